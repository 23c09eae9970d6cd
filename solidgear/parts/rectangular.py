"""3D solid of a rectangular block, in cells that are boxes."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, prod
from typing import TYPE_CHECKING

import numpy as np
from skfem import Mesh, MeshHex

from solidgear.core import Body, SolidgearError
from solidgear.core.kernel.room import assemblable
from solidgear.core.scene.patches import FACES
from solidgear.parts.own_mesh import solid_body

if TYPE_CHECKING:
    from solidgear.core import Scene

#: cells along the shortest edge at refinement 1; of longer edges they grow with the root of the edge,
#: since waves along an edge are longer than those across: every edge is divided by a multiple of this,
#: and meshes of refinements 1/4, 1/2, 1 and so on are nested
CELLS = 4
#: widths closer than this part of themselves are equal
SAME = 1e-6


def block_body(
    scene: Scene, wanted: Sequence, *, element: str, size: float | None, refinement: float
) -> Body:
    """Build the free body, in one block, of a scene with a ``body`` that is a block; sizes as for
    :func:`solidgear.core.models.solid.body.solid`.
    """
    mesh = block_mesh(scene, wanted, element, size, refinement)
    facts = {"refinement": refinement, "axis": False}
    middle = mesh.p[:, mesh.facets].mean(axis=1)
    low, high = mesh.p.min(axis=1), mesh.p.max(axis=1)
    near = 1e-9 * (high - low).max()
    patches = {
        name: np.flatnonzero(np.abs(middle[k // 2] - (low, high)[k % 2][k // 2]) < near)
        for k, name in enumerate(FACES)
    }
    return solid_body(
        mesh, scene, element=element, wanted=wanted, clipped=False, facts=facts, patches=patches
    )


def block_mesh(
    scene: Scene, wanted: Sequence, element: str, size: float | None, refinement: float
) -> Mesh:
    """Return boxes with a line at every section, their number along an edge by its length beside the
    shortest, or of one size; tetrahedra are refused. Between two rigid faces they are no wider at the
    free rim than they are thick: a layer gives way there.

    Meshes whose refinements are one twice the other are nested, so that frequencies fall from one
    to the next.
    """
    if not element.startswith("hex"):
        raise SolidgearError(
            f"solid: element = {element} is not for a block; use hex8, hex20 or hex27"
        )
    assert scene.body is not None
    x, y, z = scene.body.edges
    least = min(x, y, z)
    sizes = [size or edge / CELLS / max(1, round((edge / least) ** 0.5)) for edge in (x, y, z)]
    along = sorted({0.0, y, *(s.y for s, _ in wanted if s.patch is None)})
    places = (-x / 2, x / 2), along, (-z / 2, z / 2)
    lines = [_divided(marks, cell, refinement) for marks, cell in zip(places, sizes)]
    rigid = {FACES.index(s.patch.name) for s, tie in wanted if s.patch and tie == "rigid"}
    for axis in range(3):
        if {2 * axis, 2 * axis + 1} <= rigid:
            across = np.diff(lines[axis]).max()
            lines = [line if k == axis else _to_rims(line, across) for k, line in enumerate(lines)]
    assemblable(prod(len(line) - 1 for line in lines), 27)
    boxes = MeshHex.init_tensor(*lines)
    # scikit-fem's are left-handed, and x mirrors
    return MeshHex(boxes.p * [[-1.0], [1.0], [1.0]], boxes.t)


def _divided(places: Sequence[float], size: float, refinement: float) -> np.ndarray:
    """Return lines at some places and evenly between."""
    out = [np.array([places[0]])]
    for a, b in zip(places, places[1:]):
        cells = max(1, round(refinement * ceil((b - a) / size - 1e-9)))
        out.append(np.linspace(a, b, cells + 1)[1:])
    return np.concatenate(out)


def _to_rims(line: np.ndarray, width: float) -> np.ndarray:
    """Return a line with its first and last cell halved until they are no wider than some width."""
    while line[1] - line[0] > (1 + SAME) * width:
        line = np.insert(line, [1, -1], [(line[0] + line[1]) / 2, (line[-2] + line[-1]) / 2])
    return line
