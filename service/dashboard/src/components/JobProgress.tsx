import { ApiError } from "../api/problem";
import { useCancel } from "../api/queries";
import { isTerminal } from "../api/types";
import type { LiveJob } from "../hooks/useJob";
import { useNow } from "../hooks/useNow";
import { jobState, parseTime, wholeDuration } from "../lib/format";
import { Problem } from "./Problem";

/** A running job: what it does now, how far it is, and the button that stops it. Nothing once it has succeeded. */
export function JobProgress({ live, label }: { live: LiveJob; label: string }) {
  const { job, snapshot, error } = live;
  const cancel = useCancel();
  const active = job !== undefined && !isTerminal(snapshot.state);
  const now = useNow(1000, active);
  if (error) return <Problem error={error} />;
  if (!job) return <div className="skeleton skeleton-row" role="status" aria-label="Loading the job" />;
  if (snapshot.state === "failed") {
    const { title, detail, where } = job.error ?? { title: `${label}: failed`, detail: "", where: null };
    return <Problem error={new ApiError({ title, detail, where: where ?? null })} />;
  }
  if (!active) return null;

  const elapsed_s = (now.getTime() - parseTime(job.started_at ?? job.created_at).getTime()) / 1000;
  const percentDone = Math.round(snapshot.fraction * 100);
  const cancelling = job.cancel_requested || cancel.isPending || cancel.isSuccess;
  const state = cancelling ? "Cancelling…" : snapshot.state === "queued" ? "Waiting for a worker" : snapshot.message;
  return (
    <div className="job" data-state={snapshot.state} data-testid="job-progress">
      <div className="job-line">
        <strong>{label}</strong>
        <span className="job-percent">{snapshot.state === "running" ? `${percentDone} %` : jobState(snapshot.state)}</span>
      </div>
      <div
        className="bar"
        role="progressbar"
        aria-label={label}
        aria-valuemin={0}
        aria-valuemax={100}
        aria-valuenow={percentDone}
        aria-valuetext={`${percentDone} %, ${state}`}
        data-indeterminate={snapshot.state === "queued"}
      >
        <span style={{ width: `${percentDone}%` }} />
      </div>
      <div className="job-line">
        <span className="job-message" aria-live="polite">
          {state || "Running"}
        </span>
        <span className="job-time">{wholeDuration(elapsed_s)}</span>
      </div>
      <div className="job-line">
        <span className="job-connection">{CONNECTION[snapshot.connection]}</span>
        <button type="button" className="quiet" disabled={cancelling} onClick={() => cancel.mutate(job.id)}>
          {cancelling ? "Cancelling…" : "Cancel"}
        </button>
      </div>
      {cancel.error && <Problem error={cancel.error} onDismiss={() => cancel.reset()} />}
    </div>
  );
}

const CONNECTION = {
  connecting: "",
  live: "",
  reconnecting: "Connection lost, reconnecting…",
  polling: "Updating every few seconds",
  closed: "",
} as const;
