"""A solid problem as plain arrays: what every 3D peer is given."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Seat:
    """A surface tied to a point on the axis, which a spring holds.

    Attributes
    ----------
    y : float
        Of the point, m.
    nodes : (k,) ndarray of int
    stiffness : (6, 6) ndarray
        SI, order x y z thx thy thz.
    mean : (6, n, 3) ndarray or None
        The point's motion as the mean of the surface's; None where the surface is rigid and moves
        with the point.
    """

    y: float
    nodes: np.ndarray
    stiffness: np.ndarray
    mean: np.ndarray | None


@dataclass(frozen=True, eq=False)
class Problem:
    """Nodes, cells, materials, seats and loads of a solid body.

    Attributes
    ----------
    element : str
        ``tet10``, ``hex20`` and so on.
    doflocs : (nb, 3) ndarray
        Reference coordinates of a cell's nodes on the unit simplex or cube.
    nodes : (n, 3) ndarray
        m.
    cells : (ne, nb) ndarray of int
    material : (ne,) ndarray of int
        Index into ``materials``.
    materials : tuple of (E, nu, density)
    seats : tuple of Seat
    wrench : (6, n, 3) ndarray
        Nodal forces of the six unit loads at the lumped port; with displacements u, ``wrench . u``
        is the port's motion.
    """

    element: str
    doflocs: np.ndarray
    nodes: np.ndarray
    cells: np.ndarray
    material: np.ndarray
    materials: tuple[tuple[float, float, float], ...]
    seats: tuple[Seat, ...]
    wrench: np.ndarray

    @property
    def loaded(self) -> np.ndarray:
        """Nodes that carry any of the unit loads."""
        return np.flatnonzero(self.wrench.any(axis=(0, 2)))


def problem_of(body, scene) -> Problem:
    """The problem a solid body stands for.

    Parameters
    ----------
    body : Body
        Solid.
    scene : Scene
        The one it was built from: bearings ``rigid`` or ``average``, the lumped point ``average``.
    """
    mesh = body.geometry
    n = mesh.nodes.shape[1]

    def mean(station):
        index = body.port_index(station.name)
        out = np.zeros((6, 3 * n))
        for block in body.blocks:
            count = len(block.components)
            rows = block.ports[count * index : count * (index + 1)]
            if block.expand is not None:
                # Unknowns that no seat ties come first and are orthonormal motions of the mesh; a mean
                # that reaches others would need the seat's motion.
                free = block.size - block.border
                if abs(rows[:, free:]).sum() > 0:
                    raise ValueError(f"{station.name} shares nodes with a rigid seat")
                rows = rows[:, :free] @ block.expand[:, :free].T
            out[list(block.components)] = rows.toarray()
        return out.reshape(6, n, 3)

    seats = []
    for bearing in scene.bearings:
        at = mesh.facet_unknowns(mesh.seat(bearing, scene.segments, 1e-7 * scene.length))
        motion = None if bearing.attachment == "rigid" else mean(bearing)
        seats.append(Seat(bearing.y, at, np.array(bearing.stiffness), motion))
    materials = [(m.E, m.nu, m.density) for m in (s.material for s in scene.segments)]
    kinds = tuple(dict.fromkeys(materials))
    owner = np.array([kinds.index(material) for material in materials])
    return Problem(
        element=mesh.name,
        doflocs=np.asarray(mesh.element.doflocs),
        nodes=mesh.nodes.T,
        cells=mesh.dofs.T,
        material=owner[mesh.segment],
        materials=kinds,
        seats=tuple(seats),
        wrench=mean(scene.port),
    )
