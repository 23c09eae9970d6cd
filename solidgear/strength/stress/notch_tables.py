"""Tables and sentences on all notches of a shaft: features of the drawing, safeties, ratings."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

from solidgear.core import listed
from solidgear.show.table import Cell, Column, Table, quantity, text, word
from solidgear.show.units import ENGINEERING, Units, plain
from solidgear.strength.stress.at_rest import StressAtRest, StressedShaft, lesser_elsewhere
from solidgear.strength.stress.cases import CaseStress
from solidgear.strength.stress.din743 import LOADS
from solidgear.strength.stress.drawn import DrawnStress
from solidgear.strength.stress.rating import Kind, Rating
from solidgear.strength.stress.rating_lines import ASSUMED, Entry
from solidgear.strength.stress.shaft import Notch, ShaftStress

#: SI unit of a stress in tables
STRESS = "Pa stressed"
#: what a safety is against
KIND_WORDS: dict[Kind, str] = {
    "fatigue": "against fatigue",
    "yielding": "against yielding",
    "crack": "against a first crack",
}
#: safety that DIN 743 asks for where loads and strength are sure
LEAST = 1.2
#: share of a value that is left open from which on it is told
LITTLE = 1e-3


def drawn_notches(stress: ShaftStress, units: Units = ENGINEERING) -> Table:
    """Return the features of the drawing that DIN 743 rates, each where it is worst."""
    stresses = [
        Column(head, write=partial(units.number, si=STRESS, digits=4), unit="Pa")
        for head in ("sigma_N", "sigma_b", "tau_t")
    ]
    factors = [Column(head, write=_factor) for head in ("Kf bending", "Kf torsion")]
    columns = [text("notch"), word("kind"), quantity("y", "m", units)]
    columns += [quantity("d", "m", units, digits=4), *stresses, *factors]
    rows = [
        [
            drawn.name,
            drawn.kind,
            drawn.y,
            drawn.section.outer,
            drawn.nominal.tension,
            drawn.nominal.bending,
            drawn.nominal.torsion,
            drawn.factors.get("bending"),
            drawn.factors.get("torsion"),
        ]
        for drawn in stress.drawn
    ]
    note = (
        "Each in the section of its length where its safety is least. Nominal stress in the "
        "section of the norm, of diameter d; Kf by DIN 743-2."
    )
    return Table(f"Notches of the drawing, {units.unit(STRESS)}", columns, rows, note)


def _factor(value: float) -> str:
    return plain(value, 4)


def safeties(stress: ShaftStress) -> Table:
    """Return safeties of all notches that are rated, the least first."""
    rated = [(notch, notch.rating) for notch in stress.worst if notch.rating is not None]
    ratings = [rating for _, rating in rated]
    columns = [
        text("notch"),
        word("kind"),
        Column("S, fatigue"),
        Column("less by the error bar", write=partial(plain, digits=2), hidden=not stress.notches),
        Column("S, yielding"),
        Column("S, first crack", hidden=all(r.crack is None for r in ratings)),
        Column("S, least K_1", hidden=all(r.least is None for r in ratings)),
        Column("S, elementary", hidden=all(r.elementary is None for r in ratings)),
    ]
    rows = [
        [
            notch.name,
            kind_of(notch),
            safety(r.fatigue),
            r.fatigue_bar if isinstance(notch, Notch) else None,
            safety(r.yielding),
            None if r.crack is None else safety(r.crack),
            None if r.least is None else safety(min(r.least)),
            None if r.elementary is None else safety(r.elementary),
        ]
        for notch, r in rated
    ]
    note = f"The norm asks for {LEAST:g} where loads and strength are known."
    if stress.notches:
        note += " Less by the error bar: loss of S with Kt at the upper end of its error bar."
    if any(r.least is not None for r in ratings):
        note += (
            " Least K_1: the lesser of both S if the steel is of the group that loses most strength "
            "at this size; write group beside strength, or give K_1."
        )
    if any(r.elementary is not None for r in ratings):
        note += " Fatigue by the consequent rule of Miner; elementary: by the elementary rule."
    return Table("Safety by DIN 743", columns, rows, note)


def over_cases(cases: Sequence[CaseStress], units: Units = ENGINEERING) -> list[Table]:
    """Return the largest moment and the worst notches of every case of the loads; none of one case."""
    if not cases:
        return []
    elsewhere = any(case.yielding_notch != case.notch for case in cases)
    rated, filleted = any(case.worst for case in cases), any(case.fillet for case in cases)
    columns = [
        word("in"),
        quantity("largest M", "N m", units, digits=4),
        Column(
            f"on a fillet, {units.unit(STRESS)}",
            write=partial(units.number, si=STRESS, digits=4),
            unit="Pa",
            hidden=not filleted,
        ),
        replace(text("fillet"), hidden=not filleted),
        Column("S, fatigue", hidden=not rated),
        Column("S, yielding", hidden=not rated),
        replace(text("worst notch"), hidden=not rated),
        replace(text("in yielding"), hidden=not elsewhere),
    ]
    rows = [
        [
            case.label,
            case.largest_moment,
            case.amplitude,
            case.fillet,
            None if case.fatigue is None else safety(case.fatigue),
            None if case.yielding is None else safety(case.yielding),
            case.notch or None,
            case.yielding_notch or None,
        ]
        for case in cases
    ]
    note = "Other tables are of the case named above."
    if filleted:
        note += " On a fillet: the largest amplitude by bending on a surface."
    if rated:
        note += " Each safety is the least of all notches."
    return [Table("Every case of the loads", columns, rows, note)]


def kind_of(notch: Notch | DrawnStress) -> str:
    """Return the kind of a notch in words."""
    return notch.kind if isinstance(notch, DrawnStress) else "fillet"


def rating(name: str, record: Rating, units: Units = ENGINEERING) -> Table:
    """Return the rating of one notch by DIN 743, every factor with its source."""
    columns = [word(""), text("what"), *map(Column, LOADS), text("source")]
    rows = []
    for entry in record.entries:
        unit = units.unit(STRESS) if entry.unit == "Pa" else "1/mm" if entry.unit else ""
        what = f"{entry.what}, {unit}" if unit else entry.what
        values = [_value(value, entry.unit, units) for value in entry.values]
        rows.append([entry.symbol, what, *values, _source(entry)])
    note = (
        f"Safety against fatigue {safety(record.fatigue)}, against yielding "
        f"{safety(record.yielding)}, by nominal stress without shear forces, as in the norm."
    )
    if record.crack is not None:
        note += f" Against a first crack in the hard surface {safety(record.crack)}."
    if record.assumed:
        note += f" Assumed, since not given: {', '.join(record.assumed)}."
    if record.least is not None:
        fatigue, yielding = map(safety, record.least)
        note += (
            f" With the least K_1 of all groups of steel {fatigue} against fatigue and {yielding} "
            "against yielding."
        )
    return Table(f"DIN 743 at {name}", columns, rows, note)


def _value(value: float | None, unit: str, units: Units) -> str | None:
    if value is None:
        return None
    if unit == "Pa":
        return units.number(value, STRESS, 4)
    return plain(1e-3 * value if unit else value, 4)


def _source(entry: Entry) -> str | Cell:
    return Cell(entry.source, "mark assumed") if ASSUMED in entry.source else entry.source


def safety(value: float) -> str:
    """Return a safety as text."""
    return plain(value, 3) if math.isfinite(value) else "endless"


def headline(stressed: StressAtRest, units: Units = ENGINEERING) -> str:
    """Return the sentences on the worst notch of all shafts, and on what has no rating; empty where
    there is neither.
    """
    worst = [(shaft, shaft.found.worst[0]) for shaft in stressed.shafts if shaft.found.worst]
    if not worst:
        return " ".join(_unrated_words(stressed.shafts, units))
    shaft, notch = min(worst, key=lambda pair: _rank(pair[1]))
    count = sum(len(each.found.worst) for each in stressed.shafts)
    lead = f"Worst of {count} notches" if count > 1 else "Worst"
    several = len(stressed.shafts) > 1
    sentence = f"{lead} at {_place(shaft, notch, several)}: {_stress_words(notch, units)}"
    if notch.rating is not None:
        sentence += f", {_safety_words(notch.rating)}"
        sentence += "".join(_less_elsewhere(stressed, notch.rating))
    if shaft.open_safety is not None and shaft.open_safety[1] > (1 + LITTLE) * shaft.open_safety[0]:
        low, high = map(safety, shaft.open_safety)
        sentence += f"; the least safety is {low} to {high} by {stressed.open_by} of the bearings"
    return " ".join([f"{sentence}.", *_unrated_words(stressed.shafts, units)])


def _rank(notch: Notch | DrawnStress) -> tuple[float, float, bool, float]:
    """Return the rank of a notch; without ratings fillets, with their stress, come first."""
    fatigue, least, stress = notch.severity
    return fatigue, least, isinstance(notch, DrawnStress), stress


def _place(shaft: StressedShaft, notch: Notch | DrawnStress, several: bool) -> str:
    name = notch.name if isinstance(notch, Notch) else f'{notch.kind} "{notch.name}"'
    return f"{shaft.name}, {name}" if several else name


def _less_elsewhere(stressed: StressAtRest, worst: Rating) -> Iterator[str]:
    """Yield the least safeties that other notches have than that of the least against fatigue."""
    for kind, least in lesser_elsewhere(stressed.shafts, worst):
        place = _place(least.shaft, least.notch, len(stressed.shafts) > 1)
        yield f"; least {KIND_WORDS[kind]} {safety(least.value)} at {place}"


def _stress_words(notch: Notch | DrawnStress, units: Units) -> str:
    unit = units.unit(STRESS)
    if isinstance(notch, DrawnStress):
        nominal = units.number(notch.nominal.bending, STRESS, 4)
        return f"{nominal} {unit} of nominal bending"
    value = units.number(notch.local.amplitude, STRESS, 4)
    bar = units.number(notch.local.amplitude_bar, STRESS, 2)
    return f"{value} ± {bar} {unit} by bending"


def _safety_words(rating_: Rating) -> str:
    fatigue, yielding = safety(rating_.fatigue), safety(rating_.yielding)
    words = f"safety {fatigue} against fatigue and {yielding} against yielding"
    if rating_.crack is not None:
        words = f"safety {fatigue} against fatigue, {yielding} against yielding"
        words += f" and {safety(rating_.crack)} against a first crack"
    words += " by DIN 743"
    if rating_.least is not None:
        words += f", {safety(min(rating_.least))} if K_1 is the least of all steels"
    return words


def _unrated_words(shafts: tuple[StressedShaft, ...], units: Units) -> list[str]:
    """Return a sentence on notches without a rating."""
    names = [
        f"{shaft.name}, {name}" if len(shafts) > 1 else name
        for shaft in shafts
        for name in not_rated(shaft.found, units)
    ]
    return [f"Not rated: {listed(names, most=4)}."] if names else []


def not_rated(stress: ShaftStress, units: Units = ENGINEERING) -> Iterator[str]:
    """Yield the sharp corners of a shaft, whose safety may be less than any that is shown, and the
    features without a rating.
    """
    places = [units.text(corner.y, "m") for corner in stress.sharp]
    if places:
        yield f"sharp corner{'s' if len(places) > 1 else ''} at y = {listed(places, most=6)}"
    for feature in stress.unrated:
        yield f'{feature.kind} "{feature.name}"'
