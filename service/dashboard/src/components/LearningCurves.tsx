import { count, percent, significant } from "../lib/format";
import { curvePoints, learningOf } from "../lib/learning";
import type { Classifier } from "../api/types";

const WIDTH = 280;
const HEIGHT = 90;

/** How a classifier learned: the loss of each epoch, and what came of it. */
export function LearningCurves({ classifier }: { classifier: Classifier }) {
  const learning = learningOf(classifier.metrics);
  if (!learning) return null;
  const { trainLoss, heldOutLoss, bestEpoch, heldOutAccuracy } = learning;
  const all = [...trainLoss, ...heldOutLoss];
  const range = [Math.min(...all), Math.max(...all)] as const;
  const best = trainLoss.length > 1 ? (bestEpoch / (trainLoss.length - 1)) * WIDTH : 0;
  return (
    <details className="learning">
      <summary>How it learned</summary>
      <svg
        viewBox={`-4 -4 ${WIDTH + 8} ${HEIGHT + 8}`}
        role="img"
        aria-label={`Loss by epoch: ${significant(trainLoss[0]!)} to ${significant(trainLoss.at(-1)!)} on what was learned`}
      >
        <line x1={best} y1={0} x2={best} y2={HEIGHT} className="learning-best" />
        <polyline points={curvePoints(trainLoss, range, WIDTH, HEIGHT)} className="learning-train" />
        <polyline points={curvePoints(heldOutLoss, range, WIDTH, HEIGHT)} className="learning-held-out" />
      </svg>
      <p className="hint">
        Loss over {count(trainLoss.length, "epoch")}, from {significant(range[1])} to {significant(range[0])}:{" "}
        <span className="learning-key" data-curve="train">
          learned
        </span>
        ,{" "}
        <span className="learning-key" data-curve="held-out">
          held out
        </span>
        ; epoch {bestEpoch + 1} was kept.
        {heldOutAccuracy !== null && ` ${percent(heldOutAccuracy)} of the held-out variations get their class.`}
      </p>
    </details>
  );
}
