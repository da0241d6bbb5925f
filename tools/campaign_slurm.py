"""Runs a sweep as a real job array of Slurm on this machine, kills one task, runs the array again, and compares the
merged table with that of one process.

    python3 tools/campaign_slurm.py build/release/hamflow [--tasks 6]

It needs root and Debian's packages slurm-wlm and munge. The daemons have a configuration of their own, in a temporary
folder, and end with the script.
"""

import argparse
import contextlib
import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time

SCENARIO = """
[problem]
name = "henon-heiles"
initial = { q = [0.1, 0.1], p = [0.2, 0.3] }
[method]
name = "stv4"
[run]
dt = 0.05
steps = 4000000
"""
VARY = ("--vary", "problem.initial.q[1]=-0.2:0.2:60")
CONFIGURATION = """
ClusterName=one
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SlurmUser=root
SlurmdUser=root
SlurmctldPort=16817
SlurmdPort=16818
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ReturnToService=2
SelectType=select/cons_tres
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


@contextlib.contextmanager
def slurm(folder):
    """The daemons of Slurm with one node. Yields the environment of its commands."""
    host = socket.gethostname().split(".")[0]
    for name in ("state", "spool"):
        (folder / name).mkdir()
    (folder / "slurm.conf").write_text(CONFIGURATION.format(host=host, folder=folder, cpus=os.cpu_count()))
    key = folder / "munge.key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o400)
    folder.chmod(0o755)
    env = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}
    daemons = []
    try:
        for words in (("munged", "-F", "--force", f"--socket={folder}/munge.socket", f"--key-file={key}",
                       f"--pid-file={folder}/munge.pid", f"--log-file={folder}/munge.log", f"--seed-file={folder}/seed"),
                      ("slurmctld", "-D"), ("slurmd", "-D", "-N", host)):
            daemons.append(subprocess.Popen(words, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
            time.sleep(2)
        end = time.monotonic() + 120
        while "idle" not in subprocess.run(["sinfo", "-h", "-o", "%t"], env=env, capture_output=True, text=True).stdout:
            if time.monotonic() > end:
                raise RuntimeError("Slurm's node is not idle after 120 s\n" + (folder / "slurmctld.log").read_text()[-2000:] +
                                   (folder / "slurmd.log").read_text()[-2000:])
            time.sleep(1)
        yield env
    finally:
        for daemon in reversed(daemons):
            daemon.terminate()
        for daemon in daemons:
            daemon.wait()


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("hamflow")
    options.add_argument("--tasks", type=int, default=6)
    asked = options.parse_args()
    hamflow = str(pathlib.Path(asked.hamflow).resolve())
    for program in ("slurmctld", "slurmd", "munged", "sbatch"):
        if shutil.which(program) is None:
            sys.exit(f"{program} is missing; install the packages slurm-wlm and munge")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "s.toml").write_text(SCENARIO)
        job = folder / "job.sh"
        job.write_text(f"#!/bin/bash\n#SBATCH --array=0-{asked.tasks - 1} --output={folder}/task-%a.log\n"
                       f"cd {folder}\n{hamflow} sweep s.toml {' '.join(VARY)} --out big.sweep --shard auto --resume --threads 1 --quiet\n")
        (folder / "slurm").mkdir()
        with slurm(folder / "slurm") as env:

            def submit():
                return subprocess.run(["sbatch", "--parsable", job], env=env, check=True, capture_output=True,
                                      text=True).stdout.strip()

            def wait(number):
                while subprocess.run(["squeue", "-h", "-j", number], env=env, capture_output=True, text=True).stdout.strip():
                    time.sleep(1)

            first = submit()
            journal = folder / "big.sweep" / f"shard-0-of-{asked.tasks}" / "members.bin"
            end = time.monotonic() + 300
            while not journal.exists() and time.monotonic() < end:
                time.sleep(0.1)
            subprocess.run(["scancel", f"{first}_0"], env=env, check=True)
            wait(first)
            merged = subprocess.run([hamflow, "sweep", "--merge", "big.sweep", "--json"], cwd=folder, capture_output=True,
                                    text=True)
            found = json.loads(merged.stdout)
            print(f"after the first array, of which task 0 was cancelled: {found['done']} of {found['members']} members done")
            wait(submit())
        print("\n".join(log.read_text() for log in sorted(folder.glob("task-*.log")) if "error" in log.read_text()))
        subprocess.run([hamflow, "sweep", "--merge", "big.sweep", "--quiet"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        subprocess.run([hamflow, "sweep", "s.toml", *VARY, "--out", "whole", "--quiet"], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
        equal = (folder / "big.sweep/sweep.h5").read_bytes() == (folder / "whole/sweep.h5").read_bytes()
        print(f"{asked.tasks} tasks, merged table and table of one process:", "equal to the byte" if equal else "DIFFERENT")
        sys.exit(0 if equal else 1)


if __name__ == "__main__":
    main()
