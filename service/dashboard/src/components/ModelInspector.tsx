import { useEffect, useState } from "react";

import type { Model } from "../api/types";
import { count, humanize } from "../lib/format";
import { settle } from "../lib/parameterSpace";
import type { Values } from "../lib/parameterSpace";
import { Icon } from "./Icon";
import { ParameterControl } from "./ParameterControl";

interface ModelInspectorProps {
  model: Model;
  values: Values;
  glb: ArrayBuffer | undefined;
  onValues: (values: Values) => void;
  onRandom: () => void;
  onHeld: (held: boolean) => void;
}

/** The parameters of the selected model. */
export function ModelInspector({ model, values, glb, onValues, onRandom, onHeld }: ModelInspectorProps) {
  const changed = model.parameters.some(({ name }) => (values[name] ?? 1) !== 1);
  const settings = settle(model.parameters, values);
  return (
    <section className="inspector" aria-label="Model">
      <div className="inspector-head">
        <p className="eyebrow">Procedural model</p>
        <h2>{humanize(model.name)}</h2>
        {model.description && <p className="muted">{model.description}</p>}
        <dl className="facts">
          <div>
            <dt>Class</dt>
            <dd>{humanize(model.class_name)}</dd>
          </div>
          <div>
            <dt>Built by</dt>
            <dd>{count(model.operation_count, "operation")}</dd>
          </div>
          <div>
            <dt>Surface</dt>
            <dd>{model.closed ? "Closed" : "Open"}</dd>
          </div>
          <Symmetry of={model.symmetry} />
        </dl>
      </div>
      <div className="inspector-actions">
        <button type="button" className="button" onClick={onRandom}>
          <Icon name="shuffle" /> Random variation
        </button>
        <button type="button" className="button button-plain" onClick={() => onValues({})} disabled={!changed}>
          <Icon name="reset" /> Reset
        </button>
        <DownloadGlb glb={glb} name={`${model.name}.glb`} />
      </div>
      <h3>Parameters</h3>
      <div className="parameters">
        {model.parameters.map((parameter) => {
          const setting = settings[parameter.name];
          return (
            setting && (
              <ParameterControl
                key={parameter.name}
                parameter={parameter}
                setting={setting}
                onChange={(value) => onValues({ ...values, [parameter.name]: value })}
                onHeld={onHeld}
              />
            )
          );
        })}
        {model.parameters.length === 0 && <p className="muted">This model has no parameters.</p>}
      </div>
    </section>
  );
}

function Symmetry({ of: { mirrors, axis, order } }: { of: Model["symmetry"] }) {
  const found = mirrors.map((mirror) => `Mirror ${mirror}`);
  if (axis) found.push(`${order}-fold about ${axis}`);
  if (found.length === 0) return null;
  return (
    <div>
      <dt>Symmetry</dt>
      <dd>{found.join(", ")}</dd>
    </div>
  );
}

function DownloadGlb({ glb, name }: { glb: ArrayBuffer | undefined; name: string }) {
  const [url, setUrl] = useState<string>();
  useEffect(() => {
    if (!glb) return;
    const made = URL.createObjectURL(new Blob([glb], { type: "model/gltf-binary" }));
    setUrl(made);
    return () => URL.revokeObjectURL(made);
  }, [glb]);
  return (
    <a
      className="button button-plain button-icon"
      href={url}
      download={name}
      aria-disabled={!url}
      aria-label="Download this mesh as GLB"
      title="Download this mesh (GLB)"
    >
      <Icon name="download" />
    </a>
  );
}
