"""Lower ends of near modes: bounded as one, by what lies beyond them, and not at all where nothing was
solved beyond.
"""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg as sla

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.bounds.clusters import lower_ends
from solidgear.core.judge import bounded
from solidgear.core.judge import settle as settling
from solidgear.core.judge.bounded import NOTHING_BEYOND, mode_bars
from solidgear.core.judge.hidden import COMPLETE, complete_list
from solidgear.core.judge.settle import settle
from solidgear.core.quantity import Quantity
from solidgear.core.safety import ROOM
from solidgear.core.scene import Bearing, Port, Scene
from solidgear.core.solve import groups
from tests.shafts import shaft

COARSE = {"order": 3, "layers": 0, "edge_layers": 0, "relative_size": 4.0}
FINE = {**COARSE, "order": 7}
PAD = Path(__file__).parent / "found/parts/rubber_pad_block.toml"
PLATE = '[[port]]\nname = "top"\n'


def solved(eigenvalues, size, count, seed=3):
    """Rayleigh quotients of a diagonal matrix in a space near its lowest shapes, and the exact
    products of energy of their errors.
    """
    n, m = len(eigenvalues), 40
    noise = np.random.default_rng(seed).standard_normal((n, m))
    basis = np.linalg.qr(np.eye(n)[:, :m] + 5 * size * noise / np.sqrt(n))[0]
    values, turn = sla.eigh(basis.T @ (eigenvalues[:, None] * basis))
    shapes = (basis @ turn)[:, :count]
    values = values[:count]
    error = shapes * values / eigenvalues[:, None] - shapes
    return values, error.T @ (eigenvalues[:, None] * error)


def spectrum(*lowest):
    above = lowest[-1] * (1.3 + np.random.default_rng(1).random(300) * 30)
    return np.sort(np.r_[lowest, above])


@pytest.mark.parametrize("size", [3e-4, 1e-3, 3e-3])
def test_a_cluster_narrower_than_its_errors_is_bounded_as_one(size):
    exact = spectrum(*(1 + 2e-5 * np.arange(5)), 1.6, 1.9)
    values, products = solved(exact, size, 7)
    error = values - exact[:7]
    assert error[:5].min() > np.ptp(exact[:5]) / 2
    ends = lower_ends(values, products, values[-1])
    assert (ends[:5] <= exact[:5]).all()
    # gaps inside the cluster would make it some fifty times as wide
    assert (values - ends)[:5].max() < 3 * error[:5].max()


def test_shapes_that_share_one_error_lie_below_what_each_says_alone():
    """A mesh sees two modes at 1, of which one is exact and the other lies at 0.99: shapes halfway
    between them have half of the error each, and in truth one of them all.
    """
    exact = np.array([0.99, 1.0, 4.0, 50.0])
    stiff = (1 - exact[0]) / (exact[3] - exact[0])
    seen = np.array([np.sqrt(1 - stiff), 0.0, 0.0, np.sqrt(stiff)])
    own = np.array([0.0, 1.0, 0.0, 0.0])
    shapes = np.column_stack([own + seen, own - seen]) / np.sqrt(2)
    shapes = np.column_stack([shapes, [0.0, 0.0, 1.0, 0.0]])
    values = np.einsum("ij,i,ij->j", shapes, exact, shapes)
    assert values == pytest.approx([1, 1, 4])
    error = shapes * values / exact[:, None] - shapes
    products = error.T @ (exact[:, None] * error)
    ends = lower_ends(values, products, values[-1])
    assert 0.98 < ends[0] <= exact[0] and 0.99 < ends[1] <= exact[1]
    # one by one both would lie between
    assert lower_ends(values, np.diag(np.diag(products)), values[-1])[0] > exact[0]


def test_nothing_beyond_a_cluster_leaves_no_lower_end():
    values = np.array([1.0, 3.0, 3.001, 3.002])
    ends = lower_ends(values, 1e-3 * np.eye(4), values[-1])
    assert np.isfinite(ends[0]) and np.isnan(ends[1:]).all()
    # a gap inside the cluster is none to rest on, wherever the list ends
    assert np.isnan(lower_ends(values[1:3], 1e-3 * np.eye(2), values[-1])).all()


