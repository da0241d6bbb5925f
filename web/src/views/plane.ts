// A plane with axes, drawn on a canvas: what orbits and sections have in common.

export interface Curve {
  x: Float64Array;
  y: Float64Array;
  color: string;
  joined: boolean; // a line; else points
  mark: number; // the row that is marked; -1: none
}

export interface Frame {
  x_name: string;
  y_name: string;
  equal: boolean; // one unit has the same length on both axes
  /// Lines at these values: walls.
  walls: { axis: "x" | "y"; value: number }[];
}

/// The color of a name of style.css.
export function color_of(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/// Marks of an axis: whole multiples of 1, 2 or 5 times a power of ten.
export function marks(least: number, most: number, count: number): number[] {
  const raw = (most - least) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((each) => each * power).find((each) => each >= raw)!;
  const all: number[] = [];
  for (let k = Math.ceil(least / step); k * step <= most; ++k) all.push(k * step);
  return all;
}

export function short(x: number): string {
  return x === 0 ? "0" : String(Number(x.toPrecision(4)));
}

function range_of(curves: Curve[], axis: "x" | "y", more: number[]): [number, number] {
  let least = Infinity;
  let most = -Infinity;
  const look = (value: number): void => {
    if (!Number.isFinite(value)) return;
    least = Math.min(least, value);
    most = Math.max(most, value);
  };
  for (const curve of curves) curve[axis].forEach(look);
  more.forEach(look);
  if (least > most) return [-1, 1];
  const room = 0.06 * (most - least) || Math.max(Math.abs(most) * 0.1, 0.1);
  return [least - room, most + room];
}

const left = 62;
const bottom = 40;
const top = 10;
const right = 12;

/// Draws the curves, and returns the values at a place of the canvas.
export function draw_plane(canvas: HTMLCanvasElement, curves: Curve[], frame: Frame): (px: number, py: number) => [number, number] {
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const pen = canvas.getContext("2d")!;
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  let [x0, x1] = range_of(curves, "x", frame.walls.filter((each) => each.axis === "x").map((each) => each.value));
  let [y0, y1] = range_of(curves, "y", frame.walls.filter((each) => each.axis === "y").map((each) => each.value));
  const wide = Math.max(width - left - right, 1);
  const high = Math.max(height - top - bottom, 1);
  if (frame.equal) {
    const unit = Math.max((x1 - x0) / wide, (y1 - y0) / high);
    [x0, x1] = [(x0 + x1 - unit * wide) / 2, (x0 + x1 + unit * wide) / 2];
    [y0, y1] = [(y0 + y1 - unit * high) / 2, (y0 + y1 + unit * high) / 2];
  }
  const px = (x: number): number => left + ((x - x0) / (x1 - x0)) * wide;
  const py = (y: number): number => top + ((y1 - y) / (y1 - y0)) * high;

  pen.font = "12px system-ui, sans-serif";
  pen.lineWidth = 1;
  pen.strokeStyle = color_of("--line");
  pen.fillStyle = color_of("--faint");
  pen.textAlign = "center";
  pen.textBaseline = "top";
  for (const mark of marks(x0, x1, Math.max(2, wide / 90))) {
    pen.beginPath();
    pen.moveTo(px(mark), top + high);
    pen.lineTo(px(mark), top + high + 4);
    pen.stroke();
    pen.fillText(short(mark), px(mark), top + high + 6);
  }
  pen.textAlign = "right";
  pen.textBaseline = "middle";
  for (const mark of marks(y0, y1, Math.max(2, high / 60))) {
    pen.beginPath();
    pen.moveTo(left - 4, py(mark));
    pen.lineTo(left, py(mark));
    pen.stroke();
    pen.fillText(short(mark), left - 7, py(mark));
  }
  pen.strokeRect(left, top, wide, high);
  pen.fillStyle = color_of("--ink");
  pen.textAlign = "center";
  pen.textBaseline = "bottom";
  pen.fillText(frame.x_name, left + wide / 2, height - 2);
  pen.save();
  pen.translate(12, top + high / 2);
  pen.rotate(-Math.PI / 2);
  pen.fillText(frame.y_name, 0, 0);
  pen.restore();

  pen.save();
  pen.beginPath();
  pen.rect(left, top, wide, high);
  pen.clip();
  pen.strokeStyle = color_of("--ink");
  pen.lineWidth = 2;
  for (const wall of frame.walls) {
    pen.beginPath();
    if (wall.axis === "x") pen.moveTo(px(wall.value), top), pen.lineTo(px(wall.value), top + high);
    else pen.moveTo(left, py(wall.value)), pen.lineTo(left + wide, py(wall.value));
    pen.stroke();
  }
  for (const curve of curves) {
    pen.strokeStyle = pen.fillStyle = curve.color;
    pen.lineWidth = 1.2;
    if (curve.joined) {
      pen.beginPath();
      for (let i = 0; i < curve.x.length; ++i) pen.lineTo(px(curve.x[i]!), py(curve.y[i]!));
      pen.stroke();
    } else {
      for (let i = 0; i < curve.x.length; ++i) pen.fillRect(px(curve.x[i]!) - 0.8, py(curve.y[i]!) - 0.8, 1.6, 1.6);
    }
    if (curve.mark >= 0 && curve.mark < curve.x.length) {
      pen.beginPath();
      pen.arc(px(curve.x[curve.mark]!), py(curve.y[curve.mark]!), 5, 0, 2 * Math.PI);
      pen.fill();
    }
  }
  pen.restore();
  return (at_x, at_y) => [x0 + ((at_x - left) / wide) * (x1 - x0), y1 - ((at_y - top) / high) * (y1 - y0)];
}

/// The same curves as a picture of lines.
export function plane_as_svg(curves: Curve[], frame: Frame, width = 720, height = 540): string {
  let [x0, x1] = range_of(curves, "x", []);
  let [y0, y1] = range_of(curves, "y", []);
  const wide = width - left - right;
  const high = height - top - bottom;
  if (frame.equal) {
    const unit = Math.max((x1 - x0) / wide, (y1 - y0) / high);
    [x0, x1] = [(x0 + x1 - unit * wide) / 2, (x0 + x1 + unit * wide) / 2];
    [y0, y1] = [(y0 + y1 - unit * high) / 2, (y0 + y1 + unit * high) / 2];
  }
  const px = (x: number): string => (left + ((x - x0) / (x1 - x0)) * wide).toFixed(2);
  const py = (y: number): string => (top + ((y1 - y) / (y1 - y0)) * high).toFixed(2);
  const escaped = (text: string): string => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
  const parts = [`<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" font-family="sans-serif" font-size="12">`];
  parts.push(`<rect x="${left}" y="${top}" width="${wide}" height="${high}" fill="none" stroke="#888"/>`);
  for (const mark of marks(x0, x1, 6)) parts.push(`<text x="${px(mark)}" y="${height - bottom + 18}" text-anchor="middle">${short(mark)}</text>`);
  for (const mark of marks(y0, y1, 6)) parts.push(`<text x="${left - 6}" y="${py(mark)}" text-anchor="end" dominant-baseline="middle">${short(mark)}</text>`);
  parts.push(`<text x="${left + wide / 2}" y="${height - 4}" text-anchor="middle">${escaped(frame.x_name)}</text>`);
  parts.push(`<text transform="translate(14 ${top + high / 2}) rotate(-90)" text-anchor="middle">${escaped(frame.y_name)}</text>`);
  for (const curve of curves) {
    const points = Array.from(curve.x, (x, i) => `${px(x)},${py(curve.y[i]!)}`);
    if (curve.joined) parts.push(`<polyline fill="none" stroke="${curve.color}" points="${points.join(" ")}"/>`);
    else for (const point of points) parts.push(`<circle r="0.8" fill="${curve.color}" cx="${point.split(",")[0]}" cy="${point.split(",")[1]}"/>`);
  }
  return parts.join("\n") + "\n</svg>\n";
}
