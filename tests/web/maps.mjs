// Cells of maps and section points of many starts, which the engine computes in lanes, have the bits of single motions; an
// exponent that of the command.
//   node maps.mjs HAMFLOW FOLDER      FOLDER: build/web
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { load_engine } from "./engine.mjs";

const [hamflow, folder] = process.argv.slice(2);
if (!existsSync(join(folder, "engine.wasm"))) {
  console.log("skipped: there is no page; ./dev web builds it");
  process.exit(77);
}
const engine = await load_engine(folder);
let wrong = 0;
function check(what, found, expected, is_same = Object.is) {
  const different = found.length !== expected.length ? -1 : found.findIndex((x, i) => !is_same(x, expected[i]));
  if (found.length === expected.length && different < 0) return;
  ++wrong;
  console.error(`${what}: found ${found.length} numbers, expected ${expected.length}; ${found[different]} in place of ${expected[different]}`);
}

function formula(coordinates, hamiltonian, start, more = "", run = "dt = 0.05", method = "stv4") {
  return `[problem]\nname = "formula"\ncoordinates = ${JSON.stringify(coordinates)}\nhamiltonian = "${hamiltonian}"\n${more}
initial = { ${start} }\n[method]\nname = "${method}"\n[run]\n${run}\nsteps = 1000\n`;
}
const henon = (more, run, method) =>
  formula(["x", "y"], "(p_x^2 + p_y^2)/2 + (x^2 + y^2)/2 + x^2*y - a*y^3/3", "q = [0, 0.1], p = [0.45, 0.1]", `parameters = { a = 1 }\n${more ?? ""}`, run, method);
const walls = 'walls = [{ coordinate = "x", min = -0.3, max = 0.3 }]';
const pendulum = formula(["q"], "p^2/2 - cos(q)", "q = [1.3], p = [0.1]", "", "dt = 0.1");

/// The i-th of `count` values from `from` to `to`, as the engine makes them.
const value = ({ from, to, count }, i) => (i === 0 ? from : i + 1 === count ? to : from + (to - from) * (i / (count - 1)));
const axis = ({ key, from, to, count }) => `${key}=${from}:${to}:${count}`;

const q1 = { key: "problem.initial.q[1]", from: -0.3, to: 0.4, count: 7 };
const p1 = { key: "problem.initial.p[1]", from: -0.2, to: 0.2, count: 5 };
const steps = 700;
const of_state = {
  energy_error: (state) => state.energy.max_error,
  relative_energy_error: (state) => state.energy.max_error / state.energy.scale,
  bounces: (state) => state.walls.reduce((sum, wall) => sum + wall.bounces, 0),
  "x + 3*p_y": (state) => state.final.q[0] + 3 * state.final.p[1],
  "q^2": (state) => state.final.q[0] * state.final.q[0],
};
const maps = [
  ["starts", henon(), q1, p1, "energy_error"],
  ["starts, relative", henon(), q1, p1, "relative_energy_error"],
  ["an expression", henon(), q1, p1, "x + 3*p_y"],
  ["a parameter and a start", henon(), { key: "problem.parameters.a", from: 0.5, to: 1.5, count: 5 }, q1, "x + 3*p_y"],
  ["the step size", henon(), { key: "run.dt", from: 0.01, to: 0.1, count: 5 }, q1, "energy_error"],
  ["walls", henon(walls), q1, p1, "bounces"],
  ["walls, states", henon(walls), q1, p1, "x + 3*p_y"],
  ["implicit steps, one by one", henon("", "dt = 0.1", "cg"), q1, p1, "x + 3*p_y"],
  ["compensated", henon("", 'dt = 0.05\narithmetic = "compensated"'), q1, p1, "x + 3*p_y"],
  ["sines", pendulum, { key: "problem.initial.q[0]", from: -1, to: 1, count: 6 }, { key: "run.dt", from: 0.1, to: 0.2, count: 3 }, "q^2"],
];
for (const [name, text, x, y, observable] of maps) {
  const facts = engine.call("map", text, axis(x), axis(y), observable, steps);
  if (facts.errors) {
    ++wrong;
    console.error(`${name}: ${facts.errors[0].message}`);
    continue;
  }
  const cells = engine.call("cells", 0, 1, facts.columns * facts.rows, 1e9);
  const expected = [];
  for (let iy = 0; iy < y.count; ++iy) {
    for (let ix = 0; ix < x.count; ++ix) {
      engine.call("open", text, `${x.key}=${value(x, ix)}\n${y.key}=${value(y, iy)}`);
      const state = engine.call("advance", steps, steps);
      expected.push(state.failed ? NaN : of_state[observable](state));
    }
  }
  check(`map over ${name} (${facts.lanes} lanes)`, [...engine.numbers("cell_numbers", cells.done)], expected);
}

