// The engine of the laboratory and the command compute the same bits, for scenarios of + - * / and sqrt, and with portable functions.
//   node bits.mjs HAMFLOW FOLDER      FOLDER: build/web
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { load_engine } from "./engine.mjs";

const [hamflow, folder] = process.argv.slice(2);
if (!existsSync(join(folder, "engine.wasm"))) {
  console.log("skipped: there is no page; ./dev web builds it");
  process.exit(77);
}

function formula(coordinates, hamiltonian, start, more = "") {
  return `[problem]\nname = "formula"\ncoordinates = ${JSON.stringify(coordinates)}\nhamiltonian = "${hamiltonian}"\n${more}\ninitial = { ${start} }\n`;
}
const henon = formula(["x", "y"], "(p_x^2 + p_y^2)/2 + (x^2 + y^2)/2 + x^2*y - y^3/3", "q = [0, 0.1], p = [0.45, 0.1]");
const kepler = formula(["x", "y"], "(p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2)", "q = [0.4, 0], p = [0, 2]");
const well = formula(["q"], "p^2/2 - q^2/2 + q^4/4", "q = [1.3], p = [0.1]");
const rotating = formula(["x", "y"], "(p_x^2 + p_y^2)/2 + y*p_x - x*p_y - 1/sqrt(x^2 + y^2 + 0.1)", "q = [1, 0], p = [0.1, 1.1]");
const box = formula(["x", "y"], "(p_x^2 + p_y^2)/2 + 2/(1 + 20*(x^2 + y^2))", "q = [0.8, 0.3], p = [-0.7, 0.6]",
  'walls = [{ coordinate = "x", min = -1, max = 1 }, { coordinate = "y", min = -1, max = 1 }]');
const blocks = formula(["x", "d"], "(p_x - p_d)^2/2 + p_d^2/(2*M)", "q = [1, 0.5], p = [-100, -100]",
  'parameters = { M = 100 }\nwalls = [{ coordinate = "x", min = 0 }, { coordinate = "d", min = 0 }]');
const sphere = formula(["x", "y", "z"], "(p_x^2 + p_y^2 + p_z^2)/2 + z", "q = [0.6, 0, -0.8], v = [0.4, 0.9, 0.3]", 'constraints = ["x^2 + y^2 + z^2 - 1"]');
const energy_start = formula(["x", "y"], "(p_x^2 + p_y^2)/2 + (x^2 + y^2)/2 + x^2*y - y^3/3", 'q = [0, 0.1], p = ["+", 0.1], energy = 0.125');
const bodies = `[problem]\nname = "n-body"\nmasses = [1, 1, 1]
initial = { q = [0.97000436, -0.24308753, -0.97000436, 0.24308753, 0, 0], p = [0.466203685, 0.43236573, 0.466203685, 0.43236573, -0.93240737, -0.86473146] }\n`;
const gas = `[problem]\nname = "gas"\nparticles_per_side = 5\nstart = "corner"\npair = "lennard-jones"\nscale = "per-side"\ncontainer = { kind = "circle", radius = 1.5, exponent = 1 }\n`;

const named = (name, start, more = "") => `[problem]\nname = "${name}"\n${more}${start ? `initial = { ${start} }` : ""}\n`;
const duffing = named("duffing", "q = [1.3], p = [0.4]", "mass = 1\nalpha = -1\nbeta = 1\n");
const chain = named("fput", "q = [0.3, 0.4, -0.2, 0.2], p = [0.1, -0.2, 0.2, 0.1]", "n = 4\nalpha = 0.25\nbeta = 0.5\n");
const sextic = named("sextic", "q = [0.6], p = [0.9]");
const harmonic = named("harmonic", "q = [1], p = [0.5]");
const magnetic = named("magnetic", "q = [0.4, -0.3, 0.2], p = [0.5, 0.3, 0.4]", "field = [0.1, 0.2, 1]\n");
const molecule = named("lennard-jones-oscillator", "q = [1.5], p = [0]");
const planets = named("solar-system", "", 'planets = "outer"\n');

