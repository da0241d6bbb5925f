// CPU times of the engine under Node, and of the command where it is given. Prints; a figure to look at, no test.
//   node speed.mjs FOLDER [HAMFLOW]      FOLDER: build/web
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { load_engine } from "./engine.mjs";

const [folder, hamflow] = process.argv.slice(2);
const engine = await load_engine(folder);

/// CPU-seconds of this process.
function spent(action) {
  const before = process.cpuUsage();
  action();
  const { user, system } = process.cpuUsage(before);
  return (user + system) / 1e6;
}
function call(...args) {
  const answer = engine.call(...args);
  if (answer.errors) throw new Error(answer.errors[0].message);
  return answer;
}
const kepler = `[problem]\nname = "formula"\ncoordinates = ["x", "y"]\nhamiltonian = "(p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2)"
initial = { q = [0.4, 0], p = [0, 2] }\n[method]\nname = "stv4"\n[run]\ndt = 0.01\nsteps = 1000\n`;
const henon = `[problem]\nname = "formula"\ncoordinates = ["x", "y"]\nhamiltonian = "(p_x^2 + p_y^2)/2 + (x^2 + y^2)/2 + x^2*y - y^3/3"
initial = { q = [0, 0.1], p = ["+", 0.1], energy = 0.11 }\n[method]\nname = "stv4"\n[run]\ndt = 0.05\nsteps = 1000\nsection = { coordinate = "x" }\n`;

const times = [];
call("open", kepler, "");
call("advance", 200000, 200000);
for (let k = 0; k < 5; ++k) times.push(spent(() => call("advance", 1e6, 1e6)) * 1000);
const page = Math.min(...times);
console.log(`Kepler stv4: ${page.toFixed(1)} ns a step (${times.map((x) => x.toFixed(0)).join(" ")})`);
if (hamflow) {
  const work = mkdtempSync(join(tmpdir(), "hamflow-speed-"));
  const file = join(work, "kepler.toml");
  writeFileSync(file, kepler);
  const of_command = (steps) => {
    const text = `TIMEFORMAT=%U; time "${hamflow}" run ${file} --set run.steps=${steps} --set run.certificate=false --out none --quiet >/dev/null`;
    return Number(execFileSync("bash", ["-c", `(${text}) 2>&1`], { encoding: "utf8" }));
  };
  const all = [0, 1, 2].map(() => ((of_command(2.2e7) - of_command(2e6)) / 2e7) * 1e9);
  const command = Math.min(...all);
  console.log(`  the command: ${command.toFixed(1)} ns (${all.map((x) => x.toFixed(0)).join(" ")}); ratio ${(page / command).toFixed(2)}`);
  rmSync(work, { recursive: true });
}

const sets = Array.from({ length: 20 }, (_, k) => `problem.initial={ q = [0, ${-0.3 + 0.03 * k}], p = ["+", 0.02], energy = 0.11 }`);
for (const starts of [1, 20]) {
  for (let k = 0; k < 2; ++k) {
    let step = 0;
    const seconds = spent(() => {
      call("starts", henon, sets.slice(-starts).join("\n"));
      step = call("points_of_starts", 2000, 1e9).step;
    });
    console.log(`section of ${starts} starts x 2000 points: ${seconds.toFixed(2)} s, ${step} steps`);
  }
}
const one_by_one = spent(() => {
  call("open", henon, sets[19]);
  call("advance", 250000, 250000);
});
console.log(`section of one motion: ${one_by_one.toFixed(2)} s for 250000 steps`);

const x = "problem.initial.q[1]=-0.4:0.6:200";
const y = "problem.initial.p[1]=-0.4:0.4:200";
for (const observable of ["lyapunov", "energy_error", "x"]) {
  call("map", henon, x, y, observable, 2000);
  let done = 0;
  const seconds = spent(() => (done = call("cells", 19000, 1, 2000, 1e9).done));
  console.log(`map of ${observable}, 2000 steps: ${((seconds / done) * 1e6).toFixed(0)} us a cell, ${((seconds / done) * 40000 / 2).toFixed(1)} s for 200 x 200 on two cores`);
}
call("map", henon, x, y, "x", 1);
console.log(`a cell of one step: ${(spent(() => call("cells", 19000, 1, 2000, 1e9)) * 500).toFixed(0)} us`);
