// What may stand at a place of the text: keys of the table, names of problems and methods, words of a key.
import type { Declarations, Declared } from "../engine/protocol";

export interface Completion {
  text: string;
  meaning: string;
  insert: string;
}
export interface Completions {
  from: number; // the part of the text that they replace
  to: number;
  all: Completion[];
}

const tables = ["problem", "method", "run", "output"];
const problem_keys = ["name", "initial", "orbit", "walls"];

/// The value of a key of this table in the text; empty: there is none.
function value_in(toml: string, table: string, key: string): string {
  const part = toml.split(/^\s*\[/m).find((each) => each.startsWith(`${table}]`)) ?? "";
  return new RegExp(`^\\s*${key}\\s*=\\s*["']([^"'(]*)`, "m").exec(part)?.[1] ?? "";
}

function keys_of(declarations: Declarations, table: string, toml: string): Declared[] {
  if (table === "problem") {
    const found = declarations.problems.filter((each) => each.name === value_in(toml, "problem", "name"));
    return [...new Map(found.flatMap((each) => each.keys).map((key) => [key.name, key])).values()];
  }
  if (table === "method") return declarations.methods.find((each) => each.name === value_in(toml, "method", "name"))?.keys ?? [];
  return declarations.tables[table] ?? [];
}

function values_of(declarations: Declarations, table: string, key: string, toml: string): Completion[] {
  const plain = (text: string, meaning = ""): Completion => ({ text, meaning, insert: text });
  if (table === "problem" && key === "name") {
    return [...new Map(declarations.problems.map((each) => [each.name, plain(each.name, each.formula)])).values()];
  }
  if (table === "method" && key === "name") return declarations.methods.map((each) => plain(each.name, each.purpose));
  if (table === "run" && key === "arithmetic") return declarations.arithmetics.map((each) => plain(each));
  const choices = declarations.problems.filter((each) => each.name === value_in(toml, "problem", "name")).map((each) => each.choices[key] ?? "");
  const words = keys_of(declarations, table, toml).find((each) => each.name === key)?.words ?? [];
  return [...new Set([...(table === "problem" ? choices : []), ...words])].filter((word) => word !== "").map((word) => plain(word));
}

/// What may stand before the caret.
export function completions_at(toml: string, caret: number, declarations: Declarations): Completions {
  const before = toml.slice(0, caret);
  const line = before.slice(before.lastIndexOf("\n") + 1);
  const table = [...before.matchAll(/^\s*\[([a-z]+)\]/gm)].pop()?.[1] ?? "";
  const chosen = (typed: string, all: Completion[]): Completions => ({
    from: caret - typed.length,
    to: caret,
    all: all.filter((each) => each.text.startsWith(typed) && each.text !== typed).concat(all.filter((each) => !each.text.startsWith(typed) && typed.length > 1 && each.text.includes(typed))),
  });
  const header = /^\s*\[([a-z]*)$/.exec(line);
  if (header) return chosen(header[1]!, tables.map((name) => ({ text: name, meaning: "", insert: `${name}]\n` })));
  const value = /^\s*([a-z_]+)\s*=\s*["']([^"']*)$/.exec(line);
  if (value) return chosen(value[2]!, values_of(declarations, table, value[1]!, toml));
  const key = /^\s*([a-z_]*)$/.exec(line);
  if (!key || table === "") return chosen("", []);
  const part = toml.split(/^\s*\[/m).find((each) => each.startsWith(`${table}]`)) ?? "";
  const is_there = (name: string): boolean => new RegExp(`^\\s*${name}\\s*=`, "m").test(part);
  const insert = (each: Declared): string => `${each.name} = ${/word|text/.test(each.type) ? '"' : each.type === "list" ? "[" : each.type === "table" ? "{ " : ""}`;
  const usual = table === "problem" ? problem_keys : table === "method" ? ["name"] : [];
  const all = [
    ...usual.map((name) => ({ text: name, meaning: "", insert: name === "name" ? 'name = "' : `${name} = ` })),
    ...keys_of(declarations, table, toml).filter((each) => !usual.includes(each.name)).map((each) => ({ text: each.name, meaning: each.meaning, insert: insert(each) })),
  ];
  return chosen(key[1]!, all.filter((each) => !is_there(each.text)));
}
