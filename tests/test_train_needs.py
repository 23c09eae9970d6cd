"""A train is asked for what a command uses, and for nothing else."""

import pytest

from solidgear.backlash.train import teeth_of
from solidgear.core.errors import SceneError, SolidgearError
from solidgear.core.scene.file import load
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.reading import load_train
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.response.respond import respond
from tests.command import command

SHAFT = """material = "steel"
segment = [{ kind = "cylinder", name = "s", length = "300 mm", diameter = "60 mm" }]
bearing = [
    { name = "A", position = "50 mm", seat_width = "15 mm", stiffness = { kxx = "2e8 N/m", kyy = "1e8 N/m", kzz = "1e8 N/m" } },
    { name = "B", position = "250 mm", seat_width = "15 mm", stiffness = { kxx = "2e8 N/m", kzz = "1e8 N/m" } },
]
port = { name = "wheel", at = "s.middle", span = ["140 mm", "160 mm"] }
"""
PAIR = """[pinion]
scene = "shaft.toml"
teeth = 20
module = "3 mm"
{pinion}
[gear]
scene = "shaft.toml"
teeth = 20
{gear}
[mesh]
shaft_angle = 0
pressure_angle = "20 deg"
stiffness = "3e8 N/m"
{mesh}
{more}
"""
ROTORS = """[engine]
inertia = 0.1
spring = {{ stiffness = 1e4, at = "{at}" }}
[load]
inertia = 0.1
spring = {{ stiffness = 1e4, at = "{at}" }}
"""


@pytest.fixture
def pair(tmp_path):
    """Path of a train of two shafts, with lines of a file in some of its tables."""
    (tmp_path / "shaft.toml").write_text(SHAFT)

    def written(**lines):
        tables = {"pinion": "", "gear": "", "mesh": "", "more": ""} | lines
        path = tmp_path / "train.toml"
        path.write_text(PAIR.format(**tables))
        return path

    return written


def frequencies(path):
    assembly = Assembly(load_train(path))
    return [
        mode.frequency_hz for mode in train_modes(assembly, "euler", max_frequency=2500.0).modes
    ]


def test_frequencies_need_teeth_and_a_mesh_alone(pair):
    """No engine, load, transmission error, hand, face width or flank; with the flank they are the same."""
    bare, told = frequencies(pair()), frequencies(pair(pinion='loaded_side = "left"'))
    assert bare == pytest.approx(told, rel=1e-12) and len(bare) > 5
    (text,) = Assembly(load_train(pair())).cautions()
    assert "the left flank of the pinion is taken" in text
    assert Assembly(load_train(pair(gear='loaded_side = "right"'))).cautions() == ()


def test_the_flank_of_the_gear_is_that_of_the_pinion(pair):
    here, there = (pair(**{side: 'loaded_side = "right"'}) for side in ("pinion", "gear"))
    assert frequencies(here) == pytest.approx(frequencies(there), rel=1e-12)


def test_a_command_that_is_driven_asks_for_the_error(pair):
    assembly = Assembly(load_train(pair()))
    with pytest.raises(SceneError, match="it is what drives the teeth") as error:
        respond(assembly, "euler", highest_hz=500.0)
    assert error.value.problems[0].path == ("mesh", "transmission_error")
    force = {"gear.wheel": [0, 0, 100.0, 0, 0, 0]}
    assert len(respond(assembly, "euler", highest_hz=500.0, forces=force).frequency_hz) > 10


def test_a_torque_asks_for_where_it_comes_in_and_goes_out(pair):
    with pytest.raises(SceneError, match=r"write \[engine\] and \[load\]") as error:
        load_train(pair(more="[operation]\ntorque = 10"))
    assert error.value.problems[0].path == ("operation",)
    assembly = Assembly(load_train(pair(mesh='transmission_error = "1 um"\nbacklash = "50 um"')))
    with pytest.raises(
        SolidgearError, match=r"no torque passes the pinion: it comes in at \[engine\]"
    ):
        teeth_of(assembly, mean_force=1000.0)
    whole = pair(
        more=ROTORS.format(at="A") + "[operation]\ntorque = 10", pinion='loaded_side = "left"'
    )
    assert load_train(whole).point.torque == 10


def test_helical_teeth_are_asked_for_their_hand(pair):
    with pytest.raises(SceneError, match="hand: is missing"):
        Assembly(load_train(pair(pinion="helix_angle = 0.2")))


def test_as_many_modes_are_listed_as_are_asked_for(pair):
    """Without a frequency, so many; with one, at most so many."""
    file = pair(more="[ask]\nmodes = 8")
    train = load_train(file)
    found = train_modes(Assembly(train), "euler", at_most=train.ask.modes)
    assert len(found.modes) == 8 + found.rigid
    done = command("system-modes", file, "--pinion", "euler", "--gear", "euler")
    assert done.exit_code == 0 and "\n 9 │" in done.output and "\n10 │" not in done.output
    low = found.modes[3].frequency_hz * 1.0001
    assert len(train_modes(Assembly(train), "euler", max_frequency=low, at_most=8).modes) < 8


CHAIN = """[shaft.{a}]
scene = "shaft.toml"
teeth = 20
module = "3 mm"
[shaft.{b}]
scene = "shaft.toml"
teeth = 30
module = "3 mm"
[shaft.{c}]
scene = "shaft.toml"
teeth = 20
[[mesh]]
between = ["{a}", "{b}"]
shaft_angle = 0
pressure_angle = 0.35
stiffness = 3e8
[[mesh]]
between = ["{b}", "{c}"]
shaft_angle = 0
pressure_angle = 0.35
stiffness = 3e8
azimuth = "180 deg"
"""


def test_flanks_of_a_chain_follow_from_the_first(pair):
    """What drives the idler on its left flank is driven on the right one of the next."""
    path = pair()
    path.write_text(CHAIN.format(a="one", b="two", c="three"))
    train = load_train(path)
    assert [one.pinion.flank for one in train.pairs] == ["left", "right"]
    assert Assembly(train).system("euler").free.shape[1] == 1


def masses_of(tmp_path, *masses):
    path = tmp_path / "discs.toml"
    step = SHAFT.replace('"300 mm", diameter = "60 mm" }', '"150 mm", diameter = "60 mm" },')
    step = step.replace(
        "},]", '}, { kind = "cylinder", name = "t", length = "150 mm", diameter = "70 mm" }]'
    )
    rows = "".join(
        f"[[mass]]\nmass = {m}\nposition = {y}\nseat_width = {w}\n" for m, y, w in masses
    )
    path.write_text(
        step.replace(
            '"s.middle", span = ["140 mm", "160 mm"]', '"s.end", span = ["120 mm", "150 mm"]'
        )
        + rows
    )
    return load(path).masses


def test_masses_need_no_names_and_may_sit_across_a_step(tmp_path):
    """A disc on a step is carried by the longer piece of its seat, and its mass stays where it was."""
    first, second = masses_of(tmp_path, (3.0, 0.145, 0.03), (1.0, 0.1, 0.01))
    assert [first.name, second.name] == ["mass 1", "mass 2"]
    assert (first.lo, first.hi) == pytest.approx((0.13, 0.15), abs=1e-12)
    assert first.y + first.offset[1] == pytest.approx(0.145, abs=1e-12)
    assert second.offset == (0.0, 0.0, 0.0) and second.y == 0.1
