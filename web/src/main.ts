// The page: an editor of a scenario, the clock, and the views of its motion.
import { Engine, EngineError } from "./engine/engine";
import { as_command, as_python, csv_of, save, save_text } from "./export";
import { gallery } from "./gallery/gallery";
import { inlined, rows_of, type Inlined } from "./state/inlined";
import { fragment_of, shared_by } from "./state/link";
import { with_method } from "./state/method";
import { Motion } from "./state/motion";
import { Recording } from "./state/recording";
import { color_of, draw_plane, plane_as_svg, short, type Curve, type Frame } from "./views/plane";
import { SectionView } from "./views/section";
import { Series } from "./views/series";

function element<T extends HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

const editor = element<HTMLTextAreaElement>("editor");
const complaints = element<HTMLUListElement>("complaints");
const x_name = element<HTMLInputElement>("x");
const y_name = element<HTMLInputElement>("y");
const equal = element<HTMLInputElement>("equal");
const tracks = element<HTMLInputElement>("tracks");
const speed = element<HTMLInputElement>("speed");
const scrub = element<HTMLInputElement>("scrub");
const second = element<HTMLSelectElement>("second");
const energy_series = new Series(element("energy"));
const column_series = new Series(element("series"));
const section = new SectionView(element("section"), complain);

const in_frame = location.protocol === "about:"; // of a notebook: there is no address to share
element("share").hidden = in_frame;

const engine = new Engine();
const all_motions = [new Motion(engine, 0), new Motion(engine, 1)];
let motions: Motion[] = []; // open: the scenario, and beside it a second method
let recorded: { columns: string[]; rows: Recording; given: Inlined } | null = null; // in place of motions
let playing = false;
let busy = false; // a request is under way
let turned_at = -1; // the step at which the motion was reversed; -1: it was not
let marked = -1; // the row that the time slider shows; -1: the last
let certified_at = 0; // the time of the last certificate
const certificate_pause = 1500; // ms while the motion plays

function complain(error: unknown): void {
  const all = error instanceof EngineError ? error.complaints : [{ line: 0, column: 0, key: "", message: String(error) }];
  complaints.replaceChildren(
    ...all.map((each) => {
      const item = document.createElement("li");
      const text = (each.key ? `${each.key}: ` : "") + each.message;
      if (each.line === 0) item.textContent = text;
      else {
        const place = Object.assign(document.createElement("button"), { type: "button", textContent: `line ${each.line}, column ${each.column}` });
        place.onclick = () => select_place(each.line, each.column);
        item.append(place, `: ${text}`);
      }
      return item;
    }),
  );
}

function select_place(line: number, column: number): void {
  const lines = editor.value.split("\n");
  const at = lines.slice(0, line - 1).reduce((sum, each) => sum + each.length + 1, 0) + column - 1;
  editor.focus();
  editor.setSelectionRange(at, at + 1);
}

/// Runs one request at a time; a second one while it lasts is left out.
async function exclusively(work: () => Promise<void>): Promise<void> {
  if (busy) return;
  busy = true;
  try {
    await work();
  } catch (error) {
    playing = false;
    complain(error);
  } finally {
    busy = false;
    draw();
  }
}

async function open(): Promise<void> {
  while (busy) await new Promise((resolve) => setTimeout(resolve, 5)); // the last request of a motion that plays
  await exclusively(async () => {
    playing = false;
    complaints.replaceChildren();
    const [first, other] = all_motions as [Motion, Motion];
    await first.open(editor.value);
    recorded = null;
    element("recorded").hidden = true;
    motions = [first];
    if (second.value !== "") {
      await other.open(with_method(editor.value, second.value));
      motions = [first, other];
    }
    turned_at = -1;
    marked = -1;
    certified_at = 0;
    element("certificate").replaceChildren();
    element("returned").textContent = "";
    const { q, p } = first.facts;
    const names = [...first.names(), ...first.facts.observables.map((each) => each.name)];
    if (x_name.value === "") x_name.value = q[0]!;
    if (y_name.value === "") y_name.value = q[1] ?? p[0]!;
    element("columns").replaceChildren(...names.map((name) => Object.assign(document.createElement("option"), { value: name })));
    element("tracks-label").hidden = body_columns().length === 0;
    section.open(editor.value, first.facts, first.state.energy.initial);
    element("section-figure").hidden = !section.is_open;
    element("section-x-name").textContent = section.frame().x_name;
    element("section-y-name").textContent = section.frame().y_name;
    await show_columns();
  });
}

