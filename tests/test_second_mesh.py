"""Bars of a 3D solid whose mesh is set, from a second, coarser one, beside the harmonic solid."""

import json

import pytest

import solidgear as sg
from validation.shipped import GEOMETRY

SCENES = [
    ("cylinder_free", ("refinement=0.5",)),
    pytest.param("cylinder_free", ("element=tet10", "refinement=0.8"), marks=pytest.mark.long),
]


@pytest.mark.parametrize("name, settings", SCENES)
def test_bars_of_a_mesh_that_is_set_hold_what_the_harmonic_solid_says(run, name, settings):
    path = GEOMETRY / f"{name}.toml"
    code, out, _ = run("modes", path, "-f", "solid", "--json", *(f"--set={s}" for s in settings))
    scene = sg.load(path)
    exact = sg.modes(sg.build(scene, "harmonic", order=6), scene, n=24)
    rows = [mode for mode in json.loads(out)["modes"] if mode["frequency_hz"] > 0]
    assert code == 0 and len(rows) > 4
    for mode in rows:
        # the harmonic solid itself is good to some 1e-6
        off = mode["frequency_hz"] / exact.named(mode["name"]).frequency_hz - 1
        assert -2e-6 < off < mode["bar"] + 2e-6 < 0.05, mode["name"]


def test_the_second_mesh_may_be_left_out(run):
    code, out, _ = run(
        "modes", GEOMETRY / "cylinder_free.toml", "-f", "solid", "--no-bars", "--set=refinement=0.4"
    )
    assert code == 0 and "No bars: the model was given" in out


def test_a_mesh_of_the_fewest_cells_has_no_coarser_one_and_no_bar(run, tmp_path):
    path = tmp_path / "block.toml"
    material = "material = { E = 2.1e11, nu = 0.3, density = 7850.0 }"
    path.write_text(f"{material}\nbody = {{ block = [0.02, 0.03, 0.01] }}\n")
    code, out, _ = run("modes", path, "-f", "solid", "--json", "-n", "2", "--set=refinement=0.05")
    assert code == 0 and {mode["bar"] for mode in json.loads(out)["modes"]} == {None}
