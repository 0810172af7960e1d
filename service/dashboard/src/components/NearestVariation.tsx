import type { Neighbor } from "../api/types";
import type { ShownNeighbor } from "../hooks/useNeighbor";
import { neighborText } from "../lib/neighbor";
import { formatRoute } from "../lib/route";
import { Icon } from "./Icon";

interface NearestVariationProps extends ShownNeighbor {
  neighbor: Neighbor;
  /** Whether the mesh is taken for one of the classes. */
  known: boolean;
}

/** How near the nearest variation of the class is, and where to look at it. */
export function NearestVariation({ neighbor, known, instance, shown, show }: NearestVariationProps) {
  return (
    <div className="neighbor" data-testid="neighbor">
      <p>{neighborText(neighbor, known)}</p>
      {instance && (
        <div className="neighbor-actions">
          <button type="button" className="quiet" aria-pressed={shown} onClick={() => show(!shown)}>
            <Icon name={shown ? "eye" : "eyeOff"} size={14} /> Nearest variation
          </button>
          <a className="quiet" href={formatRoute({ kind: "model", id: instance.modelId, values: instance.values })}>
            Open its model <Icon name="arrow" size={14} />
          </a>
        </div>
      )}
    </div>
  );
}
