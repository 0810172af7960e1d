/** What the stage is asked to draw. Free of three.js, so that the page can build it before three.js is loaded. */

export type Tone = "model" | "query" | "fit";

export interface Layer {
  id: string;
  label: string;
  tone: Tone;
  /** Binary glTF, absent while it is on its way. */
  glb: ArrayBuffer | undefined;
  /** What the bytes show: the camera is framed anew when the first layer's subject changes, and only then. */
  subject: string;
  visible: boolean;
  /** 0 to 1. */
  opacity: number;
  /** Draw this node of the file alone, in its own colors of vertices. */
  coloredNode?: string;
  /** Where the mesh stands, if not in the coordinates of the file that is looked at. */
  pose?: Placement;
  /** The mesh stands beside the first layer, as large, in coordinates of a model of its own. */
  beside?: boolean;
}

/** `scale * rotation @ point + translation`; the rotation row by row. */
export interface Placement {
  rotation: readonly (readonly number[])[];
  translation: readonly number[];
  scale: number;
}
