"""Claims of chapter 3 on mesh point, line of action and mesh stiffness, figures 3.11 to 3.22."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

import numpy as np

from solidgear.teeth.contact.cycle import MeshCycle, mesh_cycle
from validation.thesis import contact
from validation.thesis.claim import CAVEAT, CONFIRMED, NOT, OPEN, Claim
from validation.thesis.contact import PILOT, THREE, TWO, WAYS, Mounting, by_pilot, by_span

#: of what moves over a mesh cycle: what is little
LITTLE = 0.1
#: relative change of a stiffness that is none, and from which it is plain
NONE, PLAIN = 0.01, 0.02
#: torque, N m, and ease-off, m, that the thesis may have had
TORQUES, EASE_OFFS = (50.0, 3000.0), (50e-6, 300e-6)


def cycles(way: str, mountings: Iterable[Mounting]) -> list[MeshCycle]:
    """Mesh cycles on mountings."""
    return [contact.contact(way, mounting) for mounting in mountings]


def shift(rows: list[np.ndarray]) -> tuple[float, float]:
    """How far the mean of rows over a cycle moves between cycles, and rows within a cycle."""
    means = np.array([row.mean(axis=0) for row in rows])
    moved = np.linalg.norm(means[:, None] - means, axis=-1).max()
    swing = max(np.linalg.norm(row[:, None] - row, axis=-1).max() for row in rows)
    return float(moved), float(swing)


def stiffness(cycle: MeshCycle) -> float:
    """k_m of the thesis, mean over the cycle, N/m."""
    return float(cycle.supported_secant.mean())


def moves(place: str, noun: str, rows_of: str, scale: float, unit: str) -> Claim:
    """Judge how far something of the contact moves with bearings."""
    numbers: dict[str, float] = {}
    words, ok = [], []
    studies = {
        "S": by_pilot().values(),
        "L with a pilot": by_span(PILOT).values(),
        "L without": by_span(None).values(),
        "a pilot": (TWO, THREE),
    }
    for way in WAYS:
        parts = []
        for name, mountings in studies.items():
            rows = [getattr(cycle, rows_of) for cycle in cycles(way, mountings)]
            moved, swing = shift(rows)
            numbers |= {f"{way} {name}": moved, f"{way} {name} over a cycle": swing}
            ok.append(moved < LITTLE * swing)
            parts.append(f"{name} {moved * scale:.2g}")
        words.append(f"{way}: {', '.join(parts)} {unit}, over a mesh cycle {swing * scale:.2g}")
    verdict = CONFIRMED if all(ok) else CAVEAT if any(ok) else NOT
    return Claim(
        place, f"the {noun} hardly moves with the bearings", verdict, "; ".join(words), numbers
    )


def mesh_point_still() -> Claim:
    """Figures 3.11 to 3.14."""
    return moves("3.11 to 3.14", "mesh point", "points", 1e3, "mm")


def line_of_action_still() -> Claim:
    """Figures 3.15 to 3.18."""
    return moves("3.15 to 3.18", "line of action", "lines_of_action", 1e3, "mrad")


def stiffness_by_pilot() -> Claim:
    """Figure 3.19: the farther the pilot, the smaller."""
    numbers: dict[str, float] = {}
    words, ok = [], []
    for way in WAYS:
        values = [stiffness(cycle) for cycle in cycles(way, by_pilot().values())]
        change = values[-1] / values[0] - 1
        rises = max(np.diff(values)) / values[0]
        numbers |= {f"{way} change": change, f"{way} largest rise": float(rises)}
        ok.append(change < -NONE and rises < LITTLE * -change)
        words.append(f"{way}: " + " ".join(f"{value / 1e8:.3f}" for value in values) + "e8 N/m")
    verdict = CONFIRMED if all(ok) else CAVEAT if any(ok) else NOT
    says = "the mesh stiffness falls as the pilot goes away from the pinion"
    return Claim("3.19", says, verdict, "; ".join(words), numbers)


def close_pilot_counts_more() -> Claim:
    """Figure 3.19: the effect is larger while the pilot is close."""
    numbers: dict[str, float] = {}
    words, ok = [], []
    for way in WAYS:
        values = [stiffness(cycle) for cycle in cycles(way, by_pilot().values())]
        slopes = np.diff(values) / np.diff(contact.PILOTS) / values[0]
        numbers |= {f"{way} first": slopes[0], f"{way} last": slopes[-1]}
        ok.append(abs(slopes[0]) == np.abs(slopes).max())
        percent = " ".join(f"{100 * slope:+.2f}" for slope in slopes)
        words.append(f"{way}: from step to step {percent} % an inch")
    verdict = CONFIRMED if all(ok) else CAVEAT if any(ok) else NOT
    says = "a pilot's position counts more where it is close to the pinion"
    return Claim("3.19", says, verdict, "; ".join(words), {k: float(v) for k, v in numbers.items()})


def spans(pilot: float | None) -> dict[str, float]:
    """Change of k_m by the span from the longest to the shortest, by way."""
    out = {}
    for way in WAYS:
        values = [stiffness(cycle) for cycle in cycles(way, by_span(pilot).values())]
        out[way] = values[-1] / values[0] - 1
    return out


def span_with_pilot() -> Claim:
    """Figure 3.20."""
    changes = spans(PILOT)
    words = "; ".join(f"{way}: {100 * change:+.2f} %" for way, change in changes.items())
    verdict = CONFIRMED if max(map(abs, changes.values())) < NONE else NOT
    says = "with a pilot the mesh stiffness does not change with L"
    return Claim("3.20", says, verdict, f"from L = 5.965 to 2.925 in {words}", changes)


def span_without_pilot() -> Claim:
    """Figure 3.21."""
    changes, with_pilot = spans(None), spans(PILOT)
    more = all(abs(changes[way]) > abs(with_pilot[way]) for way in WAYS)
    plain = all(abs(change) > PLAIN for change in changes.values())
    verdict = CONFIRMED if more and plain else CAVEAT if more else NOT
    words = "; ".join(f"{way}: {100 * change:+.2f} %" for way, change in changes.items())
    says = "without a pilot the mesh stiffness can be sensitive to L"
    return Claim("3.21", says, verdict, f"from L = 5.965 to 2.925 in {words}", changes)


def pilot_stiffens() -> Claim:
    """Figure 3.22, and that the pilot does it, not L."""
    numbers: dict[str, float] = {}
    words, ok = [], []
    for way in WAYS:
        mountings = (TWO, Mounting(None, THREE.span), THREE)
        two, shorter, three = (stiffness(cycle) for cycle in cycles(way, mountings))
        pilot, span = three / two - 1, shorter / two - 1
        numbers |= {f"{way} pilot": pilot, f"{way} span": span}
        ok.append(pilot > PLAIN and abs(span) < LITTLE * pilot)
        words.append(f"{way}: {100 * pilot:+.1f} %, of which L alone {100 * span:+.2f} %")
    verdict = CONFIRMED if all(ok) else CAVEAT if any(ok) else NOT
    says = "a pilot raises the mesh stiffness, not the span"
    return Claim("3.22", says, verdict, "; ".join(words), numbers)


def stiffness_without_shafts() -> Claim:
    """Equation of k_m: is it that of the mesh, to stand beside the shafts?"""
    numbers: dict[str, float] = {}
    words, ok = [], []
    for way in WAYS:
        rigid = contact.contact(way, None)
        teeth, tangent = float(rigid.secant.mean()), float(rigid.tangent.mean())
        for name, mounting in (("two bearings", TWO), ("three", THREE)):
            cycle = contact.contact(way, mounting)
            published, give = stiffness(cycle), contact.along_line(cycle, mounting)
            numbers |= {f"{way} {name}": published, f"{way} {name} supports": give}
            numbers[f"{way} {name} teeth"] = float(cycle.secant.mean())
            numbers[f"{way} {name} series"] = 1 / (1 / published - give)
            ok.append(abs(published / teeth - 1) < PLAIN)
        numbers |= {f"{way} secant": teeth, f"{way} tangent": tangent}
        words.append(
            f"{way}: k_m {published / 1e8:.2f}e8 N/m on three bearings, of the teeth alone "
            f"{teeth / 1e8:.2f}e8, about the load {tangent / 1e8:.2f}e8; the supports give "
            f"{give * 1e10:.2f}e-10 m/N along the line of action"
        )
    found = f"{'; '.join(words)}: a train that has shafts and this k_m counts its supports twice"
    says = "k_m = F / (e_L - e_0) is the stiffness of the teeth"
    return Claim("equation of k_m", says, CONFIRMED if all(ok) else NOT, found, numbers)


@cache
def level(torque: float, ease_off: float) -> MeshCycle:
    """Contact on three bearings under a torque, N m, with an ease-off, m."""
    bevel, supports = contact.pair(ease_off), contact.supports(THREE)
    return mesh_cycle(
        bevel, torque, bevel.base, bevel.slices, supports, positions=contact.POSITIONS
    )


def stiffness_level() -> Claim:
    """The level of figures 3.19 to 3.22, for torque and cutter are not published."""
    values = {
        f"{torque:g} N m, {1e6 * ease_off:.0f} um": stiffness(level(torque, ease_off))
        for torque in TORQUES
        for ease_off in EASE_OFFS
    }
    words = ", ".join(f"{value / 1e8:.2f}e8 ({name})" for name, value in values.items())
    found = f"on three bearings {words} N/m; the plots show 1.8e8 to 3.2e8"
    return Claim("3.19 to 3.22", "level of the mesh stiffness", OPEN, found, values)


CLAIMS = (
    mesh_point_still,
    line_of_action_still,
    stiffness_by_pilot,
    close_pilot_counts_more,
    span_with_pilot,
    span_without_pilot,
    pilot_stiffens,
    stiffness_without_shafts,
    stiffness_level,
)
