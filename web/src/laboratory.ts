// The state of the page: the motions or the recorded rows, the clock, and what is chosen to be shown.
import { Engine } from "./engine/engine";
import { EnginePool } from "./engine/pool";
import type { Certificate } from "./engine/protocol";
import { short } from "./drawing/plane";
import { gallery } from "./gallery/gallery";
import type { Inlined } from "./state/inlined";
import { with_method } from "./state/method";
import { Motion } from "./state/motion";
import { Recording } from "./state/recording";

/// What the views show; a link keeps it.
export interface Display {
  x: string; // columns or expressions; empty: the usual ones
  y: string;
  z: string; // empty: the picture is plane
  equal: boolean; // one unit has the same length on all axes
  bodies: boolean; // all bodies instead of x and y
  turns: boolean; // angles of the section modulo a turn
}

export const usual_display: Display = { x: "", y: "", z: "", equal: false, bodies: false, turns: false };

/// Rows that were computed before: of a run, or one for each member of a sweep.
export interface Recorded {
  given: Omit<Inlined, "rows">;
  rows: Recording;
}

/// Rows with named columns: of a motion, or recorded.
export interface Track {
  columns: string[];
  rows: Recording;
  joined: boolean; // the rows follow each other on a curve
}

const least_pause = 1500; // ms from one certificate to the next while the motion plays
const pause_of_certificates = 25; // times what the last one took: the motion waits for it
const numbers_a_frame = 4000; // that rows of a frame may have, more than one row: so that many columns stay fast

export class Laboratory {
  readonly engine = new Engine(gallery[0]!.toml);
  readonly pool = new EnginePool(); // for sections and maps
  private readonly both = [new Motion(this.engine, 0), new Motion(this.engine, 1)];
  motions: Motion[] = []; // open: the scenario, and beside it a second method
  recorded: Recorded | null = null; // in place of motions
  toml = "";
  is_edited = false; // the editor has another text than `toml`
  second = ""; // a method beside that of the scenario; empty: none
  display: Display = { ...usual_display };
  starts: [number, number][] = []; // of an example: points of the section at which orbits start
  speed = 10 ** 2.5; // steps a second
  playing = false;
  turned_at = -1; // the step at which the motion was reversed; -1: it was not
  marked = -1; // the row that is shown; -1: the last
  certificates: { method: string; found: Certificate }[] = [];
  returned = ""; // what came back after a reversal
  changed = true; // the views have to draw
  is_opening = false; // some motions are of the next scenario, others of the one before: there is nothing to draw
  private busy = false; // a request is under way
  private certified_at = 0; // time of the last certificate
  private certificate_pause = least_pause;
  private ticked_at = 0;
  private opened_count = 0;
  private asked_count = 0; // of open()

  /// @param opened called when another scenario or recording is there   @param complain called with what went wrong
  constructor(private readonly opened: () => void, readonly complain: (error: unknown) => void) {}

  get tracks(): Track[] {
    if (this.recorded !== null) {
      const { given, rows } = this.recorded;
      return [{ columns: given.columns, rows, joined: given.kind !== "sweep" }];
    }
    return this.motions.map((motion) => ({ columns: motion.columns(), rows: motion.recording, joined: !motion.facts.map }));
  }
  /// The row of a track that is shown.
  row(track: Track): number {
    return this.marked >= 0 ? Math.min(this.marked, track.rows.count - 1) : track.rows.count - 1;
  }
  /// The first motion; only if there are motions.
  get first(): Motion {
    return this.motions[0]!;
  }
  get last_step(): number {
    return this.turned_at < 0 ? this.first.facts.steps : 2 * this.turned_at;
  }
  /// " (AU)": a unit that the scenario names; empty: it names none.
  unit(of: "length" | "time"): string {
    const setting = this.recorded === null ? this.first.facts.settings.find(({ path }) => path === `problem.units.${of}`) : undefined;
    return setting === undefined ? "" : ` (${setting.text.replace(/['"]/g, "")})`;
  }
  /// Changes when rows do not only follow those before.
  get trail_version(): string {
    return `${this.opened_count} ${this.tracks.map(({ rows }) => `${rows.every}/${rows.width}`).join()} ${JSON.stringify(this.display)}`;
  }
  /// Changes with the rows.
  get version(): string {
    return `${this.opened_count} ${this.tracks.map(({ rows }) => `${rows.count}/${rows.every}/${rows.width}`).join()}`;
  }
  get is_empty(): boolean {
    return this.motions.length === 0 && this.recorded === null;
  }

