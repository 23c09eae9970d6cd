"""Solids that do not fit: what is offered, and the same digits from factors that take less memory."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

import solidgear as sg
from solidgear.core.factoring import Factoring
from solidgear.core.machine.memory import NoRoom
from solidgear.core.models.size import size_of_body
from solidgear.core.solve import single
from solidgear.core.solve.backends import missing
from solidgear.core.solve.factor import FactorError, factorise
from solidgear.core.solve.shifted import factors, needed_mb
from solidgear.core.solve.single import Refining

GEOMETRY = Path(__file__).parents[1] / "geometry"


@cache
def scene_of(name):
    return sg.load(GEOMETRY / f"{name}.toml")


PARDISO = pytest.mark.skipif(bool(missing("pardiso")), reason=missing("pardiso") or "-")
SMALL = {"element": "hex20", "refinement": 0.3, "half": False}


@pytest.fixture(autouse=True)
def no_forced_backend(monkeypatch):
    monkeypatch.delenv("SOLIDGEAR_BACKEND", raising=False)


def solved(scene, model="solid", **options):
    body = sg.build(scene, model, **options)
    found = sg.condense(body, scene, scene.port.name)
    return body, found, sg.modes(body, scene, n=6)


# ------------------------------------------------------------------------------------------------- the same digits
@pytest.fixture(scope="module")
def usual():
    return solved(scene_of("pinion_overhung"), **SMALL)


@pytest.mark.parametrize(
    "options, backend",
    [
        pytest.param({"precision": "single"}, "superlu", marks=pytest.mark.slow),
        pytest.param({"precision": "single"}, "pardiso", marks=PARDISO),
        pytest.param({"out_of_core": True}, "pardiso", marks=PARDISO),
        pytest.param(
            {"out_of_core": True, "precision": "single"},
            "pardiso",
            marks=[PARDISO, pytest.mark.slow],
        ),
    ],
)
def test_equal_to_a_double_factor_in_memory(usual, options, backend, monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_BACKEND", backend)
    _, there, sure = usual
    body, found, modes = solved(scene_of("pinion_overhung"), **SMALL, **options)
    # both end at the rounding of the product with the matrix, which thin cells make worse: measured
    # 1.5e-14 on fat ones, 1.6e-12 on these
    size = np.sqrt(np.outer(*(2 * [np.nan_to_num(np.diag(there.compliance), nan=1.0)])))
    assert np.nanmax(abs(found.compliance - there.compliance) / size) < 2e-11
    assert modes.frequency_hz == pytest.approx(sure.frequency_hz, rel=1e-12)
    assert modes.evidence["error"] < 1e-9
    for said in (found.evidence["backend"], modes.evidence["backend"]):
        assert said.startswith(backend)
        assert ("out of core" in said) == ("out_of_core" in options)
        assert ("single precision" in said) == ("precision" in options)
    if "precision" in options:
        refining = factors(body)[0].refining
        assert refining is not None and 1 <= refining.steps <= 6
        assert f"{refining.steps} refinements in double" in modes.evidence["backend"]


@pytest.mark.long
def test_a_border_of_rigid_seats_is_refined_as_well(usual):
    scene = scene_of("pinion_overhung").with_attachment("rigid")
    double, one = (solved(scene, **SMALL, **more) for more in ({}, {"precision": "single"}))
    assert one[0].blocks[0].border == 18
    # twice the rounding of the other: once on either side of the border
    assert one[2].frequency_hz == pytest.approx(double[2].frequency_hz, rel=1e-11)


def test_every_refinement_takes_digits_off_the_error(monkeypatch):
    body = sg.build(scene_of("pinion_overhung"), "solid", **SMALL)
    block = body.blocks[0]
    matrix = (block.stiffness + 0.03 * body.scale * block.mass).tocsr()
    rhs = block.mass @ np.random.default_rng(0).standard_normal((block.size, 2))
    exact = factorise(matrix).solve(rhs)
    monkeypatch.setattr(single, "LEAST", np.inf)
    errors = []
    for steps in (1, 2, 3, single.MOST):
        monkeypatch.setattr(single, "MOST", steps)
        made = factorise(matrix, factoring=Factoring(precision="single"))
        off = made.solve(rhs) - exact
        error = np.sqrt(np.sum(off * (matrix @ off), axis=0) / np.sum(exact * rhs, axis=0))
        errors.append(error.max())
    # numbers of four bytes: three digits or so are left of seven at a condition of 1e6 and more
    assert 1e-6 < errors[0] < 0.1
    # measured 1e3 and more from step to step; a tenth would be no refinement worth the name
    assert errors[1] < 0.05 * errors[0] and errors[2] < 0.05 * errors[1] + 1e-11
    # by itself it goes on until what a double factor leaves (1.2e-10 measured between the two)
    assert errors[3] < 2e-9


def test_a_factor_that_is_too_far_from_its_matrix_is_told():
    matrix = sp.diags(np.geomspace(1.0, 1e4, 40)).tocsr()
    # nothing in common with the matrix: forty eigenvalues, no two alike
    refining = Refining(matrix.__matmul__, lambda f: f)
    with pytest.raises(FactorError, match="too far from the matrix.*precision = double"):
        refining.solve(np.ones(40))


@PARDISO
def test_files_of_a_factor_go_with_it():
    matrix = sp.diags([4.0, -1.0, -1.0], [0, 1, -1], shape=(500, 500)).tocsr()
    made = factorise(matrix, "pardiso", factoring=Factoring(out_of_core=True))
    folder = Path(made._solve.__self__.folder)
    assert any(folder.iterdir())
    rhs = np.arange(500.0)
    assert matrix @ made.solve(rhs) == pytest.approx(rhs)
    del made
    assert not folder.exists()


@pytest.mark.long
@PARDISO
def test_what_is_counted_of_memory_falls_as_asked():
    def sizes(half):
        body = sg.build(scene_of("pinion_overhung"), "solid", refinement=0.7, half=half)
        return [needed_mb(body, Factoring(**more)) for more in ({}, {"precision": "single"})]

    for both, one in (sizes(True), sizes(False)):
        # of half the digits numbers take half, and the work by the entry nearly all
        assert both > 1.25 * one
    # blocks by mirror planes have a quarter of the fill each
    assert sizes(False)[0] > 1.5 * sizes(True)[0]


@PARDISO
@pytest.mark.slow
def test_in_files_a_large_factor_takes_less_than_with_half_the_digits():
    scene = scene_of("pinion_overhung").with_attachment("rigid")
    body = sg.build(scene, "solid", refinement=0.85, half=False)
    half, files = (
        needed_mb(body, Factoring(**more))
        for more in ({"precision": "single"}, {"out_of_core": True})
    )
    # the work by the entry alone is left in memory
    assert half > 1.2 * files


# ------------------------------------------------------------------------------------------------- refusals
@pytest.mark.parametrize(
    "options, said",
    [
        ({"precision": "half"}, "use one of double, single"),
        ({"precision": "singel"}, "did you mean 'single'|use one of double, single"),
        ({"out_of_core": "yes"}, "it is true or false"),
    ],
)
def test_options_are_checked(options, said):
    for model in ("solid", "sector"):
        with pytest.raises(sg.SolidgearError, match=said):
            sg.build(scene_of("pinion_toothed"), model, **options)
    with pytest.raises(sg.SolidgearError, match="there is no such option"):
        sg.build(scene_of("pinion_overhung"), "harmonic", **options)


def test_back_ends_that_cannot_are_told():
    matrix = sp.identity(5, format="csr")
    with pytest.raises(
        FactorError, match="superlu was asked for but makes no factor in out of core"
    ):
        factorise(matrix, "superlu", factoring=Factoring(out_of_core=True))


def test_no_back_end_for_files(monkeypatch):
    monkeypatch.setattr("solidgear.core.solve.choice.missing", lambda name: f"{name} is not usable")
    with pytest.raises(FactorError, match="no back end here .*pardiso is not usable: pip install"):
        factorise(sp.identity(9, format="csr"), factoring=Factoring(out_of_core=True))


def refused(scene, monkeypatch, share, **options):
    """What is said where a share of what is needed is free."""
    body = sg.build(scene_of(scene), "solid", **options)
    need = needed_mb(body, body.factoring)
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", str(share * need))
    with pytest.raises(NoRoom) as caught:
        factors(body)
    monkeypatch.delenv("SOLIDGEAR_MEMORY_MB")
    assert "MB are free" in str(caught.value) and "\n" not in str(caught.value)
    return str(caught.value), share * need


SMALLER = ["--set precision=single (", "--set out_of"]
OFFERED = (
    # hexahedra that fall into pieces: on this mesh neither takes less than what did not fit
    pytest.param(
        *("pinion_overhung", {}, ["-f harmonic", "--set refinement="], SMALLER),
        marks=pytest.mark.slow,
    ),
    (
        "pinion_keyed",
        {"half": False, "refinement": 0.45},
        ["--set half=true", "-f corrected", "--set refinement=", *SMALLER],
        (),
    ),
    pytest.param(
        *("pinion_toothed", {"refinement": 0.35}, ["-f sector", "--set refinement=", *SMALLER], ()),
        marks=pytest.mark.long,
    ),
    pytest.param(
        *("shaft_step", {"refinement": 0.45}, ["--set refinement=", *SMALLER], ["-f "]),
        marks=pytest.mark.slow,
    ),
)


@PARDISO
@pytest.mark.parametrize("scene, options, wanted, no", OFFERED)
def test_a_refusal_offers_what_fits(scene, options, wanted, no, monkeypatch):
    message, _ = refused(scene, monkeypatch, 0.9, **options)
    first = [message.find(word) for word in wanted]
    # all of them, those that fit in the order in which they should be tried
    assert min(first) >= 0 and not [word for word in no if word in message]
    fit = len(message.partition("too large as well")[0])
    places = [at for at in first if at < fit]
    assert places == sorted(places) and len(places) >= 1


@pytest.mark.long
@PARDISO
def test_the_coarser_mesh_that_is_offered_fits(monkeypatch):
    given = {"element": "tet10", "refinement": 0.5}
    message, free = refused("pinion_overhung", monkeypatch, 0.7, **given)
    room = free + size_of_body(sg.build(scene_of("pinion_overhung"), "solid", **given)).matrices_mb
    refinement = float(message.split("--set refinement=")[1].split()[0])
    body = sg.build(scene_of("pinion_overhung"), "solid", **{**given, "refinement": refinement})
    assert f"{body.size} unknowns" in message
    assert 0.5 * room < needed_mb(body, body.factoring) + size_of_body(body).matrices_mb < room


@pytest.mark.slow
@PARDISO
def test_what_is_offered_is_what_the_analysis_says(monkeypatch):
    given = {"element": "tet10", "refinement": 0.7}
    message, _ = refused("pinion_overhung", monkeypatch, 0.9, **given)
    told = float(message.split("--set out_of_core=true (about ")[1].split()[0])
    body = sg.build(scene_of("pinion_overhung"), "solid", **given)
    files, whole = (needed_mb(body, Factoring(out_of_core=x)) for x in (True, False))
    # and the matrices that are held beside it
    assert files < told < whole
