"""A shaft with teeth, splines or bolt circles in 3D: from one sector of it, or whole from copies of
the same mesh.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from skfem import MeshTet2

from solidgear.core import Block, Body, Outline, SolidgearError
from solidgear.core.kernel.room import assemblable
from solidgear.core.meshing.element_size import rough_cells
from solidgear.core.models.kinds import CYCLIC
from solidgear.core.models.size import Size, size_of_mesh
from solidgear.core.models.solid.block import body_of, free_block, mesh_facts
from solidgear.core.models.solid.enriched import Seat
from solidgear.core.models.solid.mesh import SolidMesh, _isoparametric, basis_of
from solidgear.core.models.solid.plan import tetrahedra_plan
from solidgear.core.scene.feature import SMALLEST
from solidgear.core.scene.parts import Segment
from solidgear.core.scene.shaft import attached_stations, resolved
from solidgear.cuts.features.around import SAME_ANGLE, middle, mirror_angle, no_common_sector
from solidgear.cuts.sector.cyclic import cyclic_blocks
from solidgear.cuts.sector.half import half_sector_blocks, half_sector_solid
from solidgear.cuts.sector.mesh import seats, sector_solid
from solidgear.cuts.sector.meshing import (
    SectorMesh,
    hole_sizes,
    mirrored,
    replicated,
    sector_mesh,
    sectors_of,
)
from solidgear.cuts.solid.holes import fine_lines

if TYPE_CHECKING:
    from solidgear.core import Scene
    from solidgear.core.scene.shaft import Shaft

#: eigenvalues of pairs in a real matrix made of a complex one differ by rounding
PAIRS = 1e-9


def sector(
    scene: Scene,
    *,
    size: float | None = None,
    graded_size: float | None = None,
    refinement: float = 1.0,
    material_port: bool = False,
    ovalising: tuple[int, ...] = (),
    attachments: tuple[str, ...] | None = None,
    count: int | None = None,
    half: bool = True,
) -> Body:
    """Build the free body of a shaft that repeats itself around the axis, from one sector of it; options
    as in :data:`~solidgear.core.models.options.SECTOR_OPTIONS`, and `count` sectors around, by default the
    number that features have in common.

    Teeth are resolved, also those that the scene smears for other models, unless the scene resolves
    other features: then the segment of revolution stands for smeared ones here too. The mean motion
    of the material between the ends of its span converges more quickly, of teeth, than that of the
    surface of the lumped point. Ovalising harmonics are below half the sectors. Half a sector is
    solved where features are even about a plane, as straight teeth are, and holes that lie evenly
    with them: the whole sector then has the same elements and their images.

    Half a sector gives blocks ``axial``, ``torsion``, ``bending_z`` and its twin; a whole one
    ``cyclic_0`` of axial motion and torsion, and ``cyclic_1`` of bending in both planes. Features
    without a common sector, a harmonic index that is too high and a seat without faces are refused.
    """
    sizes = {"size": size, "graded_size": graded_size, "refinement": refinement}
    ties = [*attached_stations(scene.stations, attachments)]
    features = cyclic_features(scene)
    ends = (scene.port.lo, scene.port.hi) if material_port else ()
    meshed = meshed_sector(scene, ties, features, ends, count=count, **sizes)
    high = [h for h in ovalising if 2 * h >= meshed.count]
    if high:
        raise SolidgearError(
            f"sector: ovalising {high[0]} is not below half of the {meshed.count} sectors"
        )
    if not half:
        meshed = mirrored(meshed)
    mesh, blocks_of = _solved_part(meshed)
    facets = seats(mesh, meshed.straight, scene, features)

    def seat_of(station, attachment):
        if material_port and attachment == "average" and station is scene.port:
            y = meshed.straight[1][meshed.mesh.t]
            inside = (y > station.lo - 1e-9) & (y < station.hi + 1e-9)
            return Seat(station.y, np.zeros(0, int), cells=np.flatnonzero(inside.all(axis=0)))
        seat = facets(station, attachment)
        if not len(seat):
            raise SolidgearError(f"port {station.name!r}: no element faces lie on its seat")
        return Seat(station.y, seat, attachment == "rigid")

    blocks = blocks_of(scene, ties, seat_of, ovalising)
    facts = _facts(meshed, mesh, features, refinement) | {
        "sectors": meshed.count,
        "solved_part": "half a sector" if meshed.half else "a whole sector",
        "pair_tolerance": PAIRS,
    }
    return body_of(scene, ties, blocks, facts, mesh, "sector")


def _solved_part(meshed: SectorMesh) -> tuple[SolidMesh, Callable[..., tuple[Block, ...]]]:
    """Return the mesh of a sector, or of its half, and the function that makes blocks of it."""
    if meshed.half:
        half = half_sector_solid(meshed)
        return half, partial(half_sector_blocks, half)
    mesh = sector_solid(meshed)
    return mesh, partial(cyclic_blocks, mesh, mesh.sector)


def whole(scene: Scene, wanted: Sequence, *, refinement: float, **sizes: Any) -> Body:
    """Build the free body, in one block, of the same shaft in full: all sectors, copies of one mesh
    with the ``size`` and ``graded_size`` of :func:`sector`.
    """
    features = cyclic_features(scene)
    mesh, segment, meshed = whole_mesh(scene, wanted, refinement=refinement, **sizes)
    solid = _isoparametric(mesh, "tet10", segment)
    block = free_block(solid, scene, wanted, seats(solid, mesh.p, scene, features))
    facts = _facts(meshed, solid, features, refinement) | {
        "sectors": meshed.count,
        "pair_tolerance": 1e-6,
    }
    return body_of(scene, wanted, (block,), facts, solid)


def whole_mesh(
    scene: Scene, wanted: Sequence, **sizes: Any
) -> tuple[MeshTet2, np.ndarray, SectorMesh]:
    """Return the mesh of all sectors, the segment of each element, and the sector that it is copied
    from; parameters as for :func:`whole`.
    """
    meshed = mirrored(meshed_sector(scene, wanted, cyclic_features(scene), **sizes))
    return (*replicated(meshed), meshed)


def cyclic_features(scene: Shaft) -> tuple[Any, ...]:
    """Return the features of a scene that repeat themselves around the axis: the resolved ones, or,
    without any, teeth that the scene smears for other models.
    """
    cyclic = tuple(f for f in scene.features if f.sort == CYCLIC)
    return tuple(f for f in cyclic if not f.smeared) or cyclic


def no_sector(scene: Shaft) -> str:
    """Return the reason why the features of a scene have no sector that can be meshed; empty if they
    have one.

    Examples
    --------
    >>> import solidgear as sg
    >>> no_sector(sg.load("geometry/pinion_toothed.toml"))
    ''
    """
    features = cyclic_features(scene)
    if not features:
        return ""
    return _edge_in_teeth(scene.outline, features) or no_common_sector(features)


def not_together(scene: Shaft) -> str:
    """Return the reason why teeth and bolt circles of a scene cannot be meshed beside cuts;
    empty if they can.
    """
    features = resolved(scene)
    around = [f for f in features if f.sort == CYCLIC]
    toothed = {f.segment: f for f in around if f.toothed}
    for teeth in toothed.values():
        label = f'{teeth.what} "{teeth.name}"'
        if teeth.spiral_angle:
            return f"a mesh with {label} is twisted, and would twist cuts beside it"
        pitch, first = 2 * math.pi / teeth.count, next(iter(toothed.values()))
        difference = (middle(teeth, 1) - middle(first, 1) + pitch / 2) % pitch - pitch / 2
        if abs(difference) > SAME_ANGLE:
            return f'{label} does not lie evenly about the middle of {first.what} "{first.name}"'
    for cut in features:
        if cut.sort != CYCLIC and cut.segment in toothed:
            teeth = toothed[cut.segment]
            return f'{cut.what} "{cut.name}" is cut into the segment of {teeth.what} "{teeth.name}"'
    return _edge_in_teeth(scene.outline, around)


def _edge_in_teeth(outline: Outline[Segment], features: Sequence[Any]) -> str:
    """Return the reason why fillets and chamfers beside teeth cannot be meshed, empty if they can:
    they stand on the face below the roots, or leave one above the tips.
    """
    toothed = {f.segment: f for f in features if f.toothed}
    for c in outline.corners:
        label, owner = f'{c.kind} "{c.name}"', outline.segments[c.owner]
        if owner.name in toothed:
            return f'{label} runs along the teeth of "{owner.name}": a sector holds none there'
        if not 0 < c.joint < len(outline.segments):
            continue
        s = outline.segments[c.joint if c.side < 0 else c.joint - 1]
        if s.name not in toothed:
            continue
        if c.surface == "bore":
            return f'{label} is in the bore, at the teeth of "{s.name}": a sector holds none there'
        pitch, r = s.outer0 if c.side < 0 else s.outer1, c.on_face[0]
        root, tip = toothed[s.name].land * pitch, toothed[s.name].tip * pitch
        least = SMALLEST * pitch
        if c.root and r > root - least:
            return (
                f'{label} reaches {r:.6g} m from the axis, where the roots of "{s.name}" lie at '
                f"{root:.6g} m: a sector needs it to end below {root - least:.6g} m"
            )
        if not c.root and r < tip + least:
            return (
                f'{label} begins {r:.6g} m from the axis, where the tips of "{s.name}" lie at '
                f"{tip:.6g} m: a sector needs it to begin above {tip + least:.6g} m"
            )
    return ""


def meshed_sector(
    scene, wanted, features, ends=(), *, size=None, graded_size=None, refinement=1.0, count=None
) -> SectorMesh:
    """Mesh one sector of a scene, divided at the planes ``ends`` too; parameters as for
    :func:`sector`.
    """
    sizes = {"size": size, "graded_size": graded_size, "refinement": refinement}
    assemblable(rough_sector(scene, wanted, count=count, **sizes), 10)
    plan = tetrahedra_plan(scene, wanted, around=16, **sizes)
    plan["planes"] = sorted({*plan["planes"], *ends})
    return sector_mesh(scene.outline, features, **plan, refinement=refinement, count=count)


def sectors_around(scene, options: Mapping[str, Any]) -> int:
    """Return the number of sectors of a scene: the number asked for, or that which features
    have in common.
    """
    return options.get("count") or max(1, sectors_of(cyclic_features(scene)))


def halved(scene: Shaft, count: int) -> bool:
    """Return True where the middle of one of so many sectors can lie in a mirror plane of all features.

    Examples
    --------
    >>> import solidgear as sg
    >>> [halved(sg.load(f"geometry/pinion_{kind}.toml"), 14) for kind in ("toothed", "spiral")]
    [True, False]
    """
    return mirror_angle(cyclic_features(scene), count) is not None


def sector_size(
    scene,
    *,
    ovalising: tuple[int, ...],
    attachments: tuple[str, ...] | None,
    count: int | None,
    half: bool,
    material_port: bool,
    **sizes: Any,
) -> Size:
    """Mesh one sector and count; parameters as for :func:`sector`.

    A wave around takes as many complex unknowns as the sector has, or, of half a sector, real ones.
    Motions that are equal in all sectors are real, and of half a sector fall into two.
    """
    wanted = [*attached_stations(scene.stations, attachments)]
    ends = (scene.port.lo, scene.port.hi) if material_port else ()
    meshed = meshed_sector(scene, wanted, cyclic_features(scene), ends, count=count, **sizes)
    meshed = meshed if half else mirrored(meshed)
    mesh: Any = _solved_part(meshed)[0]
    (_, entries), *_ = size_of_mesh(mesh.mesh, basis_of("tet10")).matrices
    n, nodes = mesh.nodes.shape[1], mesh.sector
    axis, waves = len(nodes.axis), 1 + len(ovalising)
    if meshed.half:
        planes = len(nodes.middle) + len(nodes.cut)
        rows = 6 * (n - planes - axis) + 3 * planes + axis
        # the two planes of bending are twins, of one matrix
        matrices, twins = [(rows // 2, entries)] * 2 + [(rows, 2 * entries)] * waves, rows
    else:
        rows = 3 * (n - len(nodes.slave) - axis) + axis
        matrices, twins = [(rows, entries)] + [(2 * rows, 4 * entries)] * waves, 0
    odd = rows % 2 if meshed.half else 0  # axial motion and torsion are halves of the rows
    total = sum(count for count, _ in matrices) + twins + odd
    return Size(total, tuple(matrices), sum(count for _, count in matrices))


def rough_sector(scene, wanted, *, refinement: float, count: int | None = None, **sizes) -> float:
    """Estimate the number of tetrahedra in half a sector, without meshing; parameters as for
    :func:`meshed_sector`.
    """
    plan = tetrahedra_plan(scene, wanted, refinement=refinement, around=16, **sizes)
    features = cyclic_features(scene)
    fine = [fine_lines(hole) for *_, hole in hole_sizes(scene.segments, features, refinement)]
    around = count or max(1, sectors_of(features))
    plan_sizes = {name: plan[name] for name in ("circles", "size", "graded_size")}
    return rough_cells(scene.outline, fine=fine, **plan_sizes) / (2 * around)


def _facts(meshed: SectorMesh, mesh: SolidMesh, features, refinement: float) -> dict[str, Any]:
    return {
        **mesh_facts(mesh, meshed.quality, meshed.parts),
        "refinement": refinement,
        "features": [f.name for f in features],
    }
