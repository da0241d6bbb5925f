// The picture of the motion: two columns against each other, three in space, or all bodies.
import { grown, range_of, within_turn, type Range } from "../drawing/layout";
import { color_of, draw_plane, frame_of, type Curve, type Frame, type Shown } from "../drawing/plane";
import { draw_space, ends_of, grown_ends, type Look, type SpaceCurve } from "../drawing/space";
import { plane_as_svg } from "../drawing/svg";
import { save, save_text } from "../export";
import type { Laboratory, Track } from "../laboratory";
import { element, label_of, made } from "../page/dom";
import type { MakeView, View } from "../view";
import { StartHandle } from "../page/start_handle";

const most_paths = 40; // of more bodies only the places are drawn

const body_color = (i: number): string => `hsl(${(i * 137.5 + 210) % 360} 65% ${color_of("--section-lightness")})`;

class Orbit implements View {
  place = "stage" as const;
  order = 10;
  root = made(`<div>
    <div class="row" role="group" aria-label="Columns">
      <label>x <input id="x" list="columns" size="10" autocomplete="off"></label>
      <label>y <input id="y" list="columns" size="10" autocomplete="off"></label>
      <label>z <input id="z" list="columns" size="6" autocomplete="off" placeholder="none"></label>
      <datalist id="columns"></datalist>
      <label><input id="equal" type="checkbox"> equal axes</label>
      <label id="tracks-label" hidden><input id="tracks" type="checkbox"> all bodies</label>
    </div>
    <p id="legend" hidden></p>
    <canvas id="orbit" role="img" aria-label="Orbit"></canvas></div>`);
  private readonly canvas = this.root.querySelector("canvas")!;
  private readonly input = (id: string): HTMLInputElement => this.root.querySelector(`#${id}`)!;
  private range: Range | null = null;
  private range_version = "";
  private bodies_of: string[] = []; // the columns in which `bodies` were found
  private bodies: number[][] = [];
  private ends: [number, number][] | null = null;
  private look: Look = { turn: 0.6, tilt: 0.45 };
  private shown: Shown | undefined;
  private readonly handle: StartHandle;

