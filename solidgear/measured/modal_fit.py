"""Resonances from measured responses, each with damping, shape and uncertainty.

In a band of lines a response is a sum over modes, accelerance over s = i w,

    H_o(s) = sum_r  A_or / (s - p_r) + A_or* / (s - p_r*)  + a polynomial of the modes outside,

with poles p that all responses share. Poles are begun with by least squares in the complex
frequency domain (Guillaume, Verboven et al. 2003, A poly-reference implementation of the
least-squares complex frequency-domain estimator, IMAC 21), with the numerator left at the highest
order so that one set of normal equations serves the denominators of all orders; a pole that stays
where it is over the orders is a mode. They are then brought to the least squares of the sum itself
by Gauss and Newton, residues being eliminated (Golub and Pereyra 1973, SIAM J. Numer. Anal. 10,
413), each response weighed by the noise. Deviations are those of that fit, of the residuals as they
are (White 1980, Econometrica 48, 817, in the form that leverage widens): noise that grows with the
response counts as well as a floor does.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from scipy.ndimage import uniform_filter1d

from solidgear.core import SolidgearError, pinned
from solidgear.core.meshing.placing import Placing
from solidgear.measured.universal import Responses, Shapes

#: lines of a band, and the overlap of neighbouring bands
LINES, MARGIN = 512, 128
#: lines below which nothing is fitted
FEWEST = 32
#: highest order of the denominator in a band, and the lowest that is looked at
ORDERS = range(4, 41, 2)
#: share of the unit circle that a band is put on; the rest takes the gap (Verboven 2002)
CIRCLE = 0.9
#: a pole stays where it is within this share of its half width, over so many orders of those
STAYS, STABLE = 0.5, 3
#: largest damping of a mode
DAMPED = 0.1
#: degree of the polynomial, rounds of the fit, of which weights are of the first, and the change of
#: the poles in half widths that ends it
DEGREE, ROUNDS, WEIGHING, ENDS = 6, 25, 3, 1e-4
#: power of a mode over that of the noise of as many unknowns from which on it is one
SIGNIFICANT = 12.0
#: standard deviation of a pole along the axis over its half width from which on no peak is located
LOCATED = 0.5
#: half widths (of the wider) within which a second pole must stand out more, and how much more
NEAR, STEEP = 1.25, 5
#: lines over which noise is alike
ABOUT = 9
#: standard deviation to which a frequency repeats, relative, whatever the noise: the modulus of steel falls
#: by some 0.03 % a kelvin, so that 1.3 K are as much, as are 0.4 g of accelerometer or cord that move with a
#: kilogram
REPEATS = 2e-4


@dataclass(frozen=True, eq=False)
class ModalFit:
    """Poles of responses and their residues, by ascending frequency."""

    poles: np.ndarray  #: (n,) rad/s
    covariances: np.ndarray  #: (n, 2, 2) of the real and imaginary part of each
    residues: np.ndarray  #: (n, m) of every response, as accelerance

    @property
    def frequencies(self) -> np.ndarray:
        """Undamped natural frequencies, Hz."""
        return np.abs(self.poles) / (2 * np.pi)

    @property
    def damping(self) -> np.ndarray:
        """Damping ratios."""
        return -self.poles.real / np.abs(self.poles)

    @property
    def deviations(self) -> tuple[np.ndarray, np.ndarray]:
        """Standard deviations of frequencies, Hz, and of damping ratios."""
        size = np.abs(self.poles)
        along = np.column_stack([self.poles.real, self.poles.imag]) / size[:, None]
        across = np.column_stack([-self.poles.imag, self.poles.real]) / size[:, None]
        # damping is the sine of the angle to the imaginary axis, the cosine of which is its slope
        slope = np.abs(self.poles.imag) / size**2
        spread = [np.einsum("ni,nij,nj->n", v, self.covariances, v) for v in (along, across)]
        return np.sqrt(spread[0]) / (2 * np.pi), np.sqrt(spread[1]) * slope


@pinned
def fit_modes(hertz: np.ndarray, accelerance: np.ndarray) -> ModalFit:
    """Return modes of accelerances (m, k), in any unit, over ascending frequencies (k,), Hz."""
    ahead = hertz > 0
    omega, data = 2 * np.pi * hertz[ahead], accelerance[:, ahead]
    if len(omega) < FEWEST:
        raise SolidgearError(f"responses have {len(omega)} lines; give {FEWEST} at least")
    moved = np.sqrt(np.mean(np.abs(data) ** 2, axis=1))
    if not np.all(np.isfinite(data)) or not np.all(moved > 0):
        raise SolidgearError("a response is zero everywhere, or has an entry that is not a number")
    modes_found: list[tuple[complex, np.ndarray, np.ndarray]] = []
    count = max(math.ceil((len(omega) - 2 * MARGIN) / (LINES - 2 * MARGIN)), 1)
    edges = np.linspace(0, len(omega), count + 1).astype(int)
    for first, last in zip(edges[:-1], edges[1:]):
        lines = slice(max(first - MARGIN, 0), last + MARGIN)
        band = _Band(omega[lines], data[:, lines])
        low = omega[first] if first else -math.inf
        high = omega[last] if last < len(omega) else math.inf
        before = [pole for pole, *_ in modes_found]
        for mode in band.modes():
            # a mode on an edge is found from both sides
            near = any(abs(mode[0] - pole) < -mode[0].real / 2 for pole in before)
            slack = -mode[0].real
            if low - slack <= mode[0].imag < high + slack and not near:
                modes_found.append(mode)
    if not modes_found:
        raise SolidgearError("no resonance stands out of the noise of these responses")
    modes_found.sort(key=lambda mode: abs(mode[0]))
    poles, covariances, residues = (np.array(part) for part in zip(*modes_found))
    return ModalFit(poles, covariances, residues)


class _Band:
    """Responses over some lines, and the modes in them."""

    def __init__(self, omega: np.ndarray, data: np.ndarray):
        self.omega, self.step = omega, float(np.median(np.diff(omega)))
        self.middle, self.half = (omega[0] + omega[-1]) / 2, (omega[-1] - omega[0]) / 2
        # a part that does not continue from line to line is noise
        jumps = np.median(np.abs(np.diff(data, 2, axis=1)), axis=1) / math.sqrt(6 * math.log(2))
        rms = np.sqrt(np.mean(np.abs(data) ** 2, axis=1))
        self.scale = np.maximum(jumps, 1e-9 * rms.max())
        self.data = data / self.scale[:, None]
        x = (omega - self.middle) / self.half
        self.smooth = np.polynomial.legendre.legvander(x, DEGREE)

    def modes(self) -> list[tuple[complex, np.ndarray, np.ndarray]]:
        """Return the pole, covariance of it, and residues of every mode."""
        poles = self.starts()
        while len(poles):
            poles = self.refined(poles)
            power, covariance, residues = self.estimates(poles)
            width = -poles.real
            inside = self.inside(poles)
            mode = (width > 0) & (width < DAMPED * abs(poles)) & (width < self.half)
            # the nearer a stronger pole, the more a second one takes of noise that grows with peaks
            distance = np.abs(poles - poles[:, None]) / np.maximum(width, width[:, None])
            stronger = np.where(power > power[:, None], distance, np.inf).min(axis=1)
            required = SIGNIFICANT * np.maximum(1.0, NEAR / np.maximum(stronger, 1e-3)) ** STEEP
            located = covariance[:, 1, 1] < (LOCATED * width) ** 2
            accepted = mode & ((power > required) & located | ~inside)
            if accepted.all():
                places = np.flatnonzero(inside)
                scaled = residues * self.scale[:, None]
                return [(complex(poles[k]), covariance[k], scaled[:, k]) for k in places]
            # the weakest goes, and the others are fitted without it
            worst = int(np.where(accepted, np.inf, np.where(mode & located, power, -1.0)).argmin())
            poles = np.delete(poles, worst)
        return []

    def inside(self, poles: np.ndarray) -> np.ndarray:
        """Return which poles lie in the band."""
        return np.abs(poles.imag - self.middle) <= self.half

    def starts(self) -> np.ndarray:
        """Return poles that are stable over the orders."""
        rate = CIRCLE * math.pi / self.half
        most = min(ORDERS[-1], len(self.omega) // 4)
        z = np.exp(1j * rate * (self.omega - self.middle))
        powers = z[:, None] ** np.arange(most + 1)
        numerator = np.linalg.qr(powers)[0].conj().T
        normal = (powers.conj().T * np.sum(np.abs(self.data) ** 2, axis=0)) @ powers
        for row in self.data:
            projected = (numerator * row) @ powers
            normal = normal - projected.conj().T @ projected
        chains: list[list[complex]] = []
        orders = [n for n in ORDERS if n <= most]
        for n in orders:
            # with the lowest coefficient held, a spurious pole lies beyond the axis
            higher = np.linalg.lstsq(
                normal[1 : n + 1, 1 : n + 1], -normal[1 : n + 1, 0], rcond=None
            )[0]
            roots = np.roots(np.append(higher[::-1], 1.0))
            poles = 1j * self.middle + np.log(roots) / rate
            for pole in poles[(poles.real < 0) & (poles.imag > 0)]:
                width = max(-pole.real, self.step)
                near = [c for c in chains if abs(c[-1] - pole) < STAYS * width]
                if near:
                    min(near, key=lambda chain: abs(chain[-1] - pole)).append(complex(pole))
                else:
                    chains.append([complex(pole)])
        return np.array([c[-1] for c in chains if len(c) >= STABLE], complex)

    def refined(self, poles: np.ndarray) -> np.ndarray:
        """Return the poles of least squares."""
        weight = np.ones(len(self.data))
        cost = math.inf
        step = np.zeros_like(poles)
        for turn in range(ROUNDS):
            fit = _Fit(self, poles, weight)
            if turn > WEIGHING and fit.cost > cost * (1 + 1e-9):
                step = step / 2
                poles = poles - step
                continue
            if turn < WEIGHING:
                weight = fit.weight()
            cost, step = fit.cost, fit.step()
            far = np.abs(step) / np.maximum(-poles.real, self.step)
            step = step / np.maximum(1.0, far)
            poles = poles + step
            # a pole across the axis is turned back
            poles = -np.maximum(np.abs(poles.real), 1e-9 * np.abs(poles)) + 1j * poles.imag
            moved = far[self.inside(poles)]
            if turn >= WEIGHING and np.max(moved, initial=0.0) < ENDS:
                break
        return poles

    def estimates(self, poles: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the power of every mode over that of the noise, covariances of poles, and
        residues.
        """
        fit = _Fit(self, poles, _Fit(self, poles, np.ones(len(self.data))).weight())
        return fit.power(), fit.covariances(), fit.residues


