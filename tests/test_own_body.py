"""The body of the file at rest: mass, deflection and stress are of the shaft with its cuts, and of the part
in its STEP file, not of the plain shaft that beams see.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core import as_supports
from solidgear.core.judge.bounded import static_bars
from solidgear.core.scene.own_mass import own_mass
from solidgear.cuts.features import BoltCircle, CrossHole, Flat, Keyway, Spline
from solidgear.cuts.features.mass import _drawn
from solidgear.strength.deflection.at_rest import AT_REST, deflection
from solidgear.strength.stress.spread_weight import SpreadWeight
from solidgear.trains.assembly.assembly import Assembly
from solidgear.variants.sweep.bench import surface
from solidgear.variants.sweep.sheet import sweep_sheet

ROOT = Path(__file__).parent.parent
PINS = ROOT / "tests" / "found" / "parts" / "pins_load.toml"
ROD = sg.Segment.cylinder("rod", length=0.2, diameter=0.06)
G = 9.80665


def cut(**fields):
    return {"segment": "rod", "angle": "30 deg", **fields}


KEY = Keyway(**cut(name="key", y=0.05, length=0.05, width=0.014, depth=0.006))
HOLE = CrossHole(**cut(name="hole", y=0.15, diameter=0.01, offset=0.008, inclination="20 deg"))


def keyed(features=(KEY,), **fields):
    """A rod on two bearings that resist each motion once."""
    spring = {"kxx": 1e9, "kzz": 1e9}
    bearings = [
        sg.Bearing(name="A", y=0.02, seat_width=0.02, stiffness={**spring, "kyy": 1e9}),
        sg.Bearing(name="B", y=0.18, seat_width=0.02, stiffness=spring),
    ]
    port = sg.Port(name="gear", y=0.12, lo=0.11, hi=0.13)
    return sg.Scene.from_parts([ROD], features=features, bearings=bearings, port=port, **fields)


@pytest.mark.parametrize(
    "features",
    [
        (KEY,),
        (Flat(**cut(name="flat", y=0.05, length=0.05, depth=0.006)),),
        (HOLE,),
        # two holes that cross, and share what they remove
        (
            CrossHole(**cut(name="a", y=0.1, diameter=0.01)),
            CrossHole(name="b", segment="rod", angle="120 deg", y=0.1, diameter=0.01),
        ),
    ],
    ids=["keyway", "flat", "oblique hole", "crossing holes"],
)
def test_mass_and_centre_of_cuts_are_those_of_the_kernel(features):
    """Closed forms against boolean solids of the mesher's kernel, which integrates to 1e-5."""
    scene = keyed(features)
    volume, centre = _drawn(features, scene.segments[0])
    found, plain = own_mass(scene), own_mass(scene.plain)
    removed = 7850 * volume
    assert plain.mass - found.mass == pytest.approx(removed, rel=2e-5)
    moment = plain.mass * np.array(plain.centre) - found.mass * np.array(found.centre)
    assert moment == pytest.approx(removed * np.array(centre), abs=2e-5 * removed * 0.2)
    # weight is spread so that it has both
    spread = SpreadWeight.of(scene, np.array([0.0, 0.0, -G]))
    six = spread.between(0.0, scene.length, about=0.0)
    assert six[2] == pytest.approx(-G * found.mass, rel=1e-12)
    assert six[3] == pytest.approx(-G * found.mass * found.centre[1], rel=1e-9)


def test_mass_of_teeth_and_bolt_circles_is_that_of_the_sector():
    """Mass of a mesh of flat and curved cells, to what eight arcs a hole lose of it."""
    spline = Spline(name="s", segment="rod", count=12, model="sector", angle="0 deg")
    bolts = BoltCircle(name="b", segment="rod", count=12, diameter=0.005, circle=0.03)
    scene = keyed((spline, bolts))
    mass = sg.build(scene, "sector", refinement=0.5).mass_matrix()[0, 0]
    assert own_mass(scene).mass == pytest.approx(mass, rel=2e-3)
    assert own_mass(scene).mass != pytest.approx(own_mass(scene.plain).mass, rel=1e-2)


@pytest.mark.parametrize("weight", ["-z", "x", "-y"])
def test_weight_is_that_of_the_part(weight):
    """Two discs on three pins weigh 1.453 kg at 77.1 mm by the kernel of the file, whatever the model, and
    bearings at 10 and 140 mm share it by the lever.
    """
    scene = sg.load(PINS).with_changes(load=None, weight=weight)
    file = scene.body
    first, second = (
        bearing.load
        for bearing in deflection(
            Assembly.of(scene, kept=6).settling("timoshenko"), AT_REST, "timoshenko"
        )
        .shafts[0]
        .bearings
    )
    way = "xyz".index(weight[-1])
    total = G * 7850 * file.volume * (-1 if weight[0] == "-" else 1)
    assert first[way] + second[way] == pytest.approx(total, rel=1e-9)
    if way != 1:
        share = (file.centre[1] - 0.01) / 0.13
        assert second[way] == pytest.approx(share * total, rel=1e-9)
    stress = sg.stress(scene)
    assert stress.model == "statics"
    # what the first bearing carries, but for the weight before the section
    forces = stress.shafts[0].found.forces
    before = forces.spread.between(0.0, 0.08, about=0.0)[way]
    assert forces.at(0.08)[way] == pytest.approx(first[way] - before, rel=1e-6)


