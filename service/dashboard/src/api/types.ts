/** Short names for the bodies of the REST API, all taken from the generated schema. */
import type { components } from "./schema";

type Schemas = components["schemas"];

export type Model = Schemas["ModelOut"];
export type Parameter = Schemas["ParameterOut"];
export type Condition = Schemas["ConditionOut"];
export type Mesh = Schemas["MeshOut"];
export type Job = Schemas["JobOut"];
export type JobState = Job["state"];
export type JobKind = Job["kind"];
export type Classifier = Schemas["ClassifierOut"];
export type Classification = Schemas["ClassificationOut"];
export type Neighbor = NonNullable<NonNullable<Classification["result"]>["neighbor"]>;
export type TradeOffPoint = NonNullable<Classifier["trade_off"]>[number];
export type Estimation = Schemas["EstimationOut"];
export type EstimationResult = NonNullable<Estimation["result"]>;
export type ParameterEstimate = EstimationResult["parameters"][number];
export type ParameterStatus = NonNullable<ParameterEstimate["status"]>;
export type Alternative = EstimationResult["alternatives"][number];
export type Verdict = NonNullable<EstimationResult["verdict"]>;
export type Residuals = NonNullable<Verdict["residuals"]>;
export type Pose = EstimationResult["pose"];
export type Unit = NonNullable<Schemas["EstimationIn"]["units"]>;
export type Axis = NonNullable<Schemas["EstimationIn"]["up"]>;
export type Collection = Schemas["CollectionOut"];
export type CollectionDetail = Schemas["CollectionDetailOut"];
export type Retrieval = Schemas["RetrievalOut"];
export type RetrievedMesh = NonNullable<Retrieval["result"]>["items"][number];
export type Evidence = Retrieval["evidence"];
export type Accepted = Schemas["AcceptedOut"];

export interface Page<Item> {
  items: Item[];
  next_cursor?: string | null;
}

const TERMINAL: ReadonlySet<JobState> = new Set(["succeeded", "failed", "cancelled"]);

/** Whether a job in this state will never change again. */
export function isTerminal(state: JobState): boolean {
  return TERMINAL.has(state);
}
