/** What a classification says, in words. */
import type { Classification } from "../api/types";
import { humanize, percent } from "./format";

type Answer = Pick<NonNullable<Classification["result"]>, "class_name" | "answer" | "known">;

/** The service's own threshold of `known`: below it a mesh is unknown. */
export const KNOWN_THRESHOLD = 0.5;

export interface Verdict {
  /** Whether the mesh is taken for one of the classes at all. */
  known: boolean;
  title: string;
  /** The nearest class of what is unknown, and how sure it is that there is a class; `null` if there is nothing to say. */
  detail: string | null;
}

/** `Goblet` or `Unknown` at a threshold, and what stands behind it. */
export function verdictOf({ class_name, answer, known }: Answer, threshold: number): Verdict {
  const accepted = known === null ? answer !== "unknown" : known >= threshold;
  const odds = known === null ? null : `${percent(known)} sure that it is of any class`;
  if (accepted) return { known: true, title: humanize(class_name), detail: odds };
  const nearest = `Nearest class: ${humanize(class_name)}`;
  return { known: false, title: "Unknown", detail: odds === null ? nearest : `${nearest}; ${odds}` };
}
