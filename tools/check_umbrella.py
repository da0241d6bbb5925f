#!/usr/bin/env python3
"""Fails unless hamflow.hpp names every header below include/hamflow but those of detail, and nothing else; with --fix, writes the list."""

import pathlib
import sys

from sources import ROOT

HEAD = "// The library in one include. ./dev fmt makes the list: every header below include/hamflow but those of detail.\n#pragma once\n\n"


def expected(root: pathlib.Path) -> str:
    include = root / "include"
    headers = sorted(path.relative_to(include).as_posix() for path in include.glob("hamflow/*/**/*.hpp")
                     if path.relative_to(include).parts[1] != "detail")
    return HEAD + "".join(f'#include "{header}"\n' for header in headers)


def violations(root: pathlib.Path) -> list[str]:
    wanted = expected(root).splitlines()
    found = (root / "include/hamflow/hamflow.hpp").read_text().splitlines()
    return [f"lacks {line}" for line in wanted if line not in found] + [f"has a wrong line: {line}" for line in found if line not in wanted]


def main() -> int:
    if "--fix" in sys.argv[1:]:
        (ROOT / "include/hamflow/hamflow.hpp").write_text(expected(ROOT))
    found = violations(ROOT)
    for text in found:
        print(f"include/hamflow/hamflow.hpp {text}; ./dev fmt mends it")
    if not found:
        print("umbrella: hamflow.hpp names every public header")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
