/** What the values of a model mean together: which are active, and in which range. As the service settles them. */
import type { Condition, Parameter } from "../api/types";
import { parameterLabel, parameterValue } from "./format";

export type Values = Record<string, number>;

/** A parameter beside the values of the others. */
export interface Setting {
  value: number;
  /** The range that the other values leave. */
  minimum: number;
  maximum: number;
  active: boolean;
  /** Why it is not active, such as "Only with armrests". */
  reason: string | null;
}

/** Settle values in the order of the parameters: each may depend on those before it. What is not given is 1. */
export function settle(parameters: Parameter[], values: Values): Record<string, Setting> {
  const settings: Record<string, Setting> = {};
  const byName = new Map(parameters.map((parameter) => [parameter.name, parameter]));
  for (const parameter of parameters) {
    const reason = whyInactive(parameter, settings, byName);
    let { minimum, maximum } = parameter;
    for (const limit of parameter.limits) {
      const bound = limit.offset + limit.factor * (settings[limit.parameter]?.value ?? 1);
      if (limit.bound === "minimum") minimum = Math.max(minimum, bound);
      else maximum = Math.min(maximum, bound);
    }
    const given = values[parameter.name] ?? 1;
    const whole = parameter.options.length > 0 ? Math.round(given) : given;
    const value = reason === null ? Math.min(Math.max(whole, minimum), maximum) : 1;
    settings[parameter.name] = { value, minimum, maximum, active: reason === null, reason };
  }
  return settings;
}

/** The values to send: those of active parameters, moved into their ranges. */
export function settledValues(parameters: Parameter[], values: Values): Values {
  const settings = settle(parameters, values);
  return Object.fromEntries(
    Object.keys(values).flatMap((name) => {
      const setting = settings[name];
      return setting?.active ? [[name, setting.value]] : [];
    }),
  );
}

/** The values to keep: those of active parameters moved in, the others as they were, for when they come back. */
export function keptValues(parameters: Parameter[], values: Values): Values {
  return { ...values, ...settledValues(parameters, values) };
}

/** The name of an option, if the parameter has any. */
export function optionName(parameter: Parameter, value: number): string | null {
  return parameter.options.find((option) => option.value === value)?.name ?? null;
}

/** Whether the parameter is a switch: without or with something. */
export function isSwitch(parameter: Parameter): boolean {
  return parameter.options.length === 2 && parameter.minimum === 0;
}

function whyInactive(
  parameter: Parameter,
  settings: Record<string, Setting>,
  byName: ReadonlyMap<string, Parameter>,
): string | null {
  for (const condition of parameter.active_when) {
    const other = settings[condition.parameter];
    const described = byName.get(condition.parameter);
    if (other === undefined || described === undefined) continue;
    if (!other.active) return other.reason;
    if (other.value < condition.minimum || other.value > condition.maximum) return asked(described, condition);
  }
  return null;
}

function asked(parameter: Parameter, { minimum, maximum }: Condition): string {
  const label = inSentence(parameterLabel(parameter));
  const names = parameter.options
    .filter((option) => option.value >= minimum && option.value <= maximum)
    .map((option) => option.name);
  if (names.length === 1 && (names[0] === "with" || names[0] === "without")) return `Only ${names[0]} ${label}`;
  if (names.length > 0) return `Only if ${label} is ${names.join(" or ")}`;
  const [low, high] = [parameterValue(minimum, parameter), parameterValue(maximum, parameter)];
  return low === high ? `Only if ${label} is ${low}` : `Only if ${label} is ${low} to ${high}`;
}

/** A label within a sentence; capitals of abbreviations stay. */
function inSentence(label: string): string {
  return /^[A-Z][a-z ]/.test(label) ? label.charAt(0).toLowerCase() + label.slice(1) : label;
}
