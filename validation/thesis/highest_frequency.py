"""Whether a published highest frequency can belong to published stiffnesses and masses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.errors import SolidgearError


@dataclass(frozen=True)
class Consistency:
    """Verdict on a published highest frequency; its text is a sentence.

    Attributes
    ----------
    consistent : bool
    bound_hz : float
        The highest natural frequency cannot be lower than this.
    published_hz : float
    dof : int
        Place of the diagonal entry that sets the bound.
    needed_mass : float
        Smallest mass (or inertia) there with which the published frequency becomes possible, kg or
        kg m^2.
    """

    consistent: bool
    bound_hz: float
    published_hz: float
    dof: int
    needed_mass: float

    def __str__(self) -> str:
        if self.consistent:
            verdict, unless = "possible", ""
        else:
            verdict = "impossible"
            unless = (
                f", unless the mass of degree of freedom {self.dof + 1} "
                f"is {self.needed_mass:.4g} or more"
            )
        return (
            f"{self.published_hz:.1f} Hz is {verdict}: "
            f"the highest frequency is at least {self.bound_hz:.1f} Hz{unless}"
        )


def rayleigh_bound(stiffness, mass) -> float:
    """Lower bound of the highest natural frequency.

    Rayleigh's quotient of a unit vector is ``K_ii / M_ii``, and no quotient exceeds the highest
    eigenvalue.

    Parameters
    ----------
    stiffness, mass : (n, n) array_like
        Symmetric, SI; only the diagonals enter.  Springs left out can only raise the highest
        frequency.

    Returns
    -------
    float
        Hz.

    Raises
    ------
    SolidgearError
        As :func:`consistency`.

    Examples
    --------
    >>> int(rayleigh_bound([[1.585e10]], [[14.72]]))  # the straddled pinion of Hua (2010)
    5222
    """
    return consistency(
        np.diag(np.asarray(stiffness, float)), np.diag(np.asarray(mass, float)), 0.0
    ).bound_hz


def consistency(stiffness_diagonal, mass_diagonal, highest_hz: float) -> Consistency:
    """Whether a published highest frequency can belong to published stiffnesses and masses.

    Parameters
    ----------
    stiffness_diagonal, mass_diagonal : (n,) array_like
        SI; stiffnesses may leave out the mesh, which only raises the bound.
    highest_hz : float
        Highest published frequency of the whole model, Hz.

    Returns
    -------
    Consistency

    Raises
    ------
    SolidgearError
        For diagonals of different lengths, masses that are not positive, or a frequency that is not
        finite.

    Examples
    --------
    >>> print(consistency([1.585e10], [14.72], 4139.6).consistent)
    False
    """
    k, m = np.asarray(stiffness_diagonal, float), np.asarray(mass_diagonal, float)
    if k.shape != m.shape or k.ndim != 1 or k.size == 0:
        raise SolidgearError(
            f"stiffness and mass diagonals need the same length, "
            f"but have shapes {k.shape} and {m.shape}"
        )
    if not (np.isfinite(k).all() and np.isfinite(m).all() and (m > 0).all()):
        raise SolidgearError(
            "stiffness and mass diagonals must be finite, and every mass and inertia positive"
        )
    if not (np.isfinite(highest_hz) and highest_hz >= 0):
        raise SolidgearError(
            f"the highest published frequency is {highest_hz}; "
            "it must be a finite number of Hz, not negative"
        )
    worst = int(np.argmax(k / m))
    bound = float(np.sqrt(max(k[worst], 0.0) / m[worst]) / (2 * np.pi))
    needed = float(k[worst] / (2 * np.pi * highest_hz) ** 2) if highest_hz > 0 else np.inf
    return Consistency(bool(highest_hz >= bound), bound, float(highest_hz), worst, needed)
