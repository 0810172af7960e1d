import { expect, it } from "vitest";

import type { Classifier, Model } from "../src/api/types";
import { defaultTarget } from "../src/components/EstimationPanel";
import { byClass, classesToAdd, newestVersions } from "../src/lib/classes";

const model = (class_name: string, name: string, created_at = "2026-01-01") =>
  ({ id: `${name} ${created_at}`, class_name, name, created_at }) as Model;

const MODELS = [
  model("table", "table_round"),
  model("chair", "armchair"),
  model("table", "table", "2026-01-02"),
  model("table", "table", "2026-01-03"),
];

it("groups models by class, newest version first", () => {
  expect(byClass(undefined)).toEqual([]);
  const classes = byClass(MODELS);
  expect(classes.map(({ name, models }) => [name, models.map(({ id }) => id)])).toEqual([
    ["chair", ["armchair 2026-01-01"]],
    ["table", ["table 2026-01-03", "table 2026-01-02", "table_round 2026-01-01"]],
  ]);
  expect(newestVersions(MODELS).map(({ id }) => id)).toEqual([
    "armchair 2026-01-01",
    "table 2026-01-03",
    "table_round 2026-01-01",
  ]);
});

it("estimates with all models of the class that was found", () => {
  const classes = byClass(MODELS);
  expect(defaultTarget(classes, "table")).toBe("class:table");
  expect(defaultTarget(classes, "chair")).toBe("armchair 2026-01-01");
  expect(defaultTarget(classes, "ship")).toBe("armchair 2026-01-01");
  expect(defaultTarget([], null)).toBeNull();
});

it("offers the classes that a classifier has not learned", () => {
  const knowing = (...class_names: string[]) => ({ class_names }) as Classifier;
  expect(classesToAdd(MODELS, knowing("chair")).map(({ name, models }) => [name, models.length])).toEqual([["table", 2]]);
  expect(classesToAdd(MODELS, knowing("chair", "table"))).toEqual([]);
  expect(classesToAdd(MODELS, undefined)).toEqual([]);
});
