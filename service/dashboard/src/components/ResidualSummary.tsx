import type { Residuals } from "../api/types";
import { residualsText, share } from "../lib/answers";
import { humanize } from "../lib/format";

/** What the model does not follow and what it invents, in all and by part of the model. */
export function ResidualSummary({ residuals }: { residuals: Residuals }) {
  const parts = residuals.by_part.toSorted((a, b) => invented(b) - invented(a));
  return (
    <div className="residuals" data-testid="residuals">
      <p>{residualsText(residuals)}</p>
      {parts.length > 1 && (
        <details>
          <summary>By part of the model</summary>
          <table>
            <thead>
              <tr>
                <th scope="col">Part</th>
                <th scope="col">Of the area</th>
                <th scope="col">Not in the mesh</th>
              </tr>
            </thead>
            <tbody>
              {parts.map((part) => (
                <tr key={part.name}>
                  <th scope="row">{humanize(part.name)}</th>
                  <td>{share(part.share_of_area)}</td>
                  <td>{share(part.invented_share)}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </details>
      )}
    </div>
  );
}

function invented(part: Residuals["by_part"][number]): number {
  return part.share_of_area * part.invented_share;
}
