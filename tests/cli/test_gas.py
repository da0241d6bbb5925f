"""The gas: starts, containers, cut-offs, and what a wrong key is told."""

import csv
import json
import math
import time
import unittest

import h5py

from command import EXAMPLES
from gas_case import GAS, GasCase

START_OF = """
[problem]
name = "gas"
%(start)s
dimension = %(dimension)d
container = { kind = "none" }
[method]
name = "verlet"
[run]
dt = 1e-4
steps = 3
"""
TWO = """
[problem]
name = "gas"
%s
scale = 1
container = { kind = "none" }
initial = { q = [-0.6, 0, 0.6, 0], p = [10, 0, -10, 0] }
[method]
name = "verlet"
[run]
dt = 1e-3
steps = 1
"""
HENON_HEILES = """
[problem]
name = "henon-heiles"
initial = { q = [0.1, 0.2], p = [0.1, 0] }
[method]
name = "verlet"
[run]
dt = 0.1
steps = 3
"""


class Gas(GasCase):
    def test_defaults(self):
        s = self.gas()
        self.assertEqual(s["parameters"]["scale"], 1.5)  # (4 - 1)/2: neighbours at 2/3 are one length apart
        self.assertEqual((s["parameters"]["radius"], s["parameters"]["exponent"]), (1.5, 1))
        self.assertEqual(list(s["invariants"]), ["angular_momentum"])
        self.assertEqual(s["evaluations"]["force"], 61)
        self.assertEqual(len(s["final"]["q"]), 32)

    def test_starts(self):
        zero = ("--set", "run.steps=0")
        lattice = self.gas("", *zero)["final"]
        self.assertEqual(lattice["q"][:4], [-1, -1, -1 / 3, -1])
        for p in lattice["p"]:
            self.assertEqual(round(p * 1e5) % 2, 0)
            self.assertAlmostEqual(p * 5e4, round(p * 5e4), delta=1e-10)
            self.assertTrue(-1 <= p < 1)
        self.assertEqual(lattice, self.gas("seed = 1", *zero)["final"])
        self.assertNotEqual(lattice["p"], self.gas("seed = 2", *zero)["final"]["p"])
        corner = self.gas('start = "corner"', *zero)
        self.assertEqual(corner["final"]["q"][:4], [0, 0, 1 / 3, 0])
        self.assertEqual(set(corner["final"]["p"]), {0})
        self.assertEqual(corner["parameters"]["scale"], 3)  # n - 1
        self.assertEqual(self.gas('scale = "listing"', *zero)["parameters"]["scale"], 7.5)  # (16 - 1)/2
        space = self.gas('dimension = 3\ncontainer = { kind = "circle", radius = 2 }', *zero)
        self.assertEqual(len(space["final"]["q"]), 3 * 64)
        self.assertEqual(len(space["invariants"]["angular_momentum"]["initial"]), 3)

    def test_a_file(self):
        rows = [("mass", "y", "x", "p_x", "p_y"), (1, 0, 0, 0.1, 0), (2, 0.1, 1, 0, "1/4"), (3, 1, 0.2, 0, 0)]
        with (self.folder / "start.csv").open("w") as out:
            csv.writer(out).writerows(rows)
        text = (GAS % 'start = "file"\nfile = "start.csv"').replace("particles_per_side = 4\n", "")
        self.write("file.toml", text)
        s = self.summary("file.toml", "--set", "run.steps=0")
        self.assertEqual(s["final"]["q"], [0, 0, 1, 0.1, 0.2, 1])
        self.assertEqual(s["final"]["p"], [0.1, 0, 0, 0.25, 0, 0])
        self.assertEqual(s["parameters"]["masses"], [1, 2, 3])
        self.assertEqual(s["parameters"]["scale"], 1)
        # per-side is of n^2 particles: a file of three has no such number.
        self.assertIn("problem.particles_per_side: found 4 but start.csv has 3 particles",
                      self.hamflow("run", "file.toml", "--out", "none", "--set", "problem.particles_per_side=4",
                                   status=2).stderr)
        for wrong, said in (("x,y,p_x\n0,0,0\n", "no column p_y"), ("x,y,p_x,p_y\n0,0,0\n", "3 numbers in line 2"),
                            ("x,y,p_x,p_y\n0,a,0,0\n", "line 2"), ("", "empty file"),
                            ("x,y,p_x,p_y,masss\n0,0,0,0,1\n", "masss"), ("x,y,p_x,p_y\n", "no particle")):
            self.write("start.csv", wrong)
            self.assertIn(said, self.hamflow("run", "file.toml", "--out", "none", status=2).stderr)
        for wrong in (b"", b"\x89HDF\r\n\x1a\n and then nothing"):
            (self.folder / "bad.h5").write_bytes(wrong)
            self.assertIn("found bad.h5, which is damaged or not an HDF5 file",
                          self.hamflow("run", "file.toml", "--out", "none", "--set", "problem.file=bad.h5", status=2).stderr)
        self.assertIn('allowed with particles_per_side, else "listing" or a number',
                      self.hamflow("run", "file.toml", "--out", "none", "--set", "problem.scale=per-side", status=2).stderr)
        (self.folder / "start.csv").unlink()
        self.assertIn("cannot read the file start.csv", self.hamflow("run", "file.toml", "--out", "none", status=2).stderr)

    def test_a_run_goes_on_with_the_file_that_it_began_with(self):
        """Other numbers under the same name are another system."""
        def written(mass):
            self.write("three.csv", f"x,y,p_x,p_y,mass\n0,0,0.1,0,2\n1,0,0,0.1,3\n0,1,0,0,{mass}\n")
        self.write("file.toml", GAS.replace("particles_per_side = 4", "") %
                   'start = "file"\nfile = "three.csv"\ncontainer = { kind = "none" }')
        written(1)
        sweep = ["sweep", "file.toml", "--vary", "run.dt=0.001,0.002", "--quiet", "--out", "s"]
        self.hamflow("run", "file.toml", "--quiet", "--out", "r")
        self.hamflow("reverse", "file.toml", "--quiet", "--out", "v")
        self.hamflow(*sweep)
        more = ["--resume", "--quiet", "--set", "run.steps=40"]
        written(50)
        for command in (["run", "file.toml", "--out", "r"], ["reverse", "file.toml", "--out", "v"], sweep):
            told = self.hamflow(*command, *more, status=2).stderr
            self.assertIn("problem.file: contents: found contents with hash", told)
        written(1)
        self.hamflow("run", "file.toml", "--out", "r", *more)
        self.hamflow(*sweep, *more)
        # Nor may one of several files change.
        for name in ("a", "b"):
            (self.folder / f"{name}.csv").write_text((self.folder / "three.csv").read_text())
        files = ["sweep", "file.toml", "--vary", 'problem.file="a.csv","b.csv"', "--quiet", "--out", "f"]
        self.hamflow(*files)
        self.hamflow(*files, *more)
        written(50)
        (self.folder / "three.csv").rename(self.folder / "b.csv")
        self.assertIn("problem.file: contents: found contents with hash", self.hamflow(*files, *more, status=2).stderr)

    def test_files_of_other_programs(self):
        text = (GAS % 'start = "file"\nfile = "start.csv"').replace("particles_per_side = 4\n", "")
        self.write("file.toml", text.replace("steps = 20", "steps = 0"))
        (self.folder / "start.csv").write_bytes(b"\xef\xbb\xbfx,y,p_x,p_y\r\n0,0,1,0\r\n1,0,0,0\r\n")  # as spreadsheets do
        self.assertEqual(self.summary("file.toml")["final"]["q"], [0, 0, 1, 0])
        self.write("start.csv", "x,y,p_x,p_y,x\n0,0,1,0,3\n")
        self.assertIn("found the column 'x' twice", self.hamflow("run", "file.toml", "--out", "none", status=2).stderr)
        told = self.hamflow("run", "file.toml", "--out", "none", "--set", "problem.file=.", status=2).stderr
        self.assertIn("found the folder", told)

    def test_a_typed_pair_without_parameters(self):
        typed = self.gas('pair = "formula"\nphi = "r^-12 - 2*r^-6"')
        named = self.gas()
        for x, y in zip(typed["final"]["q"], named["final"]["q"]):
            self.assertAlmostEqual(x, y, delta=1e-12)
        self.assertEqual(typed["parameters"]["phi"], "r^-12 - 2*r^-6")
        for keys in ("", "\nparameters = { b = 2 }"):  # what is kept of them is no parameter itself
            s = self.gas('pair = "formula"\nphi = "r^-12 - %s*r^-6"%s' % ("b" if keys else "2", keys))
            self.assertNotIn("parameters", s["parameters"])

    def test_one_note_for_the_walls_of_all_particles(self):
        box = 'container = { kind = "box", size = [4.1, 4.3] }'
        self.write("gas.toml", GAS % box)
        notes = self.hamflow("run", "gas.toml", "--out", "none", "--set", "run.arithmetic=lattice").stderr
        self.assertEqual(notes.count("half a grid spacing"), 1, notes)

    def test_the_last_sample_of_a_run(self):
        self.write("gas.toml", GAS % "")
        self.hamflow("run", "gas.toml")
        end = json.loads((self.folder / "gas.run/summary.json").read_text())["final"]
        self.write("on.toml", (GAS % 'start = "file"\nfile = "gas.run/run.h5"').replace("steps = 20", "steps = 0"))
        s = self.summary("on.toml")
        self.assertEqual((s["final"]["q"], s["final"]["p"]), (end["q"], end["p"]))
        # Beyond double with all digits.
        quad = ("--set", "run.arithmetic=quad")
        self.hamflow("run", "gas.toml", *quad, "--force")
        end = json.loads((self.folder / "gas.run/summary.json").read_text())["final"]
        s = self.summary("on.toml", *quad)
        self.assertGreater(len(end["q"][0]), 30)
        self.assertEqual((s["final"]["q"], s["final"]["p"]), (end["q"], end["p"]))
        # of a run that was killed digits may be a row behind: the last whole frame counts
        with h5py.File(self.folder / "gas.run/run.h5", "r+") as file:
            for name in ("q", "p"):
                rows = file["digits/" + name]
                before = [text.decode().strip(" \0") for text in rows[-2]]
                rows.resize(len(rows) - 1, axis=0)
                self.assertEqual(len(before), len(end[name]))
        self.assertEqual(self.summary("on.toml", *quad)["final"]["p"], before)
        self.hamflow("run", "gas.toml", "--force")
        self.write("on.toml", GAS % 'start = "file"\nfile = "gas.run/run.h5"\ndimension = 3')
        self.assertIn("found particles in 2 dimensions", self.hamflow("run", "on.toml", "--out", "none", status=2).stderr)
        (self.folder / "gas.run/run.h5").write_bytes(b"no file")
        self.assertIn("run.h5", self.hamflow("run", "on.toml", "--out", "none", status=2).stderr)

    def test_a_run_of_another_dimension(self):
        """As many numbers would be other particles, or none."""
        for dimension in (2, 3):
            self.write(f"{dimension}.toml", START_OF % {"dimension": dimension, "start": "particles_per_side = 6"})
            self.hamflow("run", f"{dimension}.toml", "--out", f"in{dimension}", "--quiet")
        for dimension in (2, 3):
            other = 5 - dimension
            start = f'start = "file"\nfile = "in{other}/run.h5"'
            self.write("other.toml", START_OF % {"dimension": dimension, "start": start})
            told = self.hamflow("run", "other.toml", "--out", "none", status=2).stderr
            self.assertIn(f"found particles in {other} dimensions", told)
            self.assertIn(f"allowed problem.dimension = {dimension}, or the dimension of the file", told)
        self.write("plane.toml", HENON_HEILES)
        self.hamflow("run", "plane.toml", "--out", "plane", "--quiet")
        self.write("other.toml", START_OF % {"dimension": 2, "start": 'start = "file"\nfile = "plane/run.h5"'})
        self.assertIn("a run without bodies", self.hamflow("run", "other.toml", "--out", "none", status=2).stderr)

    def test_particles_that_may_pass_through_each_other(self):
        """Whatever the law; not of a method whose steps follow the motion."""
        for pair in ('pair = "lennard-jones"', 'pair = "formula"\nphi = "r^-9 - r^-6"', 'pair = "newton"'):
            self.write("two.toml", TWO % pair)
            self.assertIn("may pass through each other", str(self.summary("two.toml", "--set", "run.dt=0.12")["warnings"]), pair)
            slow = self.summary("two.toml", "--set", "run.dt=1e-3")["warnings"]
            self.assertNotIn("pass through", str(slow), pair)
        for smooth in ('pair = "newton"\nsoftening = 30', 'pair = "formula"\nphi = "exp(-r^2)"'):  # through these they may
            self.write("two.toml", TWO % smooth)
            self.assertNotIn("pass through", str(self.summary("two.toml", "--set", "run.dt=0.12")["warnings"]), smooth)
        self.write("two.toml", TWO % 'pair = "lennard-jones"')
        for method in ("dop853", "taylor"):
            self.assertNotIn("pass through", str(self.summary("two.toml", "--set", "run.dt=0.12", "--set", f"method.name={method}")))

    def test_where_the_last_state_is(self):
        text = (GAS % 'container = { kind = "none" }\ncutoff = 1.2\ndimension = 3').replace("side = 4", "side = 15")
        self.write("many.toml", text)
        for out, settings, place in (("h5", [], "/particles/all"), ("end", ["run.record=[1e-5,2e-5]", "run.dt=1e-5"], "/particles/all"), ("times", ["run.record=[1e-5]"], None),
                                     ("csv", ['output.formats=["csv"]'], None), ("none", [], None)):
            s = json.loads(self.hamflow("run", "many.toml", "--set", "run.steps=2", *(w for x in settings for w in ("--set", x)),
                                        "--out", out, "--json", "--quiet").stdout)
            self.assertEqual(s["final"]["dataset"], place, out)
            self.assertEqual("final_state" in str(s["warnings"]), out in ("times", "csv"), out)

    def test_initial_overrides(self):
        s = self.gas('masses = [1, 2]\ninitial = { q = [0, 0, 1, 0], v = [0, 0.5, 0, 0.5] }', "--set", "run.steps=0")
        self.assertEqual(s["final"]["p"], [0, 0.5, 0, 1])

    def test_containers(self):
        none = self.gas('container = { kind = "none" }')
        self.assertEqual(list(none["invariants"]), ["angular_momentum", "linear_momentum", "centre_of_mass"])
        for name in none["invariants"]:
            self.assertLess(none["invariants"][name]["max_error"], 1e-13)
        periodic = self.gas('cutoff = 1.5\ncontainer = { kind = "periodic", size = [2.7, 2.7] }')
        self.assertEqual(list(periodic["invariants"]), ["linear_momentum", "centre_of_mass"])
        for name in periodic["invariants"]:
            self.assertLess(periodic["invariants"][name]["max_error"], 1e-13)
        box = self.gas('container = { kind = "box", size = [2.1, 2.1] }', "--set", "run.steps=2000")
        self.assertEqual(box["parameters"]["wall_rule"], "mirror")
        self.assertEqual(box["parameters"]["size"], [2.1, 2.1])
        self.assertEqual(set(box["events"]), {"wall:x:min", "wall:x:max", "wall:y:min", "wall:y:max"})
        done = self.hamflow("sweep", "gas.toml", "--vary", "problem.wall_rule=mirror,reject", "--set", "run.steps=2000", "--out",
                            "none", "--json")
        self.assertEqual(json.loads(done.stdout)["rows"][0]["events"], box["events"])
        self.assertGreater(sum(box["events"].values()), 0)
        self.assertLessEqual(max(map(abs, box["final"]["q"])), 1.05)
        self.assertEqual(box["invariants"], {})

    def test_typed_pairs(self):
        """The same potential, typed: its forces differ by rounding alone."""
        built_in = self.gas()
        typed = self.gas('pair = "formula"\nphi = "r^-12 - b*r^-6"\nparameters = { b = 2 }')
        self.assertEqual(typed["parameters"]["b"], 2)
        for a, b in zip(typed["final"]["q"] + typed["final"]["p"], built_in["final"]["q"] + built_in["final"]["p"]):
            self.assertAlmostEqual(a, b, delta=1e-13)
        usual = self.gas(f"epsilon = 1\nsigma = '2^(-1/6)'")  # 4 ((s/r)^12 - (s/r)^6) with the minimum at r = 1
        self.assertAlmostEqual(usual["energy"]["initial"], built_in["energy"]["initial"], delta=1e-13)

    def test_newton(self):
        s = self.gas('pair = "newton"\nsoftening = 0.1\nscale = 1')
        q, p = s["final"]["q"], s["final"]["p"]
        wall = sum(1 / (2.25 - q[i] ** 2 - q[i + 1] ** 2) for i in range(0, 32, 2)) / 2
        pairs = sum(1 / math.sqrt(math.dist(q[2 * i:2 * i + 2], q[2 * j:2 * j + 2]) ** 2 + 0.01)
                    for i in range(16) for j in range(i))
        self.assertAlmostEqual(s["energy"]["final"], sum(x * x for x in p) / 2 - pairs + wall, delta=1e-11)
        masses = [1 + i % 3 for i in range(16)]  # they are inertia: phi is that of every pair
        unequal = self.gas(f'pair = "newton"\nsoftening = 0.1\nscale = 1\nmasses = {masses}', "--set", "run.steps=0")
        q, p = unequal["final"]["q"], unequal["final"]["p"]
        energy = sum(x * x / (2 * masses[i // 2]) for i, x in enumerate(p))
        energy += sum(1 / (2.25 - q[i] ** 2 - q[i + 1] ** 2) for i in range(0, 32, 2)) / 2
        energy -= sum(1 / math.sqrt(math.dist(q[2 * i:2 * i + 2], q[2 * j:2 * j + 2]) ** 2 + 0.01)
                      for i in range(16) for j in range(i))
        self.assertAlmostEqual(unequal["energy"]["initial"], energy, delta=1e-11)

    def test_wrong_keys(self):
        for keys, said in (
                ('scale = "per_side"', 'did you mean per-side'),
                ("scale = 0", "positive"),
                ("dimension = 4", "from 2 to 3"),
                ('start = "corners"', "corner"),
                ('start = "file"', "file"),
                ('file = "x.csv"', 'with start = "file"'),
                ('pair = "lennard_jones"', 'did you mean lennard-jones'),
                ('pair = "formula"', "phi"),
                ('pair = "formula"\nphi = "r^-2 - s"', "s"),
                ('pair = "formula"\nphi = "exp(-t*r)"', "problem.phi: found \"exp(-t*r)\", column 6: the time t"),
                ('pair = "formula"\nphi = "k/r"\nparameters = { k = 1, l = 2 }', "parameters.l: found a parameter that no formula"),
                ('phi = "1/r"', 'with pair = "formula"'),
                ('pair = "newton"\nepsilon = 1', "epsilon"),
                ("softening = 0.1", "softening"),
                ('container = { kind = "round" }', "circle"),
                ('container = { kind = "circle", size = [1, 1] }', "periodic"),
                ('container = { kind = "box" }', "size"),
                ('container = { kind = "box", size = [3] }', "2 edges"),
                ('container = { exponent = 0.5 }', "a number from 1"),
                ("container = { radius = 1.2 }", "particle 1 "),
                ('start = "corner"\ncontainer = { kind = "box", size = [1.9, 3] }', "x4 = 1 beyond the wall"),
                ('container = { kind = "periodic", size = [3, 3] }', "with a cutoff of at most 2"),
                ('cutoff = 2.5\ncontainer = { kind = "periodic", size = [3, 4] }', "at most 2, half"),
                ("cutoff = -1", "positive"),
                ('cutoff = { radius = 2, kind = "smooth" }', "inner"),
                ('cutoff = { radius = 2, kind = "smooth", inner = 2 }', "inner below radius"),
                ('cutoff = { radius = 2, inner = 1 }', "smooth"),
                ('cutoff = { kind = "shifted" }', "radius"),
                ("masses = [1, 2, 3]", "problem.masses: found 3 numbers; allowed one, or 16"),
                ("masses = -1", "positive"),
                ("seed = -1", "whole number"),
                ('start = "corner"\nscale = 1\ncutoff = 0.4\ncontainer = { kind = "periodic", size = [2, 1] }',
                 "particles 4 and 16 at images of the same point in the periodic box"),
                ('wall_rule = "mirror"', "walls"),
                ("initial = { q = [0, 0, 0, 0], p = [0, 0, 0, 0] }", "particles 1 and 2 at one point"),
                ("particle = 3", "did you mean")):
            with self.subTest(keys):
                self.assertIn(said, self.errors(keys))
        self.assertIn("particles_per_side", self.errors("", "--set", "problem.particles_per_side=1"))

    def test_the_exponents_of_a_circle_and_of_walls(self):
        walls = "walls = [{ coordinate = 'x1', min = -9, max = 9 }]\nwall_rule = 'soft'\nexponent = 3\n"
        told = self.gas("container = { kind = 'circle', radius = 9, exponent = 2 }\n" + walls, "--set", "run.steps=0")["parameters"]
        self.assertEqual((told["exponent"], told["wall_exponent"], told["strength"]), (2, 3, 1))
        told = self.gas("container = { kind = 'none' }\n" + walls, "--set", "run.steps=0")["parameters"]
        self.assertEqual(told["exponent"], 3)
        self.assertNotIn("wall_exponent", told)

    def test_a_seed_of_nothing_drawn_is_noted(self):
        self.write("gas.toml", GAS % "seed = 3")
        drawn = self.hamflow("run", "gas.toml", "--out", "none")
        self.assertNotIn("seed", drawn.stderr)
        still = self.hamflow("run", "gas.toml", "--out", "none", "--set", "problem.start=corner")
        self.assertIn('note: problem.seed is not used, because start = "corner" has no random momenta', still.stderr)

    def test_what_a_wrong_gas_is_told(self):
        typed = "container = { kind = 'none' }\npair = 'formula'\n"
        self.assertIn("allowed r, numbers, pi", self.errors(typed + "phi = 'x1'"))
        self.assertIn("found the name r, which a pair law has itself", self.errors(typed + "phi = 'r'\nparameters = { r = 2 }"))
        box = "start = 'corner'\ncontainer = { kind = 'box', size = [1, 1] }\n"
        self.assertIn("with none, circle or periodic", self.errors(box + "walls = [{ coordinate = 'x1', max = 2 }]"))
        self.assertRegex(self.errors(box), r"beyond the wall at -?0\.5; allowed a start between the walls, from -0\.5 to 0\.5")

    def test_who_is_outside(self):
        """In every arithmetic, by name and number; the state is the last good one."""
        for arithmetic in ("double", "compensated", "double-double", "quad", "mp(40)", "lattice"):
            s = self.gas("container = { radius = 1.45 }", "--set", "run.dt=0.1", "--set", "run.steps=50", "--set",
                         f"run.arithmetic={arithmetic}", status=1)
            self.assertEqual((s["status"], s["error"]["kind"]), ("failed", "outside"), arithmetic)
            self.assertRegex(s["error"]["message"], r"step \d+, from t = \S+: particle \d+ was on or beyond the soft wall")
            self.assertIn("exponent", s["error"]["hint"])
            self.assertIn("dt", s["error"]["hint"])
        for method in ("rk4", "gauss(2)", "cg(2,4)"):
            s = self.gas("container = { radius = 1.45 }", "--set", "run.dt=0.3", "--set", "run.steps=50", "--set",
                         f"method={{name='{method}'}}", status=1)
            self.assertEqual(s["error"]["kind"], "outside", method)

    def test_inner_stages(self):
        """Negative sub-steps: stv4 looks at x = 1.3 + 1.35 * 0.15 on its way to 1.45, verlet does not."""
        keys = "scale = 4\ninitial = { q = [1.3, 0, -1, 0], v = [1.5, 0, 0, 0] }"
        for arithmetic in ("double", "lattice"):
            step = ("--set", "run.dt=0.1", "--set", "run.steps=1", "--set", f"run.arithmetic={arithmetic}")
            there = self.gas(keys, *step, "--set", "method={name='verlet'}")
            self.assertLess(there["final"]["q"][0], 1.45)
            error = self.gas(keys, *step, status=1)["error"]
            self.assertEqual(error["kind"], "outside")
            self.assertIn("particle 1 ", error["message"])

    def test_a_kick_too_large_for_the_lattice(self):
        """Particle 109 is thrown beyond the wall by a kick that is no integer of the range: as in double, it is outside.
        Where the kick leads back at first, it is said what double does. A lattice too narrow is another matter."""
        case = (str(EXAMPLES / "gas_121.toml"), "--set", "run.dt=0.01", "--set", "run.steps=30")
        lattice = ("--set", "run.arithmetic=lattice")
        in_double = self.summary(*case, status=1)["error"]
        error = self.summary(*case, *lattice, status=1)["error"]
        self.assertEqual((error["kind"], error["step"]), ("outside", 22))
        self.assertIn("particle 109 was on or beyond the soft wall", error["message"])
        self.assertIn("larger exponent", error["hint"])
        self.assertEqual(error, in_double)
        listing = self.summary(*case, *lattice, "--set", "problem.scale='listing'", status=1)["error"]
        self.assertEqual((listing["kind"], listing["step"]), ("outside", 23))
        self.assertRegex(listing["message"], r"particle \d+ was on or beyond .* in double \d steps? later: on the lattice the kick")
        narrow = self.summary(*case, *lattice, "--set", "run.dt=0.0005", "--set", "run.steps=60", "--set",
                              "run.lattice={position='2^-52', momentum='2^-62'}", status=1)["error"]
        self.assertEqual(narrow["kind"], "lattice_overflow")

    def test_the_circle_is_no_pair_force(self):
        """On the lattice momenta sum to a constant without it; with it nothing is said of their sum."""
        lattice = ("--set", "run.arithmetic=lattice")
        self.assertEqual(list(self.gas("", *lattice)["invariants"]), ["angular_momentum"])
        free = self.gas('container = { kind = "none" }', *lattice)
        self.assertLess(free["invariants"]["linear_momentum"]["max_error"], 32 * 2**-53)  # read in double, and added

    def test_equal_positions_on_the_way(self):
        """Two that meet at one point: no number, told at the step."""
        error = self.gas('container = { kind = "none" }\ninitial = { q = [-1, 0, 1, 0], v = [1, 0, -1, 0] }\nscale = "2^20"',
                         "--set", "run.dt=1", "--set", "method={name='euler-a'}", status=1)["error"]
        self.assertEqual((error["kind"], error["step"]), ("non_finite", 1))

    def test_the_engine_and_more_digits(self):
        """Pairs all at once, against the loop over pairs in quad: rounding alone."""
        for keys in ("", "epsilon = 1", 'pair = "newton"\nsoftening = 0.1', "cutoff = 1.4",
                     'cutoff = { radius = 2, kind = "force-shifted" }', 'dimension = 3\ncontainer = { radius = 2 }',
                     'cutoff = { radius = 1.6, kind = "smooth", inner = 1.2 }\n'
                     'container = { kind = "periodic", size = [2.7, 3] }'):
            ends = [self.gas(keys, "--set", f"run.arithmetic={a}")["final"] for a in ("double", "quad")]
            for x in ("q", "p"):
                for a, b in zip(ends[0][x], ends[1][x]):
                    # 61 kicks of some ten roundings each, of momenta up to 1, grown tenfold over 20 steps at most.
                    self.assertAlmostEqual(a, float(b), delta=61 * 10 * 2.0**-52, msg=keys)

    def test_many_coordinates(self):
        """Above 10^4 coordinates the summary names where they are."""
        text = (GAS % 'container = { kind = "none" }\ncutoff = 1.2\ndimension = 3').replace("side = 4", "side = 15")
        self.write("many.toml", text)
        s = self.summary("many.toml", "--set", "run.steps=0")
        self.assertEqual(set(s["final"]), {"t", "dataset"})

    def test_shown(self):
        shown = self.hamflow("show", "gas").stdout
        for key in ("particles_per_side", "container", "cutoff", "epsilon", "softening", "phi", "seed"):
            self.assertIn(key, shown)
        self.write("new.toml", self.hamflow("new", "gas").stdout)
        self.assertEqual(self.summary("new.toml")["status"], "done")
        self.assertIn("gas", self.hamflow("list", "problems").stdout)


if __name__ == "__main__":
    unittest.main()
