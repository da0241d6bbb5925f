"""hamflow view: a page with a scenario, a run or a sweep in it. The page itself is tested in tests/web."""

import base64
import json
import os
import re
import shutil
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

HAMFLOW = os.environ["HAMFLOW"]
SCENARIO = """[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2)"
initial = { q = [1, 0], p = [0, 1] }

[method]
name = "verlet"

[run]
dt = 0.1
steps = 20
"""


class View(unittest.TestCase):
    """The command is copied, so that the page beside it is that of the test."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        (self.folder / "bin").mkdir()
        self.command = self.folder / "bin" / "hamflow"
        shutil.copy(HAMFLOW, self.command)
        (self.folder / "kepler.toml").write_text(SCENARIO)

    def install(self):
        share = self.folder / "share" / "hamflow"
        share.mkdir(parents=True)
        (share / "laboratory.html").write_text("<body><!--inlined--><p>the page</p></body>")

    def call(self, *words):
        return subprocess.run([self.command, *words], cwd=self.folder, capture_output=True, text=True,
                              env={**os.environ, "DISPLAY": "", "WAYLAND_DISPLAY": ""})

    def inlined(self, file):
        found = re.search(r'<script type="application/json" id="inlined">(.*)</script><p>', (self.folder / file).read_text())
        data = json.loads(found[1])
        stored = base64.b64decode(data["rows"])
        numbers = struct.unpack(f"<{len(stored) // 8}d", stored)
        width = max(1, len(data["columns"]))
        return data, [numbers[i:i + width] for i in range(0, len(numbers), width)]

    def test_without_the_page(self):
        done = self.call("view", "kepler.toml")
        self.assertEqual(done.returncode, 3)
        self.assertIn("./dev web", done.stderr)

    def test_scenario(self):
        self.install()
        done = self.call("view", "kepler.toml", "--no-browser")
        self.assertEqual((done.returncode, done.stdout), (0, "kepler.html\n"), done.stderr)
        data, _ = self.inlined("kepler.html")
        self.assertEqual((data["kind"], data["toml"]), ("scenario", SCENARIO))

    def test_run(self):
        self.install()
        done = self.call("run", "kepler.toml", "--quiet", "--json")
        final = json.loads(done.stdout)["final"]
        done = self.call("view", "kepler.run", "-o", "page.html", "--no-browser")
        self.assertEqual((done.returncode, done.stdout), (0, "page.html\n"), done.stderr)
        data, rows = self.inlined("page.html")
        self.assertEqual(data["columns"][:6], ["t", "x", "y", "p_x", "p_y", "energy error"])
        self.assertEqual((data["name"], data["note"], len(rows)), ("kepler.run", "", 21))
        self.assertEqual(list(rows[-1][1:5]), final["q"] + final["p"])
        self.assertEqual(rows[0][5], 0)

    def test_sweep(self):
        self.install()
        self.call("sweep", "kepler.toml", "--vary", "run.dt=0.05,0.1", "--quiet")
        done = self.call("view", "kepler.sweep", "-o", "page.html", "--no-browser")
        self.assertEqual(done.returncode, 0, done.stderr)
        data, rows = self.inlined("page.html")
        self.assertEqual((data["kind"], data["columns"][0], len(rows)), ("sweep", "varied/run.dt", 2))
        self.assertEqual([row[0] for row in rows], [0.05, 0.1])
        self.assertIn("verlet", data["toml"])

    def test_laboratory_alone(self):
        self.install()
        done = self.call("view", "--no-browser")
        self.assertEqual((done.returncode, done.stdout), (0, "laboratory.html\n"), done.stderr)
        self.assertIn("the page", (self.folder / "laboratory.html").read_text())

    def test_wrong_scenario(self):
        self.install()
        (self.folder / "kepler.toml").write_text(SCENARIO.replace("verlet", "verlte"))
        self.assertEqual(self.call("view", "kepler.toml", "--no-browser").returncode, 2)
        self.assertEqual(self.call("view", "nothing.toml", "--no-browser").returncode, 3)


if __name__ == "__main__":
    unittest.main()
