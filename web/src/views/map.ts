// A map: a number for each pair of values of two keys, painted on all cores. A click starts the motion of a cell.
import { draw_heat, type Heat } from "../drawing/heat";
import { type Shown } from "../drawing/plane";
import type { Engine } from "../engine/engine";
import { csv_of, save, save_text } from "../export";
import type { Laboratory } from "../laboratory";
import { made, text_of } from "../page/dom";
import { tasks_of, type Task } from "../state/map_order";
import { entries_of, span_of_key, toml_number, with_value } from "../state/toml_edit";
import type { MakeView, View } from "../view";

const time_of_a_request = 120; // ms; then the picture shows more cells
const pause_of_pictures = 250; // ms
const names: Record<string, string> = { lyapunov: "Lyapunov exponent", energy_error: "energy error", relative_energy_error: "relative energy error", bounces: "bounces" };

interface Axis {
  key: string;
  from: number;
  to: number;
}
/// What is painted.
interface Painting {
  toml: string;
  x: Axis;
  y: Axis;
  observable: string;
  steps: number;
  heat: Heat;
  tasks: Task[];
  left: number; // cells that are not computed yet
  began: number;
}

class MapView implements View {
  place = "stage" as const;
  order = 50;
  root = made<HTMLDetailsElement>(`<details id="map-figure"><summary>Map over two keys</summary>
    <div class="row" role="group" aria-label="Map">
      <label>x <select id="map-x"></select></label><label>from <input id="map-x-from" size="5" inputmode="decimal"></label><label>to <input id="map-x-to" size="5" inputmode="decimal"></label>
    </div><div class="row" role="group" aria-label="Map, second key">
      <label>y <select id="map-y"></select></label><label>from <input id="map-y-from" size="5" inputmode="decimal"></label><label>to <input id="map-y-to" size="5" inputmode="decimal"></label>
    </div><div class="row">
      <label>Number <input id="map-observable" list="map-observables" size="16" value="lyapunov" autocomplete="off"></label>
      <datalist id="map-observables"></datalist>
      <label>Steps <input id="map-steps" size="6" inputmode="numeric" value="2000"></label>
      <label>Cells a side <input id="map-cells" size="4" inputmode="numeric" value="100"></label>
      <button id="map-paint" type="button">Paint</button>
    </div>
    <div id="map-painted" hidden>
      <p id="map-status" role="status"></p>
      <canvas id="map" role="img" aria-label="Map"></canvas>
      <p class="note">A click starts the motion of a cell. Grey: no start has these values, or the motion failed.</p>
      <div class="row"><button id="map-png" type="button">map.png</button><button id="map-csv" type="button">map.csv</button></div>
    </div></details>`);
  private readonly canvas = this.root.querySelector("canvas")!;
  private painting: Painting | null = null;
  private readonly begun = new WeakMap<Engine, Painting>(); // which map an engine knows
  private shown: Shown | undefined;
  private changed = true;
  private drawn_at = 0;
  private cross: [number, number] | null = null;
  private readonly field = (id: string): HTMLInputElement & HTMLSelectElement => this.root.querySelector(`#map-${id}`)!;

  constructor(private readonly laboratory: Laboratory) {
    this.field("observables").append(...Object.entries(names).map(([name, text]) => Object.assign(document.createElement("option"), { value: name, textContent: text })));
    this.field("paint").onclick = () => (this.painting !== null && this.painting.left > 0 ? this.stop() : void this.paint());
    this.root.addEventListener("toggle", () => this.offer_keys());
    for (const axis of ["x", "y"]) this.field(axis).onchange = () => this.offer_range(axis);
    this.canvas.onclick = (event) => void this.start_cell(event);
    this.field("png").onclick = () => this.canvas.toBlob((picture) => picture && save("map.png", picture));
    this.field("csv").onclick = () => this.save_csv();
    new ResizeObserver(() => this.ask_to_draw()).observe(this.canvas);
  }

