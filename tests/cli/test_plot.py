"""hamflow plot: what stands in the figures, for every example and kind; columns, sizes, several runs; refusals."""

import re
import struct
import subprocess
import unittest

from command import EXAMPLES, HAMFLOW, CommandCase

KINDS = ("orbit", "phase", "time", "energy", "energy-error", "section", "condition", "particles", "tracks", "radial")

BODIES = """
[problem]
name = "n-body"
masses = [1, 0.5]
initial = { q = [0,0, 1,0], p = [0,-0.5, 0,0.5] }
[method]
name = "stv4"
[run]
dt = 0.01
steps = 1000
"""

FORMULA = """
[problem]
name = "formula"
coordinates = ["theta_1", "phi_2"]
hamiltonian = "(p_theta_1^2+p_phi_2^2)/2 - cos(theta_1) + phi_2^2/2"
invariants = { L_z = "p_phi_2^2+phi_2^2" }
initial = { q = [0.5, 0.2], p = [0, 0.1] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 60
[output]
observables = { kin_1 = "p_theta_1^2/2" }
"""


def texts(svg):
    """What is written in the figure, without the markup inside a text; a subscript is part of its symbol."""
    found = re.findall(r"<text[^>]*>(.*?)</text>", svg, re.S)
    return [re.sub(r"<[^>]*>", "", text).strip() for text in found]


