/** The canvas. This module and what it imports are loaded on demand: three.js is most of the page's weight. */
import { Canvas } from "@react-three/fiber";

import { Scene } from "./Scene";
import type { SceneProps } from "./Scene";

export default function Viewport(props: SceneProps) {
  return (
    <Canvas
      frameloop="demand"
      dpr={[1, 2]}
      camera={{ fov: 32, position: [3, 2, 4] }}
      gl={{ antialias: true, alpha: true }}
      flat
      fallback={<p>This browser cannot draw 3D graphics (WebGL 2 is missing).</p>}
    >
      <Scene {...props} />
    </Canvas>
  );
}