const rotors = formula(["q1", "q2"], "p1^2/2 + p2^2/2 - cos(q1) - cos(q2) + exp(-(q1 - q2)^2) + 0.1*tanh(q1)", "q = [0.3, 1.1], p = [0.7, -0.2]");
const functions = formula(["q1"], "p1^2/2 + q1^4 + log(2 + sin(q1)) + cosh(q1/3) + sinh(q1)^2/9 + atan(q1) + asin(q1/9) - acos(q1/9) + tan(q1/9) + (2 + q1)^1.7 + atan2(q1, 3)",
  "q = [0.4], p = [0.5]");
const pendulum = named("pendulum", "q = [1.2], p = [0.4]");
const toda = formula(["q1", "q2", "q3"], "(p1^2 + p2^2 + p3^2)/2 + exp(q1 - q2) + exp(q2 - q3) + exp(q3 - q1)", "q = [0.1, 0.4, -0.5], p = [0.3, -0.2, 0.1]");
const portable = 'functions = "portable"';

/// name, problem, method or the keys of [method], run
const scenarios = [
  ["henon verlet", henon, "verlet", "dt = 0.05"],
  ["henon stv4", henon, "stv4", "dt = 0.05"],
  ["henon euler-b", henon, "euler-b", "dt = 0.02"],
  ["henon yoshida6", henon, "yoshida6", "dt = 0.05"],
  ["henon rk4", henon, "rk4", "dt = 0.05"],
  ["henon dop853", henon, "dop853", "dt = 0.1"],
  ["henon taylor", henon, "taylor", "dt = 0.1"],
  ["henon cg", henon, "cg", "dt = 0.1"],
  ["henon discrete-gradient", henon, "discrete-gradient", "dt = 0.1"],
  ["henon stv4 compensated", henon, "stv4", 'dt = 0.05\narithmetic = "compensated"'],
  ["henon stv4 lattice", henon, "stv4", 'dt = 0.05\narithmetic = "lattice"'],
  ["henon verlet lattice", henon, "verlet", 'dt = 0.05\narithmetic = "lattice"'],
  ["henon by energy", energy_start, "stv4", "dt = 0.05"],
  ["kepler verlet", kepler, "verlet", "dt = 0.01"],
  ["kepler stv4", kepler, "stv4", "dt = 0.01"],
  ["kepler rk4", kepler, "rk4", "dt = 0.01"],
  ["kepler cg", kepler, "cg", "dt = 0.02"],
  ["kepler stv4 compensated", kepler, "stv4", 'dt = 0.01\narithmetic = "compensated"'],
  ["kepler verlet lattice", kepler, "verlet", 'dt = 0.01\narithmetic = "lattice"'],
  ["well verlet", well, "verlet", "dt = 0.1"],
  ["well stv4", well, "stv4", "dt = 0.1"],
  ["well cg", well, "cg", "dt = 0.1"],
  ["rotating cg", rotating, "cg", "dt = 0.05"],
  ["rotating rk4", rotating, "rk4", "dt = 0.02"],
  ["box with walls", box, "stv4", "dt = 0.02"],
  ["blocks with walls", blocks, "verlet", "dt = 0.001"],
  ["sphere rattle4", sphere, "rattle4", "dt = 0.05"],
  ["three bodies stv4", bodies, "stv4", "dt = 0.01"],
  ["three bodies dop853", bodies, "dop853", "dt = 0.02"],
  ["duffing stv4", duffing, "stv4", "dt = 0.1"],
  ["duffing lattice", duffing, "verlet", 'dt = 0.1\narithmetic = "lattice"'],
  ["chain stv4", chain, "stv4", "dt = 0.05"],
  ["chain verlet lattice", chain, "verlet", 'dt = 0.05\narithmetic = "lattice"'],
  ["sextic cg", sextic, "cg", "dt = 0.05"],
  ["harmonic yoshida6", harmonic, "yoshida6", "dt = 0.1"],
  ["harmonic taylor", harmonic, "taylor", "dt = 0.1"],
  ["magnetic boris", magnetic, "boris", "dt = 0.1"],
  ["molecule dop853", molecule, "dop853", "dt = 0.02"],
  ["planets wisdom-holman", planets, "wisdom-holman", "dt = 20"],
  ["planets wisdom-holman lattice", planets, 'name = "wisdom-holman"\ncoordinates = "democratic-heliocentric"', 'dt = 20\narithmetic = "lattice"'],
  ["rotors stv4", rotors, "stv4", `dt = 0.05\n${portable}`],
  ["rotors cg", rotors, 'name = "cg"\nquadrature = "3"', `dt = 0.05\n${portable}`],
  ["rotors dop853", rotors, "dop853", `dt = 0.1\n${portable}`],
  ["rotors lattice", rotors, "verlet", `dt = 0.05\narithmetic = "lattice"\n${portable}`],
  ["all functions stv4", functions, "stv4", `dt = 0.05\n${portable}`],
  ["all functions gauss", functions, "gauss", `dt = 0.05\n${portable}`],
  ["all functions taylor", functions, "taylor", `dt = 0.1\n${portable}`],
  ["pendulum yoshida6", pendulum, "yoshida6", `dt = 0.1\n${portable}`],
  ["pendulum taylor", pendulum, "taylor", `dt = 0.1\n${portable}`],
  ["toda kahan-li8", toda, "kahan-li8", `dt = 0.05\n${portable}`],
  ["henon stv4 double-double", henon, "stv4", 'dt = 0.05\narithmetic = "double-double"'],
  ["henon gauss double-double", henon, "gauss", 'dt = 0.05\narithmetic = "double-double"'],
  ["bodies stv4 double-double", bodies, "stv4", 'dt = 0.01\narithmetic = "double-double"'],
  ["harmonic verlet double-double", harmonic, "verlet", 'dt = 0.05\narithmetic = "double-double"'],
  ["gas verlet", gas, "verlet", "dt = 0.001"],
  ["gas stv4 lattice", gas, "stv4", 'dt = 0.001\narithmetic = "lattice"'],
];
const steps = 1000;

