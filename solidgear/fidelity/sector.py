"""A shaft with teeth, splines or bolt circles in 3D: from one sector of it, or whole from copies of
the same mesh.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from solidgear.body import Body, Port
from solidgear.body.surface import Surface, Volume
from solidgear.errors import SolidgearError
from solidgear.fidelity.attachment import tie_rigidly
from solidgear.fidelity.cyclic import Sector, cyclic_blocks
from solidgear.fidelity.halves import seat_on_cylinder
from solidgear.fidelity.options import SECTOR_OPTIONS, checked
from solidgear.fidelity.rung import CYCLIC
from solidgear.fidelity.scale import elastic_scale
from solidgear.fidelity.solid import tetrahedra_plan
from solidgear.fidelity.solid_block import Facets, free_block
from solidgear.fidelity.solid_drawing import solid_surface
from solidgear.fidelity.solid_mesh import SolidMesh, _isoparametric
from solidgear.frames import rotation
from solidgear.meshing.quality import check_mesh
from solidgear.meshing.sector import (
    SectorMesh,
    cut_vertices,
    matched,
    replicated,
    sector_mesh,
    volume_of_sector,
)

#: eigenvalues of pairs in a real matrix made of a complex one differ by rounding
PAIRS = 1e-9


def sector(
    scene: Any,
    *,
    size: float | None = None,
    graded_size: float | None = None,
    refinement: float = 0.7,
    material_port: bool = False,
    ovalising: tuple[int, ...] = (),
    attachments: tuple[str, ...] | None = None,
    count: int | None = None,
) -> Body:
    """Free body of a shaft that repeats itself around the axis, from one sector of it.

    Teeth are resolved, also those that the scene smears for other models.

    Parameters
    ----------
    scene : Scene
        With teeth, splines or bolt circles, and no feature of another kind.
    size, graded_size, refinement
        As for tetrahedra of :func:`solidgear.fidelity.solid.solid`.
    material_port : bool
        Stations on toothed segments follow the mean motion of their material, not that of their
        flanks, tips and roots.
    ovalising : tuple of int
        Further harmonic indices to build, from 2 to less than half the sectors.
    attachments : tuple of str, optional
        Attachments to build at every station, the first being the default one.
    count : int, optional
        Sectors around; by default as many as features have in common.

    Returns
    -------
    Body
        Blocks ``cyclic_0`` of axial motion and torsion, and ``cyclic_1`` of bending.

    Raises
    ------
    SolidgearError
        Features without a common sector, a harmonic index that is too high, or a seat without
        faces; MeshError where meshing fails.
    """
    own = {"size": size, "graded_size": graded_size, "refinement": refinement}
    given = {**own, "ovalising": ovalising, "attachments": attachments}
    attachments = checked("sector", given, SECTOR_OPTIONS)["attachments"]
    wanted = [(s, a) for s in scene.stations for a in (attachments or (s.attachment,))]
    features = cyclic_features(scene)
    made = meshed_sector(scene, wanted, features, count=count, **own)
    high = [h for h in ovalising if 2 * h >= made.count]
    if high:
        raise SolidgearError(
            f"sector: ovalising {high[0]} is not below half of the {made.count} sectors"
        )
    mesh = _mesh_of(made)
    facets = seats(mesh, made.straight, scene, features)

    def parts_of(station, attachment):
        if material_port and attachment == "average" and on_teeth(station, scene, features):
            y = made.straight[1][made.mesh.t]
            inside = (y > station.lo - 1e-9) & (y < station.hi + 1e-9)
            return mesh.over_cells(np.flatnonzero(inside.all(axis=0))), None
        found = facets(station, attachment)
        if not len(found):
            raise SolidgearError(f"port {station.name!r}: no element faces lie on its seat")
        held = mesh.facet_unknowns(found) if attachment == "rigid" else None
        return mesh.over_facets(found), held

    blocks = cyclic_blocks(mesh, scene, mesh.sector, wanted, parts_of, ovalising)
    facts = _facts(made, mesh, features, refinement) | {"pair_tolerance": PAIRS}
    return _body("sector", scene, wanted, blocks, facts, mesh)


def whole(scene: Any, wanted: Sequence, *, refinement: float, **own: Any) -> Body:
    """Free body of the same shaft in full: all sectors, copies of one mesh.

    Parameters
    ----------
    scene : Scene
    wanted : sequence of (station, attachment)
    refinement : float
    **own
        ``size`` and ``graded_size`` of :func:`sector`.

    Returns
    -------
    Body
        One block.

    Raises
    ------
    SolidgearError
        As :func:`sector`.
    """
    features = cyclic_features(scene)
    made = meshed_sector(scene, wanted, features, refinement=refinement, **own)
    mesh, segment = replicated(made)
    solid = _isoparametric(mesh, "tet10", segment)
    block, ties = free_block(solid, scene, wanted, seats(solid, mesh.p, scene, features))
    facts = _facts(made, solid, features, refinement) | {"pair_tolerance": 1e-6}
    return _body("solid", scene, wanted, (tie_rigidly(block, ties),), facts, solid)


def cyclic_features(scene: Any) -> tuple[Any, ...]:
    """Features of a scene that repeat themselves around the axis, smeared or not.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    tuple of Teeth, Spline or BoltCircle
    """
    return tuple(f for f in getattr(scene, "features", ()) if f.kind in CYCLIC)


def meshed_sector(
    scene, wanted, features, *, size=None, graded_size=None, refinement=0.7, count=None
) -> SectorMesh:
    """The mesh of one sector of a scene; parameters as for :func:`sector`."""
    plan = tetrahedra_plan(
        scene, wanted, size=size, graded_size=graded_size, refinement=refinement, around=16
    )
    return sector_mesh(scene.segments, features, **plan, refinement=refinement, count=count)


def _body(fidelity, scene, wanted, blocks, facts, drawing) -> Body:
    ports = tuple(Port(s.name, s.y, a) for s, a in wanted)
    return Body(fidelity, blocks, ports, elastic_scale(scene), scene.length, facts, drawing)


def _facts(made: SectorMesh, mesh: SolidMesh, features, refinement: float) -> dict[str, Any]:
    elements = made.mesh.t.shape[1]
    return {
        "element": "tet10",
        "elements": elements * made.count,
        "nodes": int(mesh.nodes.shape[1]),
        "sectors": made.count,
        "refinement": refinement,
        "volume": made.count * made.quality.volume,
        "min_jacobian_ratio": made.quality.min_ratio,
        "representative_size": float((made.quality.volume / elements) ** (1 / 3)),
        "features": [f.name for f in features],
    }


def on_teeth(station, scene, features) -> bool:
    """Whether a station sits on a toothed segment."""
    names = {f.segment for f in features if f.kind != "bolt_circle"}
    return any(
        s.name in names and station.lo < s.y1 and station.hi > s.y0 for s in scene.segments
    )


def seats(mesh: SolidMesh, straight: np.ndarray, scene, features) -> Facets:
    """Facets of seats: on what is left of surfaces of revolution, and flanks, tips and roots of
    teeth.

    Parameters
    ----------
    mesh : SolidMesh
        Of a sector, or of the whole.
    straight : (3, nv) ndarray
        Places of its vertices, m; only y and the radius count.
    scene : Scene
    features : sequence of Teeth, Spline or BoltCircle

    Returns
    -------
    callable
        ``facets(station, attachment)``.
    """
    toothed = {f.segment: f for f in features if f.kind != "bolt_circle"}
    tolerance = 1e-7 * scene.length
    plain = [s for s in scene.segments if s.name not in toothed]
    on_cylinder = seat_on_cylinder(mesh, plain, tolerance)
    corners = mesh.mesh.facets[:, mesh.boundary]
    y, r = straight[1, corners], np.hypot(*straight[[0, 2]][:, corners])

    def facets(station, attachment):
        found = on_cylinder(station, attachment)
        if attachment == "section":
            return found
        low, high = y.min(axis=0), y.max(axis=0)
        on = np.zeros(len(mesh.boundary), bool)
        for s in scene.segments:
            if s.name in toothed:
                teeth = toothed[s.name]
                pitch = s.outer0 + (s.outer1 - s.outer0) * (y - s.y0) / s.length
                # chords of roots run below their circle by this at most; bores and holes lie deeper
                least = teeth.root * np.cos(np.pi / teeth.count - teeth.root_half) * (1 - 1e-6)
                here = (low > s.y0 - tolerance) & (high < s.y1 + tolerance)
                on |= here & (r > least * pitch).all(axis=0)
        inside = (low >= station.lo - tolerance) & (high <= station.hi + tolerance)
        steep = high - low > tolerance
        return np.union1d(found, mesh.boundary[inside & steep & on])

    return facets


@dataclass(frozen=True, eq=False)
class SectorSolid(SolidMesh):
    """The mesh of a sector, which draws the whole part.

    Attributes
    ----------
    sector : Sector
    inner : (k,) ndarray of int
        Facets on the cut faces.
    """

    sector: Sector
    inner: np.ndarray

    @cached_property
    def boundary(self) -> np.ndarray:
        """Indices of the facets on the surface of the whole part."""
        return np.setdiff1d(self.mesh.boundary_facets(), self.inner)

    def surface(self, moved: Mapping[str, np.ndarray]) -> Surface:
        """All copies of the sector, each with its phase."""
        parts = {}
        for name, vector in moved.items():
            h = int(name.removeprefix("cyclic_"))
            real, imaginary = (vector, None) if h == 0 else (vector[::2], vector[1::2])
            parts[h] = [None if v is None else solid_surface(self, v) for v in (real, imaginary)]
        rest = solid_surface(self, None)
        size, copies = len(rest.points), []
        for k in range(self.sector.count):
            angle = k * self.sector.angle
            local = np.zeros((size, 3))
            for h, (real, imaginary) in parts.items():
                local += np.cos(h * angle) * real.displacement
                if imaginary is not None:
                    local -= np.sin(h * angle) * imaginary.displacement
            turn = rotation(1, angle)[:3, :3].T
            copies.append((rest.points @ turn, local @ turn))
        points, displacement = (np.vstack(part) for part in zip(*copies))
        shift = size * np.arange(self.sector.count)[:, None, None]

        def every(cells):
            return (cells + shift).reshape(-1, cells.shape[1])

        return Surface(
            points, displacement, every(rest.faces), every(rest.triangles), every(rest.lines)
        )

    def volume(self) -> Volume | None:
        """No mesh of the whole part."""
        return None


def _mesh_of(made: SectorMesh) -> SectorSolid:
    plain = _isoparametric(made.mesh, "tet10", made.segment)
    low, high, axis = cut_vertices(made)
    outside = made.mesh.boundary_facets()
    inner, sides = [], []
    for own in (low, high):
        on = np.zeros(plain.nodes.shape[1], bool)
        on[own] = on[axis] = True
        inner.append(outside[on[made.mesh.facets[:, outside]].all(axis=0)])
        sides.append(plain.facet_unknowns(inner[-1]))
    on_axis = np.intersect1d(*sides)
    master, slave = (np.setdiff1d(side, on_axis) for side in sides)
    master = matched(plain.nodes, made.count, master, slave)
    return SectorSolid(
        plain.mesh,
        plain.name,
        plain.element,
        plain.dofs,
        plain.nodes,
        plain.segment,
        Sector(made.count, master, slave, on_axis),
        np.concatenate(inner),
    )
