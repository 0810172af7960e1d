import type { CSSProperties } from "react";

import type { ParameterEstimate } from "../api/types";
import { parameterLabel, parameterValue, significant } from "../lib/format";

/** The estimated parameters: name, value, and where it lies in its range (the tick is the base model). */
export function ParameterTable({ parameters }: { parameters: ParameterEstimate[] }) {
  return (
    <table className="parameter-table" data-testid="parameter-table">
      <caption className="visually-hidden">Estimated parameters</caption>
      <thead>
        <tr>
          <th scope="col">Parameter</th>
          <th scope="col" className="number">
            Value
          </th>
          <th scope="col">Range</th>
        </tr>
      </thead>
      <tbody>
        {parameters.map((parameter) => (
          <tr key={parameter.name} data-active={parameter.active}>
            <th scope="row">{parameterLabel(parameter)}</th>
            <td className="number">{estimated(parameter)}</td>
            <td>{parameter.active && parameter.option === null && <RangeBar parameter={parameter} />}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function estimated(parameter: ParameterEstimate): string {
  if (!parameter.active) return "inactive";
  return parameter.option ?? parameterValue(parameter.value, parameter);
}

function RangeBar({ parameter }: { parameter: ParameterEstimate }) {
  const { minimum, maximum, value } = parameter;
  const at = (x: number) => `${(Math.min(Math.max((x - minimum) / (maximum - minimum || 1), 0), 1)) * 100}%`;
  const text =
    `${parameterValue(value, parameter)}, between ${parameterValue(minimum, parameter)} and ` +
    `${parameterValue(maximum, parameter)} (factor ${significant(value)})`;
  return (
    <span
      className="range-bar"
      role="img"
      aria-label={text}
      title={text}
      style={{ "--value": at(value), "--base": at(1) } as CSSProperties}
    />
  );
}
