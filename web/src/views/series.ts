// Columns against time, by uPlot.
import uPlot from "uplot";
import { color_of } from "./plane";

export class Series {
  private plot: uPlot | undefined;

  constructor(private readonly parent: HTMLElement) {
    new ResizeObserver(() => this.plot?.setSize({ width: parent.clientWidth, height: 150 })).observe(parent);
  }

  /// Removes the plot: its colors or the number of its curves have changed.
  reset(): void {
    this.plot?.destroy();
    this.plot = undefined;
  }

  /// @param curves values over the same times, one array for each motion
  draw(times: Float64Array, curves: Float64Array[]): void {
    const data: uPlot.AlignedData = [Array.from(times), ...curves.map((each) => Array.from(each))];
    if (this.plot !== undefined && this.plot.series.length === data.length) {
      this.plot.setData(data);
      return;
    }
    this.reset();
    const colors = ["--first", "--second"];
    const axis = { stroke: color_of("--faint"), grid: { stroke: color_of("--line"), width: 0.5 }, ticks: { stroke: color_of("--line") } };
    const value = (_: uPlot, all: number[]): string[] => all.map((x) => (x === 0 ? "0" : String(Number(x.toPrecision(3)))));
    this.plot = new uPlot(
      {
        width: this.parent.clientWidth,
        height: 150,
        scales: { x: { time: false } },
        axes: [{ ...axis, values: value }, { ...axis, values: value, size: 70 }],
        series: [{}, ...curves.map((_, i) => ({ stroke: color_of(colors[i]!), width: 1.2, points: { show: false } }))],
        cursor: { show: false },
      },
      data,
      this.parent,
    );
  }
}
