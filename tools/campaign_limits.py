"""Runs run, sweep, convert and shell against limits that grow step by step: the size of a file, a full disk (a tmpfs, as
root), memory, and processes (as a user who is not root). Each has to end with its status, an error and, where asked for, JSON; never
by a crash or a hang; what was there before is there afterwards, or what is new, whole. A run that was stopped so goes on
without the limit to the bits of an undisturbed one.

    tools/campaign_limits.py build/release/hamflow --steps 100     # of each limit and command"""

import os
import resource
import shutil
import subprocess
import sys

from campaign import SESSION, main

SWEEP = ("sweep", "s.toml", "--vary", "run.dt=0.001:0.01:300", "--json", "--threads", "2", "--out", "x.sweep")
CONVERT = ("convert", "base", "--to", "polar", "-o")
ALLOWED = (0, 1, 2, 3)


def limited(kind, value):
    return lambda: resource.setrlimit(kind, (value, value))


def check_whole(campaign, what):
    """The files of others are as they were, or whole."""
    x = campaign.folder
    for name in ("x.h5", "x.csv"):
        data = (x / name).read_bytes()
        if data != b"old" and not (campaign.same_samples("wanted.h5", name) if name == "x.h5"
                                   else data == (x / "wanted.csv").read_bytes()):
            campaign.complain(f"{what}: {name} is neither the old one nor the new one")
    if (x / "x.sweep" / "sweep.h5").exists() and not campaign.same_samples("wanted.sweep/sweep.h5", "x.sweep/sweep.h5"):
        campaign.complain(f"{what}: sweep.h5 differs")
    if (x / "saved" / "run.h5").exists() and not campaign.same_samples("wanted.saved/run.h5", "saved/run.h5"):
        campaign.complain(f"{what}: run.h5 of a shell differs")


def each_command(campaign, what, **options):
    """All four under one limit."""
    for name in ("x.run", "x.sweep", "saved"):
        shutil.rmtree(campaign.folder / name, ignore_errors=True)
    for name in ("x.h5", "x.csv"):
        (campaign.folder / name).write_text("old")
    done = campaign.call("run", "s.toml", "--out", "x.run", "--json", **options)
    campaign.judge(done, ALLOWED, f"{what}, run")
    campaign.judge(campaign.call(*SWEEP, **options), ALLOWED, f"{what}, sweep")
    left = campaign.folder / "x.sweep" / "members.bin"
    goes_on = "--resume" if left.exists() else "--force"  # where not even that could be written, there is nothing to go on from
    campaign.judge(campaign.call(*SWEEP, goes_on), (0,), f"{what}, the sweep that goes on")
    for name in ("x.h5", "x.csv"):
        campaign.judge(campaign.call(*CONVERT, name, **options), ALLOWED, f"{what}, convert", json_expected=False)
    session = campaign.call("shell", "s.toml", **options, input=SESSION.replace("step 20\nsave! saved\n", ""))
    campaign.judge(session, ALLOWED, f"{what}, shell", json_expected=False)
    check_whole(campaign, what)
    again = campaign.call("run", "s.toml", "--out", "x.run", "--resume", "--json")
    if campaign.judge(again, (0,), f"{what}, the run that goes on") and not campaign.same_run("wanted.run", "x.run"):
        campaign.complain(f"{what}: the run that goes on differs")


def sizes(most, steps):
    return sorted({int(most * (i / steps) ** 2) for i in range(steps + 1)})


def file_sizes(campaign, arguments):
    for size in sizes(1.1 * max(p.stat().st_size for p in campaign.folder.rglob("*.h5")), arguments.steps):
        campaign.counts["file sizes"] += 1
        each_command(campaign, f"file size {size}", preexec_fn=limited(resource.RLIMIT_FSIZE, size))


def memory(campaign, arguments):
    """From what --version needs to what everything needs."""
    def works(megabytes):
        done = campaign.call("--version", preexec_fn=limited(resource.RLIMIT_AS, megabytes << 20))
        return done is not None and done.returncode == 0
    least = next(m for m in range(1, 4096) if works(m))
    for i in range(arguments.steps):
        kilobytes = (least << 10) + i * (48 << 10) // arguments.steps
        campaign.counts["memory limits"] += 1
        each_command(campaign, f"memory {kilobytes} kB", preexec_fn=limited(resource.RLIMIT_AS, kilobytes << 10))


