import { useRef } from "react";

import { useModels } from "../api/queries";
import { useCollectionSession } from "../hooks/useCollectionSession";
import { useFirstQuestion } from "../hooks/useFirstQuestion";
import { useMeshSession } from "../hooks/useMeshSession";
import { useModelSession } from "../hooks/useModelSession";
import { useRoute } from "../hooks/useRoute";
import { count, humanize } from "../lib/format";
import { MESH_ACCEPT } from "../lib/meshFiles";
import { CollectionForm } from "./CollectionForm";
import { CollectionInspector } from "./CollectionInspector";
import { CollectionList } from "./CollectionList";
import { ContactSheet } from "./ContactSheet";
import { DropTarget } from "./DropTarget";
import { FitLegend, VIEW_TITLES } from "./FitLegend";
import { Header } from "./Header";
import { JobList } from "./JobList";
import { Legend } from "./Legend";
import { MeshInspector } from "./MeshInspector";
import { MeshList } from "./MeshList";
import { ModelInspector } from "./ModelInspector";
import { ModelList } from "./ModelList";
import { Problem } from "./Problem";
import { Stage } from "./Stage";
import { StartPage } from "./StartPage";

/** The one page: what there is on the left, a view of it in the middle, what can be done with it on the right. */
export function App() {
  const route = useRoute();
  const models = useModels();
  const question = useFirstQuestion();
  const picker = useRef<HTMLInputElement>(null);
  const choose = () => picker.current?.click();

  const isHome = route.kind === "home";
  const linkedModel = route.kind === "model" ? route.id : null;
  const model = models.data?.find(({ id }) => id === linkedModel) ?? null;
  const modelMissing = linkedModel !== null && models.isSuccess && model === null;
  const modelSession = useModelSession(model, route.kind === "model" ? route.values : undefined);
  const meshSession = useMeshSession(route);
  const { fitView } = meshSession;
  const residuals = meshSession.estimation?.result?.verdict?.residuals ?? null;
  const showsMesh = route.kind === "mesh" || route.kind === "estimation";
  const collectionSession = useCollectionSession(route);
  const controls = isHome ? "start" : "inspector";
  const showsCollection = route.kind === "collection" || route.kind === "retrieval";

  const stage = showsMesh
    ? {
        title: meshSession.mesh?.file_name ?? "Mesh",
        subtitle: fitView.hasFit
          ? VIEW_TITLES[fitView.view]
          : meshSession.neighbor.shown
            ? "Query, and the nearest variation of its class"
            : "Query",
        layers: meshSession.layers,
        kind: "mesh" as const,
        fittedUp: meshSession.fittedUp,
        busy: meshSession.busy,
        error: meshSession.error,
        legend: fitView.hasFit ? (
          <FitLegend {...fitView} legend={meshSession.legend} adjust={meshSession.adjust} residuals={residuals} />
        ) : meshSession.legend.length > 1 ? (
          <div className="fit-legend">
            <Legend entries={meshSession.legend} onChange={meshSession.adjust} />
          </div>
        ) : null,
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
    <div className="page" data-view={isHome ? "home" : "work"}>
      <a className="skip-link" href={`#${controls}`} onClick={(event) => {
        event.preventDefault();
        document.getElementById(controls)?.focus();
      }}>
        Skip to the controls
      </a>
      <Header />
      <aside className="library" aria-label="Library">
        <ModelList selectedId={model?.id ?? null} />
        <MeshList
          selectedId={showsMesh ? meshSession.meshId : null}
          onChoose={choose}
          isHome={isHome}
          busy={question.busy}
          failure={question.failure}
          onDismiss={question.dismissFailure}
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
            if (file) void question.receive(file);
            event.target.value = "";
          }}
        />
      </aside>
      <main className="centre">
        {isHome ? (
          <StartPage
            onChoose={choose}
            onSample={() => void question.receiveSample()}
            busy={question.busy}
            failure={question.failure}
            onDismiss={question.dismissFailure}
          />
        ) : showsCollection ? (
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
        <JobList hideEmpty={isHome} />
      </main>
      <aside className="panel" id="inspector" hidden={isHome} tabIndex={-1} aria-label="Controls">
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
              unaskedError={question.unaskedError(meshSession.mesh.id)}
              onClassifier={meshSession.setClassifier}
              threshold={meshSession.threshold}
              onThreshold={meshSession.setThreshold}
              neighbor={meshSession.neighbor}
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
        ) : null}
      </aside>
      <DropTarget onFile={(file) => void question.receive(file)} />
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
