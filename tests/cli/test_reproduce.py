"""hamflow reproduce starts hamflow-reproduce, and says how to get it where it is missing."""

import json
import os
import shutil
import signal
import subprocess
import unittest

from command import HAMFLOW, CommandCase

PROGRAM = """#!/bin/sh
case "$*" in
"--list --json") echo '[{"id": "G2.8"}]';;
wait) touch waits; while :; do sleep 0.01; done;;
*) for word; do echo "$word"; done; exit 7;;
esac
"""


class Reproduce(CommandCase):
    def setUp(self):
        super().setUp()
        shutil.copy(HAMFLOW, self.folder / "hamflow")
        (self.folder / "empty").mkdir()
        self.environment = os.environ | {"PATH": str(self.folder / "empty")}

    def started(self, *arguments, **options):
        return subprocess.run([self.folder / "hamflow", *arguments], cwd=self.folder, env=self.environment, capture_output=True,
                              text=True, timeout=60, **options)

    def install(self, folder):
        program = self.folder / folder / "hamflow-reproduce"
        program.write_text(PROGRAM)
        program.chmod(0o755)

    def test_without_the_program(self):
        for arguments in (("reproduce", "G2.8"), ("reproduce", "--help"), ("list", "experiments"), ("show", "G2.8", "--out", "r")):
            done = self.started(*arguments)
            self.assertEqual((done.returncode, done.stdout), (3, ""), arguments)
            self.assertIn("./dev theses", done.stderr)
        for arguments in (("reproduce", "all"), ("list", "experiments")):
            error = json.loads(self.started(*arguments, "--json").stdout)["error"]
            self.assertEqual(error["kind"], "file")
            self.assertIn("./dev theses", error["message"])
        done = self.started("show", "G2.8")
        self.assertEqual(done.returncode, 2)
        self.assertIn("./dev theses", done.stderr)
        self.assertEqual(self.started("show", "stv4").returncode, 0)

    def test_it_gets_the_arguments_and_gives_the_status(self):
        for folder in (".", "empty"):  # beside the command, and in PATH
            self.install(folder)
            for arguments, expected in ((("reproduce", "a b", "--quick"), ["a b", "--quick"]),
                                        (("reproduce", "--help"), ["--help"]), (("list", "experiments"), ["--list"]),
                                        (("show", "G2.8"), ["--show", "G2.8"]),
                                        (("show", "G2.8", "--out", "r"), ["--show", "G2.8", "--out", "r"])):
                done = self.started(*arguments)
                self.assertEqual((done.stdout.splitlines(), done.returncode), (expected, 7), done.stderr)
            self.assertIn("did you mean G2.8", self.started("show", "G2.80").stderr)
            self.assertIn("found --out with cg", self.started("show", "cg", "--out", "r").stderr)
            (self.folder / folder / "hamflow-reproduce").unlink()

    def test_signals_reach_it(self):
        self.install(".")
        process = subprocess.Popen([self.folder / "hamflow", "reproduce", "wait"], cwd=self.folder)
        while not (self.folder / "waits").exists():
            self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(), -signal.SIGTERM)


if __name__ == "__main__":
    unittest.main()
