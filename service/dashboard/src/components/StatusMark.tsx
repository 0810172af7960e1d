import type { ParameterStatus } from "../api/types";

/** A disc that is as full as a value is known; a bar beside it where the range ends. */
export function StatusMark({ status }: { status: ParameterStatus }) {
  return (
    <svg className="status-mark" data-status={status} width={9} height={9} viewBox="0 0 10 10" aria-hidden="true">
      <circle cx="5" cy="5" r="4" fill={status === "determined" ? "currentColor" : "none"} />
      {status === "determined_up_to_scale" && <path d="M5 1a4 4 0 0 1 0 8z" fill="currentColor" stroke="none" />}
      {status === "at_range_end" && <path d="M5 1v8" />}
    </svg>
  );
}