  opened(): void {
    this.root.hidden = this.laboratory.recorded !== null;
    const { painting } = this;
    // The map stays while its own cells are started, and for the same keys.
    if (painting !== null && this.value_of(painting.x.key) === null) this.forget();
    this.place_cross();
    this.offer_keys();
  }
  restyle(): void {
    this.changed = true;
  }
  private ask_to_draw(): void {
    this.changed = true;
    this.laboratory.changed = true;
  }
  private stop(): void {
    const { painting } = this;
    if (painting !== null) painting.tasks.length = painting.left = 0;
    this.ask_to_draw();
  }
  private forget(): void {
    this.stop();
    this.painting = null;
    this.root.querySelector<HTMLElement>("#map-painted")!.hidden = true;
  }

  /// The value of a key in the text; null: there is no number.
  private value_of(key: string): number | null {
    if (this.laboratory.recorded !== null || this.laboratory.is_empty) return null;
    const { toml, first } = this.laboratory;
    const span = span_of_key(toml, first.facts.settings, key);
    const value = span === null ? NaN : Number(toml.slice(span.from, span.to));
    return Number.isFinite(value) ? value : null;
  }
  private offered = "";
  /// The keys of the text whose values are numbers, those of the start first.
  private offer_keys(): void {
    if (!this.root.open || this.laboratory.is_empty || this.laboratory.recorded !== null) return;
    const { toml, first } = this.laboratory;
    const settings = first.facts.settings.filter(({ path, line }) => line > 0 && path !== "run.steps");
    const all = settings.flatMap((setting) => [setting.path, ...entries_of(toml, setting).map((_, i) => `${setting.path}[${i}]`)]);
    const rank = (key: string): number => ["problem.initial.q", "problem.initial", "problem.", ""].findIndex((start) => key.startsWith(start));
    const keys = all.filter((key) => this.value_of(key) !== null).sort((a, b) => rank(a) - rank(b));
    if (keys.join() === this.offered) return;
    this.offered = keys.join();
    [["x", keys[0]], ["y", keys[1]]].forEach(([axis, chosen]) => {
      this.field(axis!).replaceChildren(...keys.map((key) => new Option(key.replace(/^problem\.|^run\./, ""), key, false, key === chosen)));
      this.offer_range(axis!);
    });
  }
  private offer_range(axis: string): void {
    const value = this.value_of(this.field(axis).value) ?? 0;
    const half = value === 0 ? 0.5 : Math.abs(value) * 0.5;
    this.field(`${axis}-from`).value = toml_number(value - half, 3);
    this.field(`${axis}-to`).value = toml_number(value + half, 3);
  }

