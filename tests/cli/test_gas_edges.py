"""The gas where it is told what is wrong, unused, or not printed: edges of a periodic box on the lattice, keys without
an effect or in the wrong table, lines of a start file, states of many coordinates, times without a sample."""

import json
import unittest

from command import CommandCase

GAS = """[problem]
name = "gas"
particles_per_side = 4
%s
[method]
name = "stv4"
[run]
dt = 0.0005
steps = 20
"""
PERIODIC = 'cutoff = 1.3\ncontainer = { kind = "periodic", size = [2.7, %s] }'
FROM_FILE = """[problem]
name = "gas"
start = "file"
file = "p.csv"
container = %s
[method]
name = "stv4"
[run]
dt = 0.0005
steps = 2
"""
INITIAL = "initial = { q = [0, 0, 0.5, 0], p = [0, 0, 0, 0] }"
NOT_USED = "not used, because initial gives the start of the particles"


class Edges(CommandCase):
    def told(self, keys, *sets, status=2, command="run"):
        self.write("gas.toml", GAS % keys)
        words = [word for each in sets for word in ("--set", each)]
        return self.hamflow(command, "gas.toml", *(["--out", "none"] if command == "run" else []), *words, status=status).stderr

    def test_a_unit_that_moves_the_box(self):
        """Edges are rounded as the start is, and told; one that would vanish leaves no box, and the cut-off is checked again."""
        for unit, moved in (("2^-3", "0.0499"), ("2^-40", "1.8")):
            told = self.told(PERIODIC % 3, "run.arithmetic=lattice", f"run.lattice.position={unit}", status=0)
            self.assertIn("the edges of the periodic box are rounded to whole grid spacings, by up to " + moved, told)
        told = self.told(PERIODIC % 3, "run.arithmetic=lattice", "run.lattice.position=8")
        self.assertIn("run.lattice.position: found the grid spacing 8 for a periodic box whose edge 2.7 is 0.3375 spacings and would be rounded to 0; allowed spacings", told)
        self.assertIn("too short for problem.cutoff", self.told((PERIODIC % 3).replace("1.3", "2"),
                                                               "run.arithmetic=lattice", "run.lattice.position=2^-1"))
        self.assertNotIn("note", self.told(PERIODIC % 3, "run.arithmetic=lattice", "run.lattice.position=2^-53", status=0))
        # Whole numbers of a coarse unit are a box as good as any.
        self.assertNotIn("periodic", self.told((PERIODIC % 3).replace("2.7", "2.75"), "run.arithmetic=lattice",
                                               "run.lattice.position=2^-40", status=0))

    def test_a_box_that_becomes_too_short(self):
        """An edge below 1 has digits below the usual unit; half of it is no cut-off of the box that is left."""
        keys = 'scale = 1\ncutoff = "%s/2"\ncontainer = { kind = "periodic", size = [%s, 3] }'
        for text, shorter in (("0.57", True), ("0.58", False)):
            moved = round(float(text) * 2**52) * 2.0**-52 - float(text)
            self.assertNotEqual(moved, 0)
            self.assertEqual(moved < 0, shorter)
            told = self.told(keys % (text, text), "run.arithmetic=lattice", "run.steps=0", status=2 if shorter else 0)
            self.assertIn(f"too short for problem.cutoff = {text}/2" if shorter else "the edges of the periodic box are rounded", told)

    def test_a_box_without_edges_on_the_lattice(self):
        """All that is wrong is told, whatever the arithmetic."""
        for container, said in (('{ kind = "periodic" }', "container.size: missing"),
                                ('{ kind = "periodic", size = [-1, 3] }', "positive")):
            told = self.told(f"cutoff = 1\ncontainer = {container}", "run.arithmetic=lattice")
            self.assertIn(said, told)

    def test_what_initial_overrides_is_named(self):
        keys = f'start = "file"\nfile = "nothing.csv"\nseed = 3\n{INITIAL}'
        self.write("gas.toml", GAS % keys)
        note = f"note: problem.start, problem.file, problem.seed are {NOT_USED}"
        for command in (["run", "--out", "none"], ["reverse"], ["compare", "--methods", "verlet,stv4", "--out", "none"],
                        ["sweep", "--vary", "run.dt=1e-4,2e-4", "--out", "none"]):
            arguments = [command[0], "gas.toml", *command[1:]]
            self.assertEqual(self.hamflow(*arguments).stderr.count(note), 1, command)
            self.assertNotIn("not used", self.hamflow(*arguments, "--quiet").stderr)
        self.assertIn(f"problem.seed is {NOT_USED}", self.told(f"seed = 3\n{INITIAL}", status=0))
        # The number on a side still gives the scale, unless that is given.
        self.assertNotIn("particles_per_side", self.told(INITIAL, status=0))
        self.assertNotIn("particles_per_side", self.told(f'scale = "per-side"\n{INITIAL}', status=0))
        for scale in ("1", '"listing"'):
            self.assertIn(f"problem.particles_per_side is {NOT_USED}", self.told(f"scale = {scale}\n{INITIAL}", "run.steps=0", status=0))

    def test_a_key_that_some_members_do_not_use(self):
        self.write("gas.toml", GAS % "seed = 3")
        told = self.hamflow("sweep", "gas.toml", "--vary", 'problem.start="lattice","corner"', "--out", "none").stderr
        self.assertIn('problem.seed is not used, because start = "corner" has no random momenta', told)

    def test_keys_of_other_tables(self):
        for keys, said in (
                ('container = { kind = "box", size = [3, 3], wall_rule = "mirror" }', "container.wall_rule: found \"mirror\" (a string); allowed as problem.wall_rule\n"),
                ('container = { kind = "circle", walls = [] }', "allowed as problem.walls\n"),
                ('container = { kind = "box", size = [3, 3], walls = [] }', "problem.wall_rule defines what happens there"),
                ("container = { skin = 0.2 }", "allowed as problem.cutoff.skin\n"),
                ("container = { inner = 0.2 }", "allowed as problem.cutoff.inner\n"),
                ("container = { cutoff = 2 }", "allowed as problem.cutoff\n"),
                ("cutoff = { radius = 1, exponent = 2 }", "allowed as problem.container.exponent or problem.exponent\n"),
                ("cutoff = { radius = 1, size = [2, 2] }", "allowed as problem.container.size\n"),
                ("skin = 0.2", "allowed as problem.cutoff.skin\n"),
                ("inner = 1", "allowed as problem.cutoff.inner\n"),
                ("radius = 1", "allowed as problem.container.radius or problem.cutoff.radius\n"),
                ("size = [3, 3]", "allowed as problem.container.size\n"),
                ("exponent = 2", "allowed as problem.container.exponent, or with walls\n")):
            with self.subTest(keys):
                told = self.told(keys)
                self.assertIn(said, told)
                self.assertEqual(told.count("error"), 1, told)
        self.assertIn("found an unknown key; allowed radius, kind, inner, skin", self.told("cutoff = { radius = 1, cutoff = 1 }"))

    def test_lines_of_a_start_file(self):
        """Each at the key `file`, with the line and the column of the CSV."""
        box = '{ kind = "box", size = [1, 1] }'
        for container, text, said in (
                ("{ }", "x,y,p_x,p_y\n0,0,0\n", "found 3 numbers in line 2, column 6 of p.csv; allowed 4"),
                ("{ }", "x,y,p_x,p_y\n0,0,0,0,1\n", "found 5 numbers in line 2, column 9 of p.csv; allowed 4"),
                ("{ }", "x,y,p_x,p_y\n\n0,0,0,a\n", "found 'a' for p_y in line 3, column 7 of p.csv; allowed a number"),
                ("{ }", "x,y,p_x,p_y\n0, nan,0,0\n", "found 'nan' for y in line 2, column 4 of p.csv"),
                ("{ }", "x,y,p_x,p_y\n0,1,inf,0\n", "found 'inf' for p_x in line 2, column 5 of p.csv"),
                ("{ }", "x,y,p_x,p_y\n0,1,,0\n", "found '' for p_x in line 2, column 5 of p.csv"),
                ("{ }", "x,y,p_x\n0,0,0\n", "found no column p_y in line 1 of p.csv"),
                ("{ }", "x,y,p_x,p_y,m\n0,0,0,0,1\n", "found the column 'm' in line 1, column 13 of p.csv"),
                ("{ }", "x,y,x,p_x,p_y\n", "found the column 'x' twice in line 1, column 5 of p.csv"),
                ("{ }", "x,y,p_x,p_y,mass\n0,0,0,0,0\n", "found mass 0 in line 2, column 9 of p.csv"),
                ("{ }", "", "found the empty file p.csv"),
                ("{ }", "x,y,p_x,p_y\n\n", "found no particle below line 1 of p.csv"),
                ("{ }", "x,y,p_x,p_y\n0,0,0,0\n\n1,1,0,0\n0,0,1,1\n",
                 "found particles 1 and 3 at one point, in lines 2 and 5 of p.csv; allowed different positions"),
                ("{ }", "x,y,p_x,p_y\n0,0,0,0\n0,2,0,0\n", "on or beyond the soft wall, in line 3 of p.csv; allowed below radius"),
                (box, "x,y,p_x,p_y\n0,0,0,0\n0,1,0,0\n", "found y2 = 1 beyond the wall at 0.5, in line 3 of p.csv")):
            with self.subTest(said):
                self.write("p.csv", text)
                self.write("file.toml", FROM_FILE % container)
                told = self.hamflow("run", "file.toml", "--out", "none", status=2).stderr
                self.assertIn("file.toml:4:8: error: problem.file: found", told)
                self.assertIn(said, told)
                self.assertEqual(told.count("error"), 1, told)
        # What no file says is told where it was typed.
        self.assertIn("gas.toml:4:9: error: problem.start: found particle 1 at",
                      self.told('start = "lattice"\ncontainer = { radius = 1.2 }'))

    def test_a_reversal_of_many_coordinates(self):
        """As in run, where the states are, not what they are."""
        text = (GAS % 'container = { kind = "none" }\ncutoff = 1.2\ndimension = 3').replace("side = 4", "side = 15")
        self.write("many.toml", text.replace("steps = 20", "steps = 1"))
        for out, start, end, line in (([], None, None, "not saved"), (["--out", "kept"], "/start", "/end", "/end in reverse.h5")):
            s = json.loads(self.hamflow("reverse", "many.toml", "--json", *out).stdout)
            self.assertEqual((s["start"], s["returned"]), ({"dataset": start}, {"dataset": end}))
            self.assertRegex(self.hamflow("reverse", "many.toml", *out, *(["--force"] if out else [])).stdout, f"returned +{line}")
        self.assertEqual(json.loads((self.folder / "kept/reverse.json").read_text())["start"], {"dataset": "/start"})
        s = json.loads(self.hamflow("reverse", "many.toml", "--json", "--set", "problem.particles_per_side=3").stdout)
        self.assertEqual(len(s["returned"]["q"]), 81)

    def test_why_pairs_are_not_counted(self):
        self.write("gas.toml", GAS % "cutoff = 1.4")
        s = json.loads(self.hamflow("reverse", "gas.toml", "--json").stdout)
        self.assertIsNone(s["pair_evaluations"])
        self.assertIn("with a cut-off the number of pairs changes", s["pair_evaluations_note"])
        self.write("gas.toml", GAS % "")
        self.assertNotIn("pair_evaluations_note", json.loads(self.hamflow("reverse", "gas.toml", "--json").stdout))

    def test_times_without_a_sample(self):
        """The nearest sample is drawn in its place, and told; a time beyond all of them is refused."""
        self.write("gas.toml", GAS % "")
        self.hamflow("run", "gas.toml", "--quiet", "--out", "late", "--set", "run.record=[0.005, 0.007]")
        self.hamflow("run", "gas.toml", "--quiet", "--out", "all")
        self.hamflow("run", "gas.toml", "--quiet", "--out", "back", "--set", "run.dt=-0.0005")
        two, many = "the 2 samples from 0.005 to 0.007", "the 21 samples from 0 to 0.01"
        for run, at, status, said in (
                ("late", "-0.001", 2, f"found the time -0.001; allowed times of {two}; the nearest is at 0.005"),
                ("late", "0.0058", 0, f"note: no sample is at the time 0.0058, only at those of {two}; the nearest is at 0.005, which is drawn"),
                ("all", "0.005,0.00512", 0, f"note: no sample is at the time 0.00512, only at those of {many}; the nearest is at 0.005,"),
                ("all", "1", 2, "the nearest is at 0.01"),
                ("back", "-0.00512", 0, "the nearest is at -0.005,"), ("back", "-0.011", 2, "the nearest is at -0.01")):
            for kind in ("particles", "radial"):
                with self.subTest(f"{run} {at} {kind}"):
                    self.assertIn(said, self.hamflow("plot", run, "--kind", kind, f"--at={at}", "-o", "f.svg", status=status).stderr)
        self.assertEqual(self.hamflow("plot", "all", "--kind", "particles", "--at", "0,0.0015,0.01", "-o", "f.svg").stderr, "")
        # The start is drawn where samples begin later: a run.h5 tells where it began.
        for kind in ("particles", "radial"):
            for run in ("late", "all"):
                self.assertEqual(self.hamflow("plot", run, "--kind", kind, "--at", "0", "-o", f"{run}.svg").stderr, "")
            self.assertEqual((self.folder / "late.svg").read_text(), (self.folder / "all.svg").read_text())


if __name__ == "__main__":
    unittest.main()
