"""Figures and words that the terminal, the page and the charts share.

How a number, a model and a verdict are written, and what is read out of the results of a run.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, TypeGuard

from solidgear.fidelity.ladder import LADDER
from solidgear.fidelity.rung import BEAM

#: kind -> unit of the blocks (translation, translation), (mixed), (rotation, rotation)
BLOCK_UNITS = {
    "stiffness": ("N/m", "N/rad", "N m/rad"),
    "compliance": ("m/N", "rad/N", "rad/(N m)"),
}
NOTHING = "-"


def plain(value: Any) -> Any:
    """The same data as dicts, lists, texts and finite numbers; NaN and infinities become None.

    Everything in the report reads its input through this, so that a result straight from numpy and
    one read back from JSON give the same page.
    """
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def is_number(value: Any) -> TypeGuard[float]:
    """Whether `value` is a finite number (a truth value is none)."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def engineering(value: float | None, digits: int = 5, nothing: str = NOTHING) -> str:
    """`value` with an exponent that is a multiple of three, such as ``240.05e6``; exact zeros are
    ``0``.
    """
    if not is_number(value):
        return nothing
    if value == 0:
        return "0"
    # rounded first: 999.999 is 1.0000e3, not 1000.0
    value = float(f"{value:.{digits - 1}e}")
    exponent = 3 * (math.floor(math.log10(abs(value)) + 1e-12) // 3)
    mantissa = value / 10.0**exponent
    decimals = max(digits - 1 - math.floor(math.log10(abs(mantissa)) + 1e-12), 0)
    return f"{mantissa:.{decimals}f}" + (f"e{exponent}" if exponent else "")


def percent(value: float | None, signed: bool = True, nothing: str = NOTHING) -> str:
    """A fraction in per cent, to a resolution that suits its size."""
    if not is_number(value):
        return nothing
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


def hertz(value: float | None, nothing: str = NOTHING) -> str:
    """A frequency to five or six figures, without its unit."""
    if not is_number(value):
        return nothing
    return f"{value:.1f}" if abs(value) >= 100 else f"{value:.5g}"


def seconds(value: float | None, nothing: str = NOTHING) -> str:
    """A duration in s, to about three figures, without its unit."""
    if not is_number(value):
        return nothing
    if value >= 100:
        return f"{value:.0f}"
    if value >= 10:
        return f"{value:.1f}"
    if value >= 0.01:
        return f"{value:.2f}"
    return f"{value:.1g}"


def count(value: float | None, nothing: str = NOTHING) -> str:
    """A large number in a small cell, such as ``94.1k``."""
    if not is_number(value):
        return nothing
    for size, mark in ((1e6, "M"), (1e3, "k")):
        if value >= 9.9995 * size / 10:
            return f"{value / size:.3g}{mark}"
    return f"{value:.0f}"


def model_name(key: str | None) -> str:
    """The name of a model in a sentence; an unknown key stays itself."""
    return LADDER[key].title if key and key in LADDER else str(key or NOTHING)


def heading(key: str) -> str:
    """The name of a model at the head of a narrow column."""
    return LADDER[key].heading if key in LADDER else key


def is_beam(key: str) -> bool:
    """Whether a model is a beam."""
    return key in LADDER.of(BEAM)


def entry(model: Mapping, kind: str, i: int, j: int) -> float | None:
    """One entry of a model's 'stiffness' or 'compliance'; None if there is none."""
    try:
        value = model[kind][i][j]
    except (KeyError, IndexError, TypeError):
        return None
    return value if is_number(value) else None


def first_mode(model: Mapping, family: str) -> dict | None:
    """The lowest elastic mode of a family ('bending', 'axial', 'torsion'), or None."""
    for mode in model.get("modes") or ():
        name = str(mode.get("name", ""))
        of_family = mode.get("family") == family or name.startswith(family)
        elastic = not name.startswith("rigid")
        if of_family and elastic and is_number(mode.get("frequency_hz")):
            return mode
    return None


def quantity_key(quantity: str) -> str:
    """One spelling for a quantity: ``bending_1``, ``f_bending_1_hz`` and ``bending 1`` are the
    same.
    """
    text = str(quantity).lower().replace("_", " ").removesuffix(" hz").strip()
    return "bending 1" if text in ("f bending 1", "f1") else text


def headline(results: Mapping, model: str, quantity: str) -> dict | None:
    """The deviation that stands for a model where there is room for one.

    A beam has no seat surface: its fair partner is the solid with section ties ('section'). A solid
    is compared as the scene has it.
    """
    key = quantity_key(quantity)
    of_model = [r for r in results.get("deviations") or () if r.get("model") == model]
    rows = [r for r in of_model if quantity_key(r.get("quantity", "")) == key]
    wanted = "section" if is_beam(model) else "as scene"
    for row in rows:
        if row.get("attachment") == wanted:
            return row
    return rows[0] if rows else None


def is_resolved(row: Mapping) -> bool:
    """Whether a deviation may be read as one: False only where it lies inside the bands of the
    models compared.
    """
    verdict = row.get("verdict")
    if verdict is not None:
        return verdict != "not resolved"
    return not (
        is_number(row.get("band"))
        and is_number(row.get("relative"))
        and abs(row["relative"]) <= row["band"]
    )


def answer_seconds(model: Mapping) -> float | None:
    """What an answer costs: building and solving. Bands and variants are evidence on top, and in
    the total only.
    """
    times = model.get("seconds") or {}
    stages = [times.get(s) for s in ("build", "statics", "modes")]
    known = [s for s in stages if is_number(s)]
    return sum(known) if len(known) == len(stages) else times.get("total")


def validity(model: Mapping) -> str:
    """``yes``, ``no``, ``open`` (not judged, or not to be told) or ``unknown`` where the record
    says nothing.
    """
    if model.get("valid") is True:
        return "yes"
    if model.get("open"):
        return "open"
    return "no" if model.get("valid") is False else "unknown"


def band_percent(value: float | None, nothing: str = NOTHING) -> str:
    """A band in per cent; one beyond 100 % says nothing but that."""
    if is_number(value) and value > 1:
        return "> 100 %"
    return percent(value, signed=False, nothing=nothing)


def reference_of(results: Mapping) -> str | None:
    """The key of the model that the others are measured against."""
    verdict, mac = results.get("verdict") or {}, results.get("mac") or {}
    return verdict.get("reference") or mac.get("reference")
