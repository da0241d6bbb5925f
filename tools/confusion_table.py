#!/usr/bin/env python3
"""The confusion table of the drift classes: runs of known behaviour, and what their certificates call them.

    python3 tools/confusion_table.py build/release/hamflow                 # 64 random runs of each behaviour
    python3 tools/confusion_table.py build/release/hamflow --runs 8 --only kepler
    python3 tools/confusion_table.py build/release/hamflow --truth         # how the errors of longer runs grow
    python3 tools/confusion_table.py build/release/hamflow --hold --runs 36   # against runs 16 times as long

The behaviours, and why their class is known, are in tools/behaviours.py. Those whose class no theory tells are compared
with runs 16 times as long, and with --hold they alone are run. Ends with 1 where a class is false, or where more than a
third of the runs of 32 periods and more is undecided.
"""

import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from behaviours import BEHAVIOURS, BOUNDED, HELD, LINEAR, NONE, WALK  # noqa: E402


def drawn(name, number, given):
    """The run of a behaviour with a number: the same for every order and choice of the others."""
    run = BEHAVIOURS[name][1](random.Random(f"{given.seed} {name} {number}"))
    run.cut(given.longest)
    return run


def summary(command, scenario):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "run.toml"
        file.write_text(scenario)
        done = subprocess.run([command, "run", str(file), "--json", "--quiet", "--out", "none"], capture_output=True,
                              text=True, timeout=600)
    if done.returncode not in (0, 1) or not done.stdout:
        raise RuntimeError(f"{scenario}\n{done.stdout}\n{done.stderr}")
    return json.loads(done.stdout)


def growth(command, run):
    """Largest energy errors of a run once, four and sixteen times as long, over their scale."""
    return [max(summary(command, run.scenario(times))["energy"]["max_relative_error"] or 0, 1e-300)
            for times in (1, 4, 16)]


def contradicted(short, long):
    """What a run 16 times as long says against the class of the short one; empty where it says nothing.

    An error is bounded where it grew by less than a random walk does, and linear where it grew by more than t^(1/4). A
    random walk says of itself up to which trend per step it is one.
    """
    before, after = (s["energy"]["max_relative_error"] for s in (short, long))
    given = short["certificate"]["drift"]
    if long["status"] != "done" or before is None or after is None or before == 0:
        return ""
    grew = f"{given}, but the error grew from {before:.2e} to {after:.2e}"
    if given == BOUNDED and after > 4 * before:
        return grew
    if given == LINEAR and after < 2 * before and after < 0.1:  # an error of the size of the energy has no room to grow
        return grew
    if given == WALK and after > before + long["steps"] * short["certificate"]["trend_not_excluded"]:
        return grew
    return ""


def held(command, run):
    """The certificate of a run, and what one 16 times as long says against it."""
    short = summary(command, run.scenario())
    decided = short["certificate"]["drift"] != NONE
    return short["certificate"], contradicted(short, summary(command, run.scenario(16))) if decided else ""


def show_truth(names, given, pool):
    print(f"{'behaviour':34}{'class':>12}   exponent of the largest error: 1 to 4 times, 4 to 16 times as long")
    for name in names:
        grown = list(pool.map(lambda n: growth(given.hamflow, drawn(name, n, given)), range(given.runs)))
        median = [sorted(math.log(g[k + 1] / g[k], 4) for g in grown)[given.runs // 2] for k in (0, 1)]
        print(f"{name:34}{BEHAVIOURS[name][0]:>12}   {median[0]:8.2f}{median[1]:8.2f}", flush=True)


class Row:
    """The classes that the runs of one behaviour were given."""

    def __init__(self, truth):
        self.truth = truth
        self.given = dict.fromkeys((BOUNDED, WALK, LINEAR, NONE), 0)
        self.false, self.long, self.long_undecided = [], 0, 0

    def add(self, number, run, certificate, against):
        given = certificate["drift"] or NONE
        self.given[given] += 1
        if against if self.truth == HELD else given not in (NONE, self.truth):
            certificate["reason"] += f"; {against}" if against else ""
            self.false.append((number, given, certificate))
        # Of an energy of which no bit changes there is nothing to decide (free flight between walls).
        if (run.periods is None or run.periods >= 32) and certificate["energy_level"] != 0:
            self.long += 1
            self.long_undecided += given == NONE


def show_table(rows, details):
    print(f"{'behaviour':34}{'class':>12} |{'bounded':>9}{'walk':>6}{'linear':>8}{'undecided':>11} |{'false':>6}"
          f"{'undecided of >= 32 periods':>28}")
    for name, row in rows.items():
        g = row.given
        print(f"{name:34}{row.truth:>12} |{g[BOUNDED]:9}{g[WALK]:6}{g[LINEAR]:8}{g[NONE]:11} |{len(row.false):6}"
              f"{row.long_undecided:20} of {row.long:4}")
        for number, given, c in row.false if details else []:
            print(f"    run {number}: {given} ({c['reason']}; p = {c['p_value']}, exponent {c['growth_exponent']})")
    false = sum(len(row.false) for row in rows.values())
    runs = sum(sum(row.given.values()) for row in rows.values())
    judged = [row for row in rows.values() if row.truth != NONE]
    undecided, long = sum(row.long_undecided for row in judged), sum(row.long for row in judged)
    print(f"{runs} runs, {false} false ({100 * false / runs:.2f} %); of {long} of 32 periods and more "
          f"{undecided} undecided ({100 * undecided / max(long, 1):.1f} %)")
    return false, undecided / max(long, 1)


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("hamflow")
    options.add_argument("--runs", type=int, default=64, help="of each behaviour [64]")
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--only", default="", help="behaviours whose name contains this")
    options.add_argument("--details", action="store_true", help="each false class")
    options.add_argument("--truth", action="store_true", help="errors of runs 4 and 16 times as long")
    options.add_argument("--hold", action="store_true", help="only the behaviours that longer runs judge")
    options.add_argument("--longest", type=int, default=10**9, help="no run has more steps")
    options.add_argument("--jobs", type=int, default=os.cpu_count())
    given = options.parse_args()
    names = [name for name in BEHAVIOURS if given.only in name and (not given.hold or BEHAVIOURS[name][0] == HELD)]
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        if given.truth:
            show_truth(names, given, pool)
            return 0
        rows = {}
        for name in names:
            row = rows[name] = Row(BEHAVIOURS[name][0])
            runs = [drawn(name, number, given) for number in range(given.runs)]
            judge = held if row.truth == HELD else lambda command, run: (summary(command, run.scenario())["certificate"], "")
            for number, (run, found) in enumerate(zip(runs, pool.map(lambda run: judge(given.hamflow, run), runs))):
                row.add(number, run, *found)
            print(f"  {name}", file=sys.stderr, flush=True)
    false, undecided = show_table(rows, given.details)
    return 0 if false == 0 and undecided <= 1 / 3 else 1


if __name__ == "__main__":
    sys.exit(main())
