import { describe, expect, it } from "vitest";

import { isCloud, loadGlb } from "../src/three/loadGlb";

/** A GLB file of these positions, as points or as triangles, below a node far from the origin. */
function glb(positions: number[], mode: number): ArrayBuffer {
  const body = new Float32Array(positions);
  const low = [0, 1, 2].map((axis) => Math.min(...positions.filter((_, place) => place % 3 === axis)));
  const high = [0, 1, 2].map((axis) => Math.max(...positions.filter((_, place) => place % 3 === axis)));
  const text = JSON.stringify({
    asset: { version: "2.0" },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0, translation: [500_000, 4_500_000, 0] }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, mode }] }],
    accessors: [{ bufferView: 0, componentType: 5126, count: positions.length / 3, type: "VEC3", min: low, max: high }],
    bufferViews: [{ buffer: 0, byteLength: body.byteLength, target: 34962 }],
    buffers: [{ byteLength: body.byteLength }],
  });
  const json = new TextEncoder().encode(text.padEnd(Math.ceil(text.length / 4) * 4));
  const file = new ArrayBuffer(28 + json.byteLength + body.byteLength);
  const view = new DataView(file);
  const words = [0x46546c67, 2, file.byteLength, json.byteLength, 0x4e4f534a];
  words.forEach((word, place) => view.setUint32(place * 4, word, true));
  new Uint8Array(file, 20).set(json);
  view.setUint32(20 + json.byteLength, body.byteLength, true);
  view.setUint32(24 + json.byteLength, 0x004e4942, true);
  new Uint8Array(file, 28 + json.byteLength).set(new Uint8Array(body.buffer));
  return file;
}

const CORNERS = [0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3];

describe("loadGlb", () => {
  it("takes points relative to their middle, with shades", async () => {
    const geometry = await loadGlb(glb(CORNERS, 0));
    expect(isCloud(geometry)).toBe(true);
    expect([...geometry.getAttribute("position").array]).toEqual(CORNERS);
    expect(geometry.getAttribute("color").count).toBe(4);
    expect(geometry.boundingSphere!.radius).toBeGreaterThan(1.5);
  });

  it("takes triangles in the file's own coordinates", async () => {
    const geometry = await loadGlb(glb(CORNERS.slice(0, 9), 4));
    expect(isCloud(geometry)).toBe(false);
    expect(geometry.boundingBox!.min.x).toBe(500_000);
  });
});
