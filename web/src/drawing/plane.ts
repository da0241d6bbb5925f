// A plane with axes on a canvas: orbits, particles, sections and maps.
import { layout, marks, short, type Box, type Layout, type Range } from "./layout";

export { short } from "./layout";
export type { Range } from "./layout";

export interface Curve {
  x: Float64Array;
  y: Float64Array;
  color: string;
  kind: "line" | "points" | "discs";
  radius: number; // of discs, in units of the axes; 0: a small disc
  mark: number; // the row that is shown; later ones are faint; -1: all are shown
}

export interface Frame {
  x_name: string;
  y_name: string;
  equal: boolean; // one unit has the same length on both axes
  walls: { axis: "x" | "y"; value: number; side: -1 | 1 }[]; // side: where the forbidden half is
  circle: number; // radius of a round wall about the origin; 0: there is none
  box: Box | null; // of a periodic box
  start: [number, number] | null; // a handle that can be dragged
  range: Range | null; // null: that of the curves and walls
}

/// A frame without walls, with names for its axes.
export function frame_of(x_name: string, y_name: string): Frame {
  return { x_name, y_name, equal: false, walls: [], circle: 0, box: null, start: null, range: null };
}

const right_room = 10; // px beside the axes
export const most_drawn = 20_000; // rows of a curve that are drawn; of more, every n-th

export const piece = 100; // segments of a path
const longest_chord = 60; // px
const few_points = 300; // fewer are drawn larger
const many_points = 1000; // more are painted pixel by pixel

