/** What the page shows, kept in the address so that it can be linked to and survives a reload. */

export type Route =
  | { kind: "home" }
  | { kind: "model"; id: string; values?: Record<string, number> }
  | { kind: "mesh"; id: string }
  | { kind: "estimation"; id: string }
  /** A collection; `new` is the form that makes one. */
  | { kind: "collection"; id: string }
  | { kind: "retrieval"; id: string };

const SEGMENTS = {
  models: "model",
  meshes: "mesh",
  estimations: "estimation",
  collections: "collection",
  retrievals: "retrieval",
} as const;

/** In place of a collection's id: there is none yet. */
export const NEW = "new";

/** Read `#/models/<id>?stem_length=1.2`, `#/meshes/<id>`, `#/estimations/<id>` and the like; anything else is home. */
export function parseRoute(hash: string): Route {
  const [path = "", query = ""] = hash.replace(/^#\/?/, "").split("?", 2);
  const [segment = "", rawId = "", ...rest] = path.split("/");
  if (!(segment in SEGMENTS) || rawId === "" || rest.length > 0) return { kind: "home" };
  const kind = SEGMENTS[segment as keyof typeof SEGMENTS];
  let id: string;
  try {
    id = decodeURIComponent(rawId);
  } catch {
    return { kind: "home" };
  }
  if (kind !== "model") return { kind, id };
  const values = Object.fromEntries(
    [...new URLSearchParams(query)].map(([name, text]) => [name, Number(text)] as const).filter(([, x]) => Number.isFinite(x)),
  );
  return Object.keys(values).length > 0 ? { kind, id, values } : { kind, id };
}

export function formatRoute(route: Route): string {
  switch (route.kind) {
    case "home":
      return "#/";
    case "model": {
      const query = new URLSearchParams(
        Object.entries(route.values ?? {}).map(([name, x]) => [name, String(Number(x.toFixed(4)))]),
      ).toString();
      return `#/models/${encodeURIComponent(route.id)}${query ? `?${query}` : ""}`;
    }
    case "mesh":
      return `#/meshes/${encodeURIComponent(route.id)}`;
    case "estimation":
      return `#/estimations/${encodeURIComponent(route.id)}`;
    case "collection":
      return `#/collections/${encodeURIComponent(route.id)}`;
    case "retrieval":
      return `#/retrievals/${encodeURIComponent(route.id)}`;
  }
}
