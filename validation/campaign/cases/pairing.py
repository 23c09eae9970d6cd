"""Is a pair right as often as its probability says? Random shafts with other springs and modulus
than those that are computed, few points, noisy shapes, and lists that have a slip.
"""

from __future__ import annotations

import argparse
import math
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise, product
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.core.body.surface import Surface
from solidgear.core.scene.file import scene_of
from solidgear.core.scene.paths import Tables
from solidgear.measured import correlate
from solidgear.measured.alignment import BANDWIDTH
from solidgear.measured.computed import Computed
from solidgear.measured.correlate import POSSIBLE, SURE, peaks_of
from solidgear.measured.data import Measured
from solidgear.measured.same_part import alignment_of
from solidgear.measured.shapes import OnPoints
from solidgear.measured.universal import Shapes
from validation.campaign.case import Case, Run
from validation.campaign.cases.identification import NOISE, SHAPES, shaft
from validation.campaign.rows import CLAIM, Found, Row

#: standard deviations of logarithms: what springs and modulus are off by
SPRINGS, MODULUS = 0.2, 0.03
#: of shapes, and points that are measured
NOISES, POINTS = (0.02, 0.05, 0.1), (3, 16)
SLIPS = (
    "none",
    "two changed places",
    "a mode is missing",
    "a peak is none",
    "a pair is split",
    "two are one peak",
)
#: sets of points and noise for each shaft and slip
SETS = 2
#: points that say which mode is which
MANY = 200
#: least MAC on many points of modes that are the same one; below, nobody can say which it is
SAME, MIXED = 0.7, None
#: MAC of a second mode over that of the first, above which it is a mixture, and neither
NEITHER = 0.5
#: probabilities that are told together
BINS = (POSSIBLE, 0.2, 0.5, 0.8, SURE, 0.99, 1.0)


class Pairing(Case):
    """A pair that is told counts as held where it is right; one that is told as sure and is wrong is
    a failure.
    """

    name, question = "pairing", "probabilities of pairs of measured and computed modes"
    parts = (("silent",), ("stated",), ("slip",))
    details = (("noise",), ("slip", "stated"))
    widths = singly = False
    seeds = (1, 50)

    def options(self, parser: argparse.ArgumentParser) -> None:
        told = "frequencies and multiplicities alone, no shapes"
        parser.add_argument("--frequencies", action="store_true", help=told)

    def judge(self, run: Run, seed: int) -> Found:
        return run.found(f"seed {seed}", judged, seed, run.given.frequencies)


def judged(seed: int, bare: bool = False) -> Found:
    """Pairs that are told, right (0) or wrong (1); of frequencies and multiplicities alone if `bare`."""
    rng = np.random.default_rng([seed, 5])
    text, springs = shaft(rng)
    tables = tomllib.loads(text.format(*springs))
    true = _solved(tables)
    for bearing in tables["bearing"]:
        held = bearing["stiffness"]
        held |= {k: x * math.exp(SPRINGS * rng.standard_normal()) for k, x in held.items()}
    computed = _solved(tables)
    shift = math.exp(MODULUS * rng.standard_normal())
    count = len(computed.body.surface({}).points)
    many = _shapes(rng, true, rng.choice(count, MANY, replace=False), 0.0)
    everywhere = OnPoints(many, NOISES[0], computed)
    partner = [_partner(row) for row in everywhere.likeness.mac]
    widths = computed.widths(correlate.SPRINGS)
    rows = []
    for slip, _ in product(SLIPS, range(SETS)):
        noise = float(rng.choice(NOISES))
        at = rng.choice(count, int(rng.integers(*POINTS)), replace=False)
        shapes = _shapes(rng, true, at, noise)
        peaks = [
            _Peak(
                math.log(shift * mode.frequency_hz) + NOISE * float(rng.standard_normal()),
                min(mode.multiplicity, 2),
                shape,
                right,
            )
            for mode, shape, right in zip(true.modes, shapes.values, partner)
        ]
        slipped = _slipped(rng, slip, peaks, widths if bare else None)
        for p, sure, right in _told(slipped, None if bare else shapes, noise, computed):
            stated = next(f"{a:.0%} to {b:.0%}" for a, b in zip(BINS, BINS[1:]) if p <= b + 1e-6)
            how = f"p {p:.4f}" if bare else f"p {p:.4f}, {len(at)} points"
            seen = "none" if bare else f"{noise:.0%}"
            silent = "sure" if sure else "unsure"
            tags = {"stated": stated, "slip": slip, "noise": seen, "silent": silent}
            rows.append(
                Row(f"seed {seed}", "pair", tags, 0.5, float(not right), how=how, rule=CLAIM)
            )
    wrong = (row for row in rows if row.tags["silent"] == "sure" and row.error)
    silent = [f"{row.body}, {row.tags['slip']}: sure and wrong, {row.how}" for row in wrong]
    return Found(rows, failures=silent)


def _partner(mac: np.ndarray) -> set[int] | None:
    """The computed mode that a true one is, by its MAC with all on many points."""
    second, first = np.sort(mac)[-2:]
    return {int(mac.argmax())} if first > SAME and second < NEITHER * first else MIXED


