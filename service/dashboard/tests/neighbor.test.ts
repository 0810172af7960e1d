import { describe, expect, it } from "vitest";

import type { Model, Neighbor } from "../src/api/types";
import { neighborInstance, neighborText } from "../src/lib/neighbor";

const neighbor: Neighbor = {
  class_name: "goblet",
  model_id: "m",
  exemplar: 3,
  values: [0.8, 1],
  distance: 0.414,
  usual_distance: 0.23,
};

describe("the nearest variation in words", () => {
  it("says why a mesh is unknown", () => {
    expect(neighborText(neighbor, false)).toBe(
      "The nearest variation of this class is at distance 0.41, farther than is usual for the class (up to 0.23).",
    );
    expect(neighborText({ ...neighbor, distance: 0.2 }, false)).toBe(
      "The nearest variation of this class is at distance 0.20, which is usual for the class (up to 0.23). " +
        "The pictures of the mesh do not look enough like it.",
    );
  });

  it("does not call a distance farther than one that reads the same", () => {
    expect(neighborText({ ...neighbor, distance: 0.232 }, false)).toContain("at distance 0.23, which is usual");
  });

  it("is short about a mesh that is known", () => {
    expect(neighborText(neighbor, true)).toBe("Distance 0.41 from the nearest variation; up to 0.23 is usual.");
  });

  it("omits the usual distance if it was not measured", () => {
    const unmeasured = { ...neighbor, usual_distance: null };
    expect(neighborText(unmeasured, true)).toBe("Distance 0.41 from the nearest variation.");
    expect(neighborText(unmeasured, false)).toBe("The nearest variation of this class is at distance 0.41.");
  });
});

describe("the nearest variation as an instance", () => {
  const rest = { label: "", minimum: 0.5, maximum: 2, options: [], limits: [], active_when: [] };
  const parameters = [
    { ...rest, name: "lid", minimum: 0, maximum: 1 },
    { ...rest, name: "knob", active_when: [{ parameter: "lid", minimum: 1, maximum: 1 }] },
  ];
  const model = { id: "m", parameters } as unknown as Model;

  it("has the values of active parameters by name", () => {
    expect(neighborInstance(neighbor, [model])).toEqual({ modelId: "m", values: { lid: 0.8 } });
    expect(neighborInstance({ ...neighbor, values: [1, 0.7] }, [model])?.values).toEqual({ lid: 1, knob: 0.7 });
  });

  it("is not there without its model or its values", () => {
    expect(neighborInstance(neighbor, [])).toBeNull();
    expect(neighborInstance(neighbor, undefined)).toBeNull();
    expect(neighborInstance({ ...neighbor, values: null }, [model])).toBeNull();
    expect(neighborInstance(null, [model])).toBeNull();
  });
});
