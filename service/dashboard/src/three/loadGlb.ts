/** Binary glTF → one geometry that draws well, whatever the file was made from. */
import { BufferAttribute, BufferGeometry, Mesh } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";

import { creasedNormals } from "./creasedNormals";

const loader = new GLTFLoader();

/** All meshes of the file in one geometry, in the file's own coordinates. */
export async function loadGlb(data: ArrayBuffer): Promise<BufferGeometry> {
  const gltf = await loader.parseAsync(data, "");
  const parts: { positions: Float32Array; normals: Float32Array }[] = [];
  gltf.scene.updateMatrixWorld(true);
  gltf.scene.traverse((node) => {
    if (!(node instanceof Mesh)) return;
    const source = node.geometry as BufferGeometry;
    const placed = source.getAttribute("position").clone().applyMatrix4(node.matrixWorld);
    parts.push(creasedNormals(placed.array, source.getIndex()?.array ?? null));
    source.dispose();
  });
  if (parts.length === 0) throw new Error("The file holds no mesh.");

  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(join(parts.map((part) => part.positions)), 3));
  geometry.setAttribute("normal", new BufferAttribute(join(parts.map((part) => part.normals)), 3));
  geometry.computeBoundingBox();
  geometry.computeBoundingSphere();
  return geometry;
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
