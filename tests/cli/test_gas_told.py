"""The gas where it tells what to do: refusals recommend what this very problem accepts and say at which key, a run goes
on without the file of its start, momenta can be drawn anew from what `show` says, figures say what they draw."""

import json
import re
import shutil
import unittest

from command import CommandCase, EXAMPLES
from gas_case import GAS

BOX = """[problem]
name = "gas"
particles_per_side = 3
container = { kind = "box", size = [4, 4] }
[method]
name = "stv4"
[run]
dt = 0.001
steps = 2
"""
FROM_FILE = """[problem]
name = "gas"
start = "file"
file = "p.csv"
masses = [2, 3, 1]
container = { kind = "none" }
[method]
name = "stv4"
[run]
dt = 0.001
steps = 100
"""
TWO = """[problem]
name = "gas"
scale = 1
container = { kind = "none" }
initial = { q = [-0.6, 0, 0.6, 0], p = [10, 0, -10, 0] }
[method]
name = "verlet"
[run]
dt = 1e-3
steps = 1
"""


def momenta(seed, numbers):
    """As `hamflow show gas` says at `seed`."""
    word = 2**64 - 1
    for k in range(numbers):
        x = (seed + (k + 1) * 0x9E3779B97F4A7C15) & word
        x = ((x ^ x >> 30) * 0xBF58476D1CE4E5B9) & word
        x = ((x ^ x >> 27) * 0x94D049BB133111EB) & word
        x ^= x >> 31
        m = int(1e5 * ((x >> 11) * 2.0**-53))
        yield float(f"{2 * m - 100000}e-5")


