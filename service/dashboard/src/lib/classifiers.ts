/** Which classifiers can be asked, and which one is asked where nobody chooses. */
import type { Classifier } from "../api/types";

/** Classifiers that can be used, the newest first. */
export function usableClassifiers(classifiers: Classifier[] | undefined): Classifier[] {
  return (classifiers ?? [])
    .filter((classifier) => classifier.state === "succeeded")
    .toSorted((a, b) => b.created_at.localeCompare(a.created_at));
}

/** The one that the service asks if none is named: the one that ships, which no job has trained, else the newest. */
export function readyClassifier(classifiers: Classifier[] | undefined): Classifier | undefined {
  const usable = usableClassifiers(classifiers);
  return usable.find(({ job_id }) => job_id === null) ?? usable[0];
}
