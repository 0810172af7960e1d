import { useState } from "react";

import { useEstimate, useModels } from "../api/queries";
import type { Axis, Estimation, Model, Unit } from "../api/types";
import { useJob } from "../hooks/useJob";
import { navigate } from "../hooks/useRoute";
import { byClass, newestVersions } from "../lib/classes";
import type { ModelClass } from "../lib/classes";
import { ago, humanize, parseTime } from "../lib/format";
import { EstimationResult } from "./EstimationResult";
import { JobProgress } from "./JobProgress";
import { Problem } from "./Problem";

interface EstimationPanelProps {
  meshId: string;
  /** The most probable class of the mesh, which may be unknown all the same: its models are the default. */
  foundClass: string | null;
  /** The estimation that is shown. */
  estimation: Estimation | undefined;
  /** All estimations of this mesh, newest first. */
  estimations: Estimation[];
  /** Which of its answers is shown: 0 is the best one. */
  answer: number;
  onAnswer: (answer: number) => void;
}

const UNITS: Unit[] = ["mm", "cm", "m", "in"];
const AXES: Axis[] = ["+x", "-x", "+y", "-y", "+z", "-z"];

/** Rebuild the mesh with a model or with all of a class: choose, start, follow, read the answer. */
export function EstimationPanel(props: EstimationPanelProps) {
  const { meshId, foundClass, estimation, estimations, answer, onAnswer } = props;
  const models = useModels();
  const estimate = useEstimate();
  const [chosen, setChosen] = useState<string | null>(null);
  const [units, setUnits] = useState<Unit | "">("");
  const [up, setUp] = useState<Axis | "">("");

  const live = useJob(estimation && estimation.state !== "succeeded" ? estimation.job_id : null);
  const [again, setAgain] = useState(false);
  const showForm = estimation === undefined || again;
  const classes = byClass(models.data);
  const target = chosen ?? defaultTarget(classes, foundClass);
  const modelOf = (id: string | null) => models.data?.find((model) => model.id === id);

  const found = (className: string) => (className === foundClass ? " (most probable)" : "");

  const start = () => {
    if (target === null) return;
    estimate.mutate(
      { meshId, target: readTarget(target), units: units || null, up: up || null },
      {
        onSuccess: (accepted) => {
          setAgain(false);
          navigate({ kind: "estimation", id: accepted.id });
        },
      },
    );
  };

  return (
    <section className="step" aria-labelledby="estimate-title">
      <div className="step-head">
        <h3 id="estimate-title">
          <span className="step-number">2</span> Which parameters rebuild it?
        </h3>
        {estimation !== undefined && (
          <button type="button" className="quiet" aria-expanded={showForm} onClick={() => setAgain(!again)}>
            {again ? "Close" : "Estimate again"}
          </button>
        )}
      </div>
      {showForm && (
        <form
          className="field-group"
          onSubmit={(event) => {
            event.preventDefault();
            start();
          }}
        >
          <div className="field-columns">
            <div className="field field-wide">
              <label htmlFor="model">Model</label>
              <select
                id="model"
                value={target ?? ""}
                disabled={classes.length === 0}
                onChange={(event) => setChosen(event.target.value)}
              >
                {classes.length === 0 && <option value="">No models</option>}
                {classes.map(({ name, models: members }) => (
                  <optgroup key={name} label={humanize(name)}>
                    {members.length > 1 && (
                      <option value={CLASS + name}>
                        Any {humanize(name).toLowerCase()}: best of {newestVersions(members).length}
                        {found(name)}
                      </option>
                    )}
                    {members.map((model) => (
                      <option key={model.id} value={model.id}>
                        {humanize(model.name)}
                        {members.length === 1 && found(name)}
                      </option>
                    ))}
                  </optgroup>
                ))}
              </select>
            </div>
            <div className="field">
              <label htmlFor="units">Unit of the file</label>
              <select id="units" value={units} onChange={(event) => setUnits(event.target.value as Unit | "")}>
                <option value="">Unknown</option>
                {UNITS.map((unit) => (
                  <option key={unit}>{unit}</option>
                ))}
              </select>
            </div>
            <div className="field">
              <label htmlFor="up">What points up</label>
              <select id="up" value={up} onChange={(event) => setUp(event.target.value as Axis | "")}>
                <option value="">Unknown</option>
                {AXES.map((axis) => (
                  <option key={axis}>{axis}</option>
                ))}
              </select>
            </div>
          </div>
          <p className="hint">Without the unit of the file only proportions are certain, not lengths.</p>
          <button
            type="submit"
            className="button"
            disabled={target === null || estimate.isPending}
          >
            {estimate.isPending ? "Starting…" : "Rebuild it"}
          </button>
        </form>
      )}
      {estimate.error && <Problem error={estimate.error} onDismiss={() => estimate.reset()} />}
      {estimation && estimation.state !== "succeeded" && <JobProgress live={live} label="Estimating parameters" />}
      {estimation?.state === "cancelled" && !estimation.result && (
        <p className="muted">The estimation was cancelled before it had found anything.</p>
      )}
      {estimation && (
        <EstimationResult
          estimation={estimation}
          models={models.data ?? []}
          answer={answer}
          onAnswer={onAnswer}
        />
      )}
      {estimations.length > 1 && (
        <div className="field">
          <label htmlFor="estimation">Estimations of this mesh</label>
          <select
            id="estimation"
            value={estimation?.id ?? ""}
            onChange={(event) => navigate({ kind: "estimation", id: event.target.value })}
          >
            {estimations.map((item) => (
              <option key={item.id} value={item.id}>
                {describe(item, modelOf(item.model_id))}
              </option>
            ))}
          </select>
        </div>
      )}
    </section>
  );
}

/** Begins the value of the choice "any model of this class"; ids of models hold no colon. */
const CLASS = "class:";

/** All models of the most probable class, else of the first class; the model itself if there is only one. */
export function defaultTarget(classes: ModelClass[], foundClass: string | null): string | null {
  const chosen = classes.find(({ name }) => name === foundClass) ?? classes[0];
  if (chosen === undefined) return null;
  return chosen.models.length > 1 ? CLASS + chosen.name : (chosen.models[0]?.id ?? null);
}

function readTarget(value: string): { modelId: string } | { className: string } {
  return value.startsWith(CLASS) ? { className: value.slice(CLASS.length) } : { modelId: value };
}

function describe(estimation: Estimation, model: Model | undefined): string {
  const name = humanize(model?.name ?? (estimation.class_name ? `any ${estimation.class_name}` : "unknown model"));
  const outcome = estimation.result ? `layer ${estimation.result.layer}` : estimation.state;
  return `${name}, ${outcome}, ${ago(parseTime(estimation.created_at), new Date())}`;
}