async function show_columns(): Promise<void> {
  for (const motion of motions) await motion.show([x_name.value, y_name.value]);
  if (in_frame) return;
  history.replaceState(null, "", await fragment_of({ toml: editor.value, x: x_name.value, y: y_name.value, method: second.value }));
}

function steps_a_frame(): number {
  return Math.max(1, Math.round(10 ** Number(speed.value) / 60));
}

function last_step(): number {
  return turned_at < 0 ? motions[0]!.facts.steps : 2 * turned_at;
}

async function advance(wanted: number): Promise<void> {
  const first = motions[0]!;
  const steps = Math.min(wanted, last_step() - first.state.step);
  if (steps > 0) {
    for (const motion of motions) await motion.advance(steps, Math.max(1, Math.floor(steps / 100)));
  }
  section.take(first.points);
  const ended = first.state.step >= last_step() || first.state.failed;
  if (ended) playing = false;
  if (ended && turned_at >= 0 && !first.state.failed) await compare_with_start();
  else if (ended || performance.now() - certified_at > certificate_pause) await certify();
}

async function compare_with_start(): Promise<void> {
  const lines: string[] = [];
  for (const motion of motions) {
    await motion.reverse();
    const { bits, equal: same, distance } = await motion.returned();
    lines.push(`${motion.facts.method}: ${same} of ${bits} bits of the start came back; largest difference ${short(distance)}`);
  }
  turned_at = -1;
  element("returned").textContent = lines.join("; ");
}

async function tick(): Promise<void> {
  if (playing && !busy) {
    if (recorded !== null) {
      marked = Math.min(marked + Math.max(1, Math.round(steps_a_frame() / 10)), recorded.rows.count - 1);
      if (marked === recorded.rows.count - 1) playing = false;
      draw();
    } else {
      await exclusively(() => advance(steps_a_frame()));
    }
  }
  requestAnimationFrame(() => void tick());
}

/// The columns of x and y of each body: names such as x1 and y1.
function body_columns(): [number, number][] {
  const first = motions[0];
  if (first === undefined) return [];
  return first.facts.q.flatMap((name, i): [number, number][] => {
    const number = /^x(\d+)$/.exec(name)?.[1];
    const y = first.facts.q.indexOf(`y${number}`);
    return number === undefined || y < 0 ? [] : [[1 + i, 1 + y]];
  });
}

function curves_of(recording: Recording, columns: string[], color: string, joined: boolean): Curve[] {
  const at = (name: string): Float64Array => recording.column(Math.max(columns.indexOf(name), 0));
  const row = marked >= 0 ? Math.min(marked, recording.count - 1) : recording.count - 1;
  return [{ x: at(x_name.value), y: at(y_name.value), color, kind: joined ? "line" : "points", radius: 0, mark: row }];
}

function curves_of_bodies(motion: Motion, color: string): Curve[] {
  const { recording, facts } = motion;
  const row = marked >= 0 ? Math.min(marked, recording.count - 1) : recording.count - 1;
  const columns = body_columns();
  if (facts.particles !== null) {
    const x = Float64Array.from(columns, ([column]) => recording.at(row, column));
    const y = Float64Array.from(columns, ([, column]) => recording.at(row, column));
    return [{ x, y, color, kind: "discs", radius: columns.length > 0 ? 0.02 : 0, mark: -1 }];
  }
  return columns.map(([x, y], i) => ({
    x: recording.column(x),
    y: recording.column(y),
    color: motions.length > 1 ? color : `hsl(${(i * 137.5 + 210) % 360} 65% ${color_of("--section-lightness")})`,
    kind: "line",
    radius: 0,
    mark: row,
  }));
}

/// An expression may be longer than its axis.
function label_of(column: string): string {
  return column.length <= 40 ? column : `${column.slice(0, 37)}...`;
}

