import { useState } from "react";

import { useEstimate, useModels } from "../api/queries";
import type { Estimation, Model } from "../api/types";
import { useJob } from "../hooks/useJob";
import { navigate } from "../hooks/useRoute";
import { ago, humanize, parseTime } from "../lib/format";
import { EstimationResult } from "./EstimationResult";
import { JobProgress } from "./JobProgress";
import { Problem } from "./Problem";

interface EstimationPanelProps {
  meshId: string;
  /** The class found for the mesh: its model is the default. */
  foundClass: string | null;
  /** The estimation that is shown. */
  estimation: Estimation | undefined;
  /** All estimations of this mesh, newest first. */
  estimations: Estimation[];
}

const DEFAULT_SAMPLES = 1000;
const MOST_SAMPLES = 100_000;

/** Rebuild the mesh with a model: choose it, start, follow, read the answer. */
export function EstimationPanel({ meshId, foundClass, estimation, estimations }: EstimationPanelProps) {
  const models = useModels();
  const estimate = useEstimate();
  const [chosenModel, setChosenModel] = useState<string | null>(null);
  const [samples, setSamples] = useState(String(DEFAULT_SAMPLES));

  const live = useJob(estimation && estimation.state !== "succeeded" ? estimation.job_id : null);
  const [again, setAgain] = useState(false);
  const showForm = estimation === undefined || again;
  const modelId = chosenModel ?? defaultModel(models.data, foundClass)?.id ?? null;
  const sampleCount = Number(samples);
  const samplesValid = Number.isInteger(sampleCount) && sampleCount >= 1 && sampleCount <= MOST_SAMPLES;
  const modelOf = (id: string | null) => models.data?.find((model) => model.id === id);

  const start = () => {
    if (modelId === null || !samplesValid) return;
    estimate.mutate(
      { meshId, modelId, samples: sampleCount },
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
            <div className="field">
              <label htmlFor="model">Model</label>
              <select
                id="model"
                value={modelId ?? ""}
                disabled={!models.data?.length}
                onChange={(event) => setChosenModel(event.target.value)}
              >
                {!models.data?.length && <option value="">No models</option>}
                {models.data?.map((model) => (
                  <option key={model.id} value={model.id}>
                    {humanize(model.name)}
                    {foundClass === model.class_name ? " (class found)" : ""}
                  </option>
                ))}
              </select>
            </div>
            <div className="field">
              <label htmlFor="samples">Samples</label>
              <input
                id="samples"
                type="number"
                min={1}
                max={MOST_SAMPLES}
                step={1}
                value={samples}
                required
                aria-describedby="samples-hint"
                onChange={(event) => setSamples(event.target.value)}
              />
            </div>
          </div>
          <p className="hint" id="samples-hint">
            Random variations the search starts from. More take longer and miss less.
          </p>
          <button
            type="submit"
            className="button"
            disabled={modelId === null || !samplesValid || estimate.isPending}
          >
            {estimate.isPending ? "Starting…" : "Estimate parameters"}
          </button>
        </form>
      )}
      {estimate.error && <Problem error={estimate.error} onDismiss={() => estimate.reset()} />}
      {estimation && estimation.state !== "succeeded" && <JobProgress live={live} label="Estimating parameters" />}
      {estimation?.state === "cancelled" && !estimation.result && (
        <p className="muted">The estimation was cancelled before it had found anything.</p>
      )}
      {estimation && <EstimationResult estimation={estimation} model={modelOf(estimation.model_id)} />}
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

/** The model of the class found, else the first one. */
export function defaultModel(models: Model[] | undefined, foundClass: string | null): Model | undefined {
  return models?.find((model) => model.class_name === foundClass) ?? models?.[0];
}

function describe(estimation: Estimation, model: Model | undefined): string {
  const name = model ? humanize(model.name) : "Unknown model";
  const outcome = estimation.result ? `layer ${estimation.result.layer}` : estimation.state;
  return `${name}, ${outcome}, ${ago(parseTime(estimation.created_at), new Date())}`;
}
