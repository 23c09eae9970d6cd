"""Numbers as they are written in the terminal, on the page and in the charts."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, TypeGuard

#: for what is not there
DASH = "–"


def is_number(value: Any) -> TypeGuard[float]:
    """Return True for a finite number, and False for a truth value."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def engineering(value: float | None, digits: int = 5) -> str:
    """Return `value` with an exponent that is a multiple of three, such as ``240.05e6``; exact
    zeros are ``0``.
    """
    if not is_number(value):
        return DASH
    if value == 0:
        return "0"
    # rounded first: 999.999 is 1.0000e3, not 1000.0
    value = float(f"{value:.{digits - 1}e}")
    exponent = 3 * (math.floor(math.log10(abs(value)) + 1e-12) // 3)
    mantissa = value / 10.0**exponent
    decimals = max(digits - 1 - math.floor(math.log10(abs(mantissa)) + 1e-12), 0)
    return f"{mantissa:.{decimals}f}" + (f"e{exponent}" if exponent else "")


def percent(value: float | None, signed: bool = True) -> str:
    """Return a fraction in per cent, to a resolution that suits its size."""
    if not is_number(value):
        return DASH
    p = 100 * value
    size = abs(p)
    if size < 1e-6:
        return "0 %" if p == 0 else "<1e-6 %"  # rounding; its figures mean nothing
    if size >= 9.995:
        decimals = 1
    elif size >= 0.0995:
        decimals = 2
    else:
        decimals = 1 - math.floor(math.log10(size))
    sign = "+" if signed else ""
    return f"{p:{sign}.{decimals}f} %"


def bar_of(value: Any) -> str:
    """Return the error bar of a number in per cent, with a sign where it is one-sided."""
    sign = {"above": "+", "below": "-"}.get(value.side, "+- ")
    return f"{sign}{percent(value.bar, signed=False)}"


def hertz(value: float | None) -> str:
    """Return a frequency to five or six figures, without its unit."""
    if not is_number(value):
        return DASH
    return f"{value:.1f}" if abs(value) >= 100 else f"{value:.5g}"


def seconds(value: float | None) -> str:
    """Return a duration in s, to about three figures, without its unit."""
    if not is_number(value):
        return DASH
    if value >= 100:
        return f"{value:.0f}"
    if value >= 10:
        return f"{value:.1f}"
    if value >= 0.01:
        return f"{value:.2f}"
    return f"{value:.1g}"


def count(value: float | None) -> str:
    """Return a large number in a small cell, such as ``94.1k``."""
    if not is_number(value):
        return DASH
    for size, mark in ((1e6, "M"), (1e3, "k")):
        if value >= 9.9995 * size / 10:
            return f"{value / size:.3g}{mark}"
    return f"{value:.0f}"


def plus_minus(bar: float) -> str:
    """Return a two-sided error bar as text."""
    return f"± {bar_percent(bar)}"


def as_text(value: Any) -> str:
    """Return a value as text, where no format is given."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.2f}" if 1000 <= abs(value) < 1e5 else f"{value:.6g}"
    return str(value)


def small(value: float) -> str:
    """Return a residual, to two figures."""
    return f"{value:.2g}"


def whole(value: float) -> str:
    """Return the nearest whole number."""
    return f"{value:.0f}"


def grouped(value: int | None) -> str:
    """Return a count with its thousands apart."""
    return f"{value:,}".replace(",", " ") if is_number(value) else DASH


def short_percent(value: float | None) -> str | None:
    """Return a tolerance in per cent; None where there is none."""
    return f"{100 * value:.4g} %" if is_number(value) else None


def capital(text: str) -> str:
    """Return the text with its first letter large."""
    return text[:1].upper() + text[1:]


def by_plane(names: Iterable[str]) -> str:
    """Return a sentence on bending 1 where modes are named by planes, after a space."""
    from solidgear.core import ModeName  # which brings NumPy

    if not any(ModeName(name).plane for name in names):
        return ""
    return (
        " Bending z and x: in the plane of y and z, or of x and y; bending 1 and 2 without a "
        "plane: the first two of both in order of frequency."
    )


def bar_percent(value: float | None) -> str:
    """Return an error bar in per cent; beyond 100 % only that."""
    if is_number(value) and value > 1:
        return "> 100 %"
    return percent(value, signed=False)
