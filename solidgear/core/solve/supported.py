"""A body with its bearings and the masses on its ports, as linear operators on the blocks that
belong together.

The factor of the free body does all the work; bearings and masses enter by the Woodbury identity.
With J the root of the masses, ``K + sigma (M + J J')`` is the factored matrix and an addition of low
rank, and so is the mass itself: nothing is factored again.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
import scipy.linalg as sla

from solidgear.core.body import Body, Supports, component_rows
from solidgear.core.solve.inertia_relief import elastic_fields
from solidgear.core.solve.shifted import SHIFT, factors
from solidgear.core.springs import root_of

# The motion of a seat that comes out below this part of the largest one has no digits left that
# matter.
ROUNDED = 1e-12
# Relative error of an inverse from which on it is refined.
REFINED = 1e-7
EPS = float(np.finfo(float).eps)
# N/m or N m/rad above which a spring stands for a constraint.
FAST = 1e18


class Supported:
    """Operators of a group of blocks on bearings of stiffness `spring` (6 m, 6 m), perhaps without
    negligible couplings (:func:`solidgear.core.solve.coupling.decoupled`); `group` holds the indices of
    the blocks (:func:`solidgear.core.solve.coupling.groups`).
    """

    def __init__(self, body: Body, supports: Supports, spring: np.ndarray, group: list[int]):
        self.group = group
        self.blocks = [body.blocks[b] for b in group]
        self._factors = [factors(body)[b] for b in group]
        self._cuts = np.cumsum([0] + [b.size for b in self.blocks])
        self.size = int(self._cuts[-1])
        #: lowest elastic eigenvalue of the free body, roughly, rad^2/s^2
        self.scale = body.scale
        #: the operator inverted is ``K + springs + shift M``, rad^2/s^2
        self.shift = SHIFT * body.scale
        self._place, self._seats = self._on_seats(body, supports)
        self._spring = self._on_group(spring)
        #: (n, q) root of the mass that moves with the ports, ``heavy @ heavy.T``
        self.heavy = np.zeros((self.size, 0))
        self._mass_update: _MassUpdate | None = None
        masses = self._root_on_ports(supports.masses)
        if masses.shape[1]:
            self._mass_update = _MassUpdate(self, masses)
            self.heavy = masses
        #: (n, r) mass-orthonormal rigid motions, resisted or not
        self.rigid = self.orthonormal_rigid()
        self.mass_rigid = self.mass(self.rigid)
        null = supports.unresisted(body)
        #: (n, k) mass-orthonormal rigid motions that no spring resists, taken out of every inverse
        self.free = np.vstack(
            [
                b.rigid @ null[list(b.components)]
                if b.components
                else np.zeros((b.size, null.shape[1]))
                for b in self.blocks
            ]
        )
        self.free = self.free[:, np.abs(self.free).max(axis=0, initial=0.0) > 0]
        if self.free.shape[1]:
            w, v = np.linalg.eigh(self.free.T @ self.mass(self.free))
            keep = w > 1e-10 * w.max()
            self.free = self.free @ (v[:, keep] / np.sqrt(w[keep]))
        self._mass_free = self.mass(self.free) if self.free.shape[1] else self.free
        #: (n, r) root of the stiffness of the springs, ``load @ load.T``
        self.load = self._root_on_ports(spring)
        #: (r,) springs that stand for constraints
        self._held = np.zeros(self.load.shape[1], bool)
        self._fast = False
        if self.load.shape[1]:
            stiffness = (root_of(self._on_group(spring)) ** 2).sum(axis=0)
            self._held = stiffness > FAST
            self._fast = np.abs(spring).max() > FAST
            self._through = self._free_inverse(self.load)
            self._inner = _solver(np.eye(self.load.shape[1]) + self.load.T @ self._through)

    def _on_seats(self, body, supports) -> tuple[np.ndarray, list]:
        """Return the places of the components of the group in a vector of six per port, and for every
        block the rows of those ports.
        """
        m = len(supports.ports)
        components = [list(b.components) for b in self.blocks]
        place = np.concatenate([component_rows(range(m), cs) for cs in components])
        if not place.size:
            return place, []
        wanted = supports.attachments or (None,) * m
        index = [body.port_index(name, a) for name, a in zip(supports.ports, wanted)]
        seats = []
        for block, cs in zip(self.blocks, components):
            rows = np.array([len(cs) * p + i for p in index for i in range(len(cs))], int)
            seats.append(block.ports[rows])
        return place, seats

    def _on_group(self, matrix: np.ndarray) -> np.ndarray:
        """Return a matrix of the ports on the components of the group."""
        return matrix[np.ix_(self._place, self._place)]

    def _root_on_ports(self, matrix: np.ndarray) -> np.ndarray:
        """Return the (n, r) root of a matrix of the ports, in the unknowns of the group."""
        if not self._seats:
            return np.zeros((self.size, 0))
        root = root_of(self._on_group(matrix))
        cuts = np.cumsum([0] + [seat.shape[0] for seat in self._seats])
        return np.vstack([seat.T @ root[a:b] for seat, a, b in zip(self._seats, cuts, cuts[1:])])

    def spring_rounding(self, u: np.ndarray) -> np.ndarray:
        """Return the (k,) energy of (n, k) shapes that the last digit of the stiffness entries of
        the springs stands for, N m.

        A coupled bearing may be far softer in one direction than any entry of the stiffness: the
        resistance there is a difference of large numbers.
        """
        if not self._seats:
            return np.zeros(u.shape[1])
        motions = [seats @ part for seats, part in zip(self._seats, self.parts(u))]
        motion = np.abs(np.vstack(motions))
        # as large a multiple as condensing springs in series and taking the root of the matrix may
        # make of it
        return 8 * EPS * np.einsum("ik,ij,jk->k", motion, np.abs(self._spring), motion)

    @property
    def backend(self) -> str:
        """Back ends of the factors, joined by ``+``."""
        return "+".join(sorted({f.backend for f in self._factors}))

    def on_ranks(self, wanted: int, tolerance: float) -> tuple[np.ndarray, np.ndarray] | None:
        """Find the lowest eigenpairs of ``K + springs + shift M`` by the engine that holds the
        factor; None where there is none, or where it lacks a part of the group or masses on ports.
        """
        ranks = self._factors[0].ranks
        if ranks is None or len(self.blocks) > 1 or self.heavy.shape[1]:
            return None
        inner = np.zeros((0, 0))
        through = self.load
        if self.load.shape[1]:
            through = self._through
            inner = np.eye(self.load.shape[1]) + self.load.T @ through
        return ranks.modes(wanted, self.load, through, inner, self.free, tolerance)

    def parts(self, x: np.ndarray) -> list[np.ndarray]:
        """Return the rows of (n, ...) ``x``, block by block."""
        return [x[a:b] for a, b in zip(self._cuts, self._cuts[1:])]

    def _per_block(self, f: Callable[[int, np.ndarray], np.ndarray], x: np.ndarray) -> np.ndarray:
        # one block is the common case, and large vectors are not copied for it
        if len(self.blocks) == 1:
            return f(0, x)
        return np.concatenate([f(i, part) for i, part in enumerate(self.parts(x))])

    def _free_inverse(self, x: np.ndarray) -> np.ndarray:
        """Return ``(K + shift M)^-1 x``.

        Rigid motions answer with 1 / shift exactly, and the factor, which would round that, is
        applied to the rest only.
        """
        carried = self.rigid.T @ x
        balanced = x - self.mass_rigid @ carried
        y = (
            self.factored(balanced)
            if self._mass_update is None
            else self._mass_update.inverse(balanced)
        )
        return self.without_rigid(y) + self.rigid @ (carried / self.shift)

    def factored(self, x: np.ndarray) -> np.ndarray:
        """Solve by the factors of the blocks, without masses on ports."""
        return self._per_block(lambda i, part: self._factors[i].solve(part), x)

    def without_rigid(self, u: np.ndarray) -> np.ndarray:
        """Return (n, k) displacements less their rigid part in the mass norm."""
        return u - self.rigid @ (self.mass_rigid.T @ u)

    def mass(self, x: np.ndarray) -> np.ndarray:
        """Return ``M x`` of (n, k) displacements, masses on ports included."""
        of_blocks = self._per_block(lambda i, part: self.blocks[i].mass @ part, x)
        return of_blocks + self.heavy @ (self.heavy.T @ x) if self.heavy.shape[1] else of_blocks

    def elastic(self, x: np.ndarray) -> np.ndarray:
        """Return ``K x`` of the free body, of (n, k) displacements."""
        return self._per_block(lambda i, part: self.blocks[i].stiffness @ part, x)

    def elastic_extended(self, x: np.ndarray) -> np.ndarray:
        """Return ``K x`` in extended precision, for shapes whose energy is small beside the terms
        of it.
        """
        return self._per_block(
            lambda i, part: (
                self.blocks[i].stiffness.astype(np.longdouble) @ part.astype(np.longdouble)
            ),
            x,
        )

    def purge(self, x: np.ndarray) -> np.ndarray:
        """Return (n, k) displacements without unresisted rigid motions."""
        return x - self.free @ (self._mass_free.T @ x) if self.free.shape[1] else x

    def inverse(self, x: np.ndarray) -> np.ndarray:
        """Return displacements ``(K + springs + shift M)^-1 x`` under (n, k) loads, without
        unresisted rigid motions.
        """
        y = self._quick_inverse(x)
        if self.inaccuracy <= REFINED:
            return y
        return y + self._quick_inverse(x - self.forward(y, self._reaction(x)))

    def _reaction(self, x: np.ndarray) -> np.ndarray | None:
        """Return the (r, k) stretch of springs that stand for constraints, from the loads; None
        where the motions give a better one.
        """
        if not self._fast:
            return None
        return self._inner(self._through.T @ self._without_free(x))

    def forward(self, u: np.ndarray, stretch: np.ndarray | None = None) -> np.ndarray:
        """Return ``(K + springs + shift M) u`` of (n, k) displacements; the rigid part, which K
        resists by rounding only, is kept from it. The (r, k) stretch of the springs may be known
        better than from ``u``.
        """
        return (
            self.elastic(self.without_rigid(u))
            + self.load @ (self.load.T @ u if stretch is None else stretch)
            + self.shift * self.mass(u)
        )

    @cached_property
    def inaccuracy(self) -> float:
        """Relative error of the inverse in its own norm, measured by the change of one step of
        refinement, on loads of random masses and springs.
        """
        if EPS * self.highest < REFINED * self.shift:
            return 0.0  # no rounding could be seen
        rng = np.random.default_rng(0)
        x = self.mass(rng.standard_normal((self.size, 1)))
        if self.load.shape[1]:
            x = np.hstack([x, self.load @ rng.standard_normal((self.load.shape[1], 1))])
        x = x - self._mass_free @ (self.free.T @ x)
        y = self._quick_inverse(x)
        stretch = self._reaction(x)
        if stretch is None:
            stretch = self.load.T @ y
        pull = self.forward(y, np.zeros_like(stretch))
        residual = x - pull - self.load @ stretch
        changed = np.abs(np.einsum("ij,ij->j", residual, self._quick_inverse(residual)))
        # the work of the loads, by the strain energy: a seat that is clamped does not move
        strained = np.einsum("ij,ij->j", y, pull) + np.einsum("ij,ij->j", stretch, stretch)
        return float(np.sqrt(changed / strained).max())

    def _without_free(self, x: np.ndarray) -> np.ndarray:
        """Return (n, k) loads less those that unresisted rigid motions carry."""
        return x - self._mass_free @ (self.free.T @ x) if self.free.shape[1] else x

    def _quick_inverse(self, x: np.ndarray) -> np.ndarray:
        x = self._without_free(x)
        y = self._free_inverse(x)
        if self.load.shape[1]:
            # A computed inverse is not quite symmetric, and neither is the matrix that it gives. A
            # seat comes to rest where y itself is held, by that matrix as it is: half of it, or
            # loads on the inverse, leave it 1e-10 of a motion, whose energy a clamp makes a part of
            # the frequency.
            y = y - self._through @ self._inner(self.load.T @ y)
        return self.purge(y)

    @cached_property
    def diagonal(self) -> np.ndarray:
        """(n,) diagonal of the stiffness of the free body."""
        return np.concatenate([b.stiffness.diagonal() for b in self.blocks])

    @cached_property
    def highest(self) -> float:
        """Highest eigenvalue of the free body, from below and within a factor of ten, rad^2/s^2."""
        stiff = self.diagonal
        heavy = np.concatenate([b.mass.diagonal() for b in self.blocks])
        return float((stiff[heavy > 0] / heavy[heavy > 0]).max())

    def stretch(self, u: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Return the (r, k) stretch ``L'u`` of the springs, the root of their energy, of (n, k)
        displacements under loads ``(K + springs + shift M) u``, roughly.

        Where the springs are so stiff that the motion of their seat is the rounding of ``u``, or stand
        for constraints, it comes from the load instead: in a soft body the seat is left with more than
        rounding, since it came to rest by the difference of two rigid motions.
        """
        out = self.load.T @ u
        if self.load.shape[1]:
            lost = self._held[:, None] | (np.abs(out) < ROUNDED * self.spread(u))
            if lost.any():
                out = np.where(lost, self._inner(self._through.T @ loads), out)
        return out

    def spread(self, u: np.ndarray) -> np.ndarray:
        """Return the (r, k) stretch of the springs by motions as large as the largest of each
        shape: the scale of the rounding of ``u``.

        The motion of a seat that is held fast is small, but it was computed beside large ones and
        carries their rounding.
        """
        return np.abs(self.load).sum(axis=0)[:, None] * np.abs(u).max(axis=0, initial=0.0)

    def rigid_motions(self) -> np.ndarray:
        """Return (n, r) rigid motions of the group, one column per component, resisted or not."""
        return sla.block_diag(*(b.rigid for b in self.blocks))

    def orthonormal_rigid(self) -> np.ndarray:
        """Return (n, r) rigid motions, mass-orthonormal."""
        rigid = self.rigid_motions()
        # A block of a body whose seats are all one rigid piece may move less than its components
        # say.
        for _ in range(2):
            size = np.sqrt(np.einsum("ij,ij->j", rigid, self.mass(rigid)))
            rigid = rigid[:, size > 0] / size[size > 0]
            w, v = np.linalg.eigh(rigid.T @ self.mass(rigid))
            keep = w > 1e-10
            rigid = rigid @ (v[:, keep] / np.sqrt(w[keep]))
        return rigid

    def split(self, x: np.ndarray) -> dict[int, np.ndarray]:
        """Return a vector (n,) of the group as block index -> vector."""
        return {b: x[a:c] for b, a, c in zip(self.group, self._cuts, self._cuts[1:])}

    def static(self, load: np.ndarray) -> np.ndarray:
        """Return (n, k) static displacements under loads, springs included; unresisted rigid
        motions must do no work on the loads.

        The elastic and the rigid part are found separately, as in :mod:`solidgear.core.solve.statics`,
        so that springs may be as soft or as stiff as they like. With ``s = load_b' u`` the root of
        the spring energy, E the inertia-relief fields and R the rigid motions, ``u = E_f - E_b s +
        R a`` and equilibrium ``R'(f - load_b s) = 0``.
        """
        rigid = self.rigid_motions()
        # Rotations are about 1/length of translations in size: equal columns keep the small systems
        # well scaled.
        rigid = rigid / np.linalg.norm(rigid, axis=0)
        e_f, e_b = self._relieved(load, rigid), self._relieved(self.load, rigid)
        resisted = self.load.T @ rigid
        inner = sla.cho_factor(np.eye(self.load.shape[1]) + self.load.T @ e_b)
        h = resisted.T @ sla.cho_solve(inner, resisted)
        stretch_by_loads = sla.cho_solve(inner, self.load.T @ e_f)
        # Unresisted motions make h singular; they get nothing.
        a = np.linalg.pinv(h, rcond=1e-13, hermitian=True) @ (
            rigid.T @ load - resisted.T @ stretch_by_loads
        )
        s = stretch_by_loads + sla.cho_solve(inner, resisted @ a)
        return self.purge(e_f - e_b @ s + rigid @ a)

    def _relieved(self, load, rigid, tolerance: float = 1e-24):
        """Return elastic displacements of the free body under loads balanced by inertia."""
        return elastic_fields(self._free_inverse, self.mass, self.elastic, rigid, load, tolerance)[
            1
        ]


