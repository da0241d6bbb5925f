#!/usr/bin/env python3
"""Kills `hamflow reproduce` again and again at random moments (kill -9), resumes it each time, and compares what it leaves
in the end with a reproduction that was never interrupted: verdicts.json, index.html and every CSV file of a curve, byte for byte.

    tools/kill_reproduction.py build/release/hamflow all --quick --kills 20 --threads 2

The reproduction that was never interrupted is made first, or taken from --wanted DIR. Prints its seconds, those of the
killed one in all, and how many experiments were done at each kill."""

import argparse
import pathlib
import random
import subprocess
import sys
import tempfile
import time


def contents(folder):
    files = [folder / "verdicts.json", folder / "index.html", *sorted(folder.glob("reproduction/*/*.csv"))]
    return {str(file.relative_to(folder)): file.read_bytes() for file in files}


def done_in(folder):
    return sum(1 for _ in folder.glob("reproduction/*/result.json"))


def reproduce(hamflow, words, folder, timeout=None):
    """Returns whether it came to its end."""
    process = subprocess.Popen([hamflow, "reproduce", *words, "--out", folder, "--resume", "--json"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        process.wait(timeout)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        return False
    if process.returncode != 0:
        sys.exit(f"hamflow ended with status {process.returncode}")
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hamflow", type=pathlib.Path)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--wanted", type=pathlib.Path, help="a folder of the same experiments in the same size")
    parser.add_argument("--seconds", type=float, help="that the reproduction takes, where --wanted is given")
    parser.add_argument("--out", type=pathlib.Path, help="of the killed one; a temporary folder")
    given, words = parser.parse_known_args()
    if not words or words[0].startswith("-"):
        parser.error("found no experiment; allowed all, gross, sonnleitner, or IDs, behind the program")
    if (given.wanted is None) != (given.seconds is None):
        parser.error("--wanted and --seconds go together: how long the one that is there took")
    rng = random.Random(given.seed)
    with tempfile.TemporaryDirectory() as temporary:
        wanted = given.wanted or pathlib.Path(temporary) / "wanted"
        found = given.out or pathlib.Path(temporary) / "found"
        seconds = given.seconds
        if given.wanted is None:
            begin = time.monotonic()
            reproduce(given.hamflow, words, wanted)
            seconds = time.monotonic() - begin
            print(f"{seconds:.0f} s without a kill", flush=True)
        begin = time.monotonic()
        for kill in range(given.kills):
            # Less each time than would take it to the end before the last kill.
            if reproduce(given.hamflow, words, found, rng.uniform(0, 2) * seconds / (given.kills + 1)):
                print(f"done after {kill} kills: give --seconds", flush=True)
                break
            print(f"kill {kill + 1}: {done_in(found)} experiments done", flush=True)
        reproduce(given.hamflow, words, found)
        print(f"{time.monotonic() - begin:.0f} s with them")
        first, second = contents(wanted), contents(found)
        wrong = sorted(name for name in first.keys() | second.keys() if first.get(name) != second.get(name))
        print(f"{len(first)} files compared, {len(wrong)} differ" + "".join("\n  " + name for name in wrong))
        return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
