// Columns against time, by uPlot.
import uPlot from "uplot";
import { extent, short, widened } from "./layout";
import { color_of } from "./plane";

const height = 150;

/// For each of `count` parts of the rows the least and the greatest value, so that a long column keeps its peaks.
export function envelope(times: Float64Array, curves: Float64Array[], count: number): Float64Array[] {
  const rows = times.length;
  if (rows <= 2 * count) return [times, ...curves.map((curve) => Float64Array.from({ length: rows }, (_, i) => curve[i] ?? NaN))];
  const found = [times, ...curves].map(() => new Float64Array(2 * count));
  for (let part = 0; part < count; ++part) {
    const from = Math.floor((part * rows) / count);
    const to = Math.floor(((part + 1) * rows) / count);
    found[0]![2 * part] = found[0]![2 * part + 1] = times[from]!;
    curves.forEach((curve, k) => {
      let least = NaN;
      let most = NaN;
      for (let i = from; i < to; ++i) {
        const value = curve[i] ?? NaN; // a second motion may have ended before
        if (!(value >= least)) least = value;
        if (!(value <= most)) most = value;
      }
      found[1 + k]![2 * part] = least;
      found[1 + k]![2 * part + 1] = most;
    });
  }
  return found;
}

export class Plot {
  private plot: uPlot | undefined;
  private mark = NaN;
  private x_name = "";
  private key = "";

  /// @param least_half the axis shows at least this far below and above 0; 0: any range   @param clicked gets a time
  constructor(private readonly parent: HTMLElement, private readonly least_half: number, clicked: (time: number) => void) {
    parent.addEventListener("click", (event) => {
      const over = this.plot?.over.getBoundingClientRect();
      if (over !== undefined && event.clientX >= over.left) clicked(this.plot!.posToVal(event.clientX - over.left, "x"));
    });
    new ResizeObserver(() => this.plot?.setSize({ width: parent.clientWidth, height })).observe(parent);
  }

  /// Removes the plot: its colors have changed.
  reset(): void {
    this.plot?.destroy();
    this.plot = undefined;
  }

  private range(least: number | null, most: number | null): [number, number] {
    const ends = [least ?? NaN, most ?? NaN, ...(this.least_half > 0 ? [-this.least_half, this.least_half] : [])];
    const wide = widened(extent(ends) ?? [-1, 1]);
    const room = 0.05 * (wide[1] - wide[0]);
    return [wide[0] - room, wide[1] + room];
  }

  /// @param key changes with the data   @param curves makes the values over the same times, one array for each motion
  /// @param mark a time that is marked; NaN: none
  draw(key: string, x_name: string, times: Float64Array, curves: () => Float64Array[], mark: number): void {
    const is_moved = !Object.is(mark, this.mark);
    this.mark = mark;
    if (this.plot !== undefined && key === this.key) {
      if (is_moved) this.plot.redraw(false);
      return;
    }
    this.key = key;
    const data = envelope(times, curves(), Math.max(100, this.parent.clientWidth)) as unknown as uPlot.AlignedData;
    if (this.plot !== undefined && this.plot.series.length === data.length && this.x_name === x_name) {
      this.plot.setData(data);
      return;
    }
    this.reset();
    this.x_name = x_name;
    const colors = ["--first", "--second"];
    const values = (_: uPlot, all: number[]): string[] => all.map(short);
    const axis = { stroke: color_of("--faint"), grid: { stroke: color_of("--line"), width: 0.5 }, ticks: { stroke: color_of("--line") }, values };
    this.plot = new uPlot(
      {
        width: this.parent.clientWidth,
        height,
        scales: { x: { time: false }, y: { range: (_, least, most) => this.range(least, most) } },
        axes: [{ ...axis, label: x_name, labelSize: 16, labelFont: "12px system-ui, sans-serif", size: 28 }, { ...axis, size: 78, space: 22 }],
        series: [{}, ...data.slice(1).map((_, i) => ({ stroke: color_of(colors[i] ?? "--faint"), width: 1.2, points: { show: false } }))],
        cursor: { show: false },
        legend: { show: false },
        hooks: { draw: [(plot) => this.draw_mark(plot)] },
      },
      data,
      this.parent,
    );
  }

  private draw_mark(plot: uPlot): void {
    if (Number.isNaN(this.mark)) return;
    const { ctx, bbox } = plot;
    ctx.fillStyle = color_of("--ink");
    ctx.fillRect(Math.round(plot.valToPos(this.mark, "x", true)), bbox.top, window.devicePixelRatio || 1, bbox.height);
  }
}
