// Splits the engine into what the first motion needs and the rest, which a worker loads when a function of it is called.
// An instrumented engine runs the first scenarios of the gallery and tells which functions they call.
//   node split.mjs ENGINE OUT      ENGINE: the folder with engine.js and engine.wasm; OUT gets engine.wasm and rest.wasm
import { execFileSync } from "node:child_process";
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const [folder, out] = process.argv.slice(2).map((path) => resolve(path));
const here = dirname(fileURLToPath(import.meta.url));
const whole = join(folder, "engine.wasm");
const features = ["--enable-exception-handling", "--enable-mutable-globals", "--enable-sign-ext", "--enable-bulk-memory"];
const scenarios_of_first = 3; // of the gallery

async function profile_of(instrumented) {
  const make = createRequire(import.meta.url)(join(folder, "engine.js"));
  const module = await make({ wasmBinary: readFileSync(instrumented) });
  const stored = (text) => {
    const bytes = module.lengthBytesUTF8(text) + 1;
    const address = module._malloc(bytes);
    module.stringToUTF8(text, address, bytes);
    return address;
  };
  const call = (name, ...args) => {
    const answer = JSON.parse(module.UTF8ToString(module[`_hamflow_${name}`](0, ...args.map((arg) => (typeof arg === "string" ? stored(arg) : arg)))));
    if (answer.errors) throw new Error(`${name}: ${answer.errors[0].message}`);
    return answer;
  };
  const gallery = join(here, "src/gallery");
  for (const name of readdirSync(gallery).filter((each) => each.endsWith(".toml")).sort().slice(0, scenarios_of_first)) {
    call("open", readFileSync(join(gallery, name), "utf8"), "");
    call("show", "t\nx");
    for (const steps of [1, 10, 100, 1000]) {
      call("advance", steps, Math.max(1, steps / 10));
      ["rows", "count", "points", "point_count", "width"].forEach((each) => module[`_hamflow_${each}`](0));
    }
    call("state");
    call("certificate");
  }
  const size = 1 << 22;
  const address = module._malloc(size);
  const length = module.asm.__write_profile(address, size);
  return module.HEAPU8 === undefined ? new Uint8Array(module.HEAPF64.buffer, address, length) : module.HEAPU8.slice(address, address + length);
}

mkdirSync(out, { recursive: true });
const instrumented = join(out, "instrumented.wasm");
const profile = join(out, "engine.profile");
execFileSync("wasm-split", ["--instrument", ...features, whole, "-o", instrumented]);
writeFileSync(profile, await profile_of(instrumented));
execFileSync("wasm-split", ["--split", ...features, whole, `--profile=${profile}`, "-o1", join(out, "engine.wasm"), "-o2", join(out, "rest.wasm")]);