def test_lower_ends_hold_among_many_modes_and_rise_with_every_one_more():
    """Modes some per cent apart, the highest of which are off most: what is solved beyond does not
    widen a bar.
    """
    exact = spectrum(*np.cumprod([1.0, *[1.03, 1.07] * 9]))
    values, products = solved(exact, 2e-2, 24)
    error = values - exact[:24]
    before = np.full(24, -np.inf)
    for count in (14, 18, 24):
        ends = lower_ends(values[:count], products[:count, :count], values[count - 1])
        known = np.isfinite(ends)
        assert known.sum() >= count - 4 and (ends[known] <= exact[:count][known]).all()
        assert (ends[:10] >= before[:10]).all()
        before = np.r_[ends, np.full(24 - count, -np.inf)]
    assert np.max((values - ends)[:10] / error[:10]) < 3


def test_a_mode_alone_has_the_lower_end_of_kato_and_temple():
    values, energy = np.array([1.0, 2.0, 5.0]), np.array([0.01, 0.02, 0.01])
    ends = lower_ends(values, np.diag(energy), 10.0)
    assert ends == pytest.approx(values - energy / (1 - values / 10.0), rel=1e-14)


def test_families_of_one_block_keep_their_order():
    """Torsion that is all but exact beside a bending pair that is not."""
    values = np.array([1.0, 1.01, 1.01, 3.0, 9.0])
    energy = np.array([1e-9, 0.05, 0.05, 1e-3, 1e-3])
    families = ["torsion", "bending", "bending", "axial", "axial"]
    ends = lower_ends(values, np.diag(energy), 9.0, families)
    assert ends[0] > 1 - 1e-8 and ends[1] < 0.96
    # a body that mixes them has no such order
    assert lower_ends(values, np.diag(energy), 9.0)[0] < 0.96


@pytest.fixture(scope="module")
def webs():
    """Two equal thin webs, whose ovalising modes lie side by side, with one of the same waves beyond."""
    web, neck = (0.002, 0.075, 0.075), (0.03, 0.015, 0.015)
    return shaft(neck, web, neck, web, neck)


def test_bars_of_equal_webs_hold_and_are_hardly_wider_than_errors(webs):
    body, fine = (sg.build(webs, "harmonic", **options) for options in (COARSE, FINE))
    found, truth = (sg.modes(one, webs, 10) for one in (body, fine))
    bars = mode_bars(webs, body, as_supports(webs), found)
    twins = [m for m in found.modes if m.name.startswith("ovalising n=2")]
    assert len(twins) >= 2
    for mode in twins[:2]:
        error = 1 - truth.named(mode.name).frequency_hz / mode.frequency_hz
        assert 0 < error <= bars[mode.name] <= 3 * error


def test_a_cluster_beyond_which_nothing_is_found_has_no_bar(webs, monkeypatch):
    body = sg.build(webs, "harmonic", **COARSE)
    found = replace(sg.modes(body, webs, 10), beyond=(), above=())
    monkeypatch.setattr(bounded, "MOST_SHAPES", 0)
    bars = mode_bars(webs, body, as_supports(webs), found)
    names = [m.name for m in found.modes if m.name.startswith("ovalising n=2")]
    assert len(names) == 2 and not bars.keys() & names and "bending 1" in bars
    assert "shapes" in NOTHING_BEYOND


def pad(folder, top=PLATE):
    """The scene of a layer of rubber, 5 mm thick, on a clamped foot and under a plate without mass."""
    path, text = folder / "pad.toml", PAD.read_text()
    assert PLATE in text
    path.write_text(text.replace("100 mm", "50 mm").replace(PLATE, top))
    return path


@pytest.fixture
def few_shapes(monkeypatch):
    """As many shapes are searched for as a quarter of the area has, and meshes end early."""
    monkeypatch.setattr(groups, "MOST_SHAPES", 40)
    monkeypatch.setattr(bounded, "MOST_SHAPES", 40)
    monkeypatch.setattr(settling, "REFINEMENTS", (0.5, 0.7))