/// The color of a name of style.css.
export function color_of(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

type Pen = CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D;

/// What a canvas shows, to find the place of the pointer.
export interface Shown {
  range: Range;
  at(px: number, py: number): [number, number];
  px(x: number): number;
  py(y: number): number;
}

export function prepared(canvas: HTMLCanvasElement): { pen: CanvasRenderingContext2D; width: number; height: number } {
  const ratio = window.devicePixelRatio || 1;
  const { clientWidth: width, clientHeight: height } = canvas;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const pen = canvas.getContext("2d")!;
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.fillStyle = color_of("--paper"); // so that an exported picture has a background
  pen.fillRect(0, 0, width, height);
  pen.font = "12px system-ui, sans-serif";
  pen.lineWidth = 1;
  return { pen, width, height };
}

export function draw_axes(pen: CanvasRenderingContext2D, { range, left, top, wide, high, px, py }: Layout, frame: Frame): void {
  pen.strokeStyle = color_of("--line");
  pen.fillStyle = color_of("--faint");
  pen.textAlign = "center";
  pen.textBaseline = "top";
  for (const mark of marks(range.x0, range.x1, Math.max(2, wide / 90))) {
    pen.fillRect(px(mark), top + high, 1, 4);
    const text = short(mark);
    const half = pen.measureText(text).width / 2;
    pen.fillText(text, Math.min(px(mark), left + wide + right_room - half), top + high + 6); // the last one stays in the picture
  }
  pen.textAlign = "right";
  pen.textBaseline = "middle";
  for (const mark of marks(range.y0, range.y1, Math.max(2, high / 60))) {
    pen.fillRect(left - 4, py(mark), 4, 1);
    pen.fillText(short(mark), left - 7, py(mark));
  }
  pen.strokeRect(left, top, wide, high);
  pen.fillStyle = color_of("--ink");
  pen.textAlign = "center";
  pen.textBaseline = "bottom";
  pen.fillText(frame.x_name, left + wide / 2, top + high + 38);
  pen.save();
  pen.translate(12, top + high / 2);
  pen.rotate(-Math.PI / 2);
  pen.textBaseline = "middle";
  pen.fillText(frame.y_name, 0, 0);
  pen.restore();
}

/// A wall is a line with hatching on its forbidden side.
function draw_walls(pen: CanvasRenderingContext2D, { px, py, range }: Layout, frame: Frame): void {
  pen.fillStyle = pen.strokeStyle = color_of("--ink");
  pen.lineWidth = 2;
  if (frame.circle > 0) {
    pen.beginPath();
    pen.ellipse(px(0), py(0), px(frame.circle) - px(0), py(0) - py(frame.circle), 0, 0, 2 * Math.PI);
    pen.stroke();
  }
  if (frame.box !== null) {
    const { x0, y0, x1, y1 } = frame.box;
    pen.setLineDash([6, 4]);
    pen.strokeRect(px(x0), py(y1), px(x1) - px(x0), py(y0) - py(y1));
    pen.setLineDash([]);
  }
  pen.lineWidth = 1;
  // Walls on both axes make a corner: the other axis bounds each of them.
  const within = (axis: "x" | "y", least: number, most: number): [number, number] => {
    const places = frame.walls.filter((each) => each.axis === axis);
    const low = places.find((each) => each.side < 0)?.value ?? least;
    const high = places.find((each) => each.side > 0)?.value ?? most;
    return [Math.max(low, least), Math.min(high, most)];
  };
  for (const wall of frame.walls) {
    pen.beginPath();
    if (wall.axis === "x") {
      const at = px(wall.value);
      const [low, most] = within("y", range.y0, range.y1);
      pen.fillRect(at - 1, py(most), 2, py(low) - py(most));
      for (let y = py(most); y < py(low); y += 8) { pen.moveTo(at, y); pen.lineTo(at + 7 * wall.side, y + 7); }
    } else {
      const at = py(wall.value);
      const [low, most] = within("x", range.x0, range.x1);
      pen.fillRect(px(low), at - 1, px(most) - px(low), 2);
      for (let x = px(low); x < px(most); x += 8) { pen.moveTo(x, at); pen.lineTo(x + 7, at - 7 * wall.side); }
    }
    pen.stroke();
  }
}

function draw_line(pen: Pen, curve: Curve, from: number, to: number, { px, py }: Layout): void {
  // In pieces: the time of a long path that crosses itself grows with the square of its length.
  for (let i = from; i < to - 1; i += piece) {
    pen.beginPath();
    for (let k = i; k <= Math.min(i + piece, to - 1); ++k) pen.lineTo(px(curve.x[k]!), py(curve.y[k]!));
    pen.stroke();
  }
}
/// Whether the rows are close enough for a line to show the path and not only chords of it.
function is_dense({ x, y }: Curve, { px, py }: Layout): boolean {
  if (x.length > most_drawn) return false;
  const every = Math.max(1, Math.floor(x.length / 100));
  let long = 0;
  let all = 0;
  for (let i = 1; i < x.length; i += every) {
    ++all;
    if (Math.hypot(px(x[i]!) - px(x[i - 1]!), py(y[i]!) - py(y[i - 1]!)) > longest_chord) ++long;
  }
  return long <= 0.3 * all;
}
/// A part of the points of a curve.
interface Points {
  curve: Curve;
  from: number;
  to: number;
}
function draw_points(pen: Pen, parts: Points[], size: number, place: Layout): void {
  if (parts.reduce((sum, { from, to }) => sum + to - from, 0) > many_points) return paint_points(pen, parts, size, place);
  for (const { curve, from, to } of parts) {
    pen.fillStyle = curve.color;
    for (let i = from; i < to; ++i) pen.fillRect(place.px(curve.x[i]!) - size / 2, place.py(curve.y[i]!) - size / 2, size, size);
  }
}
/// The same into an image: 50000 operations of a canvas take the browser 60 ms.
function paint_points(pen: Pen, parts: Points[], size: number, { px, py }: Layout): void {
  const { width, height } = pen.canvas;
  const ratio = pen.getTransform().a;
  const side = size * ratio;
  const image = new ImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer); // alpha, blue, green, red
  for (const { curve, from, to } of parts) {
    pen.fillStyle = curve.color;
    const rgb = parseInt(String(pen.fillStyle).slice(1), 16); // the canvas writes every color as #rrggbb
    const color = ((rgb & 0xff) << 16) | (rgb & 0xff00) | (rgb >> 16);
    const every = Math.max(1, Math.ceil((to - from) / most_drawn));
    for (let i = from; i < to; i += every) {
      const x = px(curve.x[i]!) * ratio - side / 2;
      const y = py(curve.y[i]!) * ratio - side / 2;
      if (!(x > -side && x < width && y > -side && y < height)) continue;
      const left = Math.max(0, Math.floor(x));
      const right = Math.min(width - 1, Math.floor(x + side));
      const low = Math.min(height - 1, Math.floor(y + side));
      for (let row = Math.max(0, Math.floor(y)); row <= low; ++row) {
        const high = Math.min(row + 1, y + side) - Math.max(row, y); // the part of the pixel that is covered
        for (let column = left; column <= right; ++column) {
          const part = high * (Math.min(column + 1, x + side) - Math.max(column, x));
          const at = row * width + column;
          pixels[at] = (Math.max(pixels[at]! >>> 24, Math.round(255 * part)) << 24) | color;
        }
      }
    }
  }
  const layer = new OffscreenCanvas(width, height);
  layer.getContext("2d")!.putImageData(image, 0, 0);
  put(pen, layer);
}
/// Puts a picture of the same size over this one.
function put(pen: Pen, layer: OffscreenCanvas): void {
  pen.save();
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.drawImage(layer, 0, 0);
  pen.restore();
}
function draw_discs(pen: CanvasRenderingContext2D, curve: Curve, { px, py }: Layout): void {
  const radius = Math.max(2, px(curve.radius) - px(0));
  pen.beginPath();
  for (let i = 0; i < curve.x.length; ++i) {
    pen.moveTo(px(curve.x[i]!) + radius, py(curve.y[i]!));
    pen.arc(px(curve.x[i]!), py(curve.y[i]!), radius, 0, 2 * Math.PI);
  }
  pen.fill();
}

const is_line = (curve: Curve, place: Layout): boolean => curve.kind === "line" && is_dense(curve, place);
const size_of_points = (curves: Curve[]): number => (curves.reduce((sum, { x }) => sum + x.length, 0) < few_points ? 3 : 1.4);

