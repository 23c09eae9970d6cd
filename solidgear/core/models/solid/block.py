"""Free block with ports from a volume mesh."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.body import Block, Body, Port, Reflection
from solidgear.core.errors import SolidgearError
from solidgear.core.kernel.attachment import Attached, with_ports
from solidgear.core.meshing.edge_places import edge_places
from solidgear.core.models.solid.enriched import Seat, enrichment
from solidgear.core.models.solid.matrices import _matrices, _mean
from solidgear.core.models.solid.mesh import SolidMesh
from solidgear.core.models.spectrum import elastic_scale
from solidgear.core.scene.patches import point_of

if TYPE_CHECKING:
    from solidgear.core.body.surface import Drawing
    from solidgear.core.meshing.quality import MeshQuality
    from solidgear.core.scene import Scene
    from solidgear.core.scene.parts import Material, Segment
    from solidgear.core.scene.shaft import Station

#: components of a node by those of its mirror image, in the planes x = 0, z = 0 and x = z
SWAPPED = [2, 1, 0]
PLANES = (([0, 1, 2], (-1, 1, 1)), ([0, 1, 2], (1, 1, -1)), (SWAPPED, (1, 1, 1)))
#: facets of a mesh that carry a station, by its attachment
Facets = Callable[["Station", str], np.ndarray]


def seat_facets(mesh: SolidMesh, segments: Sequence[Segment], tolerance: float) -> Facets:
    """Return the function that gives the facets of seats and sections of a body of revolution, within
    a tolerance, m, by station and attachment.
    """

    def facets(station, attachment):
        if attachment == "section":
            return mesh.section(station.y, tolerance)
        return mesh.seat(station, segments, tolerance)

    return facets


#: share of the sagitta of an edge by which its middle node may lie off the surface; where elements keep
#: the volume it is a fiftieth at most, and the floor of a feature is all of it away
BEYOND = 0.1


def edges_of(mesh: SolidMesh, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the edges (m, f) between the corners (c, f) of facets, -1 for a diagonal of a
    quadrilateral, which is no edge; and their middle nodes (3, m, f), m, a corner for a diagonal.
    """
    middle = np.zeros(mesh.mesh.edges.shape[1], int)
    middle[mesh.mesh.t2e] = mesh.dofs[len(mesh.mesh.t) : len(mesh.mesh.t) + len(mesh.mesh.t2e)]
    # of four corners of a quadrilateral two pairs are its diagonals
    i, j = np.array(_pairs(corners)).T
    edge = edge_places(mesh.mesh.edges, np.array([corners[i], corners[j]]))
    return edge, np.where(edge >= 0, mesh.nodes[:, middle[edge]], mesh.mesh.p[:, corners[i]])


def _pairs(corners: np.ndarray) -> list[tuple[int, int]]:
    """Return the places of any two corners of a facet."""
    return [(i, j) for i in range(len(corners)) for j in range(i)]


def chords(mesh: SolidMesh, corners: np.ndarray) -> np.ndarray:
    """Return the radii (m, f) halfway between the ends of the edges of facets, m, in the order of
    :func:`edges_of`.
    """
    p = mesh.mesh.p[[0, 2]]
    middles = [(p[:, corners[i]] + p[:, corners[j]]) / 2 for i, j in _pairs(corners)]
    return np.array([np.hypot(*middle) for middle in middles])


def rigid_motions(nodes: np.ndarray) -> np.ndarray:
    """Return the unit rigid motions (3 n, 6) about the origin of nodes (3, n), m, node by node."""
    n = nodes.shape[1]
    rigid: np.ndarray = np.zeros((n, 3, 6))
    rigid[:, :, :3] = np.eye(3)
    x, y, z = nodes
    zero = np.zeros(n)
    # th x r, column by column
    rigid[:, :, 3] = np.column_stack([zero, -z, y])
    rigid[:, :, 4] = np.column_stack([z, zero, -x])
    rigid[:, :, 5] = np.column_stack([-y, x, zero])
    return rigid.reshape(3 * n, 6)


