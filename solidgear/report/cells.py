"""How one number or name stands in a cell of the page: a dash where there is none."""

from __future__ import annotations

from typing import Any

from solidgear.report.words import engineering, is_number, percent

DASH = "–"


def eng(value: Any, digits: int = 5) -> str:
    """With an exponent that is a multiple of three."""
    return engineering(value, digits, DASH)


def pct(value: Any, signed: bool = True) -> str:
    """A fraction in per cent."""
    return percent(value, signed, DASH)


def short_percent(value: Any) -> str | None:
    """A tolerance in per cent; None where there is none."""
    return f"{100 * value:.4g} %" if is_number(value) else None


def mm(value: Any) -> str:
    """A length, m, in mm without its unit."""
    return f"{1e3 * value:.6g}" if is_number(value) else DASH


def small(value: Any) -> str:
    """A residual, to two figures."""
    return f"{value:.2g}" if is_number(value) else DASH


def whole_number(value: Any, separator: str = " ") -> str:
    """A count with its thousands apart."""
    return f"{value:,}".replace(",", separator) if is_number(value) else DASH


def megabytes(value: Any) -> str:
    return f"{value:.0f}" if is_number(value) else DASH


def capital(text: str) -> str:
    """The same text, its first letter large."""
    return text[:1].upper() + text[1:]
