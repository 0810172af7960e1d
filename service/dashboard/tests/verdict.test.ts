import { describe, expect, it } from "vitest";

import { verdictOf } from "../src/lib/verdict";

describe("the verdict of a classification", () => {
  it("names the class and how sure it is that there is one", () => {
    expect(verdictOf({ class_name: "dining_table", answer: "dining_table", known: 0.93 })).toEqual({
      known: true,
      title: "Dining table",
      detail: "93.0 % sure that it is of any class",
    });
  });

  it("says that a mesh is unknown, and which class is nearest", () => {
    expect(verdictOf({ class_name: "goblet", answer: "unknown", known: 0.12 })).toEqual({
      known: false,
      title: "Unknown",
      detail: "Nearest class: Goblet; 12.0 % sure that it is of any class",
    });
  });

  it("does without what older answers lack", () => {
    const older = { class_name: "goblet", answer: null, known: null };
    expect(verdictOf(older)).toEqual({ known: true, title: "Goblet", detail: null });
  });
});
