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
  // With reduced motion nothing plays by itself, so that a test decides what moves.
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, acceptDownloads: true, reducedMotion: "reduce", ...options });
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
const set_input = (page, selector, value, event = "input") => page.locator(selector).evaluate((input, [to, what]) => ((input.value = to), input.dispatchEvent(new Event(what))), [String(value), event]);
const set_speed = (page, value) => set_input(page, "#speed", value);
const last_number = (value) => Number(/([-\d.e]+)\D*$/.exec(value)?.[1]);
const ended = (page) => page.waitForFunction(() => document.getElementById("play").textContent === "Play", null, { timeout: 120_000 });
/// So that the status that is waited for is that of the next scenario.
const forget_status = (page) => page.evaluate(() => (document.getElementById("status").textContent = ""));
async function typed(page, toml) {
  await page.locator("#editor").fill(toml);
  await page.locator("#x").evaluate((input) => (input.value = ""));
  await page.locator("#y").evaluate((input) => (input.value = ""));
  await forget_status(page);
  await page.locator("#integrate").click();
  // The controls wait for the text to be opened.
  await page.waitForFunction(() => (document.getElementById("status").textContent.startsWith("step 0 of") && !document.getElementById("controls").inert) || document.querySelector("#complaints li"));
}
async function picture(page, name) {
  if (pictures === undefined) return;
  mkdirSync(pictures, { recursive: true });
  await page.screenshot({ path: join(pictures, `${name}.png`), fullPage: true });
}