function orbit_picture(): { curves: Curve[]; frame: Frame } {
  const colors = [color_of("--first"), color_of("--second")];
  const frame: Frame = { x_name: label_of(x_name.value), y_name: label_of(y_name.value), equal: equal.checked, walls: [], range: null };
  if (recorded !== null) return { curves: curves_of(recorded.rows, recorded.columns, colors[0]!, recorded.given.kind === "run"), frame };
  const first = motions[0]!;
  if (tracks.checked && body_columns().length > 0) {
    const radius = first.facts.particles?.radius ?? 0;
    if (radius > 0) frame.range = { x0: -radius, x1: radius, y0: -radius, y1: radius };
    const [x, y] = body_columns()[0]!;
    return { curves: motions.flatMap((motion, i) => curves_of_bodies(motion, colors[i]!)), frame: { ...frame, x_name: first.names()[x]!.replace(/\d/g, ""), y_name: first.names()[y]!.replace(/\d/g, "") } };
  }
  for (const wall of first.facts.walls) {
    for (const axis of ["x", "y"] as const) {
      if ((axis === "x" ? x_name : y_name).value !== first.facts.q[wall.coordinate]) continue;
      for (const value of [wall.min, wall.max]) if (value !== null) frame.walls.push({ axis, value });
    }
  }
  const curves = motions.flatMap((motion, i) => curves_of(motion.recording, motion.columns(), colors[i]!, !motion.facts.map));
  return { curves, frame };
}

/// Columns of the same length: the second motion may have ended before.
function padded(columns: Float64Array[]): Float64Array[] {
  const length = columns[0]!.length;
  return columns.map((column) => Float64Array.from({ length }, (_, i) => column[i] ?? NaN));
}

function draw(): void {
  if (motions.length === 0 && recorded === null) return;
  const { curves, frame } = orbit_picture();
  draw_plane(element("orbit"), curves, frame);
  const rows = recorded?.rows ?? motions[0]!.recording;
  const row = marked >= 0 ? Math.min(marked, rows.count - 1) : rows.count - 1;
  const times = rows.column(0);
  scrub.max = String(rows.count - 1);
  scrub.value = String(row);
  element("time-text").textContent = recorded?.given.kind === "sweep" ? `member ${row}` : `t = ${short(rows.at(row, 0))}`;
  element("speed-text").textContent = `${short(10 ** Number(speed.value))} steps/s`;
  element("play").textContent = playing ? "Pause" : "Play";
  for (const id of ["step", "reverse"]) element<HTMLButtonElement>(id).disabled = recorded !== null;
  element<HTMLButtonElement>("play").disabled = false;
  element("series-title").textContent = `${label_of(y_name.value)} against ${recorded?.columns[0] ?? "t"}`;
  element("energy-title").textContent = recorded === null ? "Energy error, relative to its scale" : "Energy error, H - H(0)";
  if (recorded !== null) {
    const at = (name: string): number => recorded!.columns.indexOf(name);
    column_series.draw(times, [rows.column(Math.max(at(y_name.value), 0))]);
    const error = at("energy error");
    element("energy-figure").hidden = error < 0;
    if (error >= 0) energy_series.draw(times, [rows.column(error)]);
    numbers(recorded.columns.map((name, i) => [name, short(rows.at(row, i))]));
    element("status").textContent = "";
    return;
  }
  element("energy-figure").hidden = false;
  energy_series.draw(times, padded(motions.map(({ recording, energy_column, state }) => recording.column(energy_column).map((error) => error / (state.energy.scale || 1)))));
  column_series.draw(times, padded(motions.map((motion) => motion.recording.column(Math.max(motion.column(y_name.value), 0)))));
  const { facts, state } = motions[0]!;
  const failed = motions.find((motion) => motion.state.failed);
  element("status").textContent = failed ? `${failed.facts.method}: ${failed.state.message}` : `step ${state.step} of ${last_step()}${turned_at >= 0 ? ", back" : ""}`;
  element("status").className = failed ? "bad" : "";
  numbers([
    ...motions.flatMap((motion): [string, string][] => [
      ["method", motion.facts.method],
      ["largest energy error, relative", (motion.state.energy.max_error / (motion.state.energy.scale || 1)).toExponential(2)],
      ["evaluations", String(motion.state.evaluations)],
      ...motion.facts.invariants.map((each, i): [string, string] => [`error of ${each.name}`, motion.state.invariants[i]!.max_error.toExponential(2)]),
    ]),
    ["arithmetic", facts.arithmetic],
    ["dt", short(facts.dt)],
    ["energy", short(state.energy.final)],
    ...state.walls.map((each): [string, string] => [`bounces of ${facts.q[each.coordinate]} at ${each.side < 0 ? "min" : "max"}`, String(each.bounces)]),
  ]);
}

