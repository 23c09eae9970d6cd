"""Decks read line by line: what is sound comes in whole, what is not is refused with its line."""

import random

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.meshing.placing import TURNS, Placing
from solidgear.core.meshing.quality import MeshError
from solidgear.core.scene.outline import Outline
from solidgear.parts.decks import read
from solidgear.parts.mesh_file import mesh_from
from validation.fuzz.decks import DECK_CHANGES, DECKS
from validation.mesh_files import rod, write_mesh

PLACE = Placing(1e-3, TURNS["y"], (0.0, 0.0, 0.0))
POINTS, CELLS = rod((0.0, 5.0, 10.0), (0, 10, 20, 30, 40))
HALF = len(CELLS) // 2
GROUPS = {"left": list(range(HALF)), "right": list(range(HALF, len(CELLS)))}


def text_of(folder, ending):
    path = folder / f"sound.{ending}"
    write_mesh(path, POINTS, "tetra", CELLS, GROUPS)
    return path.read_text()


def deck(folder, ending, text):
    path = folder / f"part.{ending}"
    path.write_text(text)
    return read(str(path))


@pytest.mark.parametrize("ending", DECKS)
def test_a_sound_deck(ending, tmp_path):
    """Nodes, elements and both groups, and nothing odd about it."""
    found = deck(tmp_path, ending, text_of(tmp_path, ending))
    assert found.points.T == pytest.approx(POINTS, abs=1e-7)
    assert (found.cells.T == CELLS).all()
    assert not found.remarks
    halves = [g for g in found.groups if g.of_material]
    assert [len(g.elements) for g in halves] == [HALF, len(CELLS) - HALF]
    # another program's numbers may be any
    assert found.label(0).startswith("line ") and found.label(0).endswith("element 1")


@pytest.mark.parametrize("ending", DECKS)
@pytest.mark.parametrize("change", DECK_CHANGES, ids=lambda c: c.__name__)
def test_no_line_is_lost_in_silence(ending, change, tmp_path):
    """Refused, or told by check: with a line either way."""
    sound, dice = text_of(tmp_path, ending), random.Random(ending + change.__name__)
    for _ in range(6):
        path = tmp_path / f"part.{ending}"
        path.write_text(change(sound, dice))
        try:
            said = "; ".join(mesh_from(str(path), PLACE).remarks)
        except MeshError as error:
            said = str(error)
        assert "line" in said, said


