/** A job's progress, live: server-sent events first, polling when a stream cannot be had. */
import { isTerminal } from "./types";
import type { Job, JobState } from "./types";

export interface JobSnapshot {
  state: JobState;
  /** 0 to 1; never goes back within one attempt of a job. */
  fraction: number;
  message: string;
  /** Sequence number of the newest event seen; older or repeated events are ignored. */
  sequence: number;
  connection: "connecting" | "live" | "reconnecting" | "polling" | "closed";
}

export type JobSignal =
  | { type: "opened" }
  | { type: "lost" }
  | { type: "polling" }
  | { type: "state"; sequence: number; state: JobState }
  | { type: "progress"; sequence: number; fraction: number; message: string }
  | { type: "job"; job: Job };

/** What is known before any event: the job as it was last fetched, or nothing. */
export function initialSnapshot(job?: Job): JobSnapshot {
  return {
    state: job?.state ?? "queued",
    fraction: clampFraction(job?.progress?.fraction ?? 0),
    message: job?.progress?.message ?? "",
    sequence: 0,
    connection: job && isTerminal(job.state) ? "closed" : "connecting",
  };
}

/** The snapshot after one more signal. Signals may be repeated, and late ones do not undo an ended job. */
export function reduceJob(snapshot: JobSnapshot, signal: JobSignal): JobSnapshot {
  const ended = isTerminal(snapshot.state);
  switch (signal.type) {
    case "opened":
      return ended ? snapshot : { ...snapshot, connection: "live" };
    case "lost":
      return ended ? snapshot : { ...snapshot, connection: "reconnecting" };
    case "polling":
      return ended ? snapshot : { ...snapshot, connection: "polling" };
    case "state": {
      if (ended || signal.sequence <= snapshot.sequence) return snapshot;
      const next: JobSnapshot = { ...snapshot, state: signal.state, sequence: signal.sequence, connection: "live" };
      if (isTerminal(signal.state)) next.connection = "closed";
      if (signal.state === "succeeded") next.fraction = 1;
      // Back in the queue means that the next attempt starts over.
      if (signal.state === "queued" && snapshot.state === "running") Object.assign(next, { fraction: 0, message: "" });
      return next;
    }
    case "progress":
      if (ended || signal.sequence <= snapshot.sequence) return snapshot;
      return {
        ...snapshot,
        fraction: clampFraction(signal.fraction),
        message: signal.message,
        sequence: signal.sequence,
        connection: "live",
      };
    case "job": {
      if (ended) return snapshot;
      const { job } = signal;
      return {
        ...snapshot,
        state: job.state,
        fraction: job.state === "succeeded" ? 1 : clampFraction(job.progress?.fraction ?? snapshot.fraction),
        message: job.progress?.message ?? snapshot.message,
        connection: isTerminal(job.state) ? "closed" : "polling", // only polls bring whole jobs
      };
    }
  }
}

function clampFraction(fraction: number): number {
  return Number.isFinite(fraction) ? Math.min(Math.max(fraction, 0), 1) : 0;
}

/** The parts of EventSource that are used here; tests bring their own. */
export interface EventStream {
  readonly readyState: number;
  addEventListener(type: string, listener: (event: MessageEvent<string>) => void): void;
  close(): void;
}

export interface JobWatchOptions {
  eventsUrl: string;
  fetchJob: () => Promise<Job>;
  onSignal: (signal: JobSignal) => void;
  openStream?: (url: string) => EventStream;
  pollInterval_ms?: number;
  /** Reconnections in a row without a single event before polling takes over. */
  maxFailures?: number;
}

const CLOSED = 2; // EventSource.CLOSED

/** Follow a job until it ends; returns the function that stops following. */
export function watchJob(options: JobWatchOptions): () => void {
  const { eventsUrl, fetchJob, onSignal, pollInterval_ms = 1500, maxFailures = 4 } = options;
  const openStream = options.openStream ?? ((url: string): EventStream => new EventSource(url));
  let stopped = false;
  let failures = 0;
  let timer: ReturnType<typeof setTimeout> | undefined;
  let stream: EventStream | null = null;

  const stop = () => {
    stopped = true;
    stream?.close();
    clearTimeout(timer);
  };

  const poll = async () => {
    try {
      const job = await fetchJob();
      if (stopped) return;
      onSignal({ type: "job", job });
      if (isTerminal(job.state)) return stop();
    } catch {
      if (!stopped) onSignal({ type: "lost" }); // the next round tries again
    }
    if (!stopped) timer = setTimeout(() => void poll(), pollInterval_ms);
  };

  const fallBack = () => {
    stream?.close();
    stream = null;
    onSignal({ type: "polling" });
    void poll();
  };

  const sequenceOf = (event: MessageEvent<string>) => Number.parseInt(event.lastEventId, 10) || 0;
  const read = <Data>(event: MessageEvent<string>): Data | null => {
    failures = 0;
    try {
      return JSON.parse(event.data) as Data;
    } catch {
      return null;
    }
  };

  try {
    stream = openStream(eventsUrl);
  } catch {
    fallBack();
    return stop;
  }
  stream.addEventListener("open", () => {
    if (!stopped) onSignal({ type: "opened" });
  });
  stream.addEventListener("error", () => {
    if (stopped || stream === null) return;
    failures += 1;
    // CLOSED: the browser gave up (an answer that is no event stream). Otherwise it reconnects with Last-Event-ID.
    if (stream.readyState === CLOSED || failures >= maxFailures) fallBack();
    else onSignal({ type: "lost" });
  });
  stream.addEventListener("state", (event) => {
    const data = read<{ state: JobState }>(event);
    if (stopped || data === null) return;
    onSignal({ type: "state", sequence: sequenceOf(event), state: data.state });
    if (isTerminal(data.state)) stop();
  });
  stream.addEventListener("progress", (event) => {
    const data = read<{ fraction: number; message: string }>(event);
    if (!stopped && data !== null) onSignal({ type: "progress", sequence: sequenceOf(event), ...data });
  });
  return stop;
}
