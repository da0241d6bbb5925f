// What the page and a worker say to each other: the functions of web/engine/engine.cpp, by name.

export interface Complaint {
  line: number; // 0: not in the text
  column: number;
  key: string;
  message: string;
}

export interface Facts {
  problem: string;
  formula: string;
  angles: string[];
  method: string;
  arithmetic: string;
  dt: number;
  steps: number;
  map: boolean;
  q: string[];
  p: string[];
  invariants: { name: string; meaning: string }[];
  walls: { coordinate: number; min: number | null; max: number | null }[];
  particles: { space: number; edges: number[]; radius: number; repulsion: number } | null;
  section: SectionFacts | null;
  observables: { name: string; expression: string }[];
  settings: Setting[];
  notes: string[];
}

/// A value of the text, and where it stands there.
export interface Setting {
  path: string;
  text: string;
  line: number; // 0: it is not in the text
  column: number;
}

/// An option of a problem, a method or a table.
export interface Declared {
  name: string;
  type: string; // of OptionType in option_info.hpp
  default: string;
  meaning: string;
  words: string[];
  least: number | null; // null: no bound
  most: number | null;
  whole: boolean;
  unit: string;
  keys: Declared[];
}

export interface Declarations {
  tables: Record<string, Declared[]>;
  problems: { name: string; choices: Record<string, string>; formula: string; keys: Declared[] }[];
  methods: { name: string; purpose: string; keys: Declared[] }[];
  arithmetics: string[];
}

export interface SectionFacts {
  coordinate: number;
  momentum: boolean;
  is_plane: boolean; // a coordinate or momentum has the value; else points in time, or of a map or an expression
  value: number;
  direction: number;
}

export interface MotionState {
  step: number;
  t: number;
  final: { q: number[]; p: number[] };
  energy: { initial: number; final: number; max_error: number; scale: number };
  invariants: { initial: number[]; final: number[]; max_error: number }[];
  walls: { coordinate: number; side: number; bounces: number }[];
  evaluations: number;
  outcome: string;
  failed: boolean;
  message: string;
}

export interface Returned {
  bits: number;
  equal: number;
  distance: number;
}

export interface Certificate {
  drift: string;
  reason: string;
  level: number | null;
  invariants: { name: string; max_error: number; conserved: boolean | null }[];
  reversal: { proves: string; reason: string } | null;
}

export interface MapFacts {
  columns: number; // values of x
  rows: number; // values of y
  lanes: number; // cells that run together
}

/// A key with a number, which a map can vary.
export interface SweepableKey {
  key: string;
  value: number;
}

export interface StartsState {
  step: number;
  counts: number[]; // points of each start so far
  failures: string[]; // for each start why it has ended; empty: it goes on
}

/// The functions, each with its arguments after the number of the motion, and its answer.
export interface Calls {
  open: { args: [text: string, sets: string]; answer: Facts };
  show: { args: [expressions: string]; answer: { width: number } };
  advance: { args: [steps: number, every: number]; answer: MotionState };
  state: { args: []; answer: MotionState };
  reverse: { args: []; answer: MotionState };
  returned: { args: []; answer: Returned };
  certificate: { args: []; answer: Certificate };
  /// Begins section points of some starts in place of the last ones. `sets`: PATH=VALUE, one line for each start.
  starts: { args: [text: string, sets: string]; answer: { starts: number } };
  /// Advances the starts together until each has `most` points in all, or the time is over. The rows of the reply are the
  /// new points: the number of its start, t, all q, all p.
  points_of_starts: { args: [most: number, milliseconds: number]; answer: StartsState };
  sweepable: { args: [text: string]; answer: SweepableKey[] };
  /// Begins a map in place of the last one: a number for each pair of values of two keys. Each cell is a run of its own;
  /// cell ix + iy * columns has the ix-th value of x and the iy-th of y.
  /// x, y: KEY=FROM:TO:COUNT, as after --vary of the command; observable: lyapunov, energy_error (the largest |H - H(0)|),
  /// relative_energy_error, bounces, or an expression of the state after the last step.
  map: { args: [text: string, x: string, y: string, observable: string, steps: number]; answer: MapFacts };
  /// Computes the cells first, first + stride, ..., at most `count` of them, until the time is over. The rows of the
  /// reply are their `done` numbers; NaN: the cell has no start, or its motion failed.
  cells: { args: [first: number, stride: number, count: number, milliseconds: number]; answer: { done: number } };
  declarations: { args: []; answer: Declarations };
}
export type CallName = keyof Calls;

/// What a worker gets beside questions: the first part of the engine, and the rest, which may come later.
export type Part = { first: WebAssembly.Module; rest_address: string } | { rest: WebAssembly.Module };

export interface Question {
  id: number;
  call: CallName;
  motion: number;
  args: (string | number)[];
}

/// Rows and points accompany `open`, `show` and `advance`; rows accompany `cells` and `points_of_starts`.
export interface Reply {
  id: number;
  json: string;
  rows: Float64Array | null;
  points: Float64Array | null;
}
