// Sliders for the numbers of the scenario, made of the declarations. A change restarts the motion at once.
import type { Declarations, Declared, Setting } from "../engine/protocol";
import type { Laboratory } from "../laboratory";
import { entries_of, span_of, span_of_key, toml_number, with_value } from "../state/toml_edit";
import { element, made } from "./dom";

const most_controls = 14;
const slider_steps = 1000;

/// A number of the text, and how a slider moves it.
interface Control {
  name: string;
  meaning: string;
  key: string; // as after --set
  value: number;
  least: number;
  most: number;
  is_logarithmic: boolean;
  is_whole: boolean;
}

function bounds_of(value: number, path: string, declared: Declared | undefined, scale: number): Pick<Control, "least" | "most" | "is_logarithmic" | "is_whole"> {
  const is_whole = declared?.whole ?? false;
  const is_step = path === "run.dt";
  const is_parameter = path.startsWith("problem.parameters.");
  if ((declared?.least === 0 || is_step) && value > 0) {
    // A positive number without a size of its own.
    const most = Math.min(value * 10, declared?.most ?? Infinity);
    return { least: is_whole ? 1 : value / 10, most, is_logarithmic: true, is_whole };
  }
  // A parameter of a formula declares no range. One that is small or large, such as a ratio of masses, varies by factors.
  if (declared === undefined && is_parameter && value > 0 && (value < 0.1 || value > 10)) return { least: value / 10, most: value * 10, is_logarithmic: true, is_whole };
  const half = value === 0 ? scale : Math.abs(value);
  return { least: Math.max(value - half, declared?.least ?? -Infinity), most: Math.min(value + half, declared?.most ?? Infinity), is_logarithmic: false, is_whole };
}