  private async paint(): Promise<void> {
    const number = (id: string): number => Number(this.field(id).value);
    const axis = (name: string): Axis => ({ key: this.field(name).value, from: number(`${name}-from`), to: number(`${name}-to`) });
    const count = Math.round(Math.max(2, Math.min(1000, number("cells") || 0)));
    const [x, y] = [axis("x"), axis("y")];
    const observable = this.field("observable").value.trim();
    const label = (key: string): string => key.replace(/^problem\.|^run\./, "");
    const heat: Heat = {
      columns: count, rows: count, values: new Float64Array(count * count).fill(NaN), coarse: new Uint16Array(count * count),
      range: { x0: x.from, x1: x.to, y0: y.from, y1: y.to }, x_name: label(x.key), y_name: label(y.key), name: names[observable] ?? observable,
    };
    this.stop();
    const painting: Painting = { toml: this.laboratory.toml, x, y, observable, steps: number("steps"), heat, tasks: tasks_of(count, count), left: count * count, began: performance.now() };
    this.painting = painting;
    this.root.querySelector<HTMLElement>("#map-painted")!.hidden = false;
    this.place_cross();
    try {
      await Promise.all(Array.from({ length: this.laboratory.pool.most }, () => this.work(painting)));
      const seconds = (performance.now() - painting.began) / 1000;
      if (painting === this.painting) text_of(this.root, "#map-status", `${count} x ${count} cells of ${painting.steps} steps in ${seconds.toFixed(1)} s on ${this.laboratory.pool.most} cores`);
    } catch (error) {
      if (painting === this.painting) this.forget();
      this.laboratory.complain(error);
    }
    this.ask_to_draw();
  }
  private async work(painting: Painting): Promise<void> {
    while (painting.tasks.length > 0) {
      const task = painting.tasks.shift()!;
      const done = await this.laboratory.pool.run((engine) => this.compute(engine, painting, task));
      if (done < task.count && painting.left > 0) painting.tasks.unshift({ ...task, first: task.first + done * task.stride, count: task.count - done });
    }
  }
  private async compute(engine: Engine, painting: Painting, task: Task): Promise<number> {
    const { x, y, heat } = painting;
    if (this.begun.get(engine) !== painting) {
      const range = (axis: Axis, count: number): string => `${axis.key}=${axis.from}:${axis.to}:${count}`;
      await engine.call("map", 0, painting.toml, range(x, heat.columns), range(y, heat.rows), painting.observable, painting.steps);
      this.begun.set(engine, painting);
    }
    const { rows } = await engine.call("cells", 0, task.first, task.stride, task.count, time_of_a_request);
    rows.forEach((value, i) => {
      const cell = task.first + i * task.stride;
      heat.values[cell] = value;
      heat.coarse[cell] = 1 + task.spacing;
    });
    painting.left = Math.max(0, painting.left - rows.length);
    if (performance.now() - this.drawn_at > pause_of_pictures) this.ask_to_draw(); // the last cells are drawn by paint()
    return rows.length;
  }

  private async start_cell(event: MouseEvent): Promise<void> {
    const { painting, laboratory } = this;
    if (painting === null || this.shown === undefined) return;
    const { heat, x, y } = painting;
    const at = this.shown.at(event.offsetX, event.offsetY);
    const value = ({ from, to }: Axis, place: number, count: number): number => {
      const i = Math.max(0, Math.min(count - 1, Math.round(((place - from) / (to - from)) * (count - 1))));
      return from + (i * (to - from)) / (count - 1);
    };
    let { toml } = laboratory;
    const spans = [{ key: x.key, value: value(x, at[0], heat.columns) }, { key: y.key, value: value(y, at[1], heat.rows) }]
      .map((each) => ({ ...each, span: span_of_key(toml, laboratory.first.facts.settings, each.key) }));
    for (const each of spans.sort((a, b) => (b.span?.from ?? 0) - (a.span?.from ?? 0))) if (each.span !== null) toml = with_value(toml, each.span, toml_number(each.value, 12));
    if (await laboratory.open(toml)) laboratory.play();
  }
  private place_cross(): void {
    const { painting } = this;
    const at = painting === null ? [] : [this.value_of(painting.x.key), this.value_of(painting.y.key)];
    this.cross = typeof at[0] === "number" && typeof at[1] === "number" ? [at[0], at[1]] : null;
    this.changed = true;
  }

  draw(): void {
    const { painting } = this;
    if (!this.changed || painting === null || this.canvas.clientWidth === 0) return;
    this.changed = false;
    this.drawn_at = performance.now();
    this.shown = draw_heat(this.canvas, painting.heat, this.cross);
    const all = painting.heat.values.length;
    this.field("paint").textContent = painting.left > 0 ? "Stop" : "Paint";
    if (painting.left > 0) text_of(this.root, "#map-status", `${Math.round((100 * (all - painting.left)) / all)} % of ${all} cells`);
  }

  private save_csv(): void {
    const { heat, x, y, observable } = this.painting!;
    const at = ({ from, to }: Axis, i: number, count: number): number => from + (i * (to - from)) / (count - 1);
    const rows = Array.from(heat.values, (value, cell) => [at(x, cell % heat.columns, heat.columns), at(y, Math.floor(cell / heat.columns), heat.rows), value]);
    save_text("map.csv", csv_of([x.key, y.key, observable], rows), "text/csv");
  }
}

export const make: MakeView = (laboratory) => new MapView(laboratory);
