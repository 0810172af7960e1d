/** One drawn point cloud: a small square for each point, as large as points on a surface are apart. */
import type { BufferGeometry } from "three";

interface CloudProps {
  geometry: BufferGeometry;
  color: string;
  opacity: number;
}

/** Width of a square, in spacings that as many points spread over the bounding sphere would have. */
const COVER = 1.1;

export function Cloud({ geometry, color, opacity }: CloudProps) {
  const radius = geometry.boundingSphere?.radius ?? 1;
  const count = Math.max(geometry.getAttribute("position").count, 1);
  return (
    <points geometry={geometry}>
      <pointsMaterial
        color={color}
        vertexColors
        size={COVER * radius * Math.sqrt((4 * Math.PI) / count)}
        sizeAttenuation
        transparent={opacity < 1}
        opacity={opacity}
      />
    </points>
  );
}
