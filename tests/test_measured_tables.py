"""Measured data, their tables and their file are one thing."""

import tomllib

import numpy as np
import pytest
from universal_files import mode, nodes, units, written

from solidgear.core import SceneError
from solidgear.measured.data import Measured, load_measured

TEXT = """# hung on two cords
uncertainty = "0.1 %"     # of all others
points = { unit = "mm", axis = "x", origin = "-80 mm" }
mode = [
    { frequency = "98.459 kHz", multiplicity = 2 },   # the pair
    { frequency = "121.2 kHz", uncertainty = "0.2 kHz", name = "torsion 1" },
]
"""


def test_tables_and_file_of_measured_data_read_back_equal(tmp_path):
    path = tmp_path / "tap.toml"
    path.write_text(TEXT)
    data = load_measured(path)
    assert Measured.from_dict(data.to_dict()) == data == Measured.from_dict(tomllib.loads(TEXT))
    assert data.to_toml() == TEXT
    first = data.mode[0].with_changes(frequency="98.5 kHz")
    changed = data.with_changes(mode=(first, data.mode[1]))
    assert changed != data
    assert changed.to_toml(path) == TEXT.replace("98.459 kHz", "98.5 kHz")
    assert load_measured(path) == changed
    with pytest.raises(SceneError, match=r'^tap: mode\[1\].frequency = "3 kg"'):
        Measured.from_dict({"mode": [{"frequency": "3 kg"}]}, name="tap")


def test_data_of_another_file_name_it(tmp_path):
    points = np.array([[0.0, 0, 0], [0, 0.1, 0], [0, 0.2, 0], [0.01, 0.1, 0]])
    shape = np.ones((4, 3))
    file = written(tmp_path / "tap.unv", units(), nodes(1e3 * points), mode(1, 250.0, shape))
    data = load_measured(file)
    assert data.to_dict() == {"file": str(file)} and Measured.from_dict(data.to_dict()) == data
    joined = tmp_path / "tap.toml"
    joined.write_text('shapes = "tap.unv"\nmode = [{ frequency = "250 Hz", shape = 1 }]\n')
    data, folder = load_measured(joined), tmp_path / "copy"
    assert Measured.from_dict(data.to_dict()) == data
    data.to_toml(folder / "tap.toml")
    assert 'shapes = "../tap.unv"' in (folder / "tap.toml").read_text()
    assert load_measured(folder / "tap.toml") == data
