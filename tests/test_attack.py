"""Random scenes against an over-refined reference: the generator, the reference's own elements,
and the judges' arithmetic.
"""

import math
import os
import time
from pathlib import Path

import numpy as np
import pytest

from solidgear.body import as_supports
from solidgear.judge.quantities import size
from solidgear.ladder import build
from solidgear.meshing.closed_form import mass_properties
from solidgear.scene import Bearing, Port, Scene, Segment
from solidgear.solve.statics import condense
from validation.attack import __main__ as command
from validation.attack import campaign
from validation.attack import reference as finest
from validation.attack.bands import BandTable, explained
from validation.attack.corner_mesh import corner_mesh, singular_points
from validation.attack.judge import Band, band_of, errors_of, partner_of, within
from validation.attack.outcome import outcome
from validation.attack.reference import SURE, Reference, reference, settle
from validation.attack.scenes import KINDS, TIES, distribution, random_scene, traits
from validation.attack.spectral import spectral
from validation.attack.springs import random_springs
from validation.attack.verdicts import VerdictTable
from validation.attack.worker import Worker

ROOT = Path(__file__).resolve().parent.parent


# ------------------------------------------------------------------------------------------------
# - scenes
def test_a_seed_gives_one_scene():
    assert random_scene(5).as_dict() == random_scene(5).as_dict()
    assert random_scene(5).as_dict() != random_scene(6).as_dict()
    with pytest.raises(ValueError, match="gearbox"):
        random_scene(1, kind="gear box")


def test_draws_cover_what_a_stranger_would_write():
    drawn = [traits(random_scene(seed)) for seed in range(150)]
    assert {d["kind"] for d in drawn} == set(KINDS)
    assert {d["ties"] for d in drawn} == set(TIES)
    assert {d["bearings"] for d in drawn} == {1, 2, 3}
    assert {d["tolerance"] for d in drawn} == {0.01, 0.05, 0.1}
    ratios = [d["l_over_d"] for d in drawn]
    assert min(ratios) < 0.5 and max(ratios) > 30
    assert sum(d["coupled"] for d in drawn) > 30 and sum(d["unequal"] for d in drawn) > 20
    assert max(d["segments"] for d in drawn) >= 7
    assert min(d["wall_over_radius"] for d in drawn) < 0.1
    told = dict(distribution([random_scene(seed) for seed in range(10)]))
    assert "median" in told["l_over_d"]


@pytest.mark.parametrize("coupled", ["none", "paired", "strong"])
def test_springs_hold_and_never_push(coupled):
    for seed in range(50):
        k = random_springs(np.random.default_rng(seed), 0.05, seed % 2 == 0, coupled)
        size = np.sqrt(np.diag(k))
        scaled = k / np.where(size > 0, size, 1.0) / np.where(size > 0, size, 1.0)[:, None]
        assert np.array_equal(k, k.T)
        assert np.linalg.eigvalsh(scaled).min() > -1e-14
        assert not k[4].any()


# ------------------------------------------------------------------------------------------------
# - mesh
def _stepped(attachment="average"):
    segments = [
        Segment.cylinder("thin", length=0.1, diameter=0.04, bore=0.01),
        Segment.cylinder("thick", length=0.06, diameter=0.06, bore=0.01, y0=0.1),
    ]
    matrix = np.diag([1e8, 5e7, 1e8, 1e4, 2e3, 1e4])
    bearing = Bearing(name="1", y=0.03, seat_width=0.02, matrix=matrix, attachment=attachment)
    return Scene.from_parts(
        segments, bearings=[bearing], port=Port(y=0.13, lo=0.1, hi=0.16, attachment=attachment)
    )


def test_corner_cuts_keep_the_mesh_whole():
    scene = _stepped()
    mesh = corner_mesh(scene, 3, 2.0, 0.2)
    corner = mesh.points[mesh.cells]
    x, y = corner[..., 0], corner[..., 1]
    area = 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
    assert area.min() > 0
    # the meridian without its bore, in closed form
    assert area.sum() == pytest.approx(0.1 * 0.015 + 0.06 * 0.025, rel=1e-12)
    edges = np.sort(
        np.stack([mesh.cells, np.roll(mesh.cells, -1, axis=1)], axis=2), axis=2
    ).reshape(-1, 2)
    pairs, count = np.unique(edges, axis=0, return_counts=True)
    assert count.max() == 2
    # no hanging nodes: the edges of one cell only close to the outline
    outline = np.linalg.norm(np.diff(mesh.points[pairs[count == 1]], axis=1)[:, 0], axis=1).sum()
    assert outline == pytest.approx(2 * 0.16 + 0.015 + 0.025 + 0.01, rel=1e-12)


