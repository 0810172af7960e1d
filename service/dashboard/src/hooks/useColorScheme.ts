import { useSyncExternalStore } from "react";

export type ColorScheme = "light" | "dark";

const query = () => window.matchMedia("(prefers-color-scheme: dark)");

const subscribe = (listener: () => void) => {
  const media = query();
  media.addEventListener("change", listener);
  return () => media.removeEventListener("change", listener);
};

/** What the person's system prefers, followed live. */
export function useColorScheme(): ColorScheme {
  return useSyncExternalStore(subscribe, () => (query().matches ? "dark" : "light"));
}