  constructor(private readonly laboratory: Laboratory) {
    this.handle = new StartHandle(laboratory, this.canvas, () => (this.is_plane ? this.shown : undefined));
    for (const id of ["x", "y", "z"]) this.input(id).onchange = () => this.choose_columns();
    for (const [id, key] of [["equal", "equal"], ["tracks", "bodies"]] as const) {
      this.input(id).onchange = () => {
        laboratory.display[key] = this.input(id).checked;
        this.forget_ranges();
      };
    }
    this.canvas.addEventListener("pointermove", (event) => {
      if (this.is_plane || (event.buttons & 1) === 0) return;
      this.turn(-event.movementX * 0.01, event.movementY * 0.01);
    });
    this.canvas.addEventListener("keydown", (event) => {
      const [turn, tilt] = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key] ?? [0, 0];
      if (this.is_plane || turn === tilt) return;
      event.preventDefault();
      event.stopPropagation(); // the right arrow steps elsewhere
      this.turn(turn!, tilt!);
    });
    new ResizeObserver(() => (laboratory.changed = true)).observe(this.canvas);
    element("save-svg").onclick = () => {
      const { curves, frame } = this.plane();
      save_text("orbit.svg", plane_as_svg(curves, frame), "image/svg+xml");
    };
    element("save-png").onclick = () => this.canvas.toBlob((picture) => picture && save("orbit.png", picture));
  }

  private turn(turn: number, tilt: number): void {
    this.look.turn += turn;
    this.look.tilt = Math.max(-1.5, Math.min(1.5, this.look.tilt + tilt));
    this.laboratory.changed = true;
  }
  private choose_columns(): void {
    this.forget_ranges();
    void this.laboratory.show(this.input("x").value, this.input("y").value, this.input("z").value);
  }
  private forget_ranges(): void {
    this.range = this.ends = null;
    this.laboratory.changed = true;
  }

  opened(): void {
    const { display, recorded, motions } = this.laboratory;
    if (!this.handle.is_dragged) this.forget_ranges(); // the axes stay under the pointer
    for (const id of ["x", "y", "z"] as const) this.input(id).value = display[id];
    this.input("equal").checked = display.equal;
    this.input("tracks").checked = display.bodies;
    const observables = recorded === null ? motions[0]!.facts.observables.map((each) => each.name) : [];
    const names = new Set([...this.laboratory.tracks[0]!.columns, ...observables]);
    this.root.querySelector("datalist")!.replaceChildren(...Array.from(names, (value) => Object.assign(document.createElement("option"), { value })));
    this.root.querySelector<HTMLElement>("#tracks-label")!.hidden = this.body_columns(this.laboratory.tracks[0]!).length === 0;
    this.handle.opened();
  }

  /// The columns of x, y and, if there is one, z of each body: names such as x1 and y1.
  private body_columns({ columns }: Track): number[][] {
    if (columns === this.bodies_of) return this.bodies; // there may be thousands
    const places = new Map(columns.map((name, i) => [name, i]));
    this.bodies = columns.flatMap((name, x) => {
      const number = /^x(\d+)$/.exec(name)?.[1];
      const [y, z] = [places.get(`y${number}`), places.get(`z${number}`)];
      return number === undefined || y === undefined ? [] : [z === undefined ? [x, y] : [x, y, z]];
    });
    this.bodies_of = columns;
    return this.bodies;
  }
  private get shows_bodies(): boolean {
    return this.laboratory.display.bodies && this.body_columns(this.laboratory.tracks[0]!).length > 0;
  }
  private get is_plane(): boolean {
    return this.laboratory.display.z === "";
  }
  private colors(track: number, body: number): string {
    if (this.laboratory.motions.length > 1 && this.laboratory.recorded === null) return color_of(track === 0 ? "--first" : "--second");
    return this.shows_bodies ? body_color(body) : color_of("--first");
  }

  private plane(): { curves: Curve[]; frame: Frame } {
    const { display, tracks } = this.laboratory;
    const frame: Frame = { ...frame_of(label_of(display.x), label_of(display.y)), equal: display.equal };
    const marked = (track: Track): number => (track.joined || this.laboratory.marked >= 0 ? this.laboratory.row(track) : -1);
    const at = (track: Track, name: string): Float64Array => track.rows.column(Math.max(track.columns.indexOf(name), 0));
    if (!this.shows_bodies) {
      this.add_walls(frame);
      frame.start = this.handle.place();
      const { is_turned } = this;
      const x_of = (track: Track): Float64Array => (is_turned ? at(track, display.x).map(within_turn) : at(track, display.x));
      const curves = tracks.map((track, i): Curve => ({ x: x_of(track), y: at(track, display.y), color: this.colors(i, 0), kind: track.joined && !is_turned ? "line" : "points", radius: 0, mark: marked(track) }));
      return { curves, frame };
    }
    const columns = this.body_columns(tracks[0]!);
    const unit = this.laboratory.unit("length");
    [frame.x_name, frame.y_name] = [`x${unit}`, `y${unit}`];
    if (this.is_gas) return { curves: tracks.flatMap((track) => this.gas(track, columns)), frame: this.vessel(frame) };
    const curves = tracks.flatMap((track, i) => columns.map(([x, y], body): Curve => ({ x: track.rows.column(x!), y: track.rows.column(y!), color: this.colors(i, body), kind: "line", radius: 0, mark: marked(track) })));
    return { curves, frame };
  }

  /// Whether x is an angle that is drawn from -pi to pi.
  private get is_turned(): boolean {
    const { display, tracks } = this.laboratory;
    return display.turns && !this.shows_bodies && display.x !== tracks[0]!.columns[0];
  }
  private get is_gas(): boolean {
    return this.particles !== null || this.body_columns(this.laboratory.tracks[0]!).length > most_paths;
  }
  private get particles() {
    return this.laboratory.recorded === null ? this.laboratory.first.facts.particles : null;
  }
  private add_walls(frame: Frame): void {
    if (this.laboratory.recorded !== null) return;
    const { facts } = this.laboratory.first;
    const { x, y } = this.laboratory.display;
    for (const wall of facts.walls) {
      for (const axis of ["x", "y"] as const) {
        if ((axis === "x" ? x : y) !== facts.q[wall.coordinate]) continue;
        if (wall.min !== null) frame.walls.push({ axis, value: wall.min, side: -1 });
        if (wall.max !== null) frame.walls.push({ axis, value: wall.max, side: 1 });
      }
    }
  }
  /// The vessel of a gas: a circle, hard walls, or a periodic box.
  private vessel(frame: Frame): Frame {
    if (this.particles === null) return frame;
    const { facts } = this.laboratory.first;
    const { radius, edges } = this.particles;
    frame.circle = radius;
    const walls = facts.walls.filter((wall) => /^[xy]1$/.test(facts.q[wall.coordinate] ?? ""));
    for (const { coordinate, min, max } of walls) {
      const axis = facts.q[coordinate]! === "x1" ? "x" : "y";
      if (min !== null) frame.walls.push({ axis, value: min, side: -1 });
      if (max !== null) frame.walls.push({ axis, value: max, side: 1 });
    }
    if (walls.length === 0 && edges.length >= 2) frame.box = { x0: -edges[0]! / 2, x1: edges[0]! / 2, y0: -edges[1]! / 2, y1: edges[1]! / 2 };
    return frame;
  }
  /// The particles of a row, in two colors: those that were in the left half at the start, and the others.
  private gas(track: Track, columns: number[][]): Curve[] {
    const { rows } = track;
    const row = this.laboratory.row(track);
    const first = columns.map(([x]) => rows.at(0, x!));
    const middle = [...first].sort((a, b) => a - b)[first.length >> 1]!;
    const box = this.vessel(frame_of("", "")).box;
    const inside = (value: number, edge: number): number => (box === null ? value : value - edge * Math.round(value / edge));
    return [true, false].map((is_left): Curve => {
      const mine = columns.filter((_, i) => first[i]! < middle === is_left);
      return {
        x: Float64Array.from(mine, ([x]) => inside(rows.at(row, x!), 2 * (box?.x1 ?? 1))),
        y: Float64Array.from(mine, ([, y]) => inside(rows.at(row, y!), 2 * (box?.y1 ?? 1))),
        color: color_of(is_left ? "--first" : "--second"), kind: "discs", radius: (this.particles?.repulsion ?? 0) / 2, mark: -1,
      };
    });
  }

  private space(): { curves: SpaceCurve[]; names: string[] } {
    const { display, tracks } = this.laboratory;
    const names = this.shows_bodies ? ["x", "y", "z"] : [display.x, display.y, display.z].map(label_of);
    const curves = tracks.flatMap((track, i) => {
      const bodies = this.shows_bodies ? this.body_columns(track) : [[display.x, display.y, display.z].map((name) => Math.max(track.columns.indexOf(name), 0))];
      return bodies.map(([x, y, z], body): SpaceCurve => ({
        at: [track.rows.column(x!), track.rows.column(y!), z === undefined ? new Float64Array(track.rows.count) : track.rows.column(z)],
        color: this.colors(i, body), joined: track.joined, mark: this.laboratory.row(track),
      }));
    });
    return { curves, names };
  }

  draw(): void {
    this.draw_legend();
    if (this.canvas.classList.contains("turns") === this.is_plane) {
      this.canvas.classList.toggle("turns", !this.is_plane);
      this.canvas.tabIndex = this.is_plane ? -1 : 0;
      this.canvas.setAttribute("aria-label", this.is_plane ? "Orbit" : "Orbit in space; the arrow keys turn it");
    }
    if (this.canvas.clientWidth === 0) return;
    if (!this.is_plane) {
      const { curves, names } = this.space();
      this.ends = grown_ends(this.ends, ends_of(curves, this.laboratory.display.equal));
      draw_space(this.canvas, curves, names, this.ends, this.look);
      return;
    }
    const { curves, frame } = this.plane();
    const { version } = this.laboratory;
    const is_kept = this.range !== null && (this.handle.is_dragged || version === this.range_version);
    if (!is_kept) this.range = this.range_for(curves, frame);
    this.range_version = version;
    this.shown = draw_plane(this.canvas, curves, { ...frame, range: this.range }, this.laboratory.trail_version);
  }

  private range_for(curves: Curve[], frame: Frame): Range {
    const found = grown(this.range, range_of(curves, frame));
    const track = this.laboratory.tracks[0]!;
    if (this.is_turned) return { ...found, x0: -Math.PI, x1: Math.PI };
    if (this.shows_bodies || this.laboratory.display.x !== track.columns[0] || track.rows.count < 2) return found;
    return { ...found, x0: track.rows.at(0, 0), x1: track.rows.at(track.rows.count - 1, 0) }; // time has no room at its sides
  }

  /// The names that the scenario gives, else numbers; with the masses, if these differ.
  private body_names(): string[] {
    const { recorded, motions } = this.laboratory;
    const settings = recorded === null ? motions[0]!.facts.settings : [];
    const text = (path: string): string => settings.find((each) => each.path === path)?.text ?? "";
    const names = Array.from(text("problem.bodies").matchAll(/\bname\s*=\s*["']([^"']*)["']/g), (found) => found[1]!);
    const masses = text("problem.masses").match(/[^\s,[\]]+/g) ?? [];
    const columns = this.body_columns(this.laboratory.tracks[0]!);
    const has_masses = masses.length === columns.length && new Set(masses).size > 1;
    return columns.map((_, i) => (names.length === columns.length ? names[i]! : `body ${i + 1}${has_masses ? `, mass ${masses[i]}` : ""}`));
  }

  private draw_legend(): void {
    const { motions, recorded } = this.laboratory;
    const gas = this.shows_bodies && this.is_gas && this.is_plane;
    const bodies = this.shows_bodies && !gas ? this.body_names() : [];
    const names = gas ? ["left half at the start", "right half"] : recorded === null && motions.length > 1 ? motions.map((motion) => motion.facts.method) : bodies;
    const legend = this.root.querySelector<HTMLElement>("#legend")!;
    legend.hidden = names.length === 0;
    while (legend.children.length < names.length) legend.append(made("<span></span>"));
    while (legend.children.length > names.length) legend.lastChild!.remove();
    names.forEach((name, i) => {
      const item = legend.children[i] as HTMLElement;
      if (item.textContent !== name) item.textContent = name;
      const color = gas ? (i === 0 ? "var(--first)" : "var(--second)") : this.colors(i, i);
      if (item.style.getPropertyValue("--dot") !== color) item.style.setProperty("--dot", color);
    });
  }
}

export const make: MakeView = (laboratory) => new Orbit(laboratory);
