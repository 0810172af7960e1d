/** One drawn mesh: solid or see-through, from both sides, with its edges on demand. */
import { useMemo } from "react";
import { DoubleSide, EdgesGeometry } from "three";
import type { BufferGeometry } from "three";

interface SurfaceProps {
  geometry: BufferGeometry;
  /** `null` draws the colors of the vertices. */
  color: string | null;
  edgeColor: string;
  opacity: number;
  showEdges: boolean;
}

const EDGE_ANGLE_DEG = 1;

export function Surface({ geometry, color, edgeColor, opacity, showEdges }: SurfaceProps) {
  const edges = useMemo(
    () => (showEdges ? new EdgesGeometry(geometry, EDGE_ANGLE_DEG) : null),
    [geometry, showEdges],
  );
  const seeThrough = opacity < 1;
  const order = seeThrough ? 10 : 0;
  return (
    <group>
      {seeThrough && (
        // Depth first, so that only the nearest sheet of a see-through mesh is blended and its inside stays calm.
        <mesh geometry={geometry} renderOrder={order}>
          <meshBasicMaterial colorWrite={false} side={DoubleSide} transparent />
        </mesh>
      )}
      <mesh geometry={geometry} renderOrder={order + 1}>
        <meshStandardMaterial
          key={`${seeThrough ? "see-through" : "solid"} ${color === null ? "colored" : "plain"}`}
          color={color ?? "#ffffff"}
          vertexColors={color === null}
          roughness={0.72}
          metalness={0}
          side={DoubleSide}
          transparent={seeThrough}
          opacity={opacity}
          polygonOffset
          polygonOffsetFactor={seeThrough ? 0 : 1}
          polygonOffsetUnits={seeThrough ? 0 : 1}
        />
      </mesh>
      {edges && (
        <lineSegments geometry={edges} renderOrder={order + 2}>
          <lineBasicMaterial color={edgeColor} transparent opacity={0.35 * Math.max(opacity, 0.4)} />
        </lineSegments>
      )}
    </group>
  );
}
