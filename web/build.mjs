// Bundles the page: OUT/index.html with laboratory.js and engine.wasm beside it, and OUT/laboratory.html, one file.
//   node build.mjs ENGINE OUT       ENGINE: the folder with engine.js and engine.wasm
import { build } from "esbuild";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const [engine, out] = process.argv.slice(2).map((path) => resolve(path));
const here = dirname(fileURLToPath(import.meta.url));
const usual = { bundle: true, minify: true, format: "iife", target: "es2022", write: false, logLevel: "warning", absWorkingDir: here };

const worker = await build({ ...usual, entryPoints: ["src/engine/worker.ts"], alias: { "hamflow-engine": join(engine, "engine.js") } });
const worker_source = {
  name: "worker-source",
  setup(into) {
    into.onResolve({ filter: /^worker-source$/ }, () => ({ path: "worker-source", namespace: "text" }));
    into.onLoad({ filter: /.*/, namespace: "text" }, () => ({ contents: worker.outputFiles[0].text, loader: "text" }));
  },
};
const page = await build({ ...usual, entryPoints: ["src/main.ts"], plugins: [worker_source] });
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
const inlined = `<script type="application/octet-stream" id="engine">${gzipSync(wasm, { level: 9 }).toString("base64")}</script>`;
const single = html(inlined, `<script>${script.replaceAll("</script", "<\\/script")}</script>`);
writeFileSync(join(out, "laboratory.html"), single);
console.log(`${join(out, "index.html")}\n${join(out, "laboratory.html")} (${(single.length / 1e6).toFixed(2)} MB)`);
