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
  particles: { space: number; edges: number[]; radius: number } | null;
  section: SectionFacts | null;
  observables: { name: string; expression: string }[];
  notes: string[];
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

export interface MethodName {
  name: string;
  purpose: string; // empty: not recommended first
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
  methods: { args: []; answer: MethodName[] };
}
export type CallName = keyof Calls;

export interface Question {
  id: number;
  call: CallName;
  motion: number;
  args: (string | number)[];
}

/// Rows and points accompany `open`, `show` and `advance`.
export interface Reply {
  id: number;
  json: string;
  rows: Float64Array | null;
  points: Float64Array | null;
}
