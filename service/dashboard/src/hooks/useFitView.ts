import { useCallback, useMemo, useState } from "react";

import { useGlb, useInstanceGlb } from "../api/queries";
import type { Estimation } from "../api/types";
import type { LegendEntry } from "../components/Legend";
import { answersOf, valuesOf } from "../lib/answers";
import type { Layer } from "../three/layers";

/** Mesh and fit in one, the fit alone, or one of them in the colors of its distance to the other. */
export type View = "overlay" | "fit" | "residuals";
export type Side = "query" | "fit";

type Look = Record<Side, { visible: boolean; opacity: number }>;

const FIRST_LOOK: Look = { query: { visible: true, opacity: 1 }, fit: { visible: true, opacity: 1 } };
/** With a fit beside it the query becomes a veil, so that both can be seen. */
const OVERLAID_QUERY_OPACITY = 0.4;

/** What is drawn of a mesh and its estimation: which of the answers, in which view. */
export function useFitView(meshId: string | null, queryGlb: ArrayBuffer | undefined, estimation: Estimation | undefined) {
  const hasFit = Boolean(estimation?.result && estimation.mesh_url);
  const [chosen, setChosen] = useState<{ estimationId: string; number: number } | null>(null);
  const number = chosen && chosen.estimationId === estimation?.id ? chosen.number : 0;
  const setAnswer = useCallback(
    (next: number) => setChosen(estimation ? { estimationId: estimation.id, number: next } : null),
    [estimation],
  );

  const [wanted, setView] = useState<View>("overlay");
  const [side, setSide] = useState<Side>("query");
  const residualsUrl = number === 0 ? (estimation?.residuals_url ?? null) : null;
  const view = wanted === "residuals" && residualsUrl === null ? "overlay" : wanted;

  const other = number === 0 || !estimation?.result ? undefined : answersOf(estimation.result)[number];
  const fitGlb = useGlb(hasFit ? (estimation?.mesh_url ?? null) : null);
  const otherGlb = useInstanceGlb(other ? { modelId: other.model.id, values: valuesOf(other) } : null);
  const residualsGlb = useGlb(view === "residuals" ? residualsUrl : null);

  const [look, setLook] = useState<Look>(FIRST_LOOK);
  const [touched, setTouched] = useState(false);
  const adjust = useCallback((id: string, change: Partial<Pick<LegendEntry, "visible" | "opacity">>) => {
    if (change.opacity !== undefined && id === "query") setTouched(true);
    setLook((before) => ({ ...before, [id]: { ...before[id as Side], ...change } }));
  }, []);
  const queryLook = useMemo(
    () => ({ ...look.query, opacity: hasFit && !touched ? OVERLAID_QUERY_OPACITY : look.query.opacity }),
    [look.query, hasFit, touched],
  );

  const shownGlb = number === 0 ? fitGlb.data : otherGlb.data;
  const layers = useMemo<Layer[]>(() => {
    if (meshId === null) return [];
    // The query comes first in every view, perhaps unseen: it is what the camera is framed on.
    const query: Layer = {
      id: "query",
      label: "Query",
      tone: "query",
      glb: queryGlb,
      subject: `mesh ${meshId}`,
      ...queryLook,
      visible: hasFit && view !== "overlay" ? false : queryLook.visible,
    };
    if (!hasFit || !estimation) return [query];
    if (view === "residuals") {
      const colored: Layer = {
        id: `residuals ${estimation.id} ${side}`,
        label: side === "query" ? "Query, colored" : "Fitted model, colored",
        tone: side,
        glb: residualsGlb.data,
        subject: `residuals ${estimation.id} ${side}`,
        visible: true,
        opacity: 1,
        coloredNode: side,
      };
      return [query, colored];
    }
    const fit: Layer = {
      id: `fit ${estimation.id} ${number}`,
      label: "Fitted model",
      tone: "fit",
      glb: shownGlb,
      subject: `estimation ${estimation.id} ${number}`,
      ...(view === "fit" ? { visible: true, opacity: 1 } : look.fit),
      ...(other ? { pose: other.pose } : {}),
    };
    return [query, fit];
  }, [meshId, queryGlb, hasFit, estimation, view, side, residualsGlb.data, number, shownGlb, queryLook, look.fit, other]);

  const legend: LegendEntry[] = [{ id: "query", label: "Query", tone: "query", ...queryLook }];
  if (hasFit) legend.push({ id: "fit", label: "Fitted model", tone: "fit", ...look.fit });

  return {
    hasFit,
    answer: number,
    setAnswer,
    view,
    setView,
    side,
    setSide,
    residualsThere: residualsUrl !== null,
    layers,
    legend,
    adjust,
    busy: fitGlb.isFetching || otherGlb.isFetching || residualsGlb.isFetching,
    error: fitGlb.error ?? otherGlb.error ?? residualsGlb.error,
  };
}
