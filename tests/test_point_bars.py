"""Bars of what lies between two points: their names, what they are relative to, that they hold, and
where they are told.
"""

import json
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.comparison.page.html import numbers
from solidgear.comparison.page.tables import further_points
from solidgear.comparison.recording import Findings, recorded
from solidgear.core.judge.quantities import between, canonical_name, measure, size
from solidgear.core.judge.settle import settle
from solidgear.core.judge.study import study
from solidgear.core.quantity import COMPLIANCE, Quantity
from solidgear.core.scene import Bearing, Port, Scene, Segment
from solidgear.guards.data import split_pair
from solidgear.guards.models import beam_against_solid
from solidgear.guards.probe import Probe
from solidgear.show.units import ENGINEERING
from tests.command import command
from validation.campaign.cases.points import judged, scene_of, solutions
from validation.campaign.rows import SMALL
from validation.campaign.truths.corner_mesh import corner_mesh
from validation.campaign.truths.reference import RATIO, SIZE, Reference
from validation.campaign.truths.spectral import spectral

GEOMETRY = Path(__file__).parent.parent / "geometry"
PATH = GEOMETRY / "intermediate_shaft.toml"


@pytest.fixture(scope="module")
def shaft():
    return sg.load(PATH)


@pytest.fixture(scope="module")
def settled(shaft):
    return settle(shaft, 0.05, "stiffness", points=["pinion"])


# --------------------------------------------------------------------------- names
def test_a_term_between_points_is_related_to_what_each_has_of_its_own():
    # z of a, a moment on b
    assert Quantity("C_z,thx@a@b").diagonals == ("C_zz@a@a", "C_thx@b@b")
    assert Quantity("K_thx@a@b").diagonals == ("K_thx@a@a", "K_thx@b@b")
    assert Quantity("K_thx@a@a").diagonals is None
    names = map(Quantity, ("C_zz@a@a", "K_zz@a@a", "C_zz@a@b", "C_zz@a", "C_zz"))
    assert [q for q in names if q.repeats] == ["C_zz@a@a"]
    assert Quantity("C_zz@a").pair is None


def test_names_as_they_are_asked(shaft):
    for asked, told in (
        ("C_zz@pinion@wheel", "C_zz@wheel@pinion"),  # by reciprocity
        # which of both moves and which is loaded matters
        ("C_z,thx@pinion@wheel", "C_z,thx@pinion@wheel"),
        ("C_zz@wheel@wheel", "C_zz"),
        ("C_zz@pinion@pinion", "C_zz@pinion"),
    ):
        assert canonical_name(shaft, Quantity(asked)) == told


@pytest.mark.parametrize(
    ("asked", "word"),
    [
        ("C_zz@wheel@pinon", 'no lumped point "pinon"'),
        ("K_zz@wheel@pinion", "which are held; ask for the compliance C_zz@wheel@pinion"),
        ("C_zz@wheel@pinion@wheel", "a term is between two points"),
        ("bending 1@wheel@pinion", "a frequency belongs to the whole shaft"),
    ],
)
def test_what_cannot_be_asked_is_refused_with_the_way_out(shaft, asked, word):
    with pytest.raises(sg.SolidgearError, match=word):
        sg.answer(shaft, ask=[asked])
    if not asked.startswith("bending"):
        with pytest.raises(sg.SceneError, match=word):
            shaft.with_changes(ask=sg.Ask(quantities=[asked]))


def test_a_name_with_the_sign_between_names_is_refused_beside_others(shaft):
    odd = shaft.further_ports[0].with_changes(name="pin@ion")
    with pytest.raises(sg.SceneError, match="must not contain @"):
        shaft.with_changes(further_ports=(odd,))
    alone = shaft.with_changes(port=shaft.port.with_changes(name="wh@el"), further_ports=())
    assert canonical_name(alone, Quantity("C_zz@wh@el")) == "C_zz"  # nothing to confuse it with