INP = """*HEADING
** a comment
*NODE, NSET=all
1, 0., 0., 0.
2, 10., 0., 0.
3, 0., 0., 10.
4, 0., 10.
"""
TET = (
    "*NODE\n1, 0, 0, 0\n2, 10, 0, 0\n3, 0, 0, 10\n4, 0, 10, 0\n*ELEMENT, TYPE=C3D4\n7, 1, 3, 2, 4\n"
)
BULK = (
    "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.+1,0.,0.\n"
    # fields of eight letters; a blank one is zero
    f"GRID    {3:<8d}{'':24s}{'10.':8s}\nGRID    {4:<8d}{'':16s}{'10.':8s}\n"
)
UNV = "    -1\n  2411\n" + "".join(
    f"{k:10d}         1         1        11\n   {x}   {y}   {z}\n"
    for k, (x, y, z) in enumerate(((0, 0, 0), (10, 0, 0), (0, 0, 10), (0, 10, 0)), 1)
)
REFUSED = {
    "node short": ("inp", INP, "line 7: node 4 has 2 coordinates where 3 are wanted"),
    "no nodes": ("inp", "*HEADING\nnothing\n", "it holds no .NODE"),
    "no type": ("inp", TET.replace(", TYPE=C3D4", ""), "line 6: .ELEMENT without a TYPE"),
    "short": (
        "inp",
        TET.replace("7, 1, 3, 2, 4", "7, 1, 3, 2"),
        "line 7: element 7 of type C3D4 has 3 nodes where 4 are wanted",
    ),
    "long": ("inp", TET.replace("2, 4", "2, 4, 1"), "element 7 of type C3D4 has 5 nodes"),
    "empty block": ("inp", TET.split("7,")[0], "line 6: .ELEMENT with no element below it"),
    "twice": (
        "inp",
        TET + "7, 1, 3, 2, 4\n",
        "line 8: element 7 is given twice, first in line 7",
    ),
    "no such node": ("inp", TET.replace("2, 4\n", "2, 9\n"), "line 7: element 7 names node 9"),
    "spare": (
        "inp",
        TET.replace("*ELEMENT", "5, 1, 1, 1\n6, 2, 1, 1\n*ELEMENT"),
        "line 6: node 5, and 1 more like it, belongs to no element",
    ),
    "set": (
        "inp",
        TET + "*ELSET, ELSET=a\n7, 8\n",
        "line 9: group a lists element 8, which is not",
    ),
    "no end": ("inp", TET.rstrip(), "line 7: the file ends in the middle of the line of element 7"),
    "include": ("inp", "*NODE\n1,0,0,0\n*INCLUDE, INPUT=x.inp\n", "line 3: .INCLUDE names another"),
    "word": (
        "inp",
        TET.replace("7, 1", "7, one"),
        "line 7: an entry of an element of type C3D4 is 'one'",
    ),
    "two parts": (
        "inp",
        f"*PART, NAME=a\n{TET}*END PART\n*PART, NAME=b\n{TET}*END PART\n",
        "holds 2 parts with elements .a, b.",
    ),
    "bdf short": (
        "bdf",
        BULK + "CTETRA,7,1,1,3,2\nENDDATA\n",
        "line 6: element 7 of type CTETRA has 3",
    ),
    "bdf end": (
        "bdf",
        BULK + "CTETRA,7,1,1,3,2,4\n",
        "is cut off after line 6: it does not end with",
    ),
    "bdf system": (
        "bdf",
        BULK.replace("1,,0", "1,4,0") + "ENDDATA\n",
        "line 2: GRID 1 is given in system 4",
    ),
    "bdf number": (
        "bdf",
        BULK.replace("1.+1", "1.x1") + "ENDDATA\n",
        "line 3: GRID 2 has a coordinate",
    ),
    "unv end": ("unv", UNV, "the dataset that begins in line 1 does not end with -1"),
    "unv short": (
        "unv",
        UNV
        + f"    -1\n    -1\n  2412\n{7:10d}{111:10d}{1:10d}{2:10d}{7:10d}{4:10d}\n{1:10d}{3:10d}{2:10d}\n    -1\n",
        "line 14: element 7 of type 111 .tetra. has 3 nodes where 4 are wanted",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_deck_that_is_refused(case, tmp_path):
    ending, text, sentence = REFUSED[case]
    with pytest.raises(MeshError, match=sentence):
        deck(tmp_path, ending, text)


def test_decks_of_other_programs(tmp_path):
    """Lines that go on, fields without commas, exponents without E, assemblies, reference nodes."""
    assert deck(tmp_path, "inp", TET).cells.tolist() == [[0], [2], [1], [3]]
    goes_on = TET.replace("7, 1, 3, 2, 4", "7, 1, 3,\n2, 4")
    assert deck(tmp_path, "inp", goes_on).cells.shape == (4, 1)
    # a node that a coupling holds on to, and one in a small set
    held = TET.replace("*ELEMENT", "5, 0, 20, 0\n6, 0, 30, 0\n*ELEMENT")
    held += "*NSET, NSET=top\n6\n*RIGID BODY, NSET=end, REF NODE=5\n"
    assert deck(tmp_path, "inp", held).points.shape == (3, 6)
    assembly = f"*PART, NAME=a\n{TET}*ELSET, ELSET=s, GENERATE\n7, 7, 1\n*END PART\n*ASSEMBLY, NAME=x\n*INSTANCE, NAME=a-1, PART=a\n*END INSTANCE\n*NODE\n1, 5, 5, 5\n*NSET, NSET=ref\n1\n*END ASSEMBLY\n"
    assert [g.name for g in deck(tmp_path, "inp", assembly).groups] == ["s"]
    bulk = deck(
        tmp_path, "bdf", BULK + "CTETRA  7       3       1       3       2       4\nENDDATA\n"
    )
    assert bulk.points[0].tolist() == [0, 10, 0, 0] and bulk.points[2].tolist() == [0, 0, 10, 0]
    assert [g.name for g in bulk.groups] == ["3"]
    # the spider of a connection and a mass on its node
    spider = BULK + "GRID,5,,0.,20.,0.\nCONM2,90,5,,2.\nCTETRA,7,3,1,3,2,4\nENDDATA\n"
    assert deck(tmp_path, "bdf", spider).points.shape == (3, 5)


def test_a_missing_number_is_told_once(tmp_path):
    """In an otherwise unbroken row only: programs number as they like."""
    sound = text_of(tmp_path, "bdf")
    lines = sound.splitlines(keepends=True)
    first = next(k for k, line in enumerate(lines) if line.startswith("CTETRA"))
    # one at the surface: the hole is open
    radius = np.hypot(*POINTS[CELLS].mean(axis=1)[:, [0, 2]].T)
    place = int(np.argmax(radius))
    lost = "".join(lines[: first + place] + lines[first + place + 1 :])
    (remark,) = deck(tmp_path, "bdf", lost).remarks
    assert f"element {place + 1} is missing in the row of elements 1 to {len(CELLS)}" in remark
    assert f"after line {first + place}:" in remark
    # every second number left out is a way of counting
    spread = [
        f"CTETRA  {2 * int(line[8:16]):<8d}{line[16:]}" if line.startswith("CTETRA") else line
        for line in lines
    ]
    assert not deck(tmp_path, "bdf", "".join(spread)).remarks


def test_commands_tell_what_is_doubtful(tmp_path, capsys):
    """On the terminal beside the numbers, for commands without cautions of their own."""
    from solidgear.show.remarks import load

    write_mesh(tmp_path / "part.inp", POINTS, "tetra", CELLS, GROUPS)
    scene = tmp_path / "scene.toml"
    scene.write_text(
        'material = "steel"\n[body]\nmesh = "part.inp"\nunit = "mm"\n'
        '[port]\nname = "gear"\nposition = "20 mm"\nspan = ["15 mm", "25 mm"]\n'
    )
    load(scene)
    said = capsys.readouterr()
    assert "caution: part.inp has groups of_left, of_right, and all of it is taken" in said.err
    assert not said.out


def test_a_list_of_elements_that_ends_early_is_told(tmp_path):
    """Elements in any order, the last of them lost while what is left needs every node: their numbers
    run through, the file ends as it should, and only the surface shows it.
    """
    from solidgear.core.meshing.tetrahedra import tetrahedra

    mesh = tetrahedra(
        Outline([sg.Segment.cylinder("rod", length=0.04, diameter=0.02)]), size=0.006
    ).mesh
    used, corners = np.unique(mesh.t, return_inverse=True)
    cells = np.random.default_rng(1).permutation(corners.reshape(4, -1).T)
    left = cells[: len(cells) * 95 // 100]
    while len(np.unique(left)) < len(used):
        left = cells[: len(left) + 1]
    assert len(left) < len(cells)
    for ending in DECKS:
        path = tmp_path / f"short.{ending}"
        write_mesh(path, 1e3 * mesh.p[:, used].T, "tetra", left, {})
        try:
            said = "; ".join(mesh_from(str(path), PLACE).remarks)
        except MeshError as error:
            said = str(error)
        assert "as large as an element" in said and "line" in said, said


@pytest.mark.long
def test_sound_parts_have_no_pits():
    """A keyway, whose corners are pockets, and a hollow shaft, whose bore is hollow everywhere; and
    with an element less at the surface they have.
    """
    from skfem import MeshTet1

    from solidgear.core.meshing.tetrahedra import tetrahedra
    from solidgear.core.models.solid.plan import tetrahedra_plan
    from solidgear.cuts.solid.featured import meshed
    from solidgear.cuts.solid.meshing import submesh
    from solidgear.parts.mesh_file import lost_elements

    keyed, hollow = (sg.load(f"geometry/{n}.toml") for n in ("pinion_keyed", "shaft_hollow"))
    keyed = keyed.with_changes(
        features=tuple(f.with_changes(ends="square") for f in keyed.features)
    )
    plan = tetrahedra_plan(keyed, [], size=None, graded_size=None, refinement=0.4, around=12)
    made = meshed(keyed, plan, 0.4, True)
    plan = tetrahedra_plan(hollow, [], size=None, graded_size=None, refinement=0.4, around=12)
    for mesh in (submesh(made.mesh, ~made.cut), tetrahedra(hollow.outline, **plan).mesh):
        assert lost_elements(mesh).shape[1] == 0
        outside = mesh.f2t[0, mesh.boundary_facets()]
        seen = [
            lost_elements(MeshTet1(mesh.p, np.delete(mesh.t, k, axis=1))).shape[1]
            for k in outside[::40]
        ]
        # not those at convex rims, whose edge goes with them
        assert np.mean(np.array(seen) > 0) > 0.3
