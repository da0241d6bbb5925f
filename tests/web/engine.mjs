// The engine of the laboratory under Node, without the page.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

/// @param rest the second part (web/split.mjs); null: an error when it is needed
export async function load_engine(folder, rest = "engine-rest.wasm") {
  const make = createRequire(import.meta.url)(resolve(folder, "engine.js"));
  const { instantiate } = await import(pathToFileURL(resolve(folder, "parts.mjs")));
  const compiled = (name) => new WebAssembly.Module(readFileSync(join(folder, name)));
  const module = await make({
    instantiateWasm(imports, done) {
      const first = compiled("engine.wasm");
      const instance = instantiate(first, imports, () => {
        if (rest === null) throw new Error("a function of the second part is called");
        return compiled(rest);
      });
      done(instance, first);
      return instance.exports;
    },
  });
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