function numbers(all: [string, string][]): void {
  element("facts").replaceChildren(
    ...all.map(([name, value]) => {
      const line = document.createElement("tr");
      const head = Object.assign(document.createElement("th"), { textContent: name, scope: "row" });
      line.append(head, Object.assign(document.createElement("td"), { textContent: value }));
      return line;
    }),
  );
}

/// Judges the motions so far. After a reversal there is nothing to judge.
async function certify(): Promise<void> {
  if (turned_at >= 0 || motions[0]!.facts.map || motions.some((motion) => motion.state.failed || motion.state.step === 0)) return;
  const items: HTMLLIElement[] = [];
  for (const motion of motions) {
    const found = await motion.certificate();
    const add = (text: string, bad: boolean): void => {
      items.push(Object.assign(document.createElement("li"), { textContent: `${motion.facts.method}: ${text}`, className: bad ? "bad" : "" }));
    };
    add(`energy error ${found.drift}: ${found.reason}`, found.drift === "linear");
    for (const each of found.invariants) if (each.conserved !== null) add(`${each.name} ${each.conserved ? "conserved" : "not conserved"}`, !each.conserved);
    if (found.reversal !== null) add(`${found.reversal.proves === "nothing" ? "reversal inconclusive" : found.reversal.proves}: ${found.reversal.reason}`, false);
  }
  element("certificate").replaceChildren(...items);
  certified_at = performance.now();
}

/// Turns the momenta and plays back to the start, where the bits are compared.
function reverse(): void {
  void exclusively(async () => {
    const first = motions[0];
    if (first === undefined || turned_at >= 0 || first.state.step === 0) return;
    turned_at = first.state.step;
    for (const motion of motions) await motion.reverse();
    marked = -1;
    playing = true;
  });
}

function play(): void {
  if (motions.length === 0 && recorded === null) return;
  playing = !playing;
  marked = recorded === null ? -1 : playing && marked >= recorded.rows.count - 1 ? 0 : marked;
  draw();
}

function step(): void {
  playing = false;
  marked = -1;
  if (motions.length > 0) void exclusively(() => advance(1));
}

element("integrate").onclick = () => void open();
element("play").onclick = play;
element("step").onclick = step;
element("reverse").onclick = reverse;
second.onchange = () => void open();
element("theme").onclick = () => choose_theme(document.documentElement.dataset.theme !== "dark");
function choose_theme(dark: boolean): void {
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  element("theme").setAttribute("aria-pressed", String(dark));
  energy_series.reset();
  column_series.reset();
  section.draw();
  draw();
}
scrub.oninput = () => {
  playing = false;
  marked = Number(scrub.value);
  draw();
};
x_name.onchange = y_name.onchange = () => {
  if (recorded === null) void exclusively(show_columns);
  else draw();
};
equal.onchange = tracks.onchange = speed.oninput = draw;
new ResizeObserver(draw).observe(element("orbit"));
editor.onkeydown = (event) => {
  if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) void open();
};
document.onkeydown = (event) => {
  if ((event.target as HTMLElement).closest("input, textarea, select, button, summary") || event.ctrlKey || event.metaKey || event.altKey) return;
  const action = { " ": play, ArrowRight: step, r: reverse, R: reverse }[event.key];
  if (action === undefined) return;
  event.preventDefault();
  action();
};

function copy(text: string, what: string): void {
  void navigator.clipboard.writeText(text).then(
    () => (element("copied").textContent = `${what} copied`),
    () => (element("copied").textContent = `${what} not copied: the browser refuses it here`),
  );
}
element("share").onclick = () => copy(location.href, "link");
element("copy-python").onclick = () => copy(as_python(editor.value), "Python");
element("copy-command").onclick = () => copy(as_command(editor.value), "command");
element("save-toml").onclick = () => save_text("scenario.toml", editor.value, "application/toml");
element("save-svg").onclick = () => {
  const { curves, frame } = orbit_picture();
  save_text("orbit.svg", plane_as_svg(curves, frame), "image/svg+xml");
};
element("save-png").onclick = () => element<HTMLCanvasElement>("orbit").toBlob((picture) => picture && save("orbit.png", picture));
element("save-csv").onclick = () => {
  const columns = recorded?.columns ?? motions[0]!.columns();
  const rows = recorded?.rows ?? motions[0]!.recording;
  save_text("trajectory.csv", csv_of(columns, Array.from({ length: rows.count }, (_, row) => columns.map((_, column) => rows.at(row, column)))), "text/csv");
};

