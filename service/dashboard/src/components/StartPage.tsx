import { useClassifiers, useModels } from "../api/queries";
import { byClass } from "../lib/classes";
import { readyClassifier } from "../lib/classifiers";
import { count, humanize } from "../lib/format";
import { formatRoute } from "../lib/route";
import { Icon } from "./Icon";
import { Problem } from "./Problem";

interface StartPageProps {
  onChoose: () => void;
  onSample: () => void;
  /** What is being done with which file; `null` if nothing is. */
  busy: string | null;
  failure: { error: unknown; fileName: string } | null;
  onDismiss: () => void;
}

/** Something to do at once: give a mesh and see what it is, or do so with the goblet that ships. */
export function StartPage({ onChoose, onSample, busy, failure, onDismiss }: StartPageProps) {
  return (
    <section className="start" id="start" tabIndex={-1} aria-labelledby="start-title">
      <div className="start-head">
        <h2 id="start-title">What is this mesh?</h2>
        <p>Shapewright tells which class a mesh belongs to, and which parameter values rebuild it.</p>
      </div>
      <button type="button" className="start-drop" onClick={onChoose} disabled={busy !== null}>
        <Icon name="mesh" size={44} />
        <strong>Drop a mesh…</strong>
        <span>or choose a file: OBJ, OFF, PLY, STL, GLB; scans: PLY, XYZ, PCD, LAS</span>
      </button>
      <p className="start-sample">
        <span>No mesh at hand?</span>
        <button type="button" className="button" onClick={onSample} disabled={busy !== null}>
          Try the goblet
        </button>
        <span className="hint">a scan with noise and holes</span>
      </p>
      <p className="start-busy" role="status">
        {busy !== null && (
          <>
            <span className="spinner" aria-hidden="true" /> {busy}
          </>
        )}
      </p>
      {failure && (
        <Problem error={failure.error} onDismiss={onDismiss}>
          <p className="problem-where">
            File: <code>{failure.fileName}</code>
          </p>
        </Problem>
      )}
      <KnownClasses />
    </section>
  );
}

/** The classes that the classifier tells apart, each with the picture of one of its models. */
function KnownClasses() {
  const classifiers = useClassifiers();
  const models = useModels();
  if (!classifiers.isSuccess || !models.isSuccess) return null;
  const ready = readyClassifier(classifiers.data.items);
  if (!ready) {
    return (
      <p className="muted">
        There is no classifier yet. You can drop a mesh anyway, look at it, and train a classifier from its page.
      </p>
    );
  }
  const classes = new Map(byClass(models.data).map((one) => [one.name, one.models]));
  return (
    <div className="start-classes">
      <h3>
        The classifier knows {count(ready.class_names.length, "class", "classes")}, and says when a mesh is of none of them
      </h3>
      <ul>
        {ready.class_names.map((name) => {
          const model = classes.get(name)?.[0];
          return (
            <li key={name}>
              {model ? (
                <a href={formatRoute({ kind: "model", id: model.id })}>
                  <span className="start-picture">
                    {model.thumbnail_url && <img src={model.thumbnail_url} alt="" loading="lazy" decoding="async" />}
                  </span>
                  {humanize(name)}
                </a>
              ) : (
                humanize(name)
              )}
            </li>
          );
        })}
      </ul>
    </div>
  );
}
