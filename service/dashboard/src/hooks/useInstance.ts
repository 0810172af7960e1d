import { useCallback, useEffect, useRef, useState } from "react";

import type { Instance } from "../api/client";
import { LatestWins } from "../api/latestWins";
import { ApiError } from "../api/problem";
import { api } from "../api/queries";
import type { Values } from "../lib/parameterSpace";

type Ask = { values: Values } | { seed: number };

export interface LiveInstance {
  instance: (Instance & { modelId: string }) | null;
  busy: boolean;
  error: ApiError | null;
  /** Ask for the mesh of these values, or of a random variation. */
  ask: (input: Ask) => void;
}

/** The mesh of a model, following the newest values; the last good mesh stays until the next one is there. */
export function useInstance(modelId: string | null, onValues: (values: Values) => void): LiveInstance {
  const [instance, setInstance] = useState<LiveInstance["instance"]>(null);
  const [busy, setBusy] = useState(false);
  const [error, setError] = useState<ApiError | null>(null);
  const queue = useRef<LatestWins<Ask, Instance> | null>(null);
  const report = useRef(onValues);
  useEffect(() => {
    report.current = onValues;
  }, [onValues]);

  useEffect(() => {
    if (modelId === null) return;
    const requests = new LatestWins<Ask, Instance>((input, signal) => api.createInstance(modelId, input, signal), {
      onResult: (made, input) => {
        setInstance({ ...made, modelId });
        setError(null);
        if ("seed" in input) report.current(made.values);
      },
      onError: (thrown) => setError(ApiError.from(thrown)),
      onBusy: setBusy,
    });
    queue.current = requests;
    setError(null);
    return () => {
      requests.stop();
      queue.current = null;
      setBusy(false);
    };
  }, [modelId]);

  const ask = useCallback((input: Ask) => queue.current?.request(input), []);
  return { instance, busy, error, ask };
}
