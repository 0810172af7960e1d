import { expect, it } from "vitest";

import { LatestWins } from "../src/api/latestWins";

/** A slow worker whose answers are given by hand. */
function manual() {
  const asked: { input: number; signal: AbortSignal; answer: (ok: boolean) => Promise<void> }[] = [];
  const log: string[] = [];
  const queue = new LatestWins<number, string>(
    (input, signal) =>
      new Promise((resolve, reject) => {
        const answer = async (ok: boolean) => {
          if (ok) resolve(`mesh ${input}`);
          else reject(new Error(`no ${input}`));
          await new Promise((done) => setTimeout(done));
        };
        asked.push({ input, signal, answer });
      }),
    {
      onResult: (output) => log.push(output),
      onError: (error) => log.push((error as Error).message),
      onBusy: (busy) => log.push(busy ? "busy" : "idle"),
    },
  );
  return { queue, asked, log };
}

it("drops what came in between and ends with the newest input", async () => {
  const { queue, asked, log } = manual();
  for (const input of [1, 2, 3]) queue.request(input);
  expect(asked.map(({ input }) => input)).toEqual([1]);
  await asked[0]!.answer(true);
  expect(asked.map(({ input }) => input)).toEqual([1, 3]);
  await asked[1]!.answer(true);
  expect(log).toEqual(["busy", "mesh 1", "mesh 3", "idle"]);
});

it("reports a failure only when nothing newer waits, and goes on afterwards", async () => {
  const { queue, asked, log } = manual();
  queue.request(1);
  queue.request(2);
  await asked[0]!.answer(false);
  await asked[1]!.answer(false);
  queue.request(3);
  await asked[2]!.answer(true);
  expect(log).toEqual(["busy", "no 2", "idle", "busy", "mesh 3", "idle"]);
});

it("is silent once stopped, and aborts what is in flight", async () => {
  const { queue, asked, log } = manual();
  queue.request(1);
  queue.request(2);
  queue.stop();
  expect(asked[0]!.signal.aborted).toBe(true);
  await asked[0]!.answer(true);
  expect(asked).toHaveLength(1);
  expect(log).toEqual(["busy"]);
});
