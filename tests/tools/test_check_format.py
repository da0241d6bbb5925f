"""check_format.py catches a badly formatted source, and refuses to run without clang-format of its version."""

import contextlib
import io
import os
import stat
import unittest
from unittest import mock

from small_tree import SmallTree
import check_format

BAD = "int  f( ) {return 1 ;}\n"
GOOD = "int f() { return 1; }\n"


class Format(SmallTree):
    def setUp(self):
        super().setUp()
        self.write(".clang-format", "BasedOnStyle: Google\n")
        self.write("src/run/run.cpp", GOOD)

    def check(self, *arguments: str) -> int:
        with contextlib.redirect_stdout(io.StringIO()):
            return check_format.main(list(arguments), self.root)

    def only_program(self, name: str, version: str):
        """A PATH on which stands one program, of this name, that reports this version."""
        self.write(f"bin/{name}", f"#!/bin/sh\necho 'Debian clang-format version {version}'\n")
        program = self.root / "bin" / name
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        return mock.patch.dict(os.environ, {"PATH": str(self.root / "bin")})

    def test_a_formatted_tree_passes(self):
        self.assertEqual(self.check(), 0)

    def test_a_bad_source_and_a_bad_header_fail(self):
        for name in ("src/run/more.cpp", "include/hamflow/core/vector.hpp", "tests/compile_fail/bad.cpp"):
            self.write(name, BAD)
            self.assertEqual(self.check(), 1, name)
            (self.root / name).unlink()

    def test_fix_formats_in_place(self):
        self.write("src/run/run.cpp", BAD)
        self.assertEqual(self.check("--fix"), 0)
        self.assertEqual((self.root / "src/run/run.cpp").read_text(), GOOD)

    def test_an_empty_tree_is_not_a_formatted_tree(self):
        (self.root / "src/run/run.cpp").unlink()
        with self.assertRaisesRegex(SystemExit, "found no C\\+\\+ sources"):
            self.check()

    def test_without_clang_format_it_fails_with_a_text(self):
        with mock.patch.dict(os.environ, {"PATH": str(self.root)}):
            with self.assertRaisesRegex(SystemExit, "found no clang-format; allowed is version 14"):
                self.check()

    def test_another_version_is_refused(self):
        with self.only_program("clang-format", "19.1.7"):
            with self.assertRaisesRegex(SystemExit, "clang-format version 19.1.7'; allowed is version 14"):
                self.check()

    def test_the_plain_name_will_do_if_its_version_does(self):
        with self.only_program("clang-format", "14.0.6"):
            self.assertTrue(check_format.clang_format().endswith("clang-format"))


if __name__ == "__main__":
    unittest.main()
