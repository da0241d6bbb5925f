// A Poincare section. A click is a start of the energy of the motion; its points come from workers of their own.
import { grown, range_of, within_turn } from "../drawing/layout";
import { color_of, draw_plane, frame_of, type Curve, type Frame, type Range, type Shown } from "../drawing/plane";
import { plane_as_svg } from "../drawing/svg";
import type { Engine } from "../engine/engine";
import { csv_of, save_text } from "../export";
import type { Laboratory } from "../laboratory";
import { made, text_of } from "../page/dom";
import { Recording } from "../state/recording";
import { axes_of, type SectionAxes } from "../state/section_axes";
import type { MakeView, View } from "../view";

const points_of_a_start = 2000;
const most_steps_without_point = 1e7;
const time_of_a_request = 60; // ms; then the picture shows more points
const time_to_gather = 20; // ms from a start to its integration, so that starts that come together are integrated together

interface Orbit {
  color: string; // empty: the motion itself
  points: Recording; // t, x and y of each
}
const orbit_of = (color: string): Orbit => ({ color, points: new Recording(3, Infinity) });

/// A start that waits for others.
interface Waiting {
  orbit: Orbit;
  set: string;
  is_given: boolean; // by an example: where the energy does not reach, it is left out
}

class Section implements View {
  place = "stage" as const;
  order = 20;
  root = made(`<figure id="section-figure" hidden>
    <figcaption id="section-title"></figcaption>
    <canvas id="section" role="img" aria-label="Section"></canvas>
    <div class="row" role="group" aria-label="Section">
      <label><span id="section-x-name"></span> <input id="section-x" size="7" inputmode="decimal"></label>
      <label><span id="section-y-name"></span> <input id="section-y" size="7" inputmode="decimal"></label>
      <button id="section-add" type="button">Add a start</button>
      <button id="section-in" type="button">Zoom in</button>
      <button id="section-all" type="button">Show all</button>
      <button id="section-clear" type="button">Clear</button>
      <button id="section-csv" type="button">section.csv</button>
      <button id="section-svg" type="button">section.svg</button>
      <output id="section-count"></output>
    </div></figure>`);
  private readonly canvas = this.root.querySelector("canvas")!;
  private axes: SectionAxes | null = null;
  private orbits: Orbit[] = [];
  private own = orbit_of("");
  private own_taken = 0; // numbers of the points of the motion that are in `own`
  private range: Range | null = null; // chosen by zooming or clicking; null: as wide as the points
  private usual: Range | null = null;
  private shown: Shown | undefined;
  private generation = 0; // requests of an earlier scenario end when it changes
  private readonly waiting: Waiting[] = [];
  private has_given = false; // the starts of the example are there
  private width = 0;
  private readonly row = new Float64Array(3); // for append(), which is called for each point
  private toml = "";
  private counted_at = 0;

