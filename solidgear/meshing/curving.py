"""Middle nodes of curved tetrahedra: drawn in where elements fold, and moved out so that sides enclose
the volume of what they stand for.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from skfem import MeshTet2

from solidgear.meshing.quality import element_ratios

#: below this min/max det J the edges of an element are straightened
FOLD = 0.05
#: growth of a sagitta s over a chord of half length c, times (s / c)^2. A parabola through three points
#: of an arc cuts off a share a^4 / 30 of its circle, where the arc spans 2a; one whose sagitta is
#: larger by (s / c)^2 / 5 encloses the same area. Of regular triangles on a cylinder the same holds at
#: 0.22 to 0.27, as they lie on it
OUT = 0.25


def relaxed(mesh: MeshTet2) -> MeshTet2:
    """The mesh with the mid nodes of folded elements drawn towards the middle of their edges, as
    far as needed.

    Only the tip of a cone and wedges of few degrees fold elements of a sensible size; what is lost
    there is below the volume gate.

    Parameters
    ----------
    mesh : skfem.MeshTet2

    Returns
    -------
    skfem.MeshTet2
    """
    straight = mesh.p[:, mesh.edges].mean(axis=1)
    middles = mesh.dofs.edge_dofs[0]
    keep = np.ones(mesh.edges.shape[1])
    curve = mesh.doflocs[:, middles] - straight
    # a straight edge may fold the element beside it, which then is straightened in its turn
    for part in (0.5, 0.25, *[0.0] * 10):
        folded = np.flatnonzero(element_ratios(mesh) < FOLD)
        if not len(folded):
            break
        edges = np.unique(mesh.t2e[:, folded])
        keep[edges] = np.minimum(keep[edges], part)
        doflocs = mesh.doflocs.copy()
        doflocs[:, middles] = straight + keep * curve
        mesh = replace(mesh, doflocs=doflocs)
    return mesh


def volume_kept(mesh: MeshTet2) -> MeshTet2:
    """The mesh with middle nodes moved a little beyond the true surface, so that curved sides enclose
    as much as it does.

    On a circle of sixteen edges they move by 1e-5 of its radius, and what is lost falls from 5e-5 to
    some 2e-6 of the volume.

    Parameters
    ----------
    mesh : skfem.MeshTet2
        Middle nodes on the surface.

    Returns
    -------
    skfem.MeshTet2
    """
    a, b = mesh.p[:, mesh.edges[0]], mesh.p[:, mesh.edges[1]]
    middles = mesh.dofs.edge_dofs[0]
    straight = (a + b) / 2
    curve = mesh.doflocs[:, middles] - straight
    steep = 4 * (curve**2).sum(axis=0) / ((b - a) ** 2).sum(axis=0)
    doflocs = mesh.doflocs.copy()
    doflocs[:, middles] = straight + (1 + OUT * steep) * curve
    return replace(mesh, doflocs=doflocs)
