"""Memory that ends while a command computes: it says where what was computed is, and how to go on, where that is true."""

import json
import os
import re
import resource
import shutil
import subprocess
import time
import unittest

from command import HAMFLOW, CommandCase

PARTICLES = 70
GAS = f"""
[problem]
name = "gas"
particles_per_side = {PARTICLES}
cutoff = {{ radius = 1.5, kind = "shifted" }}
container = {{ kind = "none" }}
[method]
name = "verlet"
[run]
dt = 1e-6
steps = 100
record_every = 1000000
"""
STATE = 2 * 8 * 2 * PARTICLES**2  # bytes of q and p
# What is larger than this is a region of its own, which the limit on the address space refuses.
LARGE = {"MALLOC_MMAP_THRESHOLD_": str(1 << 16), "MALLOC_ARENA_MAX": "1"}


def address_space(process):
    with open(f"/proc/{process.pid}/status") as status:
        return int(next(line for line in status if line.startswith("VmSize")).split()[1]) << 10


class Memory(CommandCase):
    def setUp(self):
        super().setUp()
        self.write("gas.toml", GAS)

    def exhausted(self, file, *arguments, begun=STATE):
        """The message of a command that gets no more memory from when the file has so many bytes."""
        for _ in range(6):
            status, out, said = self.ended_without_memory(file, *arguments, begun=begun)
            if status != 3:
                break
            # By chance it was a library that writes, or gnuplot, which had none: an error of files, which says how to go on, too.
            self.assertIn("--resume", said)
            shutil.rmtree(self.folder / "x")
        self.assertEqual(status, 1, said)
        error = json.loads(out)["error"]
        self.assertEqual(error["kind"], "memory")
        self.assertEqual(said.splitlines()[-1], "error: " + error["message"])
        return error["message"]

    def ended_without_memory(self, file, *arguments, begun):
        process = subprocess.Popen([HAMFLOW, *arguments, "--json"], cwd=self.folder, env=os.environ | LARGE, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        end = time.monotonic() + 60
        while not (self.folder / file).exists() or (self.folder / file).stat().st_size < begun:
            self.assertIsNone(process.poll(), process.communicate() if process.poll() is not None else "")
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)
        # The least of some looks: no buffer of a checkpoint, which comes and goes, is in it.
        seen = []
        for _ in range(40):
            seen.append(address_space(process))
            time.sleep(0.002)
        resource.prlimit(process.pid, resource.RLIMIT_AS, (min(seen), min(seen)))
        out, said = process.communicate(timeout=60)
        return process.returncode, out, said

    def goes_on(self, command, folder, *arguments):
        """Two steps behind those that were kept, which were some, with the bits of an undisturbed run."""
        refused = self.hamflow(command, "gas.toml", "--out", folder, "--resume", "--set", "run.steps=0", *arguments, status=2)
        kept = int(re.search("allowed with --resume at least the ([0-9]+) that were taken", refused.stderr)[1])
        self.assertGreater(kept, 0)
        steps = ("--set", f"run.steps={kept + 2}")
        found, wanted = (json.loads(self.hamflow(command, "gas.toml", "--out", out, *more, *steps, *arguments, "--json").stdout)
                         for out, more in ((folder, ("--resume",)), ("wanted", ())))
        return found, wanted

    def test_run(self):
        checkpoints = ("--set", "run.checkpoint_every=20")
        said = self.exhausted("x/checkpoint.bin", "run", "gas.toml", "--out", "x", *checkpoints, "--set", "run.steps=1e9")
        self.assertEqual(said, "out of memory; what was computed is in x, and the same command with --resume goes on")
        found, wanted = self.goes_on("run", "x", *checkpoints)
        for key in ("steps", "final", "energy", "invariants"):
            self.assertEqual(found[key], wanted[key])

    def test_run_with_force(self):
        arguments = ("run", "gas.toml", "--out", "x", "--set", "run.checkpoint_every=20", "--set", "run.steps=1e9", "--force")
        self.assertEqual(self.exhausted("x/checkpoint.bin", *arguments),
                         "out of memory; what was computed is in x, and the same command with --resume in place of --force goes on")

    def test_nothing_to_go_on_from(self):
        """The first checkpoint is what there is no memory for: the folder has none but that of the beginning."""
        steps = ("--set", "run.steps=2000")
        self.assertEqual(self.exhausted("x/checkpoint.bin", "run", "gas.toml", "--out", "x", *steps, begun=1), "out of memory")

    def test_reverse(self):
        checkpoints = ("--set", "run.checkpoint_every=20")
        said = self.exhausted("x/reversal.bin", "reverse", "gas.toml", "--out", "x", *checkpoints, "--set", "run.steps=1e9")
        self.assertEqual(said, "out of memory; what was computed is in x, and the same command with --resume goes on")
        found, wanted = self.goes_on("reverse", "x", *checkpoints)
        self.assertEqual(found["hash"], wanted["hash"])

    def test_sweep(self):
        sweep = ("sweep", "gas.toml", "--threads", "1", "--set", "run.steps=20", "--vary", "run.dt=1e-6:2e-6:24", "--out")
        said = self.exhausted("x/members.bin", *sweep, "x")
        self.assertEqual(said, "out of memory; what was computed is in x, and the same command with --resume goes on")
        done = self.hamflow(*sweep, "x", "--resume", "--json")
        self.assertRegex(done.stderr, "note: [1-9][0-9]* of 24 members are finished")
        self.assertEqual(json.loads(done.stdout)["done"], 24)

    def test_reproduce(self):
        """What ran out says nothing about the experiment, which did not fail."""
        experiment = ("reproduce", "S2.7", "--quick", "--out", "x")
        said = self.exhausted("x/reproduction/S2.7/begun.txt", *experiment, begun=1)
        self.assertEqual(said, "out of memory; what was computed is in x, and the same command with --resume goes on")
        done = json.loads(self.hamflow(*experiment, "--resume", "--json").stdout)
        self.assertEqual(done["experiments"][0]["status"], "done")


if __name__ == "__main__":
    unittest.main()
