import { useCallback, useRef, useState } from "react";

import { useModels, useUploadMesh, useUploadModel } from "../api/queries";
import { useCollectionSession } from "../hooks/useCollectionSession";
import { useMeshSession } from "../hooks/useMeshSession";
import { useModelSession } from "../hooks/useModelSession";
import { navigate, useRoute } from "../hooks/useRoute";
import { byClass } from "../lib/classes";
import { count, humanize } from "../lib/format";
import { MESH_ACCEPT, isModelDocument } from "../lib/meshFiles";
import { CollectionForm } from "./CollectionForm";
import { CollectionInspector } from "./CollectionInspector";
import { CollectionList } from "./CollectionList";
import { ContactSheet } from "./ContactSheet";
import { DropTarget } from "./DropTarget";
import { FitLegend, VIEW_TITLES } from "./FitLegend";
import { Header } from "./Header";
import { JobList } from "./JobList";
import { MeshInspector } from "./MeshInspector";
import { MeshList } from "./MeshList";
import { ModelInspector } from "./ModelInspector";
import { ModelList } from "./ModelList";
import { Problem } from "./Problem";
import { Stage } from "./Stage";

/** The one page: what there is on the left, a view of it in the middle, what can be done with it on the right. */
export function App() {
  const route = useRoute();
  const models = useModels();
  const upload = useUploadMesh();
  const uploadModel = useUploadModel();
  const picker = useRef<HTMLInputElement>(null);
  const [uploadError, setUploadError] = useState<{ error: unknown; fileName: string } | null>(null);

  const linkedModel = route.kind === "model" ? route.id : null;
  // Without anything in the address the first model is shown, so that the page never opens on an empty stage.
  const model =
    route.kind === "home"
      ? (byClass(models.data)[0]?.models[0] ?? null)
      : (models.data?.find(({ id }) => id === linkedModel) ?? null);
  const modelMissing = linkedModel !== null && models.isSuccess && model === null;
  const modelSession = useModelSession(model, route.kind === "model" ? route.values : undefined);
  const meshSession = useMeshSession(route);
  const { fitView } = meshSession;
  const residuals = meshSession.estimation?.result?.verdict?.residuals ?? null;
  const showsMesh = route.kind === "mesh" || route.kind === "estimation";
  const collectionSession = useCollectionSession(route);
  const showsCollection = route.kind === "collection" || route.kind === "retrieval";

  const { mutate: sendMesh } = upload;
  const { mutate: sendModel } = uploadModel;
  const receive = useCallback(
    (file: File) => {
      setUploadError(null);
      const onError = (error: unknown) => setUploadError({ error, fileName: file.name });
      if (isModelDocument(file.name)) {
        sendModel(file, { onError, onSuccess: ({ id }) => navigate({ kind: "model", id }) });
      } else {
        sendMesh(file, { onError, onSuccess: ({ id }) => navigate({ kind: "mesh", id }) });
      }
    },
    [sendMesh, sendModel],
  );

  const stage = showsMesh
    ? {
        title: meshSession.mesh?.file_name ?? "Mesh",
        subtitle: fitView.hasFit ? VIEW_TITLES[fitView.view] : "Query",
        layers: fitView.layers,
        kind: "mesh" as const,
        fittedUp: meshSession.fittedUp,
        busy: meshSession.busy,
        error: meshSession.error,
        legend: fitView.hasFit ? <FitLegend {...fitView} residuals={residuals} /> : null,
      }
    : {
        title: model ? humanize(model.name) : "Shapewright",
        ...(model ? { subtitle: count(model.parameters.length, "parameter") } : {}),
        layers: modelSession.layers,
        kind: "model" as const,
        busy: modelSession.busy,
        held: modelSession.held,
        error: modelSession.error,
      };

  return (
    <div className="page">
      <a className="skip-link" href="#inspector" onClick={(event) => {
        event.preventDefault();
        document.getElementById("inspector")?.focus();
      }}>
        Skip to the controls
      </a>
      <Header />
      <aside className="library" aria-label="Library">
        <ModelList selectedId={showsMesh || showsCollection ? null : (model?.id ?? null)} />
        <MeshList
          selectedId={showsMesh ? meshSession.meshId : null}
          onChoose={() => picker.current?.click()}
          uploading={upload.isPending ? upload.variables.name : null}
          uploadError={uploadError}
          onDismissError={() => setUploadError(null)}
        />
        <CollectionList selectedId={collectionSession.collectionId} />
        <input
          ref={picker}
          type="file"
          accept={MESH_ACCEPT}
          hidden
          data-testid="mesh-file"
          aria-label="Mesh file"
          onChange={(event) => {
            const file = event.target.files?.[0];
            if (file) receive(file);
            event.target.value = "";
          }}
        />
      </aside>
      <main className="centre">
        {showsCollection ? (
          <ContactSheet retrieval={collectionSession.retrieval} />
        ) : (
          <Stage
            {...stage}
            empty={
              models.isPending || models.error ? null : (
                <p className="muted">
                  {modelMissing ? "This model is not there (any more)." : "Add a model or upload a mesh to see it here."}
                </p>
              )
            }
          />
        )}
        <JobList />
      </main>
      <aside className="panel" id="inspector" tabIndex={-1} aria-label="Controls">
        {showsCollection ? (
          collectionSession.isNew ? (
            <CollectionForm />
          ) : collectionSession.collection ? (
            <CollectionInspector
              key={collectionSession.collection.id}
              collection={collectionSession.collection}
              retrieval={collectionSession.retrieval}
              retrievals={collectionSession.retrievals}
            />
          ) : collectionSession.error ? (
            <Problem error={collectionSession.error} />
          ) : (
            <PanelSkeleton />
          )
        ) : showsMesh ? (
          meshSession.mesh ? (
            <MeshInspector
              key={meshSession.mesh.id}
              mesh={meshSession.mesh}
              classifierId={meshSession.classifierId}
              onClassifier={meshSession.setClassifier}
              foundClass={meshSession.foundClass}
              estimation={meshSession.estimation}
              estimations={meshSession.estimations}
              answer={fitView.answer}
              onAnswer={fitView.setAnswer}
            />
          ) : meshSession.error ? (
            <Problem error={meshSession.error} />
          ) : (
            <PanelSkeleton />
          )
        ) : model ? (
          <ModelInspector
            model={model}
            values={modelSession.values}
            glb={modelSession.glb}
            onValues={modelSession.change}
            onRandom={modelSession.randomize}
            onHeld={modelSession.setHeld}
          />
        ) : models.isPending ? (
          <PanelSkeleton />
        ) : (
          <Welcome />
        )}
      </aside>
      <DropTarget onFile={receive} />
    </div>
  );
}

function PanelSkeleton() {
  return (
    <div className="inspector" role="status" aria-label="Loading">
      <div className="skeleton skeleton-row" />
      <div className="skeleton skeleton-block" />
    </div>
  );
}

function Welcome() {
  return (
    <section className="inspector">
      <h2>How it goes</h2>
      <ol className="welcome">
        <li>Add procedural models: JSON documents, one or several for each class of objects.</li>
        <li>Train a classifier on them. Their random variations are all it needs.</li>
        <li>Upload an unknown mesh, ask what it is, and let the models of its class rebuild it.</li>
        <li>Or index many meshes, and find those of a class.</li>
      </ol>
    </section>
  );
}
