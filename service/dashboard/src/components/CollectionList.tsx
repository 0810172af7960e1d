import { useCollections } from "../api/queries";
import type { Collection } from "../api/types";
import { count, jobState } from "../lib/format";
import { NEW, formatRoute } from "../lib/route";
import { Problem } from "./Problem";

/** The collections that can be looked through, and the way to a new one. */
export function CollectionList({ selectedId }: { selectedId: string | null }) {
  const collections = useCollections();
  const items = collections.data?.items ?? [];
  return (
    <section className="library-section" aria-labelledby="collections-title">
      <div className="section-head">
        <h2 id="collections-title">Collections</h2>
        <a className="quiet" href={formatRoute({ kind: "collection", id: NEW })}>
          Index meshes
        </a>
      </div>
      {collections.error && !collections.data && (
        <Problem error={collections.error} onRetry={() => void collections.refetch()} />
      )}
      {collections.isSuccess && items.length === 0 && (
        <p className="hint">Index meshes together to find those of a class among them.</p>
      )}
      <ul className="mesh-rows">
        {items.map((collection) => (
          <li key={collection.id}>
            <a
              className="mesh-row collection-row"
              href={formatRoute({ kind: "collection", id: collection.id })}
              aria-current={collection.id === selectedId ? "true" : undefined}
            >
              <span className="mesh-name">{collectionName(collection)}</span>
              <span className="mesh-facts">
                {collection.state === "succeeded" ? count(collection.mesh_count, "mesh", "meshes") : jobState(collection.state)}
              </span>
            </a>
          </li>
        ))}
      </ul>
    </section>
  );
}

export function collectionName(collection: Pick<Collection, "name" | "mesh_count">): string {
  return collection.name ?? count(collection.mesh_count, "mesh", "meshes");
}
