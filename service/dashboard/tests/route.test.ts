import { describe, expect, it } from "vitest";

import { formatRoute, parseRoute } from "../src/lib/route";
import type { Route } from "../src/lib/route";

describe("routes", () => {
  const routes: Route[] = [
    { kind: "home" },
    { kind: "model", id: "3fa9" },
    { kind: "model", id: "3fa9", values: { stem_length: 1.25, "odd name&": 0.5 } },
    { kind: "mesh", id: "a/b c" },
    { kind: "estimation", id: "e-1" },
    { kind: "collection", id: "new" },
    { kind: "retrieval", id: "r-1" },
  ];
  it.each(routes)("come back from the address as they went in: %j", (route) => {
    expect(parseRoute(formatRoute(route))).toEqual(route);
  });

  it.each(["", "#", "#/nowhere/1", "#/models/", "#/models/1/2", "#/meshes/%E0%A4%A"])("%j leads home", (hash) => {
    expect(parseRoute(hash)).toEqual({ kind: "home" });
  });

  it("ignores values that are no numbers", () => {
    expect(parseRoute("#/models/1?a=2&b=tall")).toEqual({ kind: "model", id: "1", values: { a: 2 } });
  });
});
