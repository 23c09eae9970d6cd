"""Elements of volumes by name: their order, and how libraries and files call them.

A name begins with the shape: ``tet`` or ``hex``. Measured properties stand where they are used: the
meshes of charts in :mod:`solidgear.core.ladder.solid`, locking and the price of first order in
:mod:`solidgear.guards.elements`.

An element on the tetrahedra or hexahedra there are is an entry here.  Another shape of cell needs its
mesh (:mod:`solidgear.core.meshing`) and its surface (:mod:`solidgear.core.models.solid.drawing`) as
well.
"""

from __future__ import annotations

from typing import NamedTuple


class Element(NamedTuple):
    """An element of the 3D solid."""

    order: int  #: of what lies along an edge
    #: of polynomials that its quadrature integrates (of hexahedra, in every direction): stiffness
    #: and mass of affine elements, and one order in reserve for curved ones
    degree: int
    basis: str  #: its class in ``skfem.element``
    cell: str  #: its kind of cell in meshio
    vtk: str  #: its class of cell in VTK, which knows the order of nodes


ELEMENTS = {
    "hex20": Element(2, 7, "ElementHexS2", "hexahedron20", "vtkQuadraticHexahedron"),
    "hex27": Element(2, 7, "ElementHex2", "hexahedron27", "vtkTriQuadraticHexahedron"),
    "hex8": Element(1, 5, "ElementHex1", "hexahedron", "vtkHexahedron"),
    "tet10": Element(2, 7, "ElementTetP2", "tetra10", "vtkQuadraticTetra"),
    "tet4": Element(1, 2, "ElementTetP1", "tetra", "vtkTetra"),
}
#: elements of first order that a mesh file may have, by those that they are solved with
SOLVED_AS = {"tet4": "tet10", "hex8": "hex20"}
