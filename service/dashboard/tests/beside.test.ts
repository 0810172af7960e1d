import { Box3, Sphere, Vector3 } from "three";
import { expect, it } from "vitest";

import { placeBeside } from "../src/three/beside";
import { START_DIRECTION } from "../src/three/up";

const first = new Box3(new Vector3(10, -3, 5), new Vector3(12, 1, 6));
const tall = new Box3(new Vector3(-0.1, -0.1, 0), new Vector3(0.1, 0.2, 2));

it("stands on the same ground, as large, and does not touch", () => {
  const { box } = placeBeside(first, tall);
  expect(box.min.y).toBeCloseTo(first.min.y, 9);
  const radius = (one: Box3) => one.getBoundingSphere(new Sphere()).radius;
  expect(radius(box)).toBeCloseTo(radius(first), 9);
  expect(box.intersectsBox(first)).toBe(false);
});

it("turns the model's upright axis to the top of the screen, without mirroring", () => {
  const { matrix } = placeBeside(first, tall);
  const at = (x: number, y: number, z: number) => new Vector3(x, y, z).applyMatrix4(matrix);
  const up = at(0, 0, 1).sub(at(0, 0, 0));
  expect(Math.abs(up.x) + Math.abs(up.z)).toBeCloseTo(0, 9);
  expect(up.y).toBeGreaterThan(0);
  expect(matrix.determinant()).toBeGreaterThan(0);
});

it("is to the right where the camera stands first", () => {
  const { box } = placeBeside(first, tall);
  const right = new Vector3(0, 1, 0).cross(new Vector3(...START_DIRECTION));
  expect(box.getCenter(new Vector3()).sub(first.getCenter(new Vector3())).dot(right)).toBeGreaterThan(0);
});
