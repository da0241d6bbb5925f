// Curves in space, seen from a direction that the pointer turns: an orthographic projection.
import { extent, marks, short, widened } from "./layout";
import { color_of, most_drawn, piece, prepared } from "./plane";

export interface SpaceCurve {
  at: [Float64Array, Float64Array, Float64Array];
  color: string;
  joined: boolean;
  mark: number; // the row that is shown
}

/// The direction of the view, in radians.
export interface Look {
  turn: number; // about the third axis
  tilt: number; // of the third axis towards the eye
}

type Point = [number, number, number];
type Ends = [number, number][];

/// The ends of the three axes.
export function ends_of(curves: SpaceCurve[], equal: boolean): Ends {
  const ends = [0, 1, 2].map((axis): [number, number] => {
    const found = curves.flatMap((curve) => extent(curve.at[axis]!) ?? []);
    return widened(extent(found) ?? [-1, 1]);
  });
  if (!equal) return ends;
  const half = Math.max(...ends.map(([least, most]) => most - least)) / 2;
  return ends.map(([least, most]) => [(least + most) / 2 - half, (least + most) / 2 + half]);
}

/// Ends that change rarely while a motion fills them.
export function grown_ends(before: Ends | null, wanted: Ends): Ends {
  if (before === null) return wanted;
  if (wanted.every(([least, most], axis) => least >= before[axis]![0] && most <= before[axis]![1])) return before;
  return wanted.map(([least, most], axis) => {
    const [low, high] = before[axis]!;
    const room = 0.2 * (Math.max(high, most) - Math.min(low, least));
    return [least < low ? least - room : low, most > high ? most + room : high];
  });
}

const corners: Point[] = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1]);

export function draw_space(canvas: HTMLCanvasElement, curves: SpaceCurve[], names: string[], ends: Ends, look: Look): void {
  const { pen, width, height } = prepared(canvas);
  const unit = Math.max(10, Math.min(width - 110, height - 90)) / 2.9; // the cube from corner to corner, with room for names
  const [cos_turn, sin_turn, cos_tilt, sin_tilt] = [Math.cos(look.turn), Math.sin(look.turn), Math.cos(look.tilt), Math.sin(look.tilt)];
  /// From -1 .. 1 on each axis to the picture; the third number is the distance to the eye.
  const seen = ([x, y, z]: Point): Point => {
    const across = x * cos_turn - y * sin_turn;
    const deep = x * sin_turn + y * cos_turn;
    return [width / 2 + unit * across, height / 2 - unit * (z * cos_tilt + deep * sin_tilt), deep * cos_tilt - z * sin_tilt];
  };
  const scaled = (value: number, axis: number): number => (2 * (value - ends[axis]![0])) / (ends[axis]![1] - ends[axis]![0]) - 1;
  const seen_row = (curve: SpaceCurve, row: number): Point => seen([scaled(curve.at[0][row]!, 0), scaled(curve.at[1][row]!, 1), scaled(curve.at[2][row]!, 2)]);

  pen.strokeStyle = color_of("--line");
  pen.beginPath();
  for (const corner of corners) {
    for (let axis = 0; axis < 3; ++axis) {
      if (corner[axis]! > 0) continue;
      const other = [...corner] as Point;
      other[axis] = 1;
      const [from, to] = [seen(corner), seen(other)];
      pen.moveTo(from[0], from[1]);
      pen.lineTo(to[0], to[1]);
    }
  }
  pen.stroke();
  draw_names(pen, seen, names, ends);

  for (const curve of curves) {
    const every = Math.max(1, Math.ceil(curve.at[0].length / most_drawn));
    pen.strokeStyle = pen.fillStyle = curve.color;
    pen.lineWidth = 1.2;
    const is_line = curve.joined && every === 1;
    for (let from = 0; from <= curve.mark; from += piece * every) {
      pen.beginPath(); // in pieces, as in plane.ts
      for (let row = from; row <= Math.min(from + piece * every, curve.mark); row += every) {
        const [x, y] = seen_row(curve, row);
        if (is_line) pen.lineTo(x, y);
        else pen.fillRect(x - 0.7, y - 0.7, 1.4, 1.4);
      }
      if (is_line) pen.stroke();
    }
    if (curve.mark < 0) continue;
    const [x, y] = seen_row(curve, curve.mark);
    pen.beginPath();
    pen.arc(x, y, 5, 0, 2 * Math.PI);
    pen.fill();
  }
}

/// Names at the middles of three edges at the bottom and at the left, with round numbers along them.
function draw_names(pen: CanvasRenderingContext2D, seen: (point: Point) => Point, names: string[], ends: Ends): void {
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  const middle = seen([0, 0, 0]);
  for (let axis = 0; axis < 3; ++axis) {
    // Of the four edges along the axis: the lowest of the picture, for the third axis the leftmost.
    const edges = [[-1, -1], [-1, 1], [1, -1], [1, 1]].map(([a, b]): Point => (axis === 0 ? [0, a!, b!] : axis === 1 ? [a!, 0, b!] : [a!, b!, 0]));
    const rank = (edge: Point): number => (axis === 2 ? -seen(edge)[0] : seen(edge)[1]);
    const edge = edges.reduce((best, each) => (rank(each) > rank(best) ? each : best));
    const place = (along: number, away: number): [number, number] => {
      const point = [...edge] as Point;
      point[axis] = along;
      const [x, y] = seen(point);
      const [from_x, from_y] = axis === 2 ? [x - 1, y] : [x, y + 1];
      const length = Math.hypot(from_x - middle[0], from_y - middle[1]) || 1;
      return [x + (away * (from_x - middle[0])) / length, y + (away * (from_y - middle[1])) / length];
    };
    pen.fillStyle = color_of("--ink");
    pen.fillText(names[axis]!, ...place(0, 38));
    pen.fillStyle = color_of("--faint");
    const [least, most] = ends[axis]!;
    for (const mark of marks(least, most, 4)) {
      const along = (2 * (mark - least)) / (most - least) - 1;
      if (Math.abs(along) < 0.9) pen.fillText(short(mark), ...place(along, 16)); // at a corner two axes meet
    }
  }
}
