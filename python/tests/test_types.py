"""The annotations of the module are those of its objects, and the examples pass mypy --strict."""

import pathlib
import subprocess
import sys

import hamflow as hf

PACKAGE = pathlib.Path(hf.__file__).resolve().parent
EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples" / "python"
# matplotlib, pandas and others come without types.
CONFIGURATION = f"[mypy]\nignore_missing_imports = True\nmypy_path = {PACKAGE.parent}\n"
# What stubtest calls different, each with the reason why it is not.
ALLOWED = r"""
# Classes of the standard library, whose own stubs differ.
hamflow(\._\w+)?\.(Callable|Fraction|Iterable|Mapping|Sequence|SimpleNamespace)(\.\w+)?
# Classes of pybind11 have its metaclass.
hamflow\._core\.(Comparison|GatheredSweep|Problem|RunTables|Scenario|Simulation|Table)
# Classes that only C++ makes have an __init__ that raises.
hamflow\._core\.(Comparison|RunTables|Scenario|Table)\.__init__
# stubtest makes one signature of the overloads, in which no argument is positional only.
hamflow(\._convert)?\.convert
"""


def check(folder, *command):
    configuration = folder / "mypy.ini"
    configuration.write_text(CONFIGURATION + f"cache_dir = {folder}\n")
    done = subprocess.run([sys.executable, "-B", "-m", *command, str(configuration)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_module_and_examples_are_strict(tmp_path):
    files = [*PACKAGE.glob("*.py"), *EXAMPLES.glob("*.py")]
    check(tmp_path, "mypy", "--strict", *map(str, sorted(files)), "--config-file")


def test_stubs_are_those_of_the_compiled_half(tmp_path):
    allowed = tmp_path / "allowed"
    allowed.write_text(ALLOWED)
    check(tmp_path, "mypy.stubtest", "hamflow", "--concise", "--allowlist", str(allowed), "--mypy-config-file")


def test_types_are_installed():
    assert (PACKAGE / "py.typed").exists() and (PACKAGE / "_core.pyi").exists()
