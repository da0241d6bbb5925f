"""The example scripts and the notebooks run, and make their figures."""

import os
import pathlib
import subprocess
import sys

import pytest

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples" / "python"
SCRIPTS = sorted(file.stem for file in EXAMPLES.glob("*.py"))


@pytest.mark.parametrize("name", SCRIPTS)
def test_script(name, tmp_path):
    command = [sys.executable, "-B", str(EXAMPLES / f"{name}.py")]
    environment = dict(os.environ)
    if name == "sweep_mpi":
        command = ["mpirun", "--oversubscribe", "-n", "2", sys.executable, "-B", "-m", "mpi4py.futures", command[-1]]
        environment |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("notebook", sorted(file.name for file in (EXAMPLES / "notebooks").glob("*.ipynb")))
def test_notebook(notebook, tmp_path):
    done = subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output-dir", str(tmp_path),
                           str(EXAMPLES / "notebooks" / notebook)], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
