// A Poincare section. A click is a start of the energy of the motion; its points come from workers of their own.
import { Engine, EngineError } from "../engine/engine";
import type { Facts } from "../engine/protocol";
import { color_of, draw_plane, type Curve, type Frame, type Range, type Shown } from "./plane";

const points_of_a_start = 2000;
const most_workers = 4;

interface Orbit {
  color: string;
  points: number[]; // x and y of each
}

/// The axes of a section, and the start that belongs to a point of it.
export interface SectionAxes {
  x: number; // columns of a point: t, then all q, then all p
  y: number;
  x_name: string;
  y_name: string;
  /// PATH=VALUE
  start(x: number, y: number): string;
}

/// null: a click would not determine a start.
export function axes_of(facts: Facts, energy: number): SectionAxes | null {
  const section = facts.section;
  const n = facts.q.length;
  if (section === null) return null;
  if (n === 1 && !section.is_plane) {
    return { x: 1, y: 2, x_name: facts.q[0]!, y_name: facts.p[0]!, start: (x, y) => `problem.initial={ q = [${x}], p = [${y}] }` };
  }
  if (n !== 2 || !section.is_plane || section.momentum) return null;
  const fixed = section.coordinate;
  const other = 1 - fixed;
  const pair = (at_fixed: string | number, at_other: number): string => (fixed === 0 ? `${at_fixed}, ${at_other}` : `${at_other}, ${at_fixed}`);
  const root = section.direction < 0 ? '"-"' : '"+"';
  return {
    x: 1 + other,
    y: 3 + other,
    x_name: facts.q[other]!,
    y_name: facts.p[other]!,
    start: (x, y) => `problem.initial={ q = [${pair(section.value, x)}], p = [${pair(root, y)}], energy = ${energy} }`,
  };
}

export class SectionView {
  private axes: SectionAxes | null = null;
  private toml = "";
  private orbits: Orbit[] = [];
  private own: Orbit = { color: "", points: [] }; // of the motion itself
  private own_taken = 0;
  private range: Range | null = null;
  private shown: Shown | undefined;
  private generation = 0; // requests of an earlier scenario end when it changes
  private readonly workers: { engine: Engine; busy: boolean }[] = [];
  private readonly waiting: { orbit: Orbit; set: string }[] = [];
  private width = 0;
  turns = false; // draw angles modulo a turn

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly complain: (error: unknown) => void,
  ) {
    canvas.addEventListener("click", (event) => {
      const [x, y] = this.place(event);
      this.range ??= this.shown?.range ?? null; // the axes stay under the pointer
      this.add(x, y);
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(event.deltaY < 0 ? 0.8 : 1.25, this.place(event));
    }, { passive: false });
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  open(toml: string, facts: Facts, energy: number): void {
    ++this.generation;
    this.waiting.length = 0;
    this.toml = toml;
    this.axes = axes_of(facts, energy);
    this.width = 1 + 2 * facts.q.length;
    this.orbits = [];
    this.own = { color: "", points: [] };
    this.own_taken = 0;
    this.range = null;
    this.draw();
  }
  get is_open(): boolean {
    return this.axes !== null;
  }
  /// The number of points so far.
  get count(): number {
    return [this.own, ...this.orbits].reduce((sum, orbit) => sum + orbit.points.length / 2, 0);
  }
  /// Takes the points that a motion has found since the last call.
  take(points: number[]): void {
    if (this.axes === null || points.length === this.own_taken) return;
    this.append(this.own, points.slice(this.own_taken));
    this.own_taken = points.length;
    this.draw();
  }

  /// Adds a start at this point of the section.
  add(x: number, y: number): void {
    if (this.axes === null) return;
    const orbit: Orbit = { color: `hsl(${(this.orbits.length * 137.5) % 360} 70% ${color_of("--section-lightness")})`, points: [] };
    this.orbits.push(orbit);
    this.waiting.push({ orbit, set: this.axes.start(x, y) });
    const count = Math.min(navigator.hardwareConcurrency || 1, most_workers);
    if (this.workers.every((each) => each.busy) && this.workers.length < count) this.workers.push({ engine: new Engine(), busy: false });
    for (const worker of this.workers) if (!worker.busy) void this.work(worker);
  }
  clear(): void {
    ++this.generation;
    this.waiting.length = 0;
    this.orbits = [];
    this.draw();
  }
  zoom(factor: number, at?: [number, number]): void {
    if (this.shown === undefined) return;
    const { x0, x1, y0, y1 } = this.shown.range;
    const [x, y] = at ?? [(x0 + x1) / 2, (y0 + y1) / 2];
    this.range = { x0: x + (x0 - x) * factor, x1: x + (x1 - x) * factor, y0: y + (y0 - y) * factor, y1: y + (y1 - y) * factor };
    this.draw();
  }
  show_all(): void {
    this.range = null;
    this.draw();
  }

  private place(event: MouseEvent): [number, number] {
    return this.shown?.at(event.offsetX, event.offsetY) ?? [0, 0];
  }

  private append(orbit: Orbit, points: ArrayLike<number>): void {
    const within = (value: number): number => (this.turns ? value - 2 * Math.PI * Math.floor((value + Math.PI) / (2 * Math.PI)) : value);
    for (let at = 0; at + this.width <= points.length; at += this.width) {
      orbit.points.push(within(points[at + this.axes!.x]!), within(points[at + this.axes!.y]!));
    }
  }

  private async work(worker: { engine: Engine; busy: boolean }): Promise<void> {
    worker.busy = true;
    for (let next = this.waiting.shift(); next !== undefined; next = this.waiting.shift()) {
      const generation = this.generation;
      try {
        await worker.engine.call("open", 0, this.toml, next.set);
        let steps = 1000;
        while (generation === this.generation && next.orbit.points.length < 2 * points_of_a_start) {
          const before = performance.now();
          const answer = await worker.engine.call("advance", 0, steps, steps);
          if (generation !== this.generation) break;
          this.append(next.orbit, answer.points);
          next.orbit.points.length = Math.min(next.orbit.points.length, 2 * points_of_a_start);
          this.draw();
          if (answer.value.failed) throw new Error(answer.value.message);
          if (performance.now() - before < 40) steps *= 2;
          if (next.orbit.points.length === 0 && answer.value.step > 1e7) break; // it does not return
        }
      } catch (error) {
        if (generation === this.generation) this.complain(error instanceof EngineError ? error : String(error));
      }
    }
    worker.busy = false;
  }

  curves(): Curve[] {
    return [this.own, ...this.orbits].map((orbit) => ({
      x: Float64Array.from({ length: orbit.points.length / 2 }, (_, i) => orbit.points[2 * i]!),
      y: Float64Array.from({ length: orbit.points.length / 2 }, (_, i) => orbit.points[2 * i + 1]!),
      color: orbit.color || color_of("--first"),
      kind: "points",
      radius: 0,
      mark: -1,
    }));
  }
  frame(): Frame {
    return { x_name: this.axes?.x_name ?? "", y_name: this.axes?.y_name ?? "", equal: false, walls: [], range: this.range };
  }
  draw(): void {
    if (this.axes !== null && this.canvas.clientWidth > 0) this.shown = draw_plane(this.canvas, this.curves(), this.frame());
  }
}