def test_measured_terms_are_entries_of_the_matrices(shaft):
    both = sg.condense(sg.build(shaft, "timoshenko"), shaft, ("wheel", "pinion"))
    found = measure(None, None, None, both)
    c, k = both.compliance, both.stiffness
    assert found["C_z,thx@wheel@pinion"] == c[2, 9] and found["C_z,thx@pinion@wheel"] == c[8, 3]
    assert found["K_z,thx@wheel@pinion"] == k[2, 9] and found["K_zz@wheel@wheel"] == k[2, 2]
    assert set(between(map(Quantity, ["C_zz", "C_z,thx", "K_yy"]), both.ports)) <= set(found)
    assert not any(name.startswith("C_yy@wheel@wheel@") for name in found)


# --------------------------------------------------------------------------- do they hold?
def light_truth(scene):
    """Statics of the reference's own elements, of orders 4 and 5 on six layers towards corners; in
    doubt by what the last order moves.
    """
    runs = []
    for order in (4, 5):
        body = spectral(scene, corner_mesh(scene, 6, SIZE, RATIO), order)
        both = sg.condense(body, scene, tuple(port.name for port in scene.ports))
        runs.append(measure(None, None, None, both))
    doubt = {q: abs(runs[1][q] - v) / size(runs[1], q) for q, v in runs[0].items()}
    return Reference(runs[1], doubt, [], [], [], 0, 0.0)


@pytest.mark.parametrize(
    "seed", [21, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (7, 13))]
)
def test_bars_hold_on_random_shafts_with_two_points(seed):
    """Against orders 5 and more on graded corners; seeds of a light reference, of three kinds."""
    scene = scene_of(seed)
    found = solutions(scene, most=2)
    truth = {"spectral": light_truth(scene)}
    for mesh, one in found.items():
        rows = judged(one["said"], truth, scene.title, mesh)
        crossed = [row for row in rows if Quantity(row.quantity).pair]
        assert len(crossed) >= 9 and all(row.held for row in crossed if row.judged)
        # errors that are there: a bar that any number would meet is no bar
        assert max(row.off for row in crossed) > SMALL


def test_a_term_that_symmetry_forbids_has_a_bar():
    """Two points in the middle plane: pushed there a shaft that is its own mirror does not tilt."""
    rod = Segment.cylinder("rod", length=0.4, diameter=0.04)
    disc = {"kxx": 4e8, "kyy": 1e8, "kzz": 4e8}
    ends = [
        Bearing(name=n, y=y, seat_width=0.02, stiffness=disc) for n, y in (("A", 0.02), ("B", 0.38))
    ]
    ports = [Port(name=n, y=0.2, lo=0.2 - w, hi=0.2 + w) for n, w in (("p", 0.01), ("q", 0.02))]
    scene = Scene.from_parts([rod], bearings=ends, port=ports[0], further_ports=(ports[1],))
    found = sg.answer(scene, tol=0.01, ask=["C_z,thx@p@q", "C_zz@p@q"])
    tilt, push = found.values
    assert tilt.zero and found.reached
    # of the geometric mean of C_zz at p and C_thx at q, which is all that there is to compare with
    assert tilt.size == pytest.approx(
        (push.size * sg.answer(scene, ask=["C_thx@q"]).values[0].size) ** 0.5, rel=0.1
    )
    assert 0 < tilt.bar < 0.01


def test_bars_of_the_whole_matrix(settled):
    bars = settled.bars
    for name in (
        "K_zz@wheel@wheel",
        "K_thy@wheel@pinion",
        "C_x,thz@pinion@wheel",
        "C_zz@wheel@pinion",
    ):
        assert 0 < bars[name] <= 0.05 and name in bars
    assert not any(name.repeats for name in bars)
    # the error of a compliance is a positive semidefinite matrix: between points no more than at them
    worst = max(bars[q] for q in ("C_zz", "C_thx", "C_zz@pinion", "C_thx@pinion"))
    assert max(b for q, b in bars.items() if q.pair and q.kind == COMPLIANCE) <= worst
    assert settled.reached and "K_zz@wheel@wheel" not in settled.missing


