/** Which direction of a file points up. Free of three.js, like layers.ts. */

export type Vec3 = readonly [number, number, number];

/** An axis of the file, or the upright axis of the model that was fitted to it. */
export type Up = "y" | "z" | "model";

const AXES: Record<"y" | "z", Vec3> = { y: [0, 1, 0], z: [0, 0, 1] };

/** Where the camera stands at first, seen from the mesh; y points up on the screen. */
export const START_DIRECTION: Vec3 = [0.75, 0.42, 1];

/** Procedural models stand on the xy plane; most meshes from elsewhere have y up. */
export const DEFAULT_UP = { model: "z", mesh: "y" } as const;

/** The choices there are, in the order in which a button walks through them. */
export function upChoices(fitted: Vec3 | null): Up[] {
  return fitted ? ["y", "z", "model"] : ["y", "z"];
}

/** The direction that a choice means; without a fit "model" falls back to y. */
export function upDirection(up: Up, fitted: Vec3 | null): Vec3 {
  return up === "model" ? (fitted ?? AXES.y) : AXES[up];
}

/** Where a fitted model's z axis points in the query's file; `rotation` is the pose's, row by row. */
export function modelUp(rotation: readonly (readonly number[])[]): Vec3 | null {
  const [x, y, z] = rotation.map((row) => row[2]);
  return x === undefined || y === undefined || z === undefined ? null : [x, y, z];
}
