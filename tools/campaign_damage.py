"""Changes one byte of a file that the command reads, every byte in turn, and looks whether it answers with a clear error or
with the right data: run.h5 (resumed, converted to .h5 and .csv), checkpoint.bin, trajectory.csv and summary.json
(resumed), the scenario (any status but a crash: another scenario may be a right one).

    tools/campaign_damage.py build/release/hamflow             # every byte
    tools/campaign_damage.py build/release/hamflow --every 50  # every 50th, from a random one on"""

import random
import shutil
import sys

from campaign import main

KEPT = ("run.h5", "checkpoint.bin", "trajectory.csv", "summary.json")


def fresh(campaign, name, data):
    """A copy of the base run with another content of one file."""
    shutil.rmtree(campaign.folder / "x", ignore_errors=True)
    shutil.copytree(campaign.folder / "base", campaign.folder / "x")
    (campaign.folder / "x" / name).write_bytes(data)


def resume(campaign, name, data, more, wanted, what):
    fresh(campaign, name, data)
    done = campaign.call("run", "s.toml", "--out", "x", "--resume", "--json", *more)
    if not campaign.judge(done, (0, 3), what):
        return
    if done.returncode != 0:
        return
    right = campaign.same_summary((campaign.folder / wanted / "summary.json").read_text(), done.stdout)
    if not right or (more and not campaign.same_run(wanted, "x")):  # of a complete run nothing but the summary is read
        campaign.complain(what + ": other data than the run's")


def convert(campaign, data, what):
    fresh(campaign, "run.h5", data)
    for name in ("x.csv", "x.h5"):
        (campaign.folder / name).unlink(missing_ok=True)
        done = campaign.call("convert", "x", "--to", "polar", "-o", name)
        if not campaign.judge(done, (0, 3), f"{what}, convert -o {name}", json_expected=False):
            continue
        there = (campaign.folder / name).exists()
        if there != (done.returncode == 0):
            campaign.complain(f"{what}, convert -o {name}: status {done.returncode}, but the file is {'' if there else 'not '}there")
        elif there and name == "x.csv" and (campaign.folder / name).read_bytes() != (campaign.folder / "wanted.csv").read_bytes():
            campaign.complain(f"{what}, convert -o {name}: other data")
        elif there and name == "x.h5" and not campaign.same_samples("wanted.h5", name):
            campaign.complain(f"{what}, convert -o {name}: other data")


def attack(campaign, arguments):
    rng = random.Random(arguments.seed)
    campaign.scenario(steps=60, every=3, checkpoint=20)
    campaign.good("run", "s.toml", "--out", "base")
    more = ("--set", "run.steps=90")
    campaign.good("run", "s.toml", "--out", "longer", *more)
    for name in ("wanted.csv", "wanted.h5"):
        campaign.good("convert", "base", "--to", "polar", "-o", name)
    scenario = (campaign.folder / "s.toml").read_bytes()
    files = {name: (campaign.folder / "base" / name).read_bytes() for name in KEPT} | {"s.toml": scenario}
    for name, good in files.items():
        if arguments.only and name not in arguments.only:
            continue
        for at in range(rng.randrange(arguments.every), len(good), arguments.every):
            data = good[:at] + bytes([good[at] ^ rng.randrange(1, 256)]) + good[at + 1:]
            what = f"{name}, byte {at}: {good[at]} -> {data[at]}"
            campaign.counts["bytes of " + name] += 1
            if name == "s.toml":
                (campaign.folder / "x.toml").write_bytes(data)
                campaign.judge(campaign.call("run", "x.toml", "--out", "none", "--json", "--set", "run.steps=5"), (0, 1, 2), what)
                continue
            resume(campaign, name, data, more, "longer", what)
            if name != "checkpoint.bin":
                resume(campaign, name, data, (), "base", what + ", complete")
            if name == "run.h5":
                convert(campaign, data, what)


def add_arguments(parser):
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--only", action="append", default=[], help="a file; default: all")


if __name__ == "__main__":
    sys.exit(main(__doc__, add_arguments, attack, "damage"))
