import { useMemo } from "react";

import { useCollection, useRetrieval, useRetrievals } from "../api/queries";
import { retrievalsOf } from "../lib/retrievals";
import { NEW } from "../lib/route";
import type { Route } from "../lib/route";

/** The selected collection, and the retrieval that is shown: the one in the address, or the newest. */
export function useCollectionSession(route: Route) {
  const isNew = route.kind === "collection" && route.id === NEW;
  const retrievalId = route.kind === "retrieval" ? route.id : null;
  const linked = useRetrieval(retrievalId);
  const collectionId =
    route.kind === "collection" && !isNew ? route.id : retrievalId === null ? null : (linked.data?.collection_id ?? null);
  const collection = useCollection(collectionId);
  const list = useRetrievals();
  const retrievals = useMemo(() => retrievalsOf(list.data?.items, collectionId), [list.data, collectionId]);
  return {
    isNew,
    collectionId,
    collection: collection.data,
    retrievals,
    retrieval: retrievalId === null ? retrievals[0] : linked.data,
    error: linked.error ?? collection.error,
  };
}
