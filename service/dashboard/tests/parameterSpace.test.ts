import { describe, expect, it } from "vitest";

import type { Parameter } from "../src/api/types";
import { isSwitch, keptValues, optionName, settle, settledValues } from "../src/lib/parameterSpace";

function parameter(name: string, rest: Partial<Parameter> = {}): Parameter {
  return {
    name,
    label: name.replace("_", " "),
    unit: null,
    base_value: null,
    kind: null,
    minimum: 0.5,
    maximum: 2,
    default: 1,
    options: [],
    active_when: [],
    limits: [],
    ...rest,
  };
}

const options = (first: number, ...names: string[]) => ({
  options: names.map((name, index) => ({ value: first + index, name })),
  minimum: first,
  maximum: first + names.length - 1,
});
const when = (name: string, minimum: number, maximum = minimum) => ({ parameter: name, minimum, maximum });

const CHAIR = [
  parameter("back", options(1, "low back", "high back", "no back")),
  parameter("armrests", { ...options(0, "without", "with"), label: "Armrests" }),
  parameter("pads", { ...options(0, "bare", "padded"), active_when: [when("armrests", 1)] }),
  parameter("pad_width", { active_when: [when("pads", 1)] }),
  parameter("back_tilt", { active_when: [when("back", 1, 2)] }),
  parameter("leg_length", { unit: "m", base_value: 0.4 }),
  parameter("ring_height", { limits: [{ bound: "maximum", parameter: "leg_length", offset: 0.25, factor: 0.75 }] }),
  parameter("tray", { active_when: [when("leg_length", 1.5, 2)] }),
];
const at = (name: string, values: Record<string, number>) => settle(CHAIR, values)[name];

describe("settle", () => {
  it("takes 1 for what is not given, and leaves settled values as they are", () => {
    expect(at("leg_length", {})).toEqual({ value: 1, minimum: 0.5, maximum: 2, active: true, reason: null });
    const once = settledValues(CHAIR, { leg_length: 9, ring_height: 1.9, back: 2.4 });
    expect(once).toEqual({ leg_length: 2, ring_height: 1.75, back: 2 });
    expect(settledValues(CHAIR, once)).toEqual(once);
  });

  it("moves the end of a range, and a value beyond it in", () => {
    expect(at("ring_height", { leg_length: 0.6, ring_height: 1.5 })).toMatchObject({ value: 0.7, maximum: 0.7 });
    expect(at("ring_height", { leg_length: 2, ring_height: 1.5 })).toMatchObject({ value: 1.5, maximum: 1.75 });
  });

  it("says why a parameter is not active", () => {
    expect(at("pads", { armrests: 0, pads: 0 })).toMatchObject({ value: 1, reason: "Only with armrests" });
    expect(at("pads", { armrests: 1 })?.reason).toBeNull();
    expect(at("pad_width", { armrests: 0 })?.reason).toBe("Only with armrests");
    expect(at("pad_width", { armrests: 1, pads: 0 })?.reason).toBe("Only if pads is padded");
    expect(at("back_tilt", { back: 3 })?.reason).toBe("Only if back is low back or high back");
    expect(at("tray", {})?.reason).toBe("Only if leg length is 0.600 m to 0.800 m");
  });

  it("sends what is active, and keeps the rest for when it comes back", () => {
    const values = { armrests: 0, pads: 0, leg_length: 3 };
    expect(settledValues(CHAIR, values)).toEqual({ armrests: 0, leg_length: 2 });
    expect(keptValues(CHAIR, values)).toEqual({ armrests: 0, pads: 0, leg_length: 2 });
  });
});

it("tells a switch from a choice, and an option by its name", () => {
  expect(CHAIR.map(isSwitch)).toEqual([false, true, true, false, false, false, false, false]);
  expect(CHAIR.map((one) => optionName(one, 1))).toEqual(["low back", "with", "padded", ...Array(5).fill(null)]);
});
