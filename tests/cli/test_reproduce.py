"""hamflow reproduce: the experiments of both theses; hamflow list experiments, hamflow show ID."""

import json
import pathlib
import signal
import subprocess
import time
import unittest

from command import HAMFLOW, CommandCase

SOME = ["G2.8", "G2.9", "G2.20", "G3.9", "T3.2", "G1.1"]
VERDICTS = ["holds", "differs", "cannot hold", "undecided", "nothing to test"]


class Reproduce(CommandCase):
    def reproduce(self, *args, status=0):
        return self.hamflow("reproduce", *args, status=status)

    def verdicts(self, folder):
        return json.loads((pathlib.Path(self.folder) / folder / "verdicts.json").read_text())

    def test_list_and_show_know_the_experiments(self):
        listed = json.loads(self.hamflow("list", "experiments", "--json").stdout)
        self.assertIn("G2.8", [e["id"] for e in listed])
        self.assertEqual(len({e["id"] for e in listed}), len(listed))
        self.assertIn("Gross, page 42", self.hamflow("show", "G2.8").stdout)
        self.assertIn("did you mean G2.8", self.hamflow("show", "G2.80", status=2).stderr)

    def test_claims_and_their_counts(self):
        found = json.loads(self.reproduce(*SOME, "--quick", "--json").stdout)
        self.assertEqual(found["status"], "done")
        self.assertEqual(found, self.verdicts("reproduce"))
        keys = {"id", "thesis", "page", "statement", "printed", "measured", "uncertainty", "rule", "verdict", "reason"}
        for claim in found["claims"]:
            self.assertLessEqual(keys, set(claim))
            self.assertIn(claim["verdict"], VERDICTS)
        self.assertEqual(list(found["verdicts"]), VERDICTS)
        for verdict, count in found["verdicts"].items():
            self.assertEqual(count, sum(c["verdict"] == verdict for c in found["claims"]))
        by_id = {c["id"]: c["verdict"] for c in found["claims"]}
        self.assertEqual(by_id["G3.9/amplitudes"], "cannot hold")  # ten times too large
        self.assertEqual(by_id["G2.8/energy"], "holds")

    def test_scenarios_of_the_folder_run_by_themselves(self):
        self.reproduce("G2.9", "--quick", "--out", "r")
        done = json.loads(self.hamflow("run", "r/reproduction/G2.9/figure.toml", "--out", "none", "--json").stdout)
        claim = next(c for c in self.verdicts("r")["claims"] if c["id"] == "G2.9/kept")
        self.assertEqual(done["energy"]["max_error"], claim["measured"])

    def test_verdicts_do_not_depend_on_threads(self):
        one = self.reproduce(*SOME, "--quick", "--json", "--threads", "1", "--out", "one").stdout
        self.assertEqual(one, self.reproduce(*SOME, "--quick", "--json", "--threads", "2", "--out", "two").stdout)

    def test_what_is_wrong_is_told_before_anything_runs(self):
        for args, text in [(["G2.80"], "did you mean G2.8"),
                           (["kepler"], "allowed all, gross, sonnleitner"),
                           (["G2.8", "--quick", "--full"], "found --quick with --full"),
                           (["G2.8", "--force", "--resume"], "found --resume with --force"),
                           ([], "experiment is required"),
                           (["G2.8", "--threads", "-1"], "threads")]:
            self.assertIn(text, self.reproduce(*args, status=2).stderr)
        self.assertFalse((pathlib.Path(self.folder) / "reproduce").exists())

    def test_a_folder_is_not_replaced_unasked(self):
        self.reproduce("G1.1", "--quick")
        self.assertIn("--resume", self.reproduce("G1.1", "--quick", status=3).stderr)
        self.reproduce("G1.1", "--quick", "--force")
        (pathlib.Path(self.folder) / "mine").mkdir()
        (pathlib.Path(self.folder) / "mine" / "file").write_text("mine")
        self.assertIn("no reproduction", self.reproduce("G1.1", "--force", "--out", "mine", status=3).stderr)

    def test_a_folder_that_a_kill_left_empty_is_used(self):
        self.reproduce("G1.1", "G2.8", "--quick")
        for name, status in [("G1.1", 0), ("G2.8", 3)]:
            of_experiment = pathlib.Path(self.folder) / "reproduce" / "reproduction" / name
            for file in of_experiment.iterdir():
                file.unlink()
            if status != 0:
                (of_experiment / "mine.txt").write_text("mine")
            self.reproduce("G1.1", "G2.8", "--quick", "--resume", status=status)

    def test_a_kill_loses_nothing_that_was_done(self):
        whole = self.reproduce(*SOME, "--quick", "--json", "--out", "whole").stdout
        for delay, sign in [(0.05, signal.SIGKILL), (0.15, signal.SIGINT), (0.3, signal.SIGKILL)]:
            process = subprocess.Popen([HAMFLOW, "reproduce", *SOME, "--quick", "--json", "--resume", "--out", "cut",
                                        "--threads", "1"], cwd=self.folder, stdout=subprocess.DEVNULL)
            time.sleep(delay)
            process.send_signal(sign)
            self.assertIn(process.wait(), (0, 130, -signal.SIGKILL))
        self.assertEqual(self.reproduce(*SOME, "--quick", "--json", "--resume", "--out", "cut").stdout, whole)


if __name__ == "__main__":
    unittest.main()
