"""Options of cards that turn, scale or move numbers in matrices of other programs: read as they mean,
or refused in a sentence, and never passed over.
"""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg

FOUND = Path(__file__).parent / "found" / "exchange"
DECK = (FOUND / "transformed_nodes.inp").read_text()
PLAIN = DECK.replace("*TRANSFORM, NSET=P, TYPE=R\n0., 1., 0., 0., 0., 1.\n", "")


def along_axes(path):
    """Stiffness along x, y, z of the first point, 1e8 N/m, and its mass, kg."""
    matrices = sg.read_matrices(path)
    return (np.diag(matrices.stiffness)[:3] / 1e8).tolist(), float(matrices.mass[0, 0])


@pytest.mark.parametrize(
    "file, due",
    [
        # directions 1, 2, 3 of both nodes are y, z, x
        ("transformed_nodes.inp", [3, 1, 2]),
        ("scale_factor.inp", [2, 4, 6]),
        ("matrix_in_other_file.inp", [1, 2, 3]),
    ],
)
def test_options_of_abaqus_have_their_meaning(file, due):
    """Two points on springs of 1, 2 and 3e8 N/m along the directions of the file, and 10 kg in them."""
    stiffness, mass = along_axes(FOUND / file)
    assert stiffness == pytest.approx(due, rel=1e-12) and mass == pytest.approx(10.0)


TURNED = {
    # about z the node at y has its radius along y and its tangent against x
    "cylindrical": ("*TRANSFORM, NSET=P, TYPE=C\n-1., 0.05, 0., -1., 0.05, 1.", None),
    "set by numbers": ("*NSET, NSET=Q, GENERATE\n1, 2, 1\n*TRANSFORM, NSET=Q\n0., 1., 0., 0., 0., 1.", [3, 1, 2]),
    "set of sets": ("*NSET, NSET=Q\nP\n*TRANSFORM, TYPE=R,\n NSET=Q\n0., 1., 0., 0., 0., 1.", [3, 1, 2]),
    "back again": ("*TRANSFORM, NSET=P\n1., 0., 0., 0., 1., 0.", [1, 2, 3]),
}  # fmt: skip


@pytest.mark.parametrize("case", TURNED)
def test_directions_of_nodes(case, tmp_path):
    card, due = TURNED[case]
    path = tmp_path / "box.inp"
    path.write_text(PLAIN.replace("*MATRIX INPUT", f"{card}\n*MATRIX INPUT", 1))
    stiffness, _ = along_axes(path)
    if due is None:
        # radius of node 1 along (1, -0.05), in the plane of springs of 1 and 2e8 N/m
        radius = np.array([1, -0.05]) / np.hypot(1, 0.05)
        across = np.array([-radius[1], radius[0]])
        due = [*np.diag(np.outer(radius, radius) + 2 * np.outer(across, across)), 3]
    assert stiffness == pytest.approx(due, rel=1e-12)


def test_matrices_are_what_they_are_assembled_as(tmp_path):
    """Names say nothing where *MATRIX ASSEMBLE does."""
    path = tmp_path / "box.inp"
    path.write_text(
        PLAIN.replace("=STIFFNESS", "=MASS1").replace("=MASS\n", "=K1\n").replace("=MASS,", "=K1,")
    )
    assert along_axes(path) == ([1, 2, 3], 10.0)
    path.write_text(
        path.read_text().partition("*MATRIX ASSEMBLE")[0].replace("MASS1", "A").replace("K1", "B")
    )
    with pytest.raises(sg.SceneError, match="nothing says what the matrix A is"):
        sg.read_matrices(path)


def test_what_a_deck_has_beside_matrices_is_said(tmp_path):
    path = tmp_path / "box.inp"
    path.write_text(PLAIN + "*BOUNDARY\n1, 1, 6\n")
    assert sg.read_matrices(path).notes == ("left out: *BOUNDARY",)


