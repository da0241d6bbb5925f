"""run.h5 of a gas: an H5MD 1.1 file that needs nothing beside it, while it grows and after a kill; figures of particles."""

import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time
import unittest

from command import EXAMPLES, HAMFLOW, CommandCase

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
from kill_and_resume import differences  # noqa: E402

CHECK = pathlib.Path(__file__).with_name("h5md_check.py")
COMPARE = os.environ["COMPARE_RUNS"]
GAS = """
[problem]
name = "gas"
particles_per_side = 3
%s
[method]
name = "stv4"
[run]
dt = 0.001
steps = 20
"""
PERIODIC = ('dimension = 3\ncutoff = 1.4\nmasses = [' + ", ".join(str(1 + i % 3) for i in range(27)) +
            ']\ncontainer = { kind = "periodic", size = [3, 3, 3.5] }')


class H5md(CommandCase):
    def run_gas(self, keys="", *arguments):
        self.write("gas.toml", GAS % keys)
        return json.loads(self.hamflow("run", "gas.toml", "--force", "--json", *arguments).stdout)

    def faults(self, *files):
        """A list for each file: one interpreter looks at all."""
        done = subprocess.run([sys.executable, "-B", CHECK, *files], cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.stderr, "")
        return [json.loads(line) for line in done.stdout.splitlines()]

    def python(self, text):
        done = subprocess.run([sys.executable, "-c", "import h5py, json\n" + text], cwd=self.folder, capture_output=True, text=True,
                              timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout) if done.stdout else None

    def looked_up(self, expression, file="gas.run/run.h5"):
        return self.python(f"f = h5py.File({file!r}, 'r', libver='latest', swmr=True)\nprint(json.dumps({expression}))")

    def test_specification(self):
        wanted = []
        for k, (keys, more) in enumerate((
                ("", ()), ('container = { kind = "box", size = [2.1, 2.2] }\nmasses = 2', ()), (PERIODIC, ()),
                ('container = { kind = "none" }', ("--set", "run.arithmetic=double-double")),
                ("", ("--set", "run.record=[0.0005, 0.02]", "--set", "output.observables={ d = 'x1 - x2' }")),
                ("", ("--set", "run.steps=0")), ("", ("--set", "run.dt=-0.001")))):
            final = self.run_gas(keys, *more, "--out", str(k))["final"]
            wanted += [[float(x) for x in final[letter]] for letter in "qp"]
        files = [f"{k}/run.h5" for k in range(7)]
        self.assertEqual(self.faults(*files), [[]] * 7)
        self.assertEqual(self.python(
            f"last = [h5py.File(file)['particles/all/' + x + '/value'][-1].ravel().tolist() for file in {files} "
            "for x in ('position', 'momentum')]\nprint(json.dumps(last))"), wanted)
        periodic = ("[f['particles/all/box/edges/value'][-1].tolist(), f['particles/all/mass/value'][0].tolist(),"
                    "[x.decode() for x in f['particles/all/box'].attrs['boundary']]]")
        self.assertEqual(self.looked_up(periodic, "2/run.h5"), [[3, 3, 3.5], [1 + i % 3 for i in range(27)], ["periodic"] * 3])

    def test_times_that_fall(self):
        """H5MD wants times that grow, and lets them be left out."""
        self.run_gas("", "--set", "run.dt=-0.001", "--out", "back")
        self.write("turn", "step 3\ndt -0.002\nstep 2\nsave turned\n")
        with open(self.folder / "turn") as commands:
            subprocess.run([HAMFLOW, "shell", "gas.toml"], cwd=self.folder, stdin=commands, check=True, timeout=60)
        for folder in ("back", "turned"):
            self.assertEqual(self.faults(f"{folder}/run.h5"), [[]])
            self.assertEqual(self.looked_up("[list(f['particles/all/position']), list(f['observables/energy'])]", f"{folder}/run.h5"),
                             [["step", "value"]] * 2)

    def test_the_check_finds_faults(self):
        """Each mutant breaks one rule; without this the test above would prove nothing."""
        self.run_gas(PERIODIC)
        mutants = (
            ("del f['particles/all/position/time']", "/particles/all/position has no time"),
            ("del f['observables/energy/time']", "/observables/energy has no time"),
            ("del f['particles/all/box'].attrs['dimension']", "no dimension"),
            ("del f['particles/all/box/edges']", "no edges"),
            ("f['particles/all/box'].attrs['boundary'] = np.array([b'open'] * 3)", "boundary"),
            ("f['h5md'].attrs['version'] = [1, 2]", "version"),
            ("del f['h5md/author'].attrs['name']", "name"),
            ("del f['particles/all/mass']", "mass"),
            ("f['step'][3] = 0", "does not grow"),
            ("x = f['t'][:]; del f['observables/energy/time']; f['observables/energy/time'] = x[:-1]", "lengths"),
            ("x = f['step'][:]; del f['observables/energy/step']; f['observables/energy/step'] = 1.0 * x", "integer"),
            ("x = f['particles/all/velocity/value'][:]; x[2, 1, 0] += 1; f['particles/all/velocity/value'][...] = x", "over"),
            ("x = f['particles/all/position/value'][:]; del f['particles/all/position/value'];"
             "f['particles/all/position/value'] = x.reshape(len(x), -1)", "shape"),
            ("f['q'] = f['particles/all/position/value'][:]", "as well"))
        self.python("import numpy as np, shutil\nfor k, mutate in enumerate(%r):\n shutil.copy('gas.run/run.h5', f'{k}.h5')\n"
                    " with h5py.File(f'{k}.h5', 'r+') as f: exec(mutate)" % [mutant for mutant, _ in mutants])
        for faults, (mutant, said) in zip(self.faults(*(f"{k}.h5" for k in range(len(mutants)))), mutants, strict=True):
            self.assertIn(said, "\n".join(faults), mutant)

    def test_it_grows(self):
        self.write("gas.toml", GAS % 'container = { kind = "none" }\nmasses = 4')
        process = subprocess.Popen([HAMFLOW, "run", "gas.toml", "--quiet", "--set", "run.steps=100000000", "--set",
                                    "run.record_every=200"], cwd=self.folder, stdout=subprocess.DEVNULL)
        seen = set()
        try:
            end = time.monotonic() + 60
            while len(seen) < 3 and time.monotonic() < end:
                time.sleep(0.3)
                if (self.folder / "gas.run/run.h5").exists():
                    seen.add(self.looked_up("f['particles/all/velocity/value'].shape[0]"))
        finally:
            process.send_signal(signal.SIGKILL)
            process.wait(timeout=30)
        self.assertGreaterEqual(len(seen), 3, "rows appear while it runs")
        self.hamflow("plot", "gas.run", "-o", "killed.svg")
        self.hamflow("plot", "gas.run", "--kind", "energy-error", "-o", "killed.svg")

    def test_resumed(self):
        keys = ("--set", "run.steps=200", "--set", "run.record_every=3")
        self.run_gas(PERIODIC, *keys, "--out", "whole")
        self.run_gas(PERIODIC, "--set", "run.record_every=3", "--out", "parts")
        self.hamflow("run", "gas.toml", *keys, "--out", "parts", "--resume", "--quiet")
        self.assertEqual(differences(COMPARE, self.folder / "whole", self.folder / "parts"), [])
        self.assertEqual(self.faults("parts/run.h5"), [[]])

    def test_the_start_is_in_it(self):
        """A run from a file is drawn and taken up again where there is no such file any more."""
        (self.folder / "start.csv").write_text("x,y,p_x,p_y,mass\n-0.5,0,0.1,0,2\n0.5,0.1,0,0,3\n0,0.7,0,0.2,2\n")
        text = (GAS % 'start = "file"\nfile = "start.csv"').replace("particles_per_side = 3\n", "")
        self.write("file.toml", text)
        for record in ((), ("--set", "run.record=[0.0105, 0.02]")):
            self.hamflow("run", "file.toml", "--quiet", "--force", "--out", "f", *record)
            (self.folder / "start.csv").rename(self.folder / "away.csv")
            for kind in ("particles", "tracks", "energy-error"):
                self.hamflow("plot", "f", "--kind", kind, "-o", "f.svg")
            (self.folder / "away.csv").rename(self.folder / "start.csv")
        self.assertEqual(self.looked_up("f['particles/start/position/value'][0].tolist()", "f/run.h5"),
                         [[-0.5, 0], [0.5, 0.1], [0, 0.7]])
        self.assertEqual(self.faults("f/run.h5"), [[]])
        on = text.replace("start.csv", "f/run.h5")
        self.write("on.toml", on)
        s = self.summary("on.toml", "--set", "run.steps=0")
        self.assertEqual(s["parameters"]["masses"], [2, 3, 2])
        self.assertEqual(s["final"]["q"], self.looked_up("f['particles/all/position/value'][-1].ravel().tolist()", "f/run.h5"))
        self.write("on.toml", on.replace('"file"', '"file"\nmasses = 1'))
        self.assertIn("masses", self.hamflow("run", "on.toml", "--out", "none", status=2).stderr)

    def test_of_n_bodies(self):
        """Their last sample too, with their masses."""
        self.hamflow("run", EXAMPLES / "figure_eight.toml", "--set", "run.steps=5", "--set", "output.figures=[]", "--set",
                     "problem.masses=[1, 2, 3]", "--out", "eight", "--quiet")
        self.write("on.toml", (GAS % 'start = "file"\nfile = "eight/run.h5"\npair = "newton"\ncontainer = { kind = "none" }')
                   .replace("particles_per_side = 3\n", ""))
        self.assertEqual(self.summary("on.toml", "--set", "run.steps=0")["parameters"]["masses"], [1, 2, 3])

    def test_many(self):
        """Above 10^4 coordinates: no names, no numbers in the summary, figures all the same."""
        self.write("many.toml", (GAS % 'container = { kind = "none" }\ncutoff = 1.2\ndimension = 3').replace("side = 3", "side = 15"))
        s = json.loads(self.hamflow("run", "many.toml", "--json", "--set", "run.steps=2", "--set",
                                    "output.figures=['particles']").stdout)
        self.assertEqual(s["final"]["dataset"], "/particles/all")
        self.assertEqual(self.looked_up("f[%r]['position/value'].shape" % s["final"]["dataset"], "many.run/run.h5"), [3, 3375, 3])
        self.assertEqual(self.looked_up("'coordinates' in f.attrs", "many.run/run.h5"), False)
        self.assertTrue((self.folder / "many.run/figures/particles.pdf").exists())
        for kind in ("tracks", "radial", "energy-error"):
            self.hamflow("plot", "many.run", "--kind", kind, "-o", "f.svg")
        self.hamflow("plot", "many.run", "--kind", "time", "--y", "energy", "-o", "f.svg")
        self.assertIn("allowed particles, energy-error, energy", self.hamflow("plot", "many.run", "--kind", "orbit", "-o", "f.svg", status=2).stderr)

    def test_figures(self):
        def texts(*arguments):
            self.hamflow("plot", *arguments, "-o", "f.svg")
            found = re.findall(r"<text[^>]*>(.*?)</text>", (self.folder / "f.svg").read_text(), re.S)
            return [re.sub(r"<[^>]*>", "", text).strip() for text in found]

        self.run_gas("", "--set", "run.steps=40")
        self.assertIn("x,  t = 0.04", texts("gas.run"))  # the usual figure of a gas
        at = texts("gas.run", "--kind", "particles", "--at", "0.01,0.02,0.03")
        self.assertEqual([f"x,  t = 0.0{k}" in at for k in (0, 1, 2, 3)], [False, True, True, True])
        self.assertIn("g(r)", texts("gas.run", "--kind", "radial", "--at", "0.01,0.04"))
        self.assertIn("x", texts("gas.run", "--kind", "tracks"))
        for arguments, said in ((("--kind", "tracks", "--at", "0.01"), "allowed for particles, radial"),
                                (("--kind", "particles", "--at", "0.05"), "allowed times of the 41 samples from 0 to 0.04"),
                                (("--kind", "particles", "--at", "soon"), "--at"),
                                (("--kind", "particles", "--y", "z"), "allowed x, y")):
            self.assertIn(said, self.hamflow("plot", "gas.run", *arguments, "-o", "g.svg", status=2).stderr)
        self.hamflow("run", "kepler.toml", "--quiet")
        self.assertIn("neither a gas", self.hamflow("plot", "kepler.run", "--kind", "radial", "-o", "g.svg", status=2).stderr)
        wrong = self.hamflow("run", "kepler.toml", "--set", "output.figures=['tracks']", "--out", "none", status=2).stderr
        self.assertIn("neither a gas", wrong)
        self.hamflow("reverse", "gas.toml", "--out", "kept", "--quiet")
        shown = texts("kept", "--kind", "particles")
        self.assertTrue({"x,  t = 0", "x,  t = 0.02", "x,  t = 0.04"} <= set(shown), shown)


if __name__ == "__main__":
    unittest.main()
