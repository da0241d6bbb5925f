"""Memory that ends while a command computes: it says where what was computed is, and how to go on, where that is true.
A large allocation of a given number is refused (memory_that_ends.cpp), at several places of a run."""

import json
import re
import shutil
import unittest

from memory import GOES_ON, MemoryCase

PARTICLES = 40
STEPS = 100
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
steps = {STEPS}
record_every = 1000000
"""
STATE = 2 * 8 * 2 * PARTICLES**2  # bytes of q and p


class Memory(MemoryCase):
    def setUp(self):
        super().setUp()
        self.write("gas.toml", GAS)

    def with_memory(self, *arguments, large=STATE // 4, **options):
        return super().with_memory(*arguments, large=large, **options)

    def goes_on(self, command, *arguments):
        """A few steps behind those that were kept, which were some, with the bits of an undisturbed run."""
        refused = self.hamflow(command, "gas.toml", "--out", "x", "--resume", "--set", "run.steps=0", *arguments, status=2)
        kept = int(re.search("allowed with --resume at least ([0-9]+), which were taken already", refused.stderr)[1])
        self.assertGreater(kept, 0)
        steps = ("--set", f"run.steps={min(kept + 2, STEPS)}")
        found, wanted = (json.loads(self.hamflow(command, "gas.toml", "--out", out, *more, *steps, *arguments, "--json").stdout)
                         for out, more in (("x", ("--resume",)), ("wanted", ("--force",))))
        return kept, found, wanted

    def ends_everywhere(self, command, *arguments, same):
        """After a tenth of the large allocations, after three tenths, ...: the kept steps grow with them."""
        every = self.large_allocations(command, "gas.toml", *arguments)
        self.assertGreater(every, 20)
        all_kept = []
        for part in range(1, 10, 2):
            said = self.exhausted(every * part // 10, command, "gas.toml", *arguments)
            if said == "out of memory":  # nothing was kept so early
                self.assertEqual(all_kept, [])
            else:
                self.assertEqual(said, GOES_ON)
                kept, found, wanted = self.goes_on(command, *arguments)
                self.assertEqual([found[key] for key in same], [wanted[key] for key in same])
                all_kept.append(kept)
            shutil.rmtree(self.folder / "x", ignore_errors=True)
        self.assertGreater(len(set(all_kept)), 1)
        self.assertEqual(all_kept, sorted(all_kept))

    def test_run(self):
        self.ends_everywhere("run", "--set", "run.checkpoint_every=4", same=("steps", "final", "energy", "invariants"))

    def test_reverse(self):
        self.ends_everywhere("reverse", "--set", "run.checkpoint_every=4", same=("hash", "start", "returned"))

    def test_run_with_force(self):
        checkpoints = ("run", "gas.toml", "--set", "run.checkpoint_every=4")
        half = self.large_allocations(*checkpoints) // 2
        self.assertEqual(self.exhausted(half, *checkpoints, "--force"), GOES_ON.replace("--resume", "--resume in place of --force"))

    def test_nothing_to_go_on_from(self):
        """No checkpoint but that of the beginning, which is of the folder and not of steps."""
        once = ("run", "gas.toml", "--set", "run.checkpoint_every=100")
        static = self.large_allocations("--version", folder=None)
        for refused in range(static, static + 4):
            self.assertEqual(self.exhausted(refused, *once), "out of memory")
            shutil.rmtree(self.folder / "x", ignore_errors=True)

    def test_sweep(self):
        sweep = ("sweep", "gas.toml", "--threads", "1", "--set", "run.steps=20", "--vary", "run.dt=1e-6:2e-6:24")
        every = self.large_allocations(*sweep)
        self.assertEqual(self.exhausted(every * 3 // 4, *sweep), GOES_ON)
        done = self.hamflow(*sweep, "--out", "x", "--resume", "--json")
        self.assertRegex(done.stderr, "note: [1-9][0-9]* of 24 members are finished")
        self.assertEqual(json.loads(done.stdout)["done"], 24)


if __name__ == "__main__":
    unittest.main()
