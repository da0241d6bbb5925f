"""Kills a run again and again at random moments (kill -9), resumes it each time, and compares what it leaves in the end
with the run that was never interrupted: the summary but for the seconds, trajectory.csv, every dataset of run.h5, bit for
bit. A run that ends before its kill is compared and begun anew.

    tools/kill_and_resume.py build/release/hamflow SCENARIO.toml --kills 200 --set run.checkpoint_every=100000

Give the scenario several seconds and a checkpoint_every far below that, or hardly a kill will find a checkpoint."""

import argparse
import json
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time


def summary(text):
    whole = json.loads(text)
    return {key: value for key, value in whole.items() if key not in ("wall_seconds", "steps_per_second")}


def differences(compare, wanted, found):
    """Names of what differs between the folders of two runs."""
    wrong = []
    if summary((wanted / "summary.json").read_text()) != summary((found / "summary.json").read_text()):
        wrong.append("summary.json")
    csv = [(folder / "trajectory.csv").read_bytes() if (folder / "trajectory.csv").exists() else None
           for folder in (wanted, found)]
    if csv[0] != csv[1]:
        wrong.append("trajectory.csv")
    if (wanted / "run.h5").exists():
        done = subprocess.run([compare, wanted / "run.h5", found / "run.h5"], capture_output=True, text=True)
        if done.returncode != 0:
            wrong.append("run.h5: " + done.stdout + done.stderr)
    return wrong


def kill_and_resume(hamflow, compare, scenario, sets, kills, seed, folder, say=print):
    """Returns the number of kills, of kills after which there was a checkpoint, of runs compared, and what differed."""
    rng = random.Random(seed)
    options = [word for text in sets for word in ("--set", text)]
    wanted, found = folder / "wanted.run", folder / "found.run"
    begin = time.monotonic()
    subprocess.run([hamflow, "run", scenario, "--out", wanted, "--quiet", "--json", *options], check=True,
                   stdout=subprocess.DEVNULL)
    seconds = time.monotonic() - begin
    killed = with_checkpoint = compared = 0
    wrong = []
    while True:
        process = subprocess.Popen([hamflow, "run", scenario, "--out", found, "--resume", "--quiet", "--json", *options],
                                   stdout=subprocess.DEVNULL)
        try:
            process.wait(timeout=rng.uniform(0, seconds / 2) if killed < kills else None)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            killed += 1
            with_checkpoint += (found / "checkpoint.bin").exists()
            continue
        if process.returncode != 0:
            return killed, with_checkpoint, compared, wrong + [f"exit status {process.returncode}"]
        compared += 1
        wrong += differences(compare, wanted, found)
        say(f"{killed} kills, {with_checkpoint} of them with a checkpoint, {compared} runs compared, "
            f"{len(wrong)} differences")
        if wrong or killed >= kills:
            return killed, with_checkpoint, compared, wrong
        shutil.rmtree(found)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hamflow", type=pathlib.Path)
    parser.add_argument("scenario", type=pathlib.Path)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE")
    parser.add_argument("--compare", type=pathlib.Path, help="the program compare_runs; default: in the build of hamflow")
    arguments = parser.parse_args()
    hamflow = arguments.hamflow.resolve()
    compare = arguments.compare or hamflow.parent / "tests" / "io" / "compare_runs"
    with tempfile.TemporaryDirectory() as folder:
        *counts, wrong = kill_and_resume(hamflow, compare, arguments.scenario.resolve(), arguments.set, arguments.kills,
                                         arguments.seed, pathlib.Path(folder))
    for what in wrong:
        print("DIFFERS:", what)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
