/** Orbit controls that frame a subject once and then leave the camera to the viewer. */
import { OrbitControls } from "@react-three/drei";
import { useThree } from "@react-three/fiber";
import { useCallback, useEffect, useLayoutEffect, useRef } from "react";
import { Frustum, Matrix4, Spherical, Vector3 } from "three";
import type { PerspectiveCamera, Sphere } from "three";
import type { ElementRef } from "react";

import { START_DIRECTION } from "./up";

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
  /** Something stands beside the subject: the camera frames both when it comes, and the subject when it goes. */
  accompanied: boolean;
  /** A control that changes the mesh is being held: the camera stays where it is. */
  held: boolean;
  onReady: (commands: CameraCommands) => void;
}

const START = new Vector3(...START_DIRECTION).normalize();
const MARGIN = 1.08;
const GLIDE_MS = 320;

/** Whether the whole sphere lies inside the sides of the view (a tenth may stick out). */
function isInView(camera: PerspectiveCamera, sphere: Sphere): boolean {
  camera.updateMatrixWorld();
  const frustum = new Frustum().setFromProjectionMatrix(
    new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse),
  );
  return frustum.planes.slice(0, 4).every((plane) => plane.distanceToPoint(sphere.center) > sphere.radius * 0.9);
}

export function CameraRig({ bounds, frameKey, accompanied, held, onReady }: CameraRigProps) {
  const camera = useThree((state) => state.camera) as PerspectiveCamera;
  const size = useThree((state) => state.size);
  const invalidate = useThree((state) => state.invalidate);
  const controls = useRef<ElementRef<typeof OrbitControls>>(null);
  const gliding = useRef(0);
  const settled = useRef<Sphere | null>(null);
  const latest = useRef({ bounds, size });
  useLayoutEffect(() => {
    latest.current = { bounds, size };
  }, [bounds, size]);

  const stopGliding = useCallback(() => cancelAnimationFrame(gliding.current), []);

  const frame = useCallback(
    (direction: Vector3 | null, glide: boolean) => {
      const { bounds: sphere, size: canvas } = latest.current;
      const orbit = controls.current;
      if (!sphere || !orbit) return;
      const radius = Math.max(sphere.radius, 1e-9);
      const halfVertical = ((camera.fov / 2) * Math.PI) / 180;
      const halfHorizontal = Math.atan(Math.tan(halfVertical) * (canvas.width / Math.max(canvas.height, 1)));
      const distance = (radius / Math.sin(Math.min(halfVertical, halfHorizontal))) * MARGIN;
      const towards = direction ?? camera.position.clone().sub(orbit.target).normalize();
      const end = sphere.center.clone().addScaledVector(towards, distance);
      camera.near = distance / 200;
      camera.far = distance * 40;
      camera.updateProjectionMatrix();
      orbit.minDistance = radius * 0.2;
      orbit.maxDistance = distance * 12;

      const startPosition = camera.position.clone();
      const startTarget = orbit.target.clone();
      const place = (share: number) => {
        camera.position.lerpVectors(startPosition, end, share);
        orbit.target.lerpVectors(startTarget, sphere.center, share);
        orbit.update();
        invalidate();
      };
      stopGliding();
      if (!glide || window.matchMedia("(prefers-reduced-motion: reduce)").matches) return place(1);
      const begun = performance.now();
      const step = (now: number) => {
        const time = Math.min(Math.max((now - begun) / GLIDE_MS, 0), 1);
        place(time * time * (3 - 2 * time));
        if (time < 1) gliding.current = requestAnimationFrame(step);
      };
      gliding.current = requestAnimationFrame(step);
    },
    [camera, invalidate, stopGliding],
  );

  const hasBounds = bounds !== null;
  useEffect(() => {
    if (hasBounds) frame(START, false);
  }, [frameKey, hasBounds, frame]);

  const wasAccompanied = useRef(accompanied);
  useEffect(() => {
    if (wasAccompanied.current !== accompanied) frame(null, true);
    wasAccompanied.current = accompanied;
  }, [accompanied, frame]);

  // A mesh that was all in view and has outgrown it is followed, once the hand is off the slider. A viewer who had
  // come closer to look at a part is left alone.
  useEffect(() => {
    if (held || bounds === null) return;
    const before = settled.current;
    if (before && isInView(camera, before) && !isInView(camera, bounds)) frame(null, true);
    settled.current = bounds;
  }, [bounds, held, camera, frame]);

  useEffect(() => {
    const move = (change: (spherical: Spherical) => void) => {
      const orbit = controls.current;
      if (!orbit) return;
      stopGliding();
      const spherical = new Spherical().setFromVector3(camera.position.clone().sub(orbit.target));
      change(spherical);
      spherical.makeSafe();
      camera.position.copy(orbit.target).add(new Vector3().setFromSpherical(spherical));
      orbit.update();
      invalidate();
    };
    onReady({
      fit: () => frame(null, true),
      turn: (azimuth, elevation) =>
        move((spherical) => {
          spherical.theta += azimuth;
          spherical.phi -= elevation;
        }),
      zoom: (factor) => move((spherical) => (spherical.radius *= factor)),
    });
    return stopGliding;
  }, [camera, frame, invalidate, onReady, stopGliding]);

  return (
    <OrbitControls
      ref={controls}
      makeDefault
      enableDamping={false}
      zoomSpeed={0.7}
      rotateSpeed={0.8}
      onStart={stopGliding}
    />
  );
}
