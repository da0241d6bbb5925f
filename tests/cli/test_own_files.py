"""What is not this run's is neither removed nor mixed: --force, --resume and files of others in the folder."""

import fcntl
import json
import os
import pathlib
import resource
import shutil
import signal
import stat
import subprocess
import sys
import time
import unittest

from command import HAMFLOW, CommandCase

SCENARIO = """
[problem]
name = "central-force"
potential = "kepler"
orbit = { kind = "ellipse", r_per = 1.0, r_aph = 3.0 }
[method]
name = "stv4"
[run]
dt = 0.01
steps = 600
[output]
formats = ["h5", "csv"]
"""


class OwnFiles(CommandCase):
    def setUp(self):
        super().setUp()
        self.write("s.toml", SCENARIO)

    def run_to(self, folder, *arguments, status=0, **options):
        return self.hamflow("run", "s.toml", "--out", folder, "--json", *arguments, status=status, **options)

    def contents(self, folder):
        root = self.folder / folder
        return {str(p.relative_to(root)): p.read_bytes() for p in root.rglob("*") if p.is_file()}

    def refused(self, folder, *arguments, words=(), status=3):
        """The folder is as it was, and the error names what to do, in JSON too."""
        before = self.contents(folder)
        done = self.run_to(folder, *arguments, status=status)
        self.assertEqual(self.contents(folder), before)
        message = json.loads(done.stdout)["error"]["message"]
        self.assertIn(message, done.stderr)
        for word in words:
            self.assertIn(word, message)

    def test_resume_without_a_checkpoint_is_refused(self):
        self.run_to("r")
        (self.folder / "r" / "checkpoint.bin").unlink()
        self.refused("r", "--resume", words=("no checkpoint", "run.h5", "--force"))
        for name in ("summary.json", "run.h5", "trajectory.csv", "figures/orbit.svg"):
            other = self.folder / f"of_another_{name[:3]}"
            (other / name).parent.mkdir(parents=True)
            (other / name).write_text("mine")
            self.refused(other.name, "--resume", words=(name,))
        subprocess.run([HAMFLOW, "shell", "s.toml"], input="step 10\nsave saved\n", text=True, cwd=self.folder, check=True,
                       capture_output=True)
        self.refused("saved", "--resume", words=("no checkpoint", "run.h5"))

    def test_force_removes_what_a_run_leaves(self):
        self.run_to("r", "--set", "output.figures=['energy']")
        folder = self.folder / "r"
        mine = {"figures/mine.svg": "1", "figures/energy.txt": "2", "notes.txt": "3", "sweep.csv": "4", "run.h5.bak": "5"}
        for name, text in mine.items():
            (folder / name).write_text(text)
        (folder / "checkpoint.bin.new").write_text("half")
        self.run_to("r", "--force", "--set", "output.formats=['h5']")
        self.assertEqual(sorted(self.contents("r")), sorted([*mine, "checkpoint.bin", "run.h5", "summary.json"]))
        for name, text in mine.items():
            self.assertEqual((folder / name).read_text(), text)

    def test_force_does_not_remove_what_it_starts_from(self):
        self.write("g.toml", '[problem]\nname = "gas"\nparticles_per_side = 3\ncontainer = { kind = "none" }\n'
                             '[method]\nname = "verlet"\n[run]\ndt = 0.001\nsteps = 5\n')
        self.hamflow("run", "g.toml", "--out", "f", "--quiet")
        (self.folder / "link").symlink_to("f")
        (self.folder / "link.h5").symlink_to("f/run.h5")
        before = self.contents("f")
        for file in ("f/run.h5", "link/run.h5", "link.h5", str(self.folder / "f" / "run.h5")):
            begins = ("g.toml", "--set", "problem.start=file", "--set", f"problem.file={file}", "--quiet")
            for out in ("f", "link"):
                said = self.hamflow("run", *begins, "--out", out, "--force", status=2).stderr
                self.assertIn(f'problem.file: found "{file}", which --force would remove from {out}', said)
                self.assertEqual(self.contents("f"), before)
            for _ in range(2):  # another folder is replaced
                self.hamflow("run", *begins, "--out", "other", "--force")
        # A table that somebody kept under a name of a sweep, or of a reversal.
        rows = "x,y,p_x,p_y\n0,0,0,0\n1,0,0,0\n"
        for command, out, name in ((["sweep", "--vary", "run.dt=0.001,0.002"], "s", "sweep.csv"),
                                   (["reverse"], "v", "reverse.json")):
            (self.folder / out).mkdir()
            (self.folder / out / name).write_text(rows)
            begins = ["g.toml", "--set", "problem.start=file", "--set", f"problem.file={out}/{name}", "--set",
                      "problem.scale=1", "--out", out, "--force"]
            self.write("g.toml", (self.folder / "g.toml").read_text().replace("particles_per_side = 3\n", ""))
            self.assertIn("which --force would remove", self.hamflow(command[0], *begins, *command[1:], status=2).stderr)
            self.assertEqual((self.folder / out / name).read_text(), rows)

    def test_force_follows_no_link_and_removes_no_folder(self):
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        (elsewhere / "energy.svg").write_text("mine")
        self.run_to("r")
        (self.folder / "r" / "figures").symlink_to(elsewhere)
        self.run_to("r", "--force")
        self.assertEqual((elsewhere / "energy.svg").read_text(), "mine")
        (self.folder / "s").mkdir()
        (self.folder / "s" / "run.h5").mkdir()
        (self.folder / "s" / "run.h5" / "mine").write_text("1")
        self.refused("s", "--force", words=("is a folder",))

    def test_a_run_and_a_sweep_do_not_replace_each_other(self):
        self.run_to("r")
        before = self.contents("r")
        sweep = ("sweep", "s.toml", "--vary", "run.dt=0.01,0.02", "--json", "--force", "--out")
        said = self.hamflow(*sweep, "r", status=3).stderr
        self.assertIn("found a run", said)
        self.assertEqual(self.contents("r"), before)
        self.hamflow(*sweep, "w")
        self.refused("w", "--force", words=("found a sweep",))

    def test_a_comparison_replaces_comparisons_alone(self):
        compare = ("compare", "s.toml", "--methods", "verlet,stv4", "--dt", "0.1", "--json", "--out")
        self.hamflow(*compare, "c")
        mine = {"figures/mine.svg": "1", "notes.txt": "2", "summary.json": "3"}
        for name, text in mine.items():
            (self.folder / "c" / name).write_text(text)
        (self.folder / "c" / "compare.csv.new").write_text("half")
        before = self.contents("c")
        self.hamflow(*compare, "c", status=3)
        self.refused("c", "--force", words=("found a comparison", "not replaced"))
        self.assertEqual(self.contents("c"), before)
        # A comparison without a reference writes nothing: nothing of the one before stands for it.
        wild = [x.replace("0.1", "1e300") for x in compare]
        self.hamflow(*wild, "c", "--force", "--set", "run.dt=1e300", "--set", "run.steps=1", status=1)
        self.assertEqual(sorted(self.contents("c")), sorted(mine))
        for name, text in mine.items():
            self.assertEqual((self.folder / "c" / name).read_text(), text)
        self.run_to("r")
        before = self.contents("r")
        self.assertIn("found a run", self.hamflow(*compare, "r", "--force", status=3).stderr)
        self.assertEqual(self.contents("r"), before)

    def is_locked(self, name):
        folder = os.open(self.folder / name, os.O_RDONLY)
        try:
            fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return False
        except BlockingIOError:
            return True
        finally:
            os.close(folder)

    def test_one_writer_in_a_folder(self):
        steps = ("--set", "run.steps=1_000_000_000")
        for command, others in ((("run", "s.toml", *steps), ("--resume", "--force")),
                                (("sweep", "s.toml", "--vary", "run.dt=0.01,0.02", *steps), ("--resume", "--force")),
                                (("compare", "s.toml", "--methods", "stv4", "--dt", "0.01", *steps), ("--force",)),
                                (("reverse", "s.toml", *steps), ("--resume", "--force"))):
            name = command[0] + ".d"
            with self.subTest(command[0]):
                long = subprocess.Popen([HAMFLOW, *command, "--out", name], cwd=self.folder, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
                try:
                    while not ((self.folder / name).exists() and self.is_locked(name)):
                        self.assertIsNone(long.poll())
                        time.sleep(0.01)
                    for other in others:
                        said = self.hamflow(*command, "--out", name, other, status=3).stderr
                        self.assertIn("another process is writing into the folder " + name, said)
                finally:
                    long.kill()
                    long.wait()

    def test_what_a_session_saves_goes_into_no_folder_that_is_written(self):
        (self.folder / "a").mkdir()
        folder = os.open(self.folder / "a", os.O_RDONLY)
        self.addCleanup(os.close, folder)
        fcntl.flock(folder, fcntl.LOCK_EX)
        done = subprocess.run([HAMFLOW, "shell", "s.toml"], cwd=self.folder, input="step 3\nsave! a\nquit\n",
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(list((self.folder / "a").iterdir()), [])
        self.assertIn("another process is writing into the folder a", done.stderr)

    def test_files_of_another_run_are_not_gone_on_with(self):
        self.run_to("a")
        self.run_to("b")  # the same scenario
        self.run_to("c", "--set", "method.name=verlet")
        more = ("--resume", "--set", "run.steps=900")
        for other, name, words in (("b", "run.h5", "belongs to another run"), ("c", "run.h5", "belongs to another run"),
                                   ("c", "trajectory.csv", "not those of the run"), ("c", "summary.json", "method differs")):
            for arguments in (more, ("--resume",)):
                with self.subTest(other=other, name=name, arguments=arguments):
                    shutil.rmtree(self.folder / "x", ignore_errors=True)
                    shutil.copytree(self.folder / "a", self.folder / "x")
                    shutil.copy(self.folder / other / name, self.folder / "x" / name)
                    self.refused("x", *arguments, words=(words, "--force"))
        self.run_to("a", *more)
        self.run_to("whole", "--set", "run.steps=900")
        self.assertEqual(self.contents("a")["trajectory.csv"], self.contents("whole")["trajectory.csv"])

    def test_a_changed_summary_is_not_printed(self):
        first = json.loads(self.run_to("a").stdout)
        file = self.folder / "a" / "summary.json"
        text = file.read_text()
        for change in (text.replace('"done"', '"done "', 1), text.replace('"steps": 600', '"steps": 601'),
                       json.dumps({k: v for k, v in first.items() if k != "energy"}),
                       json.dumps({k: v for k, v in first.items() if k != "status"}),
                       json.dumps({k: v for k, v in first.items() if k != "parameters"}), text[:-1]):
            file.write_text(change)
            again = json.loads(self.run_to("a", "--resume").stdout)
            for key in first:
                if "second" not in key:
                    self.assertEqual(again[key], first[key])
            self.assertEqual(json.loads(file.read_text()), again)
        file.unlink()
        self.run_to("a", "--resume")
        for foreign in ("", "[]", "{}", text[:100], '{"mine": 1}'):
            file.write_text(foreign)
            self.refused("a", "--resume", words=("summary", "belongs to another run"))

    def test_a_finished_run_whose_files_are_gone_is_not_complete(self):
        self.run_to("a")
        for name in ("run.h5", "trajectory.csv"):
            file = self.folder / "a" / name
            data = file.read_bytes()
            file.unlink()
            self.refused("a", "--resume", words=(name, "cannot resume with a/"))
            file.write_bytes(data)
        self.assertIn("nothing to do", self.run_to("a", "--resume").stderr)

    def test_a_run_that_has_only_begun(self):
        """What a kill in the first seconds leaves: the folder is the run's, and it starts from the beginning."""
        self.run_to("whole")
        process = subprocess.Popen([HAMFLOW, "run", "s.toml", "--out", "r", "--set", "run.steps=1_000_000_000"],
                                   cwd=self.folder, stdout=subprocess.DEVNULL)
        while not (self.folder / "r" / "run.h5").exists():
            time.sleep(0.001)
        process.kill()
        process.wait()
        begun = self.folder / "begun"
        shutil.copytree(self.folder / "r", begun)
        shutil.copy(self.folder / "whole" / "run.h5", begun / "run.h5")
        self.refused("begun", "--resume", "--set", "run.steps=1_000_000_000", words=("belongs to another run",))
        self.hamflow("run", "s.toml", "--out", "r", "--resume", "--set", "run.dt=0.02", status=2)
        said = self.run_to("r", "--resume")
        self.assertIn("from the beginning", said.stderr)
        self.assertEqual(self.contents("r")["trajectory.csv"], self.contents("whole")["trajectory.csv"])

    def test_outputs_are_whole_or_as_they_were(self):
        self.run_to("r", "--set", "run.steps=20000", "--set", "run.record_every=1")
        limit = 100_000
        for name in ("x.h5", "x.csv", "x.json"):
            target = self.folder / name
            target.write_text("old")
            words = ["convert", "r", "--to", "polar", "-o", name, *(["--json"] if name == "x.json" else [])]
            done = subprocess.run([HAMFLOW, *words], cwd=self.folder, capture_output=True, text=True,
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
            self.assertEqual(done.returncode, 3, done.stderr)
            self.assertEqual(target.read_text(), "old")
            self.hamflow(*words)
            self.assertGreater(target.stat().st_size, limit)
        link = self.folder / "link.csv"
        link.symlink_to(self.folder / "x.csv")
        self.hamflow("convert", "r", "--to", "polar", "-o", "link.csv")
        self.assertTrue(link.is_symlink())
        self.hamflow("convert", "r", "--to", "polar", "-o", "/dev/null", status=2)  # neither .h5 nor .csv
        self.assertEqual([p.name for p in self.folder.iterdir() if p.name.endswith(".part")], [])

    def test_a_run_that_goes_on_is_converted(self):
        """Its columns differ in length from one moment to the next: what comes out has as many rows in each."""
        process = subprocess.Popen([HAMFLOW, "run", "s.toml", "--out", "r", "--set", "run.steps=1_000_000_000",
                                    "--set", "run.record_every=20_000"], cwd=self.folder, stdout=subprocess.DEVNULL)
        while not (self.folder / "r" / "run.h5").exists():
            time.sleep(0.001)
        try:
            for _ in range(10):
                done = subprocess.run([HAMFLOW, "convert", "r", "--to", "polar", "-o", "x.h5"], cwd=self.folder,
                                      capture_output=True, text=True)
                if done.returncode == 3:  # a row was read as it was written: its checksum did not fit yet
                    self.assertIn("HDF5", done.stderr)
                    continue
                self.assertEqual(done.returncode, 0, done.stderr)
                self.hamflow("convert", "x.h5", "--to", "cartesian", "-o", "y.csv")
        finally:
            process.kill()
            process.wait()
        self.hamflow("convert", "r", "--to", "polar", "-o", "x.h5")  # cut short
        self.hamflow("convert", "x.h5", "--to", "cartesian", "-o", "y.csv")

    def test_what_a_user_adds_to_a_run_neither_breaks_nor_shortens_it(self):
        self.run_to("r", "--set", "output.observables={ r = 'sqrt(x^2 + y^2)' }")
        self.hamflow("convert", "r", "--to", "polar", "-o", "before.csv")
        add = """import h5py, numpy
f = h5py.File('r/run.h5', 'r+', libver='latest')
f.attrs['note'] = 'x'
f.attrs['root'] = f.ref
f['q'].attrs['mine'] = 'text of q'
mine = f.create_group('mine')
mine.attrs['what'] = 'mine too'
mine['x'] = [1., 2., 3.]
mine['names'] = ['a', 'bc']
mine['self'] = mine
mine['soft'] = h5py.SoftLink('/nowhere')
mine.create_dataset('lists', shape=(2,), dtype=h5py.vlen_dtype(numpy.float64))
f['observables/short'] = [1., 2.]
f['observables/text'] = 'a text'
f['invariants/soft'] = h5py.SoftLink('/nowhere')
"""
        subprocess.run([sys.executable, "-c", add], cwd=self.folder, check=True)
        said = self.hamflow("convert", "r", "--to", "polar", "-o", "x.h5").stderr
        for words in ("attribute root refers to objects of its file", "/mine/self (", "/mine/soft (a link)", "/invariants/soft (a link)"):
            self.assertIn(words, said)
        (left_out,) = [line for line in said.splitlines() if "; left out of x.h5: " in line]
        self.assertEqual(left_out.split("left out of x.h5: ")[1].count("("), 4, said)
        self.hamflow("convert", "r", "--to", "polar", "-o", "after.csv")
        self.assertEqual((self.folder / "after.csv").read_bytes(), (self.folder / "before.csv").read_bytes())
        look = """import h5py
f = h5py.File('x.h5')
assert f.attrs['note'] == 'x' and f['q'].attrs['mine'] == 'text of q' and f['mine'].attrs['what'] == 'mine too'
assert list(f['mine/x']) == [1, 2, 3] and list(f['mine/names']) == [b'a', b'bc'] and len(f['mine/lists']) == 2
assert [len(f[name]) for name in ('t', 'q', 'energy', 'observables/r', 'observables/short')] == [601, 601, 601, 601, 2]
"""
        subprocess.run([sys.executable, "-c", look], cwd=self.folder, check=True)
        for file in ("r", "x.h5"):
            said = self.hamflow("plot", file, "-o", "x.svg").stderr
            self.assertIn("/observables/short is left out: it has 2 rows, but the run has 601 samples", said)
            self.assertIn("/observables/text is left out", said)

    def test_a_figure_is_written_through_a_link_as_other_outputs_are(self):
        self.run_to("r", "--set", "output.figures=['energy']")
        for name, words in (("link.svg", ["plot", "r"]), ("link.csv", ["convert", "r", "--to", "polar"])):
            (self.folder / "there").write_text("old")
            (self.folder / name).symlink_to("there")
            self.hamflow(*words, "-o", name)
            self.assertTrue((self.folder / name).is_symlink())
            self.assertGreater((self.folder / "there").stat().st_size, 1000)
            self.assertFalse((self.folder / "there").is_symlink())
        # In the folder of a run a link that somebody has put there is replaced, and what it leads to stays.
        (self.folder / "mine").write_text("mine")
        for name in ("figures/energy.svg", "checkpoint.bin.new", "run.h5.new", "summary.json.new", "trajectory.csv.new"):
            (self.folder / "r" / name).unlink(missing_ok=True)
            (self.folder / "r" / name).symlink_to(self.folder / "mine")
        self.run_to("r", "--resume", "--set", "output.figures=['energy']", "--set", "run.steps=900")
        self.assertEqual((self.folder / "mine").read_text(), "mine")
        self.assertFalse((self.folder / "r/figures/energy.svg").is_symlink())
        self.assertFalse((self.folder / "r/checkpoint.bin").is_symlink())

    def hanging_gnuplot(self):
        programs = self.folder / "bin"
        programs.mkdir()
        fake = programs / "gnuplot"
        fake.write_text("#!/bin/sh\ntouch started\nsleep 1000\n")
        fake.chmod(fake.stat().st_mode | stat.S_IXUSR)
        return {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}

    def test_a_gnuplot_that_hangs_is_ended(self):
        environment = self.hanging_gnuplot()
        self.run_to("whole")
        for words in (["run", "s.toml", "--out", "r", "--set", "output.figures=['energy']"],
                      ["plot", "whole", "-o", "x.svg"]):
            for number in (signal.SIGTERM, signal.SIGINT):
                with self.subTest(words=words, number=number):
                    (self.folder / "started").unlink(missing_ok=True)
                    if words[0] == "run":
                        shutil.rmtree(self.folder / "r", ignore_errors=True)
                    process = subprocess.Popen([HAMFLOW, *words], cwd=self.folder, env=environment, text=True,
                                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
                    while not (self.folder / "started").exists():
                        time.sleep(0.005)
                    process.send_signal(number)
                    _, said = process.communicate(timeout=60)
                    self.assertEqual(process.returncode, 130, said)
                    self.assertIn("stopped while gnuplot was drawing", said)
        self.assertEqual(json.loads((self.folder / "r" / "summary.json").read_text())["status"], "done")
        more = ("r", "--resume", "--set", "output.figures=['energy']")
        self.assertIn("figures are drawn", self.run_to(*more).stderr)
        self.assertIn("figures/energy.pdf", self.contents("r"))
        self.assertIn("nothing to do", self.run_to(*more).stderr)


if __name__ == "__main__":
    unittest.main()
