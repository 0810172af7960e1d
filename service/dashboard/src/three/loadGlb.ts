/** Binary glTF → one geometry that draws well, whatever the file was made from. */
import { BufferAttribute, BufferGeometry, Mesh, Points } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";

import { creasedNormals } from "./creasedNormals";

const loader = new GLTFLoader();

interface Part {
  positions: Float32Array;
  normals: Float32Array;
  colors: Float32Array | null;
}

/**
 * All meshes of the file, or the colored ones of one node, in one geometry, in the file's own coordinates. Where there
 * is a point cloud instead, its points relative to their middle: map coordinates have more digits than a GPU.
 */
export async function loadGlb(data: ArrayBuffer, coloredNode?: string): Promise<BufferGeometry> {
  const gltf = await loader.parseAsync(data, "");
  const parts: Part[] = [];
  const clouds: BufferGeometry[] = [];
  gltf.scene.updateMatrixWorld(true);
  gltf.scene.traverse((node) => {
    if (node instanceof Points) clouds.push(node.geometry as BufferGeometry);
    if (!(node instanceof Mesh) || (coloredNode !== undefined && node.name !== coloredNode)) return;
    const source = node.geometry as BufferGeometry;
    const placed = source.getAttribute("position").clone().applyMatrix4(node.matrixWorld);
    const index = source.getIndex()?.array ?? null;
    const colors = coloredNode === undefined ? null : cornerColors(source, index);
    parts.push({ ...creasedNormals(placed.array, index), colors });
    source.dispose();
  });
  if (parts.length === 0 && clouds[0]) return withShades(clouds[0]);
  if (parts.length === 0) throw new Error("The file holds no mesh.");

  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(join(parts.map((part) => part.positions)), 3));
  geometry.setAttribute("normal", new BufferAttribute(join(parts.map((part) => part.normals)), 3));
  const colors = parts.flatMap((part) => part.colors ?? []);
  if (colors.length > 0) geometry.setAttribute("color", new BufferAttribute(join(colors), 3));
  geometry.computeBoundingBox();
  geometry.computeBoundingSphere();
  return geometry;
}

/** Whether a geometry of `loadGlb` is points without a surface. */
export function isCloud(geometry: BufferGeometry): boolean {
  return geometry.getAttribute("normal") === undefined;
}

/** Lighter points farther from the middle, so that a cloud without normals shows some depth. */
function withShades(cloud: BufferGeometry): BufferGeometry {
  cloud.computeBoundingBox();
  cloud.computeBoundingSphere();
  const positions = cloud.getAttribute("position");
  const { center, radius } = cloud.boundingSphere!;
  const colors = new Float32Array(positions.count * 3);
  for (let point = 0; point < positions.count; point++) {
    const [x, y, z] = [positions.getX(point) - center.x, positions.getY(point) - center.y, positions.getZ(point) - center.z];
    const shade = 0.35 + (0.65 * Math.hypot(x, y, z)) / Math.max(radius, 1e-12);
    colors.fill(shade, point * 3, point * 3 + 3);
  }
  cloud.deleteAttribute("normal");
  cloud.setAttribute("color", new BufferAttribute(colors, 3));
  return cloud;
}

/** (F * 3, 3) red, green, blue, one a corner, flattened. */
function cornerColors(source: BufferGeometry, index: ArrayLike<number> | null): Float32Array {
  const colors = source.getAttribute("color");
  const count = index?.length ?? colors.count;
  const corners = new Float32Array(count * 3);
  for (let corner = 0; corner < count; corner++) {
    const vertex = index ? index[corner]! : corner;
    corners[corner * 3] = colors.getX(vertex);
    corners[corner * 3 + 1] = colors.getY(vertex);
    corners[corner * 3 + 2] = colors.getZ(vertex);
  }
  return corners;
}

function join(arrays: Float32Array[]): Float32Array {
  if (arrays.length === 1) return arrays[0]!;
  const joined = new Float32Array(arrays.reduce((length, array) => length + array.length, 0));
  let offset = 0;
  for (const array of arrays) {
    joined.set(array, offset);
    offset += array.length;
  }
  return joined;
}
