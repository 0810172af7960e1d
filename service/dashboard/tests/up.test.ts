import { expect, it } from "vitest";

import { modelUp, upChoices, upDirection } from "../src/three/up";

it("finds the model's upright axis in the query: the third column of the pose", () => {
  const quarterTurnAboutX = [
    [1, 0, 0],
    [0, 0, -1],
    [0, 1, 0],
  ];
  expect(modelUp(quarterTurnAboutX)).toEqual([0, -1, 0]);
  expect(modelUp([])).toBeNull();
});

it("offers the fit's axis only where there is a fit", () => {
  expect(upChoices(null)).not.toContain("model");
  expect(upChoices([1, 0, 0])).toContain("model");
  expect(upDirection("model", [1, 0, 0])).toEqual([1, 0, 0]);
  expect(upDirection("model", null)).toEqual([0, 1, 0]);
});