element("section-add").onclick = () => {
  const [x, y] = ["section-x", "section-y"].map((id) => Number(element<HTMLInputElement>(id).value)) as [number, number];
  section.add(x, y);
};
element("section-in").onclick = () => section.zoom(0.7);
element("section-all").onclick = () => section.show_all();
element("section-clear").onclick = () => section.clear();
element("section-svg").onclick = () => save_text("section.svg", plane_as_svg(section.curves(), section.frame()), "image/svg+xml");
element("section-csv").onclick = () => {
  const rows = section.curves().flatMap((curve, i) => Array.from(curve.x, (x, k) => [i, x, curve.y[k]!]));
  save_text("section.csv", csv_of(["start", section.frame().x_name, section.frame().y_name], rows), "text/csv");
};
setInterval(() => {
  const text = `${section.count} points`;
  if (element("section-count").textContent !== text) element("section-count").textContent = text;
}, 200);

const chooser = element<HTMLSelectElement>("gallery");
chooser.append(new Option("choose", ""));
gallery.forEach((entry, i) => chooser.append(new Option(entry.title, String(i))));
function choose(i: number): void {
  const entry = gallery[i]!;
  chooser.value = String(i);
  editor.value = entry.toml;
  x_name.value = entry.x;
  y_name.value = entry.y;
  second.value = entry.second;
  equal.checked = entry.flags.includes("equal");
  tracks.checked = entry.flags.includes("tracks");
  section.turns = entry.flags.includes("turns");
  element("look").textContent = entry.look;
  element("question").textContent = entry.question;
  element("lesson").hidden = false;
  void open();
}
chooser.onchange = () => chooser.value !== "" && choose(Number(chooser.value));

document.ondragover = (event) => event.preventDefault();
document.ondrop = (event) => {
  event.preventDefault();
  const file = event.dataTransfer?.files[0];
  if (file === undefined) return;
  void file.text().then((text) => open_text(text));
};
function open_text(text: string): void {
  editor.value = text;
  x_name.value = y_name.value = second.value = "";
  element("lesson").hidden = true;
  chooser.value = "";
  void open();
}

/// Shows the rows of a run or the members of a sweep; Start again integrates its scenario.
function show_recorded(given: Inlined): void {
  const rows = new Recording(given.columns.length, Infinity);
  rows.append(rows_of(given));
  recorded = { columns: given.columns, rows, given };
  editor.value = given.toml;
  x_name.value = given.columns[1] ?? given.columns[0]!;
  y_name.value = given.columns[2] ?? given.columns[0]!;
  marked = rows.count - 1;
  element("columns").replaceChildren(...given.columns.map((name) => Object.assign(document.createElement("option"), { value: name })));
  element("recorded").hidden = false;
  element("recorded").textContent = `${given.name}: ${rows.count} ${given.kind === "sweep" ? "members" : "rows"}${given.note ? `, ${given.note}` : ""}.${given.toml === "" ? "" : " Start again integrates the scenario here."}`;
  draw();
}

async function begin(): Promise<void> {
  choose_theme(matchMedia("(prefers-color-scheme: dark)").matches);
  const methods = (await engine.call("methods")).value;
  const usual = methods.filter((each) => each.purpose !== "");
  for (const each of [...usual, ...methods.filter((other) => other.purpose === "")]) {
    second.append(Object.assign(new Option(each.name, each.name), { title: each.purpose }));
  }
  const given = inlined();
  const shared = await shared_by(location.hash);
  if (shared !== null) {
    editor.value = shared.toml;
    x_name.value = shared.x;
    y_name.value = shared.y;
    second.value = shared.method;
    await open();
  } else if (given === null) {
    choose(0);
  } else if (given.kind === "scenario") {
    open_text(given.toml);
  } else {
    show_recorded(given);
  }
}
begin().catch(complain);
void tick();
