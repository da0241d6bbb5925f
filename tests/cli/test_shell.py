"""hamflow shell: the numbers of hamflow run, settings that change on the way, files, errors, Ctrl-C at a terminal."""

import json
import os
import sys
import pty
import select
import signal
import subprocess
import time
import unittest
from decimal import Decimal

from command import HAMFLOW, CommandCase, until_it_works


class Shell(CommandCase):
    def shell(self, commands, *arguments, status=0, scenario="kepler.toml"):
        """What the shell says on stdout to these lines from a pipe."""
        done = subprocess.run([HAMFLOW, "shell", scenario, *arguments], cwd=self.folder, input=commands,
                              capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, status, f"{commands}\n{done.stdout}\n{done.stderr}")
        self.stderr = done.stderr
        return done.stdout

    def shown(self, commands, *arguments, **options):
        """The last object that --json shows."""
        return json.loads(self.shell(commands, "--json", *arguments, **options).splitlines()[-1])

    def final(self, *sets):
        s = self.summary("kepler.toml", *[word for text in sets for word in ("--set", text)])
        return s["final"], s

    def assert_same_as_run(self, commands, *sets):
        final, s = self.final(*sets)
        here = self.shown(commands + "show all\n")
        self.assertEqual({key: here[key] for key in ("t", "q", "p")}, final)
        self.assertEqual(here["energy"], s["energy"]["final"])
        self.assertEqual(here["max_energy_error"], s["energy"]["max_error"])
        self.assertEqual(here["angular_momentum"], s["invariants"]["angular_momentum"]["final"])
        self.assertEqual(here["force"], s["evaluations"]["force"])
        self.assertEqual(here["step"], s["steps"])

    def test_all_the_digits_of_the_arithmetic(self):
        final, s = self.final("run.arithmetic=quad", "run.steps=40", "method={name='stv4'}")
        here = self.shown("step 40\nshow all\n", "--set", "run.arithmetic=quad", "--set", "method={name='stv4'}")
        self.assertEqual({key: here[key] for key in ("t", "q", "p")}, final)
        self.assertEqual(here["energy"], s["energy"]["final"])
        # An error that no two doubles of the energy show.
        here = self.shown("step 9\nshow\n", "--set", "run.arithmetic=quad", "--set", "method={name='cg',degree=2}")
        self.assertLess(abs(here["energy_error"]), 1e-32)
        self.assertNotEqual(here["energy_error"], 0)

    def test_who_is_outside(self):
        self.write("gas.toml", "[problem]\nname='gas'\nparticles_per_side=11\n[method]\nname='stv4'\n[run]\ndt=0.01\nsteps=1\n")
        self.shell("step 30\n", scenario="gas.toml", status=1)
        self.assertIn("step 22, from t = 0.21: particle 109 was on or beyond the soft wall", self.stderr)

    def test_a_method_that_walls_refuse(self):
        self.write("wall.toml", "[problem]\nname = 'harmonic'\ninitial = { q = [0], p = [1] }\n"
                   "walls = [{ coordinate = 'q', max = 0.5 }]\n[method]\nname = 'verlet'\n[run]\ndt = 0.1\nsteps = 50\n")
        for method, rule in (("tao4", "event"), ("cg", "mirror")):
            for before in ("", "step 3\n"):
                self.shell(f"{before}method {method}\nstep 3\n", "--set", f"problem.wall_rule={rule}", status=2, scenario="wall.toml")
                self.assertIn(f'with problem.wall_rule = "{rule}" with {method}', self.stderr)
        self.shell("method cg\nstep 3\n", scenario="wall.toml")

    def test_a_method_that_many_particles_refuse(self):
        self.write("gas.toml", "[problem]\nname='gas'\nparticles_per_side=39\n[method]\nname='stv4'\n[run]\ndt=1e-4\nsteps=1\n")
        self.shell("method chin4a\n", scenario="gas.toml", status=2)
        self.assertIn("method: found chin4a with 3042 coordinates", self.stderr)

    def test_what_only_runs_measure_is_told(self):
        sets = [w for text in ("run.section={coordinate='x'}", "run.events=[{expression='x', action='stop'}]") for w in ("--set", text)]
        self.shell("step 3\n", *sets)
        self.assertIn("note: run.section, run.events are not used", self.stderr)
        for words in (["reverse", "kepler.toml"], ["compare", "kepler.toml", "--methods", "stv4", "--dt", "0.1"]):
            said = self.hamflow(*words, "--set", "run.steps=20", *sets).stderr
            self.assertIn("note: run.section, run.events are not used", said)
            self.assertNotIn("not used", self.hamflow(*words, "--set", "run.steps=20", *sets, "--quiet").stderr)

    def test_the_numbers_of_run(self):
        self.assert_same_as_run("step 400\n")
        self.assert_same_as_run("step 100\n" * 4)
        self.assert_same_as_run("step\n" * 20, "run.steps=20")
        self.assert_same_as_run("method stv4\ndt 1/30\nstep 300\n", "method={name='stv4'}", "run.dt='1/30'", "run.steps=300")
        self.assert_same_as_run("tol 1e-6\nstep 400\n", "method.tolerance=1e-6")
        self.assert_same_as_run("method cg(1,2)\nstep,,400\n", "method={name='cg',quadrature=2}")
        # A step, other settings, and back to the start: as if nothing had been.
        self.assert_same_as_run("step 7\ndt 0.05\nstep 3\nreset\nstep 800\n", "run.dt=0.05", "run.steps=800")

    def test_seventeen_digits(self):
        final, s = self.final()
        line = self.shell("step 400\nshow\n").strip()
        digits = lambda xs: "[" + ", ".join(f"{x:.17g}" for x in xs) + "]"
        self.assertTrue(line.startswith(f"t = 40  q = {digits(final['q'])}  p = {digits(final['p'])}  energy = "
                                        f"{s['energy']['final']:.17g}  energy_error = "), line)
        self.assertEqual(self.shell("step 400\nshow q\n").strip(), f"q = {digits(final['q'])}")

    def test_blocks_of_steps_do_not_matter(self):
        for prelude in ("", "step 5\ndt 0.07\n", "step 5\nmethod stv4\n", "step 5\nreverse\n"):
            once = self.shown(prelude + "step 100\nshow all\n")
            often = self.shown(prelude + "step 10\n" * 10 + "show all\n")
            self.assertEqual(once, often)

    def test_a_change_goes_on_from_the_state_and_time(self):
        before = self.shown("step 100\nshow\n")
        after = self.shown("step 100\ndt 0.05\nshow\n")
        self.assertEqual(before, after)
        # What follows is a run that begins in that state; the energy error still counts from the first start.
        final = self.summary("kepler.toml", "--set", f"problem.initial={{q={before['q']},p={before['p']}}}", "--set",
                             "run.dt=0.05", "--set", "method={name='stv4'}", "--set", "run.steps=50")["final"]
        here = self.shown("step 100\ndt 0.05\nmethod stv4\nstep 50\nshow all\n")
        self.assertEqual((here["q"], here["p"]), (final["q"], final["p"]))
        self.assertEqual((here["step"], here["t"]), (150, 100 * 0.1 + 50 * 0.05))
        start = self.shown("show\n")["energy"]
        self.assertEqual(here["energy_error"], here["energy"] - start)
        self.assertGreaterEqual(here["max_energy_error"], abs(here["energy_error"]))
        self.assertEqual([c["what"] for c in here["changes"]], ["dt = 0.05", "method = stv4"])

    def test_totals_go_on(self):
        first = self.summary("kepler.toml", "--set", "method={name='verlet'}", "--set", "run.steps=251")
        here = self.shown("method verlet\nstep 251\nmethod cg(1,5)\nstep 10\nshow all\n")
        # One round: verlet's energy is back near the start's, and there the element keeps it.
        self.assertEqual(here["max_energy_error"], first["energy"]["max_error"])
        self.assertGreater(here["max_energy_error"], 2 * abs(here["energy_error"]))
        second = self.summary("kepler.toml", "--set", "run.steps=10", "--set",
                              f"problem.initial={{q={first['final']['q']},p={first['final']['p']}}}")
        for key in ("force", "hessian", "linear_solves"):
            self.assertEqual(here[key], first["evaluations"][key] + second["evaluations"][key])

    def test_invariants_with_time_in_them(self):
        self.write("bodies.toml", """[problem]
name = "n-body"
masses = [1, 2]
initial = { q = [1, 0, -1, 0.5], p = [0.1, 0.6, 0.3, -0.2] }
[method]
name = "verlet"
[run]
dt = 0.01
steps = 1000
""")
        s = self.shown("step 300\ndt 0.02\nstep 300\nshow invariants\n", scenario="bodies.toml")
        moving = [key for key in s if key.startswith("max_error_")]
        self.assertGreaterEqual(len(moving), 2)
        for key in moving:
            self.assertLess(s[key], 1e-12, key)

    def test_reverse_comes_back(self):
        start = self.shown("show\n")
        back = self.shown("method stv4\nstep 200\nreverse\nstep 200\nreverse\nshow\n")
        for a, b in zip(start["q"] + start["p"], back["q"] + back["p"]):
            self.assertAlmostEqual(a, b, delta=1e-11)
        self.assertEqual(back["t"], 40)

    def test_save(self):
        self.shell("step 400\nsave mine.run\n")
        self.hamflow("run", "kepler.toml")
        mine, theirs = (json.loads((self.folder / f / "summary.json").read_text()) for f in ("mine.run", "kepler.run"))
        for s in (mine, theirs):
            del s["wall_seconds"], s["steps_per_second"]
        # Blocks of steps are not counted while a run is steered.
        self.assertIsNone(mine.pop("certificate"))
        self.assertIsNotNone(theirs.pop("certificate"))
        self.assertEqual(mine, theirs)
        # Read the files back through another command.
        csv = [self.hamflow("convert", f, "--to", "polar").stdout for f in ("mine.run", "kepler.run")]
        self.assertEqual(csv[0], csv[1])

    def test_save_after_changes(self):
        self.write("time.toml", (self.folder / "kepler.toml").read_text().replace("steps = 400", "t_end = 40"))
        self.shell("step 100\ndt 0.03\nstep 50\nmethod cg(1,3)\nstep 7\nreverse\nstep\nsave a.run\n", scenario="time.toml")
        s = json.loads((self.folder / "a.run" / "summary.json").read_text())
        self.assertEqual((s["steps"], s["dt"], s["method"]), (158, 0.03, "cg(1,3)"))
        self.assertAlmostEqual(s["final"]["t"], 10 + 58 * 0.03, delta=1e-12)
        self.assertEqual([c["step"] for c in s["changes"]], [100, 150, 157])
        rows = self.hamflow("convert", "a.run", "--to", "polar").stdout.splitlines()
        self.assertEqual(len(rows), 1 + 159)
        self.assertEqual(float(rows[-1].split(",")[0]), s["final"]["t"])

    def test_a_change_keeps_all_digits(self):
        """Two halves of 20 and 20 steps, the second with another tolerance, are the run of 40; times and energies, too."""
        for arithmetic in ("quad", "double-double", "mp(50)"):
            sets = ("--set", f"run.arithmetic={arithmetic}", "--set", "method={name='stv4'}")
            _, s = self.final(sets[1], "run.steps=40", sets[3])
            here = self.shown("step 20\ndt 0.2\ndt 0.1\nstep 20\nshow all\n", *sets)
            apart = [abs(Decimal(a) - Decimal(b)) for key in ("q", "p") for a, b in zip(here[key], s["final"][key])]
            apart += [abs(Decimal(here["t"]) - 4), abs(Decimal(here["energy"]) - Decimal(s["energy"]["final"]))]
            self.assertLess(max(apart), Decimal("1e-29"), arithmetic)  # the kick that is kept from step to step is not
            gained = Decimal(s["energy"]["final"]) - Decimal(s["energy"]["initial"])
            self.assertAlmostEqual(here["energy_error"], float(gained), delta=2.0**-52 * abs(float(gained)))
        self.shell("step 20\ndt 0.05\nstep 4\nsave a.run\n", *sets)
        s = json.loads((self.folder / "a.run" / "summary.json").read_text())
        self.assertLess(abs(Decimal(s["final"]["t"]) - Decimal("2.2")), Decimal("1e-45"))
        self.assertEqual(s["energy"]["initial"], self.shown("show energy\n", *sets)["energy"])
        rows = self.hamflow("convert", "a.run", "--to", "polar").stdout.splitlines()
        self.assertLess(abs(Decimal(rows[-1].split(",")[0]) - Decimal("2.2")), Decimal("1e-45"))

    def test_samples_are_kept_by_steps(self):
        """Also of a scenario that has times of its own, which a session need not reach."""
        self.write("times.toml", (self.folder / "kepler.toml").read_text().replace(
            "steps = 400", "t_end = 4\nrecord = [0.5, 2, 4]\n[output]\nfigures = ['orbit']"))
        for steps in (10, 40):
            self.shell(f"step {steps}\nsave! a.run\n", scenario="times.toml")
            self.assertIn("note: run.record is not used", self.stderr)
            self.assertIn("note: output.figures is not used", self.stderr)
            self.hamflow("plot", "a.run", "--kind", "energy", "-o", "f.svg")
            self.assertEqual(len(self.hamflow("convert", "a.run", "--to", "polar").stdout.splitlines()), 2 + steps)

    def test_a_figure_of_a_steered_session_shows_its_samples_alone(self):
        """The first steps with the last settings are none of its motion, and its settings are not those of all of it."""
        self.write("h.toml", "[problem]\nname='henon-heiles'\ninitial={q=[0,0.1],p=[0.4,0.1]}\n[method]\nname='stv4'\n"
                   "[run]\ndt=0.1\nsteps=200\nrecord_every=20\n")
        for commands, is_one_course in (("step 60\ndt -0.01\nstep 60\n", False), ("step 60\ndt 0.03\nstep 60\n", False),
                                        ("dt -0.1\nstep 60\n", True), ("step 60\n", True)):
            self.shell(commands + "save! s.run\n", scenario="h.toml")
            self.hamflow("plot", "s.run", "--kind", "orbit", "-o", "s.svg")
            text = (self.folder / "s.svg").read_text()
            self.assertNotIn("first steps", text, commands)
            self.assertEqual("dt = " in text, is_one_course, commands)

    def test_save_has_the_bounces(self):
        self.write("tube.toml", "[problem]\nname='t-tube'\neps=-0.6\nvelocities=[6, 1]\n[method]\nname='stv4'\n"
                   "[run]\ndt=0.01\nsteps=400\n")
        self.hamflow("run", "tube.toml", "--out", "r")
        look = ("import h5py, json, sys\nwalls = h5py.File(sys.argv[1] + '/run.h5')['events/wall']\n"
                "print(json.dumps({name: walls[name][:].tolist() for name in walls}))")

        def bounces(folder):
            return json.loads(subprocess.run([sys.executable, "-c", look, folder], cwd=self.folder, capture_output=True, text=True,
                                             check=True, timeout=60).stdout)
        wanted = bounces("r")
        self.assertGreater(len(wanted["t"]), 4)
        self.shell("step 150\nstep 250\nsave whole\n", scenario="tube.toml")
        self.assertEqual(bounces("whole"), wanted)
        # Of a session whose settings changed the steps and times go on, through all its parts.
        self.shell("step 400\nreset\nstep 200\ndt 0.005\nstep 400\nsave parts\n", scenario="tube.toml")
        parts = bounces("parts")
        self.assertEqual(len(parts["t"]), len(wanted["t"]))
        self.assertEqual(parts["side"], wanted["side"])
        for t, step, other in zip(parts["t"], parts["step"], wanted["t"], strict=True):
            self.assertAlmostEqual(t, other, delta=0.01)
            length = 0.01 if step <= 200 else 0.005
            end = step * 0.01 if step <= 200 else 2 + (step - 200) * 0.005
            self.assertTrue(end - 1.001 * length <= t <= end + 0.001 * length, (t, step))
        self.shell("step 400\nsave few\n", "--set", "run.record_events=2", scenario="tube.toml")
        self.assertEqual(bounces("few"), {name: rows[:2] for name, rows in wanted.items()})

    def test_save_refuses_an_existing_folder(self):
        self.shell("step 3\nsave a.run\nsave a.run\n", status=3)
        self.assertIn("save! a.run", self.stderr)
        self.shell("step 5\nsave! a.run\n")
        self.assertEqual(json.loads((self.folder / "a.run" / "summary.json").read_text())["steps"], 5)
        self.shell("save /proc/nowhere/x\n", status=3)

    def test_errors_stop_a_pipe_and_name_the_line(self):
        for line, words in (
            ("stepp 3", "did you mean step?"), ("step x", "a whole number"), ("step -1", "a whole number"),
            ("dt 0", "other than 0"), ("dt", "no argument"), ("dt nan", "other than 0"), ("tol -1", "positive"),
            ("tol x", "positive"), ("method stv5", "did you mean stv4?"), ("method cg(1,0)", "from 1 to 64"),
            ("show enrgy", "did you mean energy?"), ("save", "a folder"), ("quit now", "allowed no argument"),
        ):
            out = self.shell(f"# first\n\nstep 2\n{line}\nshow\n", status=2)
            self.assertEqual(out, "")
            self.assertIn(words, self.stderr)
            self.assertIn(f"line 4: {line}", self.stderr)
        self.shell("method stv4\ntol 1e-3\n", status=2)
        self.assertIn("stv4 has no tolerance", self.stderr)
        self.shell("method rk4\n", "--set", "method={name='stv4'}", "--set", "run.arithmetic=lattice", status=2)
        self.assertIn("bijection", self.stderr)
        self.shell("step 2\ndt 30\nstep 5\nshow\n", status=1)
        self.assertIn("line 3: step 5", self.stderr)
        self.assertIn("hint:", self.stderr)
        self.hamflow("shell", "nowhere.toml", status=3)
        self.shell("", "--set", "run.dt=0", status=2)
        self.assertIn("run.dt", self.stderr)

    def test_the_end(self):
        self.assertEqual(self.shell(""), "")
        self.assertEqual(self.shell("step 3"), "")
        self.assertEqual(self.shell("quit\nnonsense\n"), "")
        self.assertIn("method m", self.shell("help\n"))
        self.assertIn("Examples:", self.hamflow("shell", "--help").stdout)

    def test_too_many_samples_are_thinned_out(self):
        rows = 300000  # more than fit
        self.shell(f"method verlet\nstep {rows}\nsave a.run\n")
        self.assertIn("th step is kept", self.stderr)
        times = [float(line.split(",")[0]) for line in
                 self.hamflow("convert", "a.run", "--to", "polar").stdout.splitlines()[1:]]
        self.assertLess(len(times), rows)
        self.assertGreater(len(times), 10000)
        self.assertEqual((times[0], times[-1]), (0, rows * 0.1))

    def test_interrupt_from_a_pipe(self):
        process = subprocess.Popen([HAMFLOW, "shell", "kepler.toml"], cwd=self.folder, stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        process.stdin.write("step 2000000000\nshow\n")
        process.stdin.flush()
        until_it_works(process)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=20)
        self.assertEqual((process.returncode, out), (130, ""), err)
        self.assertIn("stopped by Ctrl-C at step", err)

    def test_at_a_terminal(self):
        """A prompt; errors and Ctrl-C leave the shell where it is."""
        try:
            master, slave = pty.openpty()
        except OSError:  # a chroot without /dev/pts
            self.skipTest("there are no pseudo-terminals here")
        process = subprocess.Popen([HAMFLOW, "shell", "kepler.toml", "--set", "run.record_every=1000000"],
                                   cwd=self.folder, stdin=slave, stdout=slave, stderr=slave, start_new_session=True)
        os.close(slave)
        self.addCleanup(os.close, master)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)

        heard = ""

        def until(words):
            """Waits for these words; what comes behind them is left for the next call."""
            nonlocal heard
            end = time.time() + 20
            while words not in heard and time.time() < end:
                if select.select([master], [], [], 0.2)[0]:
                    heard += os.read(master, 65536).decode()
            self.assertIn(words, heard)
            heard = heard.partition(words)[2]

        def say(line):
            os.write(master, (line + "\n").encode())

        until("help lists the commands")
        until("hamflow> ")
        say("nonsense")
        until("allowed step")
        until("hamflow> ")
        say("step 2000000000")
        until_it_works(process)
        process.send_signal(signal.SIGINT)
        until("stopped by Ctrl-C at step")
        until("hamflow> ")
        time.sleep(0.5)  # it has to wait for input by then
        process.send_signal(signal.SIGINT)  # at the prompt: another prompt
        until("hamflow> ")
        say("reset")
        until("hamflow> ")
        say("step 4")
        until("hamflow> ")
        say("show t")
        until("t = 0.4")
        say("quit")
        self.assertEqual(process.wait(timeout=20), 0)


if __name__ == "__main__":
    unittest.main()
