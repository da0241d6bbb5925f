"""check_layers.py catches each kind of wrong include, and nothing else."""

import unittest

from small_tree import SmallTree
import check_layers

PICTURE = """
```layers
core
problems      -> core
methods       -> core
run           -> methods
hamflow.hpp   -> problems, run

src/scenario  -> problems, run
src/io        -> src/scenario
apps          -> src/io
```
"""


class Layers(SmallTree):
    def setUp(self):
        super().setUp()
        self.write("HACKING.md", PICTURE)
        self.write("include/hamflow/hamflow.hpp", '#include "hamflow/problems/kepler.hpp"\n')
        self.write("include/hamflow/core/vector.hpp")
        self.write("include/hamflow/problems/kepler.hpp", '#include "hamflow/core/vector.hpp"\n')
        self.write("include/hamflow/methods/splitting.hpp")
        self.write("include/hamflow/run/simulation.hpp", '#include "hamflow/core/vector.hpp"\n')  # by way of methods
        self.write("src/scenario/scenario.hpp", '#include "hamflow/run/simulation.hpp"\n')
        self.write("src/io/summary.hpp", '#include "scenario.hpp"\n#include <vector>\n')
        self.write("src/io/summary.cpp", '#include "summary.hpp"\n')
        self.write("apps/hamflow/main.cpp", '#include "summary.hpp"\n')

    def wrong(self, *parts: str):
        """Exactly one violation, whose text has these parts."""
        found = check_layers.violations(self.root)
        self.assertEqual(len(found), 1, found)
        for part in parts:
            self.assertIn(part, found[0])

    def test_a_sound_tree_passes(self):
        self.assertEqual(check_layers.violations(self.root), [])

    def test_a_header_includes_upwards(self):
        self.write("include/hamflow/core/vector.hpp", '#include "hamflow/run/simulation.hpp"\n')
        self.wrong("core/vector.hpp", "run/simulation.hpp", "core may include nothing else")

    def test_problems_and_methods_know_nothing_of_each_other(self):
        self.write("include/hamflow/methods/splitting.hpp", '#include "hamflow/problems/kepler.hpp"\n')
        self.wrong("methods/splitting.hpp", "methods may include core")

    def test_a_source_file_includes_upwards_by_bare_name(self):
        self.write("src/scenario/scenario.cpp", '  #  include "summary.hpp"\n')
        self.wrong("src/scenario/scenario.cpp", "src/io/summary.hpp")

    def test_include_does_not_reach_into_src(self):
        self.write("include/hamflow/run/simulation.hpp", '#include "scenario.hpp"\n')
        self.wrong("run/simulation.hpp", "src/scenario/scenario.hpp")

    def test_include_does_not_reach_into_src_by_a_path(self):
        self.write("include/hamflow/run/simulation.hpp", '#include "../../../src/scenario/scenario.hpp"\n')
        self.wrong("run/simulation.hpp", "src/scenario/scenario.hpp")

    def test_angle_brackets_are_read_too(self):
        self.write("include/hamflow/core/vector.hpp", "#include <hamflow/run/simulation.hpp>\n")
        self.wrong("core/vector.hpp", "run/simulation.hpp")

    def test_a_name_of_two_headers(self):
        self.write("src/scenario/summary.hpp")
        self.wrong("apps/hamflow/main.cpp", "src/io/summary.hpp and src/scenario/summary.hpp")

    def test_a_name_of_no_header(self):
        self.write("src/io/summary.cpp", '#include "sumary.hpp"\n')
        self.wrong("src/io/summary.cpp", '"sumary.hpp" names nothing')

    def test_headers_that_cmake_writes_are_known(self):
        self.write("src/io/summary.cpp", '#include "list.hpp"\n')
        self.wrong('"list.hpp" names nothing')
        self.write("cmake/list.cmake", 'file(CONFIGURE OUTPUT "${generated}/list.hpp" CONTENT "")\n')
        self.assertEqual(check_layers.violations(self.root), [])
        self.write("src/io/summary.cpp", '#include "more.hpp"\n')
        self.write("src/io/CMakeLists.txt", 'file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/more.hpp" CONTENT "")\n')
        self.assertEqual(check_layers.violations(self.root), [])

    def test_a_layer_without_a_line(self):
        self.write("src/extra/extra.cpp")
        self.wrong("src/extra/extra.cpp", "no line in HACKING.md")

    def test_a_picture_with_a_cycle(self):
        self.write("HACKING.md", PICTURE.replace("\ncore\n", "\ncore -> run\n"))
        with self.assertRaisesRegex(SystemExit, "run has no line above that of core"):
            check_layers.violations(self.root)

    def test_a_missing_picture(self):
        self.write("HACKING.md", "# Hacking\n")
        with self.assertRaisesRegex(SystemExit, "no block"):
            check_layers.violations(self.root)


if __name__ == "__main__":
    unittest.main()
