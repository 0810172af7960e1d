/** The REST API as typed functions. Every refusal is thrown as an ApiError. */
import createClient from "openapi-fetch";

import { ApiError, isAbort } from "./problem";
import type { paths } from "./schema";
import type {
  Accepted,
  Axis,
  Classification,
  Classifier,
  Collection,
  CollectionDetail,
  Estimation,
  Evidence,
  Job,
  Mesh,
  Model,
  Page,
  Retrieval,
  Unit,
} from "./types";

export const PAGE_SIZE = 100;

export interface Instance {
  /** Binary glTF. */
  glb: ArrayBuffer;
  /** The parameter values it was made with, by name. */
  values: Record<string, number>;
}

interface Answer<Data> {
  data?: Data;
  error?: unknown;
  response: Response;
}

async function unwrap<Data>(request: Promise<Answer<Data>>): Promise<{ data: Data; response: Response }> {
  let answer: Answer<Data>;
  try {
    answer = await request;
  } catch (thrown) {
    throw isAbort(thrown) ? thrown : ApiError.from(thrown);
  }
  if (!answer.response.ok) {
    throw ApiError.fromAnswer(answer.response.status, answer.response.statusText, answer.error);
  }
  return { data: answer.data as Data, response: answer.response };
}

async function body<Data>(request: Promise<Answer<Data>>): Promise<Data> {
  return (await unwrap(request)).data;
}

export type Api = ReturnType<typeof createApi>;

