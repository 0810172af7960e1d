import { describe, expect, it } from "vitest";

import { KNOWN_THRESHOLD, verdictOf } from "../src/lib/verdict";

describe("the verdict of a classification", () => {
  it("names the class and how sure it is that there is one", () => {
    expect(verdictOf({ class_name: "dining_table", answer: "dining_table", known: 0.93 }, KNOWN_THRESHOLD)).toEqual({
      known: true,
      title: "Dining table",
      detail: "93.0 % sure that it is of any class",
    });
  });

  it("says that a mesh is unknown, and which class is nearest", () => {
    expect(verdictOf({ class_name: "goblet", answer: "unknown", known: 0.12 }, KNOWN_THRESHOLD)).toEqual({
      known: false,
      title: "Unknown",
      detail: "Nearest class: Goblet; 12.0 % sure that it is of any class",
    });
  });

  it("follows a threshold that has moved", () => {
    const said = { class_name: "goblet", answer: "unknown", known: 0.4 };
    expect([0, 0.4, 0.45].map((threshold) => verdictOf(said, threshold).title)).toEqual(["Goblet", "Goblet", "Unknown"]);
  });

  it("does without what older answers lack", () => {
    const older = { class_name: "goblet", answer: null, known: null };
    expect(verdictOf(older, 1)).toEqual({ known: true, title: "Goblet", detail: null });
  });
});