class _Fit:
    """Residues, and the linear fit about some poles, in real numbers: each line has two."""

    def __init__(self, band: _Band, poles: np.ndarray, weight: np.ndarray):
        self.poles, self.count = poles, len(poles)
        s = 1j * band.omega[:, None]
        pole_terms, conjugate_terms = 1 / (s - poles), 1 / (s - poles.conj())
        # in units of the half width, for the condition
        unit = np.maximum(-poles.real, band.step)
        parts = [
            (pole_terms + conjugate_terms) * unit,
            1j * (pole_terms - conjugate_terms) * unit,
            band.smooth,
            1j * band.smooth,
        ]
        self.basis = _real(np.hstack(parts))
        self.data = _real((band.data * weight[:, None]).T)
        self.left, upper = np.linalg.qr(self.basis)
        self.inverse = np.linalg.pinv(upper, rcond=1e-12)
        self.solved = self.inverse @ (self.left.T @ self.data)
        self.residual = self.data - self.basis @ self.solved
        self.cost = float(np.sum(self.residual**2))
        #: (part, mode, response): factors of both columns of every mode
        self.parts = self.solved[: 2 * self.count].reshape(2, self.count, -1)
        scaled = (self.parts[0] + 1j * self.parts[1]) * unit[:, None]
        self.residues = (scaled / weight).T
        self.weights = weight
        fall, mirrored = unit * pole_terms**2, unit * conjugate_terms**2
        along = (fall + mirrored, 1j * (fall - mirrored))
        across = (1j * (fall - mirrored), -(fall + mirrored))
        #: (real or imaginary part of the pole, part, mode, line)
        self.slopes = np.array([[self._free(part).T for part in way] for way in (along, across)])

    def _free(self, slopes: np.ndarray) -> np.ndarray:
        """Return slopes without the part that the residues explain."""
        real = _real(slopes)
        return real - self.left @ (self.left.T @ real)

    @property
    def spare(self) -> float:
        """Degrees of freedom of a response that are left for noise."""
        lines, unknowns = self.basis.shape
        return max(lines - unknowns - 2 * self.count / self.data.shape[1], 1.0)

    def weight(self) -> np.ndarray:
        """Return the weight of every response, by the remaining noise."""
        noise = np.sqrt(np.sum(self.residual**2, axis=0) / self.spare) / self.weights
        return 1 / np.maximum(noise, 1e-12 * max(float(noise.max()), 1e-300))

    def step(self) -> np.ndarray:
        """Change of the poles."""
        flat = self.slopes.reshape(4 * self.count, -1)
        gram = (flat @ flat.T).reshape(2 * self.slopes.shape[:3])
        parts = self.parts.reshape(2 * self.count, -1)
        shared = (parts @ parts.T).reshape(2 * self.parts.shape[:2])
        normal = np.einsum("acmbdn,cmdn->ambn", gram, shared).reshape(2 * (2 * self.count,))
        projected = (flat @ self.residual).reshape(*self.slopes.shape[:3], -1)
        right = np.sum(projected * self.parts, axis=(1, 3)).ravel()
        move = np.linalg.lstsq(normal, right, rcond=1e-14)[0]
        return move[: self.count] + 1j * move[self.count :]

    def power(self) -> np.ndarray:
        """Return the power that each mode explains, over the noise of as many unknowns where the
        mode is seen.
        """
        # of the lines about: a pole may fit the noise of one line altogether
        square = np.sum(self.residual.reshape(2, -1, self.residual.shape[1]) ** 2, axis=0) / 2
        noise = np.tile(uniform_filter1d(square, ABOUT, axis=0, mode="nearest"), (2, 1))
        solution = self.inverse @ self.left.T
        out = np.zeros(self.count)
        for k in range(self.count):
            pair = [k, k + self.count]
            spread = np.einsum(
                "il,lo,jl->oij", solution[pair], noise, solution[pair], optimize=True
            )
            solved = np.linalg.solve(spread, self.solved[pair].T[:, :, None])[:, :, 0]
            out[k] = np.sum(self.solved[pair].T * solved)
        return out / (2 * self.data.shape[1] + 2)

    def covariances(self) -> np.ndarray:
        """Return covariances of the real and imaginary part of every pole."""
        gradients = np.einsum("acml,cmo->olam", self.slopes, self.parts, optimize=True)
        gradients = gradients.reshape(*gradients.shape[:2], 2 * self.count)
        rows = gradients.reshape(-1, 2 * self.count)
        bread = np.linalg.pinv(rows.T @ rows)
        lever = np.sum(self.left**2, axis=1)[:, None] + np.einsum(
            "oli,oli->lo", gradients @ bread, gradients
        )
        residual = (self.residual / np.maximum(1 - lever, 0.1)).T.ravel()
        covariance = bread @ ((rows.T * residual**2) @ rows) @ bread
        pairs = [[k, k + self.count] for k in range(self.count)]
        return np.array([covariance[np.ix_(pair, pair)] for pair in pairs])


