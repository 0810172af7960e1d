import type { CSSProperties } from "react";

import type { ParameterEstimate } from "../api/types";
import { STATUS, intervalText } from "../lib/answers";
import { parameterLabel, parameterValue, significant } from "../lib/format";
import { StatusMark } from "./StatusMark";

/**
 * The estimated parameters: name and what is known of it, value and its 90 % interval, and where both lie in the range
 * (the tick is the base model).
 */
export function ParameterTable({ parameters }: { parameters: ParameterEstimate[] }) {
  return (
    <table className="parameter-table" data-testid="parameter-table">
      <caption className="visually-hidden">Estimated parameters</caption>
      <thead>
        <tr>
          <th scope="col">Parameter</th>
          <th scope="col" className="number">
            {parameters.some(({ interval }) => interval) ? "Value, 90 % interval" : "Value"}
          </th>
          <th scope="col">Range</th>
        </tr>
      </thead>
      <tbody>
        {parameters.map((parameter) => (
          <tr key={parameter.name} data-active={parameter.active} data-status={parameter.status}>
            <th scope="row">
              {parameterLabel(parameter)}
              {parameter.active && parameter.status && (
                <small className="status" title={STATUS[parameter.status].explanation}>
                  <StatusMark status={parameter.status} /> {STATUS[parameter.status].word}
                </small>
              )}
            </th>
            <td className="number">
              {estimated(parameter)}
              <Interval parameter={parameter} />
            </td>
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

function Interval({ parameter }: { parameter: ParameterEstimate }) {
  const text = intervalText(parameter);
  return text === null ? null : <small title="Where it lies with a probability of 90 %, given this structure">{text}</small>;
}

function RangeBar({ parameter }: { parameter: ParameterEstimate }) {
  const { minimum, maximum, value, interval } = parameter;
  const at = (x: number) => `${(Math.min(Math.max((x - minimum) / (maximum - minimum || 1), 0), 1)) * 100}%`;
  const text =
    `${parameterValue(value, parameter)}, between ${parameterValue(minimum, parameter)} and ` +
    `${parameterValue(maximum, parameter)} (factor ${significant(value)})`;
  const [low, high] = interval ?? [value, value];
  const style = { "--value": at(value), "--base": at(1), "--low": at(low!), "--high": at(high!) } as CSSProperties;
  return (
    <span className="range-bar" role="img" aria-label={text} title={text} style={style}>
      <span />
    </span>
  );
}
