"""Blocks of a volume mesh with mirror planes: its motions by their parity in each.

A body of revolution in hexahedra looks the same in the mirror of the planes x = 0 and z = 0. Motions
that are symmetric or antisymmetric to each do not meet in the matrices (Bossavit 1986, "Symmetry,
groups, and boundary value problems"), so that every kind is a block of a quarter of the unknowns.
What all cells give it is what one cell of each set of images gives, times the cells of the set.
Where the plane x = z between them is a mirror as well it makes one of the two kinds of bending into
the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from solidgear.core.body import Block, Reflection
from solidgear.core.body.parity import mirrored_basis, symmetric_basis
from solidgear.core.kernel.attachment import Attached, with_ports
from solidgear.core.kernel.room import assembled
from solidgear.core.models.size import size_of_mesh
from solidgear.core.models.solid.block import Facets, ports_of, rigid_motions, seats_of
from solidgear.core.models.solid.enriched import enrichment
from solidgear.core.models.solid.images import images_of
from solidgear.core.models.solid.matrices import matrices_by_images
from solidgear.core.models.solid.mesh import SolidMesh

if TYPE_CHECKING:
    from solidgear.core.scene import Scene
    from solidgear.core.scene.shaft import Station

#: name and components of the motions of every parity in the planes x = 0 and z = 0
KINDS: dict[tuple[float, ...], tuple[str, tuple[int, ...]]] = {
    (1.0, -1.0): ("bending_z", (2, 3)),
    (-1.0, 1.0): ("bending_x", (0, 5)),
    (1.0, 1.0): ("axial", (1,)),
    (-1.0, -1.0): ("torsion", (4,)),
}


def blocks_by_parity(
    mesh: SolidMesh,
    scene: Scene,
    wanted: Sequence[tuple[Station, str]],
    facets_of: Facets,
    reflections: tuple[Reflection, ...],
) -> tuple[Block, ...]:
    """Build the free blocks of a mesh with two mirror planes, or three, with their ports; parameters
    as for :func:`~solidgear.core.models.solid.block.free_block`, and reflections from
    :func:`~solidgear.core.models.solid.block.mirrored`.
    """
    size = size_of_mesh(mesh.mesh, mesh.element, mirrors=True)
    assembled(size.entries, size.unknowns)
    materials = [segment.material for segment in scene.segments]
    images = images_of(mesh.mesh.t, reflections[:2])
    stiffness, mass, nodes = matrices_by_images(mesh, materials, images)
    seats = seats_of(mesh, scene, wanted, facets_of)
    ports = ports_of(mesh, scene, wanted, seats)
    rigid, y = rigid_motions(mesh.nodes), np.repeat(mesh.nodes[1], 3)
    enrich = partial(enrichment, mesh, materials, seats, reflections=reflections)
    summed = (3 * nodes[:, None] + np.arange(3)).ravel()
    blocks: list[Block] = []
    for parity, (name, components) in KINDS.items():
        if name == "bending_x" and len(reflections) == 3:
            blocks.append(_turned(blocks[0], name, components, parity, reflections[2]))
            continue
        basis = symmetric_basis(len(y), reflections[:2], parity)
        near, first = basis[summed], _first_of(basis)
        block = Block(
            name,
            components,
            (near.T @ stiffness @ near).tocsr(),
            (near.T @ (mass @ near)).tocsr(),
            basis.T @ rigid[:, list(components)],
            y[first],
            planar=False,
            expand=basis,
            parity=parity,
            enrich=enrich,
        )
        blocks.append(with_ports(block, [_of_kind(p, components, basis, first) for p in ports]))
    return tuple(blocks)


def _turned(
    bending: Block,
    name: str,
    components: tuple[int, ...],
    parity: tuple[float, ...],
    reflection: Reflection,
) -> Block:
    """Return the bending in the plane that a mirror between the two others turns one into."""
    assert bending.expand is not None
    twin = bending.mirrored(name, components, 0, (1.0, -1.0))
    return replace(twin, expand=mirrored_basis(bending.expand, reflection), parity=parity)


def _of_kind(
    port: Attached, components: tuple[int, ...], basis: sp.csr_matrix, first: np.ndarray
) -> Attached:
    """Return a port on the unknowns of one kind, given on those of the mesh."""
    if port.held is not None:
        return Attached(port.place, held=port.held[first])
    return Attached(port.place, sp.csr_matrix(port.rows)[list(components)] @ basis)


def _first_of(basis: sp.csr_matrix) -> np.ndarray:
    """Return the first unknown of the mesh in every one of a kind."""
    columns = basis.tocsc()
    return columns.indices[columns.indptr[:-1]]
