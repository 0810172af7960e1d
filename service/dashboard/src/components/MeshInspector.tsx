import type { Estimation, Mesh } from "../api/types";
import type { ShownNeighbor } from "../hooks/useNeighbor";
import { count, meshSize, significant } from "../lib/format";
import { ClassificationPanel } from "./ClassificationPanel";
import { EstimationPanel } from "./EstimationPanel";

interface MeshInspectorProps {
  mesh: Mesh;
  classifierId: string | null;
  onClassifier: (id: string) => void;
  /** Why it was not asked what the mesh is when it was uploaded; `null` if it was. */
  unaskedError: unknown;
  /** Below it a mesh is unknown. */
  threshold: number;
  onThreshold: (threshold: number) => void;
  neighbor: ShownNeighbor;
  foundClass: string | null;
  estimation: Estimation | undefined;
  estimations: Estimation[];
  /** Which of the estimation's answers is shown: 0 is the best one. */
  answer: number;
  onAnswer: (answer: number) => void;
}

/** What is known about an unknown mesh, and the two questions that can be asked about it. */
export function MeshInspector(props: MeshInspectorProps) {
  const { mesh, classifierId, onClassifier, unaskedError, threshold, onThreshold, neighbor } = props;
  const { foundClass, estimation, estimations, answer, onAnswer } = props;
  const isCloud = mesh.kind === "point_cloud";
  return (
    <section className="inspector" aria-label="Mesh">
      <div className="inspector-head">
        <p className="eyebrow">{isCloud ? "Unknown point cloud" : "Unknown mesh"}</p>
        <h2 className="file-name">{mesh.file_name}</h2>
        <dl className="facts">
          <div>
            <dt>Size</dt>
            <dd title={`${count(mesh.vertex_count, "vertex", "vertices")}`}>{meshSize(mesh)}</dd>
          </div>
          <div>
            <dt>Extent</dt>
            <dd>{extent(mesh)}</dd>
          </div>
          <div>
            <dt>Surface</dt>
            <dd>{isCloud ? "None: points" : mesh.watertight ? "Closed" : "Open"}</dd>
          </div>
        </dl>
      </div>
      <ClassificationPanel
        meshId={mesh.id}
        classifierId={classifierId}
        onClassifier={onClassifier}
        unaskedError={unaskedError}
        threshold={threshold}
        onThreshold={onThreshold}
        neighbor={neighbor}
      />
      {isCloud ? (
        <p className="muted">
          A point cloud can be classified, and looked up in a collection. Rebuilding needs a mesh with faces.
        </p>
      ) : (
        <EstimationPanel
          meshId={mesh.id}
          foundClass={foundClass}
          estimation={estimation}
          estimations={estimations}
          answer={answer}
          onAnswer={onAnswer}
        />
      )}
    </section>
  );
}

function extent(mesh: Mesh): string {
  const [low = [], high = []] = mesh.bounds;
  return [0, 1, 2].map((axis) => significant((high[axis] ?? 0) - (low[axis] ?? 0), 2)).join(" × ");
}
