import { useState } from "react";

import { useClassifiers, useCreateCollection, useMeshes } from "../api/queries";
import { navigate } from "../hooks/useRoute";
import { usableClassifiers } from "../lib/classifiers";
import { count } from "../lib/format";
import { ClassifierPicker } from "./ClassifierPicker";
import { Problem } from "./Problem";

/** Choose meshes and a classifier, and have them indexed. */
export function CollectionForm() {
  const meshes = useMeshes();
  const classifiers = useClassifiers();
  const create = useCreateCollection();
  const [name, setName] = useState("");
  const [all, setAll] = useState(true);
  const [chosen, setChosen] = useState<ReadonlySet<string>>(new Set());
  const [classifier, setClassifier] = useState<string | null>(null);

  const items = meshes.data?.pages.flatMap((page) => page.items) ?? [];
  const usable = usableClassifiers(classifiers.data?.items);
  const classifierId = (usable.find(({ id }) => id === classifier) ?? usable[0])?.id ?? null;
  const ready = classifierId !== null && (all ? items.length > 0 : chosen.size > 0);

  const toggle = (id: string) => {
    const next = new Set(chosen);
    if (!next.delete(id)) next.add(id);
    setChosen(next);
  };

  return (
    <section className="inspector" aria-label="New collection">
      <div className="inspector-head">
        <p className="eyebrow">New collection</p>
        <h2>Index meshes</h2>
        <p className="hint">Each mesh is looked at once. Then those of a class are found in a moment.</p>
      </div>
      <form
        className="field-group"
        onSubmit={(event) => {
          event.preventDefault();
          if (!ready) return;
          create.mutate(
            { name: name.trim() || null, meshIds: all ? "all" : [...chosen], classifierId },
            { onSuccess: ({ id }) => navigate({ kind: "collection", id }) },
          );
        }}
      >
        <div className="field">
          <label htmlFor="collection-name">Name</label>
          <input
            id="collection-name"
            type="text"
            maxLength={200}
            value={name}
            placeholder="optional"
            onChange={(event) => setName(event.target.value)}
          />
        </div>
        <div className="segmented" role="group" aria-label="Which meshes">
          <label>
            <input type="radio" name="which-meshes" checked={all} onChange={() => setAll(true)} />
            <span>All meshes</span>
          </label>
          <label>
            <input type="radio" name="which-meshes" checked={!all} onChange={() => setAll(false)} />
            <span>Some</span>
          </label>
        </div>
        {meshes.error && !meshes.data && <Problem error={meshes.error} onRetry={() => void meshes.refetch()} />}
        {meshes.isSuccess && items.length === 0 && <p className="muted">Upload meshes first.</p>}
        {!all && items.length > 0 && (
          <fieldset className="mesh-choice">
            <legend className="hint">{count(chosen.size, "mesh", "meshes")} chosen</legend>
            {items.map((mesh) => (
              <label key={mesh.id} className="check">
                <input type="checkbox" checked={chosen.has(mesh.id)} onChange={() => toggle(mesh.id)} />
                <span>{mesh.file_name}</span>
              </label>
            ))}
            {meshes.hasNextPage && (
              <button
                type="button"
                className="quiet"
                onClick={() => void meshes.fetchNextPage()}
                disabled={meshes.isFetching}
              >
                Show more
              </button>
            )}
          </fieldset>
        )}
        <ClassifierPicker selectedId={classifierId} onSelect={setClassifier} />
        <button type="submit" className="button" disabled={!ready || create.isPending}>
          {create.isPending ? "Starting…" : "Start indexing"}
        </button>
      </form>
      {create.error && <Problem error={create.error} onDismiss={() => create.reset()} />}
    </section>
  );
}
