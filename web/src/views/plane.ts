// A plane with axes, drawn on a canvas or as SVG: orbits, particles and sections.

export interface Curve {
  x: Float64Array;
  y: Float64Array;
  color: string;
  kind: "line" | "points" | "discs";
  radius: number; // of discs, in units of the axes
  mark: number; // the row that is marked; -1: none
}

export interface Range {
  x0: number;
  x1: number;
  y0: number;
  y1: number;
}

export interface Frame {
  x_name: string;
  y_name: string;
  equal: boolean; // one unit has the same length on both axes
  walls: { axis: "x" | "y"; value: number }[];
  range: Range | null; // null: that of the curves and walls
}

/// The color of a name of style.css.
export function color_of(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

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
  return x === 0 ? "0" : String(Number(x.toPrecision(4)));
}

function range_of_axis(curves: Curve[], frame: Frame, axis: "x" | "y"): [number, number] {
  let least = Infinity;
  let most = -Infinity;
  const look = (value: number): void => {
    if (!Number.isFinite(value)) return;
    least = Math.min(least, value);
    most = Math.max(most, value);
  };
  for (const curve of curves) curve[axis].forEach(look);
  for (const wall of frame.walls) if (wall.axis === axis) look(wall.value);
  if (least > most) return [-1, 1];
  const room = 0.06 * (most - least) || Math.max(Math.abs(most) * 0.1, 0.1);
  return [least - room, most + room];
}

const left = 62;
const bottom = 40;
const top = 10;
const right = 12;

/// The range of the axes, and where its points are in a picture.
interface Layout {
  range: Range;
  wide: number;
  high: number;
  px: (x: number) => number;
  py: (y: number) => number;
}

function layout(curves: Curve[], frame: Frame, width: number, height: number): Layout {
  let { x0, x1, y0, y1 } = frame.range ?? { x0: 0, x1: 0, y0: 0, y1: 0 };
  if (frame.range === null) {
    [x0, x1] = range_of_axis(curves, frame, "x");
    [y0, y1] = range_of_axis(curves, frame, "y");
  }
  const wide = Math.max(width - left - right, 1);
  const high = Math.max(height - top - bottom, 1);
  if (frame.equal) {
    const unit = Math.max((x1 - x0) / wide, (y1 - y0) / high);
    [x0, x1] = [(x0 + x1 - unit * wide) / 2, (x0 + x1 + unit * wide) / 2];
    [y0, y1] = [(y0 + y1 - unit * high) / 2, (y0 + y1 + unit * high) / 2];
  }
  return {
    range: { x0, x1, y0, y1 },
    wide,
    high,
    px: (x) => left + ((x - x0) / (x1 - x0)) * wide,
    py: (y) => top + ((y1 - y) / (y1 - y0)) * high,
  };
}

/// What a canvas shows, to find the place of the pointer.
export interface Shown {
  range: Range;
  at(px: number, py: number): [number, number];
}

