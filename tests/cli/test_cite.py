"""hamflow cite: the works behind a run, a scenario, a method or a problem, as BibTeX that can be read."""

import json
import re
import unittest

from command import CommandCase


def entries(text):
    """The entries by their keys; every brace is closed."""
    found = {}
    for entry in re.split(r"(?m)^(?=@)", text):
        if not entry.strip():
            continue
        key = re.match(r"@\w+\{(\w+),\n", entry)[1]
        assert entry.count("{") == entry.count("}") and entry.rstrip().endswith("}"), entry
        assert key not in found, key
        found[key] = entry
    return found


class Cite(CommandCase):
    def test_every_method_and_problem(self):
        works = set()
        for kind in ("methods", "problems"):
            for row in json.loads(self.hamflow("list", kind, "--json").stdout):
                cited = entries(self.hamflow("cite", row["name"]).stdout)
                self.assertEqual(next(iter(cited)), "hamflow")
                works |= set(cited)
        self.assertGreater(len(works), 25)

    def test_the_works_of_a_method_in_the_order_of_its_reference(self):
        cited = entries(self.hamflow("cite", "stv4").stdout)
        self.assertEqual(list(cited), ["hamflow", "Sonnleitner2010", "Yoshida1990"])
        self.assertIn("Yoshida, H.", cited["Yoshida1990"])
        self.assertEqual(list(entries(self.hamflow("cite", "cg(2,6)").stdout)),
                         ["hamflow", "Gross1999", "BrugnanoIavernaroTrigiante2010"])

    def test_a_run_and_its_scenario_cite_the_same(self):
        self.write("a.toml", self.hamflow("new", "henon-heiles", "--method", "kahan-li8").stdout)
        self.hamflow("run", "a.toml", "--set", "run.steps=10", "--quiet")
        of_run = self.hamflow("cite", "a.run").stdout
        self.assertEqual(of_run, self.hamflow("cite", "a.toml").stdout)
        self.assertIn("KahanLi1997", entries(of_run))

    def test_wrong_names(self):
        self.assertIn("did you mean stv4?", self.hamflow("cite", "stv5", status=2).stderr)
        self.assertIn("nor a run", self.hamflow("cite", "nothing.run", status=2).stderr)
        (self.folder / "empty").mkdir()
        self.hamflow("cite", "empty", status=3)


if __name__ == "__main__":
    unittest.main()
