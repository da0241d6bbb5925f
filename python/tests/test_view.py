"""hf.view writes a page that contains the data; the page itself is tested in tests/web."""

import base64
import json
import re

import numpy as np
import pytest

import hamflow as hf
from hamflow import _view

KEPLER = {"problem": {"name": "central-force", "potential": "kepler", "orbit": {"kind": "ellipse", "r_per": 1, "r_aph": 3}},
          "method": {"name": "verlet"}, "run": {"dt": 0.1, "steps": 50}}


@pytest.fixture
def page(tmp_path, monkeypatch):
    file = tmp_path / "page.html"
    file.write_text("<body><!--inlined--><p>the page</p></body>")
    monkeypatch.setattr(_view, "laboratory", lambda: file)
    return tmp_path / "out.html"


def inlined(file):
    text = file.read_text()
    found = re.search(r'<script type="application/json" id="inlined">(.*)</script><p>', text)
    data = json.loads(found[1])
    rows = np.frombuffer(base64.b64decode(data["rows"]), dtype="<f8")
    return data, rows.reshape(-1, len(data["columns"])) if data["columns"] else rows


def test_a_run_is_in_the_page_bit_for_bit(page):
    run = hf.run(KEPLER)
    view = hf.view(run, out=page, browser=False)
    assert view.file == page and view.note == ""
    data, rows = inlined(page)
    assert data["kind"] == "run" and data["toml"] == str(run.scenario)
    names = ["t", *run.scenario.coordinates, *run.scenario.momenta]
    assert data["columns"][:len(names)] == names
    for k, name in enumerate(names):
        assert np.array_equal(rows[:, k], run[name])
    assert np.array_equal(rows[:, data["columns"].index("energy error")], run.energy - run.energy[0])


def test_rows_are_left_out_of_a_large_page(page, monkeypatch):
    monkeypatch.setattr(_view, "_MOST_NUMBERS", 100)
    run = hf.run(KEPLER)
    view = hf.view(run, out=page, browser=False)
    data, rows = inlined(page)
    every = int(re.search(r"every (\d+)", view.note)[1])
    assert data["note"] == view.note and rows.size <= 100 + len(data["columns"])
    assert np.array_equal(rows[:, 0], run.t[::every])


def test_a_scenario_and_nothing_but_the_page(page):
    hf.view(KEPLER, out=page, browser=False)
    data, _ = inlined(page)
    assert data["kind"] == "scenario" and "verlet" in data["toml"]
    view = hf.view(out=page, browser=False)
    assert "the page" in page.read_text() and "inlined\"" not in page.read_text()
    assert view._repr_html_().startswith("<iframe")


def test_a_sweep_is_in_the_page(page):
    sweep = hf.sweep(KEPLER, {"run.dt": [0.1, 0.05]})
    hf.view(sweep, out=page, browser=False)
    data, rows = inlined(page)
    assert data["kind"] == "sweep" and len(rows) == 2
    assert "verlet" in data["toml"] and data["toml"] == str(sweep.scenario)
    assert list(rows[:, data["columns"].index("varied/run.dt")]) == [0.1, 0.05]


def test_a_text_cannot_end_the_script(page):
    hf.view({**KEPLER, "output": {"observables": {"near": "x"}}}, out=page, browser=False)
    assert page.read_text().count("</script>") == 1


def test_without_the_laboratory_the_message_says_how_to_build_it(monkeypatch, tmp_path):
    monkeypatch.setattr(_view, "__file__", str(tmp_path / "_view.py"))
    monkeypatch.setattr(_view.sys, "prefix", str(tmp_path))
    with pytest.raises(hf.FileError, match="./dev web"):
        hf.view(browser=False)
