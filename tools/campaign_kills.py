"""Kills run, sweep, convert and shell at random moments (kill -9), and compares what stands in the end, or is left, with
what an undisturbed command leaves: each file whole, or not there, or the one that was there before. Runs are resumed.

    tools/campaign_kills.py build/release/hamflow --kills 125     # of each of the four"""

import random
import shutil
import subprocess
import sys
import time

from campaign import SESSION, main
from kill_and_resume import kill_and_resume


def killed(campaign, words, seconds, rng, text=""):
    """Whether the command was killed before its end."""
    process = subprocess.Popen(campaign.words(*words), cwd=campaign.folder, stdin=subprocess.PIPE, text=True,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        process.stdin.write(text)
        process.stdin.close()
        process.wait(timeout=rng.uniform(0, seconds))
        return False
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        return True


def seconds_of(campaign, words, **options):
    campaign.good(*words, **options)
    begin = time.monotonic()
    campaign.good(*words, **options)
    return time.monotonic() - begin


def kill_runs(campaign, kills, rng):
    campaign.scenario("run.toml", steps=150_000, every=101, checkpoint=7001)
    room = campaign.folder / "runs"
    room.mkdir()
    count, _, compared, wrong = kill_and_resume(campaign.hamflow, campaign.compare, campaign.folder / "run.toml", [], kills,
                                                rng.random(), room, say=lambda text: None)
    campaign.counts["kills of run"] += count
    campaign.counts["runs compared"] += compared
    for what in wrong:
        campaign.complain("run: " + what)


def kill_sweeps(campaign, kills, rng):
    campaign.scenario("sweep.toml", steps=2000)
    words = ["sweep", "sweep.toml", "--vary", "run.dt=0.001:0.01:40", "--json", "--out"]
    seconds = seconds_of(campaign, [*words, "wanted.sweep", "--force"])
    wanted = campaign.folder / "wanted.sweep"
    found = campaign.folder / "found.sweep"
    while campaign.counts["kills of sweep"] < kills:
        shutil.rmtree(found, ignore_errors=True)
        for _ in range(rng.randint(1, 5)):
            goes_on = [*words, "found.sweep", "--resume", "--threads", rng.choice("12"), "--lanes", rng.choice(["auto", "none"])]
            campaign.counts["kills of sweep"] += killed(campaign, goes_on, 1.05 * seconds, rng)
            compare_rows(campaign, wanted, found)
        campaign.good(*words, "found.sweep", "--resume")
        campaign.counts["sweeps compared"] += 1
        for name in ("sweep.h5", "sweep.csv"):
            if (found / name).read_bytes() != (wanted / name).read_bytes():
                campaign.complain(f"{name} differs")
        if sorted(p.name for p in wanted.iterdir()) != sorted(p.name for p in found.iterdir()):
            campaign.complain("sweep: files are missing, or too many")


def compare_rows(campaign, wanted, found):
    """What a kill leaves: the rows of members that were finished, and no half written file."""
    if (found / "sweep.csv").exists():
        lines = (wanted / "sweep.csv").read_text().splitlines()
        left = (found / "sweep.csv").read_text().splitlines()
        if len(lines) != len(left) or any(a != b and "not_run" not in b for a, b in zip(lines, left)):
            campaign.complain("sweep.csv has rows that differ")
    if (found / "summary.json").exists() and not (found / "summary.json").read_text().endswith("}\n"):
        campaign.complain("summary.json of a sweep is half written")


def kill_conversions(campaign, kills, rng):
    campaign.scenario("convert.toml", steps=20_000, every=10, checkpoint=100_000)
    campaign.good("run", "convert.toml", "--out", "convert.run")
    for name in ("x.h5", "x.csv"):
        words = ["convert", "convert.run", "--to", "polar", "-o", name]
        seconds = seconds_of(campaign, words)
        target = campaign.folder / name
        wanted = campaign.folder / ("wanted" + target.suffix)
        shutil.copy(target, wanted)
        before = campaign.counts["kills of convert"]
        while campaign.counts["kills of convert"] < before + kills / 2:
            target.write_text("old")
            campaign.counts["kills of convert"] += killed(campaign, words, 1.05 * seconds, rng)
            whole = (target.read_bytes() == b"old" or
                     (campaign.same_samples(wanted, target) if name == "x.h5" else
                      target.read_bytes() == wanted.read_bytes()))
            if not whole:
                campaign.complain(f"{name} of convert is neither the old one nor the new one")


def kill_shells(campaign, kills, rng):
    campaign.scenario("shell.toml", steps=1000, every=1)
    words = ["shell", "shell.toml"]
    for text in (SESSION, SESSION.replace("step 20\nsave! saved\n", "")):
        campaign.good(*words, input=text)
        shutil.copytree(campaign.folder / "saved", campaign.folder / f"wanted{len(text)}")
    seconds = seconds_of(campaign, words, input=SESSION)
    wanted = list(campaign.folder.glob("wanted[0-9]*"))
    saved = campaign.folder / "saved"
    while campaign.counts["kills of shell"] < kills:
        campaign.counts["kills of shell"] += killed(campaign, words, 1.05 * seconds, rng, SESSION)
        if (saved / "run.h5").exists() and not any(
                campaign.same_samples(w / "run.h5", saved / "run.h5") for w in wanted):
            campaign.complain("run.h5 of a shell differs")
        if (saved / "trajectory.csv").exists() and not any(
                (w / "trajectory.csv").read_bytes() == (saved / "trajectory.csv").read_bytes() for w in wanted):
            campaign.complain("trajectory.csv of a shell differs")


def attack(campaign, arguments):
    rng = random.Random(arguments.seed)
    for kill in (kill_runs, kill_sweeps, kill_conversions, kill_shells):
        kill(campaign, arguments.kills, rng)


if __name__ == "__main__":
    sys.exit(main(__doc__, lambda parser: parser.add_argument("--kills", type=int, default=125), attack, "kills"))
