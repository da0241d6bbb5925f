"""Runs the command in a folder of its own and looks at what it says, returns and leaves."""

import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time
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


def until(state, process, seconds=120):
    """Waits until state() is true of a process that runs; a process that ends before, or the time, is a failure."""
    end = time.monotonic() + seconds
    while not state():
        if process.poll() is not None:
            raise AssertionError(f"the command ended with {process.returncode} before")
        if time.monotonic() > end:
            raise AssertionError(f"not so after {seconds} s")
        time.sleep(0.01)


def until_it_works(process, seconds=0.2):
    """Waits until a command answers Ctrl-C in its own way and has worked for so many seconds of its processor: a signal
    that comes earlier ends it before there is anything to keep."""

    def has_worked():
        handled = next(line for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines()
                       if line.startswith("SigCgt:"))
        times = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
        used = (int(times[11]) + int(times[12])) / os.sysconf("SC_CLK_TCK")
        return int(handled.split()[1], 16) >> (signal.SIGINT - 1) & 1 and used >= seconds

    until(has_worked, process)


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
