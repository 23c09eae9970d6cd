"""Contents of decks that are not solved: masses, springs, links and materials are told, and units and
formats are read from what is in the file.
"""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.scene.file_materials import FileMaterial
from solidgear.core.scene.materials import by_name
from solidgear.core.scene.parts import Material
from solidgear.parts.decks.universal import unit_of
from tests.command import command
from validation.mesh_files import rod, write_mesh

POINTS, CELLS = rod((0.0, 5.0, 10.0), (0, 10, 20, 30, 40))
HALF = len(CELLS) // 2
GROUPS = {"1": list(range(HALF)), "2": list(range(HALF, len(CELLS)))}
ALL = {"1": list(range(len(CELLS)))}
NEW = len(POINTS) + 1
FIRST = ", ".join(f"{v:.5g}" for v in POINTS[4])


def scene_file(folder, ending, text="", before="", groups=None, unit='unit = "mm"', name="part"):
    """A scene of a rod in a deck with more text in it, at its end or, of bulk data, before that."""
    sound = folder / f"sound.{ending}"
    write_mesh(sound, POINTS, "tetra", CELLS, ALL if groups is None else groups)
    deck = before + sound.read_text()
    deck = deck.replace("ENDDATA", f"{text}ENDDATA") if ending == "bdf" else deck + text
    (folder / f"{name}.{ending}").write_text(deck)
    path = folder / "rod.toml"
    path.write_text(
        f'material = "steel"\n[body]\nmesh = "{name}.{ending}"\n{unit}\n'
        '[port]\nat = "s1.middle"\nattach_to = "s1"\n'
    )
    return path


def remarks(path):
    """Doubts about the file of a scene."""
    scene = sg.load(path)
    return list(scene.body.doubts(scene.material))


MASS = "[[mass]]"
LEFT_OUT = {
    "point mass": ("bdf", "CONM2   9001    5               0.5\n", "1 CONM2", MASS),
    "masses of springs": ("bdf", "CMASS2,9001,0.25,5,1\n", "1 CMASS2", MASS),
    "bush": ("bdf", f"GRID,{NEW},,9.,9.,9.\nCBUSH,9001,7,{NEW},5\n", "1 CBUSH", "[[bearing]]"),
    "spring": ("bdf", "CELAS1,9001,8,5,1\n", "1 CELAS1", "with a stiffness"),
    "rigid": ("bdf", "RBE2,9001,5,123456,1,2\n", "1 RBE2", "attachment ="),
    "averaging": ("bdf", "RBE3,9001,,5,123,1.,123,1,2\n", "1 RBE3", '"average"'),
    "held": ("bdf", "SPC1,1,123,5\n", "1 SPC1", "clamped"),
    "held in a node": ("bdf", f"GRID,{NEW},,9.,9.,9.,,123\nCELAS1,1,8,{NEW}\n", "held motions", "clamped"),
    "beam": ("bdf", "CBAR,9001,9,5,6,1.,0.,0.\n", "1 CBAR", "solid elements"),
    "mass": ("inp", "*ELEMENT, TYPE=MASS, ELSET=M\n9001, 5\n9002, 6\n*MASS, ELSET=M\n0.25\n", "2 MASS", MASS),
    "springs": ("inp", "*ELEMENT, TYPE=SPRINGA, ELSET=S\n9001, 5, 6\n*SPRING, ELSET=S\n\n1e5\n", "1 SPRINGA", "[[bearing]]"),
    "links": ("inp", "*MPC\nBEAM, 5, 6\n", "1 *MPC", "attachment ="),
    "coupling": ("inp", "*COUPLING, REF NODE=5, SURFACE=x\n*KINEMATIC\n", "1 *COUPLING", "attachment ="),
    "shells": ("inp", "*ELEMENT, TYPE=S3, ELSET=K\n9001, 5, 6, 7\n*SHELL SECTION, ELSET=K\n1.\n", "1 S3", "solid elements"),
    "lumped": ("unv", f"    -1\n  2412\n{9001:10d}{161:10d}{1:10d}{1:10d}{7:10d}{1:10d}\n{5:10d}\n    -1\n", "1 mass of kind 161", MASS),
}  # fmt: skip