/// What a canvas shows of curves that grow, without axes: so that each picture draws only the new rows.
interface Trail {
  layer: OffscreenCanvas;
  key: string;
  looks: string[]; // of each curve
  drawn: number[]; // rows of each curve
}
const trails = new WeakMap<HTMLCanvasElement, Trail>();

/// Draws the new rows of these curves over those of the picture before.
function draw_trails(canvas: HTMLCanvasElement, pen: CanvasRenderingContext2D, curves: Curve[], place: Layout, version: string): void {
  const size = size_of_points(curves);
  const lines = curves.map((curve) => is_line(curve, place));
  const looks = curves.map(({ color }, i) => `${color} ${lines[i] ? "line" : size}`);
  const key = JSON.stringify([version, place.range, canvas.width, canvas.height]);
  let trail = trails.get(canvas);
  const goes_on = (before: Trail): boolean => before.key === key && before.drawn.every((rows, i) => rows <= (curves[i]?.x.length ?? -1) && (rows === 0 || before.looks[i] === looks[i]));
  if (trail === undefined || !goes_on(trail)) {
    trail = { layer: new OffscreenCanvas(canvas.width, canvas.height), key, looks, drawn: [] };
    trails.set(canvas, trail);
  }
  trail.looks = looks;
  const layer_pen = trail.layer.getContext("2d")!;
  layer_pen.setTransform(pen.getTransform());
  const points: Points[] = [];
  curves.forEach((curve, i) => {
    const before = trail.drawn[i] ?? 0;
    const to = curve.x.length;
    trail.drawn[i] = to;
    if (to > before && !lines[i]) points.push({ curve, from: before, to });
    if (to <= before || !lines[i]) return;
    layer_pen.strokeStyle = curve.color;
    layer_pen.lineWidth = 1.2;
    draw_line(layer_pen, curve, Math.max(0, before - 1), to, place);
  });
  draw_points(layer_pen, points, size, place);
  put(pen, trail.layer);
}
function draw_mark(pen: CanvasRenderingContext2D, curve: Curve, row: number, { px, py }: Layout): void {
  pen.fillStyle = curve.color;
  pen.beginPath();
  pen.arc(px(curve.x[row]!), py(curve.y[row]!), 5, 0, 2 * Math.PI);
  pen.fill();
}

function draw_curve(pen: CanvasRenderingContext2D, curve: Curve, place: Layout): void {
  pen.strokeStyle = pen.fillStyle = curve.color;
  pen.lineWidth = 1.2;
  if (curve.kind === "discs") return draw_discs(pen, curve, place);
  const with_line = is_line(curve, place);
  const draw = (from: number, to: number): void => (with_line ? draw_line(pen, curve, from, to, place) : draw_points(pen, [{ curve, from, to }], size_of_points([curve]), place));
  const last = curve.x.length - 1;
  const shown = curve.mark >= 0 ? Math.min(curve.mark, last) : last;
  if (shown < last) {
    pen.globalAlpha = 0.25;
    draw(shown, last + 1);
    pen.globalAlpha = 1;
  }
  draw(0, shown + 1);
}

/// @param version stays as long as rows only follow those before; empty: draws everything anew
export function draw_plane(canvas: HTMLCanvasElement, curves: Curve[], frame: Frame, version = ""): Shown {
  const { pen, width, height } = prepared(canvas);
  const place = layout(curves, frame, width, height);
  draw_axes(pen, place, frame);
  const { left, top, wide, high, range, px, py } = place;
  pen.save();
  pen.beginPath();
  pen.rect(left, top, wide, high);
  pen.clip();
  draw_walls(pen, place, frame);
  const is_trail = (curve: Curve): boolean => version !== "" && curve.kind !== "discs" && (curve.mark < 0 || curve.mark >= curve.x.length - 1);
  const whole = curves.filter(is_trail);
  if (whole.length > 0) draw_trails(canvas, pen, whole, place, version);
  for (const curve of curves) if (!is_trail(curve)) draw_curve(pen, curve, place);
  pen.restore();
  // A mark at an edge is whole.
  pen.save();
  pen.beginPath();
  pen.rect(left - 6, top - 6, wide + 12, high + 12);
  pen.clip();
  for (const curve of curves) if (curve.mark >= 0 && curve.x.length > 0 && curve.kind !== "discs") draw_mark(pen, curve, Math.min(curve.mark, curve.x.length - 1), place);
  if (frame.start !== null) {
    pen.strokeStyle = color_of("--ink");
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.arc(px(frame.start[0]), py(frame.start[1]), 8, 0, 2 * Math.PI);
    pen.stroke();
  }
  pen.restore();
  return {
    range, px, py,
    at: (x, y) => [range.x0 + ((x - left) / wide) * (range.x1 - range.x0), range.y1 - ((y - top) / high) * (range.y1 - range.y0)],
  };
}
