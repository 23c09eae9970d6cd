"""Entries that are found from resonances are those that every study has: materials by name, factors."""

import pytest

import solidgear as sg
from solidgear.measured.data import load_measured
from solidgear.measured.identify import identify

SHAFT = """
material = %s
segment = [
    { kind = "cylinder", name = "a", length = "120 mm", diameter = "40 mm" },
    { kind = "cylinder", name = "b", length = "200 mm", diameter = "50 mm" },
]
%s
port = { name = "gear", at = "b.middle", attach_to = "b" }
"""
BEARINGS = """bearing = [
    { name = "A", position = "20 mm", seat_width = "15 mm", %s stiffness = { kxx = "3e8 N/m", kyy = "1e8 N/m", kzz = "3e8 N/m" } },
    { name = "B", position = "-20 mm", from = "end", seat_width = "15 mm", stiffness = { kxx = "3e8 N/m", kzz = "3e8 N/m" } },
]"""
#: bars of the modes; a modulus goes with the square of a frequency, a factor on one bearing with its
#: tenth power at least
TOLERANCE = 1e-3
OTHER = '{ E = "203 GPa", nu = 0.3, density = "7850 kg/m^3" }'


def peaks(folder, text):
    """Resonances of a scene as a file of measured ones."""
    path = folder / "true.toml"
    path.write_text(text)
    scene = sg.load(path)
    found = sg.modes(sg.build(scene, "harmonic", order=4), scene, n=10)
    listed = [mode.frequency_hz for mode in found.modes if mode.frequency_hz > 0][:4]
    data = folder / "peaks.csv"
    data.write_text("frequency [Hz]\n" + "".join(f"{f!r}\n" for f in listed))
    return load_measured(data)


def found(folder, text, measured, *vary):
    path = folder / "scene.toml"
    path.write_text(text)
    return identify(path, measured, vary, tol=TOLERANCE)


def test_a_modulus_of_a_material_by_name_is_found(tmp_path):
    measured = peaks(tmp_path, SHAFT % (OTHER, ""))
    (modulus,) = found(tmp_path, SHAFT % ('"steel"', ""), measured, "material.E").entries
    assert modulus.before == 210e9
    assert modulus.value == pytest.approx(203e9, rel=2 * TOLERANCE)


@pytest.mark.long
def test_a_factor_on_a_bearing_is_found_though_the_file_leaves_it_out(tmp_path):
    measured = peaks(tmp_path, SHAFT % ('"steel"', BEARINGS % "scale = 1.4,"))
    scene = SHAFT % ('"steel"', BEARINGS % "")
    (factor,) = found(tmp_path, scene, measured, "bearing.A.scale").entries
    assert factor.before == 1
    assert factor.value == pytest.approx(1.4, rel=10 * TOLERANCE)
