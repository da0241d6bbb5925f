"""Runs the command in a folder of its own and looks at what it says, returns and leaves."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

HAMFLOW = os.environ["HAMFLOW"]
EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])

ELLIPSE = """
[problem]
name = "central-force"
potential = "kepler"
k = 1.0
mass = 2.0
orbit = { kind = "ellipse", r_per = 1.0, r_aph = 3.0 }
[method]
name = "cg"
quadrature = 5
[run]
dt = 0.1
steps = 400
"""


class CommandCase(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self._folder.name)
        self.addCleanup(self._folder.cleanup)
        self.write("kepler.toml", ELLIPSE)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def hamflow(self, *arguments, status=0, env=None):
        """The finished process; its status has to be `status`, or may be any with None."""
        done = subprocess.run([HAMFLOW, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=120, env=env)
        if status is not None:
            self.assertEqual(done.returncode, status, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def summary(self, *arguments, status=0):
        """The summary of a run that writes nothing."""
        return json.loads(self.hamflow("run", *arguments, "--out", "none", "--json", status=status).stdout)
