/** Which files the page offers to upload. The service has the last word: it reads them and says what is wrong. */

export const MESH_EXTENSIONS = ["obj", "off", "ply", "stl", "glb", "gltf"] as const;
export const POINT_EXTENSIONS = ["xyz", "pts", "pcd", "las", "laz", "asc", "csv", "txt"] as const;
export const MESH_ACCEPT = [...MESH_EXTENSIONS, ...POINT_EXTENSIONS].map((extension) => `.${extension}`).join(",");

export function extensionOf(fileName: string): string {
  const dot = fileName.lastIndexOf(".");
  return dot < 0 ? "" : fileName.slice(dot + 1).toLowerCase();
}

export function isModelDocument(fileName: string): boolean {
  return extensionOf(fileName) === "json";
}