// Cells in any order and in slices.
engine.call("map", henon(), axis(q1), axis(p1), "x + 3*p_y", steps);
engine.call("cells", 0, 1, 35, 1e9);
const all = [...engine.numbers("cell_numbers", 35)];
const some = engine.call("cells", 1, 4, 5, 1e9);
check("every fourth cell", [...engine.numbers("cell_numbers", some.done)], [1, 5, 9, 13, 17].map((k) => all[k]));
const end = engine.call("cells", 33, 1, 100, 1e9);
check("cells at the end", [...engine.numbers("cell_numbers", end.done)], all.slice(33));

// Exponents, against the command.
engine.call("map", henon(), axis(q1), axis(p1), "lyapunov", 2000);
engine.call("cells", 0, 1, 35, 1e9);
const exponents = [...engine.numbers("cell_numbers", 35)];
const work = mkdtempSync(join(tmpdir(), "hamflow-maps-"));
const chosen = [0, 9, 17, 34];
const of_command = chosen.map((cell) => {
  const file = join(work, "scenario.toml");
  writeFileSync(file, henon().replace("steps = 1000", "steps = 2000\nlyapunov = 1"));
  const sets = [`${q1.key}=${value(q1, cell % 7)}`, `${p1.key}=${value(p1, Math.floor(cell / 7))}`].flatMap((set) => ["--set", set]);
  const told = execFileSync(hamflow, ["run", file, ...sets, "--out", "none", "--quiet", "--json"], { encoding: "utf8" });
  return JSON.parse(told).lyapunov.exponents[0];
});
rmSync(work, { recursive: true });
check("exponents", chosen.map((cell) => exponents[cell]), of_command, (a, b) => Math.abs(a - b) <= 1e-9 * Math.abs(b));
const refused = engine.call("map", henon("", "dt = 0.1", "cg"), axis(q1), axis(p1), "lyapunov", 100);
if (!refused.errors?.[0].message.startsWith("lyapunov: found cg")) ++wrong, console.error("exponents of implicit steps are not refused");

// Section points of starts together are those of motions alone, in order.
for (const [name, more, method] of [["stv4", "", "stv4"], ["cg", "", "cg"], ["walls", walls, "stv4"]]) {
  const text = henon(more, 'dt = 0.05\nsection = { coordinate = "x" }', method);
  const sets = [0.05, 0.1, 0.15, 0.2].map((y) => `problem.initial={ q = [0, ${y}], p = ["+", 0.05], energy = 0.1 }`);
  engine.call("starts", text, sets.join("\n"));
  const state = engine.call("points_of_starts", 30, 1e9);
  const numbers = engine.numbers("start_numbers", engine.count("start_number_count"));
  const rows = sets.map(() => []);
  for (let at = 0; at < numbers.length; at += 6) rows[numbers[at]].push(...numbers.slice(at + 1, at + 6));
  sets.forEach((set, k) => {
    engine.call("open", text, set);
    engine.call("advance", state.step, state.step);
    const points = engine.numbers("points", engine.count("point_count"));
    check(`section of ${name}, start ${k}`, rows[k], [...points.slice(0, 30 * 5)]);
  });
}
const keys = engine.call("sweepable", henon()).map((each) => each.key);
for (const key of ["problem.initial.q[0]", "problem.initial.p[1]", "problem.parameters.a", "run.dt"]) {
  if (!keys.includes(key)) ++wrong, console.error(`sweepable: ${key} is missing in ${keys.join(", ")}`);
}
console.log(wrong === 0 ? "maps and sections have the bits of single motions" : `${wrong} differences`);
process.exit(wrong === 0 ? 0 : 1);
