import type { Residuals } from "../api/types";
import type { Side, View } from "../hooks/useFitView";
import { Legend } from "./Legend";
import type { LegendEntry } from "./Legend";
import { Segments } from "./Segments";

export const VIEW_TITLES: Record<View, string> = {
  overlay: "Query and fitted model, overlaid",
  fit: "Fitted model",
  residuals: "How far query and fitted model are apart",
};

/** The last color stands for so many times the tolerance, and for everything beyond. */
const TOLERANCES_SHOWN = 4;

interface FitLegendProps {
  view: View;
  setView: (view: View) => void;
  side: Side;
  setSide: (side: Side) => void;
  /** Whether there are colors of the answer that is shown. */
  residualsThere: boolean;
  residuals: Residuals | null;
  legend: LegendEntry[];
  adjust: (id: string, change: Partial<Pick<LegendEntry, "visible" | "opacity">>) => void;
}

/** How mesh and fit are shown, and what the colors mean. */
export function FitLegend(props: FitLegendProps) {
  const { view, setView, side, setSide, residualsThere, residuals, legend, adjust } = props;
  return (
    <div className="fit-legend">
      <Segments
        label="View of the fit"
        value={view}
        onChange={setView}
        options={[
          { value: "overlay", label: "Overlay" },
          { value: "fit", label: "Fit" },
          {
            value: "residuals",
            label: "Residuals",
            disabled: !residualsThere,
            title: residualsThere ? "Colors say how far the surfaces are apart" : "Only the best fit is measured",
          },
        ]}
      />
      {view === "overlay" && <Legend entries={legend} onChange={adjust} />}
      {view === "residuals" && (
        <div className="residual-key">
          <Segments
            label="Surface in colors"
            value={side}
            onChange={setSide}
            options={[
              { value: "query", label: "Query", title: "Dark: the model does not follow it" },
              { value: "fit", label: "Fitted model", title: "Dark: it is not in the query" },
            ]}
          />
          <span className="residual-scale" aria-hidden="true" />
          <p>
            <span>on the other surface</span>
            <span>{farText(residuals?.tolerance ?? null)}</span>
          </p>
        </div>
      )}
    </div>
  );
}

/** The tolerance is in units in which the mesh reaches from -1 to 1, so its half is a share of the size. */
function farText(tolerance: number | null): string {
  if (tolerance === null) return "far from it";
  return `${Math.round(TOLERANCES_SHOWN * tolerance * 50)} % of the size away`;
}
