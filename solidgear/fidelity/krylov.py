"""Exact Euler-Bernoulli bending of a stepped shaft on point springs with lumped masses.

This is the initial-parameter method with Krylov-Duncan functions, arranged so that it neither overflows nor loses
roots.  Every span is cut into pieces short enough (``k l <= 2``) that the functions stay of order one, and the pair of
solutions that meets the conditions at the left end is made orthonormal after every piece, so that the growing
exponential never drowns the other solution.  Roots are not searched for but counted (Wittrick and Williams 1971,
Q. J. Mech. Appl. Math. 24, 263): the number of modes below a frequency is the number of negative pivots of the dynamic
stiffness, eliminated joint by joint, plus the clamped roots of the pieces, of which there are none below ``k l = 4.73``.

The dynamic stiffness itself is never formed: its entries grow like ``E I / l^3`` and would spend the digits of the
lowest modes on the shortest span, whereas the transfer over a short piece is merely close to one.

The theory has neither shear nor rotary inertia of the section: that is the model of the thesis, and either
would bring a second length into the functions.  Rotary inertia of lumped parts is included.

Nothing here is shared with the finite elements, which makes agreement with them worth having.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from solidgear.errors import SolidgearError
from solidgear.fidelity.options import number

#: greatest ``k l`` of a piece: below the first clamped root 4.730, and growth by exp(2) only between orthonormalisations
_REACH = 2.0
#: the series of the Krylov-Duncan functions in ``(k l)^4``; at ``k l = 2`` the first term left out is below 1e-20
_TERMS = 7
_SERIES = np.array([[1 / np.prod(np.arange(1.0, 4 * n + j + 1)) for n in range(_TERMS)] for j in range(4)])
#: Gauss points of a piece: products of two shapes are integrated to rounding
_GAUSS = np.polynomial.legendre.leggauss(12)
#: interior points of one step of the root search: five bits a step
_SECTIONS = np.arange(1, 32) / 32


def krylov_duncan(kl):
    """Krylov-Duncan functions in their plain form.

    ``S = (cosh + cos) / 2``, ``T = (sinh + sin) / 2``, ``U = (cosh - cos) / 2``, ``V = (sinh - sin) / 2``.
    For small arguments V is of the order of ``kl^3 / 6`` and loses digits, for large ones all four tend to ``exp(kl) / 4`` and a
    determinant made of them loses about ``eps exp(kl) / kl``: :func:`krylov` uses neither end.

    Parameters
    ----------
    kl : float or ndarray
        Wave number times length, with ``k^4 = m w^2 / (E I)``.

    Returns
    -------
    S, T, U, V : float or ndarray
    """
    ch, c, sh, s = np.cosh(kl), np.cos(kl), np.sinh(kl), np.sin(kl)
    return (ch + c) / 2, (sh + s) / 2, (ch - c) / 2, (sh - s) / 2


@dataclass(frozen=True)
class Span:
    """A uniform length of shaft: `length` in m, `bending_stiffness` E I in N m^2, `mass_per_length` in kg/m."""

    length: float
    bending_stiffness: float
    mass_per_length: float

    def __post_init__(self):
        for name in ("length", "bending_stiffness", "mass_per_length"):
            _given("span", name, getattr(self, name), above=0)


@dataclass(frozen=True, eq=False)
class Station:
    """A point spring to ground and a lumped mass at one place of the shaft.

    Attributes
    ----------
    y : float
        m, from the left end of the first span.
    spring : (2, 2) ndarray
        On (z, thx): N/m, N/rad, N m/rad; symmetric positive semidefinite.
    mass, inertia : float
        kg, and kg m^2 about the x axis through the station.
    """

    y: float
    spring: np.ndarray = ((0.0, 0.0), (0.0, 0.0))
    mass: float = 0.0
    inertia: float = 0.0

    def __post_init__(self):
        _given("station", "y", self.y)
        _given("station", "mass", self.mass, least=0)
        _given("station", "inertia", self.inertia, least=0)
        try:
            k = np.array(self.spring, float)
        except (TypeError, ValueError):
            k = np.zeros(0)
        here = f"station at y = {self.y:g} m: the spring"
        if k.shape != (2, 2) or not np.isfinite(k).all():
            raise SolidgearError(f"{here} must be 2 rows of 2 finite numbers, on (z, thx)")
        bound = np.sqrt(abs(k[0, 0])) * np.sqrt(abs(k[1, 1]))  # of the coupling, in its own unit
        if abs(k[0, 1] - k[1, 0]) > 1e-9 * bound:
            raise SolidgearError(f"{here} is not symmetric: {k[0, 1]:g} and {k[1, 0]:g} off the diagonal")
        if min(k[0, 0], k[1, 1]) < 0 or abs(k[0, 1]) > (1 + 1e-9) * bound:
            raise SolidgearError(f"{here} {k.tolist()} is indefinite; no motion may give energy back")
        k.flags.writeable = False
        object.__setattr__(self, "spring", k)


@dataclass(frozen=True, eq=False)
class KrylovModes:
    """Bending modes, lowest first, each of unit modal mass.

    Attributes
    ----------
    frequency_hz : (n,) ndarray
    rigid : int
        How many of them are rigid motions, of frequency zero.
    counts : (n, 2) ndarray of int
        Modes counted below ``(1 - 1e-8) f`` and below ``(1 + 1e-8) f``: mode k, counted from zero, is the right one
        when ``counts[k, 0] <= k < counts[k, 1]``.
    distributed, lumped : (n,) ndarray
        Shares of the modal mass in the spans and in the lumped masses; their sum is one.
    defect : (n,) ndarray
        Largest violation of the equations at the joints, relative to the largest term of each.
    y : (j,) ndarray
        Joints between the pieces, m.
    """

    frequency_hz: np.ndarray
    rigid: int
    counts: np.ndarray
    distributed: np.ndarray
    lumped: np.ndarray
    defect: np.ndarray
    y: np.ndarray
    _pieces: tuple = field(repr=False)  # bending stiffness and mass per length of every piece
    _states: np.ndarray = field(repr=False)  # (n, j, 6): z, thx, then Q, M before and Q, M after the joint

    def shape(self, k: int, y, *, side: str = "after"):
        """Field of one mode.

        Parameters
        ----------
        k : int
            Mode, from zero.
        y : float or array_like
            m.
        side : {'after', 'before'}
            Which limit of M and Q is meant at a joint where they jump.

        Returns
        -------
        z, phi, M, Q : ndarray
            Deflection (m), ``phi = dz/dy = thx``, ``M = E I d2z/dy2`` (N m), and ``Q = -dM/dy`` (N), the force along z that the part beyond
            y exerts on the part before it; for unit modal mass.

        Raises
        ------
        SolidgearError
            For a mode that was not computed or a y outside the shaft.
        """
        y = np.asarray(y, float)
        count, end = len(self.frequency_hz), self.y[-1]
        if not -count <= k < count:
            raise SolidgearError(f"shape: there is no mode {k}; {count} were computed, counted from 0")
        if side not in ("after", "before"):
            raise SolidgearError(f"shape: side = {side!r} is unknown; use 'after' or 'before'")
        if not np.all((y >= -1e-9 * end) & (y <= end * (1 + 1e-9))):
            raise SolidgearError(f"shape: y must lie on the shaft, from 0 to {end:g} m")
        i = np.clip(np.searchsorted(self.y, y, "right" if side == "after" else "left") - 1, 0, len(self.y) - 2)
        s = np.clip(y - self.y[i], 0, None)
        stiff, heavy = self._pieces
        start = np.moveaxis(self._states[k][:, [0, 1, 4, 5]][i], -1, 0)
        z, phi, q, m = _apply(_transfer(s, stiff[i], heavy[i] * (2 * np.pi * self.frequency_hz[k]) ** 2), start)
        # The outer face of either end lies beyond its station.
        outer = (y <= 0) if side == "before" else (y >= end)
        return z, phi, np.where(outer, 0.0, m), np.where(outer, 0.0, q)


def krylov(spans: Sequence[Span], stations: Iterable[Station] = (), n: int | None = 4, *, max_frequency: float | None = None) -> KrylovModes:
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

    Returns
    -------
    KrylovModes

    Raises
    ------
    SolidgearError
        For a station off the shaft, or when neither `n` nor `max_frequency` is given.
    """
    number("krylov", "n", n, least=1, whole=True)
    number("krylov", "max_frequency", max_frequency, above=0)
    if n is None and max_frequency is None:
        raise SolidgearError("krylov: give n, max_frequency or both; a shaft has infinitely many modes")
    shaft = _joined(tuple(spans), tuple(stations))
    loose = shaft.loose()
    top = np.inf if max_frequency is None else 2 * np.pi * max_frequency
    rigid = min(loose.shape[1], n or 2)
    omega = np.concatenate([np.zeros(rigid), shaft.roots(rigid, n, top)])
    shaped = shaft.cut(omega.max(initial=0.0))
    states, defect = shaped.shapes(omega, loose)
    states, distributed, lumped = shaped.normalise(omega, states)
    around = shaft.count((omega[:, None] * (1 + np.array([-1e-8, 1e-8]))).ravel()).reshape(-1, 2)
    around[:rigid] = 0, loose.shape[1]
    return KrylovModes(omega / (2 * np.pi), rigid, around, distributed, lumped, defect, shaped.y, (shaped.stiff, shaped.heavy), states)


