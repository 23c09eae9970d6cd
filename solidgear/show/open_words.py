"""Words and tables of what the data of a scene leave open: beside a bar, and by every input."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from solidgear.core import OpenNumbers, Quantity
from solidgear.core.judge.open_numbers import IntervalRecord, OpenRecord
from solidgear.core.judge.quantities import JUDGED
from solidgear.core.quantity import K_ZZ
from solidgear.show.table import Cell, Column, Table, text
from solidgear.show.units import Units
from solidgear.show.words import percent, short_percent

#: changes below this are none; a bar of a mesh is seldom as narrow
NOTHING = 5e-5
#: numbers that are told unless others are asked for
SHOWN = (*JUDGED, K_ZZ)
ALL = "in all"
#: share of what is open in a number that one bearing leads, and the least range worth a sentence
LEADS, WORTH = 0.8, 0.01
#: share of itself by which a sampled deviation must differ before inputs are said to act on one
#: another, where that many samples can tell
RESOLVED = 0.05


def interval(range_: IntervalRecord | None) -> str:
    """Return a range in per cent: ``-35 / +10 %``, or ``± 1.5 %`` for a symmetric one."""
    return between(range_.low or 0.0, range_.high or 0.0) if range_ else "0"


def between(low: float, high: float) -> str:
    """Return a range from its ends, relative, as :func:`interval`."""
    if max(-low, high) < NOTHING:
        return "0"
    if abs(high + low) < 0.02 * (high - low):
        return f"± {_figures(max(-low, high))} %"
    return f"-{_figures(-low)} / +{_figures(high)} %".replace("-0 /", "0 /").replace(
        "/ +0 ", "/ 0 "
    )


def _figures(share: float) -> str:
    """Return a share in per cent to two or three figures."""
    size = 100 * share
    if size < 100 * NOTHING:
        return "0"
    return f"{size:.0f}" if size >= 9.95 else f"{size:.1f}" if size >= 0.95 else f"{size:.2g}"


def parts(numbers: OpenNumbers, quantity: str) -> list[tuple[str, str]]:
    """Return sources of a number's range with the range by each, and by all if there are several."""
    number = numbers.of(quantity)
    if number is None:
        return []
    ranges = [(source, interval(part)) for source, part in number.by_source.items()]
    return ranges if len(ranges) < 2 else [*ranges, (ALL, interval(number.total))]


def columns(numbers: OpenNumbers, name: Callable[[Any], str]) -> list[Column]:
    """Return columns of ranges beside an error bar; `name` gives the quantity of an item."""
    heads = list(
        dict.fromkeys(
            head for number in numbers.numbers for head, _ in parts(numbers, number.quantity)
        )
    )
    return [
        Column(head, lambda item, head=head: dict(parts(numbers, name(item))).get(head))  # type: ignore[misc]
        for head in heads
    ]


def leading(numbers: OpenNumbers, names: Iterable[str] = ()) -> str:
    """Return the sentence on the one bearing whose inside leaves most of what is open in the widest of
    the numbers that are shown; empty where there is none.
    """
    chosen = (numbers.of(name) for name in (tuple(names) or SHOWN))
    wide = [(_wide(number), number) for number in chosen if number is not None]
    width, number = max(wide, key=lambda pair: pair[0], default=(0.0, None))
    if number is None or width < WORTH:
        return ""
    path, share = next(iter(number.width_shares.items()), ("", 0.0))
    of = next((entry.of for entry in numbers.inputs if entry.path == path), "")
    return led_by(of, share, number.quantity) if of and share >= LEADS else ""


def _wide(number: OpenRecord) -> float:
    """Return the width of the range of a number by all that is open."""
    return (number.total.high or 0.0) - (number.total.low or 0.0)


def led_by(bearing: str, share: float, number: str) -> str:
    """Return the sentence on a bearing that leaves a share of what is open in a number."""
    whole = min(99, round(100 * share)) if share < 1 else 100
    return (
        f"{whole} % of what is open in {number} comes from the inside of {bearing}: its maker knows "
        "it, and solidgear budget lists what to ask."
    )


def remark(numbers: OpenNumbers, names: Iterable[str] = ()) -> str:
    """Return the sentences on where ranges come from, and on a bearing that leads in the numbers of
    some names, by default those that are judged; empty where nothing is open.
    """
    if numbers.left_out:
        return f"The range by open data is not known: {numbers.left_out}."
    if not numbers.inputs:
        return ""
    lost = [f" Bearing {name} carries no load somewhere in them." for name in numbers.lost]
    refused = [f" Not included: {reason}." for reason in numbers.refused]
    paths = ", ".join(entry.path for entry in numbers.inputs)
    sources = ", ".join(dict.fromkeys(entry.source for entry in numbers.inputs))
    led = leading(numbers, names)
    more = f" {led}" if led else " See: solidgear budget."
    return f"Ranges of {sources}: from {paths}.{more}{''.join(lost + refused)}"


