import { ApiError } from "../api/problem";
import { useReady } from "../api/queries";

/** The name of the page and whether the service answers. */
export function Header() {
  const { isSuccess, isError, isPending, error } = useReady();
  const state = isPending ? "pending" : isSuccess && !isError ? "up" : "down";
  const away = error instanceof ApiError && (error.status === 0 || error.status === 502 || error.status === 504);
  const text = { pending: "Connecting…", up: "Service ready", down: away ? "Service not reachable" : "Service not ready" }[state];
  return (
    <header className="header">
      <a className="brand" href="#/" aria-label="Shapewright, start page">
        <svg width="24" height="24" viewBox="0 0 32 32" aria-hidden="true">
          <rect width="32" height="32" rx="7" className="brand-tile" />
          <g fill="none" stroke="#fff" strokeWidth="2" strokeLinejoin="round" strokeLinecap="round">
            <path d="M16 6.5 24.5 11v10L16 25.5 7.5 21V11z" />
            <path d="M7.5 11 16 15.5 24.5 11M16 15.5v10" opacity=".65" />
          </g>
        </svg>
        <h1>Shapewright</h1>
      </a>
      <p className="tagline">Procedural models, and what they say about an unknown mesh</p>
      <p className={`service service-${state}`} role="status">
        <span className="dot" aria-hidden="true" />
        {text}
      </p>
      <a className="header-link" href="/openapi.json" title="The OpenAPI document of the service">
        API
      </a>
    </header>
  );
}
