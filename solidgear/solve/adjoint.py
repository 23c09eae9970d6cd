"""Fields that derivatives of compliances, stiffnesses and natural frequencies are made of.

The problem is its own adjoint: with ``K u = B' F`` for the free body and what bearings do among the
forces F on its ports, a compliance changes by

    dC = - u_a' dK u_b + F_a' dB u_b + F_b' dB u_a - d_a' dKb d_b

with motions d = B u of the ports and the springs Kb.  An eigenvalue of a normed shape changes by the
negative of the same with ``dK - lambda dM`` and ``dKb - lambda dMb``; a stiffness K = C^-1 by the
negative of it too, for the loads ``K e`` that move the port by one.  Nothing is solved anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.body import Body, Supports
from solidgear.errors import SolidgearError
from solidgear.quantity import COMPLIANCE, Quantity
from solidgear.solve.modes import Mode
from solidgear.solve.statics import condense, flexibility


@dataclass(frozen=True, eq=False)
class State:
    """A displacement of a body with its bearings."""

    vectors: dict[int, np.ndarray]  #: by block
    #: forces, motions: (6 p,) on and of all ports
    forces: np.ndarray
    motions: np.ndarray
    #: along, around, shear: of a mode, rad^2/s^2; 0 of a static one
    eigenvalue: float = 0.0


@dataclass(frozen=True, eq=False)
class Form:
    """A number as a sum over pairs of states: its derivative is ``scale`` times the sum of that of
    the compliance of each pair.
    """

    pairs: tuple[tuple[State, State], ...]
    scale: float


def of_entry(body: Body, supports: Supports, wanted: Quantity, port: str) -> tuple[float, Form]:
    """Value and form of an entry of the compliance or stiffness of a port.

    Raises
    ------
    SolidgearError
        If the motion is free, so that the entry has no value.
    """
    at = condense(body, supports, port)
    matrix = at.compliance if wanted.kind == COMPLIANCE else at.stiffness
    value = float(matrix[wanted.place])
    if not np.isfinite(value) or at.free[list(wanted.place)].any():
        raise SolidgearError(f"{wanted}: {port} moves freely there; there is no derivative")
    here = 6 * body.port_index(port) + np.arange(6)
    loads = np.eye(6) if wanted.kind == COMPLIANCE else at.stiffness
    row, column = wanted.place
    first = _loaded(body, supports, here, loads[row])
    second = first if row == column else _loaded(body, supports, here, loads[column])
    return value, Form(((first, second),), 1.0 if wanted.kind == COMPLIANCE else -1.0)


def of_mode(body: Body, supports: Supports, mode: Mode) -> Form:
    """Form of a natural frequency, of a pair that of the mean of both eigenvalues."""
    there, omega = supports.rows(body), 2 * np.pi * mode.frequency_hz
    states = []
    for vectors in mode.vectors:
        motions = body.port_motions(vectors)
        weight = sum(u @ (body.block(index).mass @ u) for index, u in vectors.items())
        held = motions[there]
        size = 1 / np.sqrt(weight + held @ supports.masses @ held)
        pull = supports.stiffness @ held - omega**2 * supports.masses @ held
        forces = np.zeros_like(motions)
        np.subtract.at(forces, there, size * pull)
        scaled = {index: size * u for index, u in vectors.items()}
        states.append(State(scaled, forces, size * motions, omega**2))
    each = -1 / (8 * np.pi**2 * mode.frequency_hz) / len(states)
    return Form(tuple((one, one) for one in states), each)


def of_bodies(form: Form, low: Body, high: Body) -> float:
    """Change of a number from one body to another with the same unknowns, at the states of one
    between.

    Raises
    ------
    SolidgearError
        If the mesh changes.
    """
    total = 0.0
    for a, b in form.pairs:
        for index in a.vectors.keys() & b.vectors.keys():
            one, two = low.block(index), high.block(index)
            u, v = a.vectors[index], b.vectors[index]
            if not one.size == two.size == len(u):
                raise SolidgearError("the mesh changes with it")
            total -= u @ (two.stiffness @ v - one.stiffness @ v)
            if a.eigenvalue:
                total += a.eigenvalue * (u @ (two.mass @ v - one.mass @ v))
            if one.components:
                rows = low.rows(one)
                total += a.forces[rows] @ (two.ports @ v - one.ports @ v)
                total += b.forces[rows] @ (two.ports @ u - one.ports @ u)
    return form.scale * float(total)


def of_supports(form: Form, there: np.ndarray, low: Supports, high: Supports) -> float:
    """Change of a number from springs and masses to others, on ports at the rows `there`."""
    stiff, heavy = high.stiffness - low.stiffness, high.masses - low.masses
    total = 0.0
    for a, b in form.pairs:
        total -= a.motions[there] @ (stiff - a.eigenvalue * heavy) @ b.motions[there]
    return form.scale * float(total)


def _loaded(body: Body, supports: Supports, here: np.ndarray, load: Sequence[float]) -> State:
    """State under a load on a port: forces of bearings and the rigid motion from equilibrium."""
    flex, there, root = flexibility(body), supports.rows(body), supports.root
    forces = np.zeros(6 * len(body.ports))
    forces[here] = load
    rigid, r = body.rigid_ports, root.shape[1]
    reach = root.T @ rigid[there]
    system = np.zeros((r + 6, r + 6))
    system[:r, :r] = np.eye(r) + root.T @ flex.matrix[np.ix_(there, there)] @ root
    system[:r, r:], system[r:, :r] = -reach, reach.T
    right = np.concatenate([root.T @ (flex.matrix @ forces)[there], rigid.T @ forces])
    # both sides brought to size one; a free rotation is a column of zeros and stays still
    size = np.concatenate([1 / np.sqrt(np.diag(system)[:r]), np.ones(6)])
    column = np.abs(system[:r, r:] * size[:r, None]).max(axis=0)
    size[r:] = 1 / np.where(column > 0, column, 1.0)
    solved = size * np.linalg.lstsq(system * np.outer(size, size), size * right, rcond=1e-13)[0]
    np.subtract.at(forces, there, root @ solved[:r])
    motions = flex.matrix @ forces + rigid @ solved[r:]
    vectors = {}
    for index, block in enumerate(body.blocks):
        own = list(block.components)
        original, signs = block.mirror or (index, (1.0,) * len(own))
        pushed = np.tile(signs, len(body.ports)) * forces[body.rows(block)]
        u = block.rigid @ solved[r:][own]
        if block.size > len(own):  # else all of it is rigid, and what bends is rounding
            u = u + flex.fields[original] @ pushed
        if u.any():
            vectors[index] = u
    return State(vectors, forces, motions)
