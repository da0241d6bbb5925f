// The picture of a plane as SVG.
import { layout, marks, short } from "./layout";
import { most_drawn, type Curve, type Frame } from "./plane";

const at = (x: number): string => x.toFixed(2);
const escaped = (text: string): string => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");

export function plane_as_svg(curves: Curve[], frame: Frame, width = 720, height = 540): string {
  const place = layout(curves, frame, width, height);
  const { range, left, top, wide, high, px, py } = place;
  const parts = [
    `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" font-family="sans-serif" font-size="12">`,
    `<rect width="${width}" height="${height}" fill="#fff"/>`,
    `<clipPath id="inside"><rect x="${left}" y="${top}" width="${wide}" height="${high}"/></clipPath>`,
    `<rect x="${left}" y="${top}" width="${wide}" height="${high}" fill="none" stroke="#888"/>`,
  ];
  for (const mark of marks(range.x0, range.x1, 6)) parts.push(`<text x="${at(px(mark))}" y="${top + high + 18}" text-anchor="middle">${short(mark)}</text>`);
  for (const mark of marks(range.y0, range.y1, 6)) parts.push(`<text x="${left - 6}" y="${at(py(mark))}" text-anchor="end" dominant-baseline="middle">${short(mark)}</text>`);
  parts.push(`<text x="${left + wide / 2}" y="${height - 4}" text-anchor="middle">${escaped(frame.x_name)}</text>`);
  parts.push(`<text transform="translate(14 ${top + high / 2}) rotate(-90)" text-anchor="middle">${escaped(frame.y_name)}</text>`);
  parts.push('<g clip-path="url(#inside)">');
  for (const wall of frame.walls) {
    const line = wall.axis === "x" ? `x="${at(px(wall.value) - 1)}" y="${top}" width="2" height="${high}"` : `x="${left}" y="${at(py(wall.value) - 1)}" width="${wide}" height="2"`;
    parts.push(`<rect ${line} fill="#333"/>`);
  }
  if (frame.circle > 0) parts.push(`<ellipse cx="${at(px(0))}" cy="${at(py(0))}" rx="${at(px(frame.circle) - px(0))}" ry="${at(py(0) - py(frame.circle))}" fill="none" stroke="#333" stroke-width="2"/>`);
  for (const curve of curves) {
    const every = Math.max(1, Math.ceil(curve.x.length / most_drawn));
    const rows = Array.from({ length: Math.ceil(curve.x.length / every) }, (_, i) => i * every);
    if (curve.kind === "line") {
      const points = rows.map((i) => `${at(px(curve.x[i]!))},${at(py(curve.y[i]!))}`);
      parts.push(`<polyline fill="none" stroke="${curve.color}" points="${points.join(" ")}"/>`);
    } else {
      const radius = curve.kind === "points" ? 0.8 : Math.max(2, px(curve.radius) - px(0));
      for (const i of rows) parts.push(`<circle r="${at(radius)}" fill="${curve.color}" cx="${at(px(curve.x[i]!))}" cy="${at(py(curve.y[i]!))}"/>`);
    }
  }
  return parts.join("\n") + "\n</g>\n</svg>\n";
}
