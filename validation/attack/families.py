"""Bars on families of very simple shafts, one length or constant varied at a time.

    python -m validation.attack.families [--sequence] [WORD ...]

Random shafts mix what a bar rests on; a family shows where one thing goes wrong.  Every shaft is
solved on ever finer meshes, the finest being the truth, and bars are held against it: those of two
orders on one mesh, as an answer gives them, or of two, three and four meshes, as a comparison does.
Words select the families whose names have one of them.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from solidgear.errors import SolidgearError
from solidgear.evidence.answer import solve
from solidgear.evidence.bands import Band
from solidgear.evidence.quantities import size
from solidgear.evidence.sequence_bands import pair_bands, sequence_bands
from solidgear.fidelity.edges import sharpest_edge
from solidgear.fidelity.ladder import LADDER
from solidgear.fidelity.levels import HARMONIC, PAIRS, Options
from solidgear.scene import Scene
from validation.attack.simple_shafts import families

#: meshes solved, and unknowns after which no finer one is
LEVELS, MOST = 5, 90_000
#: pairs of orders that are judged, the one after them being the truth
JUDGED_PAIRS = 3
#: errors below this say nothing; the truth may err by this share of the finest mesh but one
LEAST, DOUBT = 1e-7, 0.3

Numbers = dict[str, float]


@dataclass(frozen=True)
class Held:
    """Bars after so many meshes, or pairs of orders: how many hold, and the number that comes nearest
    to its bar.
    """

    meshes: int
    unknowns: int
    held: int
    count: int
    worst: str
    error: float
    bar: float

    @property
    def told(self) -> str:
        """In words."""
        return (
            f"mesh {self.meshes} ({self.unknowns} unknowns): {self.held} of {self.count} held; "
            f"{self.worst} {self.error:.1e} off, bar {self.bar:.1e}"
        )


def judged(one: Scene, levels: int = LEVELS, most: int = MOST) -> list[Held]:
    """Bars of a shaft after two, three, ... meshes, against the finest of them.

    Parameters
    ----------
    one : Scene
    levels, most : int
        Meshes at most, and unknowns after which no finer one is solved.
    """
    rung = LADDER["harmonic"]
    assert rung.meshes is not None and rung.factors is not None
    plan: Any = rung.meshes({})
    solved = _solved(one, [(level,) for level in HARMONIC[:levels]], most)
    found = [values for (values,), _ in solved]
    out: list[Held] = []
    for k in range(1, len(found) - 1):
        bands = sequence_bands(one, plan, rung.factors, found[: k + 1], {}, [None] * (k + 1))
        out += _held(k + 1, solved[k][1], bands, found[k], found[-2:])
    return out


def judged_pairs(one: Scene, pairs: int = JUDGED_PAIRS, most: int = MOST) -> list[Held]:
    """Bars of two orders on one mesh, against the finest mesh solved.

    Parameters
    ----------
    one : Scene
    pairs, most : int
        Pairs at most, and unknowns after which no finer one is solved.
    """
    factors = LADDER["harmonic"].factors
    assert factors is not None
    solved = _solved(one, PAIRS[: pairs + 1], most)
    finest, _ = solved[-1]
    out: list[Held] = []
    for k, (orders, unknowns) in enumerate(solved[:-1]):
        bands = pair_bands(one, factors, k, orders, {})
        out += _held(k + 1, unknowns, bands, orders[1], finest)
    return out


def _solved(
    one: Scene, groups: Sequence[Sequence[Options]], most: int
) -> list[tuple[list[Numbers], int]]:
    """Numbers of meshes by groups, coarse to fine, each group with the unknowns of its last mesh;
    none after one of more than ``most``.
    """
    out = []
    for group in groups:
        answers = [solve(one, "harmonic", **level) for level in group]
        out.append(([dict(answer.quantities) for answer in answers], answers[-1].body.size))
        if answers[-1].body.size > most:
            break
    return out


def _held(
    meshes: int, unknowns: int, bands: dict[str, Band], values: Numbers, finest: Sequence[Numbers]
) -> Iterator[Held]:
    """How many of some bars hold against the last of the two finest solutions; nothing where all
    errors are too small to tell.
    """
    before, truth = finest
    rows = []
    for name, band in bands.items():
        if name not in truth:
            continue
        scale = size(truth, name)
        error = abs(values[name] - truth[name]) / scale
        # the truth errs by a share of its own last step
        doubt = DOUBT * abs(before.get(name, truth[name]) - truth[name]) / scale
        if error > LEAST:
            rows.append((error / band.gci, error - doubt <= band.gci, name, error, band.gci))
    if rows:
        _, _, name, error, bar = max(rows)
        held = sum(row[1] for row in rows)
        yield Held(meshes, unknowns, held, len(rows), name, error, bar)


def main(arguments: list[str] | None = None) -> int:
    """The exit code is 1 if a bar did not hold."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("words", nargs="*")
    parser.add_argument("--sequence", action="store_true", help="bars of a comparison")
    options = parser.parse_args(arguments)
    words, judge = options.words, judged if options.sequence else judged_pairs
    missed = total = 0
    for name, make in families().items():
        if words and not any(word in name for word in words):
            continue
        one = make()
        try:
            bars = judge(one)
        except SolidgearError as error:
            print(f"{name}: {error}", flush=True)
            continue
        for bar in bars:
            missed, total = missed + bar.count - bar.held, total + bar.count
            mark = "" if bar.held == bar.count else "MISSED "
            print(f"{mark}{name} ({sharpest_edge(one)}), {bar.told}", flush=True)
    print(f"{total - missed} of {total} bars held")
    return int(missed > 0)


if __name__ == "__main__":
    sys.exit(main())
