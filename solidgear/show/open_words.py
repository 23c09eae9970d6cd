"""Words and tables of what the data of a scene leave open: beside a bar, and by every input."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from solidgear.core.judge.open_record import IntervalRecord, OpenNumbers, OpenRecord
from solidgear.core.judge.quantities import JUDGED
from solidgear.core.quantity import K_ZZ, Quantity
from solidgear.show.table import Column, Table, text
from solidgear.show.units import Units
from solidgear.show.words import percent, short_percent

#: changes below this are none; a bar of a mesh is seldom as narrow
NOTHING = 5e-5
#: numbers that are told unless others are asked for
SHOWN = (*JUDGED, K_ZZ)
ALL = "in all"
#: share of itself by which a sampled deviation must differ before inputs are said to act on one
#: another, where that many samples can tell
RESOLVED = 0.05


def interval(one: IntervalRecord | None) -> str:
    """A range in per cent: ``-35 / +10 %``, or ``± 1.5 %`` of one that is as wide to both sides."""
    low, high = (one.low or 0.0, one.high or 0.0) if one else (0.0, 0.0)
    if max(-low, high) < NOTHING:
        return "0"
    if abs(high + low) < 0.02 * (high - low):
        return f"± {_figures(max(-low, high))} %"
    return f"-{_figures(-low)} / +{_figures(high)} %".replace("-0 /", "0 /").replace(
        "/ +0 ", "/ 0 "
    )


def _figures(share: float) -> str:
    """A share in per cent to two or three figures."""
    size = 100 * share
    if size < 100 * NOTHING:
        return "0"
    return f"{size:.0f}" if size >= 9.95 else f"{size:.1f}" if size >= 0.95 else f"{size:.2g}"


def parts(found: OpenNumbers, quantity: str) -> list[tuple[str, str]]:
    """Sources that leave a number open, and its range: each, and all if there are several."""
    one = found.of(quantity)
    if one is None:
        return []
    told = [(source, interval(part)) for source, part in one.by_source.items()]
    return told if len(told) < 2 else [*told, (ALL, interval(one.total))]


def columns(found: OpenNumbers, name: Callable[[Any], str]) -> list[Column]:
    """Columns that stand beside that of a bar; `name` tells the quantity of an item."""
    heads = list(
        dict.fromkeys(head for one in found.numbers for head, _ in parts(found, one.quantity))
    )
    return [
        Column(head, lambda item, head=head: dict(parts(found, name(item))).get(head))  # type: ignore[misc]
        for head in heads
    ]


def remark(found: OpenNumbers) -> str:
    """Sentence below numbers with ranges, with where they come from; empty where nothing is open."""
    if found.left_out:
        return f"Not told, what the data leave open: {found.left_out}."
    if not found.inputs:
        return ""
    lost = [f" Bearing {name} carries nothing somewhere in them." for name in found.lost]
    refused = [f" Left out of them: {reason}." for reason in found.refused]
    named = ", ".join(one.path for one in found.inputs)
    sources = ", ".join(dict.fromkeys(one.source for one in found.inputs))
    return f"Ranges of {sources}: from {named}. See: solidgear budget.{''.join(lost + refused)}"


def table(found: OpenNumbers, bars: dict[Quantity, float], units: Units) -> Table:
    """Diagonal entries of a stiffness and a compliance, each with its bar and its ranges."""
    rows = [one for one in found.numbers if not one.quantity.is_coupling]
    own = [text("quantity", lambda one: one.quantity)]
    own += [Column("value", lambda one: units.number(one.value, one.quantity.unit, 4))]
    own += [text("unit", lambda one: units.unit(one.quantity.unit))]

    def bar(one: OpenRecord) -> str | None:
        found = bars.get(one.quantity)
        return None if found is None else f"+- {percent(found, signed=False)}"

    if bars:
        own.append(Column("mesh bar", bar))
    return Table("", [*own, *columns(found, lambda one: one.quantity)], rows, remark(found))


def budget(found: OpenNumbers, asked: Iterable[str] = ()) -> Table:
    """Contribution of every input to every number that is asked for, the largest first."""
    chosen = [one for name in (tuple(asked) or SHOWN) if (one := found.of(name)) is not None]
    rows: list[tuple[str, ...]] = []
    for one in chosen:
        said = {i.path: i.said for i in found.inputs}
        shares = one.shares or dict.fromkeys(one.by_input, None)
        for k, (path, share) in enumerate(shares.items()):
            whole = "" if share is None else f"{100 * share:.0f} %"
            rows.append(
                (
                    one.quantity if not k else "",
                    path,
                    said[path],
                    interval(one.by_input[path]),
                    whole,
                )
            )
        rows.append(("", ALL, _sampled(one, found), interval(one.total), ""))
    heads = ("number", "open input", "its range", "number by it", "share")
    return Table(
        "",
        [text(head) if k < 3 else Column(head) for k, head in enumerate(heads)],
        rows,
        " ".join([*_notes(found, chosen)]),
    )


def _sampled(one: OpenRecord, found: OpenNumbers) -> str:
    """Words on the deviation of all inputs, and on samples where there are any."""
    told = [] if one.total.deviation is None else [f"s {short(one.total.deviation)}"]
    if one.sampled is not None:
        told.append(f"samples {interval(one.sampled)}, s {short(one.sampled.deviation)}")
    return "; ".join(told)


def short(share: float | None) -> str:
    """A deviation in per cent, to three figures."""
    return short_percent(float(f"{share:.3g}")) or "" if share is not None else ""


def acting(found: OpenNumbers, chosen: Iterable[OpenRecord]) -> list[OpenRecord]:
    """Numbers whose samples scatter otherwise than the inputs one by one: beyond three standard
    errors of a deviation, and by a part that matters.
    """
    wide = max(RESOLVED, 3 / (2 * max(found.samples, 1)) ** 0.5)
    out = []
    for one in chosen:
        alone, sampled = one.total.deviation, one.sampled and one.sampled.deviation
        if alone and sampled and sampled > NOTHING and abs(sampled / alone - 1) > wide:
            out.append(one)
    return out


def _notes(found: OpenNumbers, chosen: list[OpenRecord]) -> Iterable[str]:
    if not chosen:
        return
    yield (
        f"Ranges over {found.points} points of the {found.title}, relative to its numbers "
        "with all inputs as the scene says. Share: of variance, each input equally likely anywhere in "
        "its range, by itself; s: root of the sum of squares."
    )
    if found.samples:
        yield f"Samples: {found.samples} of all inputs together, seed {found.seed}."
        names = [str(one.quantity) for one in acting(found, chosen)]
        if names:
            yield f"Inputs act on one another in {', '.join(names)}: there samples hold, not s."
        else:
            yield "They scatter as the inputs one by one do: none acts much on another."
    for name in found.lost:
        yield f"Bearing {name} carries nothing somewhere in the ranges."
    for reason in found.refused:
        yield f"Left out: {reason}."
