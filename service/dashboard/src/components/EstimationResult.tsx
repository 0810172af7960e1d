import type { Estimation, EstimationResult as Result, Model } from "../api/types";
import { answersOf, failedText, valuesOf } from "../lib/answers";
import { count, duration, humanize, significant } from "../lib/format";
import { formatRoute } from "../lib/route";
import { AnswerChoice } from "./AnswerChoice";
import { Icon } from "./Icon";
import { ParameterTable } from "./ParameterTable";
import { RatioList } from "./RatioList";
import { ResidualSummary } from "./ResidualSummary";

/** The thresholds the choice among the layers goes by; an estimation's own settings overrule them. */
const DEFAULT_THRESHOLDS = { surface: 0.04, zbuffer: 0.7 };

const LAYERS: Record<number, string> = {
  1: "The nearest proportions; the surfaces do not lie close enough.",
  2: "The surfaces lie close together, but seen from all sides the two differ.",
  3: "The fit looks like the mesh from all sides.",
};

interface EstimationResultProps {
  estimation: Estimation;
  models: Model[];
  /** Which of the answers is shown: 0 is the best one. */
  answer: number;
  onAnswer: (answer: number) => void;
}

/** What an estimation found: how well it fits, its parameters and what is known of them, and what else would fit. */
export function EstimationResult({ estimation, models, answer, onAnswer }: EstimationResultProps) {
  const result = estimation.result;
  if (!result) return null;
  const { layer, complete, seconds, model: found, tried, verdict, ratios, combinations } = result;
  const threshold = thresholds(estimation);
  const answers = answersOf(result);
  const shown = answers[answer] ?? answers[0]!;
  const best = shown === answers[0];
  const model = models.find(({ id }) => id === shown.model.id);
  return (
    <div className="estimate" data-testid="estimation-result">
      {!complete && (
        <p className="notice">The search was stopped before its end. This is the best it had found until then.</p>
      )}
      <div className="verdict">
        <span className="layer" data-layer={layer}>
          Layer {layer}
        </span>
        <p>{LAYERS[layer]}</p>
      </div>
      {verdict && verdict.failed.length > 0 && (
        <ul className="failed">
          {verdict.failed.map((failed) => (
            <li key={failed.name}>{failedText(failed)}</li>
          ))}
        </ul>
      )}
      <dl className="distances">
        <Distance name="Z-buffer" value={shown.distances.zbuffer} limit={threshold.zbuffer} />
        <Distance name="Surface" value={shown.distances.surface} limit={threshold.surface} />
        <Distance name="Panorama" value={shown.distances.panorama} />
        <div>
          <dt>Time</dt>
          <dd>{duration(seconds)}</dd>
        </div>
      </dl>
      {verdict?.residuals && best && <ResidualSummary residuals={verdict.residuals} />}
      {answers.length > 1 && <AnswerChoice answers={answers} chosen={answer} onChoose={onAnswer} />}
      {tried.length > 1 && <ModelsTried model={found} tried={tried} />}
      <ParameterTable parameters={shown.parameters} />
      {best && <RatioList ratios={ratios} combinations={combinations} />}
      <div className="button-row">
        {estimation.mesh_url && best && (
          <a className="button button-plain" href={estimation.mesh_url} download="fitted.glb">
            <Icon name="download" /> Fitted mesh
          </a>
        )}
        {model && (
          <a className="button button-plain" href={formatRoute({ kind: "model", id: model.id, values: valuesOf(shown) })}>
            Open in model <Icon name="arrow" />
          </a>
        )}
      </div>
    </div>
  );
}

/** Which model of the class it is, and how near each of them came. */
function ModelsTried({ model, tried }: Pick<Result, "model" | "tried">) {
  return (
    <div className="models-tried" data-testid="models-tried">
      <p>
        Rebuilt with <strong>{humanize(model.name)}</strong>, out of {count(tried.length, "model")} of the class.
      </p>
      <ol>
        {tried.map((one) => (
          <li key={one.model.id} data-chosen={one.model.id === model.id}>
            {humanize(one.model.name)} <Nearness tried={one} />
          </li>
        ))}
      </ol>
    </div>
  );
}

function Nearness({ tried }: { tried: Result["tried"][number] }) {
  const { distances, panorama } = tried;
  if (distances && distances.zbuffer !== null) {
    return <small title="Z-buffer distance of its best fit">{significant(distances.zbuffer)}</small>;
  }
  if (panorama === null) return <small>not tried</small>;
  return <small title="Panorama distance of its nearest random variation; others were nearer">given up</small>;
}

function thresholds(estimation: Estimation): typeof DEFAULT_THRESHOLDS {
  const settings = estimation.settings as Record<string, unknown>;
  const pick = (key: string, otherwise: number) => {
    const value = settings[key];
    return typeof value === "number" ? value : otherwise;
  };
  return {
    surface: pick("surface_threshold", DEFAULT_THRESHOLDS.surface),
    zbuffer: pick("zbuffer_threshold", DEFAULT_THRESHOLDS.zbuffer),
  };
}

function Distance(props: { name: string; value: Result["distances"]["surface"]; limit?: number }) {
  const { name, value, limit } = props;
  const close = limit !== undefined && value !== null && value < limit;
  return (
    <div data-close={close}>
      <dt>{name}</dt>
      <dd>
        {value === null ? "–" : significant(value)}
        {limit !== undefined && value !== null && (
          <small title={`${close ? "Below" : "Above"} the threshold ${limit}`}>
            {close ? "<" : "≥"} {limit}
          </small>
        )}
      </dd>
    </div>
  );
}
