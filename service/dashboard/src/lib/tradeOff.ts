/** The trade-off behind a threshold, as the training of a classifier measured it. */
import type { TradeOffPoint } from "../api/types";

/** `Accepts about 93 % of the objects of a class and refuses about 87 % of all others.`; `null` if it is not known. */
export function tradeOffText(points: TradeOffPoint[] | null, threshold: number): string | null {
  const nearest = (points ?? []).reduce<TradeOffPoint | null>(
    (best, point) =>
      best !== null && Math.abs(best.threshold - threshold) <= Math.abs(point.threshold - threshold) ? best : point,
    null,
  );
  if (nearest === null) return null;
  const [accepted, refused] = [nearest.accepted_known, nearest.refused_other].map((share) => Math.round(share * 100));
  return `Accepts about ${accepted} % of the objects of a class and refuses about ${refused} % of all others.`;
}
