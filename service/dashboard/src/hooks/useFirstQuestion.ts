import { useCallback, useState } from "react";

import { useClassifications, useClassifiers, useClassify, useUploadMesh, useUploadModel } from "../api/queries";
import { readyClassifier } from "../lib/classifiers";
import { isModelDocument } from "../lib/meshFiles";
import { SAMPLE_NAME, fetchSample } from "../lib/sample";
import { navigate } from "./useRoute";

/** A file that was not taken, and why. */
export interface Failure {
  error: unknown;
  fileName: string;
}

/** A file is given: a mesh is uploaded and the ready classifier is asked what it is; a model is added. Then it is shown. */
export function useFirstQuestion() {
  const upload = useUploadMesh();
  const addModel = useUploadModel();
  const classify = useClassify();
  const classifiers = useClassifiers();
  const classifications = useClassifications();
  const [fetching, setFetching] = useState(false);
  const [failure, setFailure] = useState<Failure | null>(null);
  const [unasked, setUnasked] = useState<{ meshId: string; error: unknown } | null>(null);

  const canAsk = !classifiers.isSuccess || readyClassifier(classifiers.data.items) !== undefined;
  const asked = classifications.data?.items;
  const { mutateAsync: send } = upload;
  const { mutateAsync: sendModel } = addModel;
  const { mutateAsync: ask } = classify;

  const receive = useCallback(
    async (file: File) => {
      setFailure(null);
      setUnasked(null);
      try {
        if (isModelDocument(file.name)) {
          navigate({ kind: "model", id: (await sendModel(file)).id });
          return;
        }
        const { id: meshId } = await send(file);
        const known = asked?.some(({ mesh_id, state }) => mesh_id === meshId && state !== "failed" && state !== "cancelled");
        if (canAsk && !known) {
          // The mesh is there whether it can be asked about or not.
          await ask({ meshId, classifierId: null, fit: false }).catch((error: unknown) => setUnasked({ meshId, error }));
        }
        navigate({ kind: "mesh", id: meshId });
      } catch (error) {
        setFailure({ error, fileName: file.name });
      }
    },
    [send, sendModel, ask, asked, canAsk],
  );

  const receiveSample = useCallback(async () => {
    setFailure(null);
    setFetching(true);
    try {
      await receive(await fetchSample());
    } catch (error) {
      setFailure({ error, fileName: SAMPLE_NAME });
    } finally {
      setFetching(false);
    }
  }, [receive]);

  const busy = upload.isPending
    ? `Uploading ${upload.variables.name}…`
    : addModel.isPending
      ? `Adding ${addModel.variables.name}…`
      : fetching || classify.isPending
        ? "Asking what it is…"
        : null;
  return {
    receive,
    receiveSample,
    busy,
    failure,
    dismissFailure: useCallback(() => setFailure(null), []),
    /** Why the question about a mesh was not taken, if it was not. */
    unaskedError: (meshId: string) => (unasked?.meshId === meshId ? unasked.error : null),
  };
}
