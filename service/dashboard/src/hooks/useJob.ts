import { useQueryClient } from "@tanstack/react-query";
import { useEffect, useReducer } from "react";

import { initialSnapshot, reduceJob, watchJob } from "../api/jobStream";
import type { JobSignal, JobSnapshot } from "../api/jobStream";
import { api, refreshAfterJob, useJobQuery } from "../api/queries";
import { isTerminal } from "../api/types";
import type { Job } from "../api/types";

type Action = JobSignal | { type: "reset"; job: Job | undefined };

function reduce(snapshot: JobSnapshot, action: Action): JobSnapshot {
  return action.type === "reset" ? initialSnapshot(action.job) : reduceJob(snapshot, action);
}

export interface LiveJob {
  job: Job | undefined;
  snapshot: JobSnapshot;
  error: unknown;
}

/** Follow a job live; everything that it may have changed is fetched again when it ends. */
export function useJob(jobId: string | null): LiveJob {
  const client = useQueryClient();
  const { data: job, error } = useJobQuery(jobId);
  const [snapshot, dispatch] = useReducer(reduce, undefined, () => initialSnapshot());
  const known = job?.id === jobId ? job : undefined;
  const eventsUrl = known?.events_url ?? null;
  const endedWhenFetched = known !== undefined && isTerminal(known.state);

  useEffect(() => dispatch({ type: "reset", job: undefined }), [jobId]);

  useEffect(() => {
    if (known !== undefined && endedWhenFetched) dispatch({ type: "reset", job: known });
  }, [known, endedWhenFetched]);

  useEffect(() => {
    if (jobId === null || eventsUrl === null || endedWhenFetched) return;
    return watchJob({
      eventsUrl,
      fetchJob: () => api.getJob(jobId),
      onSignal: (signal) => {
        dispatch(signal);
        const ended =
          (signal.type === "state" && isTerminal(signal.state)) ||
          (signal.type === "job" && isTerminal(signal.job.state));
        const started = signal.type === "state" && signal.state === "running";
        if (ended || started) void refreshAfterJob(client);
      },
    });
  }, [jobId, eventsUrl, endedWhenFetched, client]);

  return { job: known, snapshot, error };
}
