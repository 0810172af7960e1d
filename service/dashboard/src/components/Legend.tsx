import { Icon } from "./Icon";
import type { Tone } from "../three/layers";

export interface LegendEntry {
  id: string;
  label: string;
  tone: Tone;
  visible: boolean;
  opacity: number;
}

interface LegendProps {
  entries: LegendEntry[];
  onChange: (id: string, change: Partial<Pick<LegendEntry, "visible" | "opacity">>) => void;
}

/** Which colour is which mesh, with a switch and an opacity for each. */
export function Legend({ entries, onChange }: LegendProps) {
  return (
    <ul className="legend" aria-label="Meshes in the view">
      {entries.map(({ id, label, tone, visible, opacity }) => (
        <li key={id} data-hidden={!visible}>
          <button
            type="button"
            className="legend-toggle"
            aria-pressed={visible}
            onClick={() => onChange(id, { visible: !visible })}
            title={visible ? `Hide: ${label}` : `Show: ${label}`}
          >
            <span className={`swatch swatch-${tone}`} aria-hidden="true" />
            {label}
            <Icon name={visible ? "eye" : "eyeOff"} size={14} />
          </button>
          <input
            type="range"
            min={0.1}
            max={1}
            step={0.05}
            value={opacity}
            disabled={!visible}
            aria-label={`Opacity: ${label}`}
            title={`Opacity ${Math.round(opacity * 100)} %`}
            onChange={(event) => onChange(id, { opacity: event.target.valueAsNumber })}
          />
        </li>
      ))}
    </ul>
  );
}
