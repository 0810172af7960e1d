import { describe, expect, it } from "vitest";

import {
  ago,
  duration,
  humanize,
  parameterLabel,
  parameterValue,
  parseTime,
  percent,
  significant,
  wholeDuration,
} from "../src/lib/format";

describe("numbers", () => {
  it("keeps three significant digits without exponents", () => {
    expect([0, 0.01874, 0.251, 6.2, 82, 1234.5].map((value) => significant(value))).toEqual([
      "0", "0.0187", "0.251", "6.20", "82.0", "1235", // prettier-ignore
    ]);
    expect(significant(Number.NaN)).toBe("–");
  });

  it("shows a parameter in its unit when the model says what 1 stands for", () => {
    expect(parameterValue(1.025, { unit: "mm", base_value: 80 })).toBe("82.0 mm");
    expect(parameterValue(0.5, { unit: "°", base_value: 30 })).toBe("15.0°");
    expect(parameterValue(0.5, { unit: null, base_value: 4 })).toBe("2.00");
    expect(parameterValue(1.234, { unit: null, base_value: null })).toBe("× 1.23");
  });

  it("never rounds a probability up to certainty or down to nothing", () => {
    expect([0, 0.0004, 0.031, 0.962, 0.99991, 1].map(percent)).toEqual([
      "0 %", "< 0.1 %", "3.1 %", "96.2 %", "> 99.9 %", "100 %", // prettier-ignore
    ]);
  });
});

describe("times", () => {
  it("reads durations aloud", () => {
    expect([0.44, 9.96, 12.4, 185, 3725].map(duration)).toEqual(["0.4 s", "10.0 s", "12 s", "3 min 5 s", "1 h 2 min"]);
    expect([-1, 3.9, 61].map(wholeDuration)).toEqual(["0 s", "3 s", "1 min 1 s"]);
    expect(duration(Number.NaN)).toBe("–");
  });

  it("takes times without a zone as UTC", () => {
    expect(parseTime("2025-03-01T10:00:00").toISOString()).toBe("2025-03-01T10:00:00.000Z");
    expect(parseTime("2025-03-01T10:00:00+01:00").toISOString()).toBe("2025-03-01T09:00:00.000Z");
  });

  it("says how long ago", () => {
    const now = new Date("2025-03-01T12:00:00Z");
    const before = (seconds: number) => ago(new Date(now.getTime() - seconds * 1000), now);
    expect([before(3), before(50), before(600), before(7200)]).toEqual(["just now", "1 min ago", "10 min ago", "2 h ago"]);
  });
});

it("makes words of names", () => {
  expect(humanize("glass_with_stem")).toBe("Glass with stem");
  expect(humanize("")).toBe("");
  expect(parameterLabel({ name: "stem_length", label: "length of the stem" })).toBe("Length of the stem");
  expect(parameterLabel({ name: "stem_length", label: "" })).toBe("Stem length");
});
