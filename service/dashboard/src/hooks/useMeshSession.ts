import { useCallback, useMemo, useState } from "react";

import { useClassifications, useClassifiers, useEstimation, useEstimations, useGlb, useMesh } from "../api/queries";
import { usableClassifiers } from "../lib/classifiers";
import type { Route } from "../lib/route";
import { KNOWN_THRESHOLD, verdictOf } from "../lib/verdict";
import { newestOf } from "../components/ClassificationPanel";
import type { LegendEntry } from "../components/Legend";
import { modelUp } from "../three/up";
import { useFitView } from "./useFitView";
import { useNeighbor } from "./useNeighbor";

/** The selected mesh, its classification, and the estimation laid over it. */
export function useMeshSession(route: Route) {
  const estimationId = route.kind === "estimation" ? route.id : null;
  const linked = useEstimation(estimationId);
  const meshId = route.kind === "mesh" ? route.id : (linked.data?.mesh_id ?? null);
  const mesh = useMesh(meshId);

  const classifiers = useClassifiers();
  const usable = usableClassifiers(classifiers.data?.items);
  const [chosen, setChosen] = useState<string | null>(null);
  const classifierId = (usable.find(({ id }) => id === chosen) ?? usable[0])?.id ?? null;

  const classifications = useClassifications();
  const classification = newestOf(
    classifications.data?.items.filter(({ result }) => result),
    meshId,
  );

  const list = useEstimations();
  const estimations = useMemo(
    () =>
      (list.data?.items ?? [])
        .filter((estimation) => estimation.mesh_id === meshId)
        .toSorted((a, b) => b.created_at.localeCompare(a.created_at)),
    [list.data, meshId],
  );
  const estimation = estimationId === null ? estimations[0] : linked.data;

  const queryGlb = useGlb(mesh.data?.content_url ?? null);
  const fitView = useFitView(meshId, queryGlb.data, estimation);

  const [threshold, setThreshold] = useState(KNOWN_THRESHOLD);
  const result = classification?.result ?? null;
  const unknown = result !== null && !verdictOf(result, threshold).known;
  const neighbor = useNeighbor(meshId, result?.neighbor ?? null, unknown && !fitView.hasFit);
  const besides = neighbor.instance !== null && (!fitView.hasFit || fitView.view === "overlay");
  const layers = useMemo(
    () => (besides ? [...fitView.layers, neighbor.layer] : fitView.layers),
    [fitView.layers, besides, neighbor.layer],
  );
  const { adjust: adjustFit } = fitView;
  const { adjust: adjustNeighbor } = neighbor;
  const adjust = useCallback(
    (id: string, change: Partial<Pick<LegendEntry, "visible" | "opacity">>) =>
      id === "neighbor" ? adjustNeighbor(change) : adjustFit(id, change),
    [adjustFit, adjustNeighbor],
  );

  const rotation = fitView.hasFit ? estimation?.result?.pose.rotation : undefined;
  const fittedUp = useMemo(() => (rotation ? modelUp(rotation) : null), [rotation]);

  return {
    mesh: mesh.data,
    meshId,
    error: linked.error ?? mesh.error ?? queryGlb.error ?? fitView.error ?? neighbor.error,
    busy: queryGlb.isFetching || fitView.busy || neighbor.busy,
    foundClass: result?.class_name ?? null,
    threshold,
    setThreshold,
    classifierId,
    setClassifier: setChosen,
    estimation,
    estimations,
    fitView,
    neighbor,
    layers,
    legend: besides ? [...fitView.legend, neighbor.entry] : fitView.legend,
    adjust,
    fittedUp,
  };
}
