import type { Answer } from "../lib/answers";
import { significant } from "../lib/format";

interface AnswerChoiceProps {
  answers: Answer[];
  chosen: number;
  onChoose: (number: number) => void;
}

/** The best answer and those that fit nearly as well; choosing one shows its parameters and its mesh. */
export function AnswerChoice({ answers, chosen, onChoose }: AnswerChoiceProps) {
  return (
    <fieldset className="answers" data-testid="answers">
      <legend>Answers that fit about as well</legend>
      {answers.map(({ label, distances }, number) => (
        <label key={number}>
          <input type="radio" name="answer" checked={number === chosen} onChange={() => onChoose(number)} />
          <span>{label}</span>
          <small title="Z-buffer distance">{distances.zbuffer === null ? "–" : significant(distances.zbuffer)}</small>
        </label>
      ))}
    </fieldset>
  );
}