@pytest.mark.parametrize("case", LEFT_OUT)
def test_what_a_deck_carries_beside_its_solids_is_told_with_what_to_write(case, tmp_path):
    ending, text, named, way = LEFT_OUT[case]
    (told,) = (r for r in remarks(scene_file(tmp_path, ending, text)) if "left out" in r)
    assert told.startswith(f"part.{ending}: left out, beside solid elements: ")
    assert named in told and way in told.split("; write ")[1]


@pytest.mark.parametrize("case", ["point mass", "masses of springs", "mass"])
def test_masses_are_told_with_their_sum_and_the_first_place(case, tmp_path):
    ending, text, _, _ = LEFT_OUT[case]
    total = 0.25 if case == "masses of springs" else 0.5
    place = f"{'the first ' * (case == 'mass')}at ({FIRST}) of the file"
    (told,) = (r for r in remarks(scene_file(tmp_path, ending, text)) if "left out" in r)
    assert f"(mass {total} in the unit of the deck, {place})" in told


SURFACES = "*ELEMENT, TYPE=CPS3, ELSET=faces\n9001, 5, 6, 7\n"
FACES = f"    -1\n  2412\n{9001:10d}{91:10d}{1:10d}{1:10d}{7:10d}{3:10d}\n{5:10d}{6:10d}{7:10d}\n    -1\n"


@pytest.mark.parametrize("ending, text", [("inp", ""), ("inp", SURFACES), ("unv", FACES), ("bdf", "PLOTEL,1,1,2\n")])  # fmt: skip
def test_groups_of_faces_and_lines_that_meshers_write_carry_nothing(ending, text, tmp_path):
    assert not [r for r in remarks(scene_file(tmp_path, ending, text)) if "left out" in r]


def test_every_command_tells_a_mass_that_is_left_out(tmp_path):
    path = scene_file(tmp_path, "bdf", LEFT_OUT["point mass"][1])
    assert "1 CONM2" in command("check", path).stdout
    assert "1 CONM2" in command("modes", path, "-f", "timoshenko").stderr


@pytest.mark.parametrize(
    "young, nu, density, steel",
    [
        (210000.0, 0.3, 7.85e-9, True),
        (2.1e8, 0.3, 7.85e-6, True),
        (2.1e11, 0.3, None, True),
        (30457.9e3, 0.3, 0.283599, True),  # psi and lb / in^3
        (206000.0, 0.3, 7.85e-9, False),
        (210000.0, 0.33, 7.85e-9, False),
        (210000.0, 0.3, 7.2e-9, False),
        (70000.0, None, None, False),
    ],
)
def test_a_material_is_known_in_any_system_of_units(young, nu, density, steel):
    told = FileMaterial(name="m", group="g", E=young, nu=nu, density=density)
    assert told.is_like(Material(**by_name("steel"))) is steel


def test_materials_of_a_deck_are_held_against_those_of_the_scene(tmp_path):
    """By group where the scene names materials by group, else against [material]."""
    cards = "MAT1,1,7.+4,,.33,2.7-9\nPSOLID,1,1\nMAT1,2,2.1+5,8.0769+4,,7.85-9\nPSOLID,2,2\n"
    path = scene_file(tmp_path, "bdf", cards, groups=GROUPS)
    (told,) = (r for r in remarks(path) if "are not read" in r)
    assert "MAT1 1 with E 70000, nu 0.33, density 2.7e-09 in the units of the file" in told
    assert "MAT1 2" not in told  # nu of E and G
    alloy = '{ E = "70 GPa", nu = 0.33, density = 2700 }'
    path.write_text(path.read_text() + f"[body.materials]\n1 = {alloy}\n")
    assert not [r for r in remarks(path) if "are not read" in r]


UNIT = (
    "    -1\n   164\n{code:10d}{words:20s}{2:10d}\n".replace("{2:10d}", f"{2:10d}")
    + "{0:25.16E}{0:25.16E}{1:25.16E}\n{1:25.16E}\n    -1\n"
)


def told_unit(code, length):
    return UNIT.format(length, 1.0, code=code, words="mm (milli-newton)")


