/** What the metrics of a classifier tell about its training. */

export interface Learning {
  /** Mean loss of each epoch, on the pictures that were learned and on those held out. */
  trainLoss: number[];
  heldOutLoss: number[];
  /** The epoch, from 0, whose weights were kept. */
  bestEpoch: number;
  /** Share of the held-out variations that get their class. */
  heldOutAccuracy: number | null;
}

/** `null` for a classifier without curves: not trained yet, or by an older version. */
export function learningOf(metrics: Record<string, unknown> | null): Learning | null {
  const curves = metrics?.["curves"] as Record<string, unknown> | undefined;
  const trainLoss = numbers(curves?.["train_loss"]);
  const heldOutLoss = numbers(curves?.["held_out_loss"]);
  const bestEpoch = metrics?.["best_epoch"];
  const accuracy = metrics?.["held_out_accuracy"];
  if (trainLoss.length === 0 || heldOutLoss.length !== trainLoss.length || typeof bestEpoch !== "number") return null;
  return { trainLoss, heldOutLoss, bestEpoch, heldOutAccuracy: typeof accuracy === "number" ? accuracy : null };
}

function numbers(values: unknown): number[] {
  return Array.isArray(values) && values.every((value) => Number.isFinite(value)) ? (values as number[]) : [];
}

/** Corners of a polyline in a box: epochs to the right, losses upward on a logarithmic scale. */
export function curvePoints(losses: number[], range: readonly [number, number], width: number, height: number): string {
  const [low, high] = range.map(scaled) as [number, number];
  return losses
    .map((loss, epoch) => {
      const x = losses.length > 1 ? (epoch / (losses.length - 1)) * width : 0;
      const y = high > low ? height - ((scaled(loss) - low) / (high - low)) * height : height / 2;
      return `${x.toFixed(1)},${y.toFixed(1)}`;
    })
    .join(" ");
}

const LEAST_LOSS = 1e-6;

function scaled(loss: number): number {
  return Math.log10(Math.max(loss, LEAST_LOSS));
}
