// Columns against time, by uPlot.
import uPlot from "uplot";
import { color_of, short } from "./plane";

const height = 150;

export class Series {
  private plot: uPlot | undefined;

  constructor(private readonly parent: HTMLElement) {
    new ResizeObserver(() => this.plot?.setSize({ width: parent.clientWidth, height })).observe(parent);
  }

  /// Removes the plot: its colors have changed.
  reset(): void {
    this.plot?.destroy();
    this.plot = undefined;
  }

  /// @param curves values over the same times, one array for each motion
  draw(times: Float64Array, curves: Float64Array[]): void {
    const data: uPlot.AlignedData = [times, ...curves];
    if (this.plot !== undefined && this.plot.series.length === data.length) {
      this.plot.setData(data);
      return;
    }
    this.reset();
    const colors = ["--first", "--second"];
    const axis = { stroke: color_of("--faint"), grid: { stroke: color_of("--line"), width: 0.5 }, ticks: { stroke: color_of("--line") } };
    const values = (_: uPlot, all: number[]): string[] => all.map(short);
    this.plot = new uPlot(
      {
        width: this.parent.clientWidth,
        height,
        scales: { x: { time: false } },
        axes: [{ ...axis, values }, { ...axis, values, size: 78 }],
        series: [{}, ...curves.map((_, i) => ({ stroke: color_of(colors[i]!), width: 1.2, points: { show: false } }))],
        cursor: { show: false },
        legend: { show: false },
      },
      data,
      this.parent,
    );
  }
}