@pytest.mark.parametrize("code, length, unit", [(1, 1.0, 1.0), (5, 1e3, 1e-3), (7, 39.37, 0.0254), (9, 100.0, 0.01), (10, 1e3, 1e-3)])  # fmt: skip
def test_a_universal_file_says_its_unit(code, length, unit):
    assert unit_of(told_unit(code, length)) == pytest.approx(unit)


def test_a_unit_that_a_universal_file_says_may_be_left_out_and_is_held_against_the_scene(tmp_path):
    said = told_unit(5, 1e3)
    bare = sg.load(scene_file(tmp_path, "unv", before=said, unit=""))
    assert bare.length == pytest.approx(0.04) and not bare.body.remarks
    (told,) = remarks(scene_file(tmp_path, "unv", before=said, unit='unit = "inch"'))
    assert 'says that lengths are in mm, but unit = "inch" of the [body] is taken' in told
    assert "by a factor of 25.4" in told
    assert not remarks(scene_file(tmp_path, "unv", before=said))
    for ending in ("unv", "inp"):
        with pytest.raises(
            sg.SceneError, match=rf"body.unit.*part.{ending} does not give the unit"
        ):
            sg.load(scene_file(tmp_path, ending, unit=""))


@pytest.mark.parametrize("ending", ["bdf", "inp", "unv"])
def test_a_deck_that_ends_otherwise_is_known_by_what_is_in_it(ending, tmp_path):
    scene_file(tmp_path, ending)
    (tmp_path / f"part.{ending}").rename(tmp_path / "part.dat")
    path = tmp_path / "rod.toml"
    path.write_text(path.read_text().replace(f"part.{ending}", "part.dat"))
    assert sg.load(path).body.counts[3] == len(CELLS)


def test_another_program_s_deck_is_refused_by_its_content(tmp_path):
    scene_file(tmp_path, "inp")
    (tmp_path / "part.dat").write_text("/prep7\nnblock,3\n")
    path = tmp_path / "rod.toml"
    path.write_text(path.read_text().replace("part.inp", "part.dat"))
    with pytest.raises(sg.SceneError, match="ends in .dat is unknown.*neither Nastran, Abaqus nor"):
        sg.load(path)


@pytest.mark.parametrize(
    "ending, text, sentence",
    [
        ("inp", "*INCLUDE, INPUT=nodes.inp\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n", r"line 1: \*INCLUDE names another file \(nodes.inp\)"),
        ("inp", "*NODE, INPUT=nodes.txt\n", r"line 1: \*NODE names another file \(nodes.txt\)"),
        ("bdf", "BEGIN BULK\nINCLUDE 'nodes.bdf'\nENDDATA\n", r"line 2: INCLUDE names another file \(nodes.bdf\)"),
    ],
)  # fmt: skip
def test_an_include_is_named(ending, text, sentence, tmp_path):
    path = scene_file(tmp_path, ending)
    Path(tmp_path / f"part.{ending}").write_text(text)
    with pytest.raises(sg.SceneError, match=sentence):
        sg.load(path)


def test_a_bearing_on_a_face_says_why_it_has_a_width(tmp_path):
    path = tmp_path / "face.toml"
    text = (
        'material = "steel"\n'
        'segment = [{ kind = "cylinder", name = "s", length = 0.1, diameter = 0.01 }]\n'
        'bearing = [{ name = "wall", face = "start", hold = "clamped"MORE }]\n'
        'port = { name = "tip", at = "s.end", span = [0.095, 0.1] }\n'
    )
    path.write_text(text.replace("MORE", ""))
    with pytest.raises(sg.SceneError, match="seat_width: .*face stands for the position alone"):
        sg.load(path)
    # nothing that is solved depends on it
    found = []
    for width in (0.002, 0.01):
        path.write_text(text.replace("MORE", f", seat_width = {width}"))
        scene = sg.load(path)
        found.append(sg.condense(sg.build(scene, "timoshenko"), scene, "tip").compliance)
    assert found[0] == pytest.approx(found[1], rel=1e-9, abs=1e-9 * np.abs(found[0]).max())
