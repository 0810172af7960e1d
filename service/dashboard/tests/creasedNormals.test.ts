import { describe, expect, it } from "vitest";

import { creasedNormals } from "../src/three/creasedNormals";

/** A tube of n rectangular sides without ends, as a soup of triangles; `turnOver` reverses every other face. */
function tube(n: number, turnOver = false): number[] {
  const soup: number[] = [];
  const point = (k: number, z: number) => [Math.cos((2 * Math.PI * k) / n), Math.sin((2 * Math.PI * k) / n), z];
  for (let k = 0; k < n; k++) {
    const faces = [
      [point(k, 0), point(k + 1, 0), point(k + 1, 1)],
      [point(k, 0), point(k + 1, 1), point(k, 1)],
    ];
    for (const face of faces) soup.push(...(turnOver && k % 2 ? face.toReversed() : face).flat());
  }
  return soup;
}

/** How far each corner's normal is from the radial direction, in degrees; the sign of the normal does not count. */
function radialErrors({ positions, normals }: { positions: Float32Array; normals: Float32Array }): number[] {
  return Array.from({ length: positions.length / 3 }, (_, k) => {
    const dot = positions[3 * k]! * normals[3 * k]! + positions[3 * k + 1]! * normals[3 * k + 1]!;
    return (Math.acos(Math.min(1, Math.abs(dot))) * 180) / Math.PI;
  });
}

describe("normals", () => {
  it("of a soup that is round are round", () => {
    expect(Math.max(...radialErrors(creasedNormals(tube(32), null)))).toBeLessThan(6);
  });

  it("do not care about windings that disagree, and follow each face's own", () => {
    const soup = tube(32, true);
    const { positions, normals } = creasedNormals(soup, null);
    expect(Math.max(...radialErrors({ positions, normals }))).toBeLessThan(6);
    const outward = (corner: number) =>
      positions[3 * corner]! * normals[3 * corner]! + positions[3 * corner + 1]! * normals[3 * corner + 1]! > 0;
    expect([outward(0), outward(6)]).toEqual([true, false]);
  });

  it("keep the edges of a box-like tube sharp", () => {
    for (const error of radialErrors(creasedNormals(tube(4), null))) expect(error).toBeCloseTo(45, 3);
  });

  it("are the same with and without an index", () => {
    const soup = tube(12);
    const points = [...new Set(Array.from({ length: soup.length / 3 }, (_, k) => soup.slice(3 * k, 3 * k + 3).join(",")))];
    const index = Array.from({ length: soup.length / 3 }, (_, k) => points.indexOf(soup.slice(3 * k, 3 * k + 3).join(",")));
    const indexed = creasedNormals(points.flatMap((point) => point.split(",").map(Number)), index);
    expect(indexed).toEqual(creasedNormals(soup, null));
  });

  it("of a fan of very many faces take no square of their time", () => {
    const count = 100_000;
    const soup = new Float32Array(count * 9);
    for (let k = 0; k < count; k++) {
      const angle = (k * 2 * Math.PI) / count;
      const next = ((k + 1) * 2 * Math.PI) / count;
      soup.set([0, 0, 0, Math.cos(angle), Math.sin(angle), 0, Math.cos(next), Math.sin(next), 0], k * 9);
    }
    const { normals } = creasedNormals(soup, null);
    expect(Array.from(normals.subarray(0, 9))).toEqual([0, 0, 1, 0, 0, 1, 0, 0, 1]);
  });

  it("of faces without area are finite", () => {
    const { normals } = creasedNormals([0, 0, 0, 0, 0, 0, 0, 0, 0], null);
    expect([...normals].every(Number.isFinite)).toBe(true);
  });
});
