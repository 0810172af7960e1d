import { describe, expect, it } from "vitest";

import type { Retrieval } from "../src/api/types";
import { evidenceText, retrievalsOf } from "../src/lib/retrievals";

const retrieval = (id: string, collection_id: string, created_at: string) =>
  ({ id, collection_id, created_at }) as Retrieval;

describe("retrievals", () => {
  it("of a collection come newest first", () => {
    const items = [
      retrieval("a", "mine", "2025-03-01T10:00:00Z"),
      retrieval("b", "other", "2025-03-01T11:00:00Z"),
      retrieval("c", "mine", "2025-03-01T12:00:00Z"),
    ];
    expect(retrievalsOf(items, "mine").map(({ id }) => id)).toEqual(["c", "a"]);
    expect(retrievalsOf(items, null)).toEqual([]);
    expect(retrievalsOf(undefined, "mine")).toEqual([]);
  });

  it("say what a mesh was ranked by, as far as it was asked for", () => {
    expect(evidenceText({ probability: 0.92, distance: 0.1377 })).toBe("92.0 %, distance 0.138");
    expect(evidenceText({ probability: 1, distance: null })).toBe("100 %");
    expect(evidenceText({ probability: null, distance: 0 })).toBe("distance 0");
  });
});