def full_disks(campaign, arguments):
    """On a small file system of its own, which takes root."""
    small = campaign.folder / "small"
    small.mkdir()
    for size in range(4, 4 + 4 * arguments.steps, 4):
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}k", "tmpfs", small], capture_output=True)
        if mounted.returncode != 0:
            print("limits: no file system can be mounted here: full disks are left out")
            return
        try:
            campaign.counts["full disks"] += 1
            for words in (("run", "../s.toml", "--out", "x.run", "--json"),
                          ("sweep", "../s.toml", *SWEEP[2:]), ("convert", "../base", "--to", "polar", "-o", "x.h5"),
                          ("convert", "../base", "--to", "polar", "-o", "x.csv")):
                done = campaign.call(*words, cwd=small)
                campaign.judge(done, (0, 3), f"disk of {size} kB, {words[0]}", json_expected=words[0] != "convert")
                left = [p.name for p in small.iterdir() if p.name.endswith(".part")]
                if left or (done and done.returncode != 0 and (small / words[-1]).is_file()):
                    campaign.complain(f"disk of {size} kB, {words[0]}: leaves {left or words[-1]}")
                if (small / "x.run").exists():
                    shutil.rmtree(campaign.folder / "x.run", ignore_errors=True)
                    shutil.move(small / "x.run", campaign.folder / "x.run")
                    again = campaign.call("run", "s.toml", "--out", "x.run", "--resume", "--json")
                    if campaign.judge(again, (0,), f"disk of {size} kB, resumed") and not campaign.same_run("wanted.run", "x.run"):
                        campaign.complain(f"disk of {size} kB: the run that goes on differs")
                for p in small.iterdir():
                    shutil.rmtree(p) if p.is_dir() else p.unlink()
        finally:
            subprocess.run(["umount", small], check=True)


def processes(campaign, arguments):
    """Threads that cannot be started. A limit binds a user who is not root, and counts all processes of that user."""
    if os.geteuid() != 0:
        print("limits: processes are limited as root only: left out")
        return
    number = 54321
    os.chmod(campaign.folder, 0o777)
    bodies = campaign.folder / "bodies.toml"
    bodies.write_text("""
[problem]
name = "n-body"
masses = [1, 1, 1]
softening = 0.1
initial = { q = [0, 0, 1, 0, 0, 1], p = [0, 0.1, 0, 0.2, 0.3, 0] }
[method]
name = "stv4"
[run]
dt = 0.01
steps = 100
arithmetic = "lattice"
threads = 8
""")
    bodies.chmod(0o644)
    (campaign.folder / "s.toml").chmod(0o644)
    one = campaign.good("run", "bodies.toml", "--out", "none", "--json", "--set", "run.threads=1")
    command = campaign.hamflow
    campaign.hamflow = campaign.folder / "hamflow"  # where any user may execute it
    shutil.copy(command, campaign.hamflow)
    campaign.hamflow.chmod(0o755)
    try:
        limited_processes(campaign, arguments, number, one)
    except (PermissionError, subprocess.SubprocessError) as error:
        print(f"limits: no other user may be played here, processes are left out: {error}")
    finally:
        campaign.hamflow = command


def limited_processes(campaign, arguments, number, one):
    """Of the user with this number, who has fewer and more processes than the command asks for."""
    for limit in range(1, min(arguments.steps, 12) + 1):
        def as_nobody(limit=limit):
            resource.setrlimit(resource.RLIMIT_NPROC, (limit, limit))
            os.setgid(number)
            os.setuid(number)
        campaign.counts["process limits"] += 1
        done = campaign.call("run", "bodies.toml", "--out", "none", "--json", preexec_fn=as_nobody, timeout=20)
        if campaign.judge(done, (0, 2), f"{limit} processes, run") and (done.returncode == 0) != (limit >= 8):
            campaign.complain(f"{limit} processes, run: status {done.returncode}")
        if done and done.returncode == 0 and not campaign.same_summary(one.stdout, done.stdout):
            campaign.complain(f"{limit} processes: other data")
        done = campaign.call("sweep", "s.toml", "--vary", "run.dt=0.001:0.01:300", "--json", "--threads", "8", "--out", "none",
                             preexec_fn=as_nobody, timeout=20)
        campaign.judge(done, (0, 2), f"{limit} processes, sweep")


LIMITS = {"file-size": file_sizes, "memory": memory, "disk": full_disks, "processes": processes}


def attack(campaign, arguments):
    campaign.scenario(steps=2000, every=3, checkpoint=200)
    campaign.good("run", "s.toml", "--out", "base")
    shutil.copytree(campaign.folder / "base", campaign.folder / "wanted.run")
    campaign.good(*SWEEP)
    shutil.move(campaign.folder / "x.sweep", campaign.folder / "wanted.sweep")
    for name in ("wanted.h5", "wanted.csv"):
        campaign.good(*CONVERT, name)
    campaign.good("shell", "s.toml", input=SESSION.replace("step 20\nsave! saved\n", ""))
    shutil.move(campaign.folder / "saved", campaign.folder / "wanted.saved")
    for name in arguments.only or LIMITS:
        LIMITS[name](campaign, arguments)


def add_arguments(parser):
    parser.add_argument("--steps", type=int, default=40)
    parser.add_argument("--only", action="append", default=[], choices=LIMITS, help="one limit; default: all")


if __name__ == "__main__":
    sys.exit(main(__doc__, add_arguments, attack, "limits"))
