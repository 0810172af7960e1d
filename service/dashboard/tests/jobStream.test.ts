import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { initialSnapshot, reduceJob, watchJob } from "../src/api/jobStream";
import type { EventStream, JobSignal } from "../src/api/jobStream";
import type { Job, JobState } from "../src/api/types";

function job(state: JobState, fraction = 0): Job {
  return {
    id: "j1", parent_id: null, kind: "estimate", state, attempt: 1, max_attempts: 3, cancel_requested: false,
    progress: { fraction, message: "working" }, error: null, result_url: null, url: "/v1/jobs/j1",
    events_url: "/v1/jobs/j1/events", created_at: "2025-03-01T10:00:00Z", started_at: null, finished_at: null,
  }; // prettier-ignore
}

const play = (...signals: JobSignal[]) => signals.reduce(reduceJob, initialSnapshot());

describe("the snapshot of a job", () => {
  const running: JobSignal = { type: "state", sequence: 2, state: "running" };
  const half: JobSignal = { type: "progress", sequence: 3, fraction: 0.5, message: "Layer 2" };

  it("follows the events", () => {
    expect(play({ type: "opened" }, running, half)).toMatchObject({
      state: "running", fraction: 0.5, message: "Layer 2", connection: "live", // prettier-ignore
    });
  });

  it("is not moved by events that are replayed after a reconnection", () => {
    const before = play(running, half);
    expect(reduceJob(reduceJob(before, running), half)).toEqual(before);
  });

  it("starts over when the job goes back to the queue", () => {
    expect(play(running, half, { type: "state", sequence: 4, state: "queued" })).toMatchObject({
      state: "queued", fraction: 0, message: "", // prettier-ignore
    });
  });

  it("stays ended", () => {
    const ended = play(running, { type: "state", sequence: 9, state: "succeeded" });
    expect(ended).toMatchObject({ fraction: 1, connection: "closed" });
    for (const late of [half, { type: "lost" }, { type: "job", job: job("running", 0.2) }] as JobSignal[]) {
      expect(reduceJob(ended, late)).toEqual(ended);
    }
  });

  it("says when it polls, and when even that is not answered", () => {
    const polled: JobSignal = { type: "job", job: job("running", 0.4) };
    expect(play({ type: "polling" }, polled, { type: "lost" }).connection).toBe("reconnecting");
    expect(play({ type: "lost" }, polled)).toMatchObject({ connection: "polling", fraction: 0.4, state: "running" });
  });

  it("keeps fractions between 0 and 1", () => {
    const at = (fraction: number) => play({ type: "progress", sequence: 1, fraction, message: "" }).fraction;
    expect([at(-1), at(2), at(Number.NaN)]).toEqual([0, 1, 0]);
  });
});

class FakeStream implements EventStream {
  readyState = 0;
  closed = false;
  readonly #listeners = new Map<string, (event: MessageEvent<string>) => void>();

  addEventListener(type: string, listener: (event: MessageEvent<string>) => void) {
    this.#listeners.set(type, listener);
  }
  close() {
    this.closed = true;
  }
  send(type: string, id: number, data: unknown) {
    const text = typeof data === "string" ? data : JSON.stringify(data);
    this.#listeners.get(type)?.(new MessageEvent(type, { data: text, lastEventId: String(id) }));
  }
  fail(readyState: number) {
    this.readyState = readyState;
    this.send("error", 0, "");
  }
}

describe("following a job", () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  function follow(fetched: (Job | Error)[] = []) {
    const stream = new FakeStream();
    const signals: JobSignal[] = [];
    const stop = watchJob({
      eventsUrl: "/v1/jobs/j1/events",
      openStream: () => stream,
      fetchJob: async () => {
        const next = fetched.shift() ?? job("running");
        if (next instanceof Error) throw next;
        return next;
      },
      onSignal: (signal) => signals.push(signal),
      pollInterval_ms: 1000,
      maxFailures: 3,
    });
    return { stream, signals, stop };
  }

  it("closes the stream when the job has ended", () => {
    const { stream, signals } = follow();
    stream.send("state", 1, { state: "running" });
    stream.send("progress", 2, { fraction: 0.1, message: "Layer 1" });
    stream.send("progress", 3, "not json");
    expect(stream.closed).toBe(false);
    stream.send("state", 4, { state: "succeeded" });
    expect(stream.closed).toBe(true);
    stream.fail(0);
    expect(signals.map(({ type }) => type)).toEqual(["state", "progress", "state"]);
  });

  it("leaves short interruptions to the browser, which resumes after the last event", () => {
    const { stream, signals } = follow();
    stream.fail(0);
    stream.fail(0);
    stream.send("progress", 5, { fraction: 0.2, message: "" });
    stream.fail(0);
    stream.fail(0);
    expect(stream.closed).toBe(false);
    expect(signals.at(-1)).toEqual({ type: "lost" });
  });

  it("polls when the answer is no event stream, survives a lost poll, and stops at the end", async () => {
    const { stream, signals } = follow([job("running", 0.4), new TypeError("away"), job("failed")]);
    stream.fail(2);
    await vi.advanceTimersByTimeAsync(0);
    expect(stream.closed).toBe(true);
    await vi.advanceTimersByTimeAsync(5000);
    expect(signals).toEqual([
      { type: "polling" },
      { type: "job", job: job("running", 0.4) },
      { type: "lost" },
      { type: "job", job: job("failed") },
    ]);
    expect(vi.getTimerCount()).toBe(0);
  });

  it("polls after too many reconnections in a row", () => {
    const { stream, signals } = follow();
    for (let k = 0; k < 3; k++) stream.fail(0);
    expect(signals.map(({ type }) => type)).toEqual(["lost", "lost", "polling"]);
  });

  it("says nothing after it was stopped", async () => {
    const { stream, signals, stop } = follow();
    stream.fail(2);
    stop();
    await vi.advanceTimersByTimeAsync(5000);
    expect(signals).toEqual([{ type: "polling" }]);
  });
});
