"""Every number of a file of rows has its bar beside it, or the file says why not."""

import csv

import pytest

import solidgear as sg
from tests.command import command, numbers

SHAFT = "geometry/shaft_stepped.toml"
SPRINGS = ("--vary", "bearing.A.scale=1,2")


@pytest.fixture(scope="module")
def rows(tmp_path_factory):
    path = tmp_path_factory.mktemp("bars") / "rows.csv"
    told = command("sweep", SHAFT, *SPRINGS, "--tol", "0.02", "-n", "4", "-o", path)
    assert told.exit_code == 0, told.output
    return numbers(path)


@pytest.mark.long
def test_bars_beside_numbers_of_a_sweep_of_bearings_hold_a_much_finer_mesh(rows):
    """The bound of the reduction says nothing of the mesh, whose error is a thousand times as large."""
    scene = sg.load(SHAFT)
    truth = sg.build(scene, "harmonic", order=6)
    there = sg.condense(truth, scene, scene.port.name)
    row = rows[0]
    off = {
        "C_thx": abs(row["C_thx"] - there.compliance[3, 3]),
        "C_zz": abs(row["C_zz"] - there.compliance[2, 2]),
        "K_thz": abs(row["K_thz"] - there.stiffness[5, 5]),
        "K_z,thx": abs(row["K_z,thx"] - there.stiffness[2, 3]),
    }
    for name, error in off.items():
        assert error <= row[f"{name} bar"] < 0.02 * abs(row["K_zz" if "_z," in name else name])
    assert off["C_thx"] > 1e3 * row["reduction_bound"] * row["C_thx"]
    modes = {str(mode.name): mode.frequency_hz for mode in sg.modes(truth, scene, n=6).modes}
    for k in range(1, 5):
        assert abs(row[f"f{k}_hz"] - modes[row[f"mode{k}"]]) <= row[f"f{k}_hz bar"]
    assert row["about_bars"] == "of the mesh: the largest over 3 bearing sets"


@pytest.mark.parametrize("vary", ["bearing.A.scale=1,2", "segment.left.diameter=50 mm,52 mm"])
def test_a_file_of_a_model_that_is_given_says_that_it_has_no_bars(vary, tmp_path):
    path = tmp_path / "rows.csv"
    command("sweep", SHAFT, "--vary", vary, "-f", "timoshenko", "-n", "2", "-o", path)
    with path.open(newline="") as file:
        row = next(csv.DictReader(file))
    assert row["about_bars"] == "none: the timoshenko mesh was given; -f auto has error bars"
    assert not any(name.endswith(" bar") and name != "mass bar" for name in row)


def test_a_design_and_a_derivative_say_what_they_have_no_bar_of():
    found = sg.optimise(SHAFT, ["segment.left.diameter=48 mm:50 mm"], "min C_zz", model="euler")
    assert found.results["about_bars"] == "none: the euler mesh was given; -f auto has error bars"
    moved = sg.sensitivities(SHAFT, "euler", of=["C_zz"], by=["material.E"]).as_dict()
    (number,) = moved["numbers"]
    assert 0 <= number["from_coarser_mesh"] < 1e-3 * number["value"]
    assert "no proven bound" in moved["about_bars"]
