"""Steady motion over many frequencies, with losses of several kinds, and a grid that misses no
peak.

A loss factor eta_j of a part or link makes the stiffness complex,

    K_j (1 + i eta_j)              hysteretic: no frequency in it
    K_j (1 + i eta_j w / w0)       viscous, with the same loss at w0
    w_r^2 (1 + i eta_r)            modal: eta_r = sum_j eta_j (share of mode r's energy in j)

``C = zeta K`` with a *ratio* zeta, as Hua (2010) writes it (equations 8 and 19), is viscous damping
with the loss factor zeta at w0 = 1 rad/s, so that zeta counts as seconds.

Hysteretic and modal losses have complex modes ``mu_r`` that serve all frequencies, all modes of the
system and those of residual fields among them, so that no static remainder is missing.  With H the
lost stiffness in elastic modes they are those of the flexibility,

    (diag(w_r^2) + i H)^-1 = W (I + i W H W)^-1 W = V diag(1 / mu_r) V^-1,      W = diag(1 / w_r),

whose largest entries are those of the lowest modes: rounding is that of the softest motion, not of
the stiffest spring. Twins share their mu, and any two vectors of their plane may come out, so that
those on the left are the rows of V^-1 and not V' again. The motion is ``sum_r a_r / (mu_r - w^2)``,
smooth but within some half-widths ``Im mu_r / (2 sqrt(Re mu_r))`` of a pole. So a grid with points
at every pole and around it can miss no peak; between them intervals are halved until their middles
are foretold.

Where all but a few springs share one loss factor, real modes do without the complex ones
(:mod:`solidgear.core.system.common_loss`).

Steady motion by elimination, one frequency at a time, beside springs of any stiffness.

In a sum of stiffnesses a clamp of 1e22 N/m leaves nothing of the shaft beside it.  So the forces s
of links that are stiffer than all parts are unknowns of their own.  With their unit rows g, ``k``
the stiffness along each and D that of all else less ``w^2 M``,

    D q + g' s = f,     g q - s / (k (1 + i eta)) = 0.

A load on such a seat goes for the most part straight into the ground. Where they span it, ``f = g'
a``, it is taken as the motion ``a / (k (1 + i eta))`` of their feet, so that the small rest is no
difference; and a motion that they span is read from q or from s, whichever rounds less.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from solidgear.core.errors import SolidgearError
from solidgear.core.machine.threads import pinned
from solidgear.core.system.common_loss import CommonLoss, common_loss, in_real_modes
from solidgear.core.system.coupled import Coupled

KINDS = ("hysteretic", "viscous", "modal")
#: grid points around a pole, in half-widths
AROUND = np.array([-16, -8, -4, -2, -1, -0.5, -0.25, 0, 0.25, 0.5, 1, 2, 4, 8, 16])
#: least half-width over frequency, so that points around a pole differ
SHARPEST = 1e-7
#: points a decade between poles before any halving
PER_DECADE = 60
#: a middle that is foretold within this needs no halving, dB
FORETOLD = 0.25
#: halvings of an interval, and points, at most
HALVINGS, MOST_POINTS = 12, 6_000
#: a peak that stands out from the dip beside it by less than this is a ripple, dB
STANDS_OUT = 0.5
#: motions this much smaller than the largest are rounding
NOISE = 1e-10
#: frequencies that are solved at once, one by one in modes
BATCH = 64
#: work of a load on a free motion, relative to the largest it could do, that is rounding
UNBALANCED = 1e-9
#: distance of a frequency from that of a mode, relative, in the square, that is rounding
ON_A_POLE = 8 * float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class SteadyState:
    """System with losses, ready for many loads and frequencies.

    Examples
    --------
    >>> from solidgear.core.system import Inertia, System, torsion_spring
    >>> fan = System({"fan": Inertia(2.0)}, {"shaft": torsion_spring("fan", 800.0)})
    >>> steady = SteadyState(fan, {"shaft": 0.1})
    >>> push = fan.load({"fan": [0, 0, 0, 0, 1, 0]})
    >>> at = np.array([20 / (2 * np.pi)])  # its resonance: 1 / (eta k)
    >>> round(float(abs(steady.motion(at, push, fan.motion("fan")[4:5])[0, 0])) * 80.0, 9)
    1.0
    """

    system: Coupled
    loss: Mapping[str, float] = field(default_factory=dict)  #: loss factor eta of parts and links
    kind: str = "hysteretic"
    matched_hz: float = 0.0  #: where viscous losses have their loss factor, Hz

    def __post_init__(self):
        if self.kind not in KINDS:
            raise SolidgearError(
                f"losses of the kind {self.kind!r} are unknown; use {', '.join(KINDS)}"
            )
        if self.kind == "viscous" and not (np.isfinite(self.matched_hz) and self.matched_hz > 0):
            raise SolidgearError(
                "viscous losses grow with frequency; say at which one, in Hz, they are to have "
                "the loss factors given"
            )
        for name, eta in self.loss.items():
            if not (np.isfinite(eta) and eta >= 0):
                raise SolidgearError(f"{name} is {eta}; a loss factor is finite and not negative")

    def factor(self, name: str, frequency_hz: np.ndarray) -> np.ndarray:
        """Return the complex factor (f,) on the stiffness of a part or link."""
        eta, constant = self.loss.get(name, 0.0), np.ones(len(frequency_hz))
        return 1 + 1j * eta * (frequency_hz / self.matched_hz if self._grows else constant)

    @property
    def _grows(self) -> bool:
        return self.kind == "viscous"

    @cached_property
    def _lost(self) -> np.ndarray:
        """Lost stiffness ``sum eta_j K_j`` (m, m) in elastic modes; the diagonal alone for modal
        losses.
        """
        lost = lost_stiffness(self.system, self.loss)
        return np.diag(np.diag(lost)) if self.kind == "modal" else lost

    @cached_property
    def _common(self) -> CommonLoss | None:
        """Loss of nearly all stiffness, and the few rows that differ from it."""
        return common_loss(self.system, self.loss) if self.kind == "hysteretic" else None

    @cached_property
    def _flexible(self) -> np.ndarray:
        """(m, m) complex flexibility in elastic modes."""
        soft = 1 / self.system.elastic[0]
        damped = np.eye(len(soft)) + 1j * soft[:, None] * self._lost * soft
        flexible = soft[:, None] * np.linalg.solve(damped, np.diag(soft))
        return (flexible + flexible.T) / 2

    @cached_property
    def _complex(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Eigenvalues mu (m,), shapes (N, m) and left vectors (m, N), which give the work of a
        load.
        """
        elastic = self.system.elastic[1]
        value, turn = np.linalg.eig(self._flexible)
        return 1 / value, elastic @ turn, np.linalg.solve(turn, elastic.T)

    @cached_property
    def poles(self) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies (m,) around which motions peak, ascending, and half-widths (m,), Hz."""
        omega = self.system.elastic[0]
        if self._grows:
            hz = omega / (2 * np.pi)
            lost = np.diag(self._lost) / omega**2 * hz / self.matched_hz
            # overcritical motions have no peak; their place does no harm
            return hz, np.maximum(lost / 2, SHARPEST) * hz
        # where real modes do, nobody asks for the shapes, which are half of the work
        real_modes = self._common is not None
        value = 1 / np.linalg.eigvals(self._flexible) if real_modes else self._complex[0]
        hz = np.sqrt(np.abs(value.real)) / (2 * np.pi)
        order = np.argsort(hz)
        width = np.maximum(np.abs(value.imag / value.real) / 2, SHARPEST)
        return hz[order], (width * hz)[order]

    @pinned
    def motion(self, frequency_hz: np.ndarray, load: np.ndarray, rows: np.ndarray) -> np.ndarray:
        """Return complex amplitudes (f, q) of the motions `rows` (q, N), such as
        ``system.motion(end)``, under a load (N,) that has the same amplitude at all frequencies.

        Refused are a resonance without damping, and 0 Hz if the load drives a free motion.
        """
        frequency_hz, load = np.asarray(frequency_hz, float), np.asarray(load)
        w2 = (2 * np.pi * frequency_hz) ** 2
        if self._grows:
            out = self._one_by_one(frequency_hz, load, rows)
        elif self._common is not None:
            out = in_real_modes(self.system, self._common, w2, load, rows)
        else:
            value, shapes, work = self._complex
            gap = value[:, None] - w2
            if np.any(np.abs(gap) <= ON_A_POLE * w2):
                raise SolidgearError(
                    "a frequency equals that of an undamped mode; give damping or a loss"
                )
            out = ((rows @ shapes) @ ((work @ load)[:, None] / gap)).T
        return out + free_motion(self.system, w2, load, rows).T

    def _one_by_one(self, frequency_hz, load, rows) -> np.ndarray:
        """Return one solution for each frequency where the loss depends on it, in elastic modes for
        each.
        """
        omega, shapes = self.system.elastic
        # unit strain energy, so that equations of very stiff and soft modes are alike
        scale = 1 / omega
        push, observed = scale * (shapes.T @ load), (rows @ shapes) * scale
        lost = scale[:, None] * self._lost * scale
        out = np.empty((len(frequency_hz), len(rows)), complex)
        for start in range(0, len(frequency_hz), BATCH):
            part = slice(start, start + BATCH)
            hz = frequency_hz[part, None, None]
            matrix = 1j * hz / self.matched_hz * lost
            diagonal = 1 - (2 * np.pi * frequency_hz[part, None]) ** 2 * scale**2
            matrix[:, np.arange(len(omega)), np.arange(len(omega))] += diagonal
            right = np.broadcast_to(push[:, None].astype(complex), (len(matrix), len(push), 1))
            out[part] = np.linalg.solve(matrix, right)[:, :, 0] @ observed.T
        return out

    @pinned
    def solved(self, frequency_hz: np.ndarray, load: np.ndarray, rows: np.ndarray) -> np.ndarray:
        """Return the same as :meth:`motion`, each frequency solved by itself.

        Between ends far from each other a sum over modes cancels: engine to load of a train at 4
        kHz is 1e-14 of the terms. Five digits are left of a sum over modes, all of an elimination;
        modal losses exist in modes alone and are summed.
        """
        if self.kind == "modal":
            return self.motion(frequency_hz, load, rows)
        frequency_hz = np.asarray(frequency_hz, float)
        elimination = Elimination(self.system, self.loss)
        out = np.empty((len(frequency_hz), len(rows)), complex)
        for start in range(0, len(frequency_hz), BATCH):
            batch = slice(start, start + BATCH)
            hz = frequency_hz[batch]
            growth = hz / self.matched_hz if self._grows else np.ones(len(hz))
            out[batch] = elimination.motion(2 * np.pi * hz, growth, load, rows)
        return out

    def grid(
        self, lowest_hz: float, highest_hz: float, motions_at: Callable[[np.ndarray], np.ndarray]
    ) -> np.ndarray:
        """Return ascending frequencies (f,) between two ends, both among them, on which no peak of
        some motions is missed; ``motions_at(frequency_hz)`` gives the motions (f, q).
        """
        if not 0 < lowest_hz < highest_hz:
            raise SolidgearError(
                f"frequencies from {lowest_hz:g} to {highest_hz:g} Hz; give ascending ends above 0"
            )
        hz, width = self.poles
        near = (hz > lowest_hz * 0.5) & (hz < highest_hz * 2)
        around = (hz[near, None] + width[near, None] * AROUND).ravel()
        count = int(np.ceil(PER_DECADE * np.log10(highest_hz / lowest_hz))) + 2
        points = np.concatenate([np.geomspace(lowest_hz, highest_hz, count), around])
        points = np.unique(points[(points >= lowest_hz) & (points <= highest_hz)])
        first = motions_at(points)
        largest = np.abs(first).max(axis=0)
        level = _decibels(first, largest)
        fresh = np.ones(len(points) - 1, bool)
        for _ in range(HALVINGS):
            intervals = np.flatnonzero(fresh)
            if not len(intervals) or len(points) + len(intervals) > MOST_POINTS:
                break
            middle = (points[intervals] + points[intervals + 1]) / 2
            middle_level = _decibels(motions_at(middle), largest)
            error = np.abs(middle_level - (level[intervals] + level[intervals + 1]) / 2).max(axis=1)
            # an interval whose middle was foretold is left with it, and not halved again
            missed = np.zeros(len(points) - 1, bool)
            missed[intervals] = error > FORETOLD
            points = np.insert(points, intervals + 1, middle)
            level = np.insert(level, intervals + 1, middle_level, axis=0)
            inherited = np.repeat(missed, 1 + np.isin(np.arange(len(missed)), intervals))
            fresh = inherited
        return points


def free_motion(
    system: Coupled, w2: np.ndarray, load: np.ndarray, rows: np.ndarray | None = None
) -> np.ndarray:
    """Return accelerations of free motions, twice integrated; of all coordinates, or by some rows."""
    push = system.free.T @ load
    if np.any(w2 == 0):
        if np.abs(push).max(initial=0.0) > UNBALANCED * np.linalg.norm(system.elastic[1].T @ load):
            raise SolidgearError(
                "at 0 Hz the load drives a motion that nothing resists; leave 0 Hz out"
            )
    moving = np.where(w2 > 0, w2, 1.0)
    motions = system.free if rows is None else rows @ system.free
    return motions @ (push[:, None] * (w2 > 0) / -moving)


def lost_stiffness(system: Coupled, loss: Mapping[str, float]) -> np.ndarray:
    """Return ``sum eta_j K_j`` in elastic modes."""
    g, rows_of = system.strains
    shapes = system.elastic[1]
    out = np.zeros((shapes.shape[1],) * 2)
    for name, eta in loss.items():
        if name not in system.parts and name not in system.links:
            raise SolidgearError(f"a loss factor for {name!r}, which is no part and no link")
        if name in rows_of:
            stretch = g[rows_of[name]] @ shapes
            out += eta * (stretch.T @ stretch)
    return out


def peaks(size: np.ndarray) -> np.ndarray:
    """Return places of local maxima of a curve, ends left out; the first of equal neighbours."""
    inner = size[1:-1]
    return 1 + np.flatnonzero((inner > size[:-2]) & (inner >= size[2:]))


def stands_out(size: np.ndarray, k: int) -> bool:
    """Return whether a local maximum rises by more than a ripple above the dips beside it."""
    before, after = size[:k][::-1], size[k + 1 :]
    least = size[k] / 10 ** (STANDS_OUT / 20)

    def dips(side):
        higher = np.flatnonzero(side > size[k])
        near = side[: higher[0]] if len(higher) else side
        return bool(len(near) and near.min() < least)

    return dips(before) and dips(after)


def _decibels(motions: np.ndarray, largest: np.ndarray) -> np.ndarray:
    """Return levels under the largest, where rounding is all one level."""
    return 20 * np.log10(np.maximum(np.abs(motions), NOISE * largest) + 1e-300)


#: stiffness of a link, over its effective mass, above the highest eigenvalue of the parts by so much
#: that it is no term of a sum; both forms are exact, and round alike near it
STIFF = 1e4
#: a load or a row that differs from a combination of the rows of links by less, relative, is one
SAME = 1e-14
#: a weight in such a combination that is rounding
SPARE = 1e-12


class Elimination:
    """Matrices of a system with loss factors of parts and links, those of the parts separate from
    the rows of the links.
    """

    def __init__(self, system: Coupled, loss: Mapping[str, float]):
        g, rows_of = system.strains
        eta = np.zeros(len(g))
        for name, place in rows_of.items():
            eta[place] = loss.get(name, 0.0)
        linked = np.zeros(len(g), bool)
        for name in system.links.keys() & rows_of.keys():
            linked[rows_of[name]] = True
        self.mass = system.mass
        stiff = linked & self._stiff(g, linked)
        self.elastic = g[~stiff].T @ g[~stiff]
        self.lost = g[~stiff].T @ (eta[~stiff, None] * g[~stiff])
        length = np.linalg.norm(g[stiff], axis=1)
        self.unit, self.stiffness, self.eta = g[stiff] / length[:, None], length**2, eta[stiff]

    def _stiff(self, g: np.ndarray, linked: np.ndarray) -> np.ndarray:
        """Return which strain rows are far stiffer than all parts."""
        own_stiffness = np.einsum("ij,ji->i", g, np.linalg.solve(self.mass, g.T))
        return own_stiffness > STIFF * own_stiffness[~linked].max(
            initial=np.inf if linked.all() else 0.0
        )

    def motion(
        self, omega: np.ndarray, growth: np.ndarray, load: np.ndarray, rows: np.ndarray
    ) -> np.ndarray:
        """Return amplitudes (f, q) of the motions `rows` (q, N) under a load (N,), at frequencies
        (f,), rad/s; `growth` (f,) multiplies the losses.
        """
        n = len(self.mass)
        flexibility = 1 / (self.stiffness * (1 + 1j * growth[:, None] * self.eta))
        matrix = np.zeros((len(omega), n + len(self.eta), n + len(self.eta)), complex)
        w2, grown = omega[:, None, None] ** 2, growth[:, None, None]
        matrix[:, :n, :n] = self.elastic - w2 * self.mass + 1j * grown * self.lost
        matrix[:, n:, :n], matrix[:, :n, n:] = self.unit, self.unit.T
        links = np.arange(n, matrix.shape[1])
        matrix[:, links, links] = -flexibility
        straight, spanned = self._spanned(load[None])
        right = np.zeros((len(omega), matrix.shape[1], 1), complex)
        right[:, :n, 0] = 0.0 if spanned[0] else load
        right[:, n:, 0] = flexibility * straight[0]
        solution = np.linalg.solve(matrix, right)[:, :, 0]
        return self._motions(solution[:, :n], solution[:, n:], straight[0], flexibility, rows)

    def _motions(self, q, force, straight, flexibility, rows) -> np.ndarray:
        """Return motions from coordinates, or from the forces of links where those round less."""
        by_coordinates = q @ rows.T
        weight, spanned = self._spanned(rows)
        by_force = ((force + straight) * flexibility) @ weight.T
        blur = (np.abs(force) + np.abs(straight)) * np.abs(flexibility)
        less = blur @ np.abs(weight).T < np.abs(q) @ np.abs(rows).T
        return np.where(spanned & less, by_force, by_coordinates)

    def _spanned(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return combinations (q, r) of the rows of links, zero where rows (q, N) are none, and
        which are.
        """
        weight = np.linalg.lstsq(self.unit.T, rows.T, rcond=None)[0].T
        # rounding on a soft spring far away would be as large as the motion of a clamp
        weight[np.abs(weight) <= SPARE * np.abs(weight).max(axis=1, initial=0.0, keepdims=True)] = 0
        miss = np.linalg.norm(rows - weight @ self.unit, axis=1)
        spanned = miss <= SAME * np.linalg.norm(rows, axis=1)
        return np.where(spanned[:, None], weight, 0.0), spanned
