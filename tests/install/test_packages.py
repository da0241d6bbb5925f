"""What each component installs, and what CMake projects of others find: find_package with versions and components, and
add_subdirectory."""

import os
import pathlib
import re
import shutil
import subprocess
import unittest

from documents import BUILD, PREFIX, ROOT, WORK

FOLDER = WORK / "packages"
COMPILER = os.environ["COMPILER"]
VERSION = re.search(r'HAMFLOW_VERSION "(.*)"', (ROOT / "include/hamflow/core/version.hpp").read_text())[1]
MAJOR, MINOR, PATCH = map(int, VERSION.split("."))
PROGRAM = """#include "hamflow/run/catalog.hpp"
int main() { return hamflow::find_method("verlet").name != "verlet"; }
"""


def run(*command) -> subprocess.CompletedProcess:
    return subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)


def files_of(folder: pathlib.Path) -> set[str]:
    return {str(file.relative_to(folder)) for file in folder.rglob("*") if not file.is_dir()}


def configured(name: str, text: str, *options: str) -> tuple[pathlib.Path, subprocess.CompletedProcess]:
    folder = FOLDER / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(outside CXX)\n" + text)
    (folder / "outside.cpp").write_text(PROGRAM)
    return folder, run("cmake", "-S", folder, "-B", folder / "build", "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={COMPILER}",
                       f"-DCMAKE_PREFIX_PATH={PREFIX}", *options)


class Components(unittest.TestCase):
    """A package is a component, so no file may be in two, and none that an installation has may be in no package."""

    def test_every_installed_file_is_in_one_component(self):
        files = {}
        for component in ("command", "development", "python"):
            prefix = FOLDER / component
            shutil.rmtree(prefix, ignore_errors=True)
            done = run("cmake", "--install", BUILD, "--component", component, "--prefix", prefix)
            self.assertEqual(done.returncode, 0, done.stdout[-2000:])
            files[component] = files_of(prefix)
            shutil.rmtree(prefix, ignore_errors=True)
        for one, other in (("command", "development"), ("command", "python"), ("development", "python")):
            self.assertEqual(files[one] & files[other], set())
        together = files["command"] | files["development"] | files["python"]
        self.assertEqual({file for file in files_of(PREFIX) if "__pycache__" not in file} - together, set())
        self.assertIn("bin/hamflow", files["command"])
        self.assertIn("share/doc/hamflow/examples/kepler_ellipse.toml", files["command"])
        for name in ("include/hamflow/hamflow.hpp", "lib/libhamflow.a", "lib/cmake/hamflow/hamflowConfig.cmake"):
            self.assertIn(name, files["development"])
        self.assertFalse({file for file in files["development"] if file.startswith("bin/")})


class FindPackage(unittest.TestCase):
    def test_versions(self):
        """Before 1.0 programs of another minor version are refused, and those of a later patch."""
        asked = {f"{MAJOR}.{MINOR}": 1, VERSION: 1, f"{MAJOR}.{MINOR}.{PATCH + 1}": 0, f"{MAJOR}.{MINOR + 1}": 0, f"{MAJOR + 1}.0": 0}
        if MINOR:
            asked[f"{MAJOR}.{MINOR - 1}"] = 0
        text = "".join(f'find_package(hamflow {version} QUIET)\nmessage("asked {version} found ${{hamflow_FOUND}}")\n' for version in asked)
        _, done = configured("versions", text)
        found = {version: int(found) for version, found in re.findall(r"asked (\S+) found (\d)", done.stdout)}
        self.assertEqual(found, asked, done.stdout)

    def test_components(self):
        """A component needs its own dependencies alone: here toml++ and fmt cannot be found."""
        without = ("-DCMAKE_DISABLE_FIND_PACKAGE_fmt=ON", "-DCMAKE_DISABLE_FIND_PACKAGE_tomlplusplus=ON")
        link = "add_executable(outside outside.cpp)\ntarget_link_libraries(outside hamflow::core hamflow::ensemble)\n"
        folder, done = configured("core", "find_package(hamflow REQUIRED COMPONENTS core ensemble)\n" + link, *without)
        self.assertEqual(done.returncode, 0, done.stdout)
        done = run("cmake", "--build", folder / "build")
        self.assertEqual(done.returncode, 0, done.stdout[-3000:])
        self.assertEqual(run(folder / "build/outside").returncode, 0)
        _, done = configured("workflow", "find_package(hamflow REQUIRED COMPONENTS workflow)\n", *without)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("fmt", done.stdout)
        _, done = configured("unknown", "find_package(hamflow REQUIRED COMPONENTS core laboratory)\n")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn('hamflow has no component "laboratory"; allowed: core, ensemble, verify, figures, workflow',
                      " ".join(done.stdout.split()))


class AddSubdirectory(unittest.TestCase):
    def test_names_are_those_of_the_package(self):
        """The library is not compiled once more: the project is configured, and a program compiled."""
        text = (f"add_subdirectory({ROOT} hamflow EXCLUDE_FROM_ALL)\nadd_executable(outside outside.cpp)\n"
                "target_link_libraries(outside hamflow::hamflow)\n"
                "foreach(part hamflow core ensemble verify figures workflow)\n"
                "  if(NOT TARGET hamflow::${part})\n    message(FATAL_ERROR \"no target hamflow::${part}\")\n  endif()\nendforeach()\n")
        folder, done = configured("inside", text)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:])
        ninja = (folder / "build/build.ninja").read_text()
        self.assertNotRegex(ninja, r"build \S*(test_unit|hamflow_bench|hamflow_static_command)\b")
        self.assertRegex(ninja, r"build \S*libhamflow\.a\b")
        done = run("cmake", "--build", folder / "build", "--target", "CMakeFiles/outside.dir/outside.cpp.o")
        self.assertEqual(done.returncode, 0, done.stdout[-3000:])


class Versions(unittest.TestCase):
    def test_texts_state_the_version(self):
        self.assertIn(f'version = "{VERSION}"', (ROOT / "pyproject.toml").read_text())
        self.assertIn(f"version: {VERSION}\n", (ROOT / "CITATION.cff").read_text())
        self.assertEqual(re.search(r"(?m)^## (\S+)", (ROOT / "CHANGELOG.md").read_text())[1], VERSION)
        self.assertIn(f'"version": "{VERSION}"', (ROOT / "packaging/vcpkg/vcpkg.json").read_text())
        self.assertIn(f'set version = "{VERSION}"', (ROOT / "packaging/conda/meta.yaml").read_text())


if __name__ == "__main__":
    unittest.main()
