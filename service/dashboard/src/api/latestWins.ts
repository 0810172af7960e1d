/**
 * Runs one request at a time and always ends with the newest input.
 *
 * A slider asks for a mesh far more often than the service can make one. Cancelling each request for the next would
 * show nothing until the hand rests; queueing them all would lag behind it. So one request is in flight, the newest
 * input waits, and what came in between is dropped.
 */
export class LatestWins<Input, Output> {
  #running: AbortController | null = null;
  #waiting: { input: Input } | null = null;

  constructor(
    private readonly run: (input: Input, signal: AbortSignal) => Promise<Output>,
    private readonly listener: {
      onResult: (output: Output, input: Input) => void;
      onError: (error: unknown, input: Input) => void;
      onBusy?: (busy: boolean) => void;
    },
  ) {}

  /** Ask for the output of this input; an older one that still waits is forgotten. */
  request(input: Input): void {
    this.#waiting = { input };
    if (this.#running === null) void this.#drain();
  }

  /** Abort what is in flight and forget what waits; nothing is reported afterwards. */
  stop(): void {
    this.#waiting = null;
    this.#running?.abort();
    this.#running = null;
  }

  async #drain(): Promise<void> {
    const controller = new AbortController();
    this.#running = controller;
    this.listener.onBusy?.(true);
    while (this.#waiting !== null && this.#running === controller) {
      const { input } = this.#waiting;
      this.#waiting = null;
      try {
        const output = await this.run(input, controller.signal);
        if (this.#running === controller) this.listener.onResult(output, input);
      } catch (error) {
        // A newer input makes an older failure uninteresting.
        if (this.#running === controller && this.#waiting === null) this.listener.onError(error, input);
      }
    }
    if (this.#running === controller) {
      this.#running = null;
      this.listener.onBusy?.(false);
    }
  }
}
