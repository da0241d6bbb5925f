"""check_citations.py catches each kind of citation that leads nowhere, and nothing else."""

import unittest

from small_tree import SmallTree
import check_citations

BIB = "@book{HLW2006,\n  year = {2006}\n}\n@misc{DLMF,\n  url = {https://dlmf.nist.gov}\n}\n@techreport{RFC4180,\n}\n"
SOUND = """// Verlet.   [HLW2006, Sect. I.1.4; DLMF,
// Sect. 19.2] Why: docs/design.md. A field.   [RFC4180]
// The data of September 5, 1994. Over 2000 steps with x[i] and f[table, hessians].
const char* reference = "HLW2006, (1.9)";
"""


class Citations(SmallTree):
    def setUp(self):
        super().setUp()
        self.write("docs/references.bib", BIB)
        self.write("docs/design.md", "# Design\n")
        self.write("src/run/run.cpp", SOUND)

    def wrong(self, text: str, *parts: str, name: str = "src/run/more.cpp"):
        """A file with this text has exactly one violation, whose words include these."""
        self.write(name, text)
        found = check_citations.violations(self.root)
        self.assertEqual(len(found), 1, found)
        for part in (name, *parts):
            self.assertIn(part, found[0])

    def test_a_sound_tree_passes(self):
        self.assertEqual(check_citations.violations(self.root), [])

    def test_an_unknown_key_in_a_comment(self):
        self.wrong("// Verlet.   [HLW2002, Sect. I.1.4; HLW2006]\n", "HLW2002 is not in")

    def test_an_unknown_key_in_a_declared_reference(self):
        self.wrong('    .reference = "Nobody1999, (2.1)",\n', "Nobody1999 is not in")

    def test_an_unknown_key_in_a_document(self):
        self.wrong("Orbits [Nobody1999].\n", "Nobody1999 is not in", name="docs/orbits.md")

    def test_an_unknown_rfc(self):
        self.wrong("// [RFC9999]\n", "RFC9999 is not in")

    def test_names_and_a_year_instead_of_a_key(self):
        for text in ('"Hairer, Lubich, Wanner 2006, I.1"', "// (Boris 1970)", "// as Jorba and Zou (2005)", "// [Lo,\n// Kay 1988]"):
            with self.subTest(text):
                self.wrong(text, "names a work without the key")

    def test_an_rfc_without_a_key(self):
        self.wrong("// A field of RFC 4180.\n", "'RFC 4180'")

    def test_a_place_in_a_work_without_a_key(self):
        for text in ("// [Golub and Van Loan, Sect. 3.4]", "// [spec: methods]", "// [the thesis,\n// p. 12]",
                     "// [HLW2006, Sect. VI.2; Arnold, Sect. 42]", "// [Abramowitz, Stegun, 26.7.3]"):
            with self.subTest(text):
                self.wrong(text, "names a place in a work without a key")

    def test_a_numbered_section_of_nothing(self):
        self.wrong("// The class by the rule of methods,\n// section 1.\n", "'section 1'")

    def test_a_document_that_is_not_there(self):
        self.wrong("// What is meant: spec/methods.md.\n", "spec/methods.md is not in the repository")

    def test_an_entry_that_nobody_cites(self):
        self.write("docs/references.bib", BIB + "@book{Nobody1999,\n}\n")
        self.assertEqual(check_citations.violations(self.root), ["docs/references.bib: Nobody1999 is cited nowhere"])

    def test_an_entry_that_stands_twice(self):
        self.write("docs/references.bib", BIB + BIB[:30])
        self.assertEqual(check_citations.violations(self.root), ["docs/references.bib: HLW2006 stands there twice"])


if __name__ == "__main__":
    unittest.main()
