"""Answers at several tolerances, and on coarser and finer meshes, never exclude each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations
from pathlib import Path

from validation.agree.commands import Numbers, by_answer, by_modes, by_stiffness
from validation.agree.relation import ROUNDING, Relation, meeting

KIND = "nested"
TOLERANCES = (1e-2, 1e-3, 1e-4)
#: factors on the cells of a mesh that the program chooses itself
REFINEMENTS = (0.7, 1.0, 1.4)


def of_scene(scene: Path, tolerances: tuple[float, ...] = TOLERANCES) -> Iterator[Relation]:
    """Answers of a shaft at several tolerances."""
    claims = {f"{tol:g}": by_answer(scene, "--tol", tol) for tol in tolerances}
    yield from beside(scene.name, claims)


def beside(subject: str, claims: Mapping[str, Numbers]) -> Iterator[Relation]:
    """Numbers of one subject by what they were asked for with, coarse to fine: none excludes another,
    and a bound from one side never moves to the other.
    """
    yield from meeting(subject, KIND, claims)
    for (coarse, numbers), (fine, others) in combinations(claims.items(), 2):
        for name in numbers.keys() & others.keys():
            a, b = numbers[name], others[name]
            seen = f"{a} at {coarse}, {b} at {fine}"
            rounding = ROUNDING * a.size
            if a.low < a.value == a.high:
                what, holds = "never rises", b.value <= a.value + rounding
            elif a.low == a.value < a.high:
                what, holds = "never falls", b.value >= a.value - rounding
            else:
                continue
            yield Relation(subject, KIND, f"{name} {what}: {coarse}, {fine}", holds, seen)


def of_body(body: Path) -> Iterator[Relation]:
    """Stiffness and modes of a body without an axis on coarser and finer meshes, and on that which
    the program chooses.
    """
    for function in (by_stiffness, by_modes):
        claims = {
            f"refinement {r}": function(body, "-f", "solid", "--set", f"refinement={r}")
            for r in REFINEMENTS
        }
        claims["default"] = function(body)
        # where a mesh has no bars its numbers claim nothing
        claims = {
            mesh: {name: n for name, n in numbers.items() if n.low < n.high}
            for mesh, numbers in claims.items()
        }
        yield from meeting(body.name, KIND, claims)
