import type { CSSProperties } from "react";

import { parameterValue } from "../lib/format";
import type { ParameterControlProps } from "./ParameterControl";

interface ParameterSliderProps extends ParameterControlProps {
  id: string;
  /** The element that says why the parameter is not active. */
  reasonId: string | undefined;
}

/** A measure: its value, and a slider whose ends follow the other values; x = 1, the base, is marked on the track. */
export function ParameterSlider({ parameter, setting, id, reasonId, onChange, onHeld }: ParameterSliderProps) {
  const { value, minimum, maximum, active } = setting;
  const span = maximum - minimum || 1;
  const at = (x: number) => (x - minimum) / span;
  const shown = parameterValue(value, parameter);
  const style = { "--value": at(value), "--base": at(1) } as CSSProperties;
  return (
    <>
      <output htmlFor={id}>{active ? shown : "–"}</output>
      <div className="parameter-track" style={style}>
        <input
          id={id}
          type="range"
          min={minimum}
          max={maximum}
          step={span / 200}
          value={value}
          disabled={!active}
          aria-valuetext={shown}
          aria-describedby={reasonId}
          onPointerDown={() => onHeld(true)}
          onPointerUp={() => onHeld(false)}
          onPointerCancel={() => onHeld(false)}
          onChange={(event) => onChange(event.target.valueAsNumber)}
        />
      </div>
    </>
  );
}
