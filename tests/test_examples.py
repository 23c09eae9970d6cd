"""Every example runs, and shows what it says it shows."""

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg

FOLDER = Path(__file__).parent.parent / "examples"


def run(name, *arguments):
    spec = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.main(*arguments)


@pytest.mark.long
def test_first_answer():
    found = run("first_answer")
    # converged values of the overhung pinion, tests/baselines
    assert found["C_zz"] == pytest.approx(5.961e-10, rel=1e-3)
    assert found["bending 1"] == pytest.approx(2758.0, rel=1e-3)


@pytest.mark.long
def test_shaft_in_python():
    found = run("shaft_in_python")
    assert found["euler"] == pytest.approx(found["formula"], rel=1e-6)
    # shear and rotary inertia cost some 2.6 (d / L)^2 of the frequency, and 3D no more than that
    assert 1 - found["timoshenko"] / found["euler"] == pytest.approx(2.6 * (1 / 30) ** 2, rel=0.1)
    assert found["harmonic"] == pytest.approx(found["timoshenko"], rel=1e-5)


@pytest.mark.slow
def test_shaft_to_report(tmp_path):
    pytest.importorskip("pandas")
    found = run("shaft_to_report", tmp_path)
    # a thicker seat is stiffer, and weighs as much as is allowed
    assert list(found["rows"]["C_zz"]) == sorted(found["rows"]["C_zz"], reverse=True)
    assert found["best"].best.kept and found["best"].gain.relative < -0.01
    assert sg.load(tmp_path / "shaft.toml") == found["shaft"].settled
    for name in ("report/report.html", "search/optimum.html"):
        assert (tmp_path / name).is_file()
    text = (FOLDER / "shaft_to_report.py").read_text(encoding="utf-8")
    body = text.partition("def main(folder=None):\n")[2].partition("\n\n\n")[0]
    assert len(body.splitlines()) <= 30


@pytest.mark.long
def test_attachments():
    found = run("attachments")
    assert found["section"] < found["average"] < found["rigid"]
    assert found["rigid"] / found["section"] > 1.1


@pytest.mark.long
def test_many_bearings():
    found = run("many_bearings")
    # a stiffer bearing never makes a softer shaft
    assert found["falls"] and 0 < found["share"] < 1


def test_two_gears():
    found = run("two_gears")
    # a box stiffer than a bearing still takes a third where both bearings share it
    assert 0.3 < found["share"] < 0.5 and found["twist"] > 1e6
    assert found["push"] == pytest.approx(2.58e-6, rel=0.01)


@pytest.mark.slow
def test_which_model():
    assert run("which_model") == {"trust": "harmonic", "cheapest": "harmonic"}


@pytest.mark.long
def test_ovalising():
    found = run("ovalising")
    assert found["harmonic"][0].startswith("ovalising n=2")
    # the ring formula: 7.746 / 2 pi sqrt(E h^2 / 12 rho (1 - nu^2)) / R^2, a few per cent off at
    # the free ends
    steel = sg.STEEL
    wave = (steel.E * 0.005**2 / (12 * steel.density)) ** 0.5 / 0.0975**2
    assert found["harmonic"][1] == pytest.approx(2.683 * wave / 6.2832, rel=0.05)
    assert "ovalising n=2" in found["counted"]


@pytest.mark.long
def test_how_sure():
    assert all(0 < band < 5e-3 for band in run("how_sure").values())  # a tenth of 5 %


def test_teeth_in_contact():
    loads = 1e3 * np.array([100, 200, 300])
    found = run("teeth_in_contact", (0.0, 10e-6), loads)
    bare, relieved = found["error"].values()
    # twice the load, all but twice the error; 10 um of relief are right for 200 N/mm
    assert bare[1] == pytest.approx(2 * bare[0], rel=0.06)
    assert relieved.argmin() == 1 and relieved[1] < 0.2 * bare[1]


@pytest.mark.long
def test_teeth_in_contact_has_a_load_for_each_relief():
    found = run("teeth_in_contact")
    least = [found["load"][error.argmin()] for error in found["error"].values()]
    assert least == [25, 200, 400, 600]


def test_lumped_model():
    found = run("lumped_model")
    assert found["thesis"] is None  # no real pair of masses
    assert abs(found["mode-matched"]) < 1e-12
    assert found["old"] < -0.5 and 0 < found["guyan"] < 0.02


def test_exact_beam():
    # cubic elements: the error falls with the fourth power of their length over the wave
    assert run("exact_beam")["worst"] < 1e-6


def test_before_solving():
    found = run("before_solving")
    assert found["euler"] == found["timoshenko"] == "will not hold" and found["solid"] == "holds"


@pytest.mark.slow
def test_two_shafts():
    found = run("two_shafts")
    modes = found["modes"]
    assert modes.rigid == 1 and modes.error_bound.max() < 1e-9 and found["unknowns"] < 150
    # of a double frequency of one shaft the mesh, a single spring, leaves one as it was
    assert modes.frequency_hz[-1] == pytest.approx(2758.0, rel=1e-3)
    # the mesh is loudest where a mode strains it most
    strained = modes.frequency_hz[modes.energy["mesh"].argmax()]
    assert found["loudest"] == pytest.approx(strained, rel=1e-3)


@pytest.mark.long
def test_way_back():
    found = run("way_back")
    assert found["bound"]["rubin"] < 1e-9 < found["bound"]["craig_bampton"] < 1e-2
    # the blank slows the shaft down, and carries what the shaft does not
    assert found["bending"] < 2758.0 and 0.5 < found["share"] < 1
    assert found["sensor"] > 0


@pytest.mark.long
def test_geared_train():
    first, force = run("geared_train")
    # a plate kept flat: some 14 % in the frequency
    assert first["timoshenko"] / first["harmonic"] - 1 == pytest.approx(0.137, abs=0.01)
    assert force["harmonic"] > 1.5 * force["timoshenko"]


def test_every_example_is_tested_and_short():
    scripts = {p.stem: p.read_text() for p in FOLDER.glob("*.py")}
    tests = Path(__file__).read_text()
    for name, text in scripts.items():
        assert f"def test_{name}(" in tests, name
        assert "It illustrates how to:" in text and len(text.splitlines()) < 60, name
        # what a person writes needs no more than the package
        assert not re.search(r"(from|import) solidgear\.", text), name