/// What the main thread of the page does meanwhile, in milliseconds of the processor: those of the clock depend on what else runs.
async function main_thread(page, work) {
  const session = await browser.newBrowserCDPSession();
  const events = [];
  session.on("Tracing.dataCollected", ({ value }) => events.push(...value));
  const categories = ["toplevel", "devtools.timeline", "disabled-by-default-devtools.timeline", "__metadata"];
  await session.send("Tracing.start", { traceConfig: { includedCategories: categories }, transferMode: "ReportEvents" });
  await work();
  const complete = new Promise((resolve) => session.once("Tracing.tracingComplete", resolve));
  await session.send("Tracing.end");
  await complete;
  await session.detach();
  const thread = (event) => `${event.pid}/${event.tid}`;
  const pictures_of = new Map(events.filter(({ name, args }) => name === "thread_name" && args.name === "CrRendererMain").map((event) => [thread(event), []]));
  for (const event of events) if (event.name === "FireAnimationFrame" && event.tdur !== undefined) pictures_of.get(thread(event))?.push(event.tdur / 1000);
  const [main, times] = [...pictures_of].sort((a, b) => b[1].length - a[1].length)[0]; // other pages of the browser draw nothing
  const tasks = events.filter((event) => thread(event) === main && /RunTask/.test(event.name) && event.tdur !== undefined);
  const sorted = times.sort((a, b) => a - b);
  return { longest: Math.max(0, ...tasks.map(({ tdur }) => tdur / 1000)), frames: sorted[Math.floor(0.95 * sorted.length)] ?? 0 };
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
    const before = page.url();
    await typed(page, toml);
    await page.waitForFunction((old) => location.href !== old, before);
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
    await page.locator("#section-clear").click(); // the starts of the example
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
    expect(readFileSync(await saved.path(), "utf8").startsWith("start,t,y,p_y\n"), "section.csv");
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
    await page.locator("summary", { hasText: "Open and export" }).click();
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
    for (let i = 0; i < files.length; ++i) {
      await forget_status(page);
      await page.locator("#gallery").selectOption(String(i));
      await page.waitForFunction(() => document.getElementById("status").textContent.startsWith("step 0 of") || document.querySelector("#complaints li"), null, { timeout: 60_000 });
      await set_speed(page, 3.5);
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

  async "every example has three sentences and a question, and no empty section"() {
    const folder = join(source, "src/gallery");
    const names = readdirSync(folder).filter((name) => name.endsWith(".toml")).sort();
    for (const name of names) {
      const head = (key) => new RegExp(`^# ${key}: (.*)$`, "m").exec(readFileSync(join(folder, name), "utf8"))?.[1] ?? "";
      expect(head("look").split(/(?<=[.!?])\s+/).length === 3, `${name}: three sentences: ${head("look")}`);
      expect(/^[^.]*(\.\d[^.]*)*\?$/.test(head("question")), `${name}: a question: ${head("question")}`);
    }
    const page = await opened({ viewport: { width: 360, height: 800 } });
    for (let i = 0; i < names.length; ++i) {
      await forget_status(page);
      await page.locator("#gallery").selectOption(String(i));
      await page.waitForFunction(() => document.getElementById("status").textContent.startsWith("step 0 of"));
      const [question, orbit] = await Promise.all(["question", "orbit"].map((id) => page.locator(`#${id}`).boundingBox()));
      expect(question.y + question.height < orbit.y, `${names[i]}: the question is above the picture`);
      expect((await page.evaluate(() => document.documentElement.scrollWidth)) <= 360, `${names[i]}: no wider than 360 px`);
      if (await page.locator("#section").isVisible()) await page.waitForFunction(() => Number(document.getElementById("section-count").textContent.split(" ")[0]) > 5000, null, { timeout: 60_000 });
      await page.waitForTimeout(200);
      expect(/^step 0 of/.test(await text(page, "status")), `${names[i]}: with reduced motion nothing plays by itself: ${await text(page, "status")}`);
    }
    expect((await page.locator("#gallery option").count()) === names.length + 1, "all are in the list");
    await page.locator("#gallery").selectOption({ label: "Sun, Jupiter and Saturn" });
    await page.waitForFunction(() => document.getElementById("legend").textContent === "SunJupiterSaturn");
    await page.locator("#gallery").selectOption({ label: "Three bodies from rest" });
    await page.waitForFunction(() => document.getElementById("legend").textContent === "body 1, mass 3body 2, mass 4body 3, mass 5");
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
  },

  async "examples can be changed while they play"() {
    const page = await opened({ reducedMotion: "no-preference" });
    for (const i of [4, 6, 1, 7, 3, 20, 0, 18, 15]) {
      await page.locator("#gallery").selectOption(String(i));
      await page.waitForTimeout(120);
    }
    await page.waitForFunction(() => /^step [1-9]/.test(document.getElementById("status").textContent) && document.getElementById("play").textContent === "Pause");
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
  },

  async "a slider takes the starts of an example to another energy"() {
    const page = await opened();
    await page.waitForFunction(() => Number(document.getElementById("section-count").textContent.split(" ")[0]) > 15000);
    const energy = page.getByLabel("energy", { exact: true });
    await energy.fill("0.03"); // some starts need more
    await energy.press("Enter");
    await page.waitForFunction(() => /energy = 0.03/.test(document.getElementById("editor").value));
    await page.waitForFunction(() => { const count = Number(document.getElementById("section-count").textContent.split(" ")[0]); return count > 5000 && count < 18000; });
    const points = async () => Number((await text(page, "section-count")).split(" ")[0]);
    let count = 0;
    for (let before = -1; count !== before; count = await points()) { // until nothing is added
      before = count;
      await page.waitForTimeout(1500);
    }
    expect(count < 18000 && count % 2000 === 0, `those that exist: ${count}`);
    expect((await text(page, "complaints")) === "", `the others are left out: ${await text(page, "complaints")}`);
  },

  async "what the main thread does is printed"() {
    const page = await opened({ reducedMotion: "no-preference" });
    const under = async (what, work) => {
      const { longest, frames } = await main_thread(page, work);
      console.log(`  ${what}: longest task ${longest.toFixed(0)} ms, a picture ${frames.toFixed(1)} ms of the processor`);
    };
    for (const i of [0, 4, 10]) {
      await under(`example ${i + 1}`, async () => {
        await page.locator("#gallery").selectOption(String(i));
        await page.waitForTimeout(2500);
      });
    }
    await page.locator("#gallery").selectOption("0");
    await page.waitForTimeout(1000);
    const section = page.locator("#section");
    const box = await section.boundingBox();
    await under("20 starts", async () => {
      for (let k = 0; k < 20; ++k) await section.click({ position: { x: box.width * (0.3 + 0.02 * k), y: box.height * 0.5 } });
      await page.waitForTimeout(2500);
    });
    await under("zoom and time line", async () => {
      for (let k = 0; k < 3; ++k) await page.locator("#section-in").click();
      for (let k = 1; k < 8; ++k) await page.locator("#scrub").fill(String(10 * k));
    });
    await under("a map", async () => {
      await page.locator("#map-figure summary").click();
      await page.locator("#map-cells").fill("150");
      await page.locator("#map-paint").click();
      await page.waitForTimeout(2500);
    });
    await under("typing", async () => {
      await page.locator("#editor").press("Control+End");
      await page.keyboard.type("\n[output]\nobs", { delay: 30 });
    });
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
  },

  async "keys reach every control"() {
    const page = await opened();
    await page.locator("#gallery").selectOption({ label: "The spherical pendulum" });
    await page.waitForFunction(() => document.getElementById("z").value === "z" && document.querySelectorAll("#controls .control").length > 0);
    for (const summary of await page.locator("summary").all()) {
      await summary.focus();
      const is_open = await summary.evaluate((each) => each.parentElement.open);
      if (!is_open) await page.keyboard.press("Enter");
    }
    const controls = await page.evaluate(() => {
      const all = [...document.querySelectorAll("button, input, select, textarea, summary, canvas[tabindex='0']")].filter((each) => each.checkVisibility() && !each.disabled && !each.closest("[inert], .uplot"));
      all.forEach((each, i) => (each.dataset.number = i));
      document.activeElement.blur();
      return all.length;
    });
    const reached = new Set();
    for (let k = 0; k < controls + 20; ++k) {
      await page.keyboard.press("Tab");
      reached.add(await page.evaluate(() => document.activeElement.dataset.number));
    }
    reached.delete(undefined);
    expect(reached.size === controls, `${reached.size} of ${controls} controls are reached`);
    const pixels = () => page.locator("#orbit").evaluate((canvas) => canvas.toDataURL());
    const before = await pixels();
    await page.locator("#orbit").focus();
    await page.keyboard.press("ArrowRight");
    await page.waitForTimeout(200);
    expect(before !== (await pixels()) && /^step 0 of/.test(await text(page, "status")), "arrow keys turn the picture in space");
    for (const [id, key] of [["play", "Enter"], ["step", " "]]) {
      await page.locator(`#${id}`).focus();
      await page.keyboard.press(key);
    }
    await page.waitForFunction(() => /^step [1-9]/.test(document.getElementById("status").textContent));
    await page.locator("#speed").focus();
    const speed = await text(page, "speed-text");
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction((old) => document.getElementById("speed-text").textContent !== old, speed);
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
      const check = async (what) => {
        const { violations } = await page.evaluate(() => globalThis.axe.run());
        const serious = violations.filter((each) => each.impact === "serious" || each.impact === "critical");
        expect(serious.length === 0, `${what}, ${colorScheme}: ${serious.map((each) => `${each.id} ${each.nodes.map((node) => node.target).join(", ")}`).join("; ")}`);
      };
      await check("a motion");
      const count = await page.locator("#gallery option").count();
      for (let i = 0; i < count - 1; ++i) {
        await forget_status(page);
        await page.locator("#gallery").selectOption(String(i));
        await page.waitForFunction(() => document.getElementById("status").textContent.startsWith("step 0 of"));
        await page.locator("#step").click();
        await check(`example ${i + 1}`);
      }
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
      await page.waitForFunction(() => document.getElementById("facts").textContent.startsWith("t0x1y0"));
      await picture(page, kind);
      await page.locator("#integrate").click();
      await page.waitForFunction(() => document.getElementById("status").textContent.startsWith("step 0 of 4000"));
      expect(await page.locator("#recorded").isHidden(), "the scenario is integrated instead");
      expect(page.errors.length === 0, `no errors: ${page.errors}`);
      rmSync(dirname(given), { recursive: true });
    }
  },

  async "a slider changes the text and starts the motion again"() {
    const page = await opened();
    await typed(page, lattice);
    await page.waitForFunction(() => document.querySelectorAll("#controls .control").length === 5);
    const names = await page.locator("#controls .control span").allTextContents();
    expect(names.join().replaceAll("\u200b", "") === "dt,x,y,p_x,p_y", `controls: ${names}`);
    await set_input(page, ".control:first-child input[type=range]", 900);
    await page.waitForFunction(() => !document.getElementById("editor").value.includes("dt = 0.05"));
    const dt = Number(/^dt = (.*)$/m.exec(await page.locator("#editor").inputValue())?.[1]);
    expect(dt > 0.2 && dt < 0.5, `the scale of dt is logarithmic: ${dt}`);
    expect((await page.locator("#editor").inputValue()).replace(/dt = .*/, "dt = 0.05") === lattice, "nothing else has changed");
    await page.waitForFunction((wanted) => document.getElementById("facts").textContent.includes(`dt${wanted}`), String(dt));
    await page.locator(".control input[inputmode]").nth(2).fill("0.2");
    await page.locator(".control input[inputmode]").nth(2).press("Enter");
    await page.waitForFunction(() => document.getElementById("editor").value.includes("q = [0, 0.2]"));
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
  },

  async "the start is dragged in the picture"() {
    const page = await opened();
    await typed(page, lattice.replace("p = [0.45, 0.1] }", "p = [0.3, 0.1] } # a comment"));
    const box = await page.locator("#orbit").boundingBox();
    // Before the motion the start is in the middle of the axes.
    const [x, y] = [box.x + 70 + (box.width - 82) / 2, box.y + 10 + (box.height - 52) / 2];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 30, y - 20, { steps: 5 });
    await page.mouse.up();
    await page.waitForFunction(() => !document.getElementById("editor").value.includes("q = [0, 0.1]"));
    const toml = await page.locator("#editor").inputValue();
    expect(/q = \[[-\d.e]+, [-\d.e]+\], p = \[0.3, 0.1\] \} # a comment/.test(toml), `only the start has changed: ${toml}`);
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
  },

  async "names are completed"() {
    const page = await opened();
    const complete = async (toml, typed_text, key = "Tab") => {
      await page.locator("#editor").fill(toml);
      await page.locator("#editor").press("Control+End");
      await page.keyboard.type(typed_text);
      await page.waitForFunction(() => !document.getElementById("completions").hidden);
      await page.keyboard.press(key);
      return page.locator("#editor").inputValue();
    };
    expect((await complete("[met", "h")) === "[method]\n", "a table");
    expect((await complete("[method]\nname = \"", "yos")).startsWith('[method]\nname = "yoshida'), "a method");
    expect((await complete("[run]\n", "arith")) === '[run]\narithmetic = "', "a key");
    expect((await complete('[run]\narithmetic = "', "lat", "Enter")) === '[run]\narithmetic = "lattice', "a word of a key");
    expect((await complete('[problem]\nname = "', "pend")) === '[problem]\nname = "pendulum', "a problem");
    await page.keyboard.press("Escape");
    expect(await page.locator("#completions").isHidden(), "Escape closes the list");
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
  },

  async "a map is painted, and a click starts the motion of a cell"() {
    const page = await opened();
    await typed(page, lattice.replace('arithmetic = "lattice"\n', ""));
    await page.locator("#map-figure summary").click();
    await page.waitForFunction(() => document.getElementById("map-y").value === "problem.initial.q[1]");
    for (const [id, value] of [["map-x-from", "-0.4"], ["map-x-to", "0.4"], ["map-y-from", "-0.4"], ["map-y-to", "0.6"], ["map-cells", "40"], ["map-steps", "1000"]]) await page.locator(`#${id}`).fill(value);
    await page.locator("#map-paint").click();
    await page.waitForFunction(() => /cells of 1000 steps in/.test(document.getElementById("map-status").textContent), null, { timeout: 120_000 });
    console.log(`  ${await text(page, "map-status")}`);
    await picture(page, "map");
    const [saved] = await Promise.all([page.waitForEvent("download"), page.locator("#map-csv").click()]);
    const rows = readFileSync(await saved.path(), "utf8").trim().split("\n");
    expect(rows[0] === "problem.initial.q[0],problem.initial.q[1],lyapunov" && rows.length === 1601, `map.csv: ${rows[0]}, ${rows.length} rows`);
    const numbers = rows.slice(1).map(last_number).filter(Number.isFinite);
    expect(numbers.length > 800 && Math.min(...numbers) < 0.02 && Math.max(...numbers) > 0.03, "regular and chaotic starts differ");
    const [png] = await Promise.all([page.waitForEvent("download"), page.locator("#map-png").click()]);
    expect(readFileSync(await png.path()).subarray(1, 4).toString() === "PNG", "map.png");
    const box = await page.locator("#map").boundingBox();
    await page.locator("#map").click({ position: { x: 70 + (box.width - 70 - 94) / 2, y: 10 + (box.height - 52) / 2 } });
    await page.waitForFunction(() => !document.getElementById("editor").value.includes("q = [0, 0.1]"));
    expect(/q = \[-?0\.0[\d]*, 0\.[01]\d*\]/.test(await page.locator("#editor").inputValue()), `the start of the cell: ${await page.locator("#editor").inputValue()}`);
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
  },

  async "files are dropped"() {
    const page = await opened();
    const drop = async (name, bytes) => {
      await page.evaluate(() => (document.getElementById("complaints").textContent = ""));
      const transfer = await page.evaluateHandle(([file, letters]) => {
        const data = new DataTransfer();
        data.items.add(new File([Uint8Array.from(atob(letters), (each) => each.charCodeAt(0))], file));
        return data;
      }, [name, bytes.toString("base64")]);
      await page.dispatchEvent("body", "drop", { dataTransfer: transfer });
    };
    const formats = join(source, "../tests/data/formats/1.0");
    await drop("run.h5", readFileSync(join(formats, "run/run.h5")));
    await page.waitForFunction(() => document.getElementById("recorded").textContent.startsWith("run.h5: 5 rows"), null, { timeout: 30_000 });
    expect((await text(page, "facts")).startsWith("t") && /q1/.test(await text(page, "facts")), `the columns: ${await text(page, "facts")}`);
    expect(/henon-heiles/.test(await page.locator("#editor").inputValue()), "its scenario");
    const csv = readFileSync(join(formats, "run/trajectory.csv"), "utf8").trim().split("\n").pop().split(",").map(Number);
    const [saved] = await Promise.all([page.waitForEvent("download"), page.evaluate(() => document.getElementById("save-csv").click())]);
    const rows = readFileSync(await saved.path(), "utf8").trim().split("\n");
    const last = rows.pop().split(",").map(Number);
    expect(last.slice(0, 5).every((value) => csv.includes(value)), `the last row: ${last}; trajectory.csv: ${csv}`);
    await drop("sweep.h5", readFileSync(join(formats, "sweep/sweep.h5")));
    await page.waitForFunction(() => document.getElementById("recorded").textContent.startsWith("sweep.h5: 3 members"));
    await drop("notes.txt", Buffer.from("hello"));
    await page.waitForFunction(() => /notes.txt is no scenario \(.toml\) and no run.h5/.test(document.getElementById("complaints").textContent));
    await drop("reverse.h5", readFileSync(join(formats, "reversal/reverse.h5")));
    await page.waitForFunction(() => /reverse.h5 is no run.h5 or sweep.h5/.test(document.getElementById("complaints").textContent));
    await drop("damaged.h5", readFileSync(join(formats, "run/run.h5")).subarray(0, 3000));
    await page.waitForFunction(() => /damaged.h5 is damaged or incomplete/.test(document.getElementById("complaints").textContent));
    await drop("kepler.toml", Buffer.from(lattice));
    await page.waitForFunction(() => document.getElementById("status").textContent.startsWith("step 0 of 4000"));
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
  },

  async "the time line moves motion, section and series"() {
    const page = await opened();
    await set_speed(page, 5);
    await page.locator("#play").click();
    await page.waitForFunction(() => Number(document.getElementById("section-count").textContent.split(" ")[0]) > 20);
    await page.locator("#play").click();
    await page.waitForFunction(() => document.getElementById("play").textContent === "Play");
    const pixels = () => page.evaluate(() => ["orbit", "section"].map((id) => document.getElementById(id).toDataURL()).concat(document.querySelector("#energy canvas").toDataURL()));
    const rows = Number(await page.locator("#scrub").getAttribute("max"));
    const before = await pixels();
    await page.locator("#scrub").fill(String(Math.round(rows / 3)));
    await page.waitForTimeout(300);
    const third = await pixels();
    expect(before.every((picture_, i) => picture_ !== third[i]), "all pictures show the row");
    const time = last_number(await text(page, "time-text"));
    expect(time > 0, `its time: ${time}`);
    await picture(page, "scrubbed");
    await page.locator("#energy").scrollIntoViewIfNeeded();
    const energy = await page.locator("#energy .u-over").boundingBox();
    await page.mouse.click(energy.x + energy.width * 0.8, energy.y + 30);
    await page.waitForFunction((at) => Number(/t = (.*)/.exec(document.getElementById("time-text").textContent)?.[1]) > at, time);
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
  },

  async "the picture in space turns"() {
    const page = await opened();
    const index = (await page.locator("#gallery option").allTextContents()).indexOf("The spherical pendulum");
    await page.locator("#gallery").selectOption({ index });
    await page.waitForFunction(() => document.getElementById("z").value === "z");
    await set_speed(page, 4);
    await page.locator("#play").click();
    await page.waitForTimeout(500);
    await page.locator("#play").click();
    await page.waitForFunction(() => document.getElementById("play").textContent === "Play");
    await page.waitForTimeout(100);
    const pixels = () => page.locator("#orbit").evaluate((canvas) => canvas.toDataURL());
    const before = await pixels();
    const box = await page.locator("#orbit").boundingBox();
    await page.mouse.move(box.x + 200, box.y + 200);
    await page.mouse.down();
    await page.mouse.move(box.x + 300, box.y + 230, { steps: 4 });
    await page.mouse.up();
    await page.waitForTimeout(100);
    expect(before !== (await pixels()), "the pointer turns it");
    await picture(page, "space");
    expect(page.errors.length === 0, `no errors: ${page.errors}`);
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