const engine = await load_engine(folder);
const work = mkdtempSync(join(tmpdir(), "hamflow-bits-"));
const wrong = [];

/// @returns where the engine and the command differ; empty: nowhere
function difference(engine, toml, steps) {
  const file = join(work, "scenario.toml");
  writeFileSync(file, toml);
  const command = JSON.parse(execFileSync(hamflow, ["run", file, "--set", `run.steps=${steps}`, "--out", "none", "--quiet", "--json"], { encoding: "utf8" }));
  const facts = engine.call("open", toml, "");
  const page = facts.errors ? null : engine.call("advance", steps, steps);
  // The texts are the shortest that read back as the same double, so that equal numbers are equal bits. A motion in double-double
  // is shown in double; the errors of its energy and invariants show its other digits.
  const facts_of = ({ final, energy, invariants }) => JSON.stringify([final.q.map(Number), final.p.map(Number), energy.max_error, Object.values(invariants).map((each) => each.max_error)]);
  const [found, expected] = [page === null ? JSON.stringify(facts) : facts_of(page), facts_of(command)];
  return found === expected ? "" : `the page has ${found}; the command ${expected}`;
}

for (const [name, problem, method, run] of scenarios) {
  const toml = `${problem}\n[method]\n${method.includes("=") ? method : `name = "${method}"`}\n\n[run]\n${run}\nsteps = ${steps}\n`;
  const found = difference(engine, toml, steps);
  if (found !== "") wrong.push(`${name}: ${found}`);
}
console.log(`${scenarios.length - wrong.length} of ${scenarios.length} scenarios have equal bits`);
const first_example = readFileSync(join(dirname(fileURLToPath(import.meta.url)), "../../web/src/gallery/01_henon_heiles.toml"), "utf8").replace(/^(# .*\n)+/, "").trimStart(); // as the page has it
const of_first_part = difference(await load_engine(folder, null), first_example, 5000);
if (of_first_part !== "") wrong.push(`the first part of the engine alone: ${of_first_part}`);
rmSync(work, { recursive: true });
if (wrong.length > 0) {
  console.error(wrong.join("\n"));
  process.exit(1);
}