def from_scene(scene, *, pieces: int = 1) -> tuple[tuple[Span, ...], tuple[Station, ...]]:
    """Spans and stations of a scene, for bending in the plane of z.

    Cones become cylinders.  Each has the mean mass of its piece and the mean of ``1 / (E I)``, so that mass, and the turn under a
    uniform moment, are exact; the error falls with the square of the number of pieces.
    Couplings of a bearing between this plane and the rest are left out.

    Parameters
    ----------
    scene : Scene
    pieces : int
        Cylinders to a cone.

    Returns
    -------
    spans : tuple of Span
    stations : tuple of Station
        The lumped point, without a mass of its own, then the bearings.
    """
    number("krylov", "pieces", pieces, least=1, whole=True)
    spans = []
    for segment in scene.segments:
        cone = segment.outer0 != segment.outer1 or segment.inner0 != segment.inner1
        count = (pieces or 1) if cone else 1
        t = (np.arange(count)[:, None] + (_GAUSS[0] + 1) / 2) / count
        outer = segment.outer0 + t * (segment.outer1 - segment.outer0)
        inner = segment.inner0 + t * (segment.inner1 - segment.inner0)
        second = 1 / ((4 / np.pi / (outer**4 - inner**4)) @ _GAUSS[1] / 2)
        area = np.pi * (outer**2 - inner**2) @ _GAUSS[1] / 2
        material = segment.material
        spans += [Span(segment.length / count, float(material.E * i), float(material.density * a)) for i, a in zip(second, area)]
    point = Station(scene.port.y)
    return tuple(spans), (point, *(Station(b.y, b.stiffness[2:4, 2:4]) for b in scene.bearings))


