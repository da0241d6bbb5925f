"""hamflow certify: the energies of csv files, columns, logs of LAMMPS and HDF5, and what is wrong with a file."""

import json
import math
import unittest

import h5py
import numpy as np

from command import CommandCase

KEYS = ["drift", "energy_level", "growth_exponent", "reason", "samples", "periods", "scale"]
T = [0.1 * k for k in range(3000)]
BOUNDED = [-0.5 + 1e-6 * math.sin(3 * t) for t in T]
LINEAR = [e + 1e-7 * t for t, e in zip(T, BOUNDED)]


def rows(separator, *columns):
    return "".join(separator.join(repr(x) for x in row) + "\n" for row in zip(*columns))


def thermo(steps, energies, padded=False):
    head = "   Step          Temp          TotEng    \n" if padded else "Step Temp TotEng \n"
    return head + "".join(f"{s:10d} 1.5 {e!r}\n" for s, e in zip(steps, energies)) + \
        f"Loop time of 0.1 on 1 procs for {len(steps)} steps with 100 atoms\n\n"


class Certify(CommandCase):
    def certified(self, file, time, energy, *more):
        found = json.loads(self.hamflow("certify", file, "--time", time, "--energy", energy, "--json", *more).stdout)
        self.assertEqual(list(found), KEYS)
        return found

    def refused(self, file, time, energy, *more, status=2):
        done = self.hamflow("certify", file, "--time", time, "--energy", energy, *more, status=status)
        self.assertEqual(done.stdout, "")
        return done.stderr

    def test_csv_with_names_and_with_numbers(self):
        self.write("e.csv", "t,x,E\n" + rows(",", T, LINEAR, BOUNDED))
        found = self.certified("e.csv", "t", "E")
        self.assertEqual((found["drift"], found["samples"], found["scale"]), ("bounded", 3000, 0.5))
        self.assertAlmostEqual(found["energy_level"], 2e-6, delta=1e-8)
        self.assertEqual(self.certified("e.csv", "1", "3"), found)
        self.assertEqual(self.certified("e.csv", "t", "x")["drift"], "linear")
        self.assertAlmostEqual(self.certified("e.csv", "t", "E", "--scale", "1/4")["energy_level"], 4e-6, delta=1e-8)
        text = self.hamflow("certify", "e.csv", "--time", "t", "--energy", "E").stdout
        self.assertTrue(text.startswith("drift            bounded: "), text)

    def test_forms_of_columns(self):
        wanted = None
        for text in ["t E\n" + rows(" ", T, BOUNDED), rows("\t", T, BOUNDED), "t;E\n" + rows(";", T, BOUNDED),
                     "# by a program\n# t E\n" + rows("  ", T, BOUNDED), "\ufeff\"t\",\"E\"\r\n" + rows(",", T, BOUNDED).replace("\n", "\r\n"),
                     "@ title\n\n# t, E\n" + rows(", ", T, BOUNDED), "t E\n" + rows(" ", T, BOUNDED).replace("e", "D")]:
            self.write("e.txt", text)
            found = self.certified("e.txt", "1", "2")
            wanted = wanted or found
            self.assertEqual(found, wanted)
            if "E" in text.split("0.0")[0]:
                self.assertEqual(self.certified("e.txt", "t", "E"), wanted)

    def test_log_of_lammps(self):
        steps = list(range(0, 300_000, 100))
        heating = thermo(range(0, 1000, 100), [3.0 - 0.1 * k for k in range(10)])
        for padded in (False, True):
            self.write("log.lammps", "LAMMPS (2Sep21)\nrun 1000\nPer MPI rank memory allocation = 3.0 Mbytes\n" + heating +
                       "run 300000\n" + thermo(steps, BOUNDED, padded).replace("\n      1000 ", "\nWARNING: dangerous builds\n      1000 ") +
                       "Total wall time: 0:00:01\n")
            done = self.hamflow("certify", "log.lammps", "--time", "Step", "--energy", "TotEng")
            self.assertIn("bounded", done.stdout)
            self.assertIn("note: log.lammps has 2 tables; only the last one is read (3000 rows)", done.stderr)
            self.assertEqual(self.certified("log.lammps", "Step", "3")["samples"], 3000)
        # A run that goes on has no "Loop time" yet; a last table of one row is that of `run 0`.
        self.write("grows.log", "LAMMPS (2Sep21)\n" + thermo(steps, LINEAR).split("Loop")[0])
        self.assertEqual(self.certified("grows.log", "Step", "TotEng")["drift"], "linear")
        # A killed run has written a part of its last line.
        whole = "LAMMPS (2Sep21)\n" + thermo(steps, LINEAR).split("Loop")[0]
        for cut in (whole + "    300000 1.", whole + "    300000 1.5 -0.4", whole + "    30", whole + "    300000 1.5 -"):
            self.write("killed.log", cut)
            done = self.hamflow("certify", "killed.log", "--time", "Step", "--energy", "TotEng")
            self.assertIn("linear", done.stdout)
            self.assertIn("note: killed.log:3003: the last line has no line end, so it may be incomplete; it is left out", done.stderr)
            self.assertEqual(self.certified("killed.log", "Step", "TotEng")["samples"], 3000)
        self.write("zero.log", "LAMMPS (2Sep21)\n" + thermo(steps, LINEAR) + thermo([300_000], [1.0]))
        self.assertEqual(self.certified("zero.log", "Step", "TotEng")["samples"], 3000)
        self.assertIn("did you mean TotEng?", self.refused("log.lammps", "Step", "TotEn"))
        self.write("none.log", "LAMMPS (2Sep21)\nERROR: no such pair style\n")
        self.assertIn("no thermo output", self.refused("none.log", "Step", "TotEng"))

    def test_a_last_line_without_its_end(self):
        whole = "t,x,E\n" + rows(",", T, LINEAR, BOUNDED)
        for cut in ("300.0", "300.0,-0.5"):
            self.write("cut.csv", whole + cut)
            done = self.hamflow("certify", "cut.csv", "--time", "t", "--energy", "E")
            self.assertIn("note: cut.csv:3002: the last line has no line end", done.stderr)
            self.assertEqual(self.certified("cut.csv", "t", "E")["samples"], 3000)
        self.write("cut.csv", whole + "300.0,-0.5,-0.5")
        self.assertEqual(self.certified("cut.csv", "t", "E")["samples"], 3001)
        self.write("cut.csv", whole + "300.0,-0.5\n")
        self.assertIn("found 2 columns; allowed 3", self.refused("cut.csv", "t", "E"))

    def test_hdf5(self):
        with h5py.File(self.folder / "run.h5", "w") as f:
            f["samples/t"] = T
            f["samples/e"] = np.array([LINEAR, BOUNDED]).T
            f["note"] = "a text"
            f["short"] = [1.0, 2.0]
        self.assertEqual(self.certified("run.h5", "samples/t", "samples/e:2")["drift"], "bounded")
        self.assertEqual(self.certified("run.h5", "/samples/t", "/samples/e:1")["drift"], "linear")
        self.assertIn("allowed samples/e:1 to samples/e:2", self.refused("run.h5", "samples/t", "samples/e"))
        self.assertIn("columns from 1 to 2", self.refused("run.h5", "samples/t", "samples/e:3"))
        wrong = self.refused("run.h5", "sample/t", "samples/e:1")
        self.assertIn("did you mean samples/t?", wrong)
        self.assertIn("note, samples/e, samples/t, short", wrong)
        self.assertIn("a group", self.refused("run.h5", "samples", "samples/e:1"))
        self.assertIn("does not contain numbers", self.refused("run.h5", "samples/t", "note"))
        self.assertIn("2 energies; allowed 3000", self.refused("run.h5", "samples/t", "short"))
        self.write("damaged.h5", "")
        (self.folder / "damaged.h5").write_bytes(b"\x89HDF\r\n\x1a\nno more")
        self.refused("damaged.h5", "t", "E", status=3)

    def test_a_run_of_our_own(self):
        done = json.loads(self.hamflow("run", "kepler.toml", "--set", "method.name=verlet", "--set", "run.dt=0.05",
                                       "--set", "run.steps=1e5", "--out", "a.run", "--json", "--quiet").stdout)
        found = self.certified("a.run/run.h5", "t", "energy")
        self.assertEqual(found["drift"], done["certificate"]["drift"])

    def test_wrong_files(self):
        self.assertIn("No such file or directory", self.refused("nothing.csv", "t", "E", status=3))
        self.assertIn("is a folder", self.refused(".", "t", "E", status=3))
        for text, words in [
                ("", "the file is empty"), ("\n\n", "the file is empty"), ("t,E\n", "no numbers"),
                ("t,E\n1,2\n2,x\n", "e.csv:3:3: error: found 'x' for E; allowed finite numbers"),
                ("t,E\n1,2\n2,\n", "e.csv:3:3: error: found '' for E"),
                ("t E\n1 2\n2 nan\n", "e.csv:3:3: error: found 'nan'"), ("t E\n1 2\ninf 2\n", "e.csv:3:1: error: found 'inf'"),
                ("t E\n1 2\n2 1e999\n", "found '1e999'"), ("t E\n1 2\n2 0x1\n", "found '0x1'"),
                ("t,E\n1,2\n2,3,4\n", "e.csv:3:5: error: found 3 columns; allowed 2, as in line 1"),
                ("t E\n1 2\n2\n", "found 1 column; allowed 2, as in line 1"),
                ("t,E\n1,2\n3,3\n\n2,3\n", "e.csv:5:1: error: found the time 2 after 3; allowed strictly increasing times"),
                ("t,E\n1,2\n", "1 sample")]:
            self.write("e.csv", text)
            self.assertIn(words, self.refused("e.csv", "t", "E"), text)
        self.write("e.csv", rows(",", T, BOUNDED))
        self.assertIn("allowed numbers from 1 to 2, because e.csv has no column names", self.refused("e.csv", "t", "2"))
        self.assertIn("--energy: error: found '3'", self.refused("e.csv", "1", "3"))
        self.write("e.csv", "time,E,E\n" + rows(",", T, BOUNDED, LINEAR))
        self.assertIn("allowed time, E, E, or numbers from 1 to 3; did you mean time?", self.refused("e.csv", "tme", "2"))
        self.assertIn("the name of 2 columns", self.refused("e.csv", "time", "E"))
        for scale in ["0", "-1", "x", "nan"]:
            self.assertIn("allowed a positive number", self.refused("e.csv", "1", "2", "--scale=" + scale))
        self.hamflow("certify", "e.csv", "--time", "1", status=2)
        rejected = json.loads(self.hamflow("certify", "e.csv", "--time", "t", "--energy", "2", "--json", status=2).stdout)
        self.assertEqual(rejected["status"], "rejected")

    def test_what_is_unknown_is_null(self):
        self.write("e.csv", "t,E\n0,0\n1,1e-3\n2,0\n")
        found = self.certified("e.csv", "t", "E")
        self.assertEqual(found["drift"], "undecided")
        self.assertEqual([found[key] for key in ["energy_level", "growth_exponent", "periods", "scale"]], [None] * 4)
        self.assertIn("--scale", self.hamflow("certify", "e.csv", "--time", "t", "--energy", "E").stdout)


if __name__ == "__main__":
    unittest.main()
