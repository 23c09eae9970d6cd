"""The fillets of a STEP part are fillets where stress is asked for, and every model that is offered settles."""

from pathlib import Path

import pytest

import solidgear as sg
from solidgear.core.ladder.registry import LADDER
from solidgear.core.loading import as_written
from solidgear.core.scene import Fillet, Port
from solidgear.core.scene.closed_form import volume_of
from solidgear.core.scene.filleted import filleted
from solidgear.cuts.features import CrossHole, Keyway
from solidgear.strength.stress.at_rest import _file_cautions
from solidgear.trains.assembly.assembly import Assembly
from validation.step_parts import write_step

GEOMETRY = Path(__file__).parents[1] / "geometry"
SCENE = """
material = "steel"
[body]
step = "part.step"
[[bearing]]
name = "A"
seat = { diameter = "40 mm", from = "5 mm", to = "25 mm" }
catalogue = { designation = "6008" }
[port]
name = "gear"
seat = { diameter = "60 mm", from = "60 mm", to = "80 mm" }
[load]
z = "1 kN"
"""
ROOTS = (
    Fillet(name="left", y="50 mm", radius="6 mm"),
    Fillet(name="right", y="90 mm", radius="5 mm"),
    Fillet(name="rim", y="50 mm", radius="3 mm", edge="rim"),
)


@pytest.fixture(scope="module")
def part(tmp_path_factory):
    """Three diameters with a fillet at each shoulder, and one rim rounded off."""
    widths = [("a", 0.0, 0.05, 0.04), ("b", 0.05, 0.04, 0.06), ("c", 0.09, 0.06, 0.045)]
    segments = [
        sg.Segment.cylinder(name, y0=y0, length=length, diameter=diameter)
        for name, y0, length, diameter in widths
    ]
    port = Port(name="gear", position=0.07, lo=0.06, hi=0.08)
    drawn = sg.Scene.from_parts(segments, blends=ROOTS, port=port)
    folder = tmp_path_factory.mktemp("filleted")
    write_step(folder / "part.step", segments, corners=drawn.corners)
    return folder, drawn


def test_fillets_of_a_step_part_are_those_that_were_drawn(part):
    """Root fillets by their radii, the rounded rim as cones of its volume; catalogue bearings are read as
    they are written.
    """
    folder, drawn = part
    (folder / "scene.toml").write_text(SCENE)
    scene = as_written(folder / "scene.toml")
    assert scene.bearings[0].catalogue is not None
    round_part = filleted(scene)
    assert round_part.body is None
    fillets = {(round(b.y, 6), round(b.radius, 6)) for b in round_part.blends}
    assert fillets == {(0.05, 0.006), (0.09, 0.005)}
    assert [b.name.partition(".")[2] for b in round_part.blends] == ["end", "start"]
    assert volume_of(round_part.outline) == pytest.approx(volume_of(drawn.outline), rel=1e-6)
    (sentence,) = _file_cautions(scene.body, round_part)
    assert "1 of 3 arcs of part.step are modelled as short cones" in sentence


def test_a_scene_of_segments_is_as_it_was():
    scene = sg.load(GEOMETRY / "pinion_filleted.toml")
    assert filleted(scene) is scene


def keyed(*features):
    rod = sg.Segment.cylinder("rod", length=0.2, diameter=0.06)
    return sg.Scene.from_parts([rod], features=features)


KEY = Keyway(name="k", segment="rod", y=0.1, length=0.04, width=0.018, depth=0.007)
HOLE = CrossHole(name="h", segment="rod", y=0.05, diameter=0.005)


@pytest.mark.parametrize("features", [(), (KEY,), (KEY, HOLE)])
@pytest.mark.parametrize("model", LADDER.bodies)
def test_every_model_that_is_offered_settles_what_the_scene_has(model, features):
    """The plain part, or all of it by models that are made for what it has; else what is said is true."""
    scene = keyed(*features)
    why = LADDER[model].unfit(Assembly.of(scene).settling(model).meshed_scene("shaft", model))
    assert bool(why) == (not LADDER[model].concerns(scene)), why
