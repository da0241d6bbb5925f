#!/usr/bin/env python3
"""Fails unless a file holds what a program prints: compare_reference.py PROGRAM FILE."""

import difflib
import pathlib
import subprocess
import sys


def main():
    program, file = sys.argv[1:]
    made = subprocess.run([program], capture_output=True, text=True, check=True).stdout.splitlines()
    there = pathlib.Path(file).read_text(encoding="utf-8").splitlines()
    difference = list(difflib.unified_diff(there, made, file, "declarations", lineterm=""))
    if difference:
        print("\n".join(difference[:40]))
        sys.exit(f"{file} differs from the declarations: ./dev docs makes it anew")


if __name__ == "__main__":
    main()
