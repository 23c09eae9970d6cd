"""Fillets of parts from files: tori of revolution are as round as cylinders."""

import pytest

import solidgear as sg
from solidgear.core.scene import Fillet
from solidgear.core.scene.closed_form import mass_properties
from solidgear.cuts.features import Keyway
from solidgear.guards.round_part import described
from validation.step_parts import write_step

SCENE = """
material = "42CrMo4"
body = { step = "part.step" }
port = { name = "end", position = "140 mm", span = ["130 mm", "150 mm"] }
"""
SIZES = (("a", 0.06, 0.04), ("b", 0.02, 0.056), ("c", 0.08, 0.03))


def segments():
    made, y = [], 0.0
    for name, length, diameter in SIZES:
        made.append(sg.Segment.cylinder(name, length=length, diameter=diameter, y0=y))
        y = made[-1].y1
    return made


FILLETS = (
    Fillet(name="left", y=0.06, radius=0.003),
    Fillet(name="right", y=0.08, radius=0.004),
    Fillet(name="rim", y=0.16, radius=0.002),
)


def part(folder, features=()):
    corners = [fillet.corner(segments()) for fillet in FILLETS]
    write_step(folder / "part.step", segments(), features, corners=corners)
    (folder / "scene.toml").write_text(SCENE)
    return sg.load(folder / "scene.toml")


@pytest.mark.long
def test_a_filleted_shaft_from_a_file_is_the_one_written_down(tmp_path):
    """Two roots and a rim: the same mass, and the same bending by the harmonic solid, within bars."""
    scene = part(tmp_path)
    written = sg.Scene.from_parts(
        segments(), port=scene.port, blends=FILLETS, material=scene.material
    )
    assert scene.body.round and scene.body.round_share == pytest.approx(1.0, abs=1e-12)
    masses = [mass_properties(s.outline).mass for s in (scene, written)]
    assert masses[0] == pytest.approx(masses[1], rel=1e-6)
    # where a fillet ends, the surface is that of its neighbours: tangent to one, on the other's face
    left = [s for s in scene.segments if 0.057 - 1e-9 < s.y0 < 0.06 - 1e-9]
    assert (left[0].outer0, left[-1].outer1) == pytest.approx((0.020, 0.023), abs=1e-8)
    # the arc of 4 mm is 0.034 mm high over a sixth of a quarter, and cones of its volume cross it
    assert "up to 0.02 mm off" in next(described(scene)).sentence

    own, true = (sg.answer(s, 0.01, "bending") for s in (scene, written))
    assert own.reached and own.rung == true.rung == "harmonic"
    gap = abs(own["bending 1"] / true["bending 1"] - 1)
    assert gap < own.bar + true.bar < 2e-3
    # the fillets themselves are twice as much as that and more
    sharp = sg.Scene.from_parts(segments(), port=scene.port, material=scene.material)
    without = sg.answer(sharp, 0.01, "bending")["bending 1"]
    assert abs(without / true["bending 1"] - 1) > 2 * (own.bar + true.bar)


@pytest.mark.long
def test_a_keyway_into_a_fillet_is_not_round(tmp_path):
    key = Keyway(name="key", segment="c", y=0.09, length=0.03, width=0.008, depth=0.004)
    scene = part(tmp_path, [key])
    assert scene.body.round_share > 0.8 and not scene.body.round
