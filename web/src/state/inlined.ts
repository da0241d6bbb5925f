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

/// The browser decodes a data address much faster than a script does.
export async function rows_of(given: Inlined): Promise<Float64Array> {
  const answer = await fetch(`data:application/octet-stream;base64,${given.rows}`);
  return new Float64Array(await answer.arrayBuffer());
}
