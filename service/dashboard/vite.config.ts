import react from "@vitejs/plugin-react";
import { defineConfig } from "vitest/config";

// `npm run dev` serves the page with hot reload and hands API calls to a service that runs elsewhere.
const service = process.env["SHAPEWRIGHT_SERVICE_URL"] ?? "http://127.0.0.1:8000";

export default defineConfig({
  plugins: [react()],
  server: {
    fs: { allow: [".", "../../examples"] }, // the sample mesh
    proxy: Object.fromEntries(["/v1", "/readyz", "/healthz"].map((path) => [path, service])),
  },
  build: {
    outDir: "dist",
    // three.js is one lazy chunk of its own; the page itself stays small.
    chunkSizeWarningLimit: 1200,
  },
  test: {
    include: ["tests/**/*.test.ts"],
    environment: "node",
  },
});
