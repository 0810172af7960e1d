import { useId } from "react";
import type { CSSProperties } from "react";

import type { Classifier } from "../api/types";
import { tradeOffText } from "../lib/tradeOff";
import { KNOWN_THRESHOLD } from "../lib/verdict";
import { Icon } from "./Icon";

interface ThresholdSliderProps {
  threshold: number;
  onThreshold: (threshold: number) => void;
  /** Measured by the training; `null` if it was not. */
  tradeOff: Classifier["trade_off"];
}

/** The threshold below which a mesh is unknown, with its trade-off. */
export function ThresholdSlider({ threshold, onThreshold, tradeOff }: ThresholdSliderProps) {
  const id = useId();
  const cost = tradeOffText(tradeOff, threshold);
  const shown = `${Math.round(threshold * 100)} %`;
  const style = { "--value": threshold, "--base": KNOWN_THRESHOLD } as CSSProperties;
  return (
    <div className="parameter threshold" data-testid="threshold">
      <label htmlFor={id}>Unknown below</label>
      <button
        type="button"
        className="icon-button parameter-reset"
        onClick={() => onThreshold(KNOWN_THRESHOLD)}
        disabled={threshold === KNOWN_THRESHOLD}
        aria-label="Reset the threshold"
        title={`Back to ${KNOWN_THRESHOLD * 100} %`}
      >
        <Icon name="reset" size={13} />
      </button>
      <output htmlFor={id}>{shown}</output>
      <div className="parameter-track" style={style}>
        <input
          id={id}
          type="range"
          min={0}
          max={1}
          step={0.05}
          value={threshold}
          aria-valuetext={shown}
          aria-describedby={`${id}-cost`}
          onChange={(event) => onThreshold(event.target.valueAsNumber)}
        />
      </div>
      <p className="hint" id={`${id}-cost`} title={cost === null ? undefined : "Measured by the training, on variations it did not learn from"}>
        {cost ?? "The effect of the threshold was not measured for this classifier."}
      </p>
    </div>
  );
}
