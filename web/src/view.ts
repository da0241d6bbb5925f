// A view: a part of the page that shows the motion. Each file of views/ makes one; the build collects them.
import type { Laboratory } from "./laboratory";

export interface View {
  place: "stage" | "numbers"; // the column of the page
  order: number; // within its column
  root: HTMLElement;
  /// Another scenario or recording is there.
  opened?(): void;
  /// The motion has moved, or another row is marked.
  draw(): void;
  /// The colors have changed.
  restyle?(): void;
}

export type MakeView = (laboratory: Laboratory) => View;
