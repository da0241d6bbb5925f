"""hf.show, hf.verify, and H as LaTeX."""

import json
import os
import subprocess

import pytest

import hamflow as hf

HAMFLOW = os.environ.get("HAMFLOW", "hamflow")


@pytest.mark.parametrize("name", ["cg", "cg(1,5)", "central-force", "formula", "energy-error", "run"])
def test_the_text_is_that_of_the_command(name):
    told = subprocess.run([HAMFLOW, "show", name], check=True, capture_output=True, text=True).stdout
    shown = hf.show(name)
    assert shown.text == told == str(shown) and "\n" not in repr(shown) and "<pre>" in shown._repr_html_()


@pytest.mark.parametrize("name", ["cg(2,6)", "kahan-li8", "henon-heiles"])
def test_works_are_those_of_the_command(name):
    told = subprocess.run([HAMFLOW, "cite", name], check=True, capture_output=True, text=True).stdout
    assert hf.cite(name) == told and told.startswith("@software{hamflow")


def test_works_behind_a_run():
    s = hf.Scenario(problem=hf.Problem("pendulum").at(q=[1], p=[0]), method="stv4", run={"dt": 0.1, "steps": 5})
    assert hf.cite(hf.run(s)) == hf.cite(s) and "{Yoshida1990" in hf.cite(s)
    with pytest.raises(hf.Error, match="did you mean stv4"):
        hf.cite("stv5")


def test_scenarios_are_shown():
    s = hf.Scenario(problem=hf.Problem("pendulum").at(q=[1], p=[0]), method="stv4", run={"dt": 0.1, "steps": 5})
    assert "start: q = [1]" in hf.show(s).text


def test_names_that_are_not_there():
    with pytest.raises(hf.Error, match="did you mean henon-heiles"):
        hf.show("henonheiles")
    with pytest.raises(hf.Error, match=r'hamflow\.show\("run"\)'):
        hf.show("nothing")
    with pytest.raises(hf.Error, match="cg"):
        hf.show("cg(x)")


def test_hamiltonians_of_the_catalogue_are_typeset():
    parser = pytest.importorskip("matplotlib.mathtext").MathTextParser("agg")
    formulas = [formula for each in hf.problems() for formula in hf.show(each.name).formulas]
    assert len(formulas) > 10
    for formula in formulas:
        parser.parse(f"${formula}$")


@pytest.mark.parametrize("typed, tex", [
    ("p^2/2 - cos(q)", r"H = \frac{p^{2}}{2} - \cos\left(q\right)"),
    ("k/2*(sqrt(q^2)-1)^2 + p^2/2", r"H = \frac{k}{2} \, \left(\sqrt{q^{2}} - 1\right)^{2} + \frac{p^{2}}{2}"),
    ("p^2/(2*omega) + 1e-3*q^-2", r"H = \frac{p^{2}}{2 \, \omega} + 1\cdot 10^{-3} \, q^{-2}")])
def test_typed_hamiltonians_are_typeset(typed, tex):
    problem = hf.Problem(typed, coordinates=["q"], parameters={name: 1 for name in ("k", "omega") if name in typed})
    assert problem._repr_html_() == f"${tex}$"


def test_long_formulas_stand_as_they_were_typed():
    problem = hf.Problem("p^2/2 + " + " + ".join(f"{k}*q^2" for k in range(1, 500)), coordinates=["q"])
    assert problem._repr_html_().startswith("<code>H = ")


def test_verify_agrees_with_the_command():
    found = hf.verify("stv4", problem="pendulum")
    told = json.loads(subprocess.run([HAMFLOW, "verify", "stv4", "--problem", "pendulum", "--json"], check=True,
                                     capture_output=True, text=True).stdout)
    assert found.rows == told["methods"] and found.agrees is True
    assert {claim["property"] for claim in found.claims} >= {"order", "symplectic"}
    assert repr(found) == "<hamflow.Verification stv4 agrees>" and "<table>" in found._repr_html_()


def test_verify_refuses():
    with pytest.raises(hf.Rejection) as caught:
        hf.verify(["stv4", "stv5"])
    assert caught.value.errors[0][0] == "methods"
    with pytest.raises(hf.Rejection) as caught:
        hf.verify("stv4", problem="pendulun")
    assert caught.value.errors[0][0] == "problem"
    with pytest.raises(TypeError):
        hf.verify()