class Plot(CommandCase):
    def plot(self, *arguments, kind=None):
        """The texts of an SVG."""
        chosen = () if kind is None else ("--kind", kind)
        self.hamflow("plot", *arguments, *chosen, "-o", "f.svg")
        return texts((self.folder / "f.svg").read_text())

    def refused(self, *arguments):
        done = self.hamflow("plot", *arguments, "-o", "refused.svg", status=2)
        self.assertFalse((self.folder / "refused.svg").exists())
        return done.stderr

    def run_some(self, name, *sets, out):
        extra = [part for text in sets for part in ("--set", text)]
        self.hamflow("run", name, "--out", out, "--quiet", "--set", "output.figures=[]", *extra)

    def test_columns_that_are_proposed_are_there(self):
        self.write("gas.toml", """
[problem]
name = "gas"
particles_per_side = 8
[method]
name = "verlet"
[run]
dt = 0.0001
steps = 2
""")
        self.run_some("gas.toml", out="gas")
        told = self.refused("gas", "--kind", "time")
        self.assertIn("hamflow plot --kind time --y x1,y1", told)
        self.plot("gas", "--y", "x1,y1", kind="time")

    def test_units_of_the_planets(self):
        """Of the one problem that brings its numbers along; of others units are those of the input."""
        self.run_some(str(EXAMPLES / "solar_system.toml"), "run.steps=20", out="s")
        momentum = "solar mass AU/day"
        for kind, axes in (("orbit", ("x in AU", "y in AU")), ("energy", ("t in days", "H in solar mass AU2/day2")),
                           ("energy-error", ("t in days",)), ("tracks", ("x in AU",)), ("particles", ("y in AU",))):
            written = self.plot("s", kind=kind)
            for axis in axes:
                self.assertTrue(any(axis in text for text in written), f"{kind}: {axis} among {written}")
        written = self.plot("s", "--y", "x1,p_x1", kind="time")
        self.assertTrue(any("in AU" in text for text in written) and any(momentum in text for text in written), written)
        self.hamflow("run", "kepler.toml", "--out", "k", "--quiet")
        self.assertFalse(any(" in " in text for kind in ("orbit", "time", "energy") for text in self.plot("k", kind=kind)))
        self.assertFalse(any(" in " in text for text in self.plot("k", "s", kind="energy-error")))

    def test_labels_of_every_example_and_kind(self):
        """A label is a name that the problem has: no kind of any example shows another."""
        allowed = re.compile(r"[-\u2212+=|/()., :·×∞^*\w]*")  # titles of typed problems are formulas
        for example in sorted(EXAMPLES.glob("*.toml")):
            fewer = ("problem.particles_per_side=6",) if example.stem == "melt" else ()
            self.run_some(str(example), "run.steps=20", *fewer, out=example.stem)
            drawn = 0
            for kind in KINDS:
                done = subprocess.run([HAMFLOW, "plot", example.stem, "--kind", kind, "-o", "f.svg"], cwd=self.folder,
                                      capture_output=True, text=True, timeout=120)
                if done.returncode == 2:
                    self.assertIn("allowed", done.stderr)
                    continue
                self.assertEqual(done.returncode, 0, f"{example.stem} {kind}: {done.stderr}")
                drawn += 1
                written = texts((self.folder / "f.svg").read_text())
                self.assertGreater(len(written), 5)
                for label in written:
                    self.assertTrue(label.isprintable() and "\ufffd" not in label and len(label) < 120, repr(label))
                    self.assertTrue(allowed.fullmatch(label), f"{example.stem} {kind}: {label!r}")
            self.assertGreaterEqual(drawn, 2 if example.stem.startswith("gas") else 3, example.stem)

    def test_bodies_have_names_colours_and_a_legend(self):
        self.run_some(str(EXAMPLES / "figure_eight.toml"), "run.steps=300", out="eight")
        self.assertTrue({"x", "y", "body 1", "body 2", "body 3"} <= set(self.plot("eight", kind="orbit")))
        labels = self.plot("eight", kind="phase")
        for axis in ("x", "y"):
            for body in (1, 2, 3):
                self.assertIn(f"{axis}{body}", labels)
                self.assertIn(f"p{axis}{body}", labels)

    def test_planes_of_space(self):
        self.run_some(str(EXAMPLES / "solar_system.toml"), "run.steps=30", out="sun")
        labels = self.plot("sun", kind="orbit")
        self.assertEqual([labels.count(f"{axis} in AU") for axis in "xyz"], [2, 2, 2])
        self.assertTrue({"Sun", "Jupiter", "Saturn", "Uranus", "Neptune", "Pluto"} <= set(labels), labels)
        self.assertEqual([self.plot("sun", "--y", "z", kind="orbit").count(f"{axis} in AU") for axis in "xyz"], [1, 0, 1])
        self.assertIn("allowed x, y, z", self.refused("sun", "--kind", "orbit", "--y", "w"))

    def test_time_shows_the_columns_that_are_chosen(self):
        self.hamflow("run", "kepler.toml", "--out", "k")
        labels = self.plot("k", kind="time")
        for label in ("t", "x", "y", "px", "py"):
            self.assertIn(label, labels)
        chosen = self.plot("k", "--y", "x,energy", "--x", "p_y", kind="time")
        self.assertTrue({"x", "py", "H"} <= set(chosen))
        self.assertNotIn("t", chosen)
        self.assertIn('found column "p_z"; allowed t, x, y, p_x, p_y, energy, energy-error, angular_momentum; did you mean p_x?',
                      self.refused("k", "--kind", "time", "--y", "p_z"))
        self.assertIn("draws no columns; allowed for orbit, phase, time",
                      self.refused("k", "--kind", "energy-error", "--y", "x"))

    def test_size_resolution_and_title(self):
        self.hamflow("run", "kepler.toml", "--out", "k")
        self.hamflow("plot", "k", "--size", "10x5", "--dpi", "254", "-o", "f.png")
        self.assertEqual(struct.unpack(">II", (self.folder / "f.png").read_bytes()[16:24]), (1000, 500))
        self.assertIn("central-force, cg(1,5), dt = 0.1", self.plot("k"))
        self.assertNotIn("central-force, cg(1,5), dt = 0.1", self.plot("k", "--no-title"))
        self.assertIn("WIDTHxHEIGHT in centimetres", self.refused("k", "--size", "10"))
        self.assertIn("for this figure at least", self.refused("k", "--size", "2x2"))
        self.assertIn("allowed with a file .png", self.refused("k", "--dpi", "300"))
        self.assertIn("50", self.refused("k", "--dpi", "1"))

    def test_several_runs_are_told_apart_by_what_differs(self):
        for method in ("verlet", "stv4"):
            for dt in ("0.1", "0.05"):
                self.run_some("kepler.toml", f"method={{name='{method}'}}", f"run.dt={dt}", out=f"{method}{dt}")
        labels = self.plot("verlet0.1", "stv40.1", kind="energy-error")
        self.assertTrue({"verlet", "stv4", "central-force, dt = 0.1"} <= set(labels), labels)
        labels = self.plot("verlet0.1", "verlet0.05", kind="orbit")
        self.assertTrue({"dt = 0.1", "dt = 0.05", "central-force, verlet"} <= set(labels), labels)
        labels = self.plot("verlet0.1", "stv40.05", kind="time")
        self.assertTrue({"verlet, dt = 0.1", "stv4, dt = 0.05"} <= set(labels), labels)
        self.assertEqual(len(set(self.plot("verlet0.1", "verlet0.1", kind="energy")) & {"verlet0.1"}), 1)

    def test_runs_that_do_not_fit(self):
        self.hamflow("run", "kepler.toml", "--out", "k")
        self.run_some(str(EXAMPLES / "pendulum.toml"), "run.steps=50", out="p")
        self.run_some(str(EXAMPLES / "figure_eight.toml"), "run.steps=50", out="eight")
        text = self.refused("k", "p", "--kind", "time")
        self.assertIn("allowed runs with the same coordinates", text)
        self.assertIn("orbit", self.refused("k", "p", "--kind", "orbit"))
        self.run_some("kepler.toml", "run.steps=50", "output.observables={ e = 'x*y' }", out="e")
        self.assertRegex(self.refused("e", "k", "--kind", "time", "--y", "e"), 'found column "e" of .*k; allowed t, x')
        self.assertIn("a single run", self.refused("eight", "eight", "--kind", "orbit"))
        self.assertIn("central-force", " ".join(self.plot("k", "p", kind="energy-error")))

    def test_energy_error_in_the_digits_of_the_run(self):
        """In doubles the difference of two energies of a quad run is 0 or 2e-16."""
        self.run_some("kepler.toml", "method={name='kahan-li8'}", "run.dt=0.005", "run.arithmetic='quad'", "run.steps=400",
                      out="quad")
        labels = self.plot("quad", kind="energy-error")
        power = next(label for label in labels if label.startswith("×10"))
        self.assertLess(int(power[3:].replace("\u2212", "-")), -19)
        self.assertIn("central-force, kahan-li8, dt = 0.005, quad", labels)

    def test_what_is_no_run(self):
        for name, said in {"nowhere.run": "does not exist", "kepler.toml": "is not a run of hamflow"}.items():
            text = self.hamflow("plot", name, "--kind", "orbit", "-o", "x.svg", status=3).stderr
            self.assertIn(f"error: {name} ", text)
            self.assertIn(said, text)
        self.hamflow("sweep", "kepler.toml", "--vary", "run.dt=0.1,0.05", "--out", "many")
        self.assertIn("folder of a sweep", self.hamflow("plot", "many", "--kind", "orbit", "-o", "x.svg", status=3).stderr)

    def test_figures_of_sweeps(self):
        def sweep(*vary):
            method = [] if any(text.startswith("method") for text in vary) else ["--set", "method.name=stv4"]
            self.hamflow("sweep", "kepler.toml", "--set", "run.steps=20", *method, "--out", "none", "--figure", "s.svg",
                         *[part for text in vary for part in ("--vary", text)])
            return texts((self.folder / "s.svg").read_text())

        lines = sweep("method.name=verlet,stv4", "run.dt=0.1,0.05,0.025")
        self.assertTrue({"verlet", "stv4", "dt", "max |H \u2212 H0|", "central-force"} <= set(lines), lines)
        self.assertTrue({"verlet", "stv4", "method"} <= set(sweep("method.name=verlet,stv4")))
        self.assertTrue({"rper", "raph"} <= {label.replace("_", "") for label in sweep(
            "problem.orbit.r_per=1:1.5:3", "problem.orbit.r_aph=2:3:4")})
        map_with_white = sweep("problem.orbit.r_per=1:1.5:3", "run.dt=0.1:1e200:2")
        self.assertIn("white: 3 of 6 members (3 non_finite)", map_with_white)

    def test_figures_of_sweeps_are_refused_before_anything_runs(self):
        def refused(status, *arguments):
            done = self.hamflow("sweep", "kepler.toml", "--out", "none", *arguments, status=status)
            self.assertNotIn("{/", done.stderr)
            return done.stderr

        dt = ("--vary", "run.dt=0.1,0.2")
        self.assertIn("the folder nodir does not exist", refused(3, *dt, "--figure", "nodir/s.svg"))
        self.assertIn("--colour: error: found final/t without --figure", refused(2, *dt, "--colour", "final/t"))
        refused(1, "--vary", "run.dt=1e300,1e301", "--figure", "s.svg")  # no member has an end to draw
        for arguments, key in ((("--methods", "stv5"), "--methods"), (("--methods", "stv4", "--dt", "x"), "--dt"),
                               (("--methods", "stv4", "--figure", "a.gif"), "--figure")):
            done = self.hamflow("compare", "kepler.toml", *arguments, status=2)
            self.assertTrue(done.stderr.startswith(f"{key}: error: found "), done.stderr)
        self.assertIn("the folder nodir does not exist", self.hamflow("compare", "kepler.toml", "--methods", "stv4", "--figure",
                                                      "nodir/a.svg", status=3).stderr)

    def test_a_start_alone_has_no_exact_curve(self):
        self.run_some("kepler.toml", "run.steps=0", out="k")
        self.assertNotIn("exact", self.plot("k", kind="orbit"))

    def test_a_curve_that_is_none_of_the_motion_is_not_called_exact(self):
        # H of a driven oscillator changes: its motion leaves the level curve of the start.
        self.hamflow("run", str(EXAMPLES / "formulas" / "driven_duffing.toml"), "--set", "run.steps=300", "--out", "d.run")
        self.hamflow("plot", "d.run", "--kind", "phase", "-o", "d.svg")
        self.assertNotIn("exact", (self.folder / "d.svg").read_text())

    def test_a_section_without_points_costs_no_run_its_other_figures(self):
        done = self.hamflow("run", "kepler.toml", "--set", "run.steps=5", "--set", "run.section={coordinate='x'}",
                            "--set", "output.figures=['section', 'orbit']", "--out", "few.run")
        self.assertIn("note: the figure section was not drawn: found \"section\", but the section has no points", done.stderr)
        self.assertTrue((self.folder / "few.run" / "figures" / "orbit.svg").exists())

    def test_a_section_says_which_it_is(self):
        self.write("h.toml", '[problem]\nname = "henon-heiles"\ninitial = { q = [0, 0.1], p = [0.4, 0] }\n[method]\n'
                             'name = "stv4"\n[run]\ndt = 0.05\nsteps = 4000\nsection = { coordinate = "q1" }\n')
        self.hamflow("run", "h.toml", "--out", "h")
        labels = self.plot("h", kind="section")
        self.assertIn("section q1 = 0, q1 increasing", labels)
        self.assertTrue({"q2", "p2"} <= set(labels))

    def test_a_coarsely_recorded_orbit_is_a_line(self):
        """Samples a hundred steps apart are no path; its opening, which plot recomputes to the bit, is."""
        self.write("h.toml", '[problem]\nname = "henon-heiles"\ninitial = { q = [0, 0.1], p = [0.49, 0] }\n[method]\n'
                             'name = "stv4"\n[run]\ndt = 0.1\nsteps = 100000\nrecord_every = 100\n')
        self.hamflow("run", "h.toml", "--out", "h")
        labels = self.plot("h", kind="orbit")
        self.assertTrue(any(label.startswith("line: the first steps, to t = ") for label in labels), labels)
        self.assertIn("dots: the samples of the whole run", labels)
        self.assertIn("gpPt6'", (self.folder / "f.svg").read_text().split("</defs>")[1])

    def test_an_opening_that_is_the_whole_run_has_no_note(self):
        self.write("g.toml", '[problem]\nname = "gas"\nparticles_per_side = 4\n[method]\nname = "verlet"\n[run]\n'
                             'dt = 0.001\nsteps = 50\nrecord_every = 50\n')
        self.hamflow("run", "g.toml", "--out", "g")
        for chosen in (("--kind", "orbit"), ("--kind", "phase", "--x", "x1", "--y", "p_x1")):
            self.assertFalse([label for label in self.plot("g", *chosen) if "first steps" in label], chosen)

    def test_axes_cover_the_curve_that_stands_for_sparse_samples(self):
        """The circle of the charge reaches from x = 1 to x = 3, whatever samples are stored."""
        for every, out in (("1", "all"), ("500", "few")):
            self.run_some(str(EXAMPLES / "magnetic.toml"), f"run.record_every={every}", out=out)
        for kind in ("orbit", "phase"):
            chosen = ("--x", "x", "--y", "y")
            self.assertEqual(self.plot("all", *chosen, kind=kind), self.plot("few", *chosen, kind=kind))
        self.write("n2.toml", BODIES)
        self.hamflow("reverse", "n2.toml", "--out", "n2.rev", "--quiet")
        self.assertIn("\u22121.5", self.plot("n2.rev", kind="orbit"))

    def test_samples_at_given_times_need_not_reach_the_end(self):
        self.run_some(str(EXAMPLES / "henon_heiles.toml"), "run.steps=4000", "run.record=[100,200,300]", out="h")
        self.assertFalse([label for label in self.plot("h", kind="orbit") if "first steps" in label])
        self.run_some(str(EXAMPLES / "henon_heiles.toml"), "run.steps=40000", "run.record=[100,200,300]", out="long")
        self.assertIn("line: the first steps, to t = 2000 of 4000", self.plot("long", kind="orbit"))

    def test_titles_and_events_of_typed_problems(self):
        """A title says what was typed, and a name of any length stands apart from its count."""
        self.write("f.toml", '[problem]\nname = "formula"\ncoordinates = ["x"]\nhamiltonian = "p_x^2/2 + x^2/2"\n'
                             'initial = { q = [1], p = [0] }\n[method]\nname = "verlet"\n[run]\ndt = 0.1\nsteps = 100\n'
                             'events = [{ name = "latitude60", expression = "x" }]\n')
        told = self.hamflow("run", "f.toml", "--out", "f.run").stdout
        self.assertRegex(told, "event user:latitude60 +[0-9]+\n")
        self.plot("f.run", kind="time")
        self.assertIn("<title>H = p_x^2/2 + x^2/2, verlet, dt = 0.1</title>", (self.folder / "f.svg").read_text())

    def test_entries_of_lists_are_named_by_their_coordinate_or_counted_from_one(self):
        self.write("v.toml", BODIES.replace("p = [0,-0.5, 0,0.5]", "v = [0,-0.5, 0,1]"))
        for key, label in (("problem.initial.q[3]", "y2(0)"), ("problem.initial.v[3]", "vy2(0)"), ("problem.masses[1]", "masses2")):
            self.hamflow("sweep", "v.toml", "--set", "run.steps=20", "--vary", key + "=0.5:0.6:10", "--figure", "v.svg",
                         "--out", "none")
            self.assertIn(label, texts((self.folder / "v.svg").read_text()), key)

    def test_pairs_need_something_that_holds_them(self):
        self.write("n2.toml", BODIES)
        self.run_some("n2.toml", out="n2")
        self.assertIn('found "radial", but the 2 bodies have no container', self.refused("n2", "--kind", "radial"))
        self.run_some(str(EXAMPLES / "gas_121.toml"), "problem.particles_per_side=2", "problem.dimension=3",
                      "problem.container={kind='box',size=[3,3,3]}", "run.steps=20", "run.dt=0.01", out="box")
        labels = self.plot("box", kind="radial")
        self.assertIn("3.0", labels)  # neighbours are 2 apart

    def test_a_reversal_has_one_list_of_kinds(self):
        self.write("n2.toml", BODIES)
        self.hamflow("reverse", "n2.toml", "--out", "n2.rev", "--quiet")
        for kind in ("energy", "energy-error"):
            self.assertIn(f'found "{kind}", but a reversal stores no energies; allowed orbit, phase, time, particles, tracks\n',
                          self.refused("n2.rev", "--kind", kind))
        self.assertTrue(self.refused("n2.rev", "--kind", "section").endswith("; allowed orbit, phase, time, particles, tracks\n"))

    def test_lines_between_few_samples_are_called_so(self):
        self.write("n2.toml", BODIES)
        self.hamflow("reverse", "n2.toml", "--out", "n2.rev", "--quiet")
        self.run_some("n2.toml", "run.record_every=1000", out="few")
        self.run_some("n2.toml", out="all")
        for kind in ("tracks", "time"):
            self.assertIn("lines join 3 samples", self.plot("n2.rev", kind=kind))
            self.assertIn("lines join 2 samples", self.plot("few", kind=kind))
        self.assertFalse([label for label in self.plot("all", kind="time") if "lines join" in label])

    def test_what_other_folders_are(self):
        self.hamflow("compare", "kepler.toml", "--methods", "stv4", "--out", "c.cmp", "--quiet")
        self.run_some("kepler.toml", "output.formats=['csv']", out="c.run")
        self.hamflow("sweep", "kepler.toml", "--vary", "run.dt=0.1,0.05", "--out", "many", "--quiet")
        self.hamflow("reverse", "kepler.toml", "--out", "r.rev", "--quiet")
        (self.folder / "r.rev" / "reverse.h5").unlink()
        for name, told in {"c.cmp": "the folder of a comparison; its figures are c.cmp/figures/work-precision.svg",
                           "c.run": "a run without run.h5",
                           "many/sweep.h5": "it is the table of a sweep: hamflow sweep --figure draws it",
                           "r.rev": "hamflow reverse FILE --out r.rev --resume"}.items():
            self.assertIn(told, self.hamflow("plot", name, "-o", "x.svg", status=3).stderr)

    def test_a_body_at_rest_is_a_point(self):
        self.run_some(str(EXAMPLES / "magnetic.toml"), "problem.initial={q=[1,0,0],v=[0,0,0]}", out="m")
        self.plot("m", kind="orbit")
        drawn = (self.folder / "f.svg").read_text().split("</defs>")[1]
        self.assertIn("gpPt6'", drawn)

    def test_long_words_of_a_sweep(self):
        """Two formulas that differ at their ends; nine methods, upright."""
        self.write("f.toml", FORMULA)
        long = "(p_theta_1^2+p_phi_2^2)/2 - cos(theta_1) + 1/2*phi_2^2 + 1/10*theta_1*phi_2"
        sweep = ("sweep", "f.toml", "--out", "none", "--quiet", "--figure", "f.svg")
        self.hamflow(*sweep, "--vary", f'problem.hamiltonian="{long}+theta_1^4","{long}+theta_1^6"')
        labels = texts((self.folder / "f.svg").read_text())
        self.assertEqual(len([label for label in labels if label.startswith("\u2026")]), 2, labels)
        self.assertTrue(any(label.endswith("theta_1^4") for label in labels), labels)
        methods = "verlet,stv4,kahan-li8,rkn8-s19,suzuki4,cg(2),cg(3)"
        self.hamflow(*sweep, "--vary", f"method.name={methods}")
        svg = (self.folder / "f.svg").read_text()
        self.assertEqual(len(re.findall(r"rotate\([^)]*\)[^<]*(?:<[^>]*>[^<]*){0,3}(?:kahan-li8|rkn8-s19)", svg)), 2, svg[:3000])

    def test_one_name_has_one_label(self):
        self.write("f.toml", FORMULA)
        self.run_some("f.toml", out="f")
        self.assertTrue({"Lz", "kin1"} <= set(self.plot("f", "--y", "L_z,kin_1", kind="time")))
        self.assertIn("p\u03b81, p\u03c62", self.plot("f", kind="time"))
        for column, label in (("invariants/L_z/final", "Lz at the end"), ("observables/kin_1_mean", "kin1, mean over time")):
            self.hamflow("sweep", "f.toml", "--vary", "run.dt=0.1,0.05", "--out", "none", "--quiet", "--figure", "f.svg", "--colour", column)
            self.assertIn(label, texts((self.folder / "f.svg").read_text()))

    def test_a_mean_counts_the_members_that_it_is_of(self):
        """Steps of 6 are too long for most of the ellipses."""
        self.hamflow("sweep", "kepler.toml", "--set", "run.steps=20", "--vary", "run.dt=0.1,6", "--vary",
                     "problem.orbit.r_per=0.2:1.5:6", "--mean", "--out", "none", "--quiet", "--figure", "f.svg", status=None)
        labels = " ".join(texts((self.folder / "f.svg").read_text()))  # long captions have several lines
        self.assertRegex(labels, "bars: standard error of the mean over [1-5] to 6 members")


if __name__ == "__main__":
    unittest.main()
