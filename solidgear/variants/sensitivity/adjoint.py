"""Fields that derivatives of compliances, stiffnesses and natural frequencies are made of.

The problem is self-adjoint: with ``K u = B' F`` for the free body and the reactions of bearings
among the forces F on the ports, a compliance changes by

    dC = - u_a' dK u_b + F_a' dB u_b + F_b' dB u_a - d_a' dKb d_b

with motions d = B u of the ports and the springs Kb.  An eigenvalue of a normed shape changes by
the negative of the same with ``dK - lambda dM`` and ``dKb - lambda dMb``; a stiffness K = C^-1 by
the negative of it too, for the loads ``K e`` that move the port by one.  No further solution is
needed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.core import (
    COMPLIANCE,
    Bearing,
    Body,
    Mode,
    Port,
    Quantity,
    Scene,
    SolidgearError,
    Supports,
    flexibility,
)
from solidgear.core.scene import PointMass
from solidgear.core.solve.statics import condense


@dataclass(frozen=True, eq=False)
class State:
    """A displacement of a body on bearings."""

    vectors: dict[int, np.ndarray]  #: by block
    forces: np.ndarray  #: (6 p,) on all ports
    motions: np.ndarray  #: (6 p,) of all ports
    eigenvalue: float = 0.0  #: of a mode, rad^2/s^2; 0 of a static displacement


@dataclass(frozen=True, eq=False)
class Form:
    """A number as a sum over pairs of states: the derivative is ``scale`` times the sum of those of
    the compliance of each pair.
    """

    pairs: tuple[tuple[State, State], ...]
    scale: float


def entry_form(body: Body, supports: Supports, wanted: Quantity, port: str) -> tuple[float, Form]:
    """Return the value and the form of an entry of the compliance or stiffness of a port;
    SolidgearError if the motion is free, so that the entry has no value.
    """
    condensed = condense(body, supports, port)
    matrix = condensed.compliance if wanted.kind == COMPLIANCE else condensed.stiffness
    value = float(matrix[wanted.place])
    if not np.isfinite(value) or condensed.free[list(wanted.place)].any():
        raise SolidgearError(f"{wanted}: {port} moves freely there; there is no derivative")
    rows = 6 * body.port_index(port) + np.arange(6)
    loads = np.eye(6) if wanted.kind == COMPLIANCE else condensed.stiffness
    row, column = wanted.place
    first = _loaded(body, supports, rows, loads[row])
    second = first if row == column else _loaded(body, supports, rows, loads[column])
    return value, Form(((first, second),), 1.0 if wanted.kind == COMPLIANCE else -1.0)


def mode_form(body: Body, supports: Supports, mode: Mode) -> Form:
    """Return the form of a natural frequency, of a pair that of the mean of both eigenvalues."""
    rows, omega = supports.rows(body), 2 * np.pi * mode.frequency_hz
    states = []
    for vectors in mode.vectors:
        motions = body.port_motions(vectors)
        weight = sum(u @ (body.block(index).mass @ u) for index, u in vectors.items())
        port_motion = motions[rows]
        size = 1 / np.sqrt(weight + port_motion @ supports.masses @ port_motion)
        pull = supports.stiffness @ port_motion - omega**2 * supports.masses @ port_motion
        forces = np.zeros_like(motions)
        np.subtract.at(forces, rows, size * pull)
        scaled = {index: size * u for index, u in vectors.items()}
        states.append(State(scaled, forces, size * motions, omega**2))
    scale = -1 / (8 * np.pi**2 * mode.frequency_hz) / len(states)
    return Form(tuple((state, state) for state in states), scale)


def change_by_bodies(form: Form, low: Body, high: Body) -> float:
    """Return the change of a number from one body to another with the same unknowns, at the states
    of a body between them; SolidgearError if the mesh changes.
    """
    total = 0.0
    for a, b in form.pairs:
        for index in a.vectors.keys() & b.vectors.keys():
            low_block, high_block = low.block(index), high.block(index)
            u, v = a.vectors[index], b.vectors[index]
            if not low_block.size == high_block.size == len(u):
                raise SolidgearError("the mesh changes with it")
            total -= u @ (high_block.stiffness @ v - low_block.stiffness @ v)
            if a.eigenvalue:
                total += a.eigenvalue * (u @ (high_block.mass @ v - low_block.mass @ v))
            if low_block.components:
                rows = low.rows(low_block)
                total += a.forces[rows] @ (high_block.ports @ v - low_block.ports @ v)
                total += b.forces[rows] @ (high_block.ports @ u - low_block.ports @ u)
    return form.scale * float(total)


def change_by_supports(form: Form, rows: np.ndarray, low: Supports, high: Supports) -> float:
    """Return the change of a number from springs and masses to others, on ports at the given
    `rows`.
    """
    stiff, heavy = high.stiffness - low.stiffness, high.masses - low.masses
    total = 0.0
    for a, b in form.pairs:
        total -= a.motions[rows] @ (stiff - a.eigenvalue * heavy) @ b.motions[rows]
    return form.scale * float(total)


def _loaded(body: Body, supports: Supports, load_rows: np.ndarray, load: Sequence[float]) -> State:
    """Compute the state under a load on a port: forces of bearings and the rigid motion from
    equilibrium.
    """
    flex, rows, root = flexibility(body), supports.rows(body), supports.root
    forces = np.zeros(6 * len(body.ports))
    forces[load_rows] = load
    rigid, r = body.rigid_ports, root.shape[1]
    reach = root.T @ rigid[rows]
    system = np.zeros((r + 6, r + 6))
    system[:r, :r] = np.eye(r) + root.T @ flex.matrix[np.ix_(rows, rows)] @ root
    system[:r, r:], system[r:, :r] = -reach, reach.T
    right = np.concatenate([root.T @ (flex.matrix @ forces)[rows], rigid.T @ forces])
    # both sides brought to size one; a free rotation is a column of zeros and stays still
    size = np.concatenate([1 / np.sqrt(np.diag(system)[:r]), np.ones(6)])
    column = np.abs(system[:r, r:] * size[:r, None]).max(axis=0)
    size[r:] = 1 / np.where(column > 0, column, 1.0)
    solved = size * np.linalg.lstsq(system * np.outer(size, size), size * right, rcond=1e-13)[0]
    np.subtract.at(forces, rows, root @ solved[:r])
    motions = flex.matrix @ forces + rigid @ solved[r:]
    vectors = {}
    for index, block in enumerate(body.blocks):
        components = list(block.components)
        original, signs = block.mirror or (index, (1.0,) * len(components))
        pushed = np.tile(signs, len(body.ports)) * forces[body.rows(block)]
        u = block.rigid @ solved[r:][components]
        if block.size > len(components):  # else all of it is rigid, and what bends is rounding
            u = u + flex.fields[original] @ pushed
        if u.any():
            vectors[index] = u
    return State(vectors, forces, motions)


#: places of a seat
SEAT = ("y", "lo", "hi")


def rates(
    low: Sequence[object], high: Sequence[object], names: Sequence[str], step: float
) -> np.ndarray:
    """Return the rates (things, names) of some numbers of segments, seats or others from a scene to
    another; refuse a shaft that takes another form.
    """
    if len(low) != len(high):
        raise SolidgearError("the shaft takes another form there")
    a, b = (
        np.array([[getattr(thing, name) for name in names] for thing in things])
        for things in (low, high)
    )
    return (b - a) / step


def line_velocities(
    scene: Scene,
    stations: Sequence[tuple[Port | Bearing | PointMass, str]],
    segments: np.ndarray,
    seats: np.ndarray,
    followed: Mapping[str, Sequence[str]],
) -> tuple[np.ndarray, np.ndarray]:
    """Return places along the axis that nodes follow, ascending, and their velocities: ends of
    segments, and those places of seats that are `followed` by their attachment; refuse places of
    one line that move apart. Rates are those of :func:`rates`, of segments by shape.
    """
    marks = {0.0: 0.0} | {s.y1: moved[1] for s, moved in zip(scene.segments, segments)}
    tol = 1e-9 * scene.length
    for (station, attachment), moved in zip(stations, seats):
        for name in followed[attachment]:
            place, rate = getattr(station, name), moved[SEAT.index(name)]
            near = next((mark for mark in marks if abs(mark - place) < tol), None)
            if near is None:
                marks[place] = rate
            elif attachment != "average" and abs(marks[near] - rate) > 1e-6 * max(1.0, abs(rate)):
                raise SolidgearError(
                    f"{station.name} is tied ({attachment}) at a line of the mesh that does not move"
                )
    places = np.array(sorted(marks))
    return places, np.array([marks[place] for place in places])


def in_plane(body: Body, index: int, six: np.ndarray) -> np.ndarray:
    """Return the components (p, c) of all ports in the plane that a block is written in."""
    block = body.block(index)
    _, signs = block.mirror or (index, (1.0,) * len(block.components))
    return six.reshape(-1, 6)[:, list(block.components)] * signs


def shared_blocks(body: Body, pair: tuple[State, State]) -> Iterator[tuple[int, list[np.ndarray]]]:
    """Yield the blocks in which both states of a pair move, with their unknowns on the mesh."""
    for index in pair[0].vectors.keys() & pair[1].vectors.keys():
        block = body.block(index)
        shapes = [state.vectors[index] for state in pair]
        yield index, [u if block.expand is None else block.expand @ u for u in shapes]
