"""hamflow plot: what stands in the figures, for every example and kind; columns, sizes, several runs; refusals."""

import re
import struct
import subprocess
import unittest

from command import EXAMPLES, HAMFLOW, CommandCase

KINDS = ("orbit", "phase", "time", "energy", "energy-error", "section", "condition", "particles", "tracks", "radial")


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
        allowed = re.compile(r"[-\u2212+=|/()., ·×∞\w]*")
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
        self.assertIn("a run alone", self.refused("eight", "eight", "--kind", "orbit"))
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
        for name, said in {"nowhere.run": "there is no such file", "kepler.toml": "no run of hamflow"}.items():
            text = self.hamflow("plot", name, "--kind", "orbit", "-o", "x.svg", status=3).stderr
            self.assertIn(f"{name} cannot be read", text)
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
        self.assertIn("there is no folder nodir", refused(3, *dt, "--figure", "nodir/s.svg"))
        self.assertIn("--colour: error: found final/t without --figure", refused(2, *dt, "--colour", "final/t"))
        refused(1, "--vary", "run.dt=1e300,1e301", "--figure", "s.svg")  # no member has an end to draw
        for arguments, key in ((("--methods", "stv5"), "--methods"), (("--methods", "stv4", "--dt", "x"), "--dt"),
                               (("--methods", "stv4", "--figure", "a.gif"), "--figure")):
            done = self.hamflow("compare", "kepler.toml", *arguments, status=2)
            self.assertTrue(done.stderr.startswith(f"{key}: error: found "), done.stderr)
        self.assertIn("no folder nodir", self.hamflow("compare", "kepler.toml", "--methods", "stv4", "--figure",
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
        self.assertIn("note: a figure is not drawn: found \"section\", but the section has no points", done.stderr)
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
        self.assertTrue(any(label.startswith("the first steps alone, to t = ") for label in labels), labels)
        self.assertNotIn("gpPt6'", (self.folder / "f.svg").read_text().split("</defs>")[1])

    def test_an_opening_that_is_the_whole_run_has_no_note(self):
        self.write("g.toml", '[problem]\nname = "gas"\nparticles_per_side = 4\n[method]\nname = "verlet"\n[run]\n'
                             'dt = 0.001\nsteps = 50\nrecord_every = 50\n')
        self.hamflow("run", "g.toml", "--out", "g")
        for chosen in (("--kind", "orbit"), ("--kind", "phase", "--x", "x1", "--y", "p_x1")):
            self.assertFalse([label for label in self.plot("g", *chosen) if "first steps" in label], chosen)


if __name__ == "__main__":
    unittest.main()
