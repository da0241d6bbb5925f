// The page: an editor of a scenario, the clock, and the views of its motion.
import { Engine, EngineError } from "./engine/engine";
import { gallery } from "./gallery/gallery";
import { fragment_of, shared_by } from "./state/link";
import { Motion } from "./state/motion";
import { color_of, draw_plane, short, type Curve, type Frame } from "./views/plane";
import { Series } from "./views/series";

function element<T extends HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

const editor = element<HTMLTextAreaElement>("editor");
const complaints = element<HTMLUListElement>("complaints");
const x_name = element<HTMLInputElement>("x");
const y_name = element<HTMLInputElement>("y");
const speed = element<HTMLInputElement>("speed");
const scrub = element<HTMLInputElement>("scrub");
const energy_series = new Series(element("energy"));

const motion = new Motion(new Engine(), 0);
let is_open = false;
let playing = false;
let busy = false; // a request is under way
let turned_at = -1; // the step at which the motion was reversed; -1: it was not
let marked = -1; // the row that the time slider shows; -1: the last

function complain(error: unknown): void {
  complaints.replaceChildren();
  const all = error instanceof EngineError ? error.complaints : [{ line: 0, column: 0, key: "", message: String(error) }];
  for (const each of all) {
    const item = document.createElement("li");
    const place = each.line > 0 ? `line ${each.line}, column ${each.column}: ` : "";
    item.textContent = place + (each.key ? `${each.key}: ` : "") + each.message;
    complaints.append(item);
  }
}

/// Runs one request at a time; a second one while it lasts is left out.
async function exclusively(work: () => Promise<void>): Promise<void> {
  if (busy) return;
  busy = true;
  try {
    await work();
    complaints.replaceChildren();
  } catch (error) {
    playing = false;
    complain(error);
  } finally {
    busy = false;
    if (is_open) draw();
  }
}

async function open(): Promise<void> {
  await exclusively(async () => {
    playing = false;
    await motion.open(editor.value, []);
    is_open = true;
    turned_at = -1;
    marked = -1;
    const { q, p } = motion.facts;
    if (x_name.value === "") x_name.value = q[0]!;
    if (y_name.value === "") y_name.value = q[1] ?? p[0]!;
    await motion.show([x_name.value, y_name.value]);
    element("columns").replaceChildren(...motion.names().map((name) => Object.assign(document.createElement("option"), { value: name })));
    history.replaceState(null, "", await fragment_of({ toml: editor.value, x: x_name.value, y: y_name.value, method: "" }));
  });
}

function steps_a_frame(): number {
  return Math.max(1, Math.round(10 ** Number(speed.value) / 60));
}

async function tick(): Promise<void> {
  if (playing && !busy) {
    await exclusively(async () => {
      const end = turned_at < 0 ? motion.facts.steps : 2 * turned_at;
      const steps = Math.min(steps_a_frame(), end - motion.state.step);
      if (steps > 0) await motion.advance(steps, Math.max(1, Math.floor(steps / 100)));
      if (motion.state.step >= end || motion.state.failed) playing = false;
    });
  }
  requestAnimationFrame(() => void tick());
}