def _real(values: np.ndarray) -> np.ndarray:
    return np.concatenate([values.real, values.imag])


@dataclass(frozen=True, eq=False)
class ResponseFit:
    """Responses, and their modes."""

    repeats: ClassVar[float] = REPEATS

    responses: Responses
    fit: ModalFit
    shapes: Shapes | None  #: none where the file gives no places of its points

    @classmethod
    def of(cls, responses: Responses) -> ResponseFit:
        """Find the modes of responses over an axis that ascends."""
        hertz = responses.frequencies
        if not np.all(np.isfinite(hertz)) or not np.all(np.diff(hertz) > 0):
            raise SolidgearError("has frequencies of responses that do not ascend")
        # accelerance is a sum over poles and a polynomial; of a displacement rigid motions are not
        missing = 2 - (2 if responses.derivatives is None else responses.derivatives)
        fit = fit_modes(hertz, responses.values * (2j * np.pi * hertz) ** missing)
        return cls(responses, fit, _shapes(responses, fit) if responses.places else None)

    @property
    def widths_hz(self) -> np.ndarray:
        """(n,) standard deviations of frequencies, of noise and of repeatability."""
        return np.hypot(self.fit.deviations[0], self.repeats * self.fit.frequencies)

    def placed(self, placing: Placing) -> ResponseFit:
        """Return the same in the frame of a scene."""
        shapes = self.shapes and self.shapes.placed(placing)
        return replace(self, responses=self.responses.placed(placing), shapes=shapes)

    @property
    def remarks(self) -> Iterator[str]:
        """Sentences on parts of the file that may be meant otherwise, and on missing ones."""
        yield from self.responses.remarks
        if self.responses.places and not self.responses.scaled:
            yield (
                "The file gives no unit of its responses (dataset 164, or labels of axes), so "
                "they are not drawn over computed ones; give it by a TOML file with file = and "
                'response_unit = "m/s^2/N".'
            )


