// A map of numbers in colors, with axes and a scale.
import { layout, marks, short, type Range } from "./layout";
import { color_of, draw_axes, frame_of, prepared, type Shown } from "./plane";

export interface Heat {
  columns: number;
  rows: number;
  values: Float64Array; // row after row; NaN: there is none
  coarse: Uint16Array; // 0: not computed yet; else 1 + the spacing of the cells when it was computed
  range: Range; // of the centres of the cells
  x_name: string;
  y_name: string;
  name: string; // of the numbers
}

const scale_width = 84;
const shades = 256;

/// From dark blue over green to bright yellow; lightness grows evenly, so that the order is seen without colors, too.
const palette: [number, number, number][] = Array.from({ length: shades }, (_, i) => {
  const at = i / (shades - 1);
  const hue = 275 - 215 * at;
  const lightness = 0.16 + 0.62 * at;
  const strength = 0.75 * Math.min(lightness, 1 - lightness);
  const channel = (n: number): number => {
    const k = (n + hue / 30) % 12;
    return Math.round(255 * (lightness - strength * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
  };
  return [channel(0), channel(8), channel(4)];
});

/// The same as numbers of an image; the alpha channel comes last.
const packed = Uint32Array.from(palette, ([red, green, blue]) => (255 << 24) | (blue << 16) | (green << 8) | red);

/// The scale of the numbers: logarithmic if they are positive and span three decades.
export interface Scale {
  least: number;
  most: number;
  is_logarithmic: boolean;
}
export function scale_of(values: Float64Array): Scale {
  const sorted = values.filter((value) => Number.isFinite(value)).sort();
  if (sorted.length === 0) return { least: 0, most: 1, is_logarithmic: false };
  const at = (part: number): number => sorted[Math.round(part * (sorted.length - 1))]!;
  const [least, most] = [at(0.01), at(0.99)]; // single cells do not decide
  if (least > 0 && most > 1000 * least) return { least, most, is_logarithmic: true };
  const half = Math.max((most - least) / 2, 1e-12 * Math.max(Math.abs(least), Math.abs(most)), Number.MIN_VALUE);
  return { least: (least + most) / 2 - half, most: (least + most) / 2 + half, is_logarithmic: false };
}
function position(value: number, { least, most, is_logarithmic }: Scale): number {
  const at = is_logarithmic ? Math.log(value / least) / Math.log(most / least) : (value - least) / (most - least);
  return Math.max(0, Math.min(1, at));
}

/// The number of a cell, or that of the cell before it in a coarser grid; undefined: not computed.
function known(heat: Heat, column: number, row: number): number | undefined {
  for (let spacing = 1; spacing <= 32; spacing *= 2) {
    const cell = column - (column % spacing) + (row - (row % spacing)) * heat.columns;
    if (heat.coarse[cell]! > 0) return heat.values[cell]!;
  }
  return undefined;
}

function painted(heat: Heat, scale: Scale): OffscreenCanvas {
  const picture = new OffscreenCanvas(heat.columns, heat.rows);
  const pen = picture.getContext("2d")!;
  const data = pen.createImageData(heat.columns, heat.rows);
  const pixels = new Uint32Array(data.data.buffer);
  for (let row = 0; row < heat.rows; ++row) {
    for (let column = 0; column < heat.columns; ++column) {
      const value = known(heat, column, row);
      if (value === undefined) continue;
      pixels[column + (heat.rows - 1 - row) * heat.columns] = Number.isFinite(value) ? packed[Math.round(position(value, scale) * (shades - 1))]! : 0xff808080;
    }
  }
  pen.putImageData(data, 0, 0);
  return picture;
}

function draw_scale(pen: CanvasRenderingContext2D, scale: Scale, name: string, left: number, top: number, high: number): void {
  for (let i = 0; i < high; ++i) {
    const [red, green, blue] = palette[Math.round((1 - i / high) * (shades - 1))]!;
    pen.fillStyle = `rgb(${red} ${green} ${blue})`;
    pen.fillRect(left, top + i, 14, 1.5);
  }
  const { least, most, is_logarithmic } = scale;
  const places = is_logarithmic ? marks(Math.log10(least), Math.log10(most), 5).filter(Number.isInteger).map((power) => 10 ** power) : marks(least, most, 5);
  pen.fillStyle = color_of("--faint");
  pen.textAlign = "left";
  pen.textBaseline = "middle";
  for (const place of places) pen.fillText(short(place), left + 18, top + (1 - position(place, scale)) * high);
  pen.save();
  pen.translate(left + scale_width - 14, top + high / 2);
  pen.rotate(-Math.PI / 2);
  pen.fillStyle = color_of("--ink");
  pen.textAlign = "center";
  pen.fillText(name, 0, 0);
  pen.restore();
}

/// @param cross a place that is marked, such as the start of the motion
export function draw_heat(canvas: HTMLCanvasElement, heat: Heat, cross: [number, number] | null): Shown {
  const { pen, width, height } = prepared(canvas);
  const { x0, x1, y0, y1 } = heat.range;
  const [half_x, half_y] = [(x1 - x0) / (heat.columns - 1) / 2, (y1 - y0) / (heat.rows - 1) / 2];
  const edges = { x0: x0 - half_x, x1: x1 + half_x, y0: y0 - half_y, y1: y1 + half_y };
  const frame = { ...frame_of(heat.x_name, heat.y_name), range: edges };
  const place = layout([], frame, width, height, scale_width + 10);
  const { left, top, wide, high, px, py } = place;
  const scale = scale_of(heat.values);
  pen.imageSmoothingEnabled = false;
  pen.drawImage(painted(heat, scale), left, top, wide, high);
  draw_axes(pen, place, frame);
  draw_scale(pen, scale, heat.name, left + wide + 10, top, high);
  if (cross !== null) {
    pen.strokeStyle = "#fff";
    pen.lineWidth = 2;
    pen.strokeRect(px(cross[0]) - 4, py(cross[1]) - 4, 8, 8);
    pen.strokeStyle = "#000";
    pen.lineWidth = 1;
    pen.strokeRect(px(cross[0]) - 5.5, py(cross[1]) - 5.5, 11, 11);
  }
  return {
    range: edges, px, py,
    at: (x, y) => [edges.x0 + ((x - left) / wide) * (edges.x1 - edges.x0), edges.y1 - ((y - top) / high) * (edges.y1 - edges.y0)],
  };
}
