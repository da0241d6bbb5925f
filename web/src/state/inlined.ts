// What `hamflow view` puts into the page: a scenario, and the rows of a run or the members of a sweep.

import { decoded } from "../engine/data";
import type { FileRows } from "../engine/hdf5_worker";

export interface Inlined {
  kind: "scenario" | "run" | "sweep";
  name: string;
  toml: string;
  columns: string[];
  rows: string; // base64 of doubles, row after row
  note: string; // what was left out; empty: nothing
}

/// null: the page was opened without a scenario.
export async function inlined(): Promise<FileRows | null> {
  const element = document.getElementById("inlined");
  if (element === null) return null;
  await new Promise((resolve) => setTimeout(resolve)); // the megabytes of text are a task of their own
  const { given, bytes } = await decoded("inlined", element.textContent!);
  return { given: given!, numbers: new Float64Array(bytes) };
}
