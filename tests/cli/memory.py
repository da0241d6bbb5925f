"""Commands that are refused a large allocation of a given number (memory_that_ends.cpp)."""

import json
import os
import shutil

from command import CommandCase

GOES_ON = "out of memory; the results so far are in x; to continue, give the same command with --resume"


class MemoryCase(CommandCase):
    def with_memory(self, *arguments, large, folder="x", refused=None, status=None):
        environment = {"LD_PRELOAD": os.environ["MEMORY_THAT_ENDS"], "HAMFLOW_TEST_LARGE": str(large),
                       "HAMFLOW_TEST_COUNT_IN": str(self.folder / "count")}
        if refused is not None:
            environment["HAMFLOW_TEST_REFUSED"] = str(refused)
        leaving = () if folder is None else ("--out", folder, "--json")
        return self.hamflow(*arguments, *leaving, status=status, env=os.environ | environment)

    def large_allocations(self, *arguments, **options):
        self.with_memory(*arguments, status=0, **options)
        shutil.rmtree(self.folder / "x", ignore_errors=True)
        return int((self.folder / "count").read_text())

    def exhausted(self, refused, *arguments, **options):
        """The message of a command that is refused memory after so many large allocations."""
        ended = self.with_memory(*arguments, refused=refused, status=1, **options)
        error = json.loads(ended.stdout)["error"]
        self.assertEqual(error["kind"], "memory")
        self.assertEqual(ended.stderr.splitlines()[-1], "error: " + error["message"])
        return error["message"]
