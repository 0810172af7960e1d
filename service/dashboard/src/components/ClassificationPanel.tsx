import { useState } from "react";

import { useClassifications, useClassifiers, useClassify } from "../api/queries";
import type { Classification } from "../api/types";
import { useJob } from "../hooks/useJob";
import type { ShownNeighbor } from "../hooks/useNeighbor";
import { count, duration, humanize, percent, significant } from "../lib/format";
import { verdictOf } from "../lib/verdict";
import { ClassifierPicker } from "./ClassifierPicker";
import { JobProgress } from "./JobProgress";
import { NearestVariation } from "./NearestVariation";
import { Problem } from "./Problem";
import { ThresholdSlider } from "./ThresholdSlider";

interface ClassificationPanelProps {
  meshId: string;
  classifierId: string | null;
  onClassifier: (id: string) => void;
  unaskedError: unknown;
  /** Below it a mesh is unknown. */
  threshold: number;
  onThreshold: (threshold: number) => void;
  neighbor: ShownNeighbor;
}

/** The newest classification of a mesh, whatever its state. */
export function newestOf<Item extends { mesh_id: string; created_at: string }>(
  items: Item[] | undefined,
  meshId: string | null,
): Item | undefined {
  return (items ?? [])
    .filter((item) => item.mesh_id === meshId)
    .reduce<Item | undefined>((best, item) => (best && best.created_at >= item.created_at ? best : item), undefined);
}

/** Which class the mesh belongs to, with the probability of each. */
export function ClassificationPanel(props: ClassificationPanelProps) {
  const { meshId, classifierId, onClassifier, unaskedError, threshold, onThreshold, neighbor } = props;
  const classifications = useClassifications();
  const classifiers = useClassifiers();
  const classify = useClassify();
  const newest = newestOf(classifications.data?.items, meshId);
  const live = useJob(newest && newest.state !== "succeeded" ? newest.job_id : null);
  const [again, setAgain] = useState(false);
  const [fit, setFit] = useState(false);
  const running = newest !== undefined && (newest.state === "queued" || newest.state === "running");

  const answered = Boolean(newest?.result);
  const classifier = classifiers.data?.items.find(({ id }) => id === newest?.classifier_id);

  return (
    <section className="step" aria-labelledby="classify-title">
      <div className="step-head">
        <h3 id="classify-title">
          <span className="step-number">1</span> What is it?
        </h3>
        {answered && (
          <button type="button" className="quiet" aria-expanded={again} onClick={() => setAgain(!again)}>
            {again ? "Close" : "Classify again"}
          </button>
        )}
      </div>
      {!running && (!answered || again) && (
        <>
          <ClassifierPicker selectedId={classifierId} onSelect={onClassifier} />
          {classifierId !== null && (
            <>
              <label className="check">
                <input type="checkbox" checked={fit} onChange={(event) => setFit(event.target.checked)} />
                <span>Also fit the likeliest classes to it</span>
              </label>
              <button
                type="button"
                className="button"
                disabled={classify.isPending}
                onClick={() => classify.mutate({ meshId, classifierId, fit }, { onSuccess: () => setAgain(false) })}
              >
                {classify.isPending ? "Starting…" : "Classify"}
              </button>
            </>
          )}
        </>
      )}
      {classify.error && <Problem error={classify.error} onDismiss={() => classify.reset()} />}
      {Boolean(unaskedError) && newest === undefined && <Problem error={unaskedError} />}
      {newest && newest.state !== "succeeded" && <JobProgress live={live} label="Classifying" />}
      {newest?.state === "cancelled" && <p className="muted">The last classification was cancelled.</p>}
      {newest?.result && (
        <>
          <Answer result={newest.result} threshold={threshold} neighbor={neighbor} />
          {newest.result.known !== null && (
            <ThresholdSlider
              threshold={threshold}
              onThreshold={onThreshold}
              tradeOff={classifier?.trade_off ?? null}
            />
          )}
          <Probabilities result={newest.result} classifier={classifier?.name ?? null} />
          {newest.result.fits && <Fits fits={newest.result.fits} />}
        </>
      )}
      {newest?.result && newest.pictures_url && (
        <Pictures key={newest.id} url={newest.pictures_url} views={newest.result.per_view.length} />
      )}
    </section>
  );
}

const SHOWN_CLASSES = 6;

type Result = NonNullable<Classification["result"]>;

function Answer({ result, threshold, neighbor }: { result: Result; threshold: number; neighbor: ShownNeighbor }) {
  const verdict = verdictOf(result, threshold);
  return (
    <div className="answer" data-known={verdict.known} data-testid="answer">
      <strong>{verdict.title}</strong>
      {verdict.detail && <span>{verdict.detail}</span>}
      {result.neighbor && <NearestVariation neighbor={result.neighbor} known={verdict.known} {...neighbor} />}
    </div>
  );
}

/** How near the short fits came, in panorama distance. */
function Fits({ fits }: { fits: NonNullable<Result["fits"]> }) {
  return (
    <ul className="fits" data-testid="fits" aria-label="Fitted classes">
      {fits.map((fit) => (
        <li key={fit.class_name}>
          <span>{humanize(fit.class_name)} fitted</span>
          <span>
            distance {significant(fit.exemplar_distance)} → <strong>{significant(fit.distance)}</strong>
          </span>
        </li>
      ))}
    </ul>
  );
}

/** What the classifier saw; fetched when it is opened. */
function Pictures({ url, views }: { url: string; views: number }) {
  const [open, setOpen] = useState(false);
  const [failed, setFailed] = useState(false);
  return (
    <details className="pictures" onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>Pictures that were looked at</summary>
      {open && !failed && (
        <img
          src={url}
          alt={`The mesh as the classifier saw it, from ${count(views, "side")}`}
          decoding="async"
          onError={() => setFailed(true)}
        />
      )}
      {failed && <p className="muted">The pictures cannot be loaded.</p>}
    </details>
  );
}

function Probabilities({ result, classifier }: { result: Result; classifier: string | null }) {
  const shown = result.probabilities.slice(0, SHOWN_CLASSES);
  const hidden = result.probabilities.length - shown.length;
  return (
    <div className="probabilities" data-testid="probabilities">
      <ul>
        {shown.map(({ class_name, probability }, rank) => (
          <li key={class_name} data-best={rank === 0}>
            <span className="probability-class">{humanize(class_name)}</span>
            <span className="probability-value">{percent(probability)}</span>
            <span className="bar" aria-hidden="true">
              <span style={{ width: `${probability * 100}%` }} />
            </span>
          </li>
        ))}
      </ul>
      <p className="hint">
        {classifier !== null && `Classifier “${classifier}”: `}mean of {result.per_view.length} views,{" "}
        {duration(result.seconds)}
        {hidden > 0 && `; ${hidden} less likely classes not shown`}
      </p>
    </div>
  );
}
