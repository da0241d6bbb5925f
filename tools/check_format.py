"""Fails on a source that clang-format would change; with --fix, formats the tree in place.

Different versions of clang-format break lines differently, so one major version is fixed: that of Debian 12."""

import pathlib
import re
import shutil
import subprocess
import sys

from sources import ROOT, cpp_sources

MAJOR = 14


def clang_format() -> str:
    """The program of the fixed version: clang-format-14, or clang-format where that is version 14. Exits without it."""
    found = []
    for name in (f"clang-format-{MAJOR}", "clang-format"):
        program = shutil.which(name)
        if program is None:
            continue
        text = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.strip()
        version = re.search(r"version (\d+)\.", text)
        if version and int(version[1]) == MAJOR:
            return program
        found.append(f"{name} is '{text}'")
    raise SystemExit(f"format: found {' and '.join(found) or 'no clang-format'}; allowed is version {MAJOR} alone, since other "
                     f"versions format differently. Debian and Ubuntu have it as the package clang-format-{MAJOR}")


def main(arguments: list[str], root: pathlib.Path = ROOT) -> int:
    if arguments not in ([], ["--fix"]):
        raise SystemExit("usage: check_format.py [--fix]")
    program = clang_format()
    mode = ["-i"] if arguments else ["--dry-run", "--Werror", "--ferror-limit=1"]
    done = subprocess.run([program, "--style=file", *mode, *map(str, cpp_sources(root))], cwd=root)
    if done.returncode == 0 and not arguments:
        print(f"format: every source is as clang-format {MAJOR} formats it")
    elif done.returncode != 0:
        print("format: ./dev fmt formats the tree in place")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
