// Changes single values in the text of a scenario, so that comments and order stay.
import type { Setting } from "../engine/protocol";

export interface Span {
  from: number;
  to: number;
}

/// Where a value of the text begins.
export function place_of(toml: string, line: number, column: number): number {
  let at = 0;
  for (let i = 1; i < line; ++i) at = toml.indexOf("\n", at) + 1;
  return at + column - 1;
}

/// The value that begins here: a text in quotes, a list, a table, or what stands before the next separator.
function value_at(toml: string, from: number): Span {
  const first = toml[from];
  if (first === '"' || first === "'") {
    let to = from + 1;
    while (to < toml.length && toml[to] !== first) to += first === '"' && toml[to] === "\\" ? 2 : 1;
    return { from, to: to + 1 };
  }
  if (first === "[" || first === "{") {
    let to = from + 1;
    while (to < toml.length && toml[to] !== "]" && toml[to] !== "}") {
      if (toml[to] === "#") to = (toml + "\n").indexOf("\n", to);
      else to = /["'[{]/.test(toml[to]!) ? value_at(toml, to).to : to + 1;
    }
    return { from, to: to + 1 };
  }
  let to = from;
  while (to < toml.length && !/[\s,\]}#]/.test(toml[to]!)) ++to;
  return { from, to };
}

export function span_of(toml: string, setting: Setting): Span {
  return value_at(toml, place_of(toml, setting.line, setting.column));
}

/// The entries of a list; empty if the value is no list.
export function entries_of(toml: string, setting: Setting): Span[] {
  const { from, to } = span_of(toml, setting);
  const all: Span[] = [];
  if (toml[from] !== "[") return all;
  for (let at = from + 1; at < to - 1;) {
    if (/[\s,]/.test(toml[at]!)) ++at;
    else if (toml[at] === "#") at = toml.indexOf("\n", at) + 1;
    else {
      const entry = value_at(toml, at);
      all.push(entry);
      at = entry.to;
    }
  }
  return all;
}

/// Where the value of a key such as run.dt or problem.initial.q[0] stands; null: not in this text.
export function span_of_key(toml: string, settings: Setting[], key: string): Span | null {
  const [, path, entry] = /^(.*?)(?:\[(\d+)\])?$/.exec(key)!;
  const setting = settings.find((each) => each.path === path && each.line > 0);
  if (setting === undefined) return null;
  return (entry === undefined ? span_of(toml, setting) : entries_of(toml, setting)[Number(entry)]) ?? null;
}

export function with_value(toml: string, span: Span, value: string): string {
  return toml.slice(0, span.from) + value + toml.slice(span.to);
}

/// A number with so many digits that a pointer or a slider can give them.
export function toml_number(x: number, digits = 5): string {
  return String(Number(x.toPrecision(digits)));
}
