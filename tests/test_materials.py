"""Materials by name: known constants, in both places of a file, and a sentence for all others."""

import pytest

import solidgear as sg
from solidgear.core.errors import SceneError
from solidgear.core.scene.materials import MATERIALS, by_name

SCENE = """
material = "{top}"
segment = [
    {{kind = "cylinder", name = "a", length = 0.3, diameter = 0.06}},
    {{kind = "cylinder", name = "b", length = 0.05, diameter = 0.1, material = "{own}"}},
]
port = {{at = "b.middle", attach_to = "b"}}
"""


def read(folder, top, own):
    path = folder / "a.toml"
    path.write_text(SCENE.format(top=top, own=own))
    return sg.load(path)


def test_a_name_stands_for_its_constants(tmp_path):
    shaft, ring = (s.material for s in read(tmp_path, "42crmo4 ", "EN-GJS-400").segments)
    assert (shaft.E, shaft.nu, shaft.density) == (210e9, 0.3, 7850.0)
    assert (ring.E, ring.nu, ring.density) == (169e9, 0.275, 7100.0)


@pytest.mark.parametrize("name", MATERIALS)
def test_constants_are_those_of_a_metal(name):
    """Wave speed along a rod: 4.5 to 5.3 km/s in all of them; a slip in units is far off."""
    known = MATERIALS[name]
    assert 4500 < (known.E / known.density) ** 0.5 < 5300
    assert 0.25 < known.nu < 0.35 and known.source
    assert sg.Material(**by_name(name)).E == known.E


@pytest.mark.parametrize(
    "top, own, words",
    [
        ("42CrMo", "steel", 'material = "42CrMo": material "42CrMo" is not known by name; did you'),
        ("steel", "Laminations", 'segment[2] "b".material = "Laminations": a laminated stack has'),
        ("", "steel", "give E, nu and density, or one of steel"),
    ],
)
def test_what_has_no_name_is_told(top, own, words, tmp_path):
    with pytest.raises(SceneError) as told:
        read(tmp_path, top, own)
    assert words in str(told.value)
