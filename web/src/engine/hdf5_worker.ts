// Reads run.h5 and sweep.h5 in a worker of its own, which is loaded when the first file is dropped.
import type { Dataset, File as Hdf5File, Group } from "h5wasm";
import type { Inlined } from "../state/inlined";
import { named_row_blocks } from "./hdf5_columns";

/// The library, which its bytes precede: the build keeps them out of the script, where they would be a third larger.
let hdf5: typeof import("h5wasm");

const scope = self as unknown as { hdf5_wasm: ArrayBuffer; onmessage: (event: MessageEvent<ArrayBuffer | { name: string; bytes: ArrayBuffer }>) => void; postMessage(message: unknown, transfer: Transferable[]): void };

export interface FileRows {
  given: Omit<Inlined, "rows">;
  numbers: Float64Array; // row after row
}

const no_file = "is no run.h5 or sweep.h5 of hamflow";

function numbers_of(dataset: Dataset): ArrayLike<number | bigint> {
  return dataset.value as unknown as ArrayLike<number | bigint>;
}
function texts_of(file: Hdf5File, name: string): string[] {
  const value: unknown = file.attrs[name]?.value;
  return Array.isArray(value) ? value.map(String) : String(value).split(",");
}
function dataset(group: Group, path: string): Dataset | null {
  const found = group.get(path);
  return found instanceof hdf5.Dataset ? found : null;
}
/// The members of a group with its path; none if it is not there.
function inside(group: Group, path: string): [string, Dataset][] {
  const found = group.get(path);
  if (!(found instanceof hdf5.Group)) return [];
  return found.keys().flatMap((key): [string, Dataset][] => {
    const each = found.get(key);
    return each instanceof hdf5.Dataset ? [[`${path}/${key}`, each]] : inside(group, `${path}/${key}`);
  });
}
const is_numeric = (each: Dataset): boolean => /^<?>?[fdqihQIHbB]/.test(String(each.dtype));

export interface Block {
  names: string[]; // of its columns
  numbers: ArrayLike<number | bigint>; // row after row
}

/// The samples of a run, as `hamflow view` stores them.
function run_blocks(file: Hdf5File): { blocks: Block[]; rows: number } {
  const t = dataset(file, "t")!;
  const q = dataset(file, "q") ?? dataset(file, "particles/all/position/value");
  const p = dataset(file, "p") ?? dataset(file, "particles/all/momentum/value");
  const energy = dataset(file, "energy");
  const rows = t.shape![0]!;
  if (q === null || p === null || energy === null) throw new Error(no_file);
  const error = Float64Array.from(numbers_of(energy) as ArrayLike<number>);
  const first = error[0] ?? 0;
  // The measures of a gas are elements of H5MD, with values, steps and times.
  const invariants = inside(file, "invariants");
  const is_there = (path: string): boolean => invariants.some(([name]) => path === `${name.replace("invariants", "observables")}/value`);
  const more = [...invariants, ...inside(file, "observables")].filter(([path, each]) => !/\/(step|time)$|^observables\/energy\//.test(path) && !is_there(path) && is_numeric(each) && each.shape!.length === 1 && each.shape![0] === rows);
  return {
    rows,
    blocks: [
      { names: ["t"], numbers: numbers_of(t) },
      { names: texts_of(file, "coordinates"), numbers: numbers_of(q) },
      { names: texts_of(file, "momenta"), numbers: numbers_of(p) },
      { names: ["energy error"], numbers: error.map((each) => each - first) },
      ...more.map(([path, each]) => ({ names: [path.slice(path.indexOf("/") + 1).replace(/\/value$/, "")], numbers: numbers_of(each) })),
    ],
  };
}

/// The columns of a sweep that have a row for each member, with their paths.
function sweep_blocks(file: Hdf5File): { blocks: Block[]; rows: number } {
  const rows = dataset(file, "member/status")!.shape![0]!;
  const blocks = ["varied", "energy", "final", "invariants", "observables", "member"].flatMap((group) =>
    inside(file, group).filter(([, each]) => is_numeric(each) && each.shape!.length > 0 && each.shape![0] === rows).map(([path, each]): Block => {
      const width = each.shape!.slice(1).reduce((product, size) => product * size, 1);
      return { names: each.shape!.length === 1 ? [path] : Array.from({ length: width }, (_, k) => `${path}[${k}]`), numbers: numbers_of(each) };
    }));
  return { blocks, rows };
}

function read(name: string, bytes: ArrayBuffer): FileRows {
  const { FS } = hdf5;
  FS!.writeFile(name, new Uint8Array(bytes));
  let file: Hdf5File | undefined;
  try {
    file = new hdf5.File(name, "r");
    const is_run = dataset(file, "t") !== null && file.attrs["coordinates"] !== undefined;
    if (!is_run && dataset(file, "member/status") === null) throw new Error(no_file);
    const { blocks, rows } = is_run ? run_blocks(file) : sweep_blocks(file);
    const toml = String(dataset(file, "scenario")?.value ?? "");
    const { columns, numbers, note } = named_row_blocks(blocks, rows);
    return { given: { kind: is_run ? "run" : "sweep", name, toml, columns, note }, numbers };
  } finally {
    if (file !== undefined && file.file_id > 0n) file.close();
    FS!.unlink(name);
  }
}

async function load(): Promise<void> {
  if (hdf5 === undefined) hdf5 = await import("h5wasm");
  const library = await hdf5.ready;
  library.activate_throwing_error_handler(); // instead of text on the console
}

scope.onmessage = ({ data }) => {
  if (data instanceof ArrayBuffer) {
    scope.hdf5_wasm = data;
    return;
  }
  const { name, bytes } = data;
  void load().then(() => {
    try {
      const found = read(name, bytes);
      scope.postMessage(found, [found.numbers.buffer]);
    } catch (error) {
      const is_other = error instanceof Error && error.message === no_file;
      const message = `${name} ${is_other ? no_file : "is damaged or incomplete: HDF5 cannot read it"}`;
      scope.postMessage({ message }, []);
    }
  });
};
