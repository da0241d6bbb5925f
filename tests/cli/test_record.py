"""record = [times]: samples at any times by partial steps, which change nothing else."""

import csv
import json
import os
import subprocess
import unittest

from command import CommandCase

COMPARE = os.environ["COMPARE_RUNS"]
BOTH = ("--set", "output.formats=['h5','csv']")


class Record(CommandCase):
    def rows(self, folder):
        with open(self.folder / folder / "trajectory.csv") as file:
            return [dict(row) for row in csv.DictReader(file)]

    def run_to(self, folder, *arguments, status=0):
        done = self.hamflow("run", "kepler.toml", "--out", folder, "--json", *BOTH, *arguments, status=status)
        return json.loads(done.stdout)

    def test_samples_are_partial_steps(self):
        for method in ("cg(1,5)", "stv4", "verlet-dkd", "rk4"):
            with self.subTest(method=method):
                name = method.split("(")[0]
                options = ["--set", f"method={{name='{name}'{', quadrature=5' if name == 'cg' else ''}}}"]
                self.run_to(name, *options, "--set", "run.record=['1/30', '0.05', 0.1, 0.75, 4.03]", "--set", "run.steps=60")
                rows = self.rows(name)
                self.assertEqual([row["step"] for row in rows], ["0", "0", "1", "7", "40"])
                self.assertEqual([float(row["t"]) for row in rows], [1 / 30, 0.05, 0.1, 0.75, 4.03])
                # From the start one step of that length gives the same bits.
                for row, dt in ((rows[0], "1/30"), (rows[1], "0.05")):
                    one = self.summary("kepler.toml", *options, "--set", f"run.dt='{dt}'", "--set", "run.steps=1")
                    self.assertEqual([float(row["q1"]), float(row["q2"])], one["final"]["q"])
                    self.assertEqual([float(row["p1"]), float(row["p2"])], one["final"]["p"])
                # At a step's time stand the step's bits.
                one = self.summary("kepler.toml", *options, "--set", "run.steps=1")
                self.assertEqual([float(rows[2]["q1"]), float(rows[2]["p2"])], [one["final"]["q"][0], one["final"]["p"][1]])
                # Later a partial step from the last step: close to a run with a dt that meets the time.
                fine = self.summary("kepler.toml", *options, "--set", "run.dt=0.01", "--set", "run.steps=403")
                whole = self.summary("kepler.toml", *options, "--set", "run.steps=40")
                fine_40 = self.summary("kepler.toml", *options, "--set", "run.dt=0.01", "--set", "run.steps=400")
                at_step = abs(whole["final"]["q"][0] - fine_40["final"]["q"][0])
                self.assertLess(abs(float(rows[4]["q1"]) - fine["final"]["q"][0]), 2 * at_step + 1e-12)

    def test_cg_keeps_the_energy_between_steps(self):
        self.run_to("r", "--set", "run.record=" + str([0.037 + 0.1 * k for k in range(300)]))
        energies = [float(row["energy"]) for row in self.rows("r")]
        self.assertEqual(len(energies), 300)
        # The run's own level: some roundings of H = -0.25 a step, not a polynomial's error of 1e-4.
        self.assertLess(max(energies) - min(energies), 64 * 2.0**-52)

    def test_recording_changes_no_bit(self):
        plain = self.run_to("plain")
        times = self.run_to("times", "--set", "run.record=[0.05, 0.15, 3.333, 39.99, 40]")
        for summary in (plain, times):
            del summary["wall_seconds"], summary["steps_per_second"]
        self.assertEqual(plain, times)
        for key in ("q1", "q2", "p1", "p2", "t", "step", "energy"):
            self.assertEqual(self.rows("times")[-1][key], self.rows("plain")[-1][key])

    def test_start_and_end_are_not_added(self):
        self.run_to("r", "--set", "run.record=[1]")
        self.assertEqual([row["step"] for row in self.rows("r")], ["10"])
        done = subprocess.run([COMPARE, "r/run.h5", "r/run.h5"], cwd=self.folder, capture_output=True, text=True)
        self.assertIn(" 1 rows", done.stdout)

    def test_step_times_that_round(self):
        # 3 * 0.1 is not 0.3 in double: it is the time of step 3 all the same; 0.3 + 1e-10 is not.
        self.run_to("r", "--set", "run.record=[0.3, 0.3000000001, '7/10', 0.8]")
        self.assertEqual([row["step"] for row in self.rows("r")], ["3", "3", "7", "8"])
        self.run_to("plain", "--set", "run.record_every=1")
        plain = self.rows("plain")
        rows = self.rows("r")
        self.assertEqual([rows[0], rows[2], rows[3]], [plain[3], plain[7], plain[8]])
        self.assertNotEqual(rows[1]["q1"], rows[0]["q1"])

    def test_backwards(self):
        self.run_to("r", "--set", "run.dt=-0.1", "--set", "run.record=[0, -0.05, -1.23, -40]")
        self.assertEqual([row["step"] for row in self.rows("r")], ["0", "0", "12", "400"])
        self.assertEqual([float(row["t"]) for row in self.rows("r")], [0, -0.05, -1.23, -40])

    def test_with_resume(self):
        times = "run.record=" + str([0.033 * k for k in range(1, 1200)])
        self.run_to("whole", "--set", times, "--set", "run.steps=1000")
        self.run_to("part", "--set", times)
        self.run_to("part", "--resume", "--set", times, "--set", "run.steps=1000", status=0)
        self.assertEqual(self.rows("whole"), self.rows("part"))
        self.hamflow("run", "kepler.toml", "--out", "part", "--resume", *BOTH, "--set", "run.record=[1]", "--set",
                     "run.steps=2000", status=2)

    def test_errors(self):
        for value, words in (("[]", "0 entries"), ("0.5", "array of numbers"), ("[1, 1]", "strictly increasing"),
                             ("[2, 1]", "in the order of the run"), ("[-0.1]", "from 0 to the end, 40"),
                             ("[40.001]", "from 0 to the end, 40"), ("['x']", "number"), ("[nan]", "number")):
            done = self.hamflow("run", "kepler.toml", "--set", "run.record=" + value, status=2)
            self.assertIn("run.record", done.stderr)
            self.assertIn(words, done.stderr)
        done = self.hamflow("run", "kepler.toml", "--set", "run.record=[1]", "--set", "run.record_every=1", status=2)
        self.assertIn("record_every", done.stderr)

    def test_a_partial_step_that_fails_ends_the_run(self):
        # One iteration converges for no step that is worth the name, and for a step of length 1e-16.
        done = self.hamflow("run", "kepler.toml", "--out", "r", "--json", "--set", "run.record=[0.05]", "--set",
                            "method.max_iterations=1", status=1)
        error = json.loads(done.stdout)["error"]
        self.assertEqual(error["kind"], "not_converged")
        self.assertEqual(error["step"], 1)
        self.assertIn("t = 0.05", error["message"])


if __name__ == "__main__":
    unittest.main()
