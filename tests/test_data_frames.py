"""Results as data frames and as data sets: in SI whatever a reader chose, with names, units and bars."""

import re
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.show.frames import quantities
from solidgear.show.table import Cell, Column, Table, numbers, quantity
from solidgear.show.units import ENGINEERING, SYSTEMS, US

pandas = pytest.importorskip("pandas")
xarray = pytest.importorskip("xarray")

ROOT = Path(__file__).parent.parent
GEOMETRY = ROOT / "geometry"
#: a number with its unit, or without, as a text: what a program cannot read
WRITTEN = re.compile(r"[<>±+−-]*\s*\d[\d\s.,e+-]*( %|[a-zµ/ ]*)?")


HOLLOW = GEOMETRY / "shaft_hollow.toml"
GEARS, CATALOGUE = GEOMETRY / "gearbox_train.toml", GEOMETRY / "gearbox_catalogue.toml"
PORT = "pinion.pinion:z"
STUDIES = {
    "modes": lambda: sg.modes(sg.build(sg.load(HOLLOW), "timoshenko"), sg.load(HOLLOW), n=6),
    "stiffness": lambda: sg.condense(
        sg.build(sg.load(HOLLOW), "timoshenko"), sg.load(HOLLOW), "port"
    ),
    "answer": lambda: sg.answer(sg.load(HOLLOW), tol=0.1, ask="bending"),
    "compare": lambda: sg.compare(sg.load(HOLLOW), models=("euler", "timoshenko")),
    "sensitivities": lambda: sg.sensitivities(HOLLOW, "euler", of=["C_zz"]),
    "deflect": lambda: sg.deflect(GEARS, "euler"),
    "bearing": lambda: sg.bearing(CATALOGUE),
    "stress": lambda: sg.stress(CATALOGUE),
    "system_modes": lambda: sg.system_modes(GEARS, "euler"),
    "receptance": lambda: sg.receptance(GEARS, PORT, PORT, "euler"),
}


class Solved(dict):
    """Results by the names of their studies, each solved when it is first looked at."""

    def __missing__(self, name):
        self[name] = STUDIES[name]()
        return self[name]


@pytest.fixture(scope="module")
def results():
    return Solved()


@pytest.mark.long
def test_every_result_has_a_frame_of_numbers_with_units(results):
    texts = set()
    for name in STUDIES:
        result = results[name]
        for key in result.framed_tables():
            frame = result.to_dataframe(key)
            assert len(frame) and frame.columns.is_unique, name
            assert set(frame.attrs["units"]) <= set(frame.columns)
            for column in frame.columns.difference(["as written", "written"]):
                if any(isinstance(v, str) and WRITTEN.fullmatch(v) for v in frame[column]):
                    texts.add((name, key, column))
    assert texts == set()


@pytest.mark.parametrize("name", ["deflect", "stress", "receptance", "sensitivities"])
def test_a_frame_is_in_si_whatever_a_reader_chose(results, name):
    from solidgear.show.sheet import tables_of

    chosen = [tables_of(results[name].sheet(units)) for units in SYSTEMS]
    for key in chosen[0]:
        first, *others = [tables[key].to_dataframe() for tables in chosen]
        for other in others:
            assert first.equals(other) and first.attrs["units"] == other.attrs["units"], key


def test_values_stand_beside_their_units_and_error_bars(results):
    answer = results["answer"]
    frame = answer.to_dataframe().set_index("quantity")
    first = answer.values[0]
    assert frame.loc[first.quantity, "value"] == first.value
    assert frame.loc[first.quantity, "error bar"] == first.bar
    numbers_of = results["compare"].to_dataframe("numbers").set_index(["model", "quantity"])
    record = results["compare"].record.models["euler"]
    assert numbers_of.loc[("euler", "C_zz"), "value"] == record.compliance[2][2]
    assert numbers_of.loc[("euler", "C_zz"), "unit"] == "m/N"


def test_axes_become_dimensions(results):
    modes = results["modes"].to_xarray()
    assert dict(modes.sizes)["component"] == 6 and list(modes.component.values)[:2] == ["x", "y"]
    assert modes.y.attrs["units"] == "m" and modes.frequency.attrs["units"] == "Hz"
    mode = results["modes"].named("bending 1")
    shape = modes.motion.sel(shape="bending 1 a").transpose("y", "component")
    assert np.array_equal(shape.values, mode.motions[0])
    matrix = results["stiffness"].to_xarray()
    stiffness = matrix.stiffness.transpose("row", "column").values
    assert np.array_equal(stiffness, results["stiffness"].stiffness)
    response = results["receptance"].to_xarray()
    value = results["receptance"].receptances[0].value
    assert np.allclose(response["real part"] + 1j * response["imaginary part"], value, rtol=1e-12)
    assert response["real part"].attrs["units"] == "m/N" and "frequency" in response.dims
    shafts = [name for name in results["deflect"].framed_tables() if name.startswith("deflection_")]
    line = results["deflect"].to_xarray(shafts[0])
    shaft = results["deflect"].judge.shafts[0]
    assert np.array_equal(line.x.values, shaft.line[:, 0]) and line.x.attrs["units"] == "m"


