// Bundles the page: OUT/index.html with laboratory.js, engine.wasm, engine-rest.wasm, hdf5.js and hdf5.wasm beside it, and
// OUT/laboratory.html, one file.
//   node build.mjs ENGINE OUT       ENGINE: the folder with engine.js and engine.wasm
import { build } from "esbuild";
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { split_engine } from "./split.mjs";

const [engine, out] = process.argv.slice(2).map((path) => resolve(path));
const here = dirname(fileURLToPath(import.meta.url));
const usual = { bundle: true, minify: true, format: "iife", target: "es2022", write: false, logLevel: "warning", absWorkingDir: here };

const worker = await build({ ...usual, entryPoints: ["src/engine/worker.ts"], alias: { "hamflow-engine": join(engine, "engine.js") }, external: ["fs", "path"] });
const data_worker = await build({ ...usual, entryPoints: ["src/engine/data_worker.ts"] });
const gallery = readdirSync(join(here, "src/gallery")).filter((name) => name.endsWith(".toml")).sort();
const heads_first = /^(# \w+: .*\n)*/; // comments at the head of a file say what to look at
const files = gallery.map((name) => {
  const text = readFileSync(join(here, "src/gallery", name), "utf8");
  const [heads] = heads_first.exec(text);
  return { name, heads: Object.fromEntries([...heads.matchAll(/^# (\w+): (.*)$/gm)].map(([, key, value]) => [key, value])), toml: text.slice(heads.length).trimStart() };
});
const views = readdirSync(join(here, "src/views")).filter((name) => name.endsWith(".ts")).sort();
const imports = views.map((name, i) => `import { make as view${i} } from ${JSON.stringify(join(here, "src/views", name))};`);
const made = { "all-views": `${imports.join("")}export const views = [${views.map((_, i) => `view${i}`)}];`, "worker-source": `export default ${JSON.stringify(worker.outputFiles[0].text)}`, "data-worker-source": `export default ${JSON.stringify(data_worker.outputFiles[0].text)}`, "gallery-files": `export const files = ${JSON.stringify(files)}` };
const made_modules = {
  name: "made-modules",
  setup(into) {
    into.onResolve({ filter: /^(worker-source|data-worker-source|gallery-files|all-views)$/ }, ({ path }) => ({ path, namespace: "made" }));
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
const parts = (await build({ ...usual, format: "esm", entryPoints: ["src/engine/parts.ts"] })).outputFiles[0].text;
const { instantiate } = await import(`data:text/javascript,${encodeURIComponent(parts)}`);
const { first, rest } = await split_engine(engine, files[0].toml, instantiate);
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
writeFileSync(join(out, "engine.wasm"), first);
writeFileSync(join(out, "engine-rest.wasm"), rest);
copyFileSync(join(engine, "engine.js"), join(out, "engine.js")); // with parts.mjs for programs that run the engine without the page
writeFileSync(join(out, "parts.mjs"), parts);
writeFileSync(join(out, "hdf5.js"), hdf5_script);
writeFileSync(join(out, "hdf5.wasm"), hdf5_library);
const packed = (bytes) => execFileSync("gzip", ["-9nc"], { input: bytes, maxBuffer: 2 ** 26 }); // 2 % smaller than what node's zlib makes
const stored = (id, bytes) => `<script type="application/octet-stream" id="${id}">${packed(bytes).toString("base64")}</script>`;
const inlined = stored("engine", first) + "\n" + stored("engine-rest", rest) + "\n" + stored("hdf5", hdf5_script) + "\n" + stored("hdf5-library", hdf5_library);
const single = html(inlined, `<script>${script.replaceAll("</script", "<\\/script")}</script>`);
writeFileSync(join(out, "laboratory.html"), single);
const kilobytes = (...all) => `${Math.round(all.reduce((sum, each) => sum + packed(each).length, 0) / 1000)} kB`;
console.log(`${join(out, "index.html")} (gzip: ${kilobytes(template, style, script)} of script and style, ${kilobytes(first)} of the engine for the first picture, then ${kilobytes(rest)})`);
console.log(`${join(out, "laboratory.html")} (${(single.length / 1e6).toFixed(2)} MB)`);
