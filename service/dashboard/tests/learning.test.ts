import { describe, expect, it } from "vitest";

import { curvePoints, learningOf } from "../src/lib/learning";

const METRICS = {
  curves: { train_loss: [1, 0.1, 0.01], held_out_loss: [1, 0.2, 0.3], held_out_accuracy: [0.5, 0.9, 0.9] },
  best_epoch: 1,
  held_out_accuracy: 0.95,
};

describe("the training of a classifier", () => {
  it("is told by its curves and the epoch that was kept", () => {
    expect(learningOf(METRICS)).toEqual({
      trainLoss: [1, 0.1, 0.01],
      heldOutLoss: [1, 0.2, 0.3],
      bestEpoch: 1,
      heldOutAccuracy: 0.95,
    });
  });

  it("is not there before the training has ended, nor for what an older version trained", () => {
    expect(learningOf(null)).toBeNull();
    expect(learningOf({ held_out_accuracy: 1 })).toBeNull();
    expect(learningOf({ ...METRICS, curves: { ...METRICS.curves, held_out_loss: [1] } })).toBeNull();
    expect(learningOf({ ...METRICS, curves: { ...METRICS.curves, train_loss: [1, null, 0] } })).toBeNull();
  });
});

describe("a curve of losses", () => {
  it("runs from left to right, a tenth of the loss as far down as the next tenth", () => {
    expect(curvePoints([1, 0.1, 0.01], [0.01, 1], 100, 60)).toBe("0.0,0.0 50.0,30.0 100.0,60.0");
  });

  it("has a place for a single epoch, for equal losses and for no loss at all", () => {
    expect(curvePoints([0.5], [0.5, 0.5], 100, 60)).toBe("0.0,30.0");
    expect(curvePoints([0, 1], [0, 1], 100, 60)).toBe("0.0,60.0 100.0,0.0");
  });
});
