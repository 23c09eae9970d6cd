"""Completeness of a list of modes, in sentences: which families were counted, where the others
begin, and whether the number asked for ends it early.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from solidgear.core.judge.hidden import COMPLETE, COUNTED
from solidgear.core.ladder.model import BEAM
from solidgear.core.ladder.registry import LADDER

if TYPE_CHECKING:
    from solidgear.core.solve.modes import Mode, ModeSet


def completeness(evidence: dict, model: str) -> str:
    """State in words which families of a :class:`~solidgear.core.solve.modes.ModeSet` were counted, and
    below which frequency no mode is missing; a beam has no other families than bending, axial and
    torsion, and says so.
    """
    bad = [part["why"] for part in evidence["count"] if not part["checked"]]
    if bad:
        return f"Not counted: {bad[0]}."
    rows = evidence["families"]
    counted_rows = [row for row in rows if row["counted"]]
    text = f"{_reach(evidence)}: {_listed(counted_rows)}"
    if LADDER[model].family == BEAM:
        return f"{text}; a beam has no others."
    uncounted = _uncounted([row for row in rows if not row["counted"]])
    return f"{text}; {uncounted}." if uncounted else f"{text}."


def cut_short(modes: Iterable[Mode], n: int, asked_hz: float | None, option: str = "") -> list[str]:
    """Warn where the number `n` of elastic shapes, twins counted twice, that was asked for, or that a
    comparison needs at least, ends a list below the frequency asked for: one sentence, or none;
    `option` names an option that can be raised, beside the number in the scene.
    """
    elastic = [m for m in modes if not m.name.rigid]
    if not asked_hz or not elastic or sum(m.multiplicity for m in elastic) < n:
        return []  # all that there are up to it
    return [
        f"the list ends with {n} elastic shapes, at {elastic[-1].frequency_hz:.4g} Hz, below the "
        f"{asked_hz:g} Hz asked for; raise {option + ', or ' if option else ''}modes of its ask, "
        f"above {n}"
    ]


def split_apart(modes: ModeSet, bars: Mapping[str, float]) -> list[str]:
    """Return sentences on pairs that a mesh has split further than their error bars, by the names
    of modes, say; without one further than meshes like it do.
    """
    unusual = dict(modes.evidence.get("split_pairs", ()))
    split = {m.name: m.split for m in modes.modes if m.name in bars and m.split > bars[m.name]}
    split |= {name: s for name, s in unusual.items() if name not in bars}
    return [
        f"the mesh splits the pair {name} by {relative:.1e}, although the body has one frequency: "
        "refine it, or use hexahedra or the harmonic model."
        for name, relative in split.items()
    ]


def _reach(evidence: dict) -> str:
    """State how far a count reaches: into the body, where the error bars of the modes above the
    list are known.
    """
    method = "counted by a second factorisation"
    if COMPLETE not in evidence:
        return (
            f"No mode of this mesh missed below {evidence[COUNTED]:.6g} Hz ({method}; the body "
            "itself may have one more, since not every mode has an error bar)"
        )
    suffix = (
        "" if evidence[COMPLETE] == evidence[COUNTED] else ", less error bars of what lies above"
    )
    return f"No mode missed below {evidence[COMPLETE]:.6g} Hz ({method}{suffix})"


def _listed(rows: list[dict]) -> str:
    if any(row["n"] is None for row in rows):
        return "all motions of the mesh"
    names = [row["family"] for row in rows if row["n"] < 2]
    waves = sorted(row["n"] for row in rows if row["n"] >= 2)
    return ", ".join(names + _ranges(waves))


def _ranges(numbers: list[int]) -> list[str]:
    """Return runs of numbers in words: ``n = 2 to 4``, ``n = 7``."""
    out: list[list[int]] = []
    for n in numbers:
        if out and n == out[-1][-1] + 1:
            out[-1].append(n)
        else:
            out.append([n])
    return [f"n = {run[0]}" + (f" to {run[-1]}" if len(run) > 1 else "") for run in out]


def _uncounted(rows: list[dict]) -> str:
    """Name the families left alone; those at the end of the row are reported together."""
    rows = sorted(rows, key=lambda row: row["n"])
    last = [row for row in rows if row.get("above")]
    if not last:
        return ""
    tail = [last[0]]
    for row in reversed(rows[: rows.index(last[0])]):
        if row["n"] == tail[0]["n"] - 1:
            tail.insert(0, row)
    parts = [
        f"n = {row['n']} begins above {_hertz(row['lowest_hz'])}" for row in rows if row not in tail
    ]
    parts.append(
        f"n = {tail[0]['n']} and above begin above {_hertz(min(row['lowest_hz'] for row in tail))}"
    )
    return ", ".join(parts)


def _hertz(value: float) -> str:
    return f"{value:.0f} Hz" if value < 1e3 else f"{value / 1e3:.3g} kHz"
