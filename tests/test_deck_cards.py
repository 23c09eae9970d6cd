"""Cards of mesh decks that hold, move or make what a mesh is: sets of nodes as patches, placed parts,
units of mass; others that would change it are refused.
"""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.meshing.quality import MeshError
from solidgear.parts.decks.deck import read

FOUND = Path(__file__).parent / "found" / "parts"
#: a brick of 1 by 2 by 3 with its nodes as Abaqus counts them
NODES = [(x, y, z) for z in (0, 3) for x, y in ((0, 0), (1, 0), (1, 2), (0, 2))]
BRICK = (
    "*NODE\n"
    + "".join(f"{k}, {x}., {y}., {z}.\n" for k, (x, y, z) in enumerate(NODES, 1))
    + "*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
)


def deck(folder, text, ending="inp"):
    path = folder / f"part.{ending}"
    path.write_text(text)
    return read(str(path))


def test_a_set_of_nodes_is_a_foot():
    """A rod whose foot is an *NSET, held rigidly: 464.67 Hz by CalculiX with twenty-node bricks of the
    same edges; both meshes are within 0.2 % of the limit.
    """
    tables = sg.load(FOUND / "node_set.toml").to_dict()
    tables["bearing"][0]["attachment"] = "rigid"
    tables["body"]["mesh"] = str(FOUND / "node_set.inp")
    tables["port"] = {"name": "foot", "patch": "ROOT"}
    scene = sg.load(tables)
    modes = sg.modes(sg.build(scene, "solid"), scene, n=2)
    assert modes.frequency_hz[0] == pytest.approx(464.67, rel=2e-3)


def test_an_unknown_patch_is_the_one_problem(tmp_path):
    path = tmp_path / "rod.toml"
    text = (FOUND / "node_set.toml").read_text().replace('"ROOT"', '"TOE"')
    path.write_text(text.replace("node_set.inp", str(FOUND / "node_set.inp")))
    with pytest.raises(sg.SceneError, match="unknown patch; there are 'ROOT'") as refusal:
        sg.load(path)
    assert not any("seat_width" in problem.sentence for problem in refusal.value.problems)


SETS = {
    "numbers": "*NSET, NSET=A\n1, 2, 3, 4\n",
    "a count": "*NSET, NSET=A, GENERATE\n1, 4, 1\n",
    "other sets": "*NSET, NSET=B\n1, 2\n*NSET, NSET=C\n3, 4\n*NSET, NSET=A\nB, C\n",
    "with its nodes": "*NODE, NSET=A\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 2., 0.\n4, 0., 2., 0.\n",
}


@pytest.mark.parametrize("case", SETS)
def test_faces_of_which_all_corners_are_in_a_set_are_its_patch(case, tmp_path):
    patches = deck(tmp_path, BRICK + SETS[case]).patches
    assert sorted(patches["A"].T.tolist()) == [[0, 1, 2, 3]]
    assert "B" not in patches  # an edge is none


def test_a_set_of_all_nodes_is_no_place(tmp_path):
    assert deck(tmp_path, BRICK + "*NSET, NSET=ALL, GENERATE\n1, 8\n").patches == {}
    assert deck(tmp_path, BRICK + "*NSET, NSET=ALL, ELSET=E\n").patches == {}


def test_a_group_of_nodes_in_a_universal_file_is_a_patch(tmp_path):
    nodes = "".join(
        f"{k:10d}{1:10d}{1:10d}{11:10d}\n{x:25.16e}{y:25.16e}{z:25.16e}\n"
        for k, (x, y, z) in enumerate(NODES, 1)
    )
    row = "".join(f"{k:10d}" for k in range(1, 9))
    members = "".join(f"{7:10d}{k:10d}{0:10d}{0:10d}" for k in (1, 2, 3, 4))
    text = (
        f"    -1\n  2411\n{nodes}    -1\n"
        f"    -1\n  2412\n{1:10d}{115:10d}{1:10d}{1:10d}{7:10d}{8:10d}\n{row}\n    -1\n"
        f"    -1\n  2467\n{1:10d}" + 6 * f"{0:10d}" + f"{4:10d}\nfoot\n{members}\n    -1\n"
    )
    assert sorted(deck(tmp_path, text, "unv").patches["foot"].T.tolist()) == [[0, 1, 2, 3]]


def test_a_surface_without_faces_is_all_that_lies_outside(tmp_path):
    patch = deck(tmp_path, BRICK + "*SURFACE, NAME=S\nE,\n").patches["S"]
    assert patch.shape == (4, 6)


def test_an_instance_places_its_part(tmp_path):
    """A shift by (10, 0, 0), then a quarter of a turn about the line through (10, 0, 0) along z."""
    part = f"*PART, NAME=p\n{BRICK}*END PART\n*ASSEMBLY\n*INSTANCE, NAME=i, PART=p\n"
    end = "*END INSTANCE\n*END ASSEMBLY\n"
    assert deck(tmp_path, part + end).points.T[2].tolist() == [1, 2, 0]
    moved = deck(tmp_path, part + "10., 0., 0.\n10., 0., 0., 10., 0., 1., 90.\n" + end).points.T
    assert moved[[0, 1, 2]] == pytest.approx(np.array([(10, 0, 0), (10, 1, 0), (8, 1, 0)]))


ABAQUS = {
    "*SYSTEM\n1., 0., 0.\n": "line 12: .SYSTEM moves or turns nodes",
    "*NMAP, NSET=A\n1., 0., 0.\n": "NMAP moves or turns nodes",
    "*NGEN\n1, 2, 1\n": "NGEN makes nodes or elements that the file does not list",
    "*ELGEN\n1, 2, 1\n": "ELGEN makes nodes or elements",
    "*ELCOPY, ELEMENT SHIFT=10, OLD SET=E, SHIFT NODES=10\n1\n": "ELCOPY makes nodes",
    "*ELEMENT, TYPE=C3D8, OFFSET=5\n2, 1, 2, 3, 4, 5, 6, 7, 8\n": "ELEMENT with OFFSET is not read",
}


@pytest.mark.parametrize("card", ABAQUS)
def test_what_changes_a_mesh_of_abaqus_is_refused(card, tmp_path):
    with pytest.raises(MeshError, match=ABAQUS[card]):
        deck(tmp_path, BRICK + card)


BULK = (
    "BEGIN BULK\n{}"
    + "".join(f"GRID,{k},,{x}.,{y}.,{z}.\n" for k, (x, y, z) in enumerate(NODES, 1))
    + "CHEXA,1,7,1,2,3,4,5,6,+\n+,7,8\nPSOLID,7,9\nMAT1,9,2.9+7,,.3,.283\nENDDATA\n"
)


def test_a_parameter_of_nastran_multiplies_densities(tmp_path):
    """0.283 lbf/in^3 is 7.33e-4 lbf s^2/in^4, by 1/386.09 s^2/in."""
    wtmass = deck(tmp_path, BULK.format("PARAM,WTMASS,.00259\n"), "bdf").materials[0]
    assert wtmass.density == pytest.approx(7.33e-4, rel=1e-3)
    assert deck(tmp_path, BULK.format(""), "bdf").materials[0].density == 0.283


def test_a_usual_system_of_nastran_is_that_of_its_grids(tmp_path):
    with pytest.raises(MeshError, match="GRID 1 is given in system 4"):
        deck(tmp_path, BULK.format("GRDSET,,4\n"), "bdf")
    # motions in a system of their own leave the mesh as it is
    assert deck(tmp_path, BULK.format("GRDSET,,,,,,4\n"), "bdf").points.shape == (3, 8)
