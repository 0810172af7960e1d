/** Orbit controls that frame a subject once and leave the camera alone afterwards. */
import { OrbitControls } from "@react-three/drei";
import { useThree } from "@react-three/fiber";
import { useCallback, useEffect, useLayoutEffect, useRef } from "react";
import { Frustum, Matrix4, Spherical, Vector3 } from "three";
import type { PerspectiveCamera, Sphere } from "three";
import type { ElementRef } from "react";

export interface CameraCommands {
  fit: () => void;
  turn: (azimuth_rad: number, elevation_rad: number) => void;
  zoom: (factor: number) => void;
}

interface CameraRigProps {
  /** Sphere around what is shown. */
  bounds: Sphere | null;
  /** The camera is framed anew when this changes. */
  frameKey: string;
  /** When this changes the camera backs off if the sphere is not all in view. */
  settleKey: string;
  onReady: (commands: CameraCommands) => void;
}

/** Whether the whole sphere lies inside the sides of the view (a tenth may stick out). */
function isInView(camera: PerspectiveCamera, sphere: Sphere): boolean {
  camera.updateMatrixWorld();
  const frustum = new Frustum().setFromProjectionMatrix(
    new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse),
  );
  return frustum.planes.slice(0, 4).every((plane) => plane.distanceToPoint(sphere.center) > sphere.radius * 0.9);
}

const START_DIRECTION = new Vector3(0.75, 0.42, 1).normalize();

export function CameraRig({ bounds, frameKey, settleKey, onReady }: CameraRigProps) {
  const camera = useThree((state) => state.camera) as PerspectiveCamera;
  const size = useThree((state) => state.size);
  const invalidate = useThree((state) => state.invalidate);
  const controls = useRef<ElementRef<typeof OrbitControls>>(null);
  const latest = useRef({ bounds, size });
  useLayoutEffect(() => {
    latest.current = { bounds, size };
  }, [bounds, size]);

  const frame = useCallback(
    (direction: Vector3) => {
      const { bounds: sphere, size: canvas } = latest.current;
      if (!sphere || !controls.current) return;
      const radius = Math.max(sphere.radius, 1e-9);
      const halfVertical = ((camera.fov / 2) * Math.PI) / 180;
      const halfHorizontal = Math.atan(Math.tan(halfVertical) * (canvas.width / Math.max(canvas.height, 1)));
      const distance = (radius / Math.sin(Math.min(halfVertical, halfHorizontal))) * 1.08;
      camera.near = distance / 200;
      camera.far = distance * 40;
      camera.position.copy(sphere.center).addScaledVector(direction, distance);
      camera.updateProjectionMatrix();
      controls.current.target.copy(sphere.center);
      controls.current.minDistance = radius * 0.2;
      controls.current.maxDistance = distance * 12;
      controls.current.update();
      invalidate();
    },
    [camera, invalidate],
  );

  const hasBounds = bounds !== null;
  useEffect(() => {
    if (hasBounds) frame(START_DIRECTION);
  }, [frameKey, hasBounds, frame]);

  useEffect(() => {
    const sphere = latest.current.bounds;
    if (settleKey === "" || !sphere || !controls.current) return;
    if (!isInView(camera, sphere)) frame(camera.position.clone().sub(controls.current.target).normalize());
  }, [settleKey, camera, frame]);

  useEffect(() => {
    const offset = () => camera.position.clone().sub(controls.current!.target);
    const move = (change: (spherical: Spherical) => void) => {
      if (!controls.current) return;
      const spherical = new Spherical().setFromVector3(offset());
      change(spherical);
      spherical.makeSafe();
      camera.position.copy(controls.current.target).add(new Vector3().setFromSpherical(spherical));
      controls.current.update();
      invalidate();
    };
    onReady({
      fit: () => frame(controls.current ? offset().normalize() : START_DIRECTION),
      turn: (azimuth, elevation) =>
        move((spherical) => {
          spherical.theta += azimuth;
          spherical.phi -= elevation;
        }),
      zoom: (factor) => move((spherical) => (spherical.radius *= factor)),
    });
  }, [camera, frame, invalidate, onReady]);

  return <OrbitControls ref={controls} makeDefault enableDamping={false} zoomSpeed={0.7} rotateSpeed={0.8} />;
}