/** The functions for a service at `baseUrl`. `fetcher` is replaced in tests. */
export function createApi(baseUrl: string, fetcher?: (request: Request) => Promise<Response>) {
  const http = createClient<paths>({ baseUrl, ...(fetcher ? { fetch: fetcher } : {}) });
  const page = { limit: PAGE_SIZE };

  return {
    /** All models, page by page. */
    async listModels(): Promise<Model[]> {
      const models: Model[] = [];
      let cursor: string | undefined;
      do {
        const query = cursor === undefined ? page : { ...page, cursor };
        const next: Page<Model> = await body(http.GET("/v1/models", { params: { query } }));
        models.push(...next.items);
        cursor = next.next_cursor ?? undefined;
      } while (cursor !== undefined);
      return models;
    },

    /** Upload a model document (its JSON text, sent as it is). */
    async uploadModel(text: string): Promise<Model> {
      return body(
        http.POST("/v1/models", {
          body: text as never,
          bodySerializer: (document: unknown) => document as string,
          headers: { "Content-Type": "application/json" },
        }) as Promise<Answer<Model>>,
      );
    },

    /** The mesh of a model for these values, or a random variation when a seed is given. */
    async createInstance(
      modelId: string,
      input: { values?: Record<string, number>; seed?: number },
      signal?: AbortSignal,
    ): Promise<Instance> {
      const { data, response } = await unwrap(
        http.POST("/v1/models/{id}/instances", {
          params: { path: { id: modelId } },
          body: { values: input.values ?? {}, seed: input.seed ?? null, subdivision_steps: 2 },
          parseAs: "arrayBuffer",
          ...(signal ? { signal } : {}),
        }) as Promise<Answer<ArrayBuffer>>,
      );
      const used = response.headers.get("X-Shapewright-Values");
      return { glb: data, values: used ? (JSON.parse(used) as Record<string, number>) : (input.values ?? {}) };
    },

    async listMeshes(cursor: string | null): Promise<Page<Mesh>> {
      return body(http.GET("/v1/meshes", { params: { query: cursor ? { ...page, cursor } : page } }));
    },

    /** The ids of all meshes, page by page. */
    async listMeshIds(): Promise<string[]> {
      const ids: string[] = [];
      let cursor: string | null = null;
      do {
        const next: Page<Mesh> = await this.listMeshes(cursor);
        ids.push(...next.items.map(({ id }) => id));
        cursor = next.next_cursor ?? null;
      } while (cursor !== null);
      return ids;
    },

    async getMesh(id: string): Promise<Mesh> {
      return body(http.GET("/v1/meshes/{id}", { params: { path: { id } } }));
    },

    async uploadMesh(file: File): Promise<Mesh> {
      return body(
        http.POST("/v1/meshes", {
          body: { file: file as unknown as string },
          bodySerializer: () => {
            const form = new FormData();
            form.append("file", file, file.name);
            return form;
          },
        }) as Promise<Answer<Mesh>>,
      );
    },

    /** A binary glTF file at an address that the API gave. */
    async fetchGlb(url: string, signal?: AbortSignal): Promise<ArrayBuffer> {
      const request = new Request(new URL(url, baseUrl), signal ? { signal } : {});
      let response: Response;
      try {
        response = await (fetcher ?? globalThis.fetch)(request);
      } catch (thrown) {
        throw isAbort(thrown) ? thrown : ApiError.from(thrown);
      }
      if (!response.ok) throw ApiError.fromAnswer(response.status, response.statusText, await response.text());
      return response.arrayBuffer();
    },

    async listClassifiers(): Promise<Page<Classifier>> {
      return body(http.GET("/v1/classifiers", { params: { query: page } }));
    },

    async trainClassifier(input: {
      modelIds: string[];
      variations: number;
      imagesPerVariation: number;
    }): Promise<Accepted> {
      return body(
        http.POST("/v1/classifiers", {
          body: {
            name: null,
            model_ids: input.modelIds,
            settings: { variations: input.variations, images_per_variation: input.imagesPerVariation },
          },
        }),
      );
    },

    /** Add a class to a trained classifier; the other models teach it which objects stay unknown. */
    async extendClassifier(input: {
      base: Classifier;
      className: string;
      modelIds: string[];
      otherModelIds: string[];
    }): Promise<Accepted> {
      return body(
        http.POST("/v1/classifiers", {
          body: {
            name: `${input.base.name || "Unnamed"} and ${input.className}`.slice(0, 200),
            base_classifier_id: input.base.id,
            model_ids: input.modelIds,
            negative_model_ids: input.otherModelIds,
            settings: {},
          },
        }),
      );
    },

    async listClassifications(): Promise<Page<Classification>> {
      return body(http.GET("/v1/classifications", { params: { query: page } }));
    },

    /** Ask what a mesh is; without a classifier's id the ready one is asked. */
    async classify(input: { meshId: string; classifierId: string | null; fit: boolean }): Promise<Accepted> {
      const { meshId, classifierId, fit } = input;
      return body(
        http.POST("/v1/classifications", {
          body: { mesh_id: meshId, classifier_id: classifierId, views: 10, seed: 0, fit },
        }),
      );
    },

    async listEstimations(): Promise<Page<Estimation>> {
      return body(http.GET("/v1/estimations", { params: { query: page } }));
    },

    async getEstimation(id: string): Promise<Estimation> {
      return body(http.GET("/v1/estimations/{id}", { params: { path: { id } } }));
    },

    /** Rebuild a mesh with a model, or with the best of a class's models. */
    async estimate(input: {
      meshId: string;
      target: { modelId: string } | { className: string };
      /** What is known of the file: the unit of its coordinates, and the axis that points up. */
      units: Unit | null;
      up: Axis | null;
    }): Promise<Accepted> {
      const { target } = input;
      const named = "modelId" in target ? { model_id: target.modelId } : { class_name: target.className };
      return body(
        http.POST("/v1/estimations", {
          body: { mesh_id: input.meshId, ...named, units: input.units, up: input.up },
        }),
      );
    },

    async listCollections(): Promise<Page<Collection>> {
      return body(http.GET("/v1/collections", { params: { query: page } }));
    },

    async getCollection(id: string): Promise<CollectionDetail> {
      return body(http.GET("/v1/collections/{id}", { params: { path: { id } } }));
    },

    /** Index meshes, so that they can be looked through. */
    async createCollection(input: {
      name: string | null;
      meshIds: string[];
      classifierId: string | null;
    }): Promise<Accepted> {
      return body(
        http.POST("/v1/collections", {
          body: { name: input.name, mesh_ids: input.meshIds, classifier_id: input.classifierId },
        }),
      );
    },

    async listRetrievals(): Promise<Page<Retrieval>> {
      return body(http.GET("/v1/retrievals", { params: { query: page } }));
    },

    async getRetrieval(id: string): Promise<Retrieval> {
      return body(http.GET("/v1/retrievals/{id}", { params: { path: { id } } }));
    },

    /** Order the meshes of a collection by how surely they are of a class. */
    async retrieve(input: { collectionId: string; className: string; evidence: Evidence }): Promise<Accepted> {
      return body(
        http.POST("/v1/retrievals", {
          body: {
            collection_id: input.collectionId,
            class_name: input.className,
            evidence: input.evidence,
            limit: 50,
            instances: 500,
            seed: 0,
          },
        }),
      );
    },

    async listJobs(): Promise<Page<Job>> {
      return body(http.GET("/v1/jobs", { params: { query: { limit: 40 } } }));
    },

    async getJob(id: string): Promise<Job> {
      return body(http.GET("/v1/jobs/{id}", { params: { path: { id } } }));
    },

    async cancelJob(id: string): Promise<Job> {
      return body(http.POST("/v1/jobs/{id}/cancel", { params: { path: { id } } }));
    },

    /** Whether the service and what it needs answer. */
    async ready(): Promise<boolean> {
      await body(http.GET("/readyz") as Promise<Answer<unknown>>);
      return true;
    },
  };
}
