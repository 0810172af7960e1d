import type { Retrieval } from "../api/types";
import { wanted } from "./CollectionInspector";

/** Pictures of the first meshes of a retrieval, in place of the 3D view. */
export function ContactSheet({ retrieval }: { retrieval: Retrieval | undefined }) {
  return (
    <section className="stage sheet" aria-label="Contact sheet">
      {retrieval?.contact_sheet_url ? (
        <img src={retrieval.contact_sheet_url} alt={`${wanted(retrieval)}: pictures of the first meshes found`} />
      ) : (
        <p className="muted">The meshes that are found show up here.</p>
      )}
    </section>
  );
}