ABAQUS = {
    "spherical": ("*TRANSFORM, NSET=P, TYPE=S\n0., 0., 0., 0., 0., 1.", "TYPE=R or C is read, not S"),
    "no directions": ("*TRANSFORM, NSET=P\n0., 1., 0., 0., 2., 0.", "gives node 1 no directions"),
    "no set": ("*TRANSFORM, NSET=Q\n0., 1., 0., 0., 0., 1.", "there is no set of nodes 'Q'"),
    "a system of nodes": ("*SYSTEM\n1., 0., 0.", "SYSTEM moves or turns nodes"),
    "nodes on circles": ("*NODE, SYSTEM=C\n1, 1., 0., 0.", "another system than x, y, z"),
    "a mapping": ("*NMAP, NSET=P, TYPE=RECTANGULAR\n0., 0., 0.", "NMAP moves or turns nodes"),
    "an instance that is moved": ("*INSTANCE, NAME=a, PART=b\n1., 0., 0.", "INSTANCE moves or turns"),
    "a diagonal": ("*MATRIX INPUT, NAME=K, TYPE=DIAGONAL", "type DIAGONAL is not read"),
    "an unknown option": ("*MATRIX INPUT, NAME=K, COMPLEX=YES", "MATRIX INPUT with COMPLEX"),
    "other numbers of nodes": ("*MATRIX ASSEMBLE, STIFFNESS=STIFFNESS, NSET=P", "MATRIX ASSEMBLE with NSET"),
    "damping of another kind": ("*MATRIX ASSEMBLE, VISCOUS DAMPING=C", "MATRIX ASSEMBLE with VISCOUS DAMPING"),
    "a scale of letters": ("*MATRIX INPUT, NAME=K, SCALE FACTOR=two", "'two' is no number"),
    "a file that is not there": ("*MATRIX INPUT, NAME=K, INPUT=gone.mtx", "the file gone.mtx is missing"),
    "an element in another file": ("*USER ELEMENT, FILE=part.sim", "USER ELEMENT with FILE"),
    "a file in itself": ("*INCLUDE, INPUT=box.inp", "box.inp names itself"),
}  # fmt: skip


@pytest.mark.parametrize("case", ABAQUS)
def test_what_is_not_read_of_abaqus_is_refused(case, tmp_path):
    card, words = ABAQUS[case]
    path = tmp_path / "box.inp"
    path.write_text(PLAIN.replace("*MATRIX INPUT", f"{card}\n*MATRIX INPUT", 1))
    with pytest.raises(sg.SceneError, match=words):
        sg.read_matrices(path)


def nastran(*cards, grid="GRID,{0},,0.,{1},0.,{2}", system="", form="6"):
    """A deck of two points on the same springs, in directions of a system."""
    lines = [*cards, grid.format(1, 0.0, system), grid.format(2, 0.1, system)]
    for name, rows in (("K", (1e8, 2e8, 3e8, 1e6, 2e6, 3e6)), ("M", (10, 10, 10, 1, 1, 1))):
        lines.append(f"DMIG,{name},0,{form},2,0")
        lines += [
            f"DMIG,{name},{node},{k},,{node},{k},{value}"
            for node in (1, 2)
            for k, value in enumerate(map(float, rows), 1)
        ]
    return "\n".join(lines)


#: y, z, x are directions 1, 2, 3: z of the system is x, and y lies in its plane of x and z
SYSTEM = "CORD2R,5,,0.,0.,0.,1.,0.,0.\n,0.,1.,0."


@pytest.mark.parametrize(
    "text, due",
    [
        (nastran(), [1, 2, 3]),
        (nastran(SYSTEM, system="5"), [3, 1, 2]),
        (nastran(SYSTEM, "GRDSET,,,,,,5"), [3, 1, 2]),
        (nastran(SYSTEM, "GRDSET,,,,,,5", system="0"), [1, 2, 3]),
        (nastran("PARAM,CK2,1.0"), [1, 2, 3]),
    ],
)
def test_directions_of_grids(text, due, tmp_path):
    path = tmp_path / "box.bdf"
    path.write_text(text)
    stiffness, mass = along_axes(path)
    assert stiffness == pytest.approx(due, rel=1e-12) and mass == pytest.approx(10.0)


NASTRAN = {
    "a cylinder": (nastran("CORD2C,5,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.", system="5"), "node 1 moves in coordinate system 5"),
    "a system in a system": (nastran("CORD2R,5,7,0.,0.,0.,1.,0.,0.\n,0.,1.,0.", system="5"), "moves in coordinate system 5"),
    "places by GRDSET": (nastran("GRDSET,,7"), "lies in coordinate system 7"),
    "a parameter": (nastran("PARAM,CK2,2.0"), "PARAM CK2 multiplies its matrices by 2.0"),
    "case control": ("K2GG = 2.0*K\nBEGIN BULK\n" + nastran(), "K2GG takes a matrix times a factor"),
    "a rectangle": (nastran(form="9"), "the form 9"),
}  # fmt: skip


@pytest.mark.parametrize("case", NASTRAN)
def test_what_is_not_read_of_nastran_is_refused(case, tmp_path):
    text, words = NASTRAN[case]
    (tmp_path / "box.bdf").write_text(text)
    with pytest.raises(sg.SceneError, match=words):
        sg.read_matrices(tmp_path / "box.bdf")