def mirrored(nodes: np.ndarray, hair: float) -> tuple[np.ndarray, tuple[Reflection, ...]]:
    """Return nodes (3, n), m, with the mirror planes x = 0, z = 0 and x = z that they have; nodes nearer
    than ``hair``, m, to each other are one.

    Nodes are moved by the rounding that kept images from lying where they should: beside the thickness
    of a thin cell that is a hundred times the rounding of a matrix. Reflections are as
    :class:`~solidgear.core.body.Block` takes them; none for a plane in which a node has no image, nor for
    x = z without the others.

    Examples
    --------
    >>> nodes, ((partner, sign),) = mirrored(np.array([[1.0, -1.0], [0.0, 0.0], [2.0, 2.0]]), 1e-6)
    >>> partner, sign
    (array([3, 4, 5, 0, 1, 2]), array([-1.,  1.,  1., -1.,  1.,  1.]))
    """
    reflections: list[Reflection] = []
    for order, sign in PLANES:
        turn = np.array(sign)[:, None]
        places = np.rint(nodes / hair).astype(np.int64)
        images = places[order] * turn
        by_place, by_image = np.lexsort(places), np.lexsort(images)
        if not np.array_equal(places[:, by_place], images[:, by_image]):
            continue
        if order == SWAPPED and len(reflections) < 2:
            continue
        partner = np.empty(nodes.shape[1], int)
        partner[by_place] = by_image
        nodes = (nodes + turn * nodes[:, partner][order]) / 2
        reflections.append(
            ((3 * partner[:, None] + order).ravel(), np.tile(np.array(sign, float), len(partner)))
        )
    return nodes, tuple(reflections)


def free_block(
    mesh: SolidMesh,
    scene,
    wanted: Sequence[tuple[Station, str]],
    facets_of: Facets,
    *,
    clipped: bool = False,
    materials: Sequence[Material] | None = None,
) -> Block:
    """Build the free block of a mesh, of all six components, with its ports; refuse a seat without
    faces, and a rigid one without nodes.

    `facets_of` is that of :func:`seat_facets`, say; `clipped`: facets may reach beyond the ends of
    their seat, where integrals stop; `materials` are those that the elements name, by default those of
    the segments.
    """
    materials = materials or [segment.material for segment in scene.segments]
    k, m = _matrices(mesh, materials)
    seats = seats_of(mesh, scene, wanted, facets_of, clipped)
    block = Block(
        "full",
        tuple(range(6)),
        k,
        m,
        rigid_motions(mesh.nodes),
        np.repeat(mesh.nodes[1], 3),
        planar=False,
        enrich=partial(enrichment, mesh, materials, seats),
    )
    return with_ports(block, ports_of(mesh, scene, wanted, seats))


def seats_of(
    mesh: SolidMesh,
    scene,
    wanted: Sequence[tuple[Station, str]],
    facets_of: Facets,
    clipped: bool = False,
) -> list[Seat]:
    """Return the facets of all ports; parameters as for :func:`free_block`."""
    seats = []
    for station, attachment in wanted:
        facets = facets_of(station, attachment)
        if not len(facets):
            face = "section" if attachment == "section" else "seat"
            raise SolidgearError(f"port {station.name!r}: no element faces lie on its {face}")
        patch = getattr(station, "patch", None)
        cut = clipped and attachment != "section" and patch is None
        span = (station.lo, station.hi) if cut else None
        seats.append(Seat(point_of(station), facets, attachment == "rigid", span))
    return seats


def ports_of(
    mesh: SolidMesh, scene, wanted: Sequence[tuple[Station, str]], seats: Sequence[Seat]
) -> list[Attached]:
    """Return the ports of all seats on the unknowns of a mesh."""
    n = mesh.nodes.shape[1]
    ports = []
    for (station, _), seat in zip(wanted, seats):
        if not seat.rigid:
            mean = _mean(mesh, seat.facets, seat.place, n, within=seat.within)
            ports.append(Attached(seat.place, mean))
            continue
        mask = np.zeros((n, 3), bool)
        mask[mesh.facet_unknowns(seat.facets)] = True
        if seat.within is not None:
            y, hair = mesh.nodes[1], 1e-7 * scene.length
            mask[(y < seat.within[0] - hair) | (y > seat.within[1] + hair)] = False
        if not mask.any():
            raise SolidgearError(
                f"port {station.name!r}: no node lies between the ends of its rigid seat: use a "
                "finer mesh there, or attachment 'average'"
            )
        ports.append(Attached(seat.place, held=mask.ravel()))
    return ports


def body_of(
    scene: Scene,
    wanted: Sequence[tuple[Station, str]],
    blocks: tuple[Block, ...],
    facts: dict[str, Any],
    drawing: Drawing,
    model: str = "solid",
) -> Body:
    """Return the body of some blocks of a volume mesh, with their stations."""
    points = [point_of(station) for station, _ in wanted]
    ports = tuple(Port(s.name, y, a, x, z) for (s, a), (x, y, z) in zip(wanted, points))
    return Body(model, blocks, ports, elastic_scale(scene), scene.length, facts, drawing)


def mesh_facts(solid: SolidMesh, quality: MeshQuality, copies: int = 1) -> dict[str, Any]:
    """Return the facts of a mesh of which so many copies make the body, with the quality of one."""
    return {
        "element": solid.name,
        "elements": quality.n_elements * copies,
        "nodes": int(solid.nodes.shape[1]),
        "volume": copies * quality.volume,
        "min_jacobian_ratio": quality.min_ratio,
        "geometry": quality.geometry,
        "representative_size": float((quality.volume / quality.n_elements) ** (1 / 3)),
    }
