import { useRef, useState } from "react";

import { useModels, useUploadModel } from "../api/queries";
import type { Model } from "../api/types";
import { navigate } from "../hooks/useRoute";
import { byClass } from "../lib/classes";
import { count, humanize } from "../lib/format";
import { formatRoute } from "../lib/route";
import { Icon } from "./Icon";
import { Problem } from "./Problem";

/** With more models than these only the class of the selected one is open at first. */
const MOST_OPEN = 8;

/** The procedural models as cards, those of one class together. */
export function ModelList({ selectedId }: { selectedId: string | null }) {
  const models = useModels();
  const upload = useUploadModel();
  const input = useRef<HTMLInputElement>(null);

  const add = (file: File | undefined) => {
    if (file) upload.mutate(file, { onSuccess: (model) => navigate({ kind: "model", id: model.id }) });
  };

  return (
    <section className="library-section" aria-labelledby="models-title">
      <div className="section-head">
        <h2 id="models-title">Models</h2>
        <button type="button" className="quiet" onClick={() => input.current?.click()} disabled={upload.isPending}>
          <Icon name="plus" size={14} /> {upload.isPending ? "Adding…" : "Add model"}
        </button>
        <input
          ref={input}
          type="file"
          accept=".json,application/json"
          hidden
          aria-label="Model document"
          onChange={(event) => {
            add(event.target.files?.[0]);
            event.target.value = "";
          }}
        />
      </div>
      {upload.error && <Problem error={upload.error} onDismiss={() => upload.reset()} />}
      {models.isPending && <ModelSkeletons />}
      {models.error && !models.data && <Problem error={models.error} onRetry={() => void models.refetch()} />}
      {models.data?.length === 0 && (
        <div className="empty">
          <p>
            <strong>No models yet.</strong> A model is a JSON document that says how its class is built and which
            parameters it has.
          </p>
          <button type="button" className="button" onClick={() => input.current?.click()}>
            Add a model document
          </button>
        </div>
      )}
      {byClass(models.data).map(({ name, models: members }) => (
        <details
          key={name}
          className="model-class"
          aria-label={`Class ${humanize(name)}`}
          open={(models.data?.length ?? 0) <= MOST_OPEN || members.some((model) => model.id === selectedId)}
        >
          <summary>
            {humanize(name)} {members.length > 1 && <span>{count(members.length, "model")}</span>}
          </summary>
          <ul className="model-cards">
            {members.map((model) => (
              <li key={model.id}>
                <ModelCard model={model} selected={model.id === selectedId} />
              </li>
            ))}
          </ul>
        </details>
      ))}
    </section>
  );
}

function ModelCard({ model, selected }: { model: Model; selected: boolean }) {
  return (
    <a
      className="model-card"
      href={formatRoute({ kind: "model", id: model.id })}
      aria-current={selected ? "true" : undefined}
      title={model.description}
    >
      <Thumbnail key={model.thumbnail_url ?? ""} url={model.thumbnail_url ?? null} />
      <span className="model-name">{humanize(model.name)}</span>
      <span className="model-facts">{count(model.parameters.length, "parameter")}</span>
    </a>
  );
}

/** The picture that a worker draws some time after the upload; a neutral drawing stands in until then. */
function Thumbnail({ url }: { url: string | null }) {
  const [failed, setFailed] = useState(false);
  return (
    <span className="thumbnail">
      {url && !failed ? (
        <img src={url} alt="" loading="lazy" decoding="async" onError={() => setFailed(true)} />
      ) : (
        <span className="thumbnail-fallback" data-testid="thumbnail-fallback">
          <Icon name="edges" size={30} />
        </span>
      )}
    </span>
  );
}

function ModelSkeletons() {
  return (
    <div className="model-cards" aria-label="Loading models" role="status">
      {[0, 1, 2, 3].map((key) => (
        <div key={key} className="model-card skeleton" />
      ))}
    </div>
  );
}
