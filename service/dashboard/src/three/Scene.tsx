/** Everything inside the canvas: light, ground, the layers, the camera. */
import { Grid } from "@react-three/drei";
import { useFrame, useThree } from "@react-three/fiber";
import { useCallback, useEffect, useMemo, useRef, useState } from "react";
import { Box3, Matrix4, Quaternion, Sphere, Vector3 } from "three";
import type { DirectionalLight } from "three";

import { placeBeside } from "./beside";
import { CameraRig } from "./CameraRig";
import { Cloud } from "./Cloud";
import type { CameraCommands } from "./CameraRig";
import type { Layer, Placement } from "./layers";
import { isCloud } from "./loadGlb";
import type { Vec3 } from "./up";
import type { Palette } from "./palette";
import { Surface } from "./Surface";
import { useGeometry } from "./useGeometry";
import type { Decoded } from "./useGeometry";


export interface SceneProps {
  layers: Layer[];
  palette: Palette;
  showEdges: boolean;
  showGrid: boolean;
  /** The direction in the file that points up on the screen. */
  up: Vec3;
  /** A control that changes the mesh is being held: the camera stays where it is. */
  held: boolean;
  onCamera: (commands: CameraCommands) => void;
  /** Called after every change of what is drawn. */
  onDrawn: (subject: string | null) => void;
  onError: (error: unknown) => void;
}

const SCREEN_UP = new Vector3(0, 1, 0);

export function Scene({ layers, palette, showEdges, showGrid, up, held, onCamera, onDrawn, onError }: SceneProps) {
  const [decoded, setDecoded] = useState<Record<string, Decoded>>({});
  const report = useCallback((id: string, value: Decoded | null) => {
    setDecoded((before) => {
      const { [id]: _, ...others } = before;
      return value ? { ...others, [id]: value } : others;
    });
  }, []);
  const matrix = useMemo(() => {
    const turn = new Quaternion().setFromUnitVectors(new Vector3(...up).normalize(), SCREEN_UP);
    return new Matrix4().makeRotationFromQuaternion(turn);
  }, [up]);

  const first = layers[0] ? decoded[layers[0].id] : undefined;
  const subject = first?.subject ?? null;
  const companion = layers.find(({ beside, visible }) => beside && visible);
  const other = companion ? decoded[companion.id] : undefined;
  const { sphere, floor, beside } = useMemo(() => {
    if (!first?.geometry.boundingBox) return { sphere: null, floor: 0, beside: null };
    const box = new Box3().copy(first.geometry.boundingBox).applyMatrix4(matrix);
    const own = other?.geometry.boundingBox;
    const placed = own ? placeBeside(box, own) : null;
    const all = placed ? box.clone().union(placed.box) : box;
    return { sphere: all.getBoundingSphere(new Sphere()), floor: box.min.y, beside: placed };
  }, [first, other, matrix]);

  const invalidate = useThree((state) => state.invalidate);
  useEffect(() => {
    invalidate();
    onDrawn(subject);
  }, [decoded, layers, subject, onDrawn, invalidate]);

  // The grid keeps its cell while a slider moves: a power of ten near a twentieth of what was framed.
  const cell = useMemo(
    () => 10 ** Math.round(Math.log10(Math.max(sphere?.radius ?? 1, 1e-9) / 6)),
    // eslint-disable-next-line react/exhaustive-deps
    [subject, sphere === null],
  );

  return (
    <>
      <hemisphereLight args={[palette.sky, palette.ground, 1.35]} />
      <Headlights />
      <directionalLight position={[4, 6, 1]} intensity={0.7} />
      <directionalLight position={[-5, 2, -4]} intensity={0.4} />
      {showGrid && sphere && (
        <Grid
          position={[sphere.center.x, floor - sphere.radius * 0.002, sphere.center.z]}
          args={[1, 1]}
          infiniteGrid
          cellSize={cell}
          sectionSize={cell * 5}
          cellThickness={0.6}
          sectionThickness={0.9}
          cellColor={palette.gridCell}
          sectionColor={palette.gridSection}
          fadeDistance={sphere.radius * 9}
          fadeStrength={2.5}
        />
      )}
      {layers.map((layer) => (
        <group key={layer.id} matrix={layer.beside ? (beside?.matrix ?? matrix) : matrix} matrixAutoUpdate={false}>
          <LayerSurface
            layer={layer}
            palette={palette}
            showEdges={showEdges}
            onDecoded={report}
            onError={onError}
          />
        </group>
      ))}
      <CameraRig
        bounds={sphere}
        frameKey={`${subject} ${up.join(" ")}`}
        accompanied={beside !== null}
        held={held}
        onReady={onCamera}
      />
    </>
  );
}

/** A light over the viewer's left shoulder and a faint one from below, so that a mesh reads well from every side. */
function Headlights() {
  const key = useRef<DirectionalLight>(null);
  const fill = useRef<DirectionalLight>(null);
  useFrame(({ camera }) => {
    key.current?.position.set(-0.45, 0.35, 1).applyQuaternion(camera.quaternion);
    fill.current?.position.set(0.7, -0.6, 0.5).applyQuaternion(camera.quaternion);
  });
  return (
    <>
      <directionalLight ref={key} intensity={1.6} />
      <directionalLight ref={fill} intensity={0.7} />
    </>
  );
}

interface LayerSurfaceProps {
  layer: Layer;
  palette: Palette;
  showEdges: boolean;
  onDecoded: (id: string, decoded: Decoded | null) => void;
  onError: (error: unknown) => void;
}

function LayerSurface({ layer, palette, showEdges, onDecoded, onError }: LayerSurfaceProps) {
  const { id, glb, subject, coloredNode, pose } = layer;
  const decoded = useGeometry(glb, subject, onError, coloredNode);
  const matrix = useMemo(() => placement(pose), [pose]);
  useEffect(() => onDecoded(id, decoded), [id, decoded, onDecoded]);
  useEffect(() => () => onDecoded(id, null), [id, onDecoded]);
  if (!decoded || !layer.visible || layer.opacity <= 0) return null;
  return (
    <group matrix={matrix} matrixAutoUpdate={false}>
      {isCloud(decoded.geometry) ? (
        <Cloud geometry={decoded.geometry} color={palette.tones[layer.tone]} opacity={layer.opacity} />
      ) : (
        <Surface
          geometry={decoded.geometry}
          color={coloredNode === undefined ? palette.tones[layer.tone] : null}
          edgeColor={palette.edge}
          opacity={layer.opacity}
          showEdges={showEdges}
        />
      )}
    </group>
  );
}

function placement(pose: Placement | undefined): Matrix4 {
  const matrix = new Matrix4();
  if (!pose) return matrix;
  const { rotation, translation, scale } = pose;
  const row = (axis: number) => [...rotation[axis]!.map((entry) => entry * scale), translation[axis]!];
  const [a, b, c] = [row(0), row(1), row(2)] as [number[], number[], number[]];
  return matrix.set(a[0]!, a[1]!, a[2]!, a[3]!, b[0]!, b[1]!, b[2]!, b[3]!, c[0]!, c[1]!, c[2]!, c[3]!, 0, 0, 0, 1);
}
