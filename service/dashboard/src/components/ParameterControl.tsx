import { useId } from "react";

import type { Parameter } from "../api/types";
import { parameterLabel } from "../lib/format";
import { isSwitch, optionName } from "../lib/parameterSpace";
import type { Setting } from "../lib/parameterSpace";
import { Icon } from "./Icon";
import { ParameterSlider } from "./ParameterSlider";

export interface ParameterControlProps {
  parameter: Parameter;
  setting: Setting;
  onChange: (value: number) => void;
  /** A slider is being dragged, or no longer. */
  onHeld: (held: boolean) => void;
}

/** One parameter: a slider for a measure, a list for a choice, a toggle for a switch; grey while it means nothing. */
export function ParameterControl(props: ParameterControlProps) {
  const { parameter, setting, onChange } = props;
  const id = useId();
  const label = parameterLabel(parameter);
  const reasonId = setting.reason === null ? undefined : `${id}-reason`;
  const kind = parameter.options.length === 0 ? "measure" : isSwitch(parameter) ? "switch" : "choice";
  return (
    <div className="parameter" data-parameter={parameter.name} data-kind={kind} data-active={setting.active}>
      <label htmlFor={id}>{label}</label>
      <button
        type="button"
        className="icon-button parameter-reset"
        onClick={() => onChange(1)}
        disabled={setting.value === 1 || !setting.active}
        aria-label={`Reset ${label}`}
        title="Back to the base model"
      >
        <Icon name="reset" size={13} />
      </button>
      {kind === "measure" && <ParameterSlider {...props} id={id} reasonId={reasonId} />}
      {kind === "choice" && (
        <select
          id={id}
          value={setting.value}
          disabled={!setting.active}
          aria-describedby={reasonId}
          onChange={(event) => onChange(Number(event.target.value))}
        >
          {parameter.options.map((option) => (
            <option key={option.value} value={option.value}>
              {option.name}
            </option>
          ))}
        </select>
      )}
      {kind === "switch" && (
        <span className="toggle">
          <output htmlFor={id}>{optionName(parameter, setting.value)}</output>
          <input
            id={id}
            type="checkbox"
            role="switch"
            checked={setting.value === 1}
            aria-checked={setting.value === 1}
            disabled={!setting.active}
            aria-describedby={reasonId}
            onChange={(event) => onChange(event.target.checked ? 1 : 0)}
          />
        </span>
      )}
      {setting.reason !== null && (
        <p className="parameter-reason" id={reasonId}>
          {setting.reason}
        </p>
      )}
    </div>
  );
}
