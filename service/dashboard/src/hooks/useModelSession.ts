import { useCallback, useEffect, useMemo, useState } from "react";

import type { Model } from "../api/types";
import type { Layer } from "../three/layers";
import { useInstance } from "./useInstance";
import type { Values } from "./useInstance";

const MOST_SEED = 2 ** 31;

/** The selected model, its slider values and the mesh that follows them. */
export function useModelSession(model: Model | null, linkedValues: Values | undefined) {
  const modelId = model?.id ?? null;
  const [values, setValues] = useState<Values>({});
  const [held, setHeld] = useState(false);
  const { instance, busy, error, ask } = useInstance(modelId, setValues);

  // A link may carry values; they are compared as text because each parse of the address makes a new object.
  const linked = JSON.stringify(linkedValues ?? {});
  useEffect(() => {
    if (modelId === null) return;
    const start = JSON.parse(linked) as Values;
    setValues(start);
    ask({ values: start });
  }, [modelId, linked, ask]);

  const change = useCallback(
    (next: Values) => {
      setValues(next);
      ask({ values: next });
    },
    [ask],
  );
  const randomize = useCallback(() => ask({ seed: Math.floor(Math.random() * MOST_SEED) }), [ask]);

  const layers = useMemo<Layer[]>(
    () =>
      model === null
        ? []
        : [
            {
              id: "model",
              label: model.name,
              tone: "model",
              glb: instance?.glb,
              subject: `model ${instance?.modelId ?? ""}`,
              visible: true,
              opacity: 1,
            },
          ],
    [model, instance],
  );
  return {
    values,
    held,
    setHeld,
    layers,
    busy,
    error,
    change,
    randomize,
    glb: instance?.modelId === modelId ? instance?.glb : undefined,
  };
}
