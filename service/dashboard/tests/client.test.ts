import { describe, expect, it } from "vitest";

import { createApi } from "../src/api/client";
import { ApiError } from "../src/api/problem";

/** An API whose service answers with `answer`, and the requests that it was sent. */
function fakeService(answer: (request: Request, count: number) => Response | Promise<Response>) {
  const requests: Request[] = [];
  const api = createApi("http://service.test", async (request) => answer(request, requests.push(request)));
  return { api, requests };
}

const json = (body: unknown, status = 200, type = "application/json") =>
  new Response(JSON.stringify(body), { status, headers: { "Content-Type": type } });

const refusal = (promise: Promise<unknown>) =>
  promise.then(
    () => expect.unreachable("it should have been refused"),
    (error: unknown) => error as ApiError,
  );

describe("errors", () => {
  it("come from the problem document, place included", async () => {
    const { api } = fakeService(() =>
      json(
        { type: "about:blank", title: "The mesh cannot be read", status: 422, detail: "NaN in a vertex", where: "line 7" },
        422,
        "application/problem+json",
      ),
    );
    const error = await refusal(api.uploadMesh(new File(["OFF"], "a.off")));
    expect(error).toBeInstanceOf(ApiError);
    expect(error).toMatchObject({ title: "The mesh cannot be read", detail: "NaN in a vertex", where: "line 7", status: 422 });
  });

  it("are clear when a proxy answers in HTML or nobody answers", async () => {
    const proxy = fakeService(() => new Response("<html>", { status: 502, statusText: "Bad Gateway" }));
    expect(await refusal(proxy.api.listModels())).toMatchObject({ title: "The service is not reachable", status: 502 });
    const nobody = fakeService(() => Promise.reject(new TypeError("fetch failed")));
    expect(await refusal(nobody.api.listJobs())).toMatchObject({ title: "The service is not reachable", status: 0 });
    expect(await refusal(nobody.api.fetchGlb("/v1/meshes/1/content"))).toMatchObject({ status: 0 });
  });

  it("let an abort through as what it is", async () => {
    const { api } = fakeService(() => Promise.reject(new DOMException("stopped", "AbortError")));
    await expect(api.createInstance("m", {})).rejects.toMatchObject({ name: "AbortError" });
  });
});

describe("requests", () => {
  it("read lists page by page", async () => {
    const { api, requests } = fakeService((_, count) =>
      json(count === 1 ? { items: [{ id: "a" }], next_cursor: "n" } : { items: [{ id: "b" }], next_cursor: null }),
    );
    expect((await api.listModels()).map(({ id }) => id)).toEqual(["a", "b"]);
    expect(requests.map(({ url }) => new URL(url).searchParams.get("cursor"))).toEqual([null, "n"]);
  });

  it("find the ids of all meshes, page by page", async () => {
    const { api, requests } = fakeService((_, count) =>
      json(count === 1 ? { items: [{ id: "a" }], next_cursor: "n" } : { items: [{ id: "b" }], next_cursor: null }),
    );
    expect(await api.listMeshIds()).toEqual(["a", "b"]);
    expect(requests.map(({ url }) => new URL(url).pathname)).toEqual(["/v1/meshes", "/v1/meshes"]);
  });

  it("ask for the meshes of a class", async () => {
    const { api, requests } = fakeService(() => json({ id: "r" }, 202));
    await api.retrieve({ collectionId: "c", className: "fish", evidence: "panorama" });
    expect(await requests[0]?.json()).toMatchObject({ collection_id: "c", class_name: "fish", evidence: "panorama" });
  });

  it("name no classifier where the ready one is to be asked", async () => {
    const { api, requests } = fakeService(() => json({ id: "c" }, 202));
    await api.classify({ meshId: "m", classifierId: null, fit: false });
    expect(await requests[0]?.json()).toMatchObject({ mesh_id: "m", classifier_id: null });
  });

  it("give back the values that a variation was made with", async () => {
    const { api, requests } = fakeService(
      () => new Response(new Uint8Array([1, 2, 3]), { headers: { "X-Shapewright-Values": '{"stem_length": 1.5}' } }),
    );
    const made = await api.createInstance("m1", { seed: 7 });
    expect(made.values).toEqual({ stem_length: 1.5 });
    expect(made.glb.byteLength).toBe(3);
    expect(await requests[0]!.json()).toMatchObject({ values: {}, seed: 7 });
  });

  it("send a mesh as a form and a model document as it is", async () => {
    const { api, requests } = fakeService(() => json({ id: "x" }, 201));
    await api.uploadMesh(new File(["OFF\n"], "a.off"));
    const sent = (await requests[0]!.formData()).get("file") as File;
    expect([sent.name, await sent.text()]).toEqual(["a.off", "OFF\n"]);
    const text = '{"format": "shapewright-procedural-model",\n "version": 1}';
    await api.uploadModel(text);
    expect(requests[1]!.headers.get("Content-Type")).toBe("application/json");
    expect(await requests[1]!.text()).toBe(text);
  });
});