def _given(what, name, value, **limits):
    # An option may be left out, a property may not: nan is refused where None would pass.
    number(what, name, np.nan if value is None else value, **limits)


def _transfer(s, stiff, force):
    """(4, 4, ...) transfer of (z, phi, Q, M) over a length `s`; `force` is ``m w^2``, ``k^4`` times `stiff`."""
    k4 = force / stiff
    x4 = k4 * s**4
    # All terms of the series are positive: nothing cancels, and w = 0 is no special case.
    c0, c1, c2, c3 = (s**j * np.polynomial.polynomial.polyval(x4, _SERIES[j]) for j in range(4))
    return np.array(
        [
            [c0, c1, -c3 / stiff, c2 / stiff],
            [k4 * c3, c0, -c2 / stiff, c1 / stiff],
            [-force * c1, -force * c2, c0, -k4 * c3],
            [force * c2, force * c3, -c1, c0],
        ]
    )


def _apply(t, b):
    return (t * b[None]).sum(axis=1)


class _Joint:
    """Springs and masses at one place, the springs as ``L D L'`` with the stiffer direction `p` first.

    A clamp of 1e20 N/m must not wash out a soft spring across it: factored, each acts with its own digits.
    """

    def __init__(self, stations, length):
        k = sum((s.spring for s in stations), np.zeros((2, 2)))
        self.mass = np.array([sum(s.mass for s in stations), sum(s.inertia for s in stations)], float)
        self.p = p = 0 if k[0, 0] * length**2 >= k[1, 1] else 1
        self.ell = k[0, 1] / k[p, p] if k[p, p] else 0.0
        soft = k[1 - p, 1 - p] - self.ell * k[0, 1]
        # What is left of a spring of rank one is rounding.
        self.d = np.array([k[p, p], soft if soft > 1e-12 * k[1 - p, 1 - p] else 0.0])
        self.first = 0 if self.mass[0] * length**2 >= self.mass[1] else 1
        order = [p, 1 - p]
        self.up, self.down = np.array([[1.0, self.ell], [0.0, 1.0]])[:, order], np.array([[1.0, 0.0], [-self.ell, 1.0]])[:, order]

    def act(self, b, omega):
        """Add the forces of the joint to the two solutions in `b` (4, 2, ...)."""
        b = self._add(b, self.p, self.ell, self.d)
        inertia = -self.mass[[self.first, 1 - self.first]][:, None] * omega**2
        return self._add(b, self.first, 0.0, inertia) if self.mass.any() else b

    @staticmethod
    def _add(b, p, ell, d):
        if not np.any(d):
            return b
        # One solution is turned so that it does not move the stiffer direction at all:
        # it then feels nothing of that spring, instead of a difference of huge forces.
        q = 1 - p
        y = b[p] + ell * b[q]
        h = np.hypot(y[0], y[1])
        safe = np.where(h > 0, h, 1.0)
        c, s = np.where(h > 0, y[0] / safe, 1.0), y[1] / safe
        b = np.stack([c * b[:, 0] + s * b[:, 1], c * b[:, 1] - s * b[:, 0]], axis=1)
        y = np.stack([h, np.zeros_like(h)])
        b[p, 1] = -ell * b[q, 1]
        b[2 + p] += d[0] * y
        b[2 + q] += ell * (d[0] * y) + d[1] * b[q]
        return b