def test_layers_shrink_by_the_ratio_at_every_corner():
    scene = _stepped()
    shortest = []
    for layers in (2, 3):
        mesh = corner_mesh(scene, layers, 2.0, 0.2)
        for point in singular_points(scene):
            at = np.linalg.norm(mesh.points - point, axis=1)
            shortest.append(np.sort(at)[1])
    n = len(shortest) // 2
    assert n >= 5
    assert np.allclose(np.array(shortest[n:]) / shortest[:n], 0.2)


# ------------------------------------------------------------------------------------------------
# - elements
def test_own_elements_twist_a_bar_exactly():
    """Between section means in a uniform bar, torsion is Saint-Venant's solution, linear along
    the shaft: 1/k + l / (G J).
    """
    bar = [Segment.cylinder("bar", length=0.3, diameter=0.05)]
    bearing = Bearing(
        name="1",
        y=0.05,
        seat_width=0.02,
        matrix=np.diag([1e8, 1e8, 1e8, 1e4, 3e5, 1e4]),
        attachment="section",
    )
    scene = Scene.from_parts(
        bar, bearings=[bearing], port=Port(y=0.25, lo=0.2, hi=0.3, attachment="section")
    )
    body = spectral(scene, corner_mesh(scene, 2, 2.0, 0.2), 4)
    twist = condense(body, scene, "port").compliance[4, 4]
    exact = 1 / 3e5 + 0.2 / (scene.material.shear_modulus * math.pi / 2 * 0.025**4)
    # rounding: the free body is factored near its rigid motion
    assert twist == pytest.approx(exact, rel=1e-10)


@pytest.mark.parametrize(
    "attachment", ["average", "rigid", pytest.param("section", marks=pytest.mark.long)]
)
def test_own_elements_agree_with_the_product(attachment):
    scene = _stepped(attachment)
    mine = spectral(scene, corner_mesh(scene, 5, 2.0, 0.2), 4)
    options = {
        "order": 4,
        "layers": 3,
        "edge_layers": 3,
        "ratio": 0.2,
        "size": 0.04,
        "refinement": 1.0,
    }
    theirs = build(scene, "harmonic", **options)
    exact = mass_properties(scene.segments)
    assert mine.mass_matrix()[0, 0] == pytest.approx(exact.mass, rel=1e-12)
    assert mine.mass_matrix()[4, 4] == pytest.approx(exact.iyy, rel=1e-12)
    assert mine.rigid_residual() < 1e-13
    supports = as_supports(scene)
    a, b = (condense(body, supports, "port").compliance for body in (mine, theirs))
    # three layers of the product at a rigid seat leave 2e-4; a wrong tie, sign or strain shows in
    # per cents
    assert np.allclose(np.diag(a), np.diag(b), rtol=5e-4)
    assert a[2, 3] == pytest.approx(b[2, 3], rel=5e-4)


# ------------------------------------------------------------------------------------------------
# - reference
def test_settling_extrapolates_what_falls_geometrically():
    a, b, c = (2.0 + 0.3**k for k in (3, 4, 5))
    value, doubt = settle(a, b, c, a, 2.0)
    assert value == pytest.approx(2.0, rel=1e-12)
    # Aitken's own step is what the last value lacks
    assert doubt == pytest.approx(SURE * 0.3**5 / 2.0, rel=1e-9)


def test_settling_doubts_what_does_not():
    value, doubt = settle(1.0, 1.1, 0.9, 1.0, 1.0)
    assert value == 0.9 and doubt == pytest.approx(SURE * 0.3)
    # two layers less that move a value by 0.1 leave at most 0.2^2 of it for the layers not there
    assert settle(1.0, 1.0, 1.0, 1.1, 1.0)[1] == pytest.approx(0.1 * 0.04 / 0.96)
    assert settle(1.0, 1.0, 1.0, 1.0, 1.0, noise=1e-5) == (1.0, 1e-5)