def test_rows_of_a_sweep_over_two_entries_are_a_grid(tmp_path):
    varied = ["segment.tube.bore=30 mm,40 mm,50 mm", "material.E=200 GPa,210 GPa"]
    rows = sg.sweep(GEOMETRY / "shaft_hollow.toml", varied, model="euler", n=2)
    grid = rows.to_xarray()
    assert dict(grid.sizes) == {"segment.tube.bore": 3, "material.E": 2}
    frame = rows.to_dataframe()
    picked = frame[(frame["segment.tube.bore"] == 0.04) & (frame["material.E"] == 210e9)]
    at = {"segment.tube.bore": 0.04, "material.E": 210e9}
    assert float(grid.f2_hz.sel(at)) == picked["f2_hz"].item()
    assert frame.attrs["units"]["f2_hz"] == "Hz"


def test_what_cannot_be_is_refused_in_a_sentence(results, monkeypatch):
    with pytest.raises(SolidgearError, match='no table .shape.; did you mean "shapes"'):
        results["modes"].to_dataframe("shape")
    with pytest.raises(SolidgearError, match="no axes: to_dataframe"):
        results["answer"].to_xarray()
    twice = numbers({"y [m]": [0.0, 0.0], "x [m]": [1.0, 2.0]}, axes=1)
    with pytest.raises(SolidgearError, match="rows at one place"):
        twice.to_xarray()
    monkeypatch.setitem(__import__("sys").modules, "xarray", None)
    with pytest.raises(SolidgearError, match=r"needs xarray: pip install 'solidgear\[tables\]'"):
        numbers({"y [m]": [0.0]}, axes=1).to_xarray()


def test_names_and_units_come_from_heads():
    columns = [
        *("frequency [Hz]", "time, s", "Hz", "C_z,thx", "", "torque, N m"),
        quantity("torque", "N m", US),
        Column("range", name="least", unit="Pa"),
    ]
    assert quantities(Table("", columns)) == {
        "frequency": "Hz",
        "time": "s",
        "frequency 2": "Hz",
        "C_z,thx": "",
        "row": "",
        "torque": "N m",
        "torque 2": "N m",
        "least": "Pa",
    }


def test_a_column_of_frames_alone_is_not_shown():
    columns = ["a", Column("unit", hidden=True), quantity("b", "m", ENGINEERING)]
    table = Table("", columns, [["x", "m", 0.002], [Cell("y", text="Y"), "rad", None]])
    assert table.heads == ["a", "b, mm"] and table.texts == [["x", "2.0000"], ["Y", "–"]]
    assert list(table.to_dataframe().columns) == ["a", "unit", "b"]
    assert list(table.to_dataframe()["a"]) == ["x", "y"]
    assert table.csv().splitlines()[0] == 'a,"b, mm"'


def test_shapes_of_a_train_are_motions_of_its_ports(tmp_path):
    found = sg.system_modes(GEOMETRY / "axle_overhung.toml", "euler", max_frequency=1000.0)
    shapes = found.to_xarray()
    turning = shapes.motion.sel(shape="train rotation", component="thy")
    teeth = [abs(float(turning.sel(port=port))) for port in ("gear.gear", "pinion.pinion")]
    # both turn as their numbers of teeth say, and all of a shaft alike
    train = found.assembly.train
    assert teeth[1] / teeth[0] == pytest.approx(abs(train.turns["pinion"] / train.turns["gear"]))
    system = found.assembly.system("euler", "euler")
    whole = found.solved.shapes
    assert np.allclose(np.einsum("ik,ij,jk->k", whole, system.mass, whole), 1.0)


@pytest.mark.long
def test_error_bars_of_displacements_stand_beside_them():
    study = sg.deflect(GEOMETRY / "shaft_stepped.toml", ["euler", "harmonic"], load="z=1 kN")
    moved = study.to_dataframe("displacements")
    assert [*moved["place"]] == ["shaft.port", "shaft.A", "shaft.B"]
    bars = study.judge.displacement["port"]
    assert moved["z error bar"][0] == pytest.approx(max(bars[2].bar, 1e-4 * abs(bars[2].value)))
    assert moved.attrs["units"]["z error bar"] == moved.attrs["units"]["z"] == "m"
    assert [*study.to_dataframe("motion_of_port")["model"]] == ["euler", "harmonic"]


def test_a_column_without_any_number_is_one_of_numbers():
    frame = Table("", ["a", "b", "c"], [["x", None, 1.0], ["y", None, None]]).to_dataframe()
    assert [str(kind) for kind in frame.dtypes[["b", "c"]]] == ["float64", "float64"]
    assert frame["b"].isna().all()
