"""hf.compare: rows of the command, errors, figures, interrupts."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

import hamflow as hf

HAMFLOW = os.environ.get("HAMFLOW", "hamflow")
MEASURED = ("seconds", "wall_seconds")  # differ from run to run
TABLES = {"problem": {"name": "henon-heiles", "initial": {"q": [0.1, -0.2], "p": [0.3, 0.1]}}, "method": {"name": "stv4"},
          "run": {"dt": 0.1, "steps": 100}}


def compared(**more):
    return hf.compare(TABLES, **{"methods": ["verlet", "cg(1,5)"], "dt": [0.1, "1/20"]} | more)


def test_rows_are_those_of_the_command(tmp_path):
    file = tmp_path / "s.toml"
    file.write_text(str(hf.Scenario(TABLES)))
    told = json.loads(subprocess.run([HAMFLOW, "compare", file, "--methods", "verlet,cg(1,5)", "--dt", "0.1,1/20", "--json",
                                      "--quiet"], check=True, capture_output=True, text=True).stdout)
    cmp = compared()

    def without_times(rows):
        return [{name: value for name, value in row.items() if name not in MEASURED} for row in rows]

    assert without_times(cmp.rows) == without_times(told["rows"]) and set(cmp.rows[0]) == set(told["rows"][0])
    assert cmp.summary["reference"] == told["reference"] and len(cmp) == 4 and cmp.status == "done"
    assert hf.compare(file, methods="verlet", dt=0.1).rows[0]["error"] == cmp.rows[0]["error"]


def test_everything_that_is_wrong_is_said_at_once():
    with pytest.raises(hf.Rejection) as caught:
        compared(methods=["verlet", "stv5", "boris"], dt=[0.1, "x", 0])
    assert [key for key, _ in caught.value.errors] == ["methods", "methods", "dt", "dt"]
    assert "--" not in str(caught.value)
    with pytest.raises(hf.Rejection, match="missing"):
        compared(methods=[])
    with pytest.raises(hf.Rejection, match="step_control"):
        hf.compare(TABLES | {"method": {"name": "stv4", "step_control": "reversible"}}, methods=["verlet"])


def test_the_method_of_the_scenario_is_not_run():
    other = TABLES | {"method": {"name": "boris"}}
    cmp = hf.compare(other, methods=["verlet"], dt=[0.1])
    assert cmp.rows[0]["error"] == compared().rows[0]["error"]
    assert any("would be refused" in note for note in cmp.notes)


def test_notes_name_what_is_not_used():
    cmp = hf.compare(TABLES | {"output": {"figures": ["orbit"]}}, methods=["verlet"], dt=[0.03])
    assert any("output.figures is not used" in note for note in cmp.notes)
    assert any("does not divide" in note for note in cmp.notes)


def test_folder_and_figures(tmp_path):
    import matplotlib

    matplotlib.use("Agg")
    cmp = compared(out=tmp_path / "c")
    assert json.loads((tmp_path / "c" / "compare.json").read_text()) == cmp.summary
    with pytest.raises(hf.FileError, match='existing="replace"'):
        compared(out=tmp_path / "c")
    with pytest.raises(hf.Error, match='allowed "error", "replace"$'):
        compared(existing="resume")
    axes = cmp.plot()
    assert len(axes) == 3 and all(each.get_xscale() == each.get_yscale() == "log" for each in axes)
    assert np.array_equal(axes[0].lines[-1].get_ydata(), [row["error"] for row in cmp.rows[2:]])
    assert cmp.plot(axes[0]) is axes[0]
    cmp.figure(tmp_path / "work.svg")
    assert (tmp_path / "work.svg").stat().st_size > 1000
    with pytest.raises(hf.Rejection, match=r"\.svg"):
        cmp.figure(tmp_path / "work.txt")


def test_where_every_run_fails():
    s = {"problem": {"name": "formula", "coordinates": ["q"], "hamiltonian": "p^2/2 - exp(q^2)", "initial": {"q": [1], "p": [1]}},
         "run": {"dt": 0.1, "steps": 5}}
    with pytest.raises(hf.Error):
        hf.compare(s, methods=["verlet"])


def test_what_notebooks_show():
    cmp = compared()
    assert repr(cmp) == "<hamflow.Compare henon-heiles: verlet, cg(1,5), 4 runs, done>"
    assert cmp._repr_html_().count("<tr>") == 5


LONG = f'hf.compare({TABLES!r} | {{"run": {{"dt": 0.1, "steps": 3_000_000}}}}, methods=["verlet", "stv4"])'


@pytest.mark.parametrize("call, kept", [(LONG, "error.partial.status"), ("hf.verify(all=True)", "error.partial.summary['status']")])
def test_ctrl_c_keeps_what_is_there(call, kept):
    code = f"""
import os, signal, threading, time
import hamflow as hf
def send():
    time.sleep(1)
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=send).start()
try:
    {call}
except KeyboardInterrupt as error:
    print({kept})
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, env=os.environ)
    assert done.stdout == "interrupted\n", done.stderr


def test_progress_is_told_of_runs():
    told = []
    hf.compare(TABLES | {"run": {"dt": 0.01, "steps": 200_000}}, methods=["verlet"], dt=[0.01],
               progress=lambda done, total: told.append((done, total)))
    assert told and all(total == 1 for _, total in told)
