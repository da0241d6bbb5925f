// The engine of the laboratory under Node, without the page.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

export async function load_engine(folder) {
  const make = createRequire(import.meta.url)(resolve(folder, "engine.js"));
  const module = await make({ wasmBinary: readFileSync(join(folder, "engine.wasm")) });
  const stored = (text) => {
    const bytes = module.lengthBytesUTF8(text) + 1;
    const address = module._malloc(bytes);
    module.stringToUTF8(text, address, bytes);
    return address;
  };
  return {
    /// The functions of web/engine/engine.cpp, for one motion.
    call(name, ...args) {
      const given = args.map((arg) => (typeof arg === "string" ? stored(arg) : arg));
      const answer = JSON.parse(module.UTF8ToString(module[`_hamflow_${name}`](0, ...given)));
      given.forEach((address, i) => typeof args[i] === "string" && module._free(address));
      return answer;
    },
    /// Numbers that a function returns by address, and counts that it returns.
    numbers(name, count) {
      const address = module[`_hamflow_${name}`](0) / 8;
      return module.HEAPF64.slice(address, address + count);
    },
    count: (name) => module[`_hamflow_${name}`](0),
  };
}