def _solver(matrix: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Return the solution of systems with a small matrix, by LAPACK itself: scipy's checks of every
    call take as long as the factor of a coarse block.
    """
    lu, pivot = sla.lu_factor(matrix)
    return lambda right: sla.lapack.dgetrs(lu, pivot, right)[0].reshape(right.shape)


class _MassUpdate:
    """Inverse of ``K + shift (M + J J')`` of a free body with rigid masses J (n, q) on the ports, by
    the inverse of the body alone.
    """

    def __init__(self, supported: Supported, heavy: np.ndarray):
        self._supported, self._heavy = supported, heavy
        rigid = supported.orthonormal_rigid()
        mass_rigid = supported.mass(rigid)
        carried = rigid.T @ heavy
        # the shift times the motion under a unit load at a mass: rigid motions without rounding
        elastic = supported.factored(heavy - mass_rigid @ carried)
        elastic = elastic - rigid @ (mass_rigid.T @ elastic)
        self._through = supported.shift * elastic + rigid @ carried
        small = np.eye(heavy.shape[1]) + heavy.T @ self._through
        self._inner = sla.cho_factor((small + small.T) / 2)

    def inverse(self, x: np.ndarray) -> np.ndarray:
        """Return displacements under (n, k) loads that no rigid motion does work on."""
        y = self._supported.factored(x)
        return y - self._through @ sla.cho_solve(self._inner, self._heavy.T @ y)