function declared_key(declarations: Declarations, laboratory: Laboratory, path: string): Declared | undefined {
  const [table, ...rest] = path.split(".");
  const { facts } = laboratory.first;
  const within = (keys: Declared[] | undefined, names: string[]): Declared | undefined => {
    const found = keys?.find((each) => each.name === names[0]);
    return names.length > 1 ? within(found?.keys, names.slice(1)) : found;
  };
  if (table === "method") return within(declarations.methods.find((each) => each.name === facts.method.replace(/\(.*/, ""))?.keys, rest);
  if (table === "problem") return declarations.problems.filter((each) => each.name === facts.problem).map((each) => within(each.keys, rest)).find((each) => each !== undefined);
  return within(declarations.tables[table!], rest);
}

function controls_of(laboratory: Laboratory, declarations: Declarations): Control[] {
  const { facts } = laboratory.first;
  const controls: Control[] = [];
  const add = (setting: Setting, entry: string, name: string, text: string, scale: number): void => {
    const value = Number(text);
    if (text.trim() === "" || !Number.isFinite(value)) return;
    const declared = declared_key(declarations, laboratory, setting.path);
    controls.push({ name, meaning: declared?.meaning ?? "", key: setting.path + entry, value, ...bounds_of(value, setting.path, declared, scale) });
  };
  const wanted = facts.settings.filter(({ path, line }) => line > 0 && /^(run\.dt|method\.|problem\.)/.test(path) && !/^problem\.(bodies|walls|masses|units|seed)/.test(path));
  const rank = (path: string): number => (path === "run.dt" ? 0 : path === "problem.initial.q" ? 2 : path.startsWith("problem.initial") ? 3 : path.startsWith("problem.") ? 1 : 4);
  for (const setting of wanted.sort((a, b) => rank(a.path) - rank(b.path))) {
    const part = /^problem\.initial\.([qpv])$/.exec(setting.path)?.[1];
    const last = setting.path.split(".").slice(1).join(".").replace(/^(initial|parameters)\./, "");
    if (part === undefined) {
      const span = span_of(laboratory.toml, setting);
      add(setting, "", last, laboratory.toml.slice(span.from, span.to), 1);
      continue;
    }
    const texts = entries_of(laboratory.toml, setting).map(({ from, to }) => laboratory.toml.slice(from, to));
    const scale = Math.max(...texts.map((text) => Math.abs(Number(text))).filter(Number.isFinite), 0) || 1;
    const names = part === "q" ? facts.q : part === "p" ? facts.p : facts.q.map((name) => `velocity of ${name}`);
    texts.forEach((text, i) => add(setting, `[${i}]`, names[i] ?? `${part}[${i}]`, text, scale));
  }
  return controls.slice(0, most_controls);
}

export class Controls {
  private declarations: Declarations | undefined;
  private key = ""; // of the controls that are shown
  private rows: { control: Control; slider: HTMLInputElement; number: HTMLInputElement }[] = [];
  private wanted: string | null = null; // a text that waits for the one before
  private is_moving = false; // the sliders stay as they are

  constructor(private readonly laboratory: Laboratory) {}

  use(declarations: Declarations): void {
    this.declarations = declarations;
    this.opened();
  }

  opened(): void {
    const { laboratory } = this;
    const place = element("controls");
    const all = this.declarations === undefined || laboratory.is_empty || laboratory.recorded !== null ? [] : controls_of(laboratory, this.declarations);
    element("controls-box").hidden = all.length === 0;
    const key = all.map((each) => each.key).join("\n");
    if (this.is_moving && key === this.key) return;
    this.key = key;
    this.rows = all.map((control) => this.row_of(control));
    place.replaceChildren(...this.rows.map(({ slider }) => slider.parentElement!));
  }

  private row_of(control: Control): { control: Control; slider: HTMLInputElement; number: HTMLInputElement } {
    const row = made<HTMLLabelElement>(`<label class="control"><span></span><input type="range" min="0" max="${slider_steps}" step="any"><input size="8" inputmode="decimal" autocomplete="off"></label>`);
    const [slider, number] = row.querySelectorAll("input") as unknown as [HTMLInputElement, HTMLInputElement];
    row.title = control.meaning;
    row.querySelector("span")!.textContent = control.name.replace(/([._])/g, "$1\u200b"); // a long name breaks there
    slider.setAttribute("aria-label", `${control.name}, slider${control.is_logarithmic ? ", logarithmic" : ""}`);
    number.setAttribute("aria-label", control.name);
    number.value = String(control.value);
    slider.value = String(slider_steps * this.position(control, control.value));
    slider.oninput = () => {
      const value = this.value_at(control, Number(slider.value) / slider_steps);
      number.value = toml_number(value, 4);
      slider.setAttribute("aria-valuetext", number.value);
      this.change(control, number.value);
    };
    slider.onchange = () => {
      this.is_moving = false;
    };
    number.onchange = () => this.change(control, number.value.trim());
    return { control, slider, number };
  }

  private position({ least, most, is_logarithmic }: Control, value: number): number {
    return is_logarithmic ? Math.log(value / least) / Math.log(most / least) : (value - least) / (most - least || 1);
  }
  private value_at({ least, most, is_logarithmic, is_whole }: Control, at: number): number {
    const value = is_logarithmic ? least * (most / least) ** at : least + (most - least) * at;
    if (is_whole) return Math.round(value);
    return Math.abs(value) < 1e-3 * (most - least) && !is_logarithmic ? 0 : value; // the middle is easy to meet
  }

  /// Puts a value into the text, and opens it when the one before is done.
  private change(control: Control, value: string): void {
    const span = span_of_key(this.laboratory.toml, this.laboratory.first.facts.settings, control.key);
    if (span === null) return;
    const text = Number.isFinite(Number(value)) && value !== "" ? value : `"${value}"`;
    this.is_moving = document.activeElement instanceof HTMLInputElement && document.activeElement.type === "range";
    const is_free = this.wanted === null;
    this.wanted = with_value(this.laboratory.toml, span, text);
    if (is_free) void this.follow();
  }
  private async follow(): Promise<void> {
    for (let done: string | null = null; this.wanted !== null && done !== this.wanted;) {
      done = this.wanted;
      await this.laboratory.reopen(done);
    }
    this.wanted = null;
  }
}

