import { useMeshes } from "../api/queries";
import type { Mesh } from "../api/types";
import { meshSize } from "../lib/format";
import { formatRoute } from "../lib/route";
import { Icon } from "./Icon";
import { Problem } from "./Problem";

interface MeshListProps {
  selectedId: string | null;
  onChoose: () => void;
  /** Whether the start page is open: it has its own drop zone and shows the progress itself. */
  isHome: boolean;
  busy: string | null;
  failure: { error: unknown; fileName: string } | null;
  onDismiss: () => void;
}

/** The uploaded meshes, and the button that adds one. */
export function MeshList({ selectedId, onChoose, isHome, busy, failure, onDismiss }: MeshListProps) {
  const meshes = useMeshes();
  const items = meshes.data?.pages.flatMap((page) => page.items) ?? [];
  return (
    <section className="library-section library-meshes" aria-labelledby="meshes-title">
      <div className="section-head">
        <h2 id="meshes-title">Meshes</h2>
        <button type="button" className="quiet" onClick={onChoose} disabled={busy !== null}>
          <Icon name="upload" size={14} /> Upload mesh
        </button>
      </div>
      {!isHome && busy !== null && (
        <p className="uploading" role="status">
          <span className="spinner" aria-hidden="true" /> {busy}
        </p>
      )}
      {!isHome && failure && (
        <Problem error={failure.error} onDismiss={onDismiss}>
          <p className="problem-where">
            File: <code>{failure.fileName}</code>
          </p>
        </Problem>
      )}
      {meshes.isPending && <div className="skeleton skeleton-row" role="status" aria-label="Loading meshes" />}
      {meshes.error && !meshes.data && <Problem error={meshes.error} onRetry={() => void meshes.refetch()} />}
      {meshes.isSuccess && items.length === 0 && isHome && <p className="muted">None yet.</p>}
      {meshes.isSuccess && items.length === 0 && !isHome && busy === null && (
        <button type="button" className="dropzone" onClick={onChoose}>
          <Icon name="mesh" size={22} />
          <span>
            <strong>Drop an unknown mesh here</strong>
            <br />
            or choose a file: OBJ, OFF, PLY, STL, GLB; scans: PLY, XYZ, PCD, LAS
          </span>
        </button>
      )}
      <ul className="mesh-rows">
        {items.map((mesh) => (
          <li key={mesh.id}>
            <MeshRow mesh={mesh} selected={mesh.id === selectedId} />
          </li>
        ))}
      </ul>
      {meshes.hasNextPage && (
        <button type="button" className="quiet" onClick={() => void meshes.fetchNextPage()} disabled={meshes.isFetching}>
          Show more
        </button>
      )}
    </section>
  );
}

function MeshRow({ mesh, selected }: { mesh: Mesh; selected: boolean }) {
  return (
    <a
      className="mesh-row"
      href={formatRoute({ kind: "mesh", id: mesh.id })}
      aria-current={selected ? "true" : undefined}
      title={mesh.file_name}
    >
      <span className="file-type">{mesh.file_type}</span>
      <span className="mesh-name">{mesh.file_name}</span>
      <span className="mesh-facts">{meshSize(mesh)}</span>
    </a>
  );
}