function draw(): void {
  const { recording, facts, state } = motion;
  const row = marked >= 0 ? Math.min(marked, recording.count - 1) : recording.count - 1;
  const column = (name: string): Float64Array => recording.column(Math.max(motion.column(name), 0));
  const curve: Curve = { x: column(x_name.value), y: column(y_name.value), color: color_of("--first"), joined: !facts.map, mark: row };
  const walls: Frame["walls"] = [];
  for (const wall of facts.walls) {
    for (const axis of ["x", "y"] as const) {
      if ((axis === "x" ? x_name : y_name).value !== facts.q[wall.coordinate]) continue;
      for (const value of [wall.min, wall.max]) if (value !== null) walls.push({ axis, value });
    }
  }
  draw_plane(element("orbit"), [curve], { x_name: x_name.value, y_name: y_name.value, equal: element<HTMLInputElement>("equal").checked, walls });
  const scale = state.energy.scale || 1;
  const times = recording.column(0);
  energy_series.draw(times, [recording.column(motion.energy_column).map((error) => error / scale)]);
  scrub.max = String(recording.count - 1);
  if (marked < 0) scrub.value = scrub.max;
  element("time-text").textContent = `t = ${short(recording.at(row, 0))}`;
  element("speed-text").textContent = `${short(10 ** Number(speed.value))} steps/s`;
  element("play").textContent = playing ? "Pause" : "Play";
  element("status").textContent = state.failed ? state.message : `step ${state.step} of ${facts.steps}`;
  element("status").className = state.failed ? "bad" : "";
  const numbers: [string, string][] = [
    ["method", facts.method],
    ["dt", short(facts.dt)],
    ["energy", short(state.energy.final)],
    ["largest energy error, of scale", (state.energy.max_error / scale).toExponential(2)],
    ...facts.invariants.map((each, i): [string, string] => [`error of ${each.name}`, state.invariants[i]!.max_error.toExponential(2)]),
    ...state.walls.map((each): [string, string] => [`bounces of ${facts.q[each.coordinate]}`, String(each.bounces)]),
  ];
  element("facts").replaceChildren(
    ...numbers.map(([name, value]) => {
      const line = document.createElement("tr");
      const head = Object.assign(document.createElement("th"), { textContent: name, scope: "row" });
      line.append(head, Object.assign(document.createElement("td"), { textContent: value }));
      return line;
    }),
  );
}

/// Back to the start: turns the momenta, takes as many steps, turns them again, and counts the bits.
async function reverse(): Promise<void> {
  await exclusively(async () => {
    playing = false;
    const steps = motion.state.step;
    await motion.reverse();
    turned_at = steps;
    await motion.advance(steps, Math.max(1, Math.floor(steps / 1000)));
    await motion.reverse();
    const { bits, equal, distance } = await motion.returned();
    element("certificate").textContent = `${equal} of ${bits} bits came back; largest difference ${short(distance)}`;
  });
}

element("integrate").onclick = () => void open();
element("play").onclick = () => {
  playing = is_open && !playing;
  marked = -1;
};
element("step").onclick = () => void exclusively(() => motion.advance(1, 1));
element("reverse").onclick = () => void reverse();
element("certify").onclick = () =>
  void exclusively(async () => {
    const found = await motion.certificate();
    element("certificate").textContent = `energy error: ${found.drift}. ${found.reason}`;
    element("certificate").className = found.drift === "linear" ? "bad" : "";
  });
element("share").onclick = () => void navigator.clipboard.writeText(location.href);
element("theme").onclick = () => {
  const dark = document.documentElement.dataset.theme !== "dark";
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  element("theme").setAttribute("aria-pressed", String(dark));
  energy_series.reset();
  if (is_open) draw();
};
scrub.oninput = () => {
  playing = false;
  marked = Number(scrub.value);
  if (is_open) draw();
};
x_name.onchange = y_name.onchange = () => void open();
element("equal").onchange = () => is_open && draw();
editor.onkeydown = (event) => {
  if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) void open();
};
const chooser = element<HTMLSelectElement>("gallery");
gallery.forEach((entry, i) => chooser.append(new Option(entry.title, String(i))));
function choose(i: number): void {
  const entry = gallery[i]!;
  editor.value = entry.toml;
  x_name.value = entry.x;
  y_name.value = entry.y;
  element<HTMLInputElement>("equal").checked = entry.equal;
  element("look").textContent = entry.look;
  element("question").textContent = entry.question;
  element("lesson").hidden = false;
  void open();
}
chooser.onchange = () => choose(Number(chooser.value));

void shared_by(location.hash).then((shared) => {
  if (shared === null) return choose(0);
  editor.value = shared.toml;
  x_name.value = shared.x;
  y_name.value = shared.y;
  return open();
});
void tick();
