/** Where a mesh stands that is shown beside another one. */
import { Box3, Matrix4, Quaternion, Sphere, Vector3 } from "three";

import { START_DIRECTION } from "./up";

const SCREEN_UP = new Vector3(0, 1, 0);
/** The distance between both, in radii of the first one. */
const GAP = 0.35;

export interface Beside {
  matrix: Matrix4;
  /** What it takes up there. */
  box: Box3;
}

/**
 * Place a mesh to the right of another one as the camera first sees them: as large, upright, on the same ground.
 *
 * `first` is the box of the other mesh as it stands on the screen, `own` that of the mesh in its model's coordinates, in
 * which z points up.
 */
export function placeBeside(first: Box3, own: Box3): Beside {
  const turn = new Matrix4().makeRotationFromQuaternion(
    new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), SCREEN_UP),
  );
  const box = own.clone().applyMatrix4(turn);
  const [radius, ownRadius] = [first, box].map((one) => one.getBoundingSphere(new Sphere()).radius) as [number, number];
  const scale = radius / Math.max(ownRadius, 1e-12);
  const right = new Vector3().crossVectors(SCREEN_UP, new Vector3(...START_DIRECTION)).normalize();
  const reach = (one: Box3) => {
    const size = one.getSize(new Vector3());
    return (Math.abs(size.x * right.x) + Math.abs(size.z * right.z)) / 2;
  };
  const place = first
    .getCenter(new Vector3())
    .addScaledVector(right, reach(first) + reach(box) * scale + GAP * radius)
    .setY(first.min.y + (box.getSize(new Vector3()).y * scale) / 2);
  const matrix = new Matrix4()
    .makeTranslation(place)
    .multiply(new Matrix4().makeScale(scale, scale, scale))
    .multiply(new Matrix4().makeTranslation(box.getCenter(new Vector3()).negate()))
    .multiply(turn);
  return { matrix, box: own.clone().applyMatrix4(matrix) };
}
