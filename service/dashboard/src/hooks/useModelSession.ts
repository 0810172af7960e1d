import { useCallback, useEffect, useMemo, useState } from "react";

import type { Model } from "../api/types";
import { keptValues, settledValues } from "../lib/parameterSpace";
import type { Values } from "../lib/parameterSpace";
import type { Layer } from "../three/layers";
import { useInstance } from "./useInstance";

const MOST_SEED = 2 ** 31;
const NONE: Model["parameters"] = [];

/** The selected model, its slider values and the mesh that follows them. */
export function useModelSession(model: Model | null, linkedValues: Values | undefined) {
  const modelId = model?.id ?? null;
  const [values, setValues] = useState<Values>({});
  const [held, setHeld] = useState(false);
  const parameters = model?.parameters ?? NONE;
  const { instance, busy, error, ask } = useInstance(modelId, setValues);

  // A link may carry values; they are compared as text because each parse of the address makes a new object.
  const linked = JSON.stringify(linkedValues ?? {});
  useEffect(() => {
    if (modelId === null) return;
    const start = JSON.parse(linked) as Values;
    setValues(keptValues(parameters, start));
    ask({ values: settledValues(parameters, start) });
    // oxlint-disable-next-line react-hooks/exhaustive-deps -- a model's parameters never change; its object does
  }, [modelId, linked, ask]);

  const change = useCallback(
    (next: Values) => {
      setValues(keptValues(parameters, next));
      ask({ values: settledValues(parameters, next) });
    },
    [ask, parameters],
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
