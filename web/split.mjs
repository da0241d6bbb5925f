// Splits the engine into the functions that the first moving picture needs and the rest, with binaryen's wasm-split.
// A run of what the page asks first decides what belongs to the first part; src/engine/parts.ts joins both parts again.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { leb, Reader, sections_of } from "./wasm_binary.mjs";

const features = ["exception-handling", "simd", "bulk-memory", "sign-ext", "mutable-globals", "nontrapping-float-to-int"].map((name) => `--enable-${name}`);
const tool = (name, ...args) => execFileSync(name, [...features, ...args], { stdio: ["ignore", "inherit", "inherit"] });

/// Asks an engine what the page asks first.
/// @param instantiate as instantiateWasm of Emscripten
/// @returns the engine and its answers
async function asked(folder, instantiate, scenario) {
  const engine = await createRequire(import.meta.url)(join(folder, "engine.js"))({ instantiateWasm: instantiate });
  const answers = [];
  const ask = (name, ...args) => {
    const given = args.map((arg) => {
      if (typeof arg === "number") return arg;
      const bytes = engine.lengthBytesUTF8(arg) + 1;
      const address = engine._malloc(bytes);
      engine.stringToUTF8(arg, address, bytes);
      return address;
    });
    const text = engine.UTF8ToString(engine[`_hamflow_${name}`](0, ...given));
    given.forEach((address, i) => typeof args[i] === "string" && engine._free(address));
    const numbers = (where, count) => engine.HEAPF64.slice(where / 8, where / 8 + count).join();
    answers.push(text, numbers(engine._hamflow_rows(0), engine._hamflow_count(0)), numbers(engine._hamflow_points(0), engine._hamflow_point_count(0)));
    const answer = JSON.parse(text);
    if (answer.errors) throw new Error(`${name}: ${answer.errors[0].message}`);
    return answer;
  };
  // Steps of a picture depend on the speed: every length, and motions that reach their end.
  for (const growth of [1, 1.1, 3, 100]) {
    const { steps } = ask("open", scenario, "");
    ask("declarations");
    for (let k = 0; k < 2; ++k) ask("show", ""), ask("state");
    for (let length = 1, step = 0; step < steps; step += Math.floor(length), length = length * growth + (growth === 1 ? 1 : 0)) {
      const all = Math.min(Math.floor(length), steps - step);
      ask("advance", all, Math.max(1, Math.floor(all / 100)));
    }
  }
  ask("open", scenario, ""); // in place of the motion before
  return { engine, answers };
}

/// The profile of wasm-split: which functions of the instrumented engine ran.
async function profile_of(folder, instrumented, scenario) {
  let exported;
  const { engine, answers } = await asked(folder, (imports, done) => {
    void WebAssembly.instantiate(readFileSync(instrumented), imports).then(({ instance, module }) => done((exported = instance), module));
    return {};
  }, scenario);
  const size = exported.exports.__write_profile(0, 0);
  const address = engine._malloc(size);
  exported.exports.__write_profile(address, size);
  return { profile: Buffer.from(engine.HEAPF64.buffer, address, size), answers };
}

/// @throws Error if the first part alone has other answers
async function check_first(folder, instantiate, first, scenario, expected) {
  const module = new WebAssembly.Module(first);
  const { answers } = await asked(folder, (imports, done) => {
    const instance = instantiate(module, imports, () => {
      throw new Error("the first part of the engine calls the rest");
    });
    done(instance, module);
    return instance.exports;
  }, scenario);
  const wrong = expected.findIndex((text, i) => text !== answers[i]);
  if (wrong >= 0 || answers.length !== expected.length) throw new Error(`the first part of the engine answers ${answers[wrong]}, and the whole engine ${expected[wrong]}`);
}

/// The parameters and results of each type, each with their count.
function types_of(section) {
  const read = new Reader(section);
  return read.list(() => {
    const from = ++read.at;
    for (let k = 0; k < 2; ++k) read.skip(read.number());
    return section.subarray(from, read.at);
  });
}

/// Takes the placeholders of wasm-split out of the table.
/// @returns the module without them, and the custom section that describes them to parts.ts
function without_placeholders(bytes) {
  const sections = sections_of(bytes);
  const section = (id) => sections.find((each) => each.id === id).content;
  const types = types_of(section(1));
  const imports = new Reader(section(2));
  const placeholder_types = [];
  imports.list(() => {
    const from = imports.text();
    imports.text();
    if (imports.byte() !== 0) throw new Error("an import of the engine is no function");
    placeholder_types.push(from === "placeholder" ? imports.number() : (imports.number(), -1));
  });
  const elements = new Reader(section(9));
  const kept = []; // runs of places in the table: where they begin, and their functions
  const left_out = []; // the same, and types
  elements.list(() => {
    if (elements.number() !== 0) throw new Error("a segment of elements has another form");
    let place = elements.constant();
    elements.list(() => {
      const index = elements.number();
      const type = placeholder_types[index] ?? -1;
      const runs = type < 0 ? kept : left_out;
      const last = runs.at(-1);
      if (last !== undefined && last.place + last.all.length === place) last.all.push(type < 0 ? index : type);
      else runs.push({ place, all: [type < 0 ? index : type] });
      ++place;
    });
  });
  const used = [...new Set(left_out.flatMap(({ all }) => all))];
  let end = 0;
  const description = [
    leb(used.length), ...used.map((type) => types[type]), leb(left_out.length),
    ...left_out.map(({ place, all }) => [leb(place - end), leb((end = place + all.length) - place)]).flat(),
    ...left_out.flatMap(({ all }) => all.map((type) => leb(used.indexOf(type)))),
  ];
  const table = [leb(kept.length), ...kept.map(({ place, all }) => [[0, 0x41], leb(place, true), [0x0b], leb(all.length), ...all.map((index) => leb(index))]).flat()];
  return { bytes: module_of(sections.map((each) => (each.id === 9 ? { id: 9, content: join_bytes(table) } : each))), description: join_bytes(description) };
}

