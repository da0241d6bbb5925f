// Bundles the page: OUT/index.html with laboratory.js, engine.wasm, hdf5.js and hdf5.wasm beside it, and OUT/laboratory.html, one file.
//   node build.mjs ENGINE OUT       ENGINE: the folder with engine.js and engine.wasm
import { build } from "esbuild";
import { copyFileSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const [engine, out] = process.argv.slice(2).map((path) => resolve(path));
const here = dirname(fileURLToPath(import.meta.url));
const usual = { bundle: true, minify: true, format: "iife", target: "es2022", write: false, logLevel: "warning", absWorkingDir: here };

const worker = await build({ ...usual, entryPoints: ["src/engine/worker.ts"], alias: { "hamflow-engine": join(engine, "engine.js") }, external: ["fs", "path"] });
const gallery = readdirSync(join(here, "src/gallery")).filter((name) => name.endsWith(".toml")).sort();
const files = gallery.map((name) => ({ name, text: readFileSync(join(here, "src/gallery", name), "utf8") }));
const views = readdirSync(join(here, "src/views")).filter((name) => name.endsWith(".ts")).sort();
const imports = views.map((name, i) => `import { make as view${i} } from ${JSON.stringify(join(here, "src/views", name))};`);
const made = { "all-views": `${imports.join("")}export const views = [${views.map((_, i) => `view${i}`)}];`, "worker-source": `export default ${JSON.stringify(worker.outputFiles[0].text)}`, "gallery-files": `export const files = ${JSON.stringify(files)}` };
const made_modules = {
  name: "made-modules",
  setup(into) {
    into.onResolve({ filter: /^(worker-source|gallery-files|all-views)$/ }, ({ path }) => ({ path, namespace: "made" }));
    into.onLoad({ filter: /.*/, namespace: "made" }, ({ path }) => ({ contents: made[path], loader: "js", resolveDir: here }));
  },
};
let hdf5_library;
const without_library = {
  name: "without-library",
  setup(into) {
    into.onLoad({ filter: /hdf5_util\.js$/ }, ({ path }) => {
      const text = readFileSync(path, "utf8");
      const bytes = /"data:application\/octet-stream;base64,([^"]{1000,})"/.exec(text);
      const place = 'Module["wasmBinary"]';
      if (bytes === null || text.split(place).length !== 2) throw new Error("h5wasm has another form than the version in package.json");
      hdf5_library = Buffer.from(bytes[1], "base64");
      return { contents: text.replace(bytes[0], () => '"hdf5.wasm"').replace(place, "self.hdf5_wasm"), loader: "js" };
    });
  },
};
const hdf5 = await build({ ...usual, entryPoints: ["src/engine/hdf5_worker.ts"], plugins: [without_library] });
const hdf5_script = Buffer.from(hdf5.outputFiles[0].contents);
const page = await build({ ...usual, entryPoints: ["src/main.ts"], plugins: [made_modules] });
const script = page.outputFiles[0].text;
const style = readFileSync(join(here, "node_modules/uplot/dist/uPlot.min.css"), "utf8") + readFileSync(join(here, "src/style.css"), "utf8");
const wasm = readFileSync(join(engine, "engine.wasm"));
const template = readFileSync(join(here, "src/index.html"), "utf8");

// The replacements are functions: a text may contain $&.
function html(engine_part, script_part) {
  return template
    .replace("<!--style-->", () => `<style>\n${style}</style>`)
    .replace("<!--engine-->", () => engine_part)
    .replace("<!--script-->", () => script_part);
}
mkdirSync(out, { recursive: true });
writeFileSync(join(out, "index.html"), html("", '<script src="laboratory.js"></script>'));
writeFileSync(join(out, "laboratory.js"), script);
writeFileSync(join(out, "engine.wasm"), wasm);
copyFileSync(join(engine, "engine.js"), join(out, "engine.js")); // for programs that run the engine without the page
writeFileSync(join(out, "hdf5.js"), hdf5_script);
writeFileSync(join(out, "hdf5.wasm"), hdf5_library);
const stored = (id, bytes) => `<script type="application/octet-stream" id="${id}">${gzipSync(bytes, { level: 9 }).toString("base64")}</script>`;
const inlined = stored("engine", wasm) + "\n" + stored("hdf5", hdf5_script) + "\n" + stored("hdf5-library", hdf5_library);
const single = html(inlined, `<script>${script.replaceAll("</script", "<\\/script")}</script>`);
writeFileSync(join(out, "laboratory.html"), single);
const first_load = [script, style, template].reduce((sum, text) => sum + gzipSync(text, { level: 9 }).length, gzipSync(wasm, { level: 9 }).length);
console.log(`${join(out, "index.html")} (${Math.round(first_load / 1000)} kB gzip)\n${join(out, "laboratory.html")} (${(single.length / 1e6).toFixed(2)} MB)`);
