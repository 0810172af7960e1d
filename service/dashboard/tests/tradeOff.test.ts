import { expect, it } from "vitest";

import { tradeOffText } from "../src/lib/tradeOff";

const POINTS = [
  { threshold: 0, accepted_known: 1, refused_other: 0 },
  { threshold: 0.5, accepted_known: 0.934, refused_other: 0.871 },
  { threshold: 1, accepted_known: 0, refused_other: 1 },
];

it("says what the nearest measured threshold accepts and refuses", () => {
  expect(tradeOffText(POINTS, 0.5)).toBe(
    "Accepts about 93 % of the objects of a class and refuses about 87 % of all others.",
  );
  expect(tradeOffText(POINTS, 0.55)).toBe(tradeOffText(POINTS, 0.5));
  expect(tradeOffText(POINTS, 0.1)).toContain("about 100 %");
});

it("says nothing where nothing was measured", () => {
  expect(tradeOffText(null, 0.5)).toBeNull();
  expect(tradeOffText([], 0.5)).toBeNull();
});