def _joined(spans, stations):
    """The shaft with a joint at the ends of every span and at every station."""
    if not spans:
        raise SolidgearError("krylov: a shaft needs at least one span")
    ends = np.concatenate([[0.0], np.cumsum([s.length for s in spans])])
    length, near = ends[-1], 1e-9 * ends[-1]
    marks, held = list(ends), [[] for _ in ends]
    for station in stations:
        if not -near <= station.y <= length + near:
            raise SolidgearError(f"krylov: the station at y = {station.y:g} m is outside the shaft, 0 to {length:g} m")
        at = int(np.argmin(abs(np.array(marks) - station.y)))
        if abs(marks[at] - station.y) > near:  # nearer than that, it is meant to be at the mark
            at = int(np.searchsorted(marks, station.y))
            marks.insert(at, station.y)
            held.insert(at, [])
        held[at].append(station)
    y = np.array(marks)
    owner = np.clip(np.searchsorted(ends, (y[1:] + y[:-1]) / 2) - 1, 0, len(spans) - 1)
    stiff, heavy = np.array([(spans[i].bending_stiffness, spans[i].mass_per_length) for i in owner], float).T
    return _Shaft(y, stiff, heavy, [_Joint(h, length) for h in held])


class _Shaft:
    """Joints and the uniform spans between them."""

    def __init__(self, y, stiff, heavy, joints):
        self.y, self.stiff, self.heavy, self.joints = y, stiff, heavy, joints
        self.length = y[-1]

    def loose(self):
        """(2, r) rigid motions (z at y = 0, tilt) that no spring resists; found by rank, not by a small frequency."""
        motions = [np.array([[1.0, y / self.length], [0.0, 1 / self.length]]) for y in self.y]
        rows = np.vstack([np.zeros((1, 2))] + [(joint.up @ r)[joint.d > 0] for joint, r in zip(self.joints, motions)])
        norm = np.linalg.norm(rows, axis=1, keepdims=True)
        _, s, vt = np.linalg.svd(rows / np.where(norm > 0, norm, 1.0))
        return vt[int((s > 1e-9).sum()) :].T / np.array([[1.0], [self.length]])

    def weights(self, span, omega):
        """(4, ...) factors that bring (z, phi, Q, M) of a span to one unit, that of its wave."""
        stiff = self.stiff[span]
        k = np.maximum((self.heavy[span] * omega**2 / stiff) ** 0.25, 1 / self.length)
        return np.stack([k, np.ones_like(k), 1 / (stiff * k**2), 1 / (stiff * k)])

    def parts(self, omega):
        """Number of pieces of every span, for frequencies up to `omega`."""
        kl = (self.heavy * omega**2 / self.stiff) ** 0.25 * np.diff(self.y)
        return np.maximum(1, np.ceil(kl / _REACH)).astype(int)

    def count(self, omega):
        """Number of modes below each frequency (rad/s, 1-d)."""
        total = np.zeros(len(omega), int)
        b = np.zeros((4, 2, len(omega)))
        b[0, 0] = b[1, 1] = 1.0  # the left end is free until its joint acts
        sign = np.ones(len(omega))
        parts = self.parts(omega.max(initial=0.0))
        for i, joint in enumerate(self.joints):
            b = joint.act(b, omega)
            if i == len(parts):
                break
            w = self.weights(i, omega)
            b = _orthonormal(b, w)
            t = _transfer((self.y[i + 1] - self.y[i]) / parts[i], self.stiff[i], self.heavy[i] * omega**2)
            # Forces at the left of the piece that move its right end by one; the determinant of `reach` is positive in a piece.
            reach = np.array([[t[1, 3], -t[0, 3]], [-t[1, 2], t[0, 2]]])
            for _ in range(parts[i]):
                new = _apply(t[:, :, None], b)
                # Pivot of the joint left of the piece: (forces of the left part + forces of the piece, far end clamped) per motion.
                ahead = (reach[:, :, None] * new[None, :2]).sum(axis=1)
                negative, sign = _negative(ahead, b[:2], w, sign, _det(new[:2]))
                total += negative
                b = _orthonormal(new, w)
        negative, _ = _negative(b[2:], b[:2], w, sign, _det(b[2:]))
        return total + negative

    def roots(self, first, last, top):
        """Frequencies (rad/s) number `first` (from zero) to `last`, None for all, and below `top`, bracketed by counts until nothing lies between."""
        span = np.diff(self.y)
        high = top if last is None else min(top, np.sqrt((self.stiff @ span) / (self.heavy @ span)) / self.length**2)
        while (below := self.count(np.array([high]))[0]) < (last or 0) and high < top:
            high = min(4 * high, top)
        order = np.arange(first, min(below, last or below)) + 1
        lo, hi = np.zeros(len(order)), np.full(len(order), float(high))
        while np.any(wide := hi - lo > 8 * np.finfo(float).eps * hi):
            brackets, of = np.unique(np.column_stack([lo, hi])[wide], axis=0, return_inverse=True)
            low, size = brackets[:, :1], np.diff(brackets, axis=1)
            grid = np.hstack([low, low + size * _SECTIONS, brackets[:, 1:]])
            counted = self.count(grid[:, 1:-1].ravel()).reshape(len(grid), -1)[of.ravel()]
            reached = np.column_stack([counted >= order[wide, None], np.ones(wide.sum(), bool)])
            at = reached.argmax(axis=1)
            lo[wide], hi[wide] = grid[of.ravel(), at], grid[of.ravel(), at + 1]
        return (lo + hi) / 2

    def cut(self, omega):
        """The same shaft with a joint at the end of every piece."""
        parts, empty = self.parts(omega), _Joint((), self.length)
        y, joints = [self.y[:1]], [self.joints[0]]
        for a, b, count, joint in zip(self.y, self.y[1:], parts, self.joints[1:]):
            y.append(np.linspace(a, b, count + 1)[1:])
            joints += [empty] * (count - 1) + [joint]
        return _Shaft(np.concatenate(y), np.repeat(self.stiff, parts), np.repeat(self.heavy, parts), joints)

    def shapes(self, omega, loose):
        """(n, j, 6) motions, and forces before and after, at every joint; and the (n,) violation of the equations."""
        out, defect = np.zeros((len(omega), len(self.y), 6)), np.zeros(len(omega))
        rigid = int((omega == 0).sum())
        for k in range(rigid):
            out[k, :, 0], out[k, :, 1] = loose[0, k] + loose[1, k] * self.y, loose[1, k]
        # Frequencies nearer than this are one: the equations have as many solutions there.
        for group in _groups(omega, 1e-10):
            if group[0] >= rigid:
                out[group], defect[group] = self._null(omega[group].mean(), len(group))
        return out, defect

    def _null(self, omega, many):
        """Solutions of all joint equations at once (multiple shooting), by inverse iteration on the normal equations.

        A sweep from the left would lose a mode that lives elsewhere; here no end is preferred.
        """
        nodes, blocks, spots = len(self.y), [], []
        unit = self.weights(np.maximum(np.arange(nodes) - 1, 0), omega)[[0, 1, 2, 3, 2, 3]].T.ravel()
        for i, joint in enumerate(self.joints):
            # Factored as in `_Joint`, so that a stiff row does not hide the soft one.
            down, up = joint.down, joint.up
            blocks.append(np.hstack([down @ np.diag(joint.mass) * omega**2 - joint.d[:, None] * up, -down, down]))
            spots.append(6 * i + np.arange(6))
        for i, t in enumerate(np.moveaxis(_transfer(np.diff(self.y), self.stiff, self.heavy * omega**2), -1, 0)):
            blocks.append(np.hstack([-t, np.eye(4)]))
            spots.append(6 * i + np.array([0, 1, 4, 5, 6, 7, 8, 9]))
        blocks += [np.eye(2), np.eye(2)]  # nothing pulls on the outer faces
        spots += [np.array([2, 3]), 6 * nodes - 2 + np.arange(2)]
        blocks = [b / unit[s] for b, s in zip(blocks, spots)]
        values = np.concatenate([(b / abs(b).max(axis=1, keepdims=True)).ravel() for b in blocks])
        row = np.repeat(np.arange(6 * nodes), [len(s) for b, s in zip(blocks, spots) for _ in b])
        column = np.concatenate([np.tile(s, len(b)) for b, s in zip(blocks, spots)])
        a = sp.csc_matrix((values, (row, column)), shape=(6 * nodes,) * 2)
        v = np.random.default_rng(0).standard_normal((6 * nodes, many))
        try:
            lu = splu(a)
        except RuntimeError:  # singular to the last bit: a step of a few bits away the solutions are the same
            lu = splu((a + 1e-15 * sp.identity(6 * nodes)).tocsc())
        for _ in range(4):
            v = np.linalg.qr(lu.solve(v, trans="T"))[0]
            v = np.linalg.qr(lu.solve(v))[0]
        return (v / unit[:, None]).T.reshape(many, nodes, 6), abs(a @ v).max(axis=0)

    def normalise(self, omega, states):
        """States of unit modal mass, orthogonal also where frequencies nearly meet; and the shares of the mass."""
        x, w = _GAUSS
        size = np.diff(self.y)
        s = size[:, None] * (x + 1) / 2
        weight = (self.heavy * size)[:, None] * w / 2
        start = np.moveaxis(states[:, :-1][:, :, [0, 1, 4, 5]], 2, 0)[..., None]
        z = [_apply(_transfer(s, self.stiff[:, None], self.heavy[:, None] * w2), start[:, k])[0].ravel() for k, w2 in enumerate(omega**2)]
        z, moved = np.reshape(z, (len(omega), -1)), states[:, :, :2].reshape(len(omega), -1)
        mass = np.array([j.mass for j in self.joints]).ravel()
        states, distributed, lumped = states.copy(), np.zeros(len(omega)), np.zeros(len(omega))
        for g in _groups(omega, 1e-4):
            spread, points = (z[g] * weight.ravel()) @ z[g].T, (moved[g] * mass) @ moved[g].T
            # The nearest orthonormal set: solutions of frequencies this close know each other to fewer digits.
            scale = 1 / np.sqrt(np.diag(spread + points))
            values, vectors = np.linalg.eigh(scale[:, None] * (spread + points) * scale)
            mix = (vectors / np.sqrt(values)) @ vectors.T * scale
            states[g] = np.tensordot(mix, states[g], 1)
            distributed[g], lumped[g] = np.diag(mix @ spread @ mix.T), np.diag(mix @ points @ mix.T)
        largest = abs(states[:, :, 0]) > 0.999 * abs(states[:, :, :1]).max(axis=1)  # of equals the first, whatever the rounding
        first = np.take_along_axis(states[:, :, 0], largest.argmax(axis=1)[:, None], 1)
        return states * np.where(first < 0, -1.0, 1.0)[:, :, None], distributed, lumped