@pytest.mark.long
def test_the_reference_is_as_good_as_it_says(tmp_path, monkeypatch):
    monkeypatch.setattr(finest, "LEVELS", ((2, 2), (3, 3)))
    scene = _stepped("rigid")
    light = reference(scene, 1.0, folder=tmp_path)
    fine = reference(scene, light.uncertainty["C_zz"] / 2, folder=tmp_path)
    assert light.setting == [4, 2] and fine.setting == [5, 3]
    for name, value in light.values.items():
        scale = size(fine.values, name)
        assert (
            abs(value - fine.values[name])
            <= (light.uncertainty[name] + fine.uncertainty[name]) * scale
        ), name
    # kept: a finer one serves a coarser goal, without solving
    start = time.process_time()
    assert reference(scene, 1.0, folder=tmp_path).setting == fine.setting
    assert time.process_time() - start < 1.0
    assert reference(scene, limit=1000, folder=None) is None


# ------------------------------------------------------------------------------------------------
# - judges
def _mode(name, hz, row):
    motions = np.zeros((1, 2, 6))
    motions[0, :, 2] = row
    return {
        "name": name,
        "family": "bending",
        "frequency_hz": hz,
        "multiplicity": 1,
        "motions": motions.tolist(),
        "uncertainty": 1e-6,
    }


def _reference(**changed):
    content = {
        "values": {"C_zz": 1.0, "C_thx": 4.0, "C_z,thx": 0.01},
        "uncertainty": dict.fromkeys(("C_zz", "C_thx", "C_z,thx"), 1e-6),
        "modes": [_mode("bending 1", 100.0, [1, 1]), _mode("bending 2", 110.0, [1, -1])],
        "gram": np.eye(12).tolist(),
        "setting": [5, 6],
        "unknowns": 1,
        "seconds": 0.0,
    }
    return Reference(**(content | changed))


def _model(values, bands=None, modes=()):
    return {
        "valid": True,
        "why_not": None,
        "values": values,
        "bands": bands or {},
        "steps": {},
        "modes": list(modes),
    }


def test_modes_are_paired_by_shape_whatever_their_names():
    swapped = _mode("bending 1", 109.0, [1, -1])
    partner, how = partner_of(swapped, _reference())
    assert partner["name"] == "bending 2" and "there called bending 2" in how
    assert partner_of(_mode("bending 1", 400.0, [1, 1]), _reference())[0] is None
    nameless = {k: v for k, v in swapped.items() if k != "motions"}
    assert partner_of(nameless, _reference())[0]["frequency_hz"] == 100.0
    model = _model({"bending 1": 109.0}, modes=[swapped])
    assert errors_of(model, _reference())["bending 1"][0] == pytest.approx(109 / 110 - 1)


def test_bands_are_held_missed_or_left_alone():
    model = _model(
        {"C_zz": 1.01, "C_thx": 4.0 + 1e-9, "C_z,thx": 0.03},
        {"C_zz": 0.02, "C_thx": 0.1, "C_z,thx": 0.01},
    )
    zz, tilt, cross = (band_of(q, model, _reference()) for q in ("C_zz", "C_thx", "C_z,thx"))
    assert zz.held and zz.judged and zz.error == pytest.approx(0.01 / 1.01)
    # an error of rounding's size says nothing of a band
    assert not tilt.judged
    # couplings count against the root of the direct compliances, not against themselves
    assert not cross.held and cross.error == pytest.approx(0.02 / math.sqrt(1.01 * 4))
    # a truth that is not known well enough cannot tell
    vague = _reference(uncertainty=dict.fromkeys(("C_zz", "C_thx", "C_z,thx"), 0.05))
    assert not band_of("C_zz", model, vague).judged


def test_errors_at_the_edge_are_not_counted():
    assert within({"C_zz": (0.04, 0.001)}, 0.05) is True
    assert within({"C_zz": (0.06, 0.001), "C_yy": (0.0, 0.0)}, 0.05) is False
    assert within({"C_zz": (0.0505, 0.001)}, 0.05) is None


