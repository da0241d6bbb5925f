"""check_links.py finds links to files and headings that are not there."""

import unittest

from small_tree import SmallTree
import check_links


class Links(SmallTree):
    def test_links_that_lead_somewhere(self):
        self.write("README.md", "[a](docs/a.md), [b](docs/a.md#two-words), [c](https://example.org)\n")
        self.write("docs/a.md", "# Two words\n\n`[no](link.md)`\n\n```\n[no](link.md)\n```\n")
        self.write("docs/tutorials/b.md", "[a](../a.md) ![made by a command](b.png)\n")
        self.assertEqual(check_links.violations(self.root), [])

    def test_a_file_that_is_not_there(self):
        self.write("docs/a.md", "[b](b.md) ![c](c.png)\n")
        self.assertEqual(check_links.violations(self.root), ["docs/a.md: b.md is not in the repository", "docs/a.md: c.png is not in the repository"])

    def test_a_heading_that_is_not_there(self):
        self.write("README.md", "# One\n[one](#one) [two](#two)\n")
        self.assertEqual(check_links.violations(self.root), ["README.md: #two: the document has no such heading"])


if __name__ == "__main__":
    unittest.main()
