import { describe, expect, it } from "vitest";

import type { Classifier } from "../src/api/types";
import { readyClassifier, usableClassifiers } from "../src/lib/classifiers";

const classifier = (id: string, fields: Partial<Classifier>) =>
  ({ id, state: "succeeded", job_id: `job of ${id}`, created_at: `2026-12-0${id}T00:00:00Z`, ...fields }) as Classifier;

const shipped = classifier("1", { job_id: null });
const older = classifier("2", {});
const newer = classifier("3", {});
const unfinished = classifier("4", { state: "running" });

describe("classifiers", () => {
  it("can be used once they are trained, the newest first", () => {
    expect(usableClassifiers([shipped, older, unfinished, newer]).map(({ id }) => id)).toEqual(["3", "2", "1"]);
    expect(usableClassifiers(undefined)).toEqual([]);
  });

  it("that ship are asked where none is chosen, else the newest", () => {
    expect(readyClassifier([newer, shipped, older])).toBe(shipped);
    expect(readyClassifier([older, newer, unfinished])).toBe(newer);
    expect(readyClassifier([unfinished])).toBeUndefined();
  });
});
