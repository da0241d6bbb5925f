"""Sends signals at random moments of a run: INT, TERM and HUP stop it with status 130 and a summary, XFSZ changes nothing,
PIPE and USR1 end it as they end any program. After each the run goes on with --resume, to the bits of an undisturbed one.

    tools/campaign_signals.py build/release/hamflow --signals 20     # of each kind"""

import json
import random
import signal
import subprocess
import sys
import time

from campaign import main

EXPECTED = {signal.SIGINT: 130, signal.SIGTERM: 130, signal.SIGHUP: 130, signal.SIGXFSZ: 0,
            signal.SIGPIPE: -signal.SIGPIPE, signal.SIGUSR1: -signal.SIGUSR1}


def attack(campaign, arguments):
    rng = random.Random(arguments.seed)
    campaign.scenario(steps=400_000, every=101, checkpoint=20_001)
    begin = time.monotonic()
    campaign.good("run", "s.toml", "--out", "wanted")
    seconds = time.monotonic() - begin
    for number, status in EXPECTED.items():
        for attempt in range(arguments.signals):
            folder = f"{number.name}{attempt}"
            process = subprocess.Popen(campaign.words("run", "s.toml", "--out", folder, "--json"), cwd=campaign.folder,
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            while not (campaign.folder / folder / "run.h5").exists():  # signals before it are those of the shell
                time.sleep(0.001)
            time.sleep(rng.uniform(0.005, 0.7 * seconds))
            process.send_signal(number)
            out, errors = process.communicate(timeout=60)
            campaign.counts[number.name] += 1
            if process.returncode not in (status, 0):
                campaign.complain(f"{number.name}: status {process.returncode}, not {status}: {errors}")
            elif process.returncode == 130 and json.loads(out)["status"] != "interrupted":
                campaign.complain(f"{number.name}: a summary that is not interrupted")
            campaign.good("run", "s.toml", "--out", folder, "--resume")
            if not campaign.same_run("wanted", folder):
                campaign.complain(f"{number.name}: the run that went on differs")


if __name__ == "__main__":
    sys.exit(main(__doc__, lambda parser: parser.add_argument("--signals", type=int, default=20), attack, "signals"))
