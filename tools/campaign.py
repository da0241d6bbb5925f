"""What the campaigns have in common: tiny scenarios, the command in a folder of its own, and what counts as a crash.
A campaign attacks the command many times and counts: tools/campaign_kills.py, _damage.py, _limits.py, _signals.py."""

import argparse
import collections
import json
import pathlib
import subprocess
import tempfile

RUN = """
[problem]
name = "central-force"
potential = "kepler"
orbit = {{ kind = "ellipse", r_per = 1.0, r_aph = 3.0 }}
[method]
name = "stv4"
[run]
dt = 0.01
steps = {steps}
record_every = {every}
checkpoint_every = {checkpoint}
[output]
formats = ["h5", "csv"]
"""
SESSION = "step 300\nsave! saved\nstep 20\nsave! saved\nquit\n"


class Campaign:
    """A folder, the command, and what was counted."""

    def __init__(self, hamflow, folder, compare=None):
        self.hamflow = pathlib.Path(hamflow).resolve()
        self.compare = pathlib.Path(compare or self.hamflow.parent / "tests" / "io" / "compare_runs").resolve()
        self.folder = pathlib.Path(folder)
        self.counts = collections.Counter()
        self.wrong = []

    def scenario(self, name="s.toml", steps=400, every=7, checkpoint=100):
        (self.folder / name).write_text(RUN.format(steps=steps, every=every, checkpoint=checkpoint))
        return name

    def words(self, *arguments):
        return [str(self.hamflow), *map(str, arguments)]

    def call(self, *arguments, timeout=60, **options):
        """The finished process; None where it hung."""
        options.setdefault("cwd", self.folder)
        options.setdefault("input", "")
        try:
            return subprocess.run(self.words(*arguments), capture_output=True, text=True, errors="replace",
                                  timeout=timeout, **options)
        except subprocess.TimeoutExpired:
            return None

    def good(self, *arguments, **options):
        done = self.call(*arguments, **options)
        if done is None or done.returncode != 0:
            raise RuntimeError(f"{arguments}: {done and done.stderr}")
        return done

    def complain(self, what):
        self.counts["wrong"] += 1
        self.wrong.append(what)

    def judge(self, done, allowed, what, json_expected=True):
        """A status that is allowed, no signal, no hang, and an error in JSON where one is asked for."""
        if done is None:
            self.complain(f"{what}: hangs")
            return False
        self.counts[f"status {done.returncode}"] += 1
        if done.returncode not in allowed:
            self.complain(f"{what}: status {done.returncode}: {done.stderr[-300:]}")
            return False
        if json_expected and done.returncode != 0:
            try:
                json.loads(done.stdout)
            except ValueError:
                self.complain(f"{what}: status {done.returncode}, no JSON on stdout: {done.stdout[:200]!r}, "
                              f"{done.stderr[-300:]!r}")
                return False
        return True

    def same_samples(self, wanted, found):
        return subprocess.run([self.compare, wanted, found], cwd=self.folder, capture_output=True).returncode == 0

    def same_summary(self, wanted, found):
        def kept(text):
            return {key: value for key, value in json.loads(text).items() if "second" not in key}
        try:
            return kept(wanted) == kept(found)
        except ValueError:
            return False

    def same_run(self, wanted, found):
        wanted, found = self.folder / wanted, self.folder / found
        return (self.same_samples(wanted / "run.h5", found / "run.h5")
                and (wanted / "trajectory.csv").read_bytes() == (found / "trajectory.csv").read_bytes()
                and self.same_summary((wanted / "summary.json").read_text(), (found / "summary.json").read_text()))

    def report(self, name):
        counts = ", ".join(f"{key}: {value}" for key, value in sorted(self.counts.items()) if key != "wrong")
        print(f"{name}: {counts}; wrong: {len(self.wrong)}")
        for what in self.wrong[:20]:
            print("WRONG:", what)
        return 1 if self.wrong else 0


def main(description, add_arguments, attack, name):
    """The command line of a campaign."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hamflow", type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--compare", type=pathlib.Path, help="the program compare_runs; default: in the build of hamflow")
    add_arguments(parser)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        campaign = Campaign(arguments.hamflow, folder, arguments.compare)
        attack(campaign, arguments)
        return campaign.report(name)
