import { useEffect, useState } from "react";
import type { BufferGeometry } from "three";

import { loadGlb } from "./loadGlb";

export interface Decoded {
  geometry: BufferGeometry;
  subject: string;
}

/** The decoded mesh of a layer; the last one stays on stage until the next one is ready. */
export function useGeometry(
  glb: ArrayBuffer | undefined,
  subject: string,
  onError: (error: unknown) => void,
  coloredNode?: string,
): Decoded | null {
  const [decoded, setDecoded] = useState<Decoded | null>(null);

  useEffect(() => {
    if (glb === undefined) return;
    let dropped = false;
    loadGlb(glb, coloredNode).then(
      (geometry) => (dropped ? geometry.dispose() : setDecoded({ geometry, subject })),
      (error: unknown) => {
        if (!dropped) onError(error);
      },
    );
    return () => {
      dropped = true;
    };
  }, [glb, subject, onError, coloredNode]);

  useEffect(() => () => decoded?.geometry.dispose(), [decoded]);
  return decoded;
}
