"""Least-squares identification of what a source does not publish, from the frequencies it does.

The results are `identified`, never `published`: every quantity carries its bounds, whether it rests
on one of them, how strongly each frequency depends on it, and how well the frequencies fix it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares

# A quantity this close to a bound, as a fraction of the way between the bounds, rests on it.
ON_BOUND = 1e-3
# Central differences of frequencies that are good to about 1e-13: 1e-5 of the way balances rounding
# and curvature.
STEP = 1e-5


@dataclass(frozen=True)
class Unknown:
    """A quantity to be identified.

    Attributes
    ----------
    name : str
    lower, upper : float
        Bounds, SI.
    unit : str
    log : bool
        Search on a logarithmic scale, for positive quantities whose order of magnitude is in doubt.
    """

    name: str
    lower: float
    upper: float
    unit: str = ""
    log: bool = True

    def at(self, t: float) -> float:
        """Value at the fraction `t` of the way between the bounds."""
        if self.log:
            return float(self.lower * (self.upper / self.lower) ** t)
        return float(self.lower + t * (self.upper - self.lower))

    def slope(self, t: float) -> float:
        """Derivative of :meth:`at` by `t`."""
        return (
            self.at(t) * float(np.log(self.upper / self.lower))
            if self.log
            else self.upper - self.lower
        )


@dataclass(frozen=True, eq=False)
class Identified:
    """An identified quantity.

    Attributes
    ----------
    name, unit : str
    value, lower, upper : float
    on_bound : {"", "lower", "upper"}
        Not empty where the data pull the quantity out of its bounds: then the value is the bound's,
        not the data's.
    sensitivity : (n,) ndarray
        ``d ln f_j / d ln p``.
    spread : float
        Relative standard deviation of the value if the misfit of the frequencies is taken as
        independent noise; inf where they do not fix it. The misfit is mostly systematic, so this is
        a scale and not a confidence interval.
    """

    name: str
    unit: str
    value: float
    lower: float
    upper: float
    on_bound: str
    sensitivity: np.ndarray
    spread: float


@dataclass(frozen=True, eq=False)
class Identification:
    """Result of `identify`.

    Attributes
    ----------
    quantities : tuple of Identified
    frequency_hz, published_hz : (n,) ndarray
    starts, agreeing : int
        Starting points, and how many of them ended at a cost within 1 % of the best.
    condition : float
        Condition number of the matrix of sensitivities; far above 1e3 means that combinations of
        the quantities are free.
    """

    quantities: tuple[Identified, ...]
    frequency_hz: np.ndarray
    published_hz: np.ndarray
    starts: int
    agreeing: int
    condition: float

    @property
    def error(self) -> np.ndarray:
        """(n,) relative to the published frequencies."""
        return self.frequency_hz / self.published_hz - 1

    @property
    def worst(self) -> int:
        """Index of the frequency with the largest relative error."""
        return int(np.argmax(np.abs(self.error)))

    @property
    def rms(self) -> float:
        """Root mean square of the relative errors."""
        return float(np.sqrt(np.mean(self.error**2)))

    @property
    def values(self) -> dict[str, float]:
        """Identified values by name."""
        return {q.name: q.value for q in self.quantities}

    @property
    def on_bounds(self) -> tuple[str, ...]:
        """Names of the quantities that rest on a bound."""
        return tuple(q.name for q in self.quantities if q.on_bound)


def identify(
    model: Callable[[dict[str, float]], np.ndarray],
    unknowns: Sequence[Unknown],
    published_hz: ArrayLike,
    starts: int = 8,
    seed: int = 0,
) -> Identification:
    """Bounded least squares on the logarithms of frequencies, from several starting points.

    Parameters
    ----------
    model : callable
        Natural frequencies, Hz, in the order of `published_hz`, from a dict of the unknowns by
        name.
    published_hz : (n,) array_like
        Positive; leave out zero frequencies, which hold no information.
    starts : int
        The middle of the bounds and ``starts - 1`` seeded random points.

    Notes
    -----
    Frequencies are compared in ascending order, without mode shapes: where two modes of the model
    cross, each published frequency is met by whichever is next.

    Examples
    --------
    The spring under a mass of 2 kg that swings at 10 Hz:

    >>> def model(p):
    ...     return np.array([np.sqrt(p["k"] / 2.0) / (2 * np.pi)])
    >>> found = identify(model, [Unknown("k", 1e2, 1e6, "N/m")], [10.0], starts=2)
    >>> bool(np.isclose(found.values["k"], 2.0 * (2 * np.pi * 10.0) ** 2))
    True
    """
    unknowns = tuple(unknowns)
    published = np.asarray(published_hz, float)

    def log_ratio(t):
        found = np.asarray(model({u.name: u.at(x) for u, x in zip(unknowns, t)}), float)
        return np.log(found / published)

    rng = np.random.default_rng(seed)
    points = [
        np.full(len(unknowns), 0.5),
        *rng.uniform(0.1, 0.9, (starts - 1, len(unknowns))),
    ]
    found = [
        least_squares(
            log_ratio,
            p,
            bounds=(0.0, 1.0),
            x_scale=0.1,
            xtol=1e-12,
            ftol=1e-12,
            gtol=1e-12,
            max_nfev=200,
        )
        for p in points
    ]
    best = min(found, key=lambda s: s.cost)
    # An exact fit leaves costs of rounding size, which differ by large factors: those agree as
    # well.
    agreeing = sum(s.cost <= 1.01 * best.cost + 1e-18 for s in found)
    return _report(log_ratio, unknowns, best.x, published, starts, agreeing)


def _report(log_ratio, unknowns, t, published, starts, agreeing) -> Identification:
    ratio = log_ratio(t)
    slope = np.empty((published.size, len(unknowns)))
    for k in range(len(unknowns)):
        step = np.zeros(len(unknowns))
        step[k] = STEP
        slope[:, k] = (log_ratio(t + step) - log_ratio(t - step)) / (2 * STEP)
    quantities = []
    per_value = slope / np.array([u.slope(x) for u, x in zip(unknowns, t)])
    values = np.array([u.at(x) for u, x in zip(unknowns, t)])
    singular = np.linalg.svd(slope, compute_uv=False)
    condition = float(singular[0] / singular[-1]) if singular[-1] > 0 else np.inf
    freedom = max(published.size - len(unknowns), 1)
    noise = float(ratio @ ratio) / freedom
    # Beyond this the inverse of the normal matrix is rounding.
    covariance = (
        noise * np.linalg.inv(per_value.T @ per_value)
        if condition < 1e6
        else np.full((len(unknowns),) * 2, np.inf)
    )
    for k, (u, x) in enumerate(zip(unknowns, t)):
        side = ""
        if x < ON_BOUND:
            side = "lower"
        elif x > 1 - ON_BOUND:
            side = "upper"
        spread = float(np.sqrt(covariance[k, k]) / abs(values[k])) if values[k] else np.inf
        quantities.append(
            Identified(
                u.name,
                u.unit,
                float(values[k]),
                u.lower,
                u.upper,
                side,
                per_value[:, k] * values[k],
                spread,
            )
        )
    return Identification(
        tuple(quantities), published * np.exp(ratio), published, starts, agreeing, condition
    )