def test_modes_below_those_of_a_thin_layer_have_bars_that_hold(tmp_path, few_shapes, run):
    """Shear of the layer as a whole, and from twice its frequency on shear between its faces, in waves
    of any length: modes without end, of which two on a coarse mesh are off by more than they lie apart.

    Frequencies are those of spectral elements of order 5 on a quarter of the layer, graded to its rim,
    which share no code with the solid; coarser ones of order 4 lie above by 5e-4 and, from twice the
    frequency on, by 2e-3.
    """
    code, out, _ = run("modes", pad(tmp_path), "--tol", 0.015, "--json")
    shown = json.loads(out)
    listed = shown["modes"]
    exact = [1494.3, 1494.3, 1496.2, 2959.5]
    assert code == 0 and len(listed) == 10 and shown["options"]["refinement"] == 0.7
    for mode, hertz in zip(listed, exact[:3]):
        off = 1 - hertz / mode["frequency_hz"]
        assert 5e-4 < off < mode["bar"] < 4 * off
    assert shown["without_bar"] == [f"mode {k}" for k in range(4, 11)]
    assert shown["why_without_bar"] == NOTHING_BEYOND
    # closer than the mesh is off, and upper ends
    frequency = [mode["frequency_hz"] for mode in listed]
    assert frequency[3] > exact[3] and frequency[6] / frequency[3] < frequency[3] / exact[3]


def test_finer_meshes_are_not_tried_where_all_modes_lie_side_by_side_in_a_layer(
    tmp_path, few_shapes
):
    roof = '[[bearing]]\nname = "roof"\nhold = "clamped"\n'
    settled = settle(sg.load(pad(tmp_path, roof)), 0.05, "modes")
    (step,) = settled.steps
    assert not settled.reached and not settled.bars and step.why == NOTHING_BEYOND


@pytest.mark.long
def test_a_wide_layer_has_bars_within_one_per_cent():
    """Beside spectral elements of order 4 on a quarter, as above, which lie above by 5e-4 at most."""
    settled = settle(sg.load(PAD), 0.01, "modes")
    found = sg.modes(settled.body, sg.load(PAD), 10)
    assert settled.reached and len(settled.bars) == 3 and settled.body.size < 10_000
    for mode, hertz in zip(found.modes, [1504.3, 1504.3, 1504.6]):
        assert 0 < 1 - hertz / mode.frequency_hz < settled.bars[Quantity(mode.name)]


@pytest.mark.long
def test_the_list_of_a_3d_solid_is_complete_below_the_lower_ends_of_what_follows():
    scene = shaft((0.02, 0.08, 0.08), (0.1, 0.03, 0.03), (0.02, 0.08, 0.08))
    stiff = np.diag([5e7, 2e7, 5e7, 0.0, 0.0, 0.0])
    bearings = [
        Bearing(name=n, y=y, seat_width=0.01, matrix=stiff) for n, y in (("A", 0.04), ("B", 0.1))
    ]
    port = Port(name="p", y=0.01, lo=0.005, hi=0.015)
    scene = Scene.from_parts(scene.segments, bearings=bearings, port=port)
    body = sg.build(scene, "solid", element="tet10", refinement=0.3)
    found = sg.modes(body, scene, 12, count=True, room=ROOM)
    truth = sg.modes(sg.build(scene, "harmonic", **FINE), scene, 24).whole
    bars = mode_bars(scene, body, as_supports(scene), found)
    checked = [m for m in found.modes if m.name in bars]
    assert len(checked) >= 7
    for mode in checked:
        error = 1 - truth.named(mode.name).frequency_hz / mode.frequency_hz
        assert error <= bars[mode.name] <= 4 * error, mode.name
    evidence = complete_list(scene, body, as_supports(scene), found).evidence
    shapes = [
        sum(m.multiplicity for m in modes.modes if 0 < m.frequency_hz < evidence[COMPLETE])
        for modes in (found.whole, truth)
    ]
    assert evidence[COMPLETE] < evidence["counted_below_hz"] and shapes[1] <= shapes[0]
