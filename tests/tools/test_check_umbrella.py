"""check_umbrella.py finds a header that hamflow.hpp lacks, and a line that names none."""

import unittest

from small_tree import SmallTree
import check_umbrella


class Umbrella(SmallTree):
    def setUp(self):
        super().setUp()
        self.write("include/hamflow/core/vector.hpp")
        self.write("include/hamflow/detail/methods/implicit/newton.hpp")
        self.write("include/hamflow/hamflow.hpp", check_umbrella.expected(self.root))

    def test_a_complete_list_passes(self):
        self.assertEqual(check_umbrella.violations(self.root), [])
        self.assertIn('#include "hamflow/core/vector.hpp"', check_umbrella.expected(self.root))
        self.assertNotIn("newton.hpp", check_umbrella.expected(self.root))  # what no user includes
        self.assertNotIn("hamflow/hamflow.hpp", check_umbrella.expected(self.root))

    def test_a_new_header_is_missed(self):
        self.write("include/hamflow/core/dual.hpp")
        self.assertEqual(check_umbrella.violations(self.root), ['lacks #include "hamflow/core/dual.hpp"'])

    def test_a_header_that_went(self):
        (self.root / "include/hamflow/core/vector.hpp").unlink()
        self.assertEqual(check_umbrella.violations(self.root), ['has a wrong line: #include "hamflow/core/vector.hpp"'])


if __name__ == "__main__":
    unittest.main()
