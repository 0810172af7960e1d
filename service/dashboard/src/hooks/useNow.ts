import { useEffect, useState } from "react";

/** The time, renewed every `interval_ms`; stands still while `active` is false. */
export function useNow(interval_ms: number, active = true): Date {
  const [now, setNow] = useState(() => new Date());
  useEffect(() => {
    if (!active) return;
    setNow(new Date());
    const timer = setInterval(() => setNow(new Date()), interval_ms);
    return () => clearInterval(timer);
  }, [interval_ms, active]);
  return now;
}