def test_sections_that_are_not_round_have_no_nominal_stress():
    stress = sg.stress(PINS)
    rows = stress.shafts[0].found.nominal
    assert rows and not any(0.07 < row.y < 0.09 for row in rows)
    # both sides of a disc, and none of the pins beside it
    assert {row.section.outer for row in rows if row.y in (0.07, 0.09)} == {0.04}
    assert any("not round from y = 70 to 90 mm" in text for text in stress.cautions)


def test_deflection_is_that_of_the_keyed_shaft():
    """Deflection under 1 kN is compliance times load on the same body, between both bars, and that of the
    plain shaft is not.
    """
    deep = Keyway(
        name="key", segment="rod", y=0.09, length=0.06, width=0.02, depth=0.012, ends="square"
    )
    scene = keyed((deep,), load={"z": 1000.0})
    study = sg.deflect(scene, tol=0.05)
    judge = study.judge
    assert judge.model == "corrected" and [s.model for s in study.solutions][-2] == "timoshenko"
    moved = judge.displacement["gear"][2]
    body = sg.build(scene, "solid", refinement=0.5)
    compliance = sg.condense(body, scene, port="gear").compliance[2, 2]
    (bar,) = (
        b for q, b in static_bars(scene, body, as_supports(scene), ["gear"]).items() if q == "C_zz"
    )
    assert abs(moved.value - 1000 * compliance) <= moved.bar + 1000 * bar * compliance
    plain = sg.deflect(scene.plain, "harmonic").judge.displacement["gear"][2]
    assert abs(plain.value - moved.value) > 3 * (plain.bar + moved.bar)
    assert any("leave it out" in text for text in study.cautions)


@pytest.mark.slow
def test_deflection_of_a_step_part_is_that_of_its_solid():
    """-11.23 um +- 0.81 % by `answer`, and a tilt of -49.1 urad."""
    judge = sg.deflect(PINS).judge
    assert judge.model == "solid"
    z, thx = judge.displacement["shaft"][2:4]
    assert abs(z.value + 11.234e-6) <= z.bar + 0.0081 * 11.234e-6
    assert abs(thx.value + 49.1e-6) <= thx.bar + 0.5e-6
    assert z.bar < 0.05 * 11.2e-6  # as the file asks


def test_deflect_by_a_named_solid_takes_options_and_weight():
    scene = keyed(load={"z": 1000.0}, weight="-z")
    judge = sg.deflect(scene, "solid", settings={"refinement": 0.3}).judge
    total = sum(bearing.load[2] for bearing in judge.shafts[0].bearings)
    assert total == pytest.approx(1000 - G * own_mass(scene).mass, rel=1e-9)
    assert judge.barred
    with pytest.raises(sg.SolidgearError, match="a model that is named"):
        sg.deflect(scene, settings={"refinement": 0.3})


def test_a_sweep_under_load_takes_keyed_shafts(tmp_path):
    """A row is what `stress` says of the same file, and the mass has no mesh in it."""
    strength = {"yield_point": "490 MPa", "ultimate": "700 MPa", "group": "tempering"}
    material = sg.Material(E="210 GPa", nu=0.3, density=7850, strength=strength)
    scene = keyed(load={"z": 1000.0}).with_changes(material=material)
    path = tmp_path / "keyed.toml"
    scene.to_toml(path)
    rows = sg.sweep(path, "segment.rod.length=200 mm", ask=["stress"])
    assert rows["status"][0] == "ok"
    (shaft,) = sg.stress(path).shafts
    assert rows["fatigue_safety"][0] == pytest.approx(shaft.found.worst[0].rating.fatigue)
    assert rows["mass"][0] == pytest.approx(own_mass(scene).mass, rel=1e-12)
    assert "model that is given" not in " ".join(sweep_sheet(rows).terminal.closing)  # none was


def test_a_step_part_is_a_key_of_what_was_solved():
    """Two readings of one file are one body; a file with lists among its words is hashable."""
    one, other = sg.load(ROOT / "geometry" / "shaft_step.toml"), sg.load(PINS)
    assert len({surface(one), surface(one.with_bearing_scale(2.0)), surface(other)}) == 2
