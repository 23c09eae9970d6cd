"""Page one of the report: the numbers asked with their bars, the model they come from, and why it
is trusted, in a record's words and the units of the reader.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from typing import Any

from solidgear.core import COMPLIANCE, FIRST_BENDING, SCENE, ModeName, Quantity, Record
from solidgear.core.judge.record import ModelRecord, VerdictRecord
from solidgear.core.quantity import AT
from solidgear.show import open_words
from solidgear.show.reading import (
    BEAM,
    LUMPED,
    entry,
    first_frequency,
    is_resolved,
    mode_of,
    model_name,
    model_of,
    reference_of,
    relative_change,
    validity,
    value_of,
)
from solidgear.show.table import Cell, Table
from solidgear.show.units import Units, digits_for
from solidgear.show.words import DASH, bar_percent, percent, plus_minus, short_percent

#: quantities of page one -> in words
ROWS: dict[str, str] = {
    "bending 1": "First bending mode",
    "axial 1": "First axial mode",
    "K_zz": "Stiffness across the shaft",
    "K_yy": "Stiffness along the shaft",
    "K_thx": "Stiffness against tilting",
    "C_zz": "Compliance across the shaft",
    "C_yy": "Compliance along the shaft",
    "C_thx": "Compliance against tilting",
}
#: told only where the scene asks for them; one without words by its symbol
ON_REQUEST: dict[str, str] = {
    "K_z,thx": "Stiffness, motion across with tilting",
    "C_z,thx": "Compliance, motion across with tilting",
    "bending 2": "Second bending mode",
    "torsion 1": "First torsion mode",
}
#: the two directions across a shaft are told apart from here on
ALIKE = 0.01
#: figures of the hash that page and customer compare
HASH_DIGITS = 12


def shown_model(record: Record) -> str | None:
    """Return the model on page one: the trusted one, else the reference, else the last solved."""
    solved = [key for key, model in record.models.items() if model.stiffness or model.modes]
    for key in (record.verdict.trust, reference_of(record)):
        if key in solved:
            return key
    return solved[-1] if solved else None


def scene_hash(scene: Mapping[str, Any]) -> str:
    """Return the first figures of the SHA-256 of a scene's data."""
    if not scene:
        return ""
    text = json.dumps(scene, sort_keys=True, ensure_ascii=True)
    return hashlib.sha256(text.encode()).hexdigest()[:HASH_DIGITS]


def numbers(record: Record, units: Units) -> Table:
    """Return the numbers asked for, each with its error bar, from the model shown."""
    key = shown_model(record)
    model = model_of(record, key)
    quantities = (record.scene.get("ask") or {}).get("quantities") or []
    names = [Quantity(q) for q in (*ROWS, *(q for q in quantities if AT not in q))]
    # by the names that results have: a scene may write those of points in another way
    names += [q for q in (record.verdict.judged if quantities else ()) if q.points]
    cells = [_number(record, model, name, _label(name), units) for name in dict.fromkeys(names)]
    cells += _other_direction(record, model, units)
    caption = f"At the lumped point {(record.scene.get('port') or {}).get('name', '')}".strip()
    if key:
        caption += f", by the {model_name(record, key)}"
    remark = open_words.remark(record.open)
    end = remark or "open data of bearings or load are not included."
    return Table(
        caption,
        ["quantity", "value", "error bar"],
        [row for row in cells if row],
        "K: all other motions held; C: left free. The error bar holds the error of mesh and "
        f"solver{'. ' if remark else '; '}{end}",
        style="numbers",
    )


def _label(name: Quantity) -> str:
    """Return a quantity in words, with its points, and its symbol."""
    words = {**ROWS, **ON_REQUEST}.get(name.symbol, "")
    places = " under loads on ".join(name.points)
    symbol = "" if words and name.is_frequency else name.symbol
    return ", ".join(filter(None, (words, places, symbol)))


def _number(
    record: Record, model: ModelRecord, name: Quantity, label: str, units: Units
) -> list[Any]:
    """Return the cells of one quantity; none where there is no such number."""
    value = _frequency(model, name) if name.is_frequency else value_of(model, name)
    if value is None or value == 0:
        return []
    bar = model.band.each.get(name) if model.band else None
    written = units.text(value, name.unit, digits_for(bar))
    ranges = open_words.parts(record.open, name)
    mesh = "no error bar" if bar is None else plus_minus(bar)
    if ranges:
        mesh = "\n".join([mesh if bar is None else f"mesh {mesh}", *map(" ".join, ranges)])
    return [label, Cell(written, "strong"), mesh]


