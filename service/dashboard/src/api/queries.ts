/** What the page knows of the service, as TanStack Query hooks; one key for each resource. */
import { useInfiniteQuery, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import type { QueryClient } from "@tanstack/react-query";

import { createApi } from "./client";
import { isTerminal } from "./types";
import type { CollectionDetail, Estimation, Job, Mesh, Model, Retrieval } from "./types";

export const api = createApi(globalThis.location?.origin ?? "http://localhost");

export const keys = {
  ready: ["ready"],
  models: ["models"],
  meshes: ["meshes"],
  mesh: (id: string) => ["mesh", id],
  glb: (url: string) => ["glb", url],
  instance: (modelId: string, values: Record<string, number>) => ["instance", modelId, values],
  classifiers: ["classifiers"],
  classifications: ["classifications"],
  estimations: ["estimations"],
  estimation: (id: string) => ["estimations", id],
  collections: ["collections"],
  collection: (id: string) => ["collections", id],
  retrievals: ["retrievals"],
  retrieval: (id: string) => ["retrievals", id],
  jobs: ["jobs"],
  job: (id: string) => ["jobs", id],
} as const;

const THUMBNAIL_WAIT_MS = 5 * 60_000;

/** A new model's thumbnail is drawn by a worker: look again for a while, not for ever. */
function awaitsThumbnail(models: Model[] | undefined): boolean {
  const since = Date.now() - THUMBNAIL_WAIT_MS;
  return (models ?? []).some((model) => !model.thumbnail_url && new Date(model.created_at).getTime() > since);
}

export function useReady() {
  return useQuery({ queryKey: keys.ready, queryFn: () => api.ready(), refetchInterval: 10_000, retry: false });
}

export function useModels() {
  return useQuery({
    queryKey: keys.models,
    queryFn: () => api.listModels(),
    refetchInterval: (query) => (awaitsThumbnail(query.state.data) ? 3000 : 60_000),
  });
}

export function useMeshes() {
  return useInfiniteQuery({
    queryKey: keys.meshes,
    queryFn: ({ pageParam }) => api.listMeshes(pageParam),
    initialPageParam: null as string | null,
    getNextPageParam: (last) => last.next_cursor ?? null,
    refetchInterval: 30_000,
  });
}

export function useMesh(id: string | null) {
  return useQuery({ queryKey: keys.mesh(id ?? ""), queryFn: () => api.getMesh(id ?? ""), enabled: id !== null });
}

/** The bytes of a mesh; content under one address never changes. */
export function useGlb(url: string | null) {
  return useQuery({
    queryKey: keys.glb(url ?? ""),
    queryFn: ({ signal }) => api.fetchGlb(url ?? "", signal),
    enabled: url !== null,
    staleTime: Infinity,
    gcTime: 60_000,
  });
}

/** The mesh of a model with these values, in the model's own coordinates. */
export function useInstanceGlb(asked: { modelId: string; values: Record<string, number> } | null) {
  return useQuery({
    queryKey: keys.instance(asked?.modelId ?? "", asked?.values ?? {}),
    queryFn: async ({ signal }) => (await api.createInstance(asked!.modelId, { values: asked!.values }, signal)).glb,
    enabled: asked !== null,
    staleTime: Infinity,
    gcTime: 60_000,
  });
}

export function useClassifiers() {
  return useQuery({ queryKey: keys.classifiers, queryFn: () => api.listClassifiers() });
}

export function useClassifications() {
  return useQuery({ queryKey: keys.classifications, queryFn: () => api.listClassifications() });
}

export function useEstimations() {
  return useQuery({ queryKey: keys.estimations, queryFn: () => api.listEstimations() });
}

export function useEstimation(id: string | null) {
  return useQuery<Estimation>({
    queryKey: keys.estimation(id ?? ""),
    queryFn: () => api.getEstimation(id ?? ""),
    enabled: id !== null,
  });
}

export function useCollections() {
  return useQuery({ queryKey: keys.collections, queryFn: () => api.listCollections() });
}

export function useCollection(id: string | null) {
  return useQuery<CollectionDetail>({
    queryKey: keys.collection(id ?? ""),
    queryFn: () => api.getCollection(id ?? ""),
    enabled: id !== null,
  });
}

export function useRetrievals() {
  return useQuery({ queryKey: keys.retrievals, queryFn: () => api.listRetrievals() });
}

export function useRetrieval(id: string | null) {
  return useQuery<Retrieval>({
    queryKey: keys.retrieval(id ?? ""),
    queryFn: () => api.getRetrieval(id ?? ""),
    enabled: id !== null,
  });
}

export function useJobs() {
  return useQuery({
    queryKey: keys.jobs,
    queryFn: () => api.listJobs(),
    refetchInterval: (query) => (query.state.data?.items.some((job: Job) => !isTerminal(job.state)) ? 2000 : 10_000),
  });
}

export function useJobQuery(id: string | null) {
  return useQuery({ queryKey: keys.job(id ?? ""), queryFn: () => api.getJob(id ?? ""), enabled: id !== null });
}

/** A job ended or was made: whatever it may have changed is asked for again. */
export async function refreshAfterJob(client: QueryClient): Promise<void> {
  await Promise.all(
    [
      keys.jobs,
      keys.classifiers,
      keys.classifications,
      keys.estimations,
      keys.collections,
      keys.retrievals,
      keys.models,
    ].map((queryKey) => client.invalidateQueries({ queryKey })),
  );
}

/** A request that starts a job; lists are asked for again once it is accepted. */
function useStarter<Input, Output>(start: (input: Input) => Promise<Output>) {
  const client = useQueryClient();
  return useMutation({ mutationFn: start, onSuccess: () => refreshAfterJob(client) });
}

export const useTrain = () => useStarter(api.trainClassifier);
export const useExtend = () => useStarter(api.extendClassifier);
export const useClassify = () => useStarter(api.classify);
export const useEstimate = () => useStarter(api.estimate);
/** Index the named meshes, or all there are. */
export const useCreateCollection = () =>
  useStarter(async (input: { name: string | null; meshIds: string[] | "all"; classifierId: string | null }) =>
    api.createCollection({ ...input, meshIds: input.meshIds === "all" ? await api.listMeshIds() : input.meshIds }),
  );
export const useRetrieve = () => useStarter(api.retrieve);
export const useCancel = () => useStarter(api.cancelJob);

export function useUploadMesh() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (file: File) => api.uploadMesh(file),
    onSuccess: async (mesh: Mesh) => {
      client.setQueryData(keys.mesh(mesh.id), mesh);
      await client.invalidateQueries({ queryKey: keys.meshes });
    },
  });
}

export function useUploadModel() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: async (file: File) => api.uploadModel(await file.text()),
    onSuccess: () => refreshAfterJob(client),
  });
}