def moving(responses: Responses) -> list[tuple[int, tuple[int, int]]]:
    """Return responses of one shape, each with the point and the direction of it: those to one
    reference, or, where the hammer went round, those at one point.
    """
    fixed = [Counter(responses.references), Counter(responses.points)]
    (reference, count), (point, many) = (ends.most_common(1)[0] for ends in fixed)
    if count >= many:
        selected = [
            (k, end)
            for k, end in enumerate(responses.points)
            if responses.references[k] == reference
        ]
    else:
        selected = [
            (k, end) for k, end in enumerate(responses.references) if responses.points[k] == point
        ]
    return [(k, end) for k, end in selected if 1 <= abs(end[1]) <= 3]


def _shapes(responses: Responses, fit: ModalFit) -> Shapes | None:
    selected = moving(responses)
    if not selected:
        return None
    numbers = sorted({number for _, (number, _) in selected})
    missing = [number for number in numbers if number not in responses.places]
    if missing:
        raise SolidgearError(f"gives no place of point {missing[0]} (dataset 15 or 2411)")
    values = np.zeros((len(fit.poles), len(numbers), 3), complex)
    for k, (number, direction) in selected:
        along = abs(direction) - 1
        values[:, numbers.index(number), along] = np.sign(direction) * fit.residues[:, k]
    places = np.array([responses.places[number] for number in numbers])
    return Shapes(np.array(numbers), places, values, responses.length)
