import { useCallback, useMemo, useState } from "react";

import { useClassifications, useClassifiers, useEstimation, useEstimations, useGlb, useMesh } from "../api/queries";
import type { Route } from "../lib/route";
import { newestOf } from "../components/ClassificationPanel";
import { usableClassifiers } from "../components/ClassifierPicker";
import type { LegendEntry } from "../components/Legend";
import type { Layer } from "../three/layers";
import { modelUp } from "../three/up";

type Look = Record<string, { visible: boolean; opacity: number }>;

const FIRST_LOOK: Look = { query: { visible: true, opacity: 1 }, fit: { visible: true, opacity: 1 } };
/** With a fit beside it the query becomes a veil, so that both can be seen. */
const OVERLAID_QUERY_OPACITY = 0.4;

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
  const fitUrl = estimation?.result ? (estimation.mesh_url ?? null) : null;
  const fitGlb = useGlb(fitUrl);
  const hasFit = fitUrl !== null;

  const [look, setLook] = useState<Look>(FIRST_LOOK);
  const [touched, setTouched] = useState(false);
  const adjust = useCallback((id: string, change: Partial<Pick<LegendEntry, "visible" | "opacity">>) => {
    if (change.opacity !== undefined && id === "query") setTouched(true);
    setLook((before) => ({ ...before, [id]: { ...before[id]!, ...change } }));
  }, []);

  const queryOpacity = hasFit && !touched ? OVERLAID_QUERY_OPACITY : look["query"]!.opacity;
  const queryVisible = look["query"]!.visible;
  const fitLook = look["fit"]!;
  const layers = useMemo<Layer[]>(() => {
    if (meshId === null) return [];
    const query: Layer = {
      id: "query",
      label: "Query",
      tone: "query",
      glb: queryGlb.data,
      subject: `mesh ${meshId}`,
      visible: queryVisible,
      opacity: queryOpacity,
    };
    if (!hasFit) return [query];
    const fit: Layer = {
      id: `fit ${estimation?.id}`,
      label: "Fitted model",
      tone: "fit",
      glb: fitGlb.data,
      subject: `estimation ${estimation?.id}`,
      ...fitLook,
    };
    return [query, fit];
  }, [meshId, queryGlb.data, fitGlb.data, hasFit, estimation?.id, queryVisible, queryOpacity, fitLook]);

  const rotation = hasFit ? estimation?.result?.pose.rotation : undefined;
  const fittedUp = useMemo(() => (rotation ? modelUp(rotation) : null), [rotation]);

  const legend: LegendEntry[] = hasFit
    ? [
        { id: "query", label: "Query", tone: "query", visible: queryVisible, opacity: queryOpacity },
        { id: "fit", label: "Fitted model", tone: "fit", ...fitLook },
      ]
    : [];

  return {
    mesh: mesh.data,
    meshId,
    error: linked.error ?? mesh.error ?? queryGlb.error ?? fitGlb.error,
    busy: queryGlb.isFetching || fitGlb.isFetching,
    foundClass: classification?.result?.class_name ?? null,
    classifierId,
    setClassifier: setChosen,
    estimation,
    estimations,
    layers,
    fittedUp,
    legend,
    adjust,
  };
}