  /// Runs one request at a time; a second one while it lasts is left out.
  private async exclusively(work: () => Promise<void>): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    try {
      await work();
    } catch (error) {
      this.playing = false;
      this.complain(error);
    } finally {
      this.busy = this.is_opening = false;
      this.changed = true;
    }
  }
  /// Waits for the last request of a motion that plays.
  private async when_free(work: () => Promise<void>): Promise<void> {
    while (this.busy) await new Promise((resolve) => setTimeout(resolve, 5));
    await this.exclusively(work);
  }

  /// Reads the scenario, and begins its motion. Of several calls the last one counts.
  /// @param shown what to show, the method beside it, and starts of the section; default: as before
  /// @returns whether the scenario is open
  async open(toml: string, shown: { display?: Display; second?: string; starts?: [number, number][] } = {}): Promise<boolean> {
    const number = ++this.asked_count;
    let is_open = false;
    await this.when_free(async () => {
      if (number !== this.asked_count) return;
      this.playing = false;
      this.is_opening = true;
      const [first, other] = this.both as [Motion, Motion];
      await first.open(toml);
      this.toml = toml;
      this.is_edited = false;
      Object.assign(this, shown);
      this.recorded = null;
      this.motions = [first];
      if (this.second !== "") {
        await other.open(with_method(toml, this.second));
        this.motions = [first, other];
      }
      Object.assign(this, { turned_at: -1, marked: -1, certified_at: 0, certificate_pause: least_pause, certificates: [], returned: "" });
      this.choose_usual_columns();
      try {
        await this.ask_columns();
      } catch { // the columns before are not of this scenario
        this.display = { ...usual_display };
        this.choose_usual_columns();
        await this.ask_columns();
      }
      ++this.opened_count;
      this.opened();
      is_open = true;
    });
    return is_open;
  }

  /// Opens a changed scenario and takes it to the step where the motion is, for at most this many milliseconds.
  async reopen(toml: string, most_time = 150): Promise<void> {
    const { playing } = this;
    const step = this.recorded === null && !this.is_empty ? this.first.state.step : 0;
    if (!(await this.open(toml))) return;
    this.playing = playing;
    if (playing) return;
    const began = performance.now();
    await this.when_free(async () => {
      let size = 64;
      while (this.first.state.step < Math.min(step, this.last_step) && !this.first.state.failed && performance.now() - began < most_time) {
        await this.advance(Math.min(size, step - this.first.state.step), 400);
        size *= 2;
      }
    });
  }

  private choose_usual_columns(): void {
    const { q, p } = this.first.facts;
    const { display } = this;
    if (display.x === "" && display.y === "" && q.includes("x1") && q.includes("y2")) display.bodies = display.equal = true;
    if (display.x === "" && display.y === "" && q.length === 3 && q.join() === "x,y,z") display.z = "z";
    if (display.x === "") display.x = q[0]!;
    if (display.y === "") display.y = q[1] ?? p[0]!;
  }
  private async ask_columns(): Promise<void> {
    const { x, y, z } = this.display;
    for (const motion of this.motions) await motion.show([x, y, z]);
  }
  /// Shows other columns. The rows of the motion begin anew if one of them is an expression.
  async show(x: string, y: string, z: string): Promise<void> {
    Object.assign(this.display, { x, y, z });
    this.changed = true;
    if (this.recorded !== null) return;
    await this.when_free(() => this.ask_columns());
  }

  /// Shows the rows of a run or the members of a sweep.
  show_recorded(given: Omit<Inlined, "rows">, numbers: Float64Array): void {
    this.playing = false;
    const rows = Recording.of(given.columns.length, numbers);
    this.recorded = { given, rows };
    this.toml = given.toml;
    this.is_edited = false;
    const [first = "", ...others] = given.columns;
    const is_bodies = given.kind === "run" && ["x1", "y1", "x2", "y2"].every((name) => given.columns.includes(name));
    this.display = { ...usual_display, x: others[0] ?? first, y: others[1] ?? first, bodies: is_bodies, equal: is_bodies };
    this.marked = rows.count - 1;
    ++this.opened_count;
    this.opened();
    this.changed = true;
  }

  private async advance(wanted: number, most_rows: number): Promise<void> {
    const { first } = this;
    const steps = Math.min(wanted, this.last_step - first.state.step);
    const rows = Math.max(1, Math.min(most_rows, Math.floor(numbers_a_frame / first.recording.width)));
    if (steps > 0) for (const motion of this.motions) await motion.advance(steps, Math.max(1, Math.floor(steps / rows)));
    const ended = first.state.step >= this.last_step || first.state.failed;
    if (ended) this.playing = false;
    if (ended && this.turned_at >= 0 && !first.state.failed) await this.compare_with_start();
    else if (ended || performance.now() - this.certified_at > this.certificate_pause) await this.certify();
  }

  private async compare_with_start(): Promise<void> {
    const lines: string[] = [];
    for (const motion of this.motions) {
      await motion.reverse();
      const { bits, equal, distance } = await motion.returned();
      lines.push(`${motion.facts.method}: ${equal} of ${bits} bits of the start came back; largest difference ${short(distance)}`);
    }
    this.turned_at = -1;
    this.returned = lines.join("; ");
  }

  /// Judges the motions so far. After a reversal there is nothing to judge; the first picture does not wait for a judgement.
  private async certify(): Promise<void> {
    if (!this.engine.has_rest) return;
    if (this.turned_at >= 0 || this.first.facts.map || this.motions.some((motion) => motion.state.failed || motion.state.step === 0)) return;
    const began = performance.now();
    const all: { method: string; found: Certificate }[] = [];
    for (const motion of this.motions) all.push({ method: motion.facts.method, found: await motion.certificate() });
    this.certificates = all;
    this.certified_at = performance.now();
    this.certificate_pause = Math.max(least_pause, pause_of_certificates * (this.certified_at - began));
  }

  play(): void {
    if (this.is_empty) return;
    this.playing = !this.playing;
    if (this.recorded === null) this.marked = -1;
    else if (this.playing && this.marked >= this.recorded.rows.count - 1) this.marked = 0;
    this.changed = true;
  }
  step(): void {
    this.playing = false;
    this.marked = -1;
    if (this.motions.length > 0 && this.recorded === null) void this.exclusively(() => this.advance(1, 1));
  }
  /// Turns the momenta and plays back to the start, where the bits are compared.
  reverse(): void {
    if (this.recorded !== null || this.is_empty) return;
    void this.when_free(async () => {
      if (this.turned_at >= 0 || this.first.state.step === 0) return;
      this.turned_at = this.first.state.step;
      for (const motion of this.motions) await motion.reverse();
      this.marked = -1;
      this.playing = true;
    });
  }
  mark(row: number): void {
    this.playing = false;
    this.marked = row;
    this.changed = true;
  }

  /// Marks the row that is nearest to a time.
  mark_time(time: number): void {
    const rows = this.tracks[0]!.rows;
    let [low, high] = [0, rows.count - 1];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (rows.at(middle, 0) < time) low = middle + 1;
      else high = middle;
    }
    this.mark(low);
  }

  /// Moves the motion that plays; once for each picture.
  tick(now: number): void {
    const seconds = Math.min((now - this.ticked_at) / 1000, 0.1); // a page that slept does not catch up
    if (this.busy && this.recorded === null) return; // the time of this picture is that of the next one, too
    this.ticked_at = now;
    if (!this.playing) return;
    const steps = Math.max(1, Math.round(this.speed * seconds));
    if (this.recorded !== null) {
      const last = this.recorded.rows.count - 1;
      this.marked = Math.min(this.marked + Math.max(1, Math.round(steps / 10)), last);
      if (this.marked === last) this.playing = false;
      this.changed = true;
    } else {
      void this.exclusively(() => this.advance(steps, 100));
    }
  }
}
