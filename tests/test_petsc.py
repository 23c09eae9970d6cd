"""PETSc in processes of its own: the same digits, and sentences where it is not there."""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.solve.factor import FactorError
from solidgear.core.solve.shifted import factors
from solidgear.petsc import solver as petsc

SCENE = sg.load(Path(__file__).parents[1] / "geometry" / "pinion_overhung.toml")
SMALL = {"element": "tet10", "refinement": 0.3}
THERE = pytest.mark.skipif(bool(petsc.missing()), reason=petsc.missing() or "-")


def numbers(body):
    found = sg.condense(body, SCENE, SCENE.port.name)
    return found, np.sqrt(np.diag(np.nan_to_num(found.compliance, nan=1.0)))


@pytest.mark.slow
@THERE
def test_mumps_on_two_ranks_equals_this_program():
    own = sg.build(SCENE, "solid", **SMALL)
    body = sg.build(SCENE, "solid", **SMALL, engine="petsc", ranks=2)
    (sure, size), (found, _) = numbers(own), numbers(body)
    # two direct factors of one matrix, corrected on the same stiffness: rounding
    off = abs(found.compliance - sure.compliance) / np.outer(size, size)
    assert np.nanmax(off) < 1e-11
    theirs, ours = sg.modes(body, SCENE, n=5), sg.modes(own, SCENE, n=5)
    assert theirs.frequency_hz == pytest.approx(ours.frequency_hz, rel=1e-11)
    assert theirs.evidence["error"] < 1e-9
    assert theirs.evidence["method"] == "krylov-schur (SLEPc)"
    assert theirs.evidence["backend"] == "mumps (petsc on 2 ranks)"
    # the ranks end with the factor, and their files with them
    ranks = factors(body)[0].ranks
    process, folder = ranks._process, ranks.folder
    del ranks
    body.cache.clear()
    assert process.poll() is not None and not folder.exists()


@pytest.mark.slow
@THERE
def test_multigrid_gives_statics_and_refuses_modes():
    body = sg.build(SCENE, "solid", element="tet4", refinement=0.5, engine="petsc-gamg", ranks=1)
    own = sg.build(SCENE, "solid", element="tet4", refinement=0.5)
    (sure, size), (found, _) = numbers(own), numbers(body)
    # conjugate gradients to 1e-11 of the residual; the energy is good to the square, times the condition
    assert np.nanmax(abs(found.compliance - sure.compliance) / np.outer(size, size)) < 1e-8
    with pytest.raises(sg.SolidgearError, match="statics only; use engine = petsc"):
        sg.modes(body, SCENE, n=2)


def test_what_is_missing_is_told(monkeypatch):
    monkeypatch.setattr(petsc, "missing", lambda: "mpirun is not there")
    body = sg.build(SCENE, "solid", **SMALL, engine="petsc")
    with pytest.raises(
        FactorError, match="engine = petsc was asked for but mpirun is not there: apt"
    ):
        factors(body)


def test_options_that_exclude_each_other():
    with pytest.raises(sg.SolidgearError, match="leave out precision and out_of_core"):
        sg.build(SCENE, "solid", **SMALL, engine="petsc", precision="single")
    with pytest.raises(sg.SolidgearError, match="ranks 0 is not usable"):
        sg.build(SCENE, "solid", **SMALL, engine="petsc", ranks=0)