def _groups(omega, gap):
    """Indices of ascending frequencies, split where neighbours differ by more than `gap`, relatively."""
    return [g for g in np.split(np.arange(len(omega)), np.flatnonzero(np.diff(omega) > gap * omega[1:]) + 1) if len(g)]


def _det(x):
    return x[0, 0] * x[1, 1] - x[0, 1] * x[1, 0]


def _negative(force, motion, w, sign, following):
    """Negative eigenvalues of ``force motion^-1``, and the sign of `following` for the next call.

    A determinant that is zero to rounding has some sign in this pivot and the same in the next: taken over
    instead of computed twice, it cannot make a mode appear in both or in neither.
    """
    det = np.where(following < 0, -1.0, 1.0)
    # Only the sum of the diagonal is needed: with the sign of the determinant it tells 0, 1 and 2 apart.
    first = force[0, 0] * motion[1, 1] - force[0, 1] * motion[1, 0]
    second = force[1, 1] * motion[0, 0] - force[1, 0] * motion[0, 1]
    trace = sign * (first + (w[0] ** 2) * second)
    return np.where(det * sign < 0, 1, np.where(trace < 0, 2, 0)), det


def _orthonormal(b, w):
    """The same two solutions, orthonormal in the unit `w`, by column operations of positive determinant."""
    g = w[:, None] * b
    one = np.sqrt((g[:, 0] ** 2).sum(axis=0))
    first, g1 = b[:, 0] / one, g[:, 0] / one
    along = (g1 * g[:, 1]).sum(axis=0)
    second, g2 = b[:, 1] - along * first, g[:, 1] - along * g1
    return np.stack([first, second / np.sqrt((g2**2).sum(axis=0))], axis=1)
