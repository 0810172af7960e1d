/** The nearest variation of a classification: in words, and as an instance of its model. */
import type { Model, Neighbor } from "../api/types";
import { settledValues } from "./parameterSpace";
import type { Values } from "./parameterSpace";

/** The distance of the nearest variation and the usual one; for an unknown mesh, also the reason. */
export function neighborText({ distance, usual_distance: usual }: Neighbor, known: boolean): string {
  const far = distance.toFixed(2);
  if (known) {
    return `Distance ${far} from the nearest variation${usual === null ? "." : `; up to ${usual.toFixed(2)} is usual.`}`;
  }
  const where = `The nearest variation of this class is at distance ${far}`;
  if (usual === null) return `${where}.`;
  const limit = `usual for the class (up to ${usual.toFixed(2)})`;
  if (Number(far) > Number(usual.toFixed(2))) return `${where}, farther than is ${limit}.`;
  return `${where}, which is ${limit}. The pictures of the mesh do not look enough like it.`;
}

export interface NeighborInstance {
  modelId: string;
  values: Values;
}

/** The instance to request; `null` if the model was deleted or an older answer lacks the values. */
export function neighborInstance(neighbor: Neighbor | null, models: Model[] | undefined): NeighborInstance | null {
  const values = neighbor?.values ?? null;
  const model = models?.find(({ id }) => id === neighbor?.model_id);
  if (!model || values?.length !== model.parameters.length) return null;
  const named = Object.fromEntries(model.parameters.map(({ name }, index) => [name, values[index]!]));
  return { modelId: model.id, values: settledValues(model.parameters, named) };
}
