// The page: an editor of a scenario, the clock, and the views of its motion.
import { views as make_views } from "all-views";
import { Laboratory, usual_display } from "./laboratory";
import { CompletionList } from "./page/completion";
import { Clock } from "./page/clock";
import { Controls } from "./page/controls";
import { element, text_of } from "./page/dom";
import { complain, no_complaints } from "./page/editor";
import { connect_examples, show_lesson } from "./page/examples";
import { connect_exports } from "./page/exports";
import { connect_files } from "./page/files";
import { connect_theme } from "./page/theme";
import { gallery, type Entry } from "./gallery/gallery";
import { inlined } from "./state/inlined";
import type { View } from "./view";
import type { FileRows } from "./engine/hdf5_worker";
import { fragment_of, shared_by } from "./state/link";

const editor = element<HTMLTextAreaElement>("editor");
const second = element<HTMLSelectElement>("second");
const in_frame = location.protocol === "about:"; // of a notebook: there is no address to share
element("share").hidden = in_frame;
const is_calm = matchMedia("(prefers-reduced-motion: reduce)").matches; // nothing moves by itself

const laboratory = new Laboratory(opened, complain);
const clock = new Clock(laboratory);
const controls = new Controls(laboratory);
const completion = new CompletionList(editor);
const views = make_views.map((make) => make(laboratory)).sort((a, b) => a.order - b.order);
for (const view of views) element(view.place === "stage" ? "views" : "numbers").append(view.root);
connect_exports(laboratory, editor);
connect_files(open_text, show_recorded, complain);
connect_examples(open_example);
connect_theme(() => {
  for (const view of views) view.restyle?.();
  laboratory.changed = true;
});

function opened(): void {
  no_complaints();
  const { recorded } = laboratory;
  if (!laboratory.is_edited) editor.value = laboratory.toml;
  second.value = laboratory.second;
  element("recorded").hidden = recorded === null;
  if (recorded !== null) text_of(document.body, "#recorded", recorded_text());
  controls.opened();
  element("controls").inert = false;
  for (const view of views) view.opened?.();
  void keep_address();
}
function recorded_text(): string {
  const { given, rows } = laboratory.recorded!;
  return `${given.name}: ${rows.count} ${given.kind === "sweep" ? "members" : "rows"}${given.note ? `, ${given.note}` : ""}.${given.toml === "" ? "" : " Start again integrates the scenario here."}`;
}
async function keep_address(): Promise<void> {
  if (in_frame || laboratory.recorded !== null) return;
  const { x, y, z } = laboratory.display;
  history.replaceState(null, "", await fragment_of({ toml: laboratory.toml, x, y, z, method: laboratory.second }));
}

async function start_again(): Promise<void> {
  await laboratory.open(editor.value, { second: second.value, ...(laboratory.recorded !== null && { display: { ...usual_display } }) });
}
function open_text(toml: string): void {
  show_lesson(null);
  editor.value = toml;
  void laboratory.open(toml, { display: { ...usual_display }, second: "", starts: [] });
}
function open_example(entry: Entry): void {
  show_lesson(entry);
  editor.value = entry.toml;
  void laboratory.open(entry.toml, { display: { ...entry.display }, second: entry.second, starts: entry.starts }).then((is_open) => {
    if (!is_open) return;
    laboratory.speed = 10 ** entry.speed;
    if (!is_calm) laboratory.play();
  });
}
function show_recorded({ given, numbers }: FileRows): void {
  show_lesson(null);
  laboratory.second = "";
  laboratory.show_recorded(given, numbers);
}

element("integrate").onclick = () => void start_again();
second.onchange = () => void start_again();
editor.addEventListener("input", () => {
  laboratory.is_edited = editor.value !== laboratory.toml;
  element("controls").inert = laboratory.is_edited; // they change the text that runs
});
editor.addEventListener("keydown", (event) => {
  if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) void start_again();
});

async function begin(): Promise<void> {
  const [given, shared] = await Promise.all([inlined(), shared_by(location.hash)]);
  if (shared !== null) {
    const { toml, x, y, z, method } = shared;
    editor.value = toml;
    await laboratory.open(toml, { second: method, display: { ...usual_display, x, y, z } });
  } else if (given === null) {
    open_example(gallery[0]!);
  } else if (given.given.kind === "scenario") {
    open_text(given.given.toml);
  } else {
    show_recorded(given);
  }
  const declarations = (await laboratory.engine.call("declarations")).value;
  const usual = declarations.methods.filter((each) => each.purpose !== "");
  for (const each of [...usual, ...declarations.methods.filter((other) => other.purpose === "")]) {
    second.append(Object.assign(new Option(each.name, each.name), { title: each.purpose }));
  }
  second.value = laboratory.second;
  completion.declarations = declarations;
  controls.use(declarations);
}

const time_of_views = 12; // ms a picture of the browser; views that are not drawn by then come with the next one
let waiting: View[] = [];

function tick(now: number): void {
  requestAnimationFrame(tick); // first: a view that fails does not stop the clock
  laboratory.tick(now);
  if (laboratory.is_empty || laboratory.is_opening) {
    waiting = [];
    return;
  }
  if (laboratory.changed && waiting.length === 0) {
    laboratory.changed = false;
    clock.draw();
    waiting = [...views];
  }
  for (const began = performance.now(); waiting.length > 0 && performance.now() - began < time_of_views;) waiting.shift()!.draw();
}
begin().catch(complain);
requestAnimationFrame(tick);
