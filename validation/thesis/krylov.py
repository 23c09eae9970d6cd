"""Exact Euler-Bernoulli bending of a stepped shaft on point springs with lumped masses.

The initial-parameter method with Krylov-Duncan functions, arranged so that it neither overflows nor
loses roots. Spans are cut into pieces short enough (``k l <= 2``) that the functions stay of order
one, and the two solutions that meet the conditions at the left end are made orthonormal after every
piece, so that the growing exponential cannot drown one. Roots are counted (Wittrick and Williams
1971, Q. J. Mech. Appl. Math. 24, 263): below a frequency lie as many modes as the dynamic
stiffness, eliminated joint by joint, has negative pivots; clamped roots of a piece begin at ``k l =
4.73`` only. That stiffness is never formed: its entries grow like ``E I / l^3`` and would spend the
digits of the lowest modes on the shortest span, whereas the transfer over a short piece is merely
close to one.

There is no shear, and no rotary inertia but that of lumped parts: that is the model of the thesis,
and either would bring a second length into the functions. Nothing is shared with the finite
elements, which makes agreement with them worth having.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from solidgear.core.errors import SolidgearError

#: greatest ``k l`` of a piece: below the first clamped root, 4.730, and a growth by exp(2) at most
#: between orthonormalisations
_REACH = 2.0
#: series of the Krylov-Duncan functions in ``(k l)^4``; at ``k l = 2`` the first term left out is
#: below 1e-20
_POWERS = 4 * np.arange(7) + np.arange(4)[:, None]
_SERIES = np.vectorize(lambda power: 1 / np.prod(np.arange(1.0, power + 1)))(_POWERS)
#: Gauss points of a piece of a cone
_GAUSS = np.polynomial.legendre.leggauss(12)


@dataclass(frozen=True)
class Span:
    """A uniform length of shaft.

    Attributes
    ----------
    length : float
        m.
    bending_stiffness : float
        E I, N m^2.
    mass_per_length : float
        kg/m.
    """

    length: float
    bending_stiffness: float
    mass_per_length: float


@dataclass(frozen=True, eq=False)
class Station:
    """A point spring to ground and a lumped mass.

    Attributes
    ----------
    y : float
        m, from the left end of the first span.
    spring : (2, 2) ndarray
        On (z, thx), in N/m, N/rad and N m/rad, symmetric positive semidefinite.
    mass : float
        kg.
    inertia : float
        About the x axis through the station, kg m^2.
    """

    y: float
    spring: np.ndarray = field(default_factory=lambda: np.zeros((2, 2)))
    mass: float = 0.0
    inertia: float = 0.0


@dataclass(frozen=True, eq=False)
class KrylovModes:
    """Bending modes, lowest first.

    Attributes
    ----------
    frequency_hz : (n,) ndarray
    rigid : int
        How many of them are rigid motions, of frequency zero.
    counts : (n, 2) ndarray of int
        Modes counted below ``(1 - 1e-8) f`` and ``(1 + 1e-8) f``: none is missing up to mode k,
        from zero, when ``counts[k, 0] <= k < counts[k, 1]``. For rigid motions: 0 and their number,
        by the rank of the springs.
    """

    frequency_hz: np.ndarray
    rigid: int
    counts: np.ndarray


def krylov(
    spans: Sequence[Span],
    stations: Iterable[Station] = (),
    n: int | None = 4,
    *,
    max_frequency: float | None = None,
) -> KrylovModes:
    """Exact bending modes of a stepped shaft.

    Parameters
    ----------
    spans : sequence of Span
        End to end from y = 0.
    stations : iterable of Station
        In any order; those at one place add up.
    n : int or None
        How many modes, rigid ones included; None is all below `max_frequency`.
    max_frequency : float, optional
        Hz; modes from here on are left out.

    Examples
    --------
    A free uniform beam, ``k L = 4.730041`` (Hua 2010 uses the same functions):

    >>> found = krylov([Span(length=1.0, bending_stiffness=1.0, mass_per_length=1.0)], n=3)
    >>> found.rigid, round(float(np.sqrt(2 * np.pi * found.frequency_hz[2])), 6)
    (2, 4.730041)
    """
    shaft = _joined(tuple(spans), tuple(stations))
    free = shaft.rigid()
    rigid = min(free, n or 2)
    top = 2 * np.pi * (max_frequency or np.inf)
    omega = np.append(np.zeros(rigid), shaft.roots(rigid, n, top))
    around = omega[:, None] * (1 + np.array([-1e-8, 1e-8]))
    counts = shaft.count(around.ravel()).reshape(-1, 2)
    counts[:rigid] = 0, free
    return KrylovModes(omega / (2 * np.pi), rigid, counts)


def from_scene(scene, *, pieces: int = 1) -> tuple[tuple[Span, ...], tuple[Station, ...]]:
    """Spans and stations of a scene, for bending in the plane of z.

    Cones become cylinders with the mean mass and the mean ``1 / (E I)`` of their pieces, so that
    mass, and the turn under a uniform moment, are exact; the error falls with the square of
    `pieces`.  Couplings of a bearing between this plane and the rest are left out.  A held end is a
    spring as stiff as on every other model.

    Parameters
    ----------
    scene : Scene
    pieces : int
        Number of cylinders to a cone.

    Raises
    ------
    SolidgearError
        For masses off their stations, a housing around the bearings, or a shaft that is not of
        plain segments: nothing of them fits into the model.
    """
    _refuse_what_is_left_out(scene)
    spans = []
    for segment in scene.segments:
        tapered = (segment.outer0, segment.inner0) != (segment.outer1, segment.inner1)
        count = pieces if tapered else 1
        t = (np.arange(count)[:, None] + (_GAUSS[0] + 1) / 2) / count
        outer = segment.outer0 + t * (segment.outer1 - segment.outer0)
        inner = segment.inner0 + t * (segment.inner1 - segment.inner0)
        second = 1 / ((4 / np.pi / (outer**4 - inner**4)) @ _GAUSS[1] / 2)
        area = np.pi * (outer**2 - inner**2) @ _GAUSS[1] / 2
        of = segment.material
        spans += [
            Span(segment.length / count, of.E * float(i), of.density * float(a))
            for i, a in zip(second, area)
        ]
    places = {station.name: station.y for station in (*scene.ports, *scene.bearings)}
    return tuple(spans), (
        *(Station(port.y) for port in scene.ports),
        *(Station(b.y, b.stiffness[2:4, 2:4]) for b in scene.bearings),
        *(
            Station(places.get(m.station, m.y), mass=m.mass, inertia=m.inertia[0])
            for m in scene.masses
        ),
    )


def _refuse_what_is_left_out(scene) -> None:
    """One sentence where a scene has what is neither a span nor a station."""
    lacking = {
        "features": scene.features,
        "fillets or chamfers": scene.blends,
        "a part from a file": scene.body,
        "a housing around its bearings": scene.housing,
        "masses with an offset from their stations": [m for m in scene.masses if any(m.offset)],
    }
    found = [name for name, there in lacking.items() if there]
    if found:
        raise SolidgearError(
            f"krylov: the scene {scene.name} has {' and '.join(found)}, and this model is of plain "
            "segments, springs and centred masses; ask another model"
        )


def krylov_duncan(kl):
    """Krylov-Duncan functions S, T, U, V of ``k l``, ``k^4 = m w^2 / (E I)``: ``(cosh + cos) / 2,
    (sinh + sin) / 2, (cosh - cos) / 2, (sinh - sin) / 2``.

    Small arguments cost V its digits, and a determinant loses ``eps exp(kl) / kl`` to large ones:
    :func:`krylov` meets neither.
    """
    ch, c, sh, s = np.cosh(kl), np.cos(kl), np.sinh(kl), np.sin(kl)
    return (ch + c) / 2, (sh + s) / 2, (ch - c) / 2, (sh - s) / 2


def _transfer(s, stiff, force):
    """(4, 4, ...) transfer of (z, phi, Q, M) over a length `s` of E I `stiff`, N m^2, under a
    `force` ``m w^2``, N/m^2.
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


def _transferred(t, b):
    """Solutions `b` (4, ...) at the far end of a transfer `t` (4, 4, ...)."""
    return (t * b[None]).sum(axis=1)


class _Joint:
    """Springs and masses at one place, the springs as ``L D L'`` with the stiffer direction `p`
    first; `up` is ``L'``.

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


def _joined(spans: Sequence[Span], stations: Sequence[Station]) -> _Shaft:
    """The shaft with a joint at the ends of every span and at every station."""
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
            t = _transfer(
                (self.y[i + 1] - self.y[i]) / parts, self.stiff[i], self.heavy[i] * omega**2
            )
            # Forces at the left of the piece that move its right end by one; the determinant of
            # `reach` is positive in a piece.
            reach = np.array([[t[1, 3], -t[0, 3]], [-t[1, 2], t[0, 2]]])
            for _ in range(parts):
                new = _transferred(t[:, :, None], b)
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
