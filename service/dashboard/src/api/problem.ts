/** What went wrong with a request, in words a person can act on. */

/** An RFC 9457 problem document, as far as the service fills it in. */
export interface Problem {
  type?: string;
  title?: string;
  status?: number;
  detail?: string;
  instance?: string;
  where?: string | null;
  /** Every place that is at fault, when there are several. */
  errors?: { where: string; detail: string }[] | null;
}

export class ApiError extends Error {
  readonly title: string;
  readonly detail: string;
  /** The place in the input that is at fault, when the service knows it. */
  readonly where: string | null;
  /** Further faults, each with its place. */
  readonly others: readonly { where: string; detail: string }[];
  /** The HTTP status, or 0 when no answer came at all. */
  readonly status: number;

  constructor(fields: { title: string; detail?: string; where?: string | null; status?: number; others?: ApiError["others"] }) {
    super(fields.detail ? `${fields.title}: ${fields.detail}` : fields.title);
    this.name = "ApiError";
    this.title = fields.title;
    this.detail = fields.detail ?? "";
    this.where = fields.where ?? null;
    this.others = fields.others ?? [];
    this.status = fields.status ?? 0;
  }

  /** The error that a refusing answer stands for; `body` is its parsed (or raw text) content. */
  static fromAnswer(status: number, statusText: string, body: unknown): ApiError {
    const problem = asProblem(body);
    if (problem?.title || problem?.detail) {
      return new ApiError({
        title: problem.title ?? `The service answered ${status}`,
        detail: problem.detail ?? "",
        where: problem.where ?? null,
        others: (problem.errors ?? []).filter((error) => error.where !== problem.where),
        status,
      });
    }
    const title = status >= 502 && status <= 504 ? "The service is not reachable" : `The service answered ${status}`;
    return new ApiError({ title, detail: statusText, status });
  }

  /** Anything that was thrown, as an ApiError. */
  static from(thrown: unknown): ApiError {
    if (thrown instanceof ApiError) return thrown;
    if (thrown instanceof TypeError) {
      // fetch() reports every network failure as a TypeError whose text differs between browsers.
      return new ApiError({
        title: "The service is not reachable",
        detail: "No answer came back. It may have stopped, or the connection was lost.",
      });
    }
    return new ApiError({ title: "Something went wrong", detail: thrown instanceof Error ? thrown.message : String(thrown) });
  }
}

function asProblem(body: unknown): Problem | null {
  if (typeof body === "object" && body !== null) return body as Problem;
  if (typeof body !== "string") return null;
  try {
    const parsed: unknown = JSON.parse(body);
    return typeof parsed === "object" && parsed !== null ? (parsed as Problem) : null;
  } catch {
    return null;
  }
}

/** Whether an exception only says that we gave up on a request ourselves. */
export function isAbort(thrown: unknown): boolean {
  return thrown instanceof DOMException && thrown.name === "AbortError";
}
