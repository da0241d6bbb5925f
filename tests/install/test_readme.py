"""README by copy and paste: its files and commands, in their order, in an empty folder with hamflow installed."""

import os
import re
import shutil
import subprocess
import unittest

from documents import BUILD, PREFIX, ROOT, WORK, blocks_of

README = ROOT / "README.md"
FOLDER = WORK / "readme"
VERSION = re.search(r'HAMFLOW_VERSION "(.*)"', (ROOT / "include/hamflow/core/version.hpp").read_text())[1]


class Readme(unittest.TestCase):
    def test_every_command_runs(self):
        """A block that names a file is that file; each line of a block of sh is a command, and has to end with status 0, or with
        that of a comment "# exit 2". What names the build is run in the clone, and of ./dev its tasks are looked up.
        Packages are tried elsewhere."""
        shutil.rmtree(FOLDER, ignore_errors=True)
        home = FOLDER / "home"
        empty = FOLDER / "empty"
        home.mkdir(parents=True)
        empty.mkdir()
        tasks = subprocess.run(["./dev", "help"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
        environment = {**os.environ, "HOME": str(home), "PATH": f"{PREFIX / 'bin'}:{os.environ['PATH']}"}
        self.assertGreaterEqual(self.commands_run(empty, environment, tasks), 9)

    def commands_run(self, empty, environment, tasks):
        ran = 0
        for block in blocks_of(README):
            if block.names:
                (empty / block.names).write_text(block.text)
            if block.language != "sh":
                continue
            if packages := re.findall(r"hamflow[-_](\d+\.\d+\.\d+)", block.text):  # tools/package/try_packages runs them
                self.assertEqual(set(packages), {VERSION}, block.where)
                continue
            for command in block.text.replace("\\\n", " ").splitlines():
                with self.subTest(command):
                    if task := re.match(r"\./dev (\w+)", command):
                        self.assertRegex(tasks, rf"(?m)^  {task[1]} ")
                        continue
                    in_clone = "build/release" in command
                    done = subprocess.run(command.replace("build/release", str(BUILD)), shell=True, cwd=ROOT if in_clone else empty,
                                          env=environment, capture_output=True, text=True, timeout=500)
                    expected = re.search(r"# exit (\d+)", command)
                    self.assertEqual(done.returncode, int(expected[1]) if expected else 0, done.stdout[-2000:] + done.stderr[-2000:])
                    ran += 1
        return ran

    def test_every_command_stands_in_a_block(self):
        text = re.sub(r"(?ms)^```.*?^```$", "", README.read_text())
        self.assertNotRegex(text, r"(?m)^    \S")


if __name__ == "__main__":
    unittest.main()
