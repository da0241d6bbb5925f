"""docs/reference/files.md: its Python, run on runs as it says, and its tables, compared with files."""

import json
import math
import os
import pathlib
import re
import subprocess
import sys
import unittest
from decimal import Decimal, localcontext

from command import EXAMPLES, CommandCase

DOCUMENT = (EXAMPLES.parent / "docs/reference/files.md").read_text()
COMPARE = os.environ["COMPARE_RUNS"]
# Takes the place of matplotlib, installed or not: it keeps the points that the document's lines
# draw as a text, in which the test looks for the orbit.
PLOT_AS_TEXT = '''
import types

_points = []


def plot(x, y):
    _points.extend(zip(x, y))


def gca():
    return types.SimpleNamespace(set=lambda **facts: _facts.update(facts))


_facts = {}


def savefig(name):
    with open(name, "w") as out:
        out.write(repr(_facts) + "\\n" + "\\n".join(f"{x!r} {y!r}" for x, y in _points))
'''


class FilesDocument(CommandCase):
    def python(self, text):
        package = self.folder / "modules" / "matplotlib"
        package.mkdir(parents=True, exist_ok=True)
        (package / "__init__.py").write_text("")
        (package / "pyplot.py").write_text(PLOT_AS_TEXT)
        done = subprocess.run([sys.executable, "-c", text], cwd=self.folder, capture_output=True, text=True, timeout=120,
                              env={**os.environ, "PYTHONPATH": str(self.folder / "modules")})
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def looked_up(self, expression, file):
        text = (f"import h5py, json, numpy as np\nf = h5py.File({file!r}, 'r', libver='latest', swmr=True)\n"
                f"decode = lambda xs: [x.decode() for x in xs]\nprint(json.dumps({expression}))")
        return json.loads(self.python(text))

    def test_snippets(self):
        self.hamflow("run", EXAMPLES / "kepler_ellipse.toml", "--set", "output.figures=[]", "--quiet")
        self.hamflow("run", "kepler.toml", "--set", "run.arithmetic=quad", "--set",
                     "method.quadrature='auto'", "--set", "run.steps=100", "--out", "quad.run", "--quiet")
        blocks = re.findall(r"```python\n(.*?)```", DOCUMENT, re.S)
        self.assertEqual(len(blocks), 4)
        self.assertLessEqual(len([line for line in blocks[0].splitlines() if line]), 10)
        out = self.python("\n".join(blocks))
        # The orbit runs between r = 1 and r = 3, up to the method's own error, of order dt^2.
        facts, *points = (self.folder / "orbit.svg").read_text().splitlines()
        self.assertIn("'xlabel': 'x'", facts)
        radii = [math.hypot(*(float(re.sub(r"[^0-9.e+-]", "", x.replace("float64", ""))) for x in line.split()))
                 for line in points]
        self.assertGreater(len(radii), 4000)
        self.assertAlmostEqual(min(radii), 1, delta=0.03)
        self.assertAlmostEqual(max(radii), 3, delta=0.03)
        # What was stored is run again to the same end.
        self.hamflow("run", "again.toml", "--quiet")
        same = subprocess.run([COMPARE, "kepler_ellipse.run/run.h5", "again.run/run.h5"], cwd=self.folder,
                              capture_output=True, text=True).stdout
        self.assertRegex(same, r"\d+ datasets, [1-9]\d+ rows")  # it did compare
        self.assertNotRegex(same, "(?m)^/?[tqp] differs")
        self.assertIn("t = ", out)
        error = Decimal(re.search(r"energy error: (\S+)", out).group(1))
        self.assertLess(error, Decimal("1e-31"))
        self.assertGreater(error, 0)

    def test_attributes(self):
        self.hamflow("run", "kepler.toml", "--set", "run.dt='1/10'", "--quiet")
        file = "kepler.run/run.h5"
        text = "{k: v.decode() for k, v in f.attrs.items() if hasattr(v, 'decode')}"
        found = self.looked_up(text, file)
        self.assertEqual({k: found[k] for k in ("problem", "method", "arithmetic", "dt_text")},
                         {"problem": "central-force", "method": "cg(1,5)", "arithmetic": "double",
                          "dt_text": "1/10"})
        self.assertEqual(self.looked_up("[float(f.attrs['dt']), f.attrs['masses'].tolist()]", file), [0.1, [2.0]])
        names = "[decode(f.attrs['coordinates']), decode(f.attrs['momenta']), decode(f['p'].attrs['columns'])]"
        self.assertEqual(self.looked_up(names, file), [["x", "y"], ["p_x", "p_y"], ["p_x", "p_y"]])
        eight = EXAMPLES / "figure_eight.toml"
        self.hamflow("run", eight, "--set", "output.figures=[]", "--set", "run.steps=10", "--out", "eight", "--quiet")
        self.assertEqual(self.looked_up(names, "eight/run.h5")[1], [f"p_{x}{i}" for i in (1, 2, 3) for x in "xy"])
        self.assertEqual(self.looked_up("f.attrs['masses'].tolist()", "eight/run.h5"), [1, 1, 1])
        self.assertFalse(self.looked_up("'unit' in f['q'].attrs", "eight/run.h5"))  # those of the input
        self.hamflow("run", EXAMPLES / "solar_system.toml", "--set", "output.figures=[]", "--set", "run.steps=2", "--out", "sun",
                     "--quiet")
        units = "[f[name].attrs['unit'].decode() for name in ('t', 'q', 'p', 'energy', 'invariants/angular_momentum')]"
        self.assertEqual(self.looked_up(units, "sun/run.h5"),
                         ["day", "AU", "solar mass AU/day", "solar mass AU^2/day^2", "solar mass AU^2/day"])
        self.assertAlmostEqual(self.looked_up("f.attrs['masses'].tolist()", "sun/run.h5")[0], 1.00000597682)
        # Every dataset of samples says what its columns are.
        untold = ("[name for name in ('t', 'step', 'q', 'p', 'energy', 'invariants/angular_momentum', 'solver/force',"
                  "'solver/gradient', 'solver/hessian', 'solver/linear_solves', 'events/halved')"
                  "if len(f[name].attrs['columns']) != (f[name].shape + (1,))[1] or not f[name].attrs['meaning']]")
        self.assertEqual(self.looked_up(untold, file), [])
        self.assertGreater(self.looked_up("int(f['solver/gradient'][-1] + f['solver/hessian'][-1])", file), 0)

    def test_digits(self):
        with localcontext() as context:
            context.prec = 80
            for arithmetic, length, places in (("double-double", 105, 30), ("quad", 44, 33), ("mp(50)", 75, 49)):
                self.hamflow("run", "kepler.toml", "--set", f"run.arithmetic={arithmetic}", "--set", "method.name=stv4",
                             "--set", "run.steps=30", "--set", "output.formats=['h5','csv']", "--out", "digits", "--force",
                             "--quiet")
                file = "digits/run.h5"
                self.assertEqual(self.looked_up("[f['digits/' + x].dtype.itemsize for x in ('t', 'q', 'p', 'energy')]",
                                                file), [length] * 4)
                q = self.looked_up("[decode(row) for row in f['digits/q'][:]]", file)
                doubles = self.looked_up("f['q'][:].tolist()", file)
                final = json.loads((self.folder / "digits" / "summary.json").read_text())["final"]["q"]
                self.assertEqual(q[-1], final)
                self.assertEqual([[float(x) for x in row] for row in q], doubles)
                # They read back: a run of no steps from there ends there.
                for row in (3, 17, 30):
                    p = self.looked_up(f"decode(f['digits/p'][{row}])", file)
                    there = self.summary("kepler.toml", "--set", f"run.arithmetic={arithmetic}", "--set", "run.steps=0",
                                         "--set", f"problem.initial={{q={q[row]}, p={p}}}")["final"]
                    self.assertEqual((there["q"], there["p"]), (q[row], p))
                lines = (self.folder / "digits" / "trajectory.csv").read_text().splitlines()
                self.assertEqual([line.split(",")[2:4] for line in lines[1:]], q)
                # A fixed step of 1/10 in all digits: the tenth time is 1 to the digits of the arithmetic.
                t = self.looked_up("decode(f['digits/t'][:])", file)
                self.assertLess(abs(Decimal(t[10]) - 1), Decimal(10) ** -places)


if __name__ == "__main__":
    unittest.main()