def _frequency(model: ModelRecord, name: Quantity) -> float | None:
    mode, named = mode_of(model, name), ModeName(name)
    exact = mode.frequency_hz if mode else None
    return exact if exact is not None or named.number != 1 else first_frequency(model, named.family)


def _other_direction(record: Record, model: ModelRecord, units: Units) -> Iterable[list[Any]]:
    """Return the stiffness in the other direction across the shaft, where it differs."""
    k_zz, k_xx = (entry(model.stiffness, i, i) for i in (2, 0))
    change = relative_change(k_xx, k_zz)
    if change is None or abs(change) <= ALIKE:
        return []
    return [
        _number(record, model, Quantity("K_xx"), "Stiffness across, other direction, K_xx", units)
    ]


def reasons(record: Record) -> list[str]:
    """Return three sentences on why to trust the model shown, or why there is no verdict."""
    verdict = record.verdict
    if verdict == VerdictRecord():
        return ["The run was interrupted before the verdict."]
    if not verdict.trust:
        return list(verdict.sentences[:3])
    return [_own(record), _second(record), _others(record)]


def _own(record: Record) -> str:
    """Return the sentence on the trusted model's own error bars."""
    trust = record.verdict.trust
    model = model_of(record, trust)
    solves = f", which solves {model.theory}," if model.theory else ""
    bars = model.band.each if model.band else {}
    judged = record.verdict.judged or list(map(Quantity, bars))
    c = max((bars[q] or 0.0 for q in judged if q.kind == COMPLIANCE and q in bars), default=None)
    sure = [(c, "compliance"), (bars.get(FIRST_BENDING), "first bending")]
    errors = [f"{bar_percent(bar)} in {kind}" for bar, kind in sure if bar is not None]
    tolerance = short_percent(record.verdict.tolerance)
    end = f"; {tolerance} was asked for" if tolerance else ""
    claim = f" has an own error of {' and '.join(errors)}" if errors else " judges the others"
    return f"The {model_name(record, trust)}{solves}{claim}{end}."


def _second(record: Record) -> str:
    """Return the sentence on the distance of a second solid from the trusted one."""
    trust, judged = record.verdict.trust, record.verdict.judged
    sentences = []
    for key, model in record.models.items():
        rows = [
            r
            for r in record.deviations
            if r.model == key
            and r.reference == trust
            and r.attachment == SCENE
            and (r.quantity in judged or not judged)
            and r.relative is not None
        ]
        if model.family in (BEAM, LUMPED) or key == trust or not rows:
            continue
        worst = max(abs(r.relative or 0.0) for r in rows)
        text = (
            f"The {model_name(record, key)}, solved independently, differs from it by at most "
            f"{percent(worst, False)} in any judged number"
        )
        inside = not any(is_resolved(r) for r in rows)
        sentences.append(text + (", less than both error bars." if inside else "."))
    return " ".join(sentences) or "No second solid was solved to confirm it."


def _others(record: Record) -> str:
    """Return the sentence on cheaper models, those that are enough and those that are not."""
    verdict = record.verdict
    tolerance = short_percent(verdict.tolerance) or "the tolerance"
    out = [model_name(record, k) for k, m in record.models.items() if validity(m) == "no"]
    keep = f"do not use the {_listed(out)} here" if out else ""
    cheapest = verdict.cheapest
    if cheapest and cheapest != verdict.trust:
        only = " for first bending and below" if model_of(record, cheapest).family == LUMPED else ""
        text = f"The {model_name(record, cheapest)} is enough within {tolerance}{only}"
        return f"{text}; {keep}." if keep else f"{text}."
    text = f"No cheaper model was shown to be within {tolerance}"
    return f"{text}: {keep}." if keep else f"{text}."


def _listed(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} or {names[-1]}"


def stamp(record: Record) -> list[tuple[str, str]]:
    """Return date, version and scene of the run as (name, value)."""
    environment = record.environment
    facts = [
        ("scene", str(record.scene.get("name") or "")),
        ("scene hash", scene_hash(record.scene)),
        ("date", str(environment.get("date") or "")),
        ("solidgear", str(environment.get("solidgear") or "")),
    ]
    return [(fact, value or DASH) for fact, value in facts]
