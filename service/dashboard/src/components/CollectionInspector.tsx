import { useState } from "react";

import { useClassifiers, useMeshes, useRetrieve } from "../api/queries";
import type { CollectionDetail, Evidence, Retrieval } from "../api/types";
import { useJob } from "../hooks/useJob";
import { useNow } from "../hooks/useNow";
import { navigate } from "../hooks/useRoute";
import { ago, count, duration, humanize, parseTime } from "../lib/format";
import { evidenceText } from "../lib/retrievals";
import { formatRoute } from "../lib/route";
import { collectionName } from "./CollectionList";
import { JobProgress } from "./JobProgress";
import { Problem } from "./Problem";

interface CollectionInspectorProps {
  collection: CollectionDetail;
  /** The retrieval that is shown. */
  retrieval: Retrieval | undefined;
  /** All retrievals from this collection, newest first. */
  retrievals: Retrieval[];
}

/** A collection: how its indexing goes, then which of its meshes are of a class. */
export function CollectionInspector({ collection, retrieval, retrievals }: CollectionInspectorProps) {
  const live = useJob(collection.state === "succeeded" ? null : collection.job_id);
  return (
    <section className="inspector" aria-label="Collection">
      <div className="inspector-head">
        <p className="eyebrow">Collection</p>
        <h2 className="file-name">{collectionName(collection)}</h2>
        <dl className="facts">
          <div>
            <dt>Size</dt>
            <dd>{count(collection.mesh_count, "mesh", "meshes")}</dd>
          </div>
          {collection.seconds !== null && (
            <div>
              <dt>Indexed in</dt>
              <dd>{duration(collection.seconds)}</dd>
            </div>
          )}
        </dl>
      </div>
      {collection.state !== "succeeded" && <JobProgress live={live} label="Indexing meshes" />}
      {collection.state === "cancelled" && <p className="muted">The indexing was cancelled.</p>}
      {collection.skipped !== null && collection.skipped.length > 0 && <Skipped collection={collection} />}
      {collection.state === "succeeded" && (
        <Query collection={collection} retrieval={retrieval} retrievals={retrievals} />
      )}
    </section>
  );
}

function Skipped({ collection }: { collection: CollectionDetail }) {
  const meshes = useMeshes();
  const known = new Map(meshes.data?.pages.flatMap((page) => page.items).map((mesh) => [mesh.id, mesh.file_name]));
  return (
    <details className="notice">
      <summary>{count(collection.skipped?.length ?? 0, "mesh", "meshes")} skipped</summary>
      <ul>
        {collection.skipped?.map(({ mesh_id, reason }) => (
          <li key={mesh_id}>
            {known.get(mesh_id) ?? mesh_id.slice(0, 12)}: {reason}
          </li>
        ))}
      </ul>
    </details>
  );
}

const EVIDENCE: Record<Evidence, string> = { combined: "Both", probabilities: "Classifier", panorama: "Geometry" };

function Query({ collection, retrieval, retrievals }: CollectionInspectorProps) {
  const classifiers = useClassifiers();
  const retrieve = useRetrieve();
  const now = useNow(10_000);
  const classes = classifiers.data?.items.find(({ id }) => id === collection.classifier_id)?.class_names ?? [];
  const [chosen, setChosen] = useState<string | null>(null);
  const [evidence, setEvidence] = useState<Evidence>("probabilities");
  const className = chosen ?? retrieval?.class_name ?? classes[0] ?? null;
  const live = useJob(retrieval && retrieval.state !== "succeeded" ? retrieval.job_id : null);
  return (
    <section className="step" aria-labelledby="retrieve-title">
      <h3 id="retrieve-title">Which meshes are of a class?</h3>
      <form
        className="field-group"
        onSubmit={(event) => {
          event.preventDefault();
          if (className === null) return;
          retrieve.mutate(
            { collectionId: collection.id, className, evidence },
            { onSuccess: ({ id }) => navigate({ kind: "retrieval", id }) },
          );
        }}
      >
        <div className="field">
          <label htmlFor="wanted-class">Class</label>
          <select
            id="wanted-class"
            value={className ?? ""}
            disabled={classes.length === 0}
            onChange={(event) => setChosen(event.target.value)}
          >
            {classes.map((name) => (
              <option key={name} value={name}>
                {humanize(name)}
              </option>
            ))}
          </select>
        </div>
        <div className="segmented" role="group" aria-label="Evidence">
          {(Object.keys(EVIDENCE) as Evidence[]).map((kind) => (
            <label key={kind}>
              <input
                type="radio"
                name="evidence"
                value={kind}
                checked={kind === evidence}
                onChange={() => setEvidence(kind)}
              />
              <span>{EVIDENCE[kind]}</span>
            </label>
          ))}
        </div>
        <button type="submit" className="button" disabled={className === null || retrieve.isPending}>
          {retrieve.isPending ? "Starting…" : "Find meshes"}
        </button>
      </form>
      {retrieve.error && <Problem error={retrieve.error} onDismiss={() => retrieve.reset()} />}
      {retrieval && retrieval.state !== "succeeded" && <JobProgress live={live} label="Finding meshes" />}
      {retrieval?.state === "cancelled" && <p className="muted">The last search was cancelled.</p>}
      {retrieval?.result && <Ranking retrieval={retrieval} />}
      {retrievals.length > 1 && (
        <div className="field">
          <label htmlFor="retrieval">Searches in this collection</label>
          <select
            id="retrieval"
            value={retrieval?.id ?? ""}
            onChange={(event) => navigate({ kind: "retrieval", id: event.target.value })}
          >
            {retrievals.map((item) => (
              <option key={item.id} value={item.id}>
                {wanted(item)}, {ago(parseTime(item.created_at), now)}
              </option>
            ))}
          </select>
        </div>
      )}
    </section>
  );
}

/** What was looked for, in words. */
export function wanted(retrieval: Retrieval): string {
  if (retrieval.class_name !== null) return humanize(retrieval.class_name);
  return retrieval.model_id !== null ? "Like a model" : "Like a mesh";
}

function Ranking({ retrieval }: { retrieval: Retrieval }) {
  const items = retrieval.result?.items ?? [];
  return (
    <div className="ranking" data-testid="ranking">
      <p className="hint">
        {wanted(retrieval)}: the first {items.length} of {count(retrieval.result?.mesh_count ?? 0, "mesh", "meshes")}
      </p>
      <ol>
        {items.map((item) => (
          <li key={item.mesh_id}>
            <a href={formatRoute({ kind: "mesh", id: item.mesh_id })} title={item.file_name}>
              {item.file_name}
            </a>
            <span className="mesh-facts">{evidenceText(item)}</span>
          </li>
        ))}
      </ol>
    </div>
  );
}
