import type { EstimationResult } from "../api/types";
import { STATUS, ratioInterval } from "../lib/answers";
import { count, significant } from "../lib/format";
import { StatusMark } from "./StatusMark";

const SHOWN = 4;

/** Quotients of lengths, which hold whatever the size of the mesh, and what is known of parameters together. */
export function RatioList({ ratios, combinations }: Pick<EstimationResult, "ratios" | "combinations">) {
  if (ratios.length === 0 && combinations.length === 0) return null;
  const more = ratios.slice(SHOWN);
  return (
    <div className="ratios" data-testid="ratios">
      {ratios.length > 0 && <h4>Ratios, whatever the size of the mesh</h4>}
      <Ratios ratios={ratios.slice(0, SHOWN)} />
      {more.length > 0 && (
        <details>
          <summary>{count(more.length, "more ratio")}</summary>
          <Ratios ratios={more} />
        </details>
      )}
      {combinations.length > 0 && <h4>Known together, though not each alone</h4>}
      {combinations.map(({ label }) => (
        <p key={label}>{label}</p>
      ))}
    </div>
  );
}

function Ratios({ ratios }: Pick<EstimationResult, "ratios">) {
  return (
    <dl>
      {ratios.map(({ numerator, denominator, label, value, interval, status }) => (
        <div key={`${numerator} ${denominator}`} title={status ? STATUS[status].word : undefined}>
          <dt>
            {status && <StatusMark status={status} />} {label}
          </dt>
          <dd>
            {significant(value)} <small>{ratioInterval(interval)}</small>
          </dd>
        </div>
      ))}
    </dl>
  );
}
