"""Volumes of drawn solids are those of their faces, whatever kind of face the file has."""

from math import pi

import pytest

from solidgear.core.meshing.gmsh_session import Session, import_gmsh
from solidgear.parts.step import volumes_of


def drawn(gmsh, splines: bool) -> list[int]:
    """A hollow cylinder and a ball beside it, 16 edges to a turn."""
    occ = gmsh.model.occ
    tube, _ = occ.cut(
        [(3, occ.addCylinder(0, 0, 0, 0, 0.05, 0, 0.03))],
        [(3, occ.addCylinder(0, 0, 0, 0, 0.05, 0, 0.02))],
    )
    solids = [*tube, (3, occ.addSphere(0.1, 0, 0, 0.02))]
    if splines:
        occ.convertToNURBS(solids)
    occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 16)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.02)
    gmsh.model.mesh.generate(2)
    return [tag for _, tag in gmsh.model.getEntities(3)]


@pytest.mark.parametrize("splines", [False, True])
def test_splines_enclose_what_cylinders_do(splines):
    """The kernel's own quadrature is 0.8 % off on splines, and exact on cylinders; triangles of fourth order,
    sixteen to a turn, leave 1e-5 of a tube.
    """
    gmsh = import_gmsh()
    with Session(gmsh):
        volumes = volumes_of(gmsh, drawn(gmsh, splines))
    exact = [pi * (0.03**2 - 0.02**2) * 0.05, 4 / 3 * pi * 0.02**3]
    assert volumes == pytest.approx(exact, rel=2e-5 if splines else 1e-12)
