"""Checks of matrices and numbers that users give, each refused in one sentence."""

from __future__ import annotations

from typing import Any

import numpy as np

from solidgear.core.errors import SolidgearError

#: Asymmetry and negative eigenvalues below this, relative, are rounding of typed numbers.
ROUNDING = 1e-9


def frozen(name: str, value: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Return a read-only array of finite numbers of that shape, or refuse the value by name."""
    try:
        out = np.array(value, float)
    except (TypeError, ValueError):
        raise SolidgearError(f"{name} must be numbers in SI, not {value!r}") from None
    if out.shape != shape:
        raise SolidgearError(f"{name} has shape {out.shape}; it must be {shape}")
    if not np.isfinite(out).all():
        raise SolidgearError(f"{name} contains NaN or infinity; all entries must be finite")
    out.setflags(write=False)
    return out


def spd(name: str, value: Any, definite: bool = True) -> np.ndarray:
    """Return a read-only 6x6 that is symmetric and positive definite, or semidefinite, judged
    relative to the diagonal, since rows mix N/m with N m/rad.
    """
    out = np.array(frozen(name, value, (6, 6)))
    d = np.diag(out)
    if (d < 0).any() or (definite and (d == 0).any()):
        low = "positive" if definite else "not negative"
        raise SolidgearError(f"{name} has {d.min():g} on its diagonal; entries there must be {low}")
    size = np.sqrt(np.where(d > 0, d, 1.0))
    scaled = out / np.outer(size, size)
    if (np.abs(scaled - scaled.T) > ROUNDING * np.maximum(1.0, np.abs(scaled))).any():
        raise SolidgearError(f"{name} is not symmetric; entry (i, j) must equal (j, i)")
    least = np.linalg.eigvalsh((scaled + scaled.T) / 2)[0]
    allowed = ROUNDING if definite else -ROUNDING
    if least < allowed:
        kind = "definite" if definite else "semidefinite"
        raise SolidgearError(
            f"{name} is not positive {kind}; "
            "its off-diagonal entries are too large for its diagonal"
        )
    out = (out + out.T) / 2
    out.setflags(write=False)
    return out


def not_negative(name: str, value: Any) -> float:
    """Return a finite number that is not negative, or refuse it by name."""
    number = _number(value)
    if not (np.isfinite(number) and number >= 0):
        raise SolidgearError(f"{name} is {value}; it must be finite and not negative")
    return number


def positive(name: str, value: Any) -> float:
    """Return a finite number above zero, or refuse it by name."""
    number = _number(value)
    if not (np.isfinite(number) and number > 0):
        raise SolidgearError(f"{name} is {value}; it must be finite and positive")
    return number


def _number(value: Any) -> float:
    """Return a scalar as it is, anything else as NaN."""
    try:
        return float(value)
    except (TypeError, ValueError):
        return np.nan
