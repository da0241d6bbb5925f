"""hamflow sweep: its table is written while it runs, and --resume goes on with the members that are not finished."""

import csv
import json
import random
import shutil
import signal
import subprocess
import time
import unittest

from command import HAMFLOW, CommandCase

MEASURED = """
[problem]
name = "henon-heiles"
initial = { q = [0.1, 0.1], p = [0.2, 0.3] }
[method]
name = "stv4"
[run]
dt = 0.05
steps = 3000
section = { coordinate = "q1" }
lyapunov = 2
eigenvalues = true
[output]
formats = ["h5", "csv"]
observables = { r = "q1^2 + q2^2" }
"""
TUBE = """
[problem]
name = "t-tube"
masses = [1, 100]
eps = -0.6
velocities = [6, 1]
wall_rule = "event"
[method]
name = "stv4"
[run]
dt = 0.01
steps = 3000
events = [{ name = "meet", expression = "q1 - q2", direction = 0 }, { name = "far", expression = "q1*q2 - 1.79", action = "stop" }]
[output]
formats = ["h5", "csv"]
"""
FILES = ("sweep.h5", "sweep.csv", "section.csv")


class SweepResume(CommandCase):
    def start(self, *words):
        return subprocess.Popen([HAMFLOW, "sweep", *words], cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True)

    def files(self, folder):
        return {name: (self.folder / folder / name).read_bytes() for name in FILES if (self.folder / folder / name).exists()}

    def table(self, folder):
        return list(csv.DictReader((self.folder / folder / "sweep.csv").read_text().splitlines()))

    def until(self, holds):
        end = time.monotonic() + 60
        while time.monotonic() < end:
            if holds():
                return
            time.sleep(0.02)
        self.fail("never came")

    def test_kills(self):
        """Whatever is measured, the files of a sweep that was killed are those of one that was not, to the byte."""
        rng = random.Random(1)
        for name, text, vary in (("m", MEASURED, "problem.initial.q[0]=0:0.2:24"), ("t", TUBE, "problem.velocities[0]=1:6:24")):
            self.write(f"{name}.toml", text)
            words = [f"{name}.toml", "--vary", vary, "--quiet"]
            begin = time.monotonic()
            self.hamflow("sweep", *words, "--out", f"{name}.wanted")
            seconds = time.monotonic() - begin
            for lanes in ("auto", "none"):
                shutil.rmtree(self.folder / f"{name}.found", ignore_errors=True)
                more = [*words, "--out", f"{name}.found", "--resume", "--lanes", lanes]
                for threads in ("1", "2", "1", "2"):
                    process = self.start(*more, "--threads", threads)
                    time.sleep(rng.uniform(0, seconds))
                    process.kill()
                    process.communicate()
                self.hamflow("sweep", *more)
                self.assertEqual(self.files(f"{name}.wanted"), self.files(f"{name}.found"))
            wanted, found = (json.loads((self.folder / f"{name}.{what}" / "summary.json").read_text())
                             for what in ("wanted", "found"))
            for key in ("status", "members", "done", "failed", "unfinished", "varied", "failures", "warnings"):
                self.assertEqual(wanted[key], found[key])

    def test_written_while_it_runs_and_interrupted(self):
        self.write("t.toml", TUBE.replace(', action = "stop"', ""))
        words = ["t.toml", "--vary", "run.steps=100,200,20000000000", "--threads", "2"]
        folder = self.folder / "t.sweep"
        process = self.start(*words, "--json")
        self.until(lambda: (folder / "sweep.csv").exists() and
                   [row["member/status"] for row in self.table("t.sweep")] == ["done", "done", "not_run"])
        self.assertTrue((folder / "sweep.h5").exists())
        self.assertFalse((folder / "summary.json").exists())
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual((json.loads(out)["done"], json.loads(out)["unfinished"]), (2, 1))
        rows = self.table("t.sweep")
        self.assertEqual([row["member/status"] for row in rows], ["done", "done", "interrupted"])
        self.assertGreater(int(rows[2]["member/steps"]), 0)
        kept = len((folder / "members.bin").read_bytes())
        process = self.start(*words, "--resume")
        self.assertIn("2 of 3 members are finished", process.stderr.readline())
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(len((folder / "members.bin").read_bytes()), kept)  # none of them was run again
        self.assertEqual(self.table("t.sweep")[:2], rows[:2])

    def test_events_and_observables_are_those_of_single_runs(self):
        self.write("t.toml", TUBE)
        self.hamflow("sweep", "t.toml", "--vary", "problem.velocities[0]=1:6:4", "--vary", "problem.wall_rule=event,reject,mirror",
                     "--out", "s", "--quiet")
        stopped = 0
        for row in self.table("s"):
            one = self.summary("t.toml", "--set", f"problem.velocities[0]={row['problem.velocities[0]']}", "--set",
                               f"problem.wall_rule={row['problem.wall_rule']}")
            self.assertEqual((row["member/status"], int(row["member/steps"])), ("done", one["steps"]))
            self.assertEqual({key[len("events/"):]: int(n) for key, n in row.items() if key.startswith("events/")}, one["events"])
            self.assertEqual({f"observables/{name}_{what}": x for name, seen in one["observables"].items() for what, x in seen.items()},
                             {key: float(x) for key, x in row.items() if key.startswith("observables/")})
            self.assertEqual(row["stopped_by/event"], one.get("stopped_by", {"event": ""})["event"])
            if row["stopped_by/event"]:
                stopped += 1
                self.assertEqual([float(row[f"stopped_by/{x}"]) for x in ("t", "q1", "q2", "p1", "p2")],
                                 [one["stopped_by"]["t"], *one["stopped_by"]["q"], *one["stopped_by"]["p"]])
        self.assertTrue(0 < stopped < 12, stopped)
        self.hamflow("sweep", "t.toml", "--vary", "problem.velocities[0]=1:6:4", "--out", "none", "--figure", "n.svg", "--colour",
                     "events/wall:q1:max", "--quiet")

    def test_halved_steps_are_counted(self):
        self.write("k.toml", MEASURED[:MEASURED.index("section")].replace('"stv4"', '"cg(2,6)"\non_divergence = "halve"')
                   .replace('"henon-heiles"', '"central-force"\npotential = "kepler"')
                   .replace("q = [0.1, 0.1], p = [0.2, 0.3]", "q = [1, 0], p = [0, 0.3]").replace("0.05", "0.3"))
        vary, seen = "problem.initial.p[1]=0.01:0.3:6", []
        for lanes in ("auto", "none"):
            done = self.hamflow("sweep", "k.toml", "--vary", vary, "--set", "run.steps=300", "--lanes", lanes, "--out", "none", "--json")
            seen.append([row["events"] for row in json.loads(done.stdout)["rows"]])
        self.assertEqual(seen[0], seen[1])
        one = self.summary("k.toml", "--set", "problem.initial.p[1]=0.3", "--set", "run.steps=300")
        self.assertEqual(seen[0][-1], one["events"])
        self.assertGreater(one["events"]["halved"], 0)

    def test_refusals(self):
        self.write("m.toml", MEASURED)
        words = ("sweep", "m.toml", "--set", "run.steps=100", "--out", "s")
        vary = ("--vary", "problem.initial.q[0]=0,0.1")
        self.hamflow(*words, *vary)
        before = self.files("s")
        for more, found in ((("--vary", "problem.initial.q[0]=0,0.2"), "--vary: error: found problem.initial.q[0]=0,0.2; allowed"),
                            ((*vary, "--vary", "run.dt=0.1"), "--vary: error: found run.dt=0.1; allowed"),
                            ((*vary, "--zip"), "--zip: error: found --zip; allowed"),
                            ((*vary, "--set", "run.dt=0.1"), "run.dt: found 0.1; allowed"),
                            ((*vary, "--set", "method.name=verlet"), "method.name: found"),
                            ((*vary, "--set", "output.formats=['csv']"), "output.formats: found"),
                            ((*vary, "--force"), "found --resume with --force")):
            done = self.hamflow(*words, *more, "--resume", "--json", status=2)
            self.assertIn(found, done.stderr)
            self.assertEqual(json.loads(done.stdout)["status"], "rejected")
        self.hamflow("sweep", "m.toml", *vary, "--resume", "--out", "none", status=2)
        self.assertEqual(self.files("s"), before)
        # What is there is of no sweep that could go on.
        (self.folder / "s" / "members.bin").rename(self.folder / "kept.bin")
        self.assertIn("contains sweep.h5", self.hamflow(*words, *vary, "--resume", status=3).stderr)
        self.hamflow("run", "m.toml", "--set", "run.steps=100", "--out", "r")
        self.assertIn("found a run in r", self.hamflow("sweep", "m.toml", *vary, "--out", "r", "--resume", status=3).stderr)
        (self.folder / "b").mkdir()
        (self.folder / "kept.bin").rename(self.folder / "b" / "members.bin")
        self.assertIn("found a sweep", self.hamflow("run", "m.toml", "--out", "b", "--force", status=3).stderr)

    def test_other_numbers_of_steps(self):
        """Members that were finished sooner, or later, begin anew; free keys change nothing else."""
        self.write("m.toml", MEASURED)
        vary = ("--vary", "problem.initial.q[0]=0,0.1,0.2", "--quiet")
        for steps in (200, 300, 200):
            self.hamflow("sweep", "m.toml", "--set", f"run.steps={steps}", *vary, "--out", f"fresh{steps}", "--force")
            done = self.hamflow("sweep", "m.toml", "--set", f"run.steps={steps}", "--vary", vary[1], "--out", "s", "--resume")
            self.assertEqual(self.files("s"), self.files(f"fresh{steps}"))
        self.assertIn("3 members had another number of steps", done.stderr)
        done = self.hamflow("sweep", "m.toml", "--set", "run.t_end=10", "--set", "run.checkpoint_every=7", "--vary", vary[1], "--out",
                            "s", "--resume")
        self.assertIn("nothing to do", done.stderr)

    def test_damage_costs_members_and_no_bit(self):
        self.write("t.toml", TUBE)
        words = ("sweep", "t.toml", "--vary", "problem.velocities[0]=1:6:5", "--set", "run.steps=300", "--quiet", "--out", "s")
        self.hamflow(*words)
        wanted = self.files("s")
        members = self.folder / "s" / "members.bin"
        whole = members.read_bytes()
        rng = random.Random(2)
        seen = set()
        for _ in range(40):
            at = rng.choice((rng.randrange(len(whole)), rng.randrange(200)))
            bad = bytearray(whole[:at] if rng.random() < 0.3 else whole)
            if at < len(bad):
                bad[at] ^= 1 << rng.randrange(8)
            members.write_bytes(bad)
            done = subprocess.run([HAMFLOW, *words, "--resume"], cwd=self.folder, capture_output=True, text=True, timeout=60)
            seen.add(done.returncode)
            self.assertIn(done.returncode, (0, 3), done.stderr)
            if done.returncode == 3:
                self.assertIn("members.bin ", done.stderr)
            else:
                self.assertEqual(members.read_bytes()[:16], whole[:16])
            self.assertEqual(self.files("s"), wanted)
        self.assertEqual(seen, {0, 3})


if __name__ == "__main__":
    unittest.main()
