"""What a run leaves: after the end, after Ctrl-C, after kill -9; and the figures made of it."""

import json
import signal
import subprocess
import unittest

from command import HAMFLOW, CommandCase, until_it_works

LONG = """
[problem]
name = "central-force"
potential = "kepler"
orbit = { kind = "ellipse", r_per = 1.0, r_aph = 3.0 }
[method]
name = "stv4"
[run]
dt = 0.01
steps = 2_000_000_000
record_every = 1000
"""


class Files(CommandCase):
    def start_long_run(self):
        self.write("long.toml", LONG)
        process = subprocess.Popen([HAMFLOW, "run", "long.toml", "--json"], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        until_it_works(process, 1)  # samples reach the file several times a second
        return process

    def test_interrupt_saves_what_is_there(self):
        process = self.start_long_run()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 130, err)
        self.assertEqual(err, "")  # no progress bar where stderr is no terminal
        s = json.loads(out)
        self.assertEqual(s["status"], "interrupted")
        self.assertGreater(s["steps"], 0)
        self.assertEqual(s["final"]["t"], s["steps"] * 0.01)
        self.assertEqual(json.loads((self.folder / "long.run" / "summary.json").read_text()), s)
        self.hamflow("plot", "long.run", "-o", "orbit.svg")

    def test_kill_leaves_a_readable_file(self):
        process = self.start_long_run()
        process.kill()
        process.wait()
        self.assertFalse((self.folder / "long.run" / "summary.json").exists())
        for kind in ("orbit", "energy", "energy-error", "phase"):
            self.hamflow("plot", "long.run", "--kind", kind, "-o", f"{kind}.svg")
            self.assertIn("<svg", (self.folder / f"{kind}.svg").read_text())

    def test_figures_of_a_running_run(self):
        process = self.start_long_run()
        self.hamflow("plot", "long.run", "-o", "orbit.png")
        process.kill()
        process.wait()
        self.assertEqual((self.folder / "orbit.png").read_bytes()[:4], b"\x89PNG")

    def test_figures_with_the_run(self):
        self.hamflow("run", "kepler.toml", "--set", "output.figures=['orbit','energy','energy-error','phase']")
        names = sorted(p.name for p in (self.folder / "kepler.run" / "figures").iterdir())
        kinds = ("energy", "energy-error", "orbit", "phase")
        self.assertEqual(names, sorted(f"{kind}.{format}" for kind in kinds for format in ("pdf", "png", "svg")))

    def test_plot_errors(self):
        self.hamflow("run", "kepler.toml")
        self.assertIn("svg", self.hamflow("plot", "kepler.run", "-o", "orbit.gif", status=2).stderr)
        self.assertIn("did you mean orbit?",
                      self.hamflow("plot", "kepler.run", "--kind", "orbt", "-o", "o.svg", status=2).stderr)
        self.assertIn("method.diagnostics",
                      self.hamflow("plot", "kepler.run", "--kind", "condition", "-o", "o.svg", status=2).stderr)

    def test_kinds_stand_in_one_table(self):
        shown = self.hamflow("plot", "--help").stdout
        kinds = next(line for line in shown.splitlines() if "--kind KIND" in line).split("KIND")[1].strip()
        for kind in kinds.split(", "):
            self.assertIn("a figure: ", self.hamflow("show", kind).stdout)
        text = self.hamflow("run", "kepler.toml", "--out", "none", "--set", "output.figures=['nothing']", status=2).stderr
        self.assertIn("allowed " + kinds, text)
        self.hamflow("plot", "nothing.run", "-o", "o.svg", status=3)
        self.hamflow("plot", "kepler.toml", "-o", "o.svg", status=3)
        self.hamflow("plot", "kepler.run", "-o", "no/such/folder/o.svg", status=3)

    def test_out_none_writes_nothing(self):
        self.hamflow("run", "kepler.toml", "--out", "none", "--set", "output.figures=['orbit']")
        self.assertEqual([p.name for p in self.folder.iterdir()], ["kepler.toml"])

    def test_a_full_disk_is_said(self):
        done = self.hamflow("list", "methods")
        self.assertTrue(done.stdout)
        with open("/dev/full", "w") as full:
            status = subprocess.run([HAMFLOW, "list", "methods"], stdout=full, stderr=subprocess.PIPE).returncode
        self.assertEqual(status, 3)


if __name__ == "__main__":
    unittest.main()