@pytest.mark.parametrize(
    "valid, error, fair, sort",
    [
        (True, 0.0, 0.0, "valid, true"),
        (True, 0.2, 0.0, "false valid"),
        (False, 0.2, 0.2, "not valid, true"),
        (False, 0.0, 0.0, "false invalid"),
        (False, 0.0, 0.2, "not valid like for like only"),
    ],
)
def test_verdicts_are_sorted(valid, error, fair, sort):
    table = VerdictTable()
    model = _model({"C_zz": 1.0 + error}) | {"valid": valid, "why_not": "reason"}
    row = {
        "seed": 1,
        "models": {"euler": model},
        "check": {"euler": "holds" if valid else "will not hold", "lumped": "holds"},
    }
    fair_reference = _reference(
        values={"C_zz": (1.0 + error) / (1.0 + fair), "C_thx": 4.0, "C_z,thx": 0.01}
    )
    table.add(
        row,
        {"tolerance": 0.05, "kind": "bar", "ties": "average", "l_over_d": 3.0},
        _reference(),
        fair_reference,
    )
    assert table.total(sort) == 1
    assert len(table.cases) == ("false" in sort)
    assert table.counts["check", "euler", "agree"] == 1
    assert any("| euler | 5 % |" in line for line in table.lines())


def test_check_may_doubt_but_not_contradict():
    table = VerdictTable()
    for said in ("holds", "holds with caution", "will not hold"):
        row = {"seed": 1, "models": {"euler": _model({"C_zz": 1.0})}, "check": {"euler": said}}
        table.add(
            row,
            {"tolerance": 0.05, "kind": "bar", "ties": "average", "l_over_d": 3.0},
            _reference(),
            None,
        )
    assert [table.counts["check", "euler", k] for k in ("agree", "uncertain", "contradict")] == [
        1,
        1,
        1,
    ]


def test_misses_are_explained_by_their_meshes():
    def told(values, error):
        return explained(
            Band("C_zz", error, 1e-3, 0.0, "", True),
            {"steps": {"C_zz": {"values": values, "used_order": 4.0}}},
        )[0]

    assert "turns" in told([1.0, 1.1, 1.05], 0.1)
    assert "changed sign" in told([1.0, 1.1, 1.15], 0.01)
    assert "grow" in told([1.0, 1.1, 1.3], -0.1)
    assert "slower" in told([1.0, 1.1, 1.15], -0.1)
    # one mesh that tells its own error
    assert "richer space" in told([1.15], -0.1)


def test_a_table_counts_only_what_was_judged():
    table = BandTable()
    row = {
        "seed": 3,
        "models": {"harmonic": _model({"C_zz": 1.01, "C_thx": 4.0}, {"C_zz": 0.001, "C_thx": 0.1})},
    }
    table.add(row, {"kind": "bar", "ties": "rigid", "l_over_d": 3.0}, _reference(), "harmonic")
    assert table.hits("harmonic") == (0, 1)
    assert "seed 3" in table.misses[0]


def test_a_worker_survives_what_it_runs():
    slow, dead, wrong = Worker(time.sleep, 1.0), Worker(os._exit, 20.0), Worker(math.sqrt, 20.0)
    try:
        assert slow.run(60)["crash"].startswith("timeout")
        assert "exit code 3" in dead.run(3)["crash"]
        assert "ValueError" in wrong.run(-1.0)["crash"]
        assert wrong.run(4.0) == 2.0
    finally:
        for worker in (slow, dead, wrong):
            worker.close()


@pytest.mark.long
def test_one_scene_end_to_end():
    """A coarse harmonic solid of a random bar has the bands and the verdict that its reference
    asks for.
    """
    scene = random_scene(15, kind="bar", ties="average")
    coarse = {
        "harmonic": {
            "order": 3,
            "layers": 1,
            "edge_layers": 0,
            "size": scene.segments[0].outer0 * 4,
        }
    }
    found = outcome(scene, ("euler", "harmonic"), coarse, check=False)
    truth = reference(scene, 1e-3, folder=None)
    bands = [band_of(q, found["models"]["harmonic"], truth) for q in ("C_zz", "C_thx", "bending 1")]
    assert all(b is not None and abs(b.error) < 0.05 for b in bands)
    assert set(errors_of(found["models"]["euler"], truth)) >= {"C_zz", "C_thx", "bending 1"}


@pytest.mark.slow
def test_a_slice_of_the_whole(tmp_path, monkeypatch):
    monkeypatch.setattr(campaign, "FOLDER", tmp_path / "reference")
    out = tmp_path / "attack.md"
    code = command.main(["--scenes", "2", "--seed", "11", "--solid", "1", "--out", str(out)])
    text = out.read_text()
    assert code == 0, text
    assert "False valid: 0.0 %" in text and "### tet10" in text
