"""Work that takes long: a signal is answered within a step, before it and behind it, and a long start says what it does."""

import json
import os
import pty
import select
import signal
import subprocess
import unittest

from command import HAMFLOW, CommandCase

KEPLER = """
[problem]
name = "central-force"
potential = "kepler"
initial = {{ q = [0.4, 0], p = [0, 2] }}
[method]
{method}
[run]
arithmetic = "{arithmetic}"
dt = 0.125
steps = {steps}
"""
# Numbers grow like 10^(3^n): a cosine takes longer with every step.
GROWING = """
[problem]
name = "formula"
hamiltonian = "p^2/2 - q^4/4 + cos(q)/1000"
coordinates = ["q"]
initial = { q = [2], p = [1] }
[method]
name = "verlet"
[run]
arithmetic = "mp(20)"
dt = 1
steps = 1000
"""


class LongWork(CommandCase):
    def start(self, *arguments, stderr=subprocess.PIPE):
        process = subprocess.Popen([HAMFLOW, *arguments], cwd=self.folder, stdout=subprocess.PIPE, stderr=stderr,
                                   text=True)
        self.addCleanup(process.kill)
        return process

    def wait_until(self, process, is_there):
        while not is_there():
            self.assertIsNone(process.poll(), "the command has ended before")
            select.select([], [], [], 0.005)

    def wait_for_handler(self, process, number):
        """Until the command has a handler of its own for the signal."""
        def is_caught():
            with open(f"/proc/{process.pid}/status", encoding="ascii") as status:
                caught = next(line for line in status if line.startswith("SigCgt:"))
            return int(caught.split()[1], 16) >> (number - 1) & 1
        self.wait_until(process, is_caught)

    def test_a_signal_within_a_step_of_minutes(self):
        """Behind the first step that the folder knows of, or within it: nothing of a step is kept."""
        methods = ("name = 'stv4'", "name = 'rk4'", "name = 'gauss'\nstages = 3", "name = 'cg'\nquadrature = 4",
                   "name = 'taylor'")
        for k, method in enumerate(methods):
            with self.subTest(method=method):
                self.write("k.toml", KEPLER.format(method=method, arithmetic="mp(60000)", steps=100000))
                process = self.start("run", "k.toml", "--out", f"r{k}", "--json")
                folder = self.folder / f"r{k}"
                self.wait_until(process, (folder / "checkpoint.bin").exists)
                process.send_signal(signal.SIGTERM if k % 2 else signal.SIGINT)
                out, _ = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 130)
                self.assertNotEqual(json.loads(out).get("status"), "done")

    def test_numbers_that_grow_beyond_all_bounds(self):
        self.write("g.toml", GROWING)
        for number in (signal.SIGINT, signal.SIGTERM):
            process = self.start("run", "g.toml", "--out", f"g{number:d}", "--json")
            self.wait_until(process, (self.folder / f"g{number:d}/checkpoint.bin").exists)
            process.send_signal(number)
            process.communicate(timeout=60)
            self.assertIn(process.returncode, (130, 1))  # 1: infinite before the signal came

    def test_a_long_start_says_what_it_does(self):
        """The line comes by a timer, after 20 s: here the signal of that timer."""
        self.write("k.toml", KEPLER.format(method="name = 'stv4'", arithmetic="mp(99999)", steps=1000))
        self.write("s.toml", KEPLER.format(method="name = 'stv4'", arithmetic="double", steps=1))
        for what, arguments in (("setting up the run", ("run", "k.toml")),
                                ("setting up the sweep", ("sweep", "s.toml", "--vary", "run.dt=0.01:0.1:1000000"))):
            process = self.start(*arguments, "--out", "none")
            self.wait_for_handler(process, signal.SIGALRM)
            process.send_signal(signal.SIGALRM)
            self.assertIn(f"note: {what} has taken ", process.stderr.readline())
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
            self.assertEqual(process.returncode, 130)

    def test_the_first_progress_has_an_estimate_of_the_end(self):
        self.write("s.toml", KEPLER.format(method="name = 'stv4'", arithmetic="double", steps=10**13))
        for arguments in (("run", "s.toml"), ("sweep", "s.toml", "--vary", "run.dt=0.01:0.1:4")):
            master, slave = pty.openpty()
            self.addCleanup(os.close, master)
            process = self.start(*arguments, "--out", "none", stderr=slave)
            os.close(slave)
            seen = b""
            while b" %  " not in seen or not seen.endswith(b"\x1b[K"):
                seen += os.read(master, 4096)
            self.assertIn(b" left", seen)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)


if __name__ == "__main__":
    unittest.main()