@pytest.mark.long
def test_stiffness_between_points_carries_what_its_inverse_loses(shaft):
    found = study(shaft, "harmonic", evidence=False, most=1, counted=False)
    here = found.ties["as scene"]
    lost = here.statics.coupled.evidence["stiffness_error"]
    assert (
        here.numbers.solver["K_zz@wheel@pinion"] == lost > here.numbers.solver["C_zz@wheel@pinion"]
    )


# --------------------------------------------------------------------------- where they are told
@pytest.mark.long
def test_the_command_tells_the_bar_of_every_block(settled):
    told = command("stiffness", PATH, "--port", "pinion,wheel", "--tol", "0.05")
    assert told.exit_code == 0
    for words in ("pinion itself", "between pinion and wheel", "wheel itself", "geometric mean"):
        assert words in told.stdout
    found = json.loads(
        command("stiffness", PATH, "--port", "wheel,pinion", "--tol", "0.05", "--json").stdout
    )
    assert found["bars"].keys() == settled.bars.keys()


def test_planes_that_nothing_couples_stay_apart(settled, shaft):
    both = sg.condense(settled.body, shaft, ("wheel", "pinion"))
    across, along = [0, 5, 6, 11], [2, 3, 8, 9]  # x thz and z thx of both
    for matrix in (both.stiffness, both.compliance):
        assert not matrix[np.ix_(across, along)].any()  # exact zeros, and no rounding to be read


def test_judged_and_reported(shaft):
    asked = ["C_zz", "C_zz@pinion@wheel"]
    scene = shaft.with_changes(ask=sg.Ask(quantities=asked, tolerance=0.05))
    solutions = {
        "timoshenko": study(scene, "timoshenko", evidence=False),
        "harmonic": study(scene, "harmonic", {"order": 3, "layers": 0}, evidence=False),
    }
    record = recorded(scene, Findings(solutions))
    assert record.verdict.judged == ["C_zz", "C_zz@wheel@pinion"]
    said = "Compliances are judged at wheel, between wheel and pinion; not at pinion."
    assert said in record.verdict.sentences
    row = next(r for r in record.deviations if r.quantity == "C_zz@wheel@pinion")
    solid, beam = (solutions[m].quantities for m in ("harmonic", "timoshenko"))
    apart = beam["C_zz@wheel@pinion"] - solid["C_zz@wheel@pinion"]
    assert row.relative == pytest.approx(
        apart / (solid["C_zz"] * solid["C_zz@pinion"]) ** 0.5, rel=1e-9
    )
    assert row.band > 0 and not any(r.quantity.repeats for r in record.deviations)
    first = {row[0]: row[1:] for row in numbers(record, ENGINEERING).rows}
    value, bar = first["Compliance across the shaft, wheel under loads on pinion, C_zz"]
    assert value[0].startswith("2.5") and bar.startswith("± ")
    table = further_points(record)
    assert "relative to the geometric mean" in table.note
    rows = iter(table.rows)
    next(row for row in rows if row[0].startswith("C_zz, wheel for a load on pinion"))
    against, bars = next(rows), next(rows)
    assert against[2] == "reference" or against[2][0] == "reference"
    assert bars[0] == "error bar" and bars[2].startswith("± ")


@pytest.mark.long
def test_a_pair_that_only_the_housing_splits_is_told(shaft):
    alike = shaft.with_changes(
        housing=None, bearings=tuple(b.with_changes(housing=None) for b in shaft.bearings)
    )
    uneven = alike.with_changes(housing=sg.load(PATH).housing)

    def said(scene, guard):
        return " ".join(n.sentence for n in guard(Probe(scene, sg.build(scene, "timoshenko"))))

    assert not said(alike, split_pair)
    assert "bearings that differ between x and z" in said(uneven, split_pair)
    assert "C_thx at wheel of the Euler beam" in said(alike, beam_against_solid)  # which of both
