/** Models by class: a class of objects is the set of models that share its name. */
import type { Classifier, Model } from "../api/types";

export interface ModelClass {
  name: string;
  models: Model[];
}

/** The classes by name, the models of each by name, of equal names the newest first. */
export function byClass(models: Model[] | undefined): ModelClass[] {
  const classes = new Map<string, Model[]>();
  for (const model of models ?? []) {
    const found = classes.get(model.class_name);
    if (found) found.push(model);
    else classes.set(model.class_name, [model]);
  }
  return [...classes]
    .map(([name, members]) => ({
      name,
      models: members.toSorted(
        (a, b) => a.name.localeCompare(b.name) || b.created_at.localeCompare(a.created_at),
      ),
    }))
    .toSorted((a, b) => a.name.localeCompare(b.name));
}

/** Of several versions of a model, which share class and name, the newest: what a class consists of. */
export function newestVersions(models: Model[] | undefined): Model[] {
  return byClass(models).flatMap(({ models: members }) =>
    members.filter((model, index) => model.name !== members[index - 1]?.name),
  );
}

/** The classes that a classifier has not learned: each can be added to it, and the others are unknown to it. */
export function classesToAdd(models: Model[] | undefined, classifier: Classifier | undefined): ModelClass[] {
  return classifier ? byClass(newestVersions(models)).filter(({ name }) => !classifier.class_names.includes(name)) : [];
}
