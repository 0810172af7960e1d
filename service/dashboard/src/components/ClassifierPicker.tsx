import { useState } from "react";

import { useClassifiers, useExtend, useModels, useTrain } from "../api/queries";
import { isTerminal } from "../api/types";
import { useJob } from "../hooks/useJob";
import { classesToAdd, newestVersions } from "../lib/classes";
import { usableClassifiers } from "../lib/classifiers";
import { count, humanize } from "../lib/format";
import { JobProgress } from "./JobProgress";
import { LearningCurves } from "./LearningCurves";
import { Problem } from "./Problem";

interface ClassifierPickerProps {
  selectedId: string | null;
  onSelect: (id: string) => void;
}

/** How many images of each class a training draws. */
const EFFORTS = [
  { id: "quick", label: "Quick", variations: 60, imagesPerVariation: 5 },
  { id: "good", label: "Good", variations: 300, imagesPerVariation: 5 },
  { id: "full", label: "Full", variations: 2000, imagesPerVariation: 5 },
] as const;

type Effort = (typeof EFFORTS)[number];

export function ClassifierPicker({ selectedId, onSelect }: ClassifierPickerProps) {
  const classifiers = useClassifiers();
  const models = useModels();
  const train = useTrain();
  const extend = useExtend();
  const [added, setAdded] = useState<string | null>(null);
  const [effort, setEffort] = useState<Effort>(EFFORTS[0]);
  const [training, setTraining] = useState(false);

  const usable = usableClassifiers(classifiers.data?.items);
  const selected = usable.find((classifier) => classifier.id === selectedId);
  const pending = classifiers.data?.items.find((classifier) => !isTerminal(classifier.state));
  const startedJob = train.data?.job.id ?? extend.data?.job.id ?? null;
  const live = useJob(pending?.job_id ?? startedJob);
  const showJob = pending !== undefined || live.snapshot.state === "failed";
  const showForm = !pending && (training || (classifiers.isSuccess && usable.length === 0));
  const current = newestVersions(models.data);
  const trainable = new Set(current.map((model) => model.class_name)).size >= 2;

  const addable = classesToAdd(models.data, selected);
  const chosen = addable.find(({ name }) => name === added) ?? addable[0];

  const add = () => {
    if (!selected || !chosen) return;
    const others = addable.filter(({ name }) => name !== chosen.name).flatMap((other) => other.models);
    train.reset();
    extend.mutate(
      {
        base: selected,
        className: chosen.name,
        modelIds: chosen.models.map((model) => model.id),
        otherModelIds: others.map((model) => model.id),
      },
      { onSuccess: () => setTraining(false) },
    );
  };

  const start = () => {
    extend.reset();
    train.mutate(
      {
        modelIds: current.map((model) => model.id),
        variations: effort.variations,
        imagesPerVariation: effort.imagesPerVariation,
      },
      { onSuccess: () => setTraining(false) },
    );
  };

  return (
    <div className="field-group">
      {classifiers.isPending && <div className="skeleton skeleton-row" role="status" aria-label="Loading classifiers" />}
      {classifiers.error && !classifiers.data && (
        <Problem error={classifiers.error} onRetry={() => void classifiers.refetch()} />
      )}
      {usable.length > 0 && (
        <div className="field">
          <label htmlFor="classifier">Classifier</label>
          <div className="field-row">
            <select id="classifier" value={selectedId ?? ""} onChange={(event) => onSelect(event.target.value)}>
              {usable.map((classifier) => (
                <option key={classifier.id} value={classifier.id}>
                  {classifier.name || "Unnamed"} · {count(classifier.class_names.length, "class", "classes")}
                </option>
              ))}
            </select>
            {!showForm && !pending && (
              <button type="button" className="quiet" onClick={() => setTraining(true)}>
                Train new
              </button>
            )}
          </div>
        </div>
      )}
      {selected && <LearningCurves key={selected.id} classifier={selected} />}
      {showForm && selected && chosen && (
        <div className="well">
          <div className="field">
            <label htmlFor="added-class">Add a class to {selected.name ? `“${selected.name}”` : "this classifier"}</label>
            <div className="field-row">
              <select id="added-class" value={chosen.name} onChange={(event) => setAdded(event.target.value)}>
                {addable.map(({ name }) => (
                  <option key={name} value={name}>
                    {humanize(name)}
                  </option>
                ))}
              </select>
              <button type="button" className="button" onClick={add} disabled={extend.isPending}>
                {extend.isPending ? "Starting…" : "Add class"}
              </button>
            </div>
          </div>
          <p className="hint">Takes under a minute. The classes it already knows stay as they are.</p>
          {extend.error && <Problem error={extend.error} onDismiss={() => extend.reset()} />}
        </div>
      )}
      {showForm && (
        <div className="well">
          <p>
            {usable.length === 0 ? "No classifier yet. " : ""}
            {trainable
              ? `Train one on all ${current.length} models: it learns from random variations alone.`
              : "It tells classes apart and learns from models alone: add models of at least two classes first."}
          </p>
          <fieldset className="segmented" disabled={!trainable}>
            <legend className="visually-hidden">Training effort</legend>
            {EFFORTS.map((option) => (
              <label key={option.id}>
                <input
                  type="radio"
                  name="effort"
                  checked={effort.id === option.id}
                  onChange={() => setEffort(option)}
                />
                <span>{option.label}</span>
              </label>
            ))}
          </fieldset>
          <p className="hint">{count(effort.variations * effort.imagesPerVariation, "image")} a class</p>
          <div className="button-row">
            <button
              type="button"
              className="button"
              onClick={start}
              disabled={!trainable || train.isPending}
            >
              {train.isPending ? "Starting…" : "Train classifier"}
            </button>
            {usable.length > 0 && (
              <button type="button" className="quiet" onClick={() => setTraining(false)}>
                Not now
              </button>
            )}
          </div>
          {train.error && <Problem error={train.error} onDismiss={() => train.reset()} />}
        </div>
      )}
      {showJob && <JobProgress live={live} label="Training a classifier" />}
    </div>
  );
}
