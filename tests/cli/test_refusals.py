"""Requests that would end in a crash are refused before: scenarios nested too deep, sweeps that fit into no memory."""

import json
import resource
import subprocess
import unittest

from command import ELLIPSE, HAMFLOW, CommandCase


class Refusals(CommandCase):
    def test_keys_of_thousands_of_parts(self):
        deep = ".".join(["a"] * 12_000)
        for text in (f"{deep} = 1\n", f"[{deep}]\n", f"[[{deep}]]\n", "x = { " + deep + " = 1 }\n",
                     '"a" . ' * 12_000 + "a = 1\n", "x = " + "[" * 12_000, "x = " + "{a = " * 12_000):
            self.write("deep.toml", ELLIPSE + text)
            done = self.hamflow("run", "deep.toml", "--out", "none", "--json", status=2)
            error = json.loads(done.stdout)["errors"][0]
            self.assertIn("allowed at most", error["message"])
            self.assertEqual(error["line"], len(ELLIPSE.splitlines()) + 1)
        done = self.hamflow("run", "kepler.toml", "--out", "none", "--json", "--set", deep + "=1", status=2)
        self.assertIn("found a path of 12000 parts; allowed at most 16", done.stderr)
        self.hamflow("run", "kepler.toml", "--out", "none", "--set", "problem.orbit={ " + deep + " = 1 }", status=2)

    def test_what_is_deep_in_texts_and_comments_only(self):
        words = "# " + "a." * 100 + "\n"
        lists = "q = [" + ", ".join(["1.5"] * 200) + "]\n"
        self.write("s.toml", words + ELLIPSE + words + '[problem.nothing]\nV = "' + "a." * 100 + '"\n' + lists)
        said = self.hamflow("run", "s.toml", "--out", "none", status=2).stderr
        self.assertNotIn("syntax", said)
        self.assertIn("problem.nothing", said)

    def limited(self, megabytes, *arguments):
        limit = megabytes << 20
        return subprocess.run([HAMFLOW, *arguments], cwd=self.folder, capture_output=True, text=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))

    def test_a_sweep_that_does_not_fit(self):
        done = self.limited(400, "sweep", "kepler.toml", "--vary", "run.dt=0.001:0.01:2000", "--vary", "problem.k=1:2:2000",
                            "--json", "--out", "w")
        self.assertEqual(done.returncode, 2, done.stderr)
        (error,) = json.loads(done.stdout)["errors"]
        self.assertRegex(error["message"], "found 4000000 members of 2 coordinates, .* allowed at most [0-9]+")
        self.assertFalse((self.folder / "w").exists())

    def test_no_memory_at_all(self):
        done = self.limited(70, "run", "kepler.toml", "--json")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(json.loads(done.stdout)["error"]["kind"], "memory")
        self.assertFalse((self.folder / "kepler.run").exists())


if __name__ == "__main__":
    unittest.main()
