"""Joints and spans of an exact Euler-Bernoulli shaft: its roots and its shapes.

Spans are cut into pieces short enough (``k l <= 2``) that the Krylov-Duncan functions stay of order
one, and the two solutions that meet the conditions at the left end are made orthonormal after every
piece, so that the growing exponential cannot drown one. Roots are counted (Wittrick and Williams
1971, Q. J. Mech. Appl. Math. 24, 263): below a frequency lie as many modes as the dynamic
stiffness, eliminated joint by joint, has negative pivots; clamped roots of a piece begin at ``k l =
4.73`` only. That stiffness is never formed: its entries grow like ``E I / l^3`` and would spend the
digits of the lowest modes on the shortest span, whereas the transfer over a short piece is merely
close to one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from solidgear.errors import SolidgearError

if TYPE_CHECKING:
    from validation.thesis.krylov import Station

#: greatest ``k l`` of a piece: below the first clamped root, 4.730, and a growth by exp(2) at most
#: between orthonormalisations
_REACH = 2.0
#: series of the Krylov-Duncan functions in ``(k l)^4``; at ``k l = 2`` the first term left out is
#: below 1e-20
_POWERS = 4 * np.arange(7) + np.arange(4)[:, None]
_SERIES = np.vectorize(lambda power: 1 / np.prod(np.arange(1.0, power + 1)))(_POWERS)
#: Gauss points of a piece: products of two shapes are integrated to rounding
GAUSS = np.polynomial.legendre.leggauss(12)
#: of the six numbers of a joint, those that start the piece beyond it
AFTER = [0, 1, 4, 5]


def krylov_duncan(kl):
    """Krylov-Duncan functions S, T, U, V: ``(cosh + cos) / 2, (sinh + sin) / 2, (cosh - cos) / 2,
    (sinh - sin) / 2``.

    Small arguments cost V its digits, and a determinant loses ``eps exp(kl) / kl`` to large ones:
    :func:`~validation.thesis.krylov.krylov` meets neither.

    Parameters
    ----------
    kl : float or ndarray
        ``k l`` with ``k^4 = m w^2 / (E I)``.

    Returns
    -------
    tuple of ndarray

    Examples
    --------
    >>> [float(value) for value in krylov_duncan(0.0)]
    [1.0, 0.0, 0.0, 0.0]
    """
    ch, c, sh, s = np.cosh(kl), np.cos(kl), np.sinh(kl), np.sin(kl)
    return (ch + c) / 2, (sh + s) / 2, (ch - c) / 2, (sh - s) / 2


def transfer(s, stiff, force):
    """Transfer of (z, phi, Q, M) over a uniform length.

    Parameters
    ----------
    s : float or ndarray
        Length, m.
    stiff : float or ndarray
        E I, N m^2.
    force : float or ndarray
        ``m w^2``, N/m^2: ``k^4`` times `stiff`.

    Returns
    -------
    (4, 4, ...) ndarray

    Examples
    --------
    At rest a tilt of 1 lifts the far end by the length:

    >>> transfer(2.0, 1.0, 0.0)[0]
    array([ 1.        ,  2.        , -1.33333333,  2.        ])
    """
    k4 = force / stiff
    # All terms of the series are positive: nothing cancels, and w = 0 is no special case.
    c0, c1, c2, c3 = (
        s**j * np.polynomial.polynomial.polyval(k4 * s**4, _SERIES[j]) for j in range(4)
    )
    rows = [c0, c1, -c3 / stiff, c2 / stiff], [k4 * c3, c0, -c2 / stiff, c1 / stiff]
    return np.array(
        [*rows, [-force * c1, -force * c2, c0, -k4 * c3], [force * c2, force * c3, -c1, c0]]
    )


def transferred(t, b):
    """Solutions `b` (4, ...) at the far end of a transfer `t` (4, 4, ...)."""
    return (t * b[None]).sum(axis=1)


class _Joint:
    """Springs and masses at one place, the springs as ``L D L'`` with the stiffer direction `p`
    first; `down` is ``L^-1``, `up` is ``L'``.

    A clamp of 1e20 N/m must not wash out a soft spring across it: factored, each acts with its own
    digits.
    """

    def __init__(self, stations, length):
        k = sum((s.spring for s in stations), np.zeros((2, 2)))
        self.mass = np.array(
            [sum(s.mass for s in stations), sum(s.inertia for s in stations)], float
        )
        p, q = (0, 1) if k[0, 0] * length**2 >= k[1, 1] else (1, 0)
        self.p = p
        self.ell = k[p, q] / k[p, p] if k[p, p] else 0.0
        soft = k[q, q] - self.ell * k[p, q]
        # What is left of a spring of rank one is rounding.
        self.d = np.array([k[p, p], soft if soft > 1e-12 * k[q, q] else 0.0])
        self.down = np.array([[1.0, 0.0], [-self.ell, 1.0]])[:, [p, q]]
        self.up = np.array([[1.0, self.ell], [0.0, 1.0]])[:, [p, q]]

    def act(self, b, omega):
        """The solutions `b` (4, 2, ...) just beyond the joint."""
        p, q = self.p, 1 - self.p
        if self.d.any():
            # One solution is turned so that it does not move the stiffer direction at all:
            # it then feels nothing of that spring, instead of a difference of huge forces.
            y = b[p] + self.ell * b[q]
            size = np.hypot(y[0], y[1])
            angle = np.arctan2(y[1], y[0])
            c, s = np.cos(angle), np.sin(angle)
            b = np.stack([c * b[:, 0] + s * b[:, 1], c * b[:, 1] - s * b[:, 0]], axis=1)
            b[p, 1] = -self.ell * b[q, 1]
            b[2 + p, 0] += self.d[0] * size
            b[2 + q, 0] += self.ell * (self.d[0] * size)
            b[2 + q] += self.d[1] * b[q]
        return np.concatenate([b[:2], b[2:] - self.mass[:, None, None] * omega**2 * b[:2]])


def joined_shaft(spans, stations):
    """The shaft with a joint at the ends of every span and at every station.

    Parameters
    ----------
    spans : sequence of Span
    stations : sequence of Station

    Returns
    -------
    _Shaft

    Raises
    ------
    SolidgearError
        For a station off the shaft.
    """
    ends = np.append(0.0, np.cumsum([s.length for s in spans]))
    length, near, marks = ends[-1], 1e-9 * ends[-1], list(ends)
    held: list[list[Station]] = [[] for _ in ends]
    for station in stations:
        if not -near <= station.y <= length + near:
            raise SolidgearError(
                f"krylov: the station at y = {station.y:g} m is outside the shaft, "
                f"0 to {length:g} m"
            )
        at = int(np.argmin(abs(np.array(marks) - station.y)))
        if abs(marks[at] - station.y) > near:  # nearer than that, it is meant to be at the mark
            at = int(np.searchsorted(marks, station.y))
            marks.insert(at, station.y)
            held.insert(at, [])
        held[at].append(station)
    y = np.array(marks)
    owner = np.clip(np.searchsorted(ends, (y[1:] + y[:-1]) / 2) - 1, 0, len(spans) - 1)
    stiff, heavy = np.array(
        [(spans[i].bending_stiffness, spans[i].mass_per_length) for i in owner], float
    ).T
    return _Shaft(y, stiff, heavy, [_Joint(h, length) for h in held])


@dataclass
class _Shaft:
    """Joints and the uniform spans between them."""

    y: np.ndarray
    stiff: np.ndarray
    heavy: np.ndarray
    joints: list

    def rigid(self):
        """Number of rigid motions that no spring resists; by rank, not by a small frequency."""
        motions = [np.array([[1.0, y / self.y[-1]], [0.0, 1 / self.y[-1]]]) for y in self.y]
        held = [(joint.up @ r)[joint.d > 0] for joint, r in zip(self.joints, motions)]
        rows = np.vstack([np.zeros((1, 2)), *held])
        # how stiff a spring is does not matter
        rows /= np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1e-300)
        return 2 - int(np.linalg.matrix_rank(rows, tol=1e-9))

    def weights(self, span, omega):
        """(4, ...) factors that bring (z, phi, Q, M) of a span to one unit, that of its wave."""
        stiff = self.stiff[span]
        k = np.maximum((self.heavy[span] * omega**2 / stiff) ** 0.25, 1 / self.y[-1])
        return np.stack([k, np.ones_like(k), 1 / (stiff * k**2), 1 / (stiff * k)])

    def parts(self, omega):
        """Number of pieces of every span, for frequencies up to `omega`."""
        kl = (self.heavy * omega**2 / self.stiff) ** 0.25 * np.diff(self.y)
        return np.maximum(1, np.ceil(kl / _REACH)).astype(int)

    def count(self, omega):
        """Number of modes below each frequency (rad/s, 1-d)."""
        total, sign = np.zeros(len(omega), int), np.ones(len(omega))
        # the left end is free until its joint acts
        b = np.eye(4, 2)[:, :, None] + np.zeros(len(omega))
        for i, parts in enumerate(self.parts(omega.max(initial=0.0))):
            w = self.weights(i, omega)
            b = _orthonormal(self.joints[i].act(b, omega), w)
            t = transfer(
                (self.y[i + 1] - self.y[i]) / parts, self.stiff[i], self.heavy[i] * omega**2
            )
            # Forces at the left of the piece that move its right end by one; the determinant of
            # `reach` is positive in a piece.
            reach = np.array([[t[1, 3], -t[0, 3]], [-t[1, 2], t[0, 2]]])
            for _ in range(parts):
                new = transferred(t[:, :, None], b)
                # Pivot of the joint left of the piece: (forces of the left part + forces of the
                # piece, far end clamped) per motion.
                ahead = (reach[:, :, None] * new[None, :2]).sum(axis=1)
                negative, sign = _negative(ahead, b, w, sign)
                total += negative
                b = _orthonormal(new, w)
        b = self.joints[-1].act(b, omega)
        return total + _negative(b[2:], b, w, sign)[0]

    def roots(self, first, last, top):
        """Frequencies (rad/s) from number `first` to before `last` (None is all) below `top`, by
        bisection of the count.
        """
        high = top
        if last is not None:
            high = min(top, np.sqrt(self.stiff.mean() / self.heavy.mean()) / self.y[-1] ** 2)
        below = self.count(np.array([high]))[0]
        while below < (last or 0) and high < top:
            high = min(4 * high, top)
            below = self.count(np.array([high]))[0]
        order = np.arange(first, min(below, last or below)) + 1
        lo, hi = np.zeros(len(order)), np.full(len(order), float(high))
        while True:
            wide = hi - lo > 8 * np.finfo(float).eps * hi
            if not wide.any():
                return (lo + hi) / 2
            # Five bits a step; the upper end is known to have been reached.
            grid = lo[wide, None] + (hi - lo)[wide, None] * np.arange(1, 32) / 32
            reached = self.count(grid.ravel()).reshape(grid.shape) >= order[wide, None]
            at = np.where(reached.any(axis=1), reached.argmax(axis=1), 31)
            marks, each = np.column_stack([lo[wide], grid, hi[wide]]), np.arange(len(at))
            lo[wide], hi[wide] = marks[each, at], marks[each, at + 1]

    def cut(self, omega):
        """The same shaft with a joint at the end of every piece."""
        parts, joints = self.parts(omega), self.joints[:1]
        for count, joint in zip(parts, self.joints[1:]):
            joints += [_Joint((), self.y[-1])] * (count - 1) + [joint]
        y = [
            np.linspace(a, b, count, endpoint=False)
            for a, b, count in zip(self.y, self.y[1:], parts)
        ]
        return _Shaft(
            np.append(np.concatenate(y), self.y[-1]),
            np.repeat(self.stiff, parts),
            np.repeat(self.heavy, parts),
            joints,
        )

    def solutions(self, omega, many):
        """Solutions of all joint equations at once (multiple shooting), by inverse iteration on the
        normal equations.

        A sweep from the left would lose a mode that lives elsewhere; here no end is preferred.
        """
        # Six unknowns a joint; from the third row on, its two equations and then the four of the
        # piece beyond it.
        nodes = len(self.y)
        block = np.zeros((nodes, 6, 12))
        for joint, b in zip(self.joints, block):
            # In the factors of the spring, so that a stiff row does not hide the soft one.
            b[:2, :2] = joint.down * joint.mass * omega**2 - joint.d[:, None] * joint.up
            b[:2, 2:6] = np.hstack([-joint.down, joint.down])
        block[:-1, 2:, AFTER] = -np.moveaxis(
            transfer(np.diff(self.y), self.stiff, self.heavy * omega**2), -1, 0
        )
        block[:-1, 2:, 6:10] = np.eye(4)
        block[-1, 2:4, 4:6] = np.eye(2)  # nothing pulls on the outer faces
        unit = self.weights(np.maximum(np.arange(nodes) - 1, 0), omega)[[0, 1, 2, 3, 2, 3]].T
        # the last joint has no neighbour, and no entry there
        block /= np.hstack([unit, np.roll(unit, -1, axis=0)])[:, None]
        block /= np.maximum(abs(block).max(axis=2, keepdims=True), 1e-300)
        i, row, column = np.nonzero(block)
        spots = np.append(6 * i + row + 2, [0, 1]), np.append(6 * i + column, [2, 3])
        a = sp.csc_matrix((np.append(block[i, row, column], [1.0, 1.0]), spots))
        v = np.random.default_rng(0).standard_normal((6 * nodes, many))
        try:
            lu = splu(a)
        except RuntimeError:
            # singular to the last bit: a step of a few bits away the solutions are the same
            lu = splu(sp.csc_matrix(a + 1e-15 * sp.identity(6 * nodes)))
        for _ in range(4):
            v = np.linalg.qr(lu.solve(v, trans="T"))[0]
            v = np.linalg.qr(lu.solve(v))[0]
        return (v / unit.reshape(-1, 1)).T.reshape(many, nodes, 6), abs(a @ v).max(axis=0)

    def shapes(self, omega):
        """(n, j, 6) motions, and forces before and after, at the joints, for unit modal mass; their
        defect; and the shares of the mass.
        """
        states = np.zeros((len(omega), len(self.y), 6))
        defect, distributed, lumped = np.zeros((3, len(omega)))
        # Frequencies nearer than this are one, with as many solutions.
        for g in _groups(omega, 1e-10):
            states[g], defect[g] = self.solutions(omega[g].mean(), len(g))
        size, stiff, heavy = np.diff(self.y)[:, None], self.stiff[:, None], self.heavy[:, None]
        inside, weight = size * (GAUSS[0] + 1) / 2, (heavy * size * GAUSS[1] / 2).ravel()
        start = np.moveaxis(states[:, :-1][:, :, AFTER], 2, 0)[..., None]
        inner_states = [
            transferred(transfer(inside, stiff, heavy * w**2), start[:, k])
            for k, w in enumerate(omega)
        ]
        z = np.array([state[0].ravel() for state in inner_states])
        mass = np.array([j.mass for j in self.joints]).ravel()
        for g in _groups(omega, 1e-4):
            moved = states[g, :, :2].reshape(len(g), -1)
            spread, points = (z[g] * weight) @ z[g].T, (moved * mass) @ moved.T
            # Solutions of frequencies this close are separated to fewer digits.
            mix = np.linalg.inv(np.linalg.cholesky(spread + points))
            states[g] = np.tensordot(mix, states[g], 1)
            distributed[g], lumped[g] = np.diag(mix @ spread @ mix.T), np.diag(mix @ points @ mix.T)
        return states, defect, distributed, lumped


def _groups(omega, gap):
    """Indices of ascending frequencies, split where neighbours differ by more than `gap`,
    relatively.
    """
    breaks = np.flatnonzero(np.diff(omega) > gap * omega[1:]) + 1
    return [group for group in np.split(np.arange(len(omega)), breaks) if len(group)]


def _negative(force, b, w, sign):
    """Negative eigenvalues of the pivot ``force motion^-1``; and the sign of ``det force``, which
    is that of the next ``det motion``.

    A determinant that is zero to rounding has some sign here and the same in the next pivot: taken
    over instead of computed twice, it cannot make a mode appear in both or in neither.
    """
    now = np.where(force[0, 0] * force[1, 1] < force[0, 1] * force[1, 0], -1.0, 1.0)
    # The trace is enough: with the sign of the determinant it separates 0, 1 and 2.
    first = force[0, 0] * b[1, 1] - force[0, 1] * b[1, 0]
    second = force[1, 1] * b[0, 0] - force[1, 0] * b[0, 1]
    both_or_none = np.where(sign * (first + w[0] ** 2 * second) < 0, 2, 0)
    return np.where(now * sign < 0, 1, both_or_none), now


def _orthonormal(b, w):
    """The same two solutions, orthonormal in the unit `w`, by column operations of positive
    determinant.
    """
    first = b[:, 0] / np.sqrt(((w * b[:, 0]) ** 2).sum(axis=0))
    second = b[:, 1] - (w**2 * first * b[:, 1]).sum(axis=0) * first
    return np.stack([first, second / np.sqrt(((w * second) ** 2).sum(axis=0))], axis=1)