class Told(CommandCase):
    def told(self, scenario, *sets, status=2):
        words = [word for each in sets for word in ("--set", each)]
        return self.hamflow("run", scenario, "--out", "none", *words, status=status).stderr

    def test_rules_that_a_box_has(self):
        """Every rule that a refusal allows is taken."""
        self.write("box.toml", BOX)
        for method in ("tao2", "tao4", "gauss", "rk4", "itoh-abe"):
            with self.subTest(method):
                told = self.told("box.toml", f"method.name={method}")
                self.assertIn("problem.wall_rule: found \"mirror\", the default here, with " + method, told)
                allowed = told.split("; allowed ")[1]
                self.assertIn("stv4", allowed)
                self.told("box.toml", "method.name=stv4", status=0)
                for rule in re.findall('"([a-z]+)"', allowed):
                    self.told("box.toml", f"method.name={method}", f"problem.wall_rule={rule}", status=0)
        told = self.told("box.toml", "method.name=gauss", "method.step_control=reversible", "problem.wall_rule=event")
        self.assertIn('allowed step_control = "fixed"\n', told)

    def test_methods_refused_at_their_key(self):
        """By the key `method.name` and its place, as all refusals, before anything runs."""
        self.write("gas.toml", BOX.replace('container = { kind = "box", size = [4, 4] }', "").replace("stv4", "taylor"))
        for phi in ("abs(r)^-6", "abs(r - 0.7)"):
            told = self.told("gas.toml", "problem.pair=formula", f"problem.phi={phi}")
            self.assertIn("gas.toml:6:8: error: method.name: found taylor: H has branches", told)
            self.assertIn("dop853", told)
            self.told("gas.toml", "problem.pair=formula", f"problem.phi={phi}", "method.name=dop853", status=0)
        self.told("gas.toml", "problem.pair=formula", "problem.phi=r^-6", status=0)
        self.write("gas.toml", BOX.replace('container = { kind = "box", size = [4, 4] }', "").replace("stv4", "itoh-abe"))
        told = self.told("gas.toml", "problem.particles_per_side=12")
        self.assertIn("gas.toml:6:8: error: method.name: found itoh-abe with 288 coordinates; allowed at most 250", told)

    def test_a_run_goes_on_without_the_file_of_its_start(self):
        """From the folder of the scenario and from another one; what it leaves is what a run leaves that never stopped."""
        start = "x,y,p_x,p_y\n0,0,0,0\n1,0,0,0.1\n0,1,0.1,0\n"
        for name in ("a", "b", "c"):
            (self.folder / name).mkdir()
        for arithmetic in ("double", "lattice"):
            with self.subTest(arithmetic):
                change = ["--set", f"run.arithmetic={arithmetic}", "--quiet"]
                self.write("a/p.csv", start)
                self.write("a/f.toml", FROM_FILE)
                self.hamflow("run", "a/f.toml", "--out", "whole.run", "--set", "run.steps=300", "--set", "output.formats=[\"h5\", \"csv\"]", *change, "--force")
                part = ["--set", "output.formats=[\"h5\", \"csv\"]", *change]
                self.hamflow("run", "a/f.toml", "--out", "part.run", "--set", "run.record_every=1", *part, "--force")
                shutil.copy(self.folder / "a/f.toml", self.folder / "b/f.toml")  # where no p.csv is
                told = self.hamflow("run", "b/f.toml", "--out", "part.run", "--resume", "--set", "run.steps=200", "--set", "run.record_every=1",
                                    *[word for word in part if word != "--quiet"])
                self.assertIn("note: problem.file: cannot read the file b/p.csv; the start is read from part.run/run.h5",
                              told.stderr)
                (self.folder / "a/p.csv").unlink()
                self.hamflow("run", "a/f.toml", "--out", "part.run", "--resume", "--set", "run.steps=300", "--set", "run.record_every=1", *part)
                self.assertEqual((self.folder / "part.run/trajectory.csv").read_bytes(), (self.folder / "whole.run/trajectory.csv").read_bytes())
                # The file is back, with another start: that is told.
                self.write("a/p.csv", start.replace("0.1", "0.2"))
                refused = self.hamflow("run", "a/f.toml", "--out", "part.run", "--resume", "--set", "run.steps=400", "--set", "run.record_every=1", *part, status=2)
                self.assertIn("a/f.toml:4:8: error: problem.file: contents: found contents with hash", refused.stderr)
        # A run that does not go on needs its file, and so does one that keeps its start in fewer digits than it had.
        (self.folder / "a/p.csv").unlink()
        self.assertIn("cannot read the file a/p.csv", self.hamflow("run", "a/f.toml", "--out", "new.run", status=2).stderr)
        self.assertIn("cannot read the file a/p.csv", self.hamflow("run", "a/f.toml", "--out", "part.run", "--resume", "--set", "run.arithmetic=quad",
                                                            status=2).stderr)

    def test_momenta_as_show_says(self):
        told = " ".join(self.hamflow("show", "gas").stdout.split())
        for part in ("0x9e3779b97f4a7c15", "0xbf58476d1ce4e5b9", "0x94d049bb133111eb", "m = floor(1e5*(x >> 11)*2^-53)", "2e-5*m - 1"):
            self.assertIn(part, told)
        self.write("gas.toml", BOX.replace('container = { kind = "box", size = [4, 4] }', ""))
        for seed, dimension in ((1, 2), (0, 3), (2**53, 2)):
            s = self.summary("gas.toml", "--set", f"problem.seed={seed}", "--set", f"problem.dimension={dimension}", "--set", "run.steps=0",
                             "--set", 'problem.container={ kind = "none" }')
            self.assertEqual(s["final"]["p"], list(momenta(seed, 3**dimension * dimension)))
            self.assertEqual(s["final"]["q"][:2 * dimension], [-1] * dimension + [0] + [-1] * (dimension - 1))

    def test_numbers_that_do_not_go_together(self):
        """With the number found and the key inside the table."""
        for container, said in (('{ kind = "box", size = [3] }', "gas.toml:4:36: error: problem.container.size: found 1 edge; allowed 2 edges"),
                                ('{ kind = "box", size = [3, 3, 3] }', "problem.container.size: found 3 edges; allowed 2 edges")):
            self.write("gas.toml", BOX.replace('{ kind = "box", size = [4, 4] }', container))
            self.assertIn(said, self.told("gas.toml"))
        self.write("gas.toml", BOX.replace("[method]", 'cutoff = { radius = 2, kind = "smooth", inner = 2.5 }\n[method]'))
        self.assertRegex(self.told("gas.toml"), r"gas.toml:5:[0-9]+: error: problem.cutoff.inner: found 2.5 with radius = 2; allowed inner below radius")

    def test_many_columns_are_not_all_listed(self):
        self.hamflow("run", str(EXAMPLES / "gas_121.toml"), "--out", "g.run", "--quiet", "--set", "output.figures=[]")
        told = self.hamflow("plot", "g.run", "--kind", "time", "--y", "x122", "-o", "o.svg", status=2).stderr
        self.assertRegex(told, r'found column "x122"; allowed t, x1, y1, x2, \.\.\., .* \([0-9]+ columns\); did you mean x12')
        self.assertLess(len(told), 250)

    def test_the_scale_of_a_start_in_a_run(self):
        """H of the run may have been another one: that is told where no key says it."""
        self.write("gas.toml", BOX)
        self.hamflow("run", "gas.toml", "--out", "g.run", "--quiet")
        self.write("on.toml", FROM_FILE.replace("p.csv", "g.run/run.h5").replace("masses = [2, 3, 1]\n", ""))
        note = "note: problem.scale is not given, so it is 1; if the run of g.run/run.h5"
        self.assertIn(note, self.told("on.toml", status=0))
        self.assertNotIn("note", self.told("on.toml", "problem.scale=1", status=0))

    def test_a_figure_of_paths_and_dots_has_no_note_of_first_steps(self):
        """Some of 121 particles have a path that lines follow, others turn too sharply between samples: all are drawn whole."""
        self.hamflow("run", str(EXAMPLES / "gas_121.toml"), "--out", "g.run", "--quiet", "--set", "run.steps=20000", "--set", "run.record_every=100",
                     "--set", "output.figures=[]")
        self.hamflow("plot", "g.run", "--kind", "orbit", "-o", "o.svg")
        self.assertNotIn("first steps", (self.folder / "o.svg").read_text())

    def test_particles_that_may_pass_in_a_sweep_and_a_comparison(self):
        """As `run` says it, once: not for each member."""
        self.write("two.toml", TWO)
        passing = "a particle moves 1.2 in a step, more than a quarter of the repulsion distance 1, so two particles may"
        self.assertIn(passing, self.told("two.toml", "run.dt=0.12", status=0))
        of_sweep = ["sweep", "two.toml", "--out", "none", "--vary"]
        told = self.hamflow(*of_sweep, "run.dt=0.001,0.12,0.13").stderr
        self.assertIn("warning: long_step: in 2 of 3 members, first in member 1, " + passing, told)
        self.assertEqual(told.count("pass through"), 1)
        self.assertNotIn("pass through", self.hamflow(*of_sweep, "run.dt=1e-4,2e-4").stderr)
        # Alone each member says it, too, and what is said of its energy is said in its place.
        self.assertNotIn("pass through", self.hamflow(*of_sweep, "problem.initial.p[0]=10,20", "--set", "run.dt=0.05").stderr)
        of_two = ["compare", "two.toml", "--methods", "verlet,stv4", "--set", "run.t_end=0.24", "--set", "problem.initial.q=[-6,0,6,0]", "--json"]
        told = self.hamflow(*of_two, "--dt", "0.12,0.06,0.0001")
        self.assertIn("long_step: in 4 of 6 runs, with the largest step in verlet with dt = 0.12, " + passing, told.stderr)
        self.assertEqual(told.stderr.count("pass through"), 1)
        self.assertEqual([each["kind"] for each in json.loads(told.stdout)["warnings"]], ["long_step"])
        told = self.hamflow(*of_two, "--dt", "0.0002,0.0001")
        self.assertEqual((json.loads(told.stdout)["warnings"], told.stderr), ([], ""))
        self.assertNotIn("pass through", self.hamflow("compare", "two.toml", "--methods", "dop853", *of_two[4:], "--dt", "0.12").stderr)

    def test_a_refusal_names_the_container_or_the_cutoff(self):
        """What is recommended is then taken."""
        self.write("gas.toml", BOX.replace('container = { kind = "box", size = [4, 4] }\n', ""))
        free = 'problem.container={ kind = "none" }'
        periodic = 'problem.container={ kind = "periodic", size = [3, 3] }'
        for method, keys, found, cutoff in (
                ("eg", [], 'found kind = "circle", the default', False), ("eg", [periodic, "problem.cutoff=1"], 'found kind = "periodic"', False),
                ("taylor", ["problem.cutoff=1"], None, True), ("taylor", [periodic, "problem.cutoff=1"], 'found kind = "periodic"', True)):
            with self.subTest(f"{method} {keys}"):
                told = self.told("gas.toml", f"method.name={method}", *keys)
                only = told.split(" meets this ")[1].split("; ")[0]
                self.assertEqual(found is not None, f'with container = {{ kind = "none" }} ({found})' in only, only)
                self.assertEqual("without cutoff" in only, cutoff, only)
                self.assertNotIn("does not meet this", told)
                taken = [key for key in keys if "cutoff" not in key or not cutoff] + ([free] if found else [])
                self.told("gas.toml", f"method.name={method}", *[key for key in taken if not found or key != periodic], status=0)
        told = self.hamflow("compare", "gas.toml", "--methods", "verlet,eg", "--out", "none", status=2).stderr
        self.assertIn('meets this only with container = { kind = "none" }', told)

    def test_places_of_particles_outside(self):
        """Nobody has typed a start: it is the container's key, or where it would stand."""
        for container, place in (('{ kind = "circle", radius = 1.2 }', "gas.toml:4:41: error: problem.container.radius: found particle 1 at"),
                                 ('{ kind = "box", size = [1, 1] }\nstart = "corner"', "gas.toml:5:9: error: problem.start: found x3 = 1 beyond the wall"),
                                 ('{ kind = "periodic", size = [1, 1] }\nstart = "corner"\ncutoff = 0.5',
                                  "gas.toml:5:9: error: problem.start: found particles 2 and 8 at images")):
            self.write("gas.toml", BOX.replace('{ kind = "box", size = [4, 4] }', container))
            told = self.told("gas.toml")
            self.assertIn(place, told)
            self.assertEqual(told.count("error"), 1)
        self.write("gas.toml", BOX.replace('{ kind = "box", size = [4, 4] }', "{ }"))
        self.assertIn("gas.toml:4:13: error: problem.container.radius: found particle 1 at 1.73", self.told("gas.toml", "problem.dimension=3"))
        self.assertIn("--set: error: problem.container.radius: found particle 1 at", self.told("gas.toml", "problem.container.radius=1.2"))
        self.assertIn("--set: error: problem.walls: found x1 = -1 beyond the wall at 0", self.told("gas.toml", 'problem.walls=[{ coordinate = "x1", min = 0 }]'))

    def test_what_came_from_set_stands_nowhere_in_the_file(self):
        self.write("gas.toml", TWO.replace('{ kind = "none" }', "{ radius = 3 }"))
        for change, key in (("run={ dt = 0.1 }", "run.steps: missing"), ("method={ }", "method.name: missing"),
                            ('run.events=[{ name = "a" }]', "run.events[0].expression: missing"),
                            ('problem.container={ kind = "box" }', "problem.container.size: missing"),
                            ("problem.initial={ q = [1, 1] }", "problem.initial.p: found neither"),
                            ("problem.initial.q[0]=5", "problem.initial: found particle 1 at 5"),
                            ("problem.container.radius=0.5", "problem.container.radius: found particle 1 at 0.6")):
            with self.subTest(change):
                told = self.told("gas.toml", change)
                self.assertTrue(told.startswith(f"--set: error: {key}"), told)
        # What stands in the file is told there, beside something else that was set.
        self.write("gas.toml", TWO.replace("-0.6, 0, 0.6, 0", "0.6, 0, 0.6, 0"))
        self.assertIn("gas.toml:5:11: error: problem.initial: found particles 1 and 2 at one point", self.told("gas.toml", "run.dt=0.1"))

    def test_invariants_are_columns_of_figures(self):
        """Of a run.h5 with its states in /particles, and of one with /q and /p."""
        self.write("two.toml", TWO)
        self.hamflow("run", "two.toml", "--out", "two.run", "--quiet")
        self.write("kepler.toml", """[problem]
name = "central-force"
potential = "kepler"
coordinates = "cartesian"
initial = { q = [1, 0], p = [0, 1] }
""" + TWO[TWO.index("[method]"):])
        self.hamflow("run", "kepler.toml", "--out", "kepler.run", "--quiet")
        for run, columns in (("two", "angular_momentum,linear_momentum_2,centre_of_mass_1"), ("kepler", "angular_momentum")):
            self.hamflow("plot", f"{run}.run", "--kind", "time", "--y", columns, "-o", f"{run}.svg")
            text = (self.folder / f"{run}.svg").read_text()
            for column in columns.split(","):
                self.assertIn(column.replace("_", "")[:8], re.sub("<[^>]*>|[_\\s]", "", text))

    def test_a_reversal_that_did_not_come_back_promises_nothing(self):
        self.write("gas.toml", GAS % "")
        back = ("reverse", "gas.toml", "--set", "run.dt=0.1", "--set", "run.steps=100", "--json")
        for arithmetic in ("lattice", "double"):
            s = json.loads(self.hamflow(*back, "--set", f"run.arithmetic={arithmetic}", status=1).stdout)
            self.assertEqual(s["status"], "failed")
            self.assertEqual(s["note"], "the reversal did not finish, so there is no result")

    def test_a_reversal_draws_nothing_by_itself(self):
        self.write("gas.toml", GAS % "")
        figures = "output.figures is not used: a reversal draws no figures; use --out DIR and hamflow plot"
        self.assertIn(figures, self.hamflow("reverse", "gas.toml", "--set", "output.figures=['particles']").stderr)
        self.assertNotIn("not used", self.hamflow("reverse", "gas.toml").stderr)

    def test_a_column_that_is_nearly_the_mass(self):
        self.write("start.csv", "x,y,p_x,p_y,mess\n0,0,0,0,1\n1,0,0,0,1\n")
        self.write("gas.toml", GAS.replace("particles_per_side = 4", "") % 'start = "file"\nfile = "start.csv"\nscale = 1')
        self.assertIn("found the column 'mess' in line 1, column 13", self.told("gas.toml"))
        self.assertIn("did you mean mass?", self.told("gas.toml"))

    def test_a_file_of_particles_in_space(self):
        self.write("start.csv", "x,y,z,p_x,p_y,p_z\n0,0,0,0,0,0\n1,0,0,0,0,1\n")
        text = GAS.replace("particles_per_side = 4", "") % 'start = "file"\nfile = "start.csv"\nscale = 1'
        self.write("gas.toml", text)
        self.assertIn("z and p_z need problem.dimension = 3", self.told("gas.toml"))

    def test_a_wrong_number_of_particles_is_one_fault(self):
        self.write("gas.toml", GAS % 'scale = "per-side"')
        (line,) = self.told("gas.toml", "problem.particles_per_side=1").splitlines()
        self.assertIn("problem.particles_per_side: found 1", line)

    def test_a_gas_has_no_coordinates_to_convert_to(self):
        self.write("gas.toml", GAS % "")
        told = self.hamflow("convert", "gas.toml", "--to", "cartesian", "-o", "c.toml", status=2).stderr
        self.assertIn("gas has only one set of coordinates, so it cannot be converted; allowed: central-force", told)


if __name__ == "__main__":
    unittest.main()
