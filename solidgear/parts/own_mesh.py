"""A solid body from a mesh that is given."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from skfem import MeshTet1

from solidgear.core import Body
from solidgear.core.meshing.quality import check_mesh
from solidgear.core.models.solid.block import body_of, free_block, mesh_facts
from solidgear.core.models.solid.lines import with_layers
from solidgear.core.models.solid.mesh import _isoparametric
from solidgear.core.models.solid.seat_faces import Seats

if TYPE_CHECKING:
    from skfem import Mesh

    from solidgear.core.models.solid.block import Facets
    from solidgear.core.scene import Material, Scene
    from solidgear.core.scene.shaft import Station


def solid_body(
    mesh: Mesh,
    shaft: Scene,
    *,
    element: str,
    wanted: Sequence[tuple[Station, str]] | None = None,
    clipped: bool = True,
    facts: Mapping[str, Any] | None = None,
    owner: np.ndarray | None = None,
    materials: Sequence[Material] | None = None,
    patches: Mapping[str, np.ndarray] | None = None,
    layers: int = 0,
    ratio: float = 1.0,
) -> Body:
    """Build the free body of a mesh, with ports on cylinders and cones of the surface, or on patches.

    Parameters
    ----------
    mesh : skfem.Mesh
        Tetrahedra or hexahedra, m, with y the axis; corners of tetrahedra with straight edges may
        have any order.
    shaft : Scene
        Its stations are looked for on the outer surface of its segments.
    element : str
        Of the 3D solid, such as ``tet10`` or ``hex20``.
    wanted : sequence of (Station, str), optional
        Other stations, each with its attachment.
    clipped : bool
        Whether integrals stop at the ends of a seat where faces reach beyond it; else only whole
        faces within the seat count.
    facts : mapping, optional
        Added to ``body.mesh``.
    owner : (ne,) array of int, optional
        Place of each element's material among `materials`; by default each has that of the segment
        in which its middle lies.
    materials : sequence of Material, optional
    patches : mapping of str to array, optional
        Facets of the patches that stations without an axis lie on.
    layers, ratio : int, float
        Ten-node tetrahedra are split in layers of a ratio towards singular lines.

    Returns
    -------
    Body

    Raises
    ------
    SolidgearError
        For a seat without faces or with faces missing, and for inverted elements.

    Examples
    --------
    >>> import solidgear as sg
    >>> from solidgear.core.meshing.tetrahedra import tetrahedra
    >>> rod = sg.Segment.cylinder("rod", length=0.3, diameter=0.06)
    >>> scene = sg.Scene.from_parts([rod])
    >>> body = sg.solid_body(tetrahedra(scene.outline, size=0.03).mesh, scene, element="tet10")
    >>> bool(np.isclose(body.mass_matrix()[0, 0], 7850 * np.pi * 0.03**2 * 0.3, rtol=1e-3))  # kg
    True
    """
    if wanted is None:
        wanted = [(s, s.attachment) for s in shaft.stations]
    if isinstance(mesh, MeshTet1):
        mesh = mesh.oriented()
    quality = check_mesh(mesh)
    if owner is None:
        y = mesh.p[1][mesh.t].mean(axis=0)
        owner = np.searchsorted([s.y1 for s in shaft.segments[:-1]], y)
        materials = None
    solid = _isoparametric(mesh, element, owner)
    seats = Seats(solid, shaft.segments, clipped)

    def facets(station, attachment: str) -> np.ndarray:
        patch = getattr(station, "patch", None)
        return seats(station, attachment) if patch is None else (patches or {})[patch.name]

    facets_of: Facets = facets
    if layers:
        kinds = materials or [segment.material for segment in shaft.segments]
        split = with_layers(solid, quality, facets, wanted, kinds, layers=layers, ratio=ratio)
        solid, quality, facets_of = split.mesh, split.quality, split.facets
    block = free_block(solid, shaft, wanted, facets_of, clipped=clipped, materials=materials)
    all_facts = {
        **mesh_facts(solid, quality),
        # no symmetry promises twins
        "round": False,
        "pair_tolerance": 0.0,
        **(facts or {}),
    }
    return body_of(shaft, wanted, (block,), all_facts, solid)
