// Where the points of a picture are: ranges of axes, and their marks.

export interface Range {
  x0: number;
  x1: number;
  y0: number;
  y1: number;
}
export type Box = Range;

/// Marks of an axis: whole multiples of 1, 2 or 5 times a power of ten.
export function marks(least: number, most: number, count: number): number[] {
  const raw = (most - least) / count;
  if (!(raw > 0) || !Number.isFinite(raw)) return [];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((each) => each * power).find((each) => each >= raw) ?? 10 * power;
  const all: number[] = [];
  for (let k = Math.ceil(least / step); k * step <= most && all.length < 100; ++k) all.push(k * step);
  return all;
}

export function short(x: number): string {
  if (x === 0) return "0";
  return Math.abs(x) < 1e-4 ? String(Number(x.toExponential(3)).toExponential()) : String(Number(x.toPrecision(4)));
}

/// The least and the greatest number; nothing if there is none.
export function extent(values: ArrayLike<number>): [number, number] | null {
  let least = Infinity;
  let most = -Infinity;
  for (let i = 0; i < values.length; ++i) {
    const value = values[i]!;
    if (!Number.isFinite(value)) continue;
    if (value < least) least = value;
    if (value > most) most = value;
  }
  return least > most ? null : [least, most];
}

/// The same angle from -pi to pi.
export function within_turn(angle: number): number {
  return angle - 2 * Math.PI * Math.floor((angle + Math.PI) / (2 * Math.PI));
}

/// A range wide enough that rounding does not look like motion.
export function widened([least, most]: [number, number]): [number, number] {
  const size = Math.max(Math.abs(least), Math.abs(most));
  if (most - least > 1e-12 * size && most > least) return [least, most];
  const half = size === 0 ? 0.1 : Math.max(0.1 * size, 1e-300);
  return [(least + most) / 2 - half, (least + most) / 2 + half];
}

const margin = 0.06; // free room beside the curves, on each side of an axis

interface Drawn {
  x: Float64Array;
  y: Float64Array;
}
interface Framed {
  equal: boolean;
  walls: { axis: "x" | "y"; value: number }[];
  circle: number;
  box: Box | null;
  range: Range | null;
}

function range_of_axis(curves: Drawn[], frame: Framed, axis: "x" | "y"): [number, number] {
  const ends: number[] = frame.walls.filter((wall) => wall.axis === axis).map((wall) => wall.value);
  if (frame.circle > 0) ends.push(-frame.circle, frame.circle);
  if (frame.box !== null) ends.push(...(axis === "x" ? [frame.box.x0, frame.box.x1] : [frame.box.y0, frame.box.y1]));
  for (const curve of curves) ends.push(...(extent(curve[axis]) ?? []));
  const found = extent(ends);
  if (found === null) return [-1, 1];
  const [least, most] = widened(found);
  const room = margin * (most - least);
  return [least - room, most + room];
}

/// The range that shows all of these curves and walls.
export function range_of(curves: Drawn[], frame: Framed): Range {
  const [x0, x1] = range_of_axis(curves, frame, "x");
  const [y0, y1] = range_of_axis(curves, frame, "y");
  return { x0, x1, y0, y1 };
}

/// A range that changes rarely while a motion fills it: a side that something leaves grows by a fifth. The free room
/// beside the curves may be used up before that.
export function grown(before: Range | null, wanted: Range): Range {
  if (before === null) return wanted;
  const { x0, x1, y0, y1 } = before;
  const out = (least: number, most: number, from: number, to: number): [number, number] => {
    const free = (margin / (1 + 2 * margin)) * (to - from);
    const more = 0.2 * (Math.max(to, most) - Math.min(from, least));
    return [from + free < least ? Math.min(from, least - more) : least, to - free > most ? Math.max(to, most + more) : most];
  };
  const [left, right] = out(x0, x1, wanted.x0, wanted.x1);
  const [low, high] = out(y0, y1, wanted.y0, wanted.y1);
  const is_same = left === x0 && right === x1 && low === y0 && high === y1;
  return is_same ? before : { x0: left, x1: right, y0: low, y1: high };
}

/// The range of the axes, and where its points are in a picture.
export interface Layout {
  range: Range;
  left: number;
  top: number;
  wide: number;
  high: number;
  px: (x: number) => number;
  py: (y: number) => number;
}

const bottom = 42;
const narrow = 400; // px: a picture of a telephone
const top = 10;

export function layout(curves: Drawn[], frame: Framed, width: number, height: number, right = 12): Layout {
  let { x0, x1, y0, y1 } = frame.range ?? range_of(curves, frame);
  const left = width < narrow ? 56 : 70; // for the numbers and the name of the axis
  const wide = Math.max(width - left - right, 1);
  const high = Math.max(height - top - bottom, 1);
  if (frame.equal) {
    const unit = Math.max((x1 - x0) / wide, (y1 - y0) / high);
    [x0, x1] = [(x0 + x1 - unit * wide) / 2, (x0 + x1 + unit * wide) / 2];
    [y0, y1] = [(y0 + y1 - unit * high) / 2, (y0 + y1 + unit * high) / 2];
  }
  return {
    range: { x0, x1, y0, y1 },
    left, top, wide, high,
    px: (x) => left + ((x - x0) / (x1 - x0)) * wide,
    py: (y) => top + ((y1 - y) / (y1 - y0)) * high,
  };
}
