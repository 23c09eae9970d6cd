"""Tetrahedra in a shaft with features, each feature a volume of its own in the mesh.

The shaft, of revolution or with straight teeth and bolt circles, is cut into pieces by the volumes
that features remove (OCC's general fuse), and all pieces are meshed together. Leaving out the
elements of the features gives the part, keeping them the plain shaft: two bodies on one mesh, whose
difference is free of the errors that they have in common. Where all features share a mirror plane,
only one half is drawn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import Any

import numpy as np
from skfem import MeshTet2

from solidgear.core import Outline
from solidgear.core.meshing.curving import Filling, ten_nodes
from solidgear.core.meshing.element_size import set_size, size_formulas
from solidgear.core.meshing.geometry import (
    geometry_error,
    misshapen,
    moments_of,
    most_misshapen,
    whole_moments,
)
from solidgear.core.meshing.gmsh_session import Session, import_gmsh
from solidgear.core.meshing.quality import MeshError, MeshQuality, check_mesh
from solidgear.core.meshing.revolved import draw_revolved, graded_corners
from solidgear.core.meshing.tetrahedra import (
    check_filling,
    filled,
    lost_by_arcs,
    segment_of_elements,
)
from solidgear.core.scene.closed_form import moments_of_parts, parts_of, volume_of
from solidgear.core.scene.parts import Segment
from solidgear.cuts.features.cut import Cut
from solidgear.cuts.solid.cuts import edge_size, feature_size, mirror_plane, tool

#: angle about y at which half a shaft begins, so that the other end of the half turn lies in the
#: same plane
_START = {0: -pi / 2, 2: 0.0}
#: share of its volume that the cut may be off by in the mesh: three times the loss of a circle of eight
#: curved edges, 4 / 30 (pi / 8)^4; one of six would lose as much
OF_CUT = 1e-2
#: volume at the rim of a section counts so many times in its second moment about a diameter
OF_RIM = 4.0
#: how many times finer features are meshed where elements beside them fold, and their edges have to be
#: straightened: a hole of 20 mm in a shaft of 60 lost 1.2 to 2 % so, and 0.1 to 0.2 % at 1.2
FINER = (1.0, 1.2, 1.5)
#: how many times smaller elements are at shoulders where the whole lacks more than arcs explain: edges
#: between the two circles of a small step fold as well
AT_STEPS = (1.0, 1.5, 2.0)


@dataclass(frozen=True)
class FeaturedMesh:
    """A meshed shaft with the volumes of features."""

    mesh: MeshTet2  #: of the plain shaft, or of half of it
    segment: np.ndarray  #: (ne,) segment each element lies in
    cut: np.ndarray  #: (ne,) elements that features remove
    #: axis at right angles to the mirror plane: 0 for x = 0, 2 for z = 0; None for a whole shaft
    plane: int | None
    quality: MeshQuality
    removed: float  #: volume that OCC says the features remove from the whole shaft, m^3


def featured_mesh(
    outline: Outline[Segment],
    features: tuple[Any, ...],
    planes: list[float],
    circles: list[float],
    *,
    size: float,
    graded_size: float | None,
    around: int,
    refinement: float,
    half: bool = True,
    edges: bool = False,
    reach: float | None = None,
    convex: bool = True,
) -> FeaturedMesh:
    """Mesh a shaft with keyways, flats and cross holes, and beside them teeth, splines and bolt
    circles, with which there are no halves; half of it where features have a mirror plane, if
    wanted.

    Sizes are those of :func:`solidgear.core.meshing.tetrahedra.tetrahedra`, given refined; `refinement`
    divides the sizes at features, and with ``edges`` elements are smaller at the re-entrant edges
    of features and at holes. MeshError for geometry that cannot be cut or meshed, inverted
    elements, or a wrong volume.
    """
    gmsh = import_gmsh()
    around_axis = tuple(f for f in features if not isinstance(f, Cut))
    features = tuple(f for f in features if isinstance(f, Cut))
    plane = mirror_plane(features) if half and not around_axis else None
    start, turn = (0.0, 2 * pi) if plane is None else (_START[plane], pi)
    radii = {s.name: float(s.outer0) for s in outline.segments}
    share = turn / (2 * pi)
    volume, sizes_around = share * volume_of(outline), []
    if around_axis:
        # slow to import, and seldom needed
        from solidgear.cuts.sector import drawing as sector_drawing
        from solidgear.cuts.sector import meshing as sector

        volume = sector.volume_of_sector(outline, around_axis, 1)
        sizes_around = sector.sizes_around(outline.segments, around_axis, refinement)
    arcs = lost_by_arcs(around)

    def fill(finer: float, at_steps: float) -> tuple[Filling, np.ndarray, float]:
        """Return the mesh, the elements in features, and their volume as OCC says."""
        graded = graded_size and graded_size / at_steps
        with Session(gmsh):
            if around_axis:
                sector_drawing.draw_toothed(gmsh, outline, around_axis, planes, circles)
            else:
                draw_revolved(gmsh, outline, planes, circles, start, turn)
            corners = graded_corners(outline, planes, circles, convex)
            pieces = _cut(gmsh, features, radii)
            formulas = size_formulas(outline, corners, size, graded, reach, around)
            formulas += sizes_around
            formulas += [feature_size(f, radii[f.segment], refinement, finer)[0] for f in features]
            if edges:
                formulas += [edge_size(f, radii[f.segment], refinement)[0] for f in features]
            set_size(gmsh, formulas, size)
            removed = sum(gmsh.model.occ.getMass(3, piece) for piece in pieces)
            filling = filled(
                gmsh,
                "gmsh could not mesh the shaft with its features ({}): change refinement a "
                "little, or look for features that almost touch",
            )
        of_part = {tag: share for tag, share in filling.straightened.items() if tag not in pieces}
        return replace(filling, straightened=of_part), np.isin(filling.volume, pieces), removed

    maps = [np.eye(3)]
    if plane is not None:
        maps.append(np.diag(np.where(np.arange(3) == plane, -1.0, 1.0)))
    exact = moments_of_parts(outline)
    if around_axis:
        exact = sector.moments_of_sectors(outline, around_axis)
    # two holes are not alike about the axis
    has_closed_form = all(f.count > 2 for f in around_axis)

    finer = at_steps = 0
    while True:
        filling, cut, removed = fill(FINER[finer], AT_STEPS[at_steps])
        mesh = filling.mesh
        segment = segment_of_elements(mesh, outline.segments)
        moments = whole_moments(moments_of(mesh, segment, outline), maps)
        shapes = misshapen(moments, exact) if has_closed_form else []
        worst = max((shape.error for shape in shapes), default=0.0)
        lacking = _volume_error(submesh(mesh, cut), removed)
        if lacking > arcs and FINER[finer] < FINER[-1]:
            finer += 1
        elif _volume_error(mesh, volume) <= arcs and worst <= most_misshapen(around):
            break
        elif graded_size and AT_STEPS[at_steps] < AT_STEPS[-1]:
            at_steps += 1
        else:
            break
    if lacking > OF_CUT:
        names = ", ".join(f'"{f.name}"' for f in features)
        raise MeshError(
            f"the elements of {names} miss {100 * lacking:.2g} % of the {1e9 * removed:.6g} mm^3 "
            f"to be cut out, more than {OF_CUT:.0%}: raise refinement"
        )
    quality = check_filling(filling, volume=volume, rtol=arcs)
    if shapes:
        of_cuts = OF_RIM * lacking * removed / share / _least_volume(outline, features)
        quality = replace(quality, geometry=geometry_error(shapes) + of_cuts)
    return FeaturedMesh(mesh, segment, cut, plane, quality, removed / share)


def _least_volume(outline: Outline[Segment], features: Sequence[Cut]) -> float:
    """Return the volume of the smallest part of a shaft that a feature is cut into, m^3."""
    with_cut = {f.segment for f in features}
    numbers = parts_of(outline).of_segments
    cut = {int(k) for k, segment in zip(numbers, outline.segments) if segment.name in with_cut}
    return min(
        float(moments[0, 0]) for k, moments in enumerate(moments_of_parts(outline)) if k in cut
    )


def _volume_error(mesh: MeshTet2, volume: float) -> float:
    """Return the share that the volume of a mesh is off by."""
    return abs(check_mesh(mesh).volume / volume - 1)


def _cut(gmsh, features, radii) -> list[int]:
    """Cut the shaft by the tools of features; return the volumes that are inside both."""
    occ = gmsh.model.occ
    shaft = occ.getEntities(3)
    tools = [(3, tool(occ, feature, radii[feature.segment])) for feature in features]
    try:
        _, pieces_of = occ.fragment(shaft, tools)
    except Exception as error:
        raise MeshError(f"the features cannot be cut into the shaft ({error})") from error
    in_shaft = {piece for pieces in pieces_of[: len(shaft)] for piece in pieces}
    in_tools = {piece for pieces in pieces_of[len(shaft) :] for piece in pieces}
    occ.remove(sorted(in_tools - in_shaft), recursive=True)
    occ.synchronize()
    for feature, pieces in zip(features, pieces_of[len(shaft) :]):
        if not in_shaft & set(pieces):
            raise MeshError(f'feature "{feature.name}" cuts nothing out of the shaft')
    return [tag for _, tag in sorted(in_shaft & in_tools)]


def submesh(mesh: MeshTet2, keep: np.ndarray) -> MeshTet2:
    """Return the elements of a curved mesh under a mask, with the nodes in the middle of their
    edges.
    """
    middles = mesh.doflocs[:, mesh.dofs.edge_dofs[0]]
    return ten_nodes(mesh.p, mesh.t[:, keep], mesh.edges, middles)
