import { useCallback, useSyncExternalStore } from "react";

import { formatRoute, parseRoute } from "../lib/route";
import type { Route } from "../lib/route";

const subscribe = (listener: () => void) => {
  window.addEventListener("hashchange", listener);
  return () => window.removeEventListener("hashchange", listener);
};

export function navigate(route: Route): void {
  window.location.hash = formatRoute(route);
}

/** The route in the address bar. */
export function useRoute(): Route {
  const hash = useSyncExternalStore(subscribe, useCallback(() => window.location.hash, []));
  return parseRoute(hash);
}
