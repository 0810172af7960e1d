/**
 * Normals for meshes of unknown make.
 *
 * Files from outside are often triangle soups: no shared vertices, no normals, windings that disagree. Corners at the
 * same place are welded, and each corner averages the faces around it whose plane lies within the crease angle of its
 * own face, so that round parts look round and edges stay edges. A neighbour with the opposite winding counts with
 * its normal turned over.
 */

export interface Corners {
  /** (F * 3, 3) positions, three corners a face, flattened. */
  positions: Float32Array;
  /** (F * 3, 3) unit normals, one a corner, flattened. */
  normals: Float32Array;
}

const MOST_NEIGHBOURS = 256;

/** Unindexed corners with smoothed normals of a triangle mesh; `index` is absent for a soup. */
export function creasedNormals(
  vertices: ArrayLike<number>,
  index: ArrayLike<number> | null,
  creaseAngle_rad = Math.PI / 5,
): Corners {
  const cornerCount = index ? index.length : vertices.length / 3;
  const faceCount = Math.floor(cornerCount / 3);
  const positions = new Float32Array(faceCount * 9);
  const normals = new Float32Array(faceCount * 9);
  const faceNormals = new Float32Array(faceCount * 3); // length = twice the area: larger faces weigh more
  const cosCrease = Math.cos(creaseAngle_rad);

  for (let corner = 0; corner < faceCount * 3; corner++) {
    const vertex = index ? index[corner]! : corner;
    for (let axis = 0; axis < 3; axis++) positions[corner * 3 + axis] = vertices[vertex * 3 + axis]!;
  }
  for (let face = 0; face < faceCount; face++) {
    const a = face * 9;
    const ux = positions[a + 3]! - positions[a]!;
    const uy = positions[a + 4]! - positions[a + 1]!;
    const uz = positions[a + 5]! - positions[a + 2]!;
    const vx = positions[a + 6]! - positions[a]!;
    const vy = positions[a + 7]! - positions[a + 1]!;
    const vz = positions[a + 8]! - positions[a + 2]!;
    faceNormals[face * 3] = uy * vz - uz * vy;
    faceNormals[face * 3 + 1] = uz * vx - ux * vz;
    faceNormals[face * 3 + 2] = ux * vy - uy * vx;
  }

  const { groupOfCorner, start, cornersByGroup } = weld(positions);
  for (let corner = 0; corner < faceCount * 3; corner++) {
    const face = (corner / 3) | 0;
    const nx = faceNormals[face * 3]!;
    const ny = faceNormals[face * 3 + 1]!;
    const nz = faceNormals[face * 3 + 2]!;
    const length = Math.hypot(nx, ny, nz);
    let x = 0;
    let y = 0;
    let z = 0;
    const group = groupOfCorner[corner]!;
    const end = start[group + 1]!;
    // The hub of a large fan touches every face of it: some of them, evenly chosen, do as well and in linear time.
    const stride = Math.ceil((end - start[group]!) / MOST_NEIGHBOURS);
    for (let k = start[group]!; k < end; k += stride) {
      const other = ((cornersByGroup[k]! / 3) | 0) * 3;
      const ox = faceNormals[other]!;
      const oy = faceNormals[other + 1]!;
      const oz = faceNormals[other + 2]!;
      const dot = nx * ox + ny * oy + nz * oz;
      if (Math.abs(dot) < cosCrease * length * Math.hypot(ox, oy, oz)) continue;
      const sign = dot < 0 ? -1 : 1;
      x += sign * ox;
      y += sign * oy;
      z += sign * oz;
    }
    const norm = Math.hypot(x, y, z) || 1;
    normals[corner * 3] = x / norm;
    normals[corner * 3 + 1] = y / norm;
    normals[corner * 3 + 2] = z / norm;
  }
  return { positions, normals };
}

/** Groups of corners at the same place (within a millionth of the largest extent), as one list cut by `start`. */
function weld(positions: Float32Array) {
  const cornerCount = positions.length / 3;
  let lowest = Infinity;
  let highest = -Infinity;
  for (const value of positions) {
    if (value < lowest) lowest = value;
    if (value > highest) highest = value;
  }
  const scale = highest > lowest ? 1e6 / (highest - lowest) : 1;

  let capacity = 16;
  while (capacity < cornerCount * 2) capacity *= 2;
  const table = new Int32Array(capacity).fill(-1); // open addressing: a corner of the group that hashed here
  const groupOfCorner = new Int32Array(cornerCount);
  let groups = 0;
  const cell = (corner: number, axis: number) => Math.round((positions[corner * 3 + axis]! - lowest) * scale);
  for (let corner = 0; corner < cornerCount; corner++) {
    const x = cell(corner, 0);
    const y = cell(corner, 1);
    const z = cell(corner, 2);
    let slot = (Math.imul(x, 73856093) ^ Math.imul(y, 19349663) ^ Math.imul(z, 83492791)) & (capacity - 1);
    for (;;) {
      const other = table[slot]!;
      if (other < 0) {
        table[slot] = corner;
        groupOfCorner[corner] = groups++;
        break;
      }
      if (cell(other, 0) === x && cell(other, 1) === y && cell(other, 2) === z) {
        groupOfCorner[corner] = groupOfCorner[other]!;
        break;
      }
      slot = (slot + 1) & (capacity - 1);
    }
  }

  const start = new Int32Array(groups + 1);
  for (const group of groupOfCorner) start[group + 1]!++;
  for (let group = 0; group < groups; group++) start[group + 1]! += start[group]!;
  const next = start.slice(0, groups);
  const cornersByGroup = new Int32Array(cornerCount);
  for (let corner = 0; corner < cornerCount; corner++) {
    const group = groupOfCorner[corner]!;
    cornersByGroup[next[group]!++] = corner;
  }
  return { groupOfCorner, start, cornersByGroup };
}