const join_bytes = (parts) => Buffer.concat(parts.map((part) => Buffer.from(part)));
const module_of = (sections) => join_bytes([[0, 0x61, 0x73, 0x6d, 1, 0, 0, 0], ...sections.flatMap(({ id, content }) => [[id], leb(content.length), content])]);
const custom = (name, content) => ({ id: 0, content: join_bytes([leb(name.length), Buffer.from(name), content]) });

/// The segments of a module's data, each cut where texts begin and end.
function pieces_of(sections) {
  const read = new Reader(sections.find(({ id }) => id === 11).content);
  return read.list(() => {
    if (read.number() !== 0) throw new Error("a segment of data has another form");
    const address = read.constant();
    const content = read.skip(read.number());
    const cuts = new Set([0, content.length]);
    const texts = new Map(); // by where they begin
    for (const { index, 0: text } of content.toString("latin1").matchAll(/[ -~\n]{6,}\0/g)) {
      cuts.add(index).add(index + text.length);
      texts.set(index, text);
    }
    const at = [...cuts].sort((x, y) => x - y);
    return at.slice(1).map((to, i) => ({ address: address + at[i], end: address + to, content: content.subarray(at[i], to), text: texts.get(at[i]) }));
  }).flat();
}

/// A section of data; pieces that follow each other are one segment.
function data_section(pieces) {
  const runs = [];
  for (const { address, end, content } of pieces) {
    if (runs.at(-1)?.end === address) runs.at(-1).all.push(content), (runs.at(-1).end = end);
    else runs.push({ address, end, all: [content] });
  }
  const encoded = ({ address, end, all }) => [[0, 0x41], leb(address, true), [0x0b], leb(end - address), ...all];
  return { id: 11, content: join_bytes([leb(runs.length), ...runs.flatMap(encoded)]) };
}

/// Moves data that the first part does not read: texts and tables of numbers to which it has no address, and names of types, which no
/// code prints. Any number in the code or in the data that could be an address is taken for one.
/// @param text the first part in the text format
function data_of_rest(sections, text) {
  const pieces = pieces_of(sections);
  const all = [...text.matchAll(/(?:(?<!\(data \()i32\.const |offset=)(\d+)/g)].map((found) => Number(found[1]));
  for (const { address, content } of pieces) {
    for (let k = -address & 3; k + 4 <= content.length; k += 4) all.push(content.readUInt32LE(k));
  }
  all.sort((a, b) => a - b);
  const tables = all.filter((each) => each % 4 === 0); // where tables of numbers and their elements begin
  const any_between = (addresses, from, to) => {
    let [low, high] = [0, addresses.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (addresses[middle] < from) low = middle + 1;
      else high = middle;
    }
    return addresses[low] < to;
  };
  const margin = 64; // an address in the code may be that of a table plus or minus some elements
  const is_name_of_type = /^\w*(?:N7hamflow|NSt3__2)\w*\0$/; // as compilers write it
  const is_of_rest = ({ address, end, content, text: piece }) =>
    piece === undefined ? content.length >= 2000 && !any_between(tables, address - margin, end + margin) : is_name_of_type.test(piece) || !any_between(all, address, end);
  return { first: data_section(pieces.filter((each) => !is_of_rest(each))), rest: data_section(pieces.filter(is_of_rest)) };
}

/// @param folder has engine.js and engine.wasm   @param scenario TOML that the page begins with
/// @param instantiate of src/engine/parts.ts
/// @returns the two modules
export async function split_engine(folder, scenario, instantiate) {
  const work = mkdtempSync(join(tmpdir(), "hamflow-split-"));
  const file = (name) => join(work, name);
  const whole = join(folder, "engine.wasm");
  try {
    tool("wasm-split", "--instrument", whole, "-o", file("instrumented.wasm"));
    const { profile, answers } = await profile_of(folder, file("instrumented.wasm"), scenario);
    writeFileSync(file("profile"), profile);
    tool("wasm-split", whole, `--profile=${file("profile")}`, "-o1", file("first.wasm"), "-o2", file("rest.wasm"));
    const { bytes, description } = without_placeholders(readFileSync(file("first.wasm")));
    writeFileSync(file("table.wasm"), bytes);
    tool("wasm-opt", "--remove-unused-module-elements", file("table.wasm"), "-o", file("first.wasm")); // the imports of the placeholders
    tool("wasm-dis", file("first.wasm"), "-o", file("first.wat"));
    const without_count = (name) => sections_of(readFileSync(file(name))).filter(({ id }) => id !== 12); // of data; only memory.init needs it
    const first = without_count("first.wasm");
    const data = data_of_rest(first, readFileSync(file("first.wat"), "utf8"));
    const rest = without_count("rest.wasm");
    const all_of_first = module_of([...first.map((each) => (each.id === 11 ? data.first : each)), custom("placeholders", description)]);
    await check_first(folder, instantiate, all_of_first, scenario, answers);
    return { first: all_of_first, rest: module_of([...rest, data.rest]) };
  } finally {
    rmSync(work, { recursive: true });
  }
}
