"""Words and numbers that are printed of a train: each once, none that is rounding, none in pieces."""

from types import SimpleNamespace

import numpy as np
import pytest

import solidgear as sg
from solidgear.show.command import say
from solidgear.show.units import ENGINEERING
from solidgear.strength.deflection.at_rest import Measured, deflect
from solidgear.strength.deflection.sheet import meanings
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.layout import senses
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.load.operation import Operating
from solidgear.trains.response.at_speed import Coincidence
from solidgear.trains.response.sheet import coincidences, every_coincidence
from solidgear.trains.system.equilibrium import without_rounding

GEARBOX, REDUCER = "geometry/gearbox_train.toml", "geometry/reducer.toml"


@pytest.fixture(scope="module")
def assembly():
    return Assembly(sg.load_train("geometry/gearbox_two_stage.toml"))


def test_the_engine_turns_its_shaft_the_way_of_its_torque_and_against_it_on_coast(assembly):
    for torque in (100.0, -100.0):
        point = OperatingPoint(torque=torque, of=assembly.train.reference)
        found = senses(assembly.train, assembly.on_flank(point.coast).contacts, point.coast)
        state = Operating(assembly, "timoshenko").at(point)
        driven = np.sign(torque) * state.outside["engine"][4]
        assert found[assembly.train.reference] == ("+y" if driven > 0 else "-y")
    # shafts that mesh outside, scenes of one sense along their axes
    assert found["input"] == found["output"] != found["middle"]


def test_a_carrier_turns_with_its_sun():
    train = sg.load_train(REDUCER)
    found = senses(train, Assembly(train).contacts)
    (stage,) = train.stages
    assert len({found[side] for side in stage.shafts}) == 1


def test_what_is_rounding_beside_the_largest_load_is_no_load_of_a_bearing():
    large, small = np.array([1e5, 1e-9, 0, 0, 0, 0]), np.array([0, 2.0, 3e-7, 0, 0, 0.5])
    found = without_rounding([large, small], 0.1)  # a moment of 1 N m is 10 N there
    np.testing.assert_array_equal(found, [[1e5, 0, 0, 0, 0, 0], [0, 2.0, 0, 0, 0, 0.5]])


def test_numbers_in_groups_of_digits_stay_on_one_line(capsys):
    say("x" * 76 + " 15\u00a0137 N", soft_wrap=False)
    first, second = capsys.readouterr().out.splitlines()
    assert second == "15\u00a0137 N" and set(first) == {"x"}


def test_what_misalignments_mean_is_said_once_for_all_meshes():
    def mesh(name, width):
        return [
            Measured(f"across {name}", "rad moved", "slope across it", 0.0, None, mesh=f" {name}"),
            Measured(
                f"f_sh {name}", "m moved", "over the face", 0.0, None, None, f" {name}", width
            ),
        ]

    alike = meanings([*mesh("a-b", 0.04), *mesh("b-c", 0.04)], ENGINEERING)
    assert alike == "across: slope across it; f_sh: over 40 mm of face"
    both = meanings([*mesh("a-b", 0.04), *mesh("b-c", 0.05)], ENGINEERING)
    assert both.endswith("f_sh: over the face (40 mm a-b, 50 mm b-c)")


def test_ten_near_orders_are_shown_and_a_file_has_all():
    near = [Coincidence(f"mesh {k}", "bending 1", 1.0 * k, 1.0, 0.01, 60.0) for k in range(93)]
    found = SimpleNamespace(coincidences=near, within=0.05, shaft="pinion")
    shown = coincidences(found, 10)
    assert len(shown.rows) == 10 and "83 more" in shown.note and "near.csv" in shown.note
    assert len(every_coincidence(found).rows) == 93
    assert not coincidences(found).note


def test_a_deflection_tells_the_sense_of_every_shaft(assembly):
    point = OperatingPoint(torque=100.0, of="input")
    found = deflect(assembly, point, ("timoshenko",))
    assert set(found.as_dict()["senses"]) == {"input", "middle", "output"}
