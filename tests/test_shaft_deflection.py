"""Deflection of a shaft alone: error bars against a finer mesh, the cheapest model, what is shown."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.loading import as_written
from solidgear.strength.deflection.at_rest import deflect, deflection
from solidgear.strength.deflection.sheet import bearings, displacements
from solidgear.strength.load import AT_REST
from solidgear.trains.assembly.assembly import Assembly

GEOMETRY = Path(__file__).parent.parent / "geometry"
CATALOGUE = GEOMETRY / "gearbox_catalogue.toml"
SPRINGS = GEOMETRY / "pinion_overhung.toml"
LOAD = ("--load", "z=2 kN, x=500 N, y=300 N")


def coarse(assembly, order=3):
    """The same shaft on a mesh that is set."""
    return replace(assembly, settings={"harmonic": {"order": order, "layers": 1}})


@pytest.mark.parametrize(
    ("file", "load"),
    [
        pytest.param(CATALOGUE, None, marks=pytest.mark.slow),
        pytest.param(SPRINGS, {"z": 2000.0, "x": 500.0, "y": 300.0}, marks=pytest.mark.long),
    ],
    ids=["catalogue", "springs"],
)
def test_error_bars_hold_against_a_finer_mesh(file, load):
    scene = as_written(file)
    scene = scene.with_changes(load=load) if load else scene
    fine = coarse(Assembly.of(scene, kept=6), order=5)
    truth, solved = (
        deflection(assembly, AT_REST, "harmonic").displacement for assembly in (fine, coarse(fine))
    )
    assert [*solved] == [station.name for station in scene.stations]
    for place, measures in solved.items():
        errors = [abs(m.value - t.value) for m, t in zip(measures, truth[place])]
        bars = [m.bar for m in measures]
        assert bars[4] is None  # the shaft turns freely
        assert all(error <= bar for error, bar in zip(errors, bars) if bar is not None), place
    errors = [abs(m.value - t.value) for m, t in zip(solved["pinion"], truth["pinion"])]
    bars = [m.bar for m in solved["pinion"]]
    assert np.linalg.norm(bars[:3]) < 4 * np.linalg.norm(errors[:3])


@pytest.mark.long
def test_a_load_along_the_axis_widens_no_bar_across_it():
    scene = as_written(SPRINGS)
    bars = []
    for load in ({"z": 1.0}, {"y": 5e4, "z": 1.0}):
        assembly = coarse(Assembly.of(scene.with_changes(load=load), kept=6))
        bars.append(deflection(assembly, AT_REST, "harmonic").displacement["pinion"][2].bar)
    assert bars[1] == pytest.approx(bars[0], rel=0.05)


def test_a_bearing_that_carries_nothing_is_named():
    scene = as_written(CATALOGUE).with_changes(load={"y": -300.0})
    notes = deflection(Assembly.of(scene, kept=6), AT_REST, "euler").notes
    assert any(note.startswith("bearing shaft.A carries no load within") for note in notes)


def test_models_of_a_shaft_are_judged_by_the_motion_of_its_port():
    scene = as_written(SPRINGS).with_changes(load={"z": 2000.0}, ask={"tolerance": 0.2})
    found = deflect(
        coarse(Assembly.of(scene, kept=6), order=2), models=("rigid", "timoshenko", "harmonic")
    )
    assert [standing.verdict for standing in found.standings] == ["beyond", "within"]
    assert "20 % of the motion of pinion: timoshenko (" in found.verdict()
    assert found.load.port == "pinion" and not found.why_without_bar


@pytest.mark.long
def test_a_shaft_is_shown_with_its_bars_or_the_reason_why_it_has_none(run, tmp_path):
    how = "deflect", SPRINGS, *LOAD, "-f", "timoshenko"
    said = run(*how, "-f", "harmonic", "--out", tmp_path)[1]
    assert "Under x 500.0 N, y 300.0 N, z 2000 N at pinion" in said
    assert said.count("error bar") == 4 and "% of the motion of pinion" in said
    bare = " ".join(run(*how)[1].split())
    assert (
        "No error bars: they come with a solid, such as harmonic" in bare
        and "mesh force" not in bare
    )
    data = json.loads((tmp_path / "deflection.json").read_text())
    assert data["load"] == [500.0, 300.0, 2000.0, 0.0, 0.0, 0.0] and data["why_without_bar"] == ""
    model = data["models"]["harmonic"]
    assert model["displacement"]["pinion"]["z"]["value"] == pytest.approx(
        model["ports"]["pinion"][2], rel=1e-12
    )
    assert model["displacement"]["pinion"]["z"]["bar"] > 0
    assert {"name", "model", "stations", "line", "ports", "bearings"} <= model.keys()


@pytest.mark.slow
def test_a_shipped_shaft_with_cuts_deflects_as_answer_says():
    """0.607335 um/kN +- 0.037 % along z by `answer`; the plain pinion has 0.5959."""
    judge = sg.deflect("geometry/pinion_keyed.toml", load="z=1 kN").judge
    moved = judge.displacement["pinion"][2]
    assert judge.model == "corrected"
    assert abs(moved.value - 0.607335e-6) <= moved.bar + 0.00037 * 0.607335e-6
    assert moved.bar < 1e-3 * moved.value


def test_bearing_loads_of_a_shaft_with_a_cut_are_those_that_stress_has():
    """To all digits, with springs against tilt, whose share follows from the shaft: both begin on the
    coarsest mesh and go on as error bars ask.
    """
    spring = {"kxx": 4e8, "kyy": 2e8, "kzz": 4e8, "kthx": 1e5}
    shaft = sg.load(
        {
            "material": "steel",
            "segment": [{"kind": "cylinder", "name": "s", "length": 0.12, "diameter": 0.04}],
            "bearing": [
                {"name": name, "position": y, "seat_width": 0.012, "stiffness": spring}
                for name, y in (("A", 0.015), ("B", 0.105))
            ],
            "port": {"name": "gear", "position": 0.06, "span": [0.055, 0.065]},
            "load": {"z": 1e3},
            "feature": [
                {"kind": "keyway", "segment": "s", "position": 0.03, "length": 0.02}
                | {"name": "key", "width": 0.012, "depth": 0.005}
            ],
        }
    )
    (deflected,) = sg.deflect(shaft, "corrected").judge.shafts
    (stressed,) = sg.stress(shaft, "corrected").shafts
    for bearing in deflected.bearings:
        assert np.array_equal(bearing.load, -stressed.acting.loads[bearing.name])


def test_models_asked_for_by_name_do_not_leave_cuts_out():
    with pytest.raises(sg.SolidgearError, match="of revolution"):
        sg.deflect("geometry/pinion_keyed.toml", "timoshenko", load="z=2 kN")


def test_what_is_rounding_beside_a_twist_is_shown_as_zero():
    """A torque from B to the middle: nothing bends, and the twist is that of the textbook with a
    torque spread over either seat.
    """
    found = sg.deflect("geometry/shaft_stepped.toml", "timoshenko", drive={"B": "100 N*m"}).judge
    carried, *_ = bearings(found)
    assert carried.values == [[f"shaft.{name}", 0.0, None, 0.0, 0.0] for name in "AB"]
    *_, at_b = displacements(found).values
    shear, thick, thin = 207e9 / 2.6, np.pi * 0.08**4 / 32, np.pi * 0.06**4 / 32
    twist = 100 / shear * (0.16 / 3 / thick + (0.0975 + 0.025 / 3) / thin)
    # a beam spreads a torque over the elements of a seat
    assert at_b == ["shaft.B", 0.0, 0.0, 0.0, 0.0, pytest.approx(twist, rel=3e-3), 0.0]


def test_a_slender_shaft_that_bends_far_is_held():
    """F L^3 / (48 E I) and F L^2 / (16 E I) of Euler's beam on pinned seats of 2 mm."""
    ends = [sg.Bearing(name=n, position=y, seat_width=2e-3, hold="pinned") for n, y in ENDS]
    rod = sg.Segment.cylinder("rod", length=1.01, diameter=0.02)
    middle = sg.Port(name="middle", position=0.505, span=(0.504, 0.506))
    scene = sg.Scene.from_parts([rod], "steel", bearings=ends, port=middle, load={"z": 1e3})
    both = sg.deflect(scene, ["euler", "timoshenko"])
    # by symmetry the middle does not tilt: what rounding leaves of that judges no model
    assert both.verdict().startswith("Cheapest model within 5 % of the motion of middle: euler")
    found = both.solutions[0]
    bending = 210e9 * np.pi * 0.02**4 / 64
    assert found.displacement["middle"][2].value == pytest.approx(1e3 / 48 / bending, rel=1e-4)
    assert found.displacement["A"][3].value == pytest.approx(1e3 / 16 / bending, rel=1e-4)


ENDS = (("A", 0.005), ("B", 1.005))
