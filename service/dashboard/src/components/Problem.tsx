/** An error in words: what is wrong, where, and a way to try again or to put it away. */
import type { ReactNode } from "react";

import { ApiError } from "../api/problem";
import { Icon } from "./Icon";

interface ProblemProps {
  error: unknown;
  onRetry?: (() => void) | undefined;
  onDismiss?: (() => void) | undefined;
  children?: ReactNode;
}

const MOST_OTHERS = 5;

export function Problem({ error, onRetry, onDismiss, children }: ProblemProps) {
  const { title, detail, where, others } = ApiError.from(error);
  return (
    <div className="problem" role="alert">
      <Icon name="alert" />
      <div className="problem-text">
        <strong>{title}</strong>
        {detail && detail !== title && <p>{detail}</p>}
        {where && (
          <p className="problem-where">
            at <code>{where}</code>
          </p>
        )}
        {others.length > 0 && (
          <ul className="problem-others">
            {others.slice(0, MOST_OTHERS).map((other) => (
              <li key={`${other.where} ${other.detail}`}>
                <code>{other.where}</code>: {other.detail}
              </li>
            ))}
          </ul>
        )}
        {children}
        {onRetry && (
          <button type="button" className="link" onClick={onRetry}>
            Try again
          </button>
        )}
      </div>
      {onDismiss && (
        <button type="button" className="icon-button" onClick={onDismiss} aria-label="Dismiss this message">
          <Icon name="close" />
        </button>
      )}
    </div>
  );
}
