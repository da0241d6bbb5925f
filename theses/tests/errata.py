"""Verdicts that are known, of claims of one of the theses."""

import json

from command import CommandCase


class ErrataCase(CommandCase):
    def assert_verdicts(self, expected):
        """By the id of the claim, whose experiments are carried out."""
        ids = sorted({claim.split("/")[0] for claim in expected})
        done = self.hamflow("reproduce", *ids, "--quick", "--out", "reproduction", "--json")
        found = {claim["id"]: claim["verdict"] for claim in json.loads(done.stdout)["claims"]}
        self.assertEqual({claim: found.get(claim) for claim in expected}, expected)
