/** The answers of an estimation, and what is known of them, in words. */
import type { Alternative, EstimationResult, ParameterEstimate, ParameterStatus, Pose, Residuals, Verdict } from "../api/types";
import { humanize, parameterValue, significant } from "./format";

/** The best answer, or one that fits nearly as well. */
export interface Answer {
  label: string;
  model: EstimationResult["model"];
  parameters: ParameterEstimate[];
  pose: Pose;
  distances: EstimationResult["distances"];
}

/** All answers, the best one first. */
export function answersOf(result: EstimationResult): Answer[] {
  const { model, parameters, pose, distances } = result;
  return [{ label: "Best fit", model, parameters, pose, distances }, ...result.alternatives.map(alternativeAnswer)];
}

function alternativeAnswer({ kind, label, model, parameters, pose, distances }: Alternative): Answer {
  const text = kind === "model" ? `Model: ${humanize(model.name).toLowerCase()}` : label;
  return { label: text.charAt(0).toUpperCase() + text.slice(1), model, parameters, pose, distances };
}

/** The values of an answer as the service takes them. */
export function valuesOf(answer: Answer): Record<string, number> {
  return Object.fromEntries(answer.parameters.map(({ name, value }) => [name, value]));
}

interface StatusWords {
  word: string;
  explanation: string;
}

export const STATUS: Record<ParameterStatus, StatusWords> = {
  determined: { word: "Determined", explanation: "The mesh says what it is." },
  determined_up_to_scale: {
    word: "Up to scale",
    explanation: "Certain in proportion to the other lengths. Say the unit of the file to know it alone.",
  },
  not_determined: { word: "Not determined", explanation: "Other values would fit about as well." },
  inactive: { word: "Inactive", explanation: "Another value makes it meaningless." },
  at_range_end: {
    word: "At the end of its range",
    explanation: "The mesh asks for more than the model allows.",
  },
};

/** Where a value lies with a probability of 90 %: `71.2 – 74.0 mm`; `null` if that is unknown. */
export function intervalText(parameter: ParameterEstimate): string | null {
  if (!parameter.interval || !parameter.active) return null;
  const [first = 0, last = 0] = parameter.interval;
  const ends = (parameter.base_value ?? 1) < 0 ? [last, first] : [first, last];
  const [low, high] = ends.map((x) => parameterValue(x, parameter));
  const unit = parameter.unit && low!.endsWith(` ${parameter.unit}`) ? ` ${parameter.unit}` : "";
  return `${unit ? low!.slice(0, -unit.length) : low} – ${high!.replace("× ", "")}`;
}

/** A ratio's interval: `1.07 – 1.20`. */
export function ratioInterval(interval: number[] | null): string | null {
  return interval && interval.length === 2 ? interval.map((end) => significant(end)).join(" – ") : null;
}

const DISTANCES: Record<Verdict["failed"][number]["name"], string> = {
  surface: "surface distance",
  zbuffer: "z-buffer distance",
};

/** Why a layer's result is not the answer: `The z-buffer distance is 0.81; it should be below 0.7.` */
export function failedText({ name, value, threshold }: Verdict["failed"][number]): string {
  const reached = value === null ? "could not be measured" : `is ${significant(value)}`;
  return `The ${DISTANCES[name]} ${reached}; it should be below ${threshold}.`;
}

/** How far one surface follows the other: `The fit follows 98 % of the mesh; 1 % of the fit is not in the mesh.` */
export function residualsText({ followed_share, invented_share }: Residuals): string {
  return `The fit follows ${share(followed_share)} of the mesh; ${share(invented_share)} of the fit is not in the mesh.`;
}

/** Whole percents; what is nearly all or nearly nothing is not rounded to it. */
export function share(fraction: number): string {
  if (fraction > 0 && fraction < 0.005) return "less than 1 %";
  if (fraction > 0.995 && fraction < 1) return "more than 99 %";
  return `${Math.round(fraction * 100)} %`;
}
