/** The 3D view with its tools and its legend. */
import { Suspense, lazy, useCallback, useMemo, useRef, useState } from "react";
import type { KeyboardEvent, ReactNode } from "react";

import { useColorScheme } from "../hooks/useColorScheme";
import type { CameraCommands } from "../three/CameraRig";
import type { Layer } from "../three/layers";
import { PALETTES } from "../three/palette";
import { DEFAULT_UP, upChoices, upDirection } from "../three/up";
import type { Up, Vec3 } from "../three/up";
import { ErrorBoundary } from "./ErrorBoundary";
import { Icon } from "./Icon";
import type { IconName } from "./Icon";
import { Problem } from "./Problem";

const Viewport = lazy(() => import("../three/Viewport"));

interface StageProps {
  title: string;
  subtitle?: string;
  layers: Layer[];
  /** A procedural model, or a mesh from elsewhere: they differ in what points up. */
  kind: "model" | "mesh";
  /** Where the fitted model's upright axis points, if one was fitted. */
  fittedUp?: Vec3 | null;
  busy: boolean;
  /** A slider that changes the mesh is being held. */
  held?: boolean;
  error: unknown;
  /** Shown in the middle while there is nothing to draw. */
  empty?: ReactNode;
  /** Shown in the lower left corner: legend, toggles. */
  legend?: ReactNode;
}

const UP_NAMES: Record<Up, string> = { y: "the y axis", z: "the z axis", model: "the fitted model's upright axis" };
const TURN_RAD = Math.PI / 18;

export function Stage({ title, subtitle, layers, kind, fittedUp = null, busy, held = false, error, empty, legend }: StageProps) {
  const scheme = useColorScheme();
  const [showEdges, setShowEdges] = useState(false);
  const [showGrid, setShowGrid] = useState(true);
  const [chosenUp, setChosenUp] = useState<Record<"model" | "mesh", Up>>(DEFAULT_UP);
  const [drawError, setDrawError] = useState<unknown>(null);
  const [drawn, setDrawn] = useState<{ subject: string | null; revision: number }>({ subject: null, revision: 0 });
  const camera = useRef<CameraCommands | null>(null);

  const onCamera = useCallback((commands: CameraCommands) => {
    camera.current = commands;
  }, []);
  const onDrawn = useCallback((subject: string | null) => {
    setDrawn((before) => ({ subject, revision: before.revision + 1 }));
    setDrawError(null);
  }, []);

  const onKeyDown = (event: KeyboardEvent) => {
    if (event.target !== event.currentTarget || event.ctrlKey || event.metaKey || event.altKey) return;
    const actions: Record<string, () => void> = {
      ArrowLeft: () => camera.current?.turn(-TURN_RAD, 0),
      ArrowRight: () => camera.current?.turn(TURN_RAD, 0),
      ArrowUp: () => camera.current?.turn(0, TURN_RAD),
      ArrowDown: () => camera.current?.turn(0, -TURN_RAD),
      "+": () => camera.current?.zoom(0.85),
      "=": () => camera.current?.zoom(0.85),
      "-": () => camera.current?.zoom(1 / 0.85),
      f: () => camera.current?.fit(),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  };

  const choices = upChoices(fittedUp);
  const up = choices.find((choice) => choice === chosenUp[kind]) ?? "y";
  const nextUp = choices[(choices.indexOf(up) + 1) % choices.length]!;
  const direction = useMemo(() => upDirection(up, fittedUp), [up, fittedUp]);

  const waiting = layers.length > 0 && drawn.subject === null && !error && !drawError;
  return (
    <section className="stage" aria-label="3D view" data-testid="stage">
      <div
        className="stage-canvas"
        role="application"
        aria-roledescription="3D view"
        aria-label={`${title}. Arrow keys turn, plus and minus zoom, F fits.`}
        // oxlint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- the view is turned with the arrow keys
        tabIndex={0}
        onKeyDown={onKeyDown}
        data-testid="stage-canvas"
        data-subject={drawn.subject ?? ""}
        data-revision={drawn.revision}
      >
        <ErrorBoundary
          fallback={(thrown, retry) => (
            <div className="stage-message">
              <Problem error={thrown} onRetry={retry} />
            </div>
          )}
        >
          <Suspense fallback={null}>
            <Viewport
              layers={layers}
              palette={PALETTES[scheme]}
              showEdges={showEdges}
              showGrid={showGrid}
              up={direction}
              held={held}
              onCamera={onCamera}
              onDrawn={onDrawn}
              onError={setDrawError}
            />
          </Suspense>
        </ErrorBoundary>
      </div>

      <div className="stage-title">
        <h2>{title}</h2>
        {subtitle && <p>{subtitle}</p>}
      </div>
      <div className="stage-tools" role="toolbar" aria-label="View">
        <Tool icon="fit" label="Fit the view (F)" onClick={() => camera.current?.fit()} />
        <Tool icon="edges" label="Show edges" pressed={showEdges} onClick={() => setShowEdges(!showEdges)} />
        <Tool icon="grid" label="Show the ground grid" pressed={showGrid} onClick={() => setShowGrid(!showGrid)} />
        <button
          type="button"
          className="tool tool-text"
          onClick={() => setChosenUp({ ...chosenUp, [kind]: nextUp })}
          title={`What points up: ${UP_NAMES[up]}. Next: ${UP_NAMES[nextUp]}`}
          aria-label={`What points up: ${UP_NAMES[up]}`}
        >
          <Icon name="up" /> {up === "model" ? "Fit" : up.toUpperCase()}
        </button>
      </div>
      <span className="stage-busy" data-busy={busy || waiting} aria-hidden="true" />
      {layers.length === 0 && empty && <div className="stage-message">{empty}</div>}
      {waiting && (
        <div className="stage-message" role="status">
          <p className="muted">Loading the mesh…</p>
        </div>
      )}
      {(error ?? drawError) ? (
        <div className="stage-notice">
          <Problem error={error ?? drawError} />
        </div>
      ) : null}
      {legend && <div className="stage-legend">{legend}</div>}
    </section>
  );
}

function Tool(props: { icon: IconName; label: string; pressed?: boolean; onClick: () => void }) {
  return (
    <button
      type="button"
      className="tool"
      onClick={props.onClick}
      title={props.label}
      aria-label={props.label}
      aria-pressed={props.pressed}
    >
      <Icon name={props.icon} />
    </button>
  );
}