export function draw_plane(canvas: HTMLCanvasElement, curves: Curve[], frame: Frame): Shown {
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const pen = canvas.getContext("2d")!;
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.fillStyle = color_of("--paper"); // so that an exported picture has a background
  pen.fillRect(0, 0, width, height);
  const { range, wide, high, px, py } = layout(curves, frame, width, height);
  const { x0, x1, y0, y1 } = range;

  pen.font = "12px system-ui, sans-serif";
  pen.lineWidth = 1;
  pen.strokeStyle = color_of("--line");
  pen.fillStyle = color_of("--faint");
  pen.textAlign = "center";
  pen.textBaseline = "top";
  for (const mark of marks(x0, x1, Math.max(2, wide / 90))) {
    pen.fillRect(px(mark), top + high, 1, 4);
    pen.fillText(short(mark), px(mark), top + high + 6);
  }
  pen.textAlign = "right";
  pen.textBaseline = "middle";
  for (const mark of marks(y0, y1, Math.max(2, high / 60))) {
    pen.fillRect(left - 4, py(mark), 4, 1);
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
  pen.fillStyle = color_of("--ink");
  for (const wall of frame.walls) {
    if (wall.axis === "x") pen.fillRect(px(wall.value) - 1, top, 2, high);
    else pen.fillRect(left, py(wall.value) - 1, wide, 2);
  }
  for (const curve of curves) {
    pen.strokeStyle = pen.fillStyle = curve.color;
    pen.lineWidth = 1.2;
    pen.beginPath();
    if (curve.kind === "line") {
      for (let i = 0; i < curve.x.length; ++i) pen.lineTo(px(curve.x[i]!), py(curve.y[i]!));
      pen.stroke();
    } else if (curve.kind === "points") {
      for (let i = 0; i < curve.x.length; ++i) pen.fillRect(px(curve.x[i]!) - 0.7, py(curve.y[i]!) - 0.7, 1.4, 1.4);
    } else {
      const radius = Math.max(1.5, (curve.radius / (x1 - x0)) * wide);
      for (let i = 0; i < curve.x.length; ++i) {
        pen.moveTo(px(curve.x[i]!) + radius, py(curve.y[i]!));
        pen.arc(px(curve.x[i]!), py(curve.y[i]!), radius, 0, 2 * Math.PI);
      }
      pen.fill();
    }
    if (curve.mark >= 0 && curve.mark < curve.x.length) {
      pen.beginPath();
      pen.arc(px(curve.x[curve.mark]!), py(curve.y[curve.mark]!), 5, 0, 2 * Math.PI);
      pen.fill();
    }
  }
  pen.restore();
  return {
    range,
    at: (at_x, at_y) => [x0 + ((at_x - left) / wide) * (x1 - x0), y1 - ((at_y - top) / high) * (y1 - y0)],
  };
}

/// The same picture as SVG.
export function plane_as_svg(curves: Curve[], frame: Frame, width = 720, height = 540): string {
  const { range, wide, high, px, py } = layout(curves, frame, width, height);
  const escaped = (text: string): string => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
  const at = (x: number): string => x.toFixed(2);
  const parts = [
    `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" font-family="sans-serif" font-size="12">`,
    `<clipPath id="inside"><rect x="${left}" y="${top}" width="${wide}" height="${high}"/></clipPath>`,
    `<rect x="${left}" y="${top}" width="${wide}" height="${high}" fill="none" stroke="#888"/>`,
  ];
  for (const mark of marks(range.x0, range.x1, 6)) parts.push(`<text x="${at(px(mark))}" y="${height - bottom + 18}" text-anchor="middle">${short(mark)}</text>`);
  for (const mark of marks(range.y0, range.y1, 6)) parts.push(`<text x="${left - 6}" y="${at(py(mark))}" text-anchor="end" dominant-baseline="middle">${short(mark)}</text>`);
  parts.push(`<text x="${left + wide / 2}" y="${height - 4}" text-anchor="middle">${escaped(frame.x_name)}</text>`);
  parts.push(`<text transform="translate(14 ${top + high / 2}) rotate(-90)" text-anchor="middle">${escaped(frame.y_name)}</text>`);
  parts.push('<g clip-path="url(#inside)">');
  for (const wall of frame.walls) {
    const place = wall.axis === "x" ? `x="${at(px(wall.value) - 1)}" y="${top}" width="2" height="${high}"` : `x="${left}" y="${at(py(wall.value) - 1)}" width="${wide}" height="2"`;
    parts.push(`<rect ${place} fill="#333"/>`);
  }
  for (const curve of curves) {
    if (curve.kind === "line") {
      const points = Array.from(curve.x, (x, i) => `${at(px(x))},${at(py(curve.y[i]!))}`);
      parts.push(`<polyline fill="none" stroke="${curve.color}" points="${points.join(" ")}"/>`);
    } else {
      const radius = curve.kind === "points" ? 0.8 : Math.max(1.5, (curve.radius / (range.x1 - range.x0)) * wide);
      curve.x.forEach((x, i) => parts.push(`<circle r="${at(radius)}" fill="${curve.color}" cx="${at(px(x))}" cy="${at(py(curve.y[i]!))}"/>`));
    }
  }
  return parts.join("\n") + "\n</g>\n</svg>\n";
}
