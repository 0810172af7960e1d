import type { Retrieval, RetrievedMesh } from "../api/types";
import { percent, significant } from "./format";

/** The retrievals from a collection, newest first. */
export function retrievalsOf(items: Retrieval[] | undefined, collectionId: string | null): Retrieval[] {
  return (items ?? [])
    .filter((item) => item.collection_id === collectionId)
    .toSorted((a, b) => b.created_at.localeCompare(a.created_at));
}

/** What a mesh was ranked by: probability and distance, as far as they were asked for. */
export function evidenceText({ probability, distance }: Pick<RetrievedMesh, "probability" | "distance">): string {
  const parts = [
    probability === null ? null : percent(probability),
    distance === null ? null : `distance ${significant(distance)}`,
  ];
  return parts.filter((part) => part !== null).join(", ");
}