@dataclass(frozen=True)
class _Peak:
    """A measured resonance and the modes it is: none of a peak that is none."""

    log: float
    multiplicity: int
    shape: np.ndarray
    right: set[int] | None


def _slipped(
    rng: np.random.Generator, slip: str, peaks: list[_Peak], widths: np.ndarray | None
) -> list[_Peak]:
    """A list with a slip, by ascending frequency; without shapes neighbours change places that may, by
    the widths of modes.
    """
    out = list(peaks)
    k = int(rng.integers(1, len(out) - 2))
    one, other = out[k : k + 2]
    if slip == "two changed places":
        gaps = [b.log - a.log for a, b in pairwise(out)]
        if widths is None:
            k = int(rng.choice(np.argsort(gaps)[: len(gaps) // 2]))
            one, other = out[k : k + 2]
            out[k : k + 2] = [replace(one, log=other.log), replace(other, log=one.log)]
            return sorted(out, key=lambda peak: peak.log)
        reach = [max((float(widths[j]) for j in p.right or ()), default=0.0) for p in out]
        near = [k for k, gap in enumerate(gaps) if 2 * gap < max(reach[k : k + 2])]
        if near:
            # the one that its springs can move that far passes the other
            k = int(rng.choice(near))
            a, b = (k, k + 1) if reach[k] > reach[k + 1] else (k + 1, k)
            out[a] = replace(out[a], log=2 * out[b].log - out[a].log)
    elif slip == "a mode is missing":
        del out[k]
    elif slip == "a peak is none":
        where = rng.uniform(out[0].log, out[-1].log)
        out.append(_Peak(float(where), 1, rng.standard_normal(one.shape.shape), set()))
    elif slip == "a pair is split" and (pairs := [p for p in out if p.multiplicity == 2]):
        one = replace(pairs[int(rng.integers(len(pairs)))], multiplicity=1)
        out = [one if p.right == one.right else p for p in out]
        out.append(replace(one, log=one.log + 2 * NOISE))
    elif slip == "two are one peak":
        k = min(range(len(out) - 1), key=lambda k: out[k + 1].log - out[k].log)
        one, other = out[k : k + 2]
        if other.log - one.log < BANDWIDTH:
            a, b = rng.standard_normal(2)
            right = MIXED if MIXED in (one.right, other.right) else one.right | other.right
            amid = (one.log + other.log) / 2
            shape = a * one.shape + b * other.shape
            out[k : k + 2] = [_Peak(amid, one.multiplicity, shape, right)]
    return sorted(out, key=lambda peak: peak.log)


def _told(
    peaks: list[_Peak], shapes: Shapes | None, noise: float, computed: Computed
) -> Iterator[tuple[float, bool, bool]]:
    """Probabilities of pairs, whether no other is in question, and whether each is right."""
    modes = [{"frequency": math.exp(p.log), "multiplicity": p.multiplicity} for p in peaks]
    measured = Measured(uncertainty=NOISE, noise=noise, mode=modes)
    seen = None
    if shapes is not None:
        values = np.array([peak.shape for peak in peaks])
        seen = OnPoints(Shapes(shapes.numbers, shapes.points, values), noise, computed).likeness
    found = alignment_of(*peaks_of(measured, computed, correlate.SPRINGS), seen)
    for peak, row in zip(peaks, found.pairs):
        told = np.flatnonzero(row > POSSIBLE)
        for j in told if peak.right is not MIXED else ():
            yield float(row[j]), len(told) == 1 and bool(row[j] >= SURE), int(j) in peak.right


class _Drawn:
    """A geometry that draws every shape once: points and noise are drawn anew, the shape is not, and
    drawing took three quarters of the time of a seed.
    """

    def __init__(self, own: Any):
        self.own = own
        self.known: dict[Any, Surface] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self.own, name)

    def surface(self, moved: Mapping[str, np.ndarray]) -> Surface:
        """The surface, moved by the unknowns of its blocks."""
        key = tuple((name, u.tobytes()) for name, u in sorted(moved.items()))
        if key not in self.known:
            self.known[key] = self.own.surface(moved)
        return self.known[key]


def _solved(tables: Tables) -> Computed:
    scene = scene_of(tables, "shaft.toml")
    body = sg.build(scene, "harmonic", order=3)
    modes = [m for m in sg.modes(body, scene, n=SHAPES).modes if m.frequency_hz > 0]
    limit = modes[-1].frequency_hz
    body = replace(body, geometry=_Drawn(body.geometry))
    return Computed(scene, body, tuple(modes), (1e-4,) * len(modes), "harmonic", {}, limit)


def _shapes(rng: np.random.Generator, true: Computed, at: np.ndarray, noise: float) -> Shapes:
    """Shapes on points of the surface, of a pair in any plane, with noise in every component."""
    surface = true.body.surface
    values = []
    for mode in true.modes:
        shape = sum(rng.standard_normal() * surface(v).displacement[at] for v in mode.vectors)
        size = np.sqrt(np.mean(np.square(shape)))
        values.append(shape + noise * size * rng.standard_normal(shape.shape))
    return Shapes(np.arange(len(at)), surface({}).points[at], np.array(values))
