import { useCallback, useMemo, useState } from "react";

import { useInstanceGlb, useModels } from "../api/queries";
import type { Neighbor } from "../api/types";
import type { LegendEntry } from "../components/Legend";
import { neighborInstance } from "../lib/neighbor";
import type { NeighborInstance } from "../lib/neighbor";
import type { Layer } from "../three/layers";

export interface ShownNeighbor {
  /** The nearest variation, if its model is there to draw it. */
  instance: NeighborInstance | null;
  shown: boolean;
  show: (shown: boolean) => void;
}

/** The nearest variation of a mesh's class beside the mesh; at first it is shown where that is `suggested`. */
export function useNeighbor(meshId: string | null, neighbor: Neighbor | null, suggested: boolean) {
  const models = useModels();
  const instance = useMemo(() => neighborInstance(neighbor, models.data), [neighbor, models.data]);
  const [chosen, setChosen] = useState<{ meshId: string | null; shown: boolean } | null>(null);
  const show = useCallback((shown: boolean) => setChosen({ meshId, shown }), [meshId]);
  const [opacity, setOpacity] = useState(1);
  const shown = instance !== null && (chosen?.meshId === meshId ? chosen.shown : suggested);
  const glb = useInstanceGlb(shown ? instance : null);

  const id = neighbor ? `neighbor ${neighbor.model_id} ${neighbor.exemplar}` : "";
  const layer = useMemo<Layer>(
    () => ({
      id,
      label: "Nearest variation",
      tone: "model",
      glb: glb.data,
      subject: id,
      visible: shown,
      opacity,
      beside: true,
    }),
    [id, glb.data, shown, opacity],
  );
  const entry: LegendEntry = { id: "neighbor", label: layer.label, tone: layer.tone, visible: shown, opacity };
  const adjust = useCallback(
    (change: Partial<Pick<LegendEntry, "visible" | "opacity">>) => {
      if (change.visible !== undefined) show(change.visible);
      if (change.opacity !== undefined) setOpacity(change.opacity);
    },
    [show],
  );
  return { instance, shown, show, layer, entry, adjust, busy: glb.isFetching, error: glb.error };
}
