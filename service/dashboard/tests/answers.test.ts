import { describe, expect, it } from "vitest";

import type { EstimationResult, ParameterEstimate } from "../src/api/types";
import { answersOf, failedText, intervalText, ratioInterval, residualsText, share, valuesOf } from "../src/lib/answers";

const height: ParameterEstimate = {
  name: "height",
  label: "height",
  unit: "mm",
  value: 1.5,
  base_value: 80,
  minimum: 0.5,
  maximum: 2,
  active: true,
  option: null,
  status: "determined",
  interval: [1.4, 1.6],
};

describe("the interval of a parameter", () => {
  it("comes in the parameter's unit, named once", () => {
    expect(intervalText(height)).toBe("112 – 128 mm");
    expect(intervalText({ ...height, unit: "°" })).toBe("112° – 128°");
    expect(intervalText({ ...height, unit: null, base_value: null })).toBe("× 1.40 – 1.60");
  });

  it("begins with its lower end where the base value is negative", () => {
    expect(intervalText({ ...height, base_value: -80 })).toBe("-128 – -112 mm");
  });

  it("is left out where nothing is known", () => {
    expect(intervalText({ ...height, interval: null })).toBeNull();
    expect(intervalText({ ...height, active: false })).toBeNull();
  });
});

describe("the verdict in words", () => {
  it("says which threshold failed", () => {
    expect(failedText({ name: "zbuffer", value: 0.8123, threshold: 0.7 })).toBe(
      "The z-buffer distance is 0.812; it should be below 0.7.",
    );
  });

  it("does not round to all or nothing", () => {
    expect([0, 0.001, 0.5, 0.999, 1].map(share)).toEqual(["0 %", "less than 1 %", "50 %", "more than 99 %", "100 %"]);
    const residuals = { tolerance: 0.04, mean: 0.1, followed_share: 0.978, invented_share: 0.031, by_part: [] };
    expect(residualsText(residuals)).toBe("The fit follows 98 % of the mesh; 3 % of the fit is not in the mesh.");
  });

  it("writes the interval of a ratio", () => {
    expect(ratioInterval([1.068, 1.196])).toBe("1.07 – 1.20");
    expect(ratioInterval(null)).toBeNull();
  });
});

it("lists the best answer and its alternatives, each with its own values", () => {
  const pose = { rotation: [], translation: [], scale: 1 };
  const distances = { panorama: 1, surface: 0.01, zbuffer: 0.1, zbuffer_raw: 1 };
  const model = { id: "a", name: "cup" };
  const other = { pose, distances, values: [0.7], parameters: [{ ...height, value: 0.7 }] };
  const result = {
    model,
    pose,
    distances,
    parameters: [height],
    alternatives: [
      { ...other, kind: "model", label: "model tall_mug", model: { id: "b", name: "tall_mug" } },
      { ...other, kind: "pose", label: "turned by 180 degrees about z", model },
    ],
  } as unknown as EstimationResult;
  const answers = answersOf(result);
  expect(answers.map(({ label }) => label)).toEqual(["Best fit", "Model: tall mug", "Turned by 180 degrees about z"]);
  expect(answers.map(valuesOf)).toEqual([{ height: 1.5 }, { height: 0.7 }, { height: 0.7 }]);
});
