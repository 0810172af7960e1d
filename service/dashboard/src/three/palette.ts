/** Colours of the drawn surfaces; the legend uses the same ones through the style sheet (styles/tokens.css). */
import type { ColorScheme } from "../hooks/useColorScheme";
import type { Tone } from "./layers";

export interface Palette {
  tones: Record<Tone, string>;
  edge: string;
  gridCell: string;
  gridSection: string;
  sky: string;
  ground: string;
}

export const PALETTES: Record<ColorScheme, Palette> = {
  light: {
    tones: { model: "#c6cfd4", query: "#3b7fd0", fit: "#e0862f" },
    edge: "#0d1b22",
    gridCell: "#dde2e5",
    gridSection: "#c3ccd1",
    sky: "#ffffff",
    ground: "#cdd3d6",
  },
  dark: {
    tones: { model: "#b9c4ca", query: "#4f93e3", fit: "#ee9a48" },
    edge: "#05090b",
    gridCell: "#20282d",
    gridSection: "#2f3a40",
    sky: "#e8f0f4",
    ground: "#6c7a82",
  },
};
