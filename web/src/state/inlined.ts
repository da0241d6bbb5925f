// What `hamflow view` puts into the page: a scenario, and the rows of a run or the members of a sweep.

export interface Inlined {
  kind: "scenario" | "run" | "sweep";
  name: string;
  toml: string;
  columns: string[];
  rows: string; // base64 of doubles, row after row
  note: string; // what was left out; empty: nothing
}

/// null: the page was opened without a scenario.
export function inlined(): Inlined | null {
  const text = document.getElementById("inlined")?.textContent?.trim() ?? "";
  return text === "" ? null : (JSON.parse(text) as Inlined);
}

export function rows_of(given: Inlined): Float64Array {
  const bytes = Uint8Array.from(atob(given.rows), (letter) => letter.charCodeAt(0));
  return new Float64Array(bytes.buffer);
}
