/** Numbers and names as people read them. */
import type { JobKind, JobState, Mesh } from "../api/types";

/** `glass_with_stem` → `Glass with stem`. */
export function humanize(name: string): string {
  const words = name.replace(/[_-]+/g, " ").trim();
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** What a parameter is called: its label as a sentence begins, or its name in words. */
export function parameterLabel(parameter: { name: string; label: string }): string {
  const label = parameter.label.trim();
  return label ? label.charAt(0).toUpperCase() + label.slice(1) : humanize(parameter.name);
}

/** A number with `digits` significant digits, never in exponent form for everyday sizes. */
export function significant(value: number, digits = 3): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const magnitude = Math.floor(Math.log10(Math.abs(value)));
  const decimals = Math.min(Math.max(digits - 1 - magnitude, 0), 6);
  return value.toFixed(decimals);
}

interface Measured {
  unit?: string | null;
  base_value?: number | null;
}

/** A parameter's value: `82.0 mm` where the model says what x = 1 stands for, else `× 1.03`. */
export function parameterValue(x: number, parameter: Measured): string {
  if (parameter.base_value === null || parameter.base_value === undefined) return `× ${x.toFixed(2)}`;
  const value = significant(x * parameter.base_value);
  if (!parameter.unit) return value;
  return parameter.unit === "°" ? `${value}°` : `${value} ${parameter.unit}`;
}

export function percent(fraction: number): string {
  const value = fraction * 100;
  if (value > 0 && value < 0.1) return "< 0.1 %";
  if (value > 99.9 && value < 100) return "> 99.9 %";
  return `${value >= 99.95 || value === 0 ? value.toFixed(0) : value.toFixed(1)} %`;
}

/** `0.4 s`, `12 s`, `3 min 5 s`, `1 h 2 min`. */
export function duration(seconds: number): string {
  if (!Number.isFinite(seconds) || seconds < 0) return "–";
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  const whole = Math.round(seconds);
  if (whole < 60) return `${whole} s`;
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  return `${Math.floor(whole / 3600)} h ${Math.floor((whole % 3600) / 60)} min`;
}

/** The same without tenths, for a clock that ticks once a second. */
export function wholeDuration(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds));
  return whole < 10 ? `${whole} s` : duration(whole);
}

/** How long ago, roughly: `now`, `4 min ago`, `2 h ago`, then the date. */
export function ago(then: Date, now: Date): string {
  const seconds = (now.getTime() - then.getTime()) / 1000;
  if (seconds < 45) return "just now";
  if (seconds < 3600) return `${Math.max(1, Math.round(seconds / 60))} min ago`;
  if (seconds < 86_400) return `${Math.round(seconds / 3600)} h ago`;
  return then.toLocaleDateString(undefined, { day: "numeric", month: "short", year: "numeric" });
}

/** Times of the API are in UTC; ones without a zone are read so too. */
export function parseTime(text: string): Date {
  return new Date(/[zZ]|[+-]\d\d:?\d\d$/.test(text) ? text : `${text}Z`);
}

export function count(value: number, singular: string, plural = `${singular}s`): string {
  return `${value.toLocaleString("en")} ${value === 1 ? singular : plural}`;
}

const KINDS: Record<JobKind, string> = {
  train_classifier: "Train classifier",
  describe_variations: "Draw variations",
  classify: "Classify",
  estimate: "Estimate",
  estimate_collection: "Estimate meshes",
  estimate_meshes: "Estimate some meshes",
  render_thumbnail: "Draw thumbnail",
  index_collection: "Index meshes",
  retrieve: "Find meshes",
};

export function jobKind(kind: JobKind): string {
  return KINDS[kind] ?? humanize(kind);
}

const STATES: Record<JobState, string> = {
  queued: "Queued",
  running: "Running",
  succeeded: "Done",
  failed: "Failed",
  cancelled: "Cancelled",
};

export function jobState(state: JobState): string {
  return STATES[state] ?? humanize(state);
}

/** What a mesh is made of: `1,200 faces`, of a point cloud `5,000 points`. */
export function meshSize(mesh: Pick<Mesh, "kind" | "face_count" | "vertex_count">): string {
  return mesh.kind === "point_cloud" ? count(mesh.vertex_count, "point") : count(mesh.face_count, "face");
}