def table(numbers: OpenNumbers, bars: Mapping[Quantity, float], units: Units) -> Table:
    """Return diagonal entries of a stiffness and a compliance, with error bars and ranges."""
    rows = [number for number in numbers.numbers if not number.quantity.is_coupling]
    columns_ = [text("quantity", lambda number: number.quantity)]
    columns_ += [
        Column("value", lambda number: units.number(number.value, number.quantity.unit, 4))
    ]
    columns_ += [text("unit", lambda number: units.unit(number.quantity.unit))]

    def bar(number: OpenRecord) -> str | None:
        numbers = bars.get(number.quantity)
        return None if numbers is None else f"+- {percent(numbers, signed=False)}"

    if bars:
        columns_.append(Column("error bar", bar))
    return Table(
        "", [*columns_, *columns(numbers, lambda number: number.quantity)], rows, remark(numbers)
    )


def budget(numbers: OpenNumbers, names: Iterable[str] = ()) -> Table:
    """Return the contribution of every input to every number asked for, the largest first."""
    chosen = [
        number for name in (tuple(names) or SHOWN) if (number := numbers.of(name)) is not None
    ]
    rows: list[tuple[Any, ...]] = []
    for number in chosen:
        ranges = {i.path: i.said for i in numbers.inputs}
        shares = number.shares or dict.fromkeys(number.by_input, None)
        for k, (path, share) in enumerate(shares.items()):
            whole = "" if share is None else f"{100 * share:.0f} %"
            quantity = Cell(number.quantity, "", "" if k else number.quantity)
            words = quantity, path, ranges[path]
            rows.append((*words, *_ends(number.by_input[path]), Cell(share, "", whole)))
        words = Cell(number.quantity, "", ""), ALL, _sampled(number, numbers)
        rows.append((*words, *_ends(number.total), Cell(None, "", "")))
    columns = [
        *map(text, ("number", "open input", "its range")),
        Column("number by it", name="low", unit="1"),
        *(Column(head, unit="1", hidden=True) for head in ("high", "deviation")),
        Column("share", unit="1"),
    ]
    return Table("", columns, rows, " ".join([*_notes(numbers, chosen)]), name="budget")


def _ends(part: IntervalRecord) -> tuple[Cell, float | None, float | None]:
    """Return the lower end of a range, shown with the upper one, that one, and the deviation."""
    return Cell(part.low, "", interval(part)), part.high, part.deviation


def _sampled(number: OpenRecord, numbers: OpenNumbers) -> str:
    """Return words on the deviation of all inputs, and on samples where there are any."""
    parts_ = [] if number.total.deviation is None else [f"s {short(number.total.deviation)}"]
    if number.sampled is not None:
        parts_.append(f"samples {interval(number.sampled)}, s {short(number.sampled.deviation)}")
    return "; ".join(parts_)


def short(share: float | None) -> str:
    """Return a deviation in per cent, to three figures."""
    return short_percent(float(f"{share:.3g}")) or "" if share is not None else ""


def acting(numbers: OpenNumbers, chosen: Iterable[OpenRecord]) -> list[OpenRecord]:
    """Return numbers whose samples scatter differently from the sum of single inputs."""
    wide = max(RESOLVED, 3 / (2 * max(numbers.samples, 1)) ** 0.5)
    out = []
    for number in chosen:
        alone, sampled = number.total.deviation, number.sampled and number.sampled.deviation
        if alone and sampled and sampled > NOTHING and abs(sampled / alone - 1) > wide:
            out.append(number)
    return out


def _notes(numbers: OpenNumbers, chosen: list[OpenRecord]) -> Iterable[str]:
    if not chosen:
        return
    yield (
        f"Ranges over {numbers.points} points of the {numbers.title}, relative to its numbers as the "
        "scene is. Share: of variance, each input uniform in its range, by itself; s: root of the "
        "sum of squares."
    )
    if numbers.samples:
        yield f"Samples: {numbers.samples} of all inputs together, seed {numbers.seed}."
        names = [str(number.quantity) for number in acting(numbers, chosen)]
        if names:
            yield f"Inputs interact in {', '.join(names)}: there take the samples and not s."
        else:
            yield "They scatter as s says: inputs hardly interact."
    for name in numbers.lost:
        yield f"Bearing {name} carries no load somewhere in the ranges."
    for reason in numbers.refused:
        yield f"Not included: {reason}."
