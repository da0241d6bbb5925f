// The laboratory in Chromium: what a visitor does, and what must come of it.
//   node page.mjs FOLDER [PICTURES]      FOLDER: build/web; PICTURES: a folder for screenshots
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const [folder, pictures] = process.argv.slice(2);
const source = join(dirname(fileURLToPath(import.meta.url)), "../../web");
const file = resolve(folder, "laboratory.html");
const browser_path = ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find((path) => existsSync(path));
const missing = !existsSync(file) ? "there is no page; ./dev web builds it" : browser_path === undefined ? "there is no chromium" : !existsSync(join(source, "node_modules/playwright-core")) ? "playwright-core is not installed; ./dev web installs it" : "";
if (missing !== "") {
  console.log(`skipped: ${missing}`);
  process.exit(77);
}
const { chromium } = createRequire(join(source, "package.json"))("playwright-core");
const axe = readFileSync(join(source, "node_modules/axe-core/axe.min.js"), "utf8");
const browser = await chromium.launch({ executablePath: browser_path, args: ["--no-sandbox"] });

let failures = 0;
function expect(condition, what) {
  if (condition) return;
  ++failures;
  console.error(`failed: ${what}`);
}

async function opened(options = {}, address = pathToFileURL(file).href) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.errors = [];
  page.on("pageerror", (error) => page.errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && page.errors.push(message.text()));
  page.on("request", (request) => /^https?:/.test(request.url()) && page.errors.push(`asked for ${request.url()}`));
  await page.goto(address);
  await page.waitForFunction(() => !document.getElementById("play").disabled, null, { timeout: 60_000 });
  return page;
}
const text = (page, id) => page.locator(`#${id}`).textContent();
const set_speed = (page, value) => page.locator("#speed").evaluate((input, to) => ((input.value = to), input.dispatchEvent(new Event("input"))), String(value));
const ended = (page) => page.waitForFunction(() => document.getElementById("play").textContent === "Play", null, { timeout: 120_000 });
async function typed(page, toml) {
  await page.locator("#editor").fill(toml);
  await page.locator("#x").evaluate((input) => (input.value = ""));
  await page.locator("#y").evaluate((input) => (input.value = ""));
  await page.locator("#integrate").click();
  await page.waitForFunction(() => document.getElementById("status").textContent.startsWith("step 0 of") || document.querySelector("#complaints li"));
}
async function picture(page, name) {
  if (pictures === undefined) return;
  mkdirSync(pictures, { recursive: true });
  await page.screenshot({ path: join(pictures, `${name}.png`), fullPage: true });
}

const lattice = `[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2 + (x^2 + y^2)/2 + x^2*y - y^3/3"
initial = { q = [0, 0.1], p = [0.45, 0.1] }

[method]
name = "stv4"

[run]
dt = 0.05
steps = 4000
arithmetic = "lattice"
`;

