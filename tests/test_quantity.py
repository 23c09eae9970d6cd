"""Names of compared numbers and of modes are texts that know what they say."""

import copy
import json
import pickle

import numpy as np
import pytest
from pydantic import TypeAdapter

from solidgear.core.body.mode_names import ModeName
from solidgear.core.frames import DOF_NAMES
from solidgear.core.quantity import ACROSS, BLOCK_UNITS, QUANTITIES, Quantity


@pytest.mark.parametrize("name", [Quantity("C_z,thx@wheel@pinion"), ModeName("bending x 2")])
def test_a_name_is_its_text_wherever_it_goes(name):
    """In JSON, in a process of its own, in a copy and as a key."""
    text = str(name)
    assert name == text and hash(name) == hash(text) and f"{name}" == text and {text: 1}[name] == 1
    assert json.dumps({name: name}) == json.dumps({text: text})
    for same in (pickle.loads(pickle.dumps(name)), copy.deepcopy(name)):
        assert type(same) is type(name) and vars(same) == vars(name)
    adapter = TypeAdapter(type(name))
    read = adapter.validate_json(json.dumps(text))
    assert type(read) is type(name) and adapter.dump_json(read) == json.dumps(text).encode()


def test_an_entry_is_named_by_its_row_and_column():
    entries = [q for q in (*QUANTITIES, *ACROSS) if not q.is_frequency]
    for name in entries:
        row, column = (DOF_NAMES[k] for k in name.place)
        letters = name.symbol[2:]
        assert letters in (f"{row},{column}", row + column, row)
        assert (row == column) is not name.is_coupling
    assert {q.unit for q in entries} == {unit for units in BLOCK_UNITS.values() for unit in units}


def test_an_entry_is_the_work_of_its_loads():
    # bars share the energy of the loads out over cells, whoever shows a quantity reads the entry
    matrix = np.arange(36.0).reshape(6, 6)
    for name in (q for q in (*QUANTITIES, *ACROSS) if not q.is_frequency):
        motion, load = map(np.array, name.loads)
        assert name.of(matrix) == matrix[name.place] == motion @ matrix @ load
        assert name.of(matrix.tolist()) == matrix[name.place]
        assert name.components == set(name.place)


@pytest.mark.parametrize("text", ["C_zq", "K_", "bending 1", "pair 1", "c_zz", ""])
def test_what_is_no_entry_is_the_frequency_of_a_mode(text):
    name = Quantity(text)
    assert name.is_frequency and name.unit == "Hz" and name.diagonals is None


@pytest.mark.parametrize(
    ("text", "family", "plane", "number", "rigid"),
    [
        ("bending 12", "bending", "", 12, False),
        ("bending z 1", "bending", "z", 1, False),
        ("ovalising n=2 3", "ovalising n=2", "", 3, False),
        ("rigid bending", "bending", "", None, True),
        ("rigid (combined)", "(combined)", "", None, True),
    ],
)
def test_parts_of_the_name_of_a_mode(text, family, plane, number, rigid):
    name = ModeName(text)
    assert (name.family, name.plane, name.number, name.rigid) == (family, plane, number, rigid)
