import { useId } from "react";
import type { CSSProperties } from "react";

import type { Parameter } from "../api/types";
import { parameterLabel, parameterValue } from "../lib/format";
import { Icon } from "./Icon";

interface ParameterSliderProps {
  parameter: Parameter;
  value: number;
  onChange: (value: number) => void;
  /** The slider is being dragged, or no longer. */
  onHeld: (held: boolean) => void;
}

/** One parameter of a model; x = 1, the base, is marked on the track. */
export function ParameterSlider({ parameter, value, onChange, onHeld }: ParameterSliderProps) {
  const id = useId();
  const { name, minimum, maximum } = parameter;
  const label = parameterLabel(parameter);
  const span = maximum - minimum || 1;
  const at = (x: number) => (x - minimum) / span;
  const shown = parameterValue(value, parameter);
  const style = { "--value": at(value), "--base": at(1) } as CSSProperties;
  return (
    <div className="parameter" style={style} data-parameter={name}>
      <label htmlFor={id}>{label}</label>
      <button
        type="button"
        className="icon-button parameter-reset"
        onClick={() => onChange(1)}
        disabled={value === 1}
        aria-label={`Reset ${label}`}
        title="Back to the base model"
      >
        <Icon name="reset" size={13} />
      </button>
      <output htmlFor={id}>{shown}</output>
      <div className="parameter-track">
        <input
          id={id}
          type="range"
          min={minimum}
          max={maximum}
          step={span / 200}
          value={value}
          aria-valuetext={shown}
          onPointerDown={() => onHeld(true)}
          onPointerUp={() => onHeld(false)}
          onPointerCancel={() => onHeld(false)}
          onChange={(event) => onChange(event.target.valueAsNumber)}
        />
      </div>
    </div>
  );
}