const tests = {
  async "the first picture moves, and the address holds the scenario"() {
    const page = await opened();
    await set_speed(page, 4);
    await page.locator("#play").click();
    await page.waitForFunction(() => Number(/step (\d+)/.exec(document.getElementById("status").textContent)?.[1]) > 1000);
    expect(/largest energy error/.test(await text(page, "facts")), "the energy error is shown");
    await page.waitForFunction(() => /energy error/.test(document.getElementById("certificate").textContent));
    await picture(page, "1280");
    const toml = lattice.replace("0.45", "0.44");
    await page.locator("#play").click();
    await typed(page, toml);
    const address = page.url();
    const other = await opened({}, address);
    expect((await other.locator("#editor").inputValue()) === toml, "the address restores the scenario");
    expect(page.errors.length + other.errors.length === 0, `no errors: ${page.errors} ${other.errors}`);
  },

  async "a mistake is reported at its place"() {
    const page = await opened();
    await typed(page, lattice.replace("stv4", "stv5"));
    expect(/line 8.*stv5/.test(await text(page, "complaints")), `the message of the reader: ${await text(page, "complaints")}`);
    await page.locator("#complaints button").click();
    expect((await page.evaluate(() => document.activeElement.id)) === "editor", "its place is selected");
  },

  async "a motion on the lattice comes back to the last bit"() {
    const page = await opened();
    await typed(page, lattice);
    await set_speed(page, 5);
    await page.locator("#play").click();
    await ended(page);
    await page.locator("#reverse").click();
    await page.waitForFunction(() => document.getElementById("returned").textContent !== "", null, { timeout: 60_000 });
    const found = /(\d+) of (\d+) bits/.exec(await text(page, "returned"));
    expect(found !== null && found[1] === found[2], `all bits come back: ${await text(page, "returned")}`);
    await typed(page, lattice.replace("lattice", "double"));
    await page.locator("#play").click();
    await ended(page);
    await page.locator("#reverse").click();
    await page.waitForFunction(() => document.getElementById("returned").textContent !== "", null, { timeout: 60_000 });
    const in_double = /(\d+) of (\d+) bits/.exec(await text(page, "returned"));
    expect(in_double !== null && in_double[1] !== in_double[2], "in double they do not");
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
  },

  async "a judgement does not change a motion"() {
    const page = await opened();
    const final = async (speed) => {
      await typed(page, lattice.replace("lattice", "double"));
      await set_speed(page, speed);
      await page.locator("#play").click();
      await ended(page);
      return page.locator("#facts").textContent();
    };
    expect((await final(6)) === (await final(3)), "the same numbers with and without certificates on the way");
  },

  async "a second method runs on the same clock"() {
    const page = await opened();
    await typed(page, lattice.replace('arithmetic = "lattice"\n', ""));
    await page.locator("#second").selectOption("rk4");
    await page.waitForFunction(() => (document.getElementById("facts").textContent.match(/method/g) ?? []).length === 2);
    await set_speed(page, 5);
    await page.locator("#play").click();
    await ended(page);
    const methods = await page.locator("#facts tr").allTextContents();
    expect(methods.includes("methodstv4") && methods.includes("methodrk4"), `both methods: ${methods}`);
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
  },

  async "clicks into the section of Henon and Heiles become orbits"() {
    const page = await opened();
    const section = page.locator("#section");
    const box = await section.boundingBox();
    const before = Date.now();
    for (let i = 0; i < 8; ++i) await section.click({ position: { x: box.width * (0.45 + 0.025 * i), y: box.height * 0.45 } });
    const all = () => page.waitForFunction(() => document.getElementById("section-count").textContent === "16000 points", null, { timeout: 120_000 });
    await all().catch(async (error) => {
      throw new Error(`${await text(page, "section-count")}; ${await text(page, "complaints")}; ${error}`);
    });
    console.log(`  8 starts with 2000 points each: ${((Date.now() - before) / 1000).toFixed(1)} s`);
    await picture(page, "section");
    const [saved] = await Promise.all([page.waitForEvent("download"), page.locator("#section-csv").click()]);
    expect(readFileSync(await saved.path(), "utf8").startsWith("start,y,p_y\n"), "section.csv");
    await page.locator("#section-clear").click();
    await page.locator("#section-x").fill("0.2");
    await page.locator("#section-y").fill("0.1");
    await page.locator("#section-add").click();
    await page.waitForFunction(() => Number(document.getElementById("section-count").textContent.split(" ")[0]) >= 2000, null, { timeout: 60_000 });
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
  },

  async "everything is exported"() {
    const page = await opened();
    await page.locator("#step").click();
    await page.locator("summary").click();
    const saved = async (id) => {
      const [download] = await Promise.all([page.waitForEvent("download"), page.locator(`#${id}`).click()]);
      return readFileSync(await download.path());
    };
    expect((await saved("save-toml")).toString() === (await page.locator("#editor").inputValue()), "scenario.toml");
    const rows = (await saved("save-csv")).toString().split("\n");
    expect(rows[0] === "t,x,y,p_x,p_y,energy error" && rows.length === 4, `trajectory.csv: ${rows}`);
    expect((await saved("save-svg")).toString().startsWith("<svg"), "orbit.svg");
    expect((await saved("save-png")).subarray(1, 4).toString() === "PNG", "orbit.png");
  },

  async "every example runs"() {
    const page = await opened();
    const titles = await page.locator("#gallery option").allTextContents();
    const files = readdirSync(join(source, "src/gallery")).filter((name) => name.endsWith(".toml"));
    expect(titles.length === files.length + 1, `${titles.length - 1} examples`);
    await set_speed(page, 3.5);
    for (let i = 0; i < files.length; ++i) {
      await page.locator("#gallery").selectOption(String(i));
      await page.waitForFunction(() => document.getElementById("status").textContent.startsWith("step 0 of") || document.querySelector("#complaints li"), null, { timeout: 60_000 });
      await page.locator("#play").click();
      await page.waitForTimeout(1500);
      if ((await text(page, "play")) === "Pause") await page.locator("#play").click();
      await page.waitForFunction(() => document.getElementById("play").textContent === "Play");
      expect((await text(page, "complaints")) === "", `${files[i]}: ${await text(page, "complaints")}`);
      expect(/^step [1-9]/.test(await text(page, "status")), `${files[i]}: ${await text(page, "status")}`);
      if (pictures !== undefined) await picture(page, `example-${files[i].replace(".toml", "")}`);
    }
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
  },

  async "360 px and 768 px are wide enough"() {
    for (const width of [360, 768]) {
      const page = await opened({ viewport: { width, height: 800 }, colorScheme: width === 360 ? "dark" : "light" });
      await set_speed(page, 4);
      await page.locator("#play").click();
      await page.waitForTimeout(1500);
      const scrolled = await page.evaluate(() => document.documentElement.scrollWidth);
      expect(scrolled <= width, `${scrolled} px at ${width} px`);
      await picture(page, String(width));
    }
  },

  async "axe finds nothing serious, light and dark"() {
    for (const colorScheme of ["light", "dark"]) {
      const page = await opened({ colorScheme });
      await set_speed(page, 4);
      await page.locator("#play").click();
      await page.waitForTimeout(2500);
      await page.locator("#play").click();
      await page.evaluate(axe);
      const { violations } = await page.evaluate(() => globalThis.axe.run());
      const serious = violations.filter((each) => each.impact === "serious" || each.impact === "critical");
      expect(serious.length === 0, `${colorScheme}: ${serious.map((each) => `${each.id} ${each.nodes.map((node) => node.target).join(", ")}`).join("; ")}`);
    }
  },

  async "the samples of a run and the members of a sweep are shown"() {
    const rows = Array.from({ length: 101 }, (_, i) => [i / 10, Math.cos(i / 10), Math.sin(i / 10), 0]);
    const encoded = Buffer.from(new Float64Array(rows.flat()).buffer).toString("base64");
    for (const kind of ["run", "sweep"]) {
      const data = { kind, name: `circle.${kind}`, toml: lattice, columns: ["t", "x", "y", "energy error"], rows: encoded, note: "" };
      const given = join(mkdtempSync(join(tmpdir(), "hamflow-page-")), "page.html");
      const script = `<script type="application/json" id="inlined">${JSON.stringify(data)}</script>`;
      writeFileSync(given, readFileSync(file, "utf8").replace("<!--inlined-->", () => script));
      const page = await opened({}, pathToFileURL(given).href);
      expect((await text(page, "recorded")).startsWith(`circle.${kind}: 101 ${kind === "run" ? "rows" : "members"}`), "what is shown");
      expect((await text(page, "facts")).startsWith("t10x-0.8391"), `the last row: ${await text(page, "facts")}`);
      await page.locator("#scrub").fill("0");
      expect((await text(page, "facts")).startsWith("t0x1y0"), "the first row");
      await picture(page, kind);
      await page.locator("#integrate").click();
      await page.waitForFunction(() => document.getElementById("status").textContent.startsWith("step 0 of 4000"));
      expect(await page.locator("#recorded").isHidden(), "the scenario is integrated instead");
      expect(page.errors.length === 0, `no errors: ${page.errors}`);
      rmSync(dirname(given), { recursive: true });
    }
  },

  async "keys work"() {
    const page = await opened();
    await page.locator("h1").click();
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction(() => document.getElementById("status").textContent.startsWith("step 1 of"));
    await page.keyboard.press(" ");
    expect((await text(page, "play")) === "Pause", "space plays");
  },
};

const only = process.env.TEST;
for (const [name, run] of Object.entries(tests)) {
  if (only !== undefined && !name.includes(only)) continue;
  const before = Date.now();
  const failed = failures;
  try {
    await run();
  } catch (error) {
    ++failures;
    console.error(`failed: ${name}: ${error.stack}`);
  }
  for (const context of browser.contexts()) await context.close();
  console.log(`${failures === failed ? "ok" : "FAILED"} ${name} (${((Date.now() - before) / 1000).toFixed(1)} s)`);
}
await browser.close();
process.exit(failures === 0 ? 0 : 1);
