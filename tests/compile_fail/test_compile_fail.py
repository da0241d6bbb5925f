"""Misuse must not compile, and the message must name what is missing: the first line of each file here says what to expect. All
files are compiled as one unit, each in a namespace of its own, since reading the headers takes most of the time; what the
compiler says is then divided among the files. control.cpp is the same ways of use, rightly."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

HERE = pathlib.Path(__file__).parent
MISUSES = sorted(file for file in HERE.glob("*.cpp") if file.name != "control.cpp")


def messages_about(text: str) -> subprocess.CompletedProcess:
    with tempfile.TemporaryDirectory() as folder:
        unit = pathlib.Path(folder) / "unit.cpp"
        unit.write_text('#include "hamflow/hamflow.hpp"\n' + text)
        return subprocess.run([os.environ["COMPILER"], "-std=c++20", "-fsyntax-only", f"-I{os.environ['INCLUDE']}", "-isystem",
                               os.environ["EIGEN"], str(unit)], capture_output=True, text=True)


def errors_in(messages: str) -> list[str]:
    """Each error with the lines that lead to it (in what function, required from where) and the notes behind it."""
    errors = [""]
    ended = False  # the error itself was read: what is no part of its explanation begins another one
    for line in messages.splitlines():
        leads = re.match(r"In file included from|\S+: (In |At global scope)", line) is not None
        if ended and (leads or " error: " in line):
            errors.append("")
            ended = False
        errors[-1] += line + "\n"
        ended = ended or " error: " in line
    return [error for error in errors if " error: " in error]


def errors_about(file: pathlib.Path, errors: list[str]) -> list[str]:
    """Those that name a place in it, and not only include it on the way to another one."""
    including = r"In file included from[^\n]*\n(?: +from[^\n]*\n)*"
    return [error for error in errors if f"{file.name}:" in re.sub(including, "", error)]


class CompileFail(unittest.TestCase):
    def test_misuse_is_named(self):
        if "clang" in os.environ["COMPILER"]:  # it does not tell which file an error comes from
            for file in MISUSES:
                with self.subTest(file.name):
                    done = messages_about(file.read_text())
                    self.assertNotEqual(done.returncode, 0, "compiled, though it must not")
                    self.assertIn(re.match(r"// expect: (.*)\n", file.read_text())[1], done.stderr)
            return
        unit = "".join(f'namespace {file.stem} {{\n#include "{file}"\n}}\n' for file in [*MISUSES, HERE / "control.cpp"])
        done = messages_about(unit)
        self.assertNotEqual(done.returncode, 0)
        errors = errors_in(done.stderr)
        self.assertGreater(len(MISUSES), 8)
        self.assertEqual(errors_about(HERE / "control.cpp", errors), [])  # beside the others
        for file in MISUSES:
            with self.subTest(file.name):
                expected = re.match(r"// expect: (.*)\n", file.read_text())[1]
                own = errors_about(file, errors)
                self.assertTrue(own, "compiled, though it must not")
                self.assertTrue(any(expected in error for error in own), f"nothing says '{expected}':\n" + "".join(own))

    def test_right_use_compiles(self):
        """If this did not compile, the others would prove nothing."""
        done = messages_about(f'#include "{HERE / "control.cpp"}"\n')
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