  constructor(private readonly laboratory: Laboratory) {
    this.canvas.addEventListener("click", (event) => {
      const [x, y] = this.place_of(event);
      this.range ??= this.shown?.range ?? null; // the axes stay under the pointer
      this.add(x, y);
    });
    this.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(event.deltaY < 0 ? 0.8 : 1.25, this.place_of(event));
    }, { passive: false });
    new ResizeObserver(() => this.ask_to_draw()).observe(this.canvas);
    const button = (id: string): HTMLButtonElement => this.root.querySelector(`#section-${id}`)!;
    button("add").onclick = () => {
      const [x, y] = ["x", "y"].map((id) => Number(this.root.querySelector<HTMLInputElement>(`#section-${id}`)!.value)) as [number, number];
      this.add(x, y);
    };
    button("in").onclick = () => this.zoom(0.7);
    button("all").onclick = () => {
      this.range = null;
      this.ask_to_draw();
    };
    button("clear").onclick = () => this.clear();
    button("svg").onclick = () => save_text("section.svg", plane_as_svg(this.curves(), this.frame()), "image/svg+xml");
    button("csv").onclick = () => this.save_csv();
  }

  opened(): void {
    this.clear();
    const { recorded } = this.laboratory;
    this.own = orbit_of("");
    this.own_taken = 0;
    this.range = this.usual = null;
    this.has_given = false;
    this.toml = this.laboratory.toml;
    this.axes = null;
    if (recorded === null) {
      const { facts, state } = this.laboratory.first;
      this.axes = axes_of(facts, state.energy.initial);
      this.width = 1 + 2 * facts.q.length;
      text_of(this.root, "#section-title", `Section: click for a start${facts.q.length > 1 ? " of the same energy" : ""}, turn the wheel to zoom`);
    }
    this.root.hidden = this.axes === null;
    text_of(this.root, "#section-x-name", this.axes?.x_name ?? "");
    text_of(this.root, "#section-y-name", this.axes?.y_name ?? "");
  }

  private ask_to_draw(): void {
    this.laboratory.changed = true;
  }
  private place_of(event: MouseEvent): [number, number] {
    return this.shown?.at(event.offsetX, event.offsetY) ?? [0, 0];
  }
  private zoom(factor: number, at?: [number, number]): void {
    if (this.shown === undefined) return;
    const { x0, x1, y0, y1 } = this.shown.range;
    const [x, y] = at ?? [(x0 + x1) / 2, (y0 + y1) / 2];
    this.range = { x0: x + (x0 - x) * factor, x1: x + (x1 - x) * factor, y0: y + (y0 - y) * factor, y1: y + (y1 - y) * factor };
    this.ask_to_draw();
  }

  /// Adds a start at this point of the section.
  private add(x: number, y: number, is_given = false): void {
    if (this.axes === null) return;
    const orbit = orbit_of(`hsl(${(this.orbits.length * 137.5) % 360} 70% ${color_of("--section-lightness")})`);
    this.orbits.push(orbit);
    this.waiting.push({ orbit, set: this.axes.start(x, y), is_given });
    if (this.waiting.length === 1) setTimeout(() => this.share_out(), time_to_gather);
  }
  /// Gives the starts that wait to the engines, in equal parts: an engine integrates up to 16 in nearly the time of one.
  private share_out(): void {
    const { generation } = this;
    const { pool } = this.laboratory;
    const share = Math.ceil(this.waiting.length / pool.most);
    while (this.waiting.length > 0) {
      const part = this.waiting.splice(0, share);
      pool.run((engine) => this.integrate(engine, part, generation)).catch((error: unknown) => generation === this.generation && this.laboratory.complain(error));
    }
  }
  private clear(): void {
    ++this.generation;
    this.waiting.length = 0;
    this.orbits = [];
    this.ask_to_draw();
  }

  private append(orbit: Orbit, points: ArrayLike<number>, from: number, to: number): void {
    const is_turned = this.laboratory.display.turns;
    const within = is_turned ? within_turn : (value: number): number => value;
    for (let at = from; at + this.width <= to; at += this.width) {
      this.row.set([points[at]!, within(points[at + this.axes!.x]!), within(points[at + this.axes!.y]!)]);
      orbit.points.append(this.row);
    }
  }

  /// Gives starts to an engine.
  /// @returns those that exist: a point of the section may need more than the energy
  private async begun(engine: Engine, starts: Waiting[]): Promise<Waiting[]> {
    const begin = (some: Waiting[]): Promise<unknown> => engine.call("starts", 0, this.toml, some.map(({ set }) => set).join("\n"));
    try {
      await begin(starts);
      return starts;
    } catch (error) {
      if (starts.length === 1 && !starts[0]!.is_given) throw error;
    }
    const possible: Waiting[] = [];
    for (const each of starts) await begin([each]).then(() => possible.push(each), (error: unknown) => each.is_given || this.laboratory.complain(error));
    if (possible.length > 0) await begin(possible);
    return possible;
  }

  private async integrate(engine: Engine, starts: Waiting[], generation: number): Promise<void> {
    if (generation !== this.generation) return;
    const mine = await this.begun(engine, starts);
    let ended = mine.map(() => false);
    while (!ended.every((each) => each)) {
      const { rows, value } = await engine.call("points_of_starts", 0, points_of_a_start, time_of_a_request);
      if (generation !== this.generation) return;
      for (let at = 0; at + this.width < rows.length; at += 1 + this.width) this.append(mine[rows[at]!]!.orbit, rows, at + 1, at + 1 + this.width);
      this.ask_to_draw();
      const failures = value.failures.filter((each, i) => each !== "" && !ended[i]);
      if (failures.length > 0) this.laboratory.complain(failures.join("; "));
      // A start without a point after so many steps does not come back to the section.
      ended = mine.map((_, i) => value.failures[i] !== "" || value.counts[i]! >= points_of_a_start || (value.counts[i] === 0 && value.step > most_steps_without_point));
    }
  }

  private curves(): Curve[] {
    const { marked, tracks } = this.laboratory;
    const until = marked < 0 ? Infinity : tracks[0]!.rows.at(this.laboratory.row(tracks[0]!), 0);
    return [this.own, ...this.orbits].map(({ color, points }) => {
      const { count } = points;
      const later = color === "" && until < Infinity ? points.column(0).findIndex((time) => Math.abs(time) > Math.abs(until)) : -1;
      const mark = color === "" && marked >= 0 && count > 0 ? (later < 0 ? count - 1 : Math.max(0, later - 1)) : -1;
      return { x: points.column(1), y: points.column(2), color: color || color_of("--first"), kind: "points", radius: 0, mark };
    });
  }
  private frame(): Frame {
    return { ...frame_of(this.axes?.x_name ?? "", this.axes?.y_name ?? ""), range: this.range };
  }

  draw(): void {
    if (this.axes === null || this.canvas.clientWidth === 0) return;
    const { points, state } = this.laboratory.first;
    // Their engines would be slower than the first picture of the motion, and make it late.
    if (!this.has_given && (state.step > 0 || !this.laboratory.playing)) {
      this.has_given = true;
      for (const [x, y] of this.laboratory.starts) this.add(x, y, true);
    }
    if (points.length > this.own_taken) {
      this.append(this.own, points, this.own_taken, points.length);
      this.own_taken = points.length;
    }
    const curves = this.curves();
    const frame = this.frame();
    if (frame.range === null) this.usual = grown(this.usual, this.usual_range(curves));
    this.shown = draw_plane(this.canvas, curves, { ...frame, range: frame.range ?? this.usual }, `section ${this.generation} ${this.toml}`);
    const now = performance.now();
    if (now - this.counted_at < 100) return void (this.laboratory.changed = true); // for the last count, and readers of the screen
    this.counted_at = now;
    text_of(this.root, "#section-count", `${curves.reduce((sum, curve) => sum + curve.x.length, 0)} points`);
  }

  /// Wide enough for the whole motion, so that there is room for clicks before it has points of its own.
  private usual_range(curves: Curve[]): Range {
    const { first, display } = this.laboratory;
    const whole = { x: first.recording.column(this.axes!.x), y: first.recording.column(this.axes!.y) };
    if (display.turns) whole.x = whole.y = Float64Array.of(-Math.PI, Math.PI);
    return range_of([...curves, whole], this.frame());
  }

  private save_csv(): void {
    const rows = [this.own, ...this.orbits].flatMap(({ points }, start) =>
      Array.from({ length: points.count }, (_, i) => [start, points.at(i, 0), points.at(i, 1), points.at(i, 2)]));
    save_text("section.csv", csv_of(["start", "t", this.frame().x_name, this.frame().y_name], rows), "text/csv");
  }
}

export const make: MakeView = (laboratory) => new Section(laboratory);
