"""Questions asked of a mesh, and what it was solved for: families of motion that are solved
together, how many modes, and both in words.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.body import Body, as_supports
from solidgear.body.mode_names import ModeName
from solidgear.judge.singular_places import singular_places
from solidgear.judge.solving import ENOUGH, Numbers
from solidgear.quantity import Quantity
from solidgear.solve.coupling import decoupled, groups
from solidgear.solve.families import FAMILIES

if TYPE_CHECKING:
    from solidgear.scene import Scene

#: options of a mesh that are reported, and in which words
SETTINGS = {
    "order": "order",
    "layers": "layers",
    "around": "cells around",
    "refinement": "refinement",
    "cuts": "cuts",
}
#: what a mesh was solved for is named up to so many numbers
FEW = 3
#: families of motion that are solved together, None for all of them, and what is asked of them
Question = tuple[tuple[str, ...] | None, tuple[Quantity, ...]]


def family_of(quantity: Quantity) -> str:
    """The family of motion that a quantity belongs to."""
    if quantity.is_frequency:
        return ModeName(quantity).family
    return next(name for name, own in FAMILIES.items() if quantity.components <= set(own))


@dataclass(frozen=True)
class Solved:
    """Solution of one mesh."""

    body: Body  #: the last one that was built on it
    numbers: Numbers
    unknowns: int  #: of all bodies
    cells: tuple[float, ...]  #: sizes of its cells, m
    #: (ne,) where on a meridian the bars come from that are not within the tolerance
    score: np.ndarray | None = None


def coupled_families(
    scene: Scene, body: Body, tolerance: float
) -> tuple[list[tuple[str, ...]], float]:
    """Families that bearings couple, and what the couplings left out may move at most.

    Parameters
    ----------
    body : Body
        With a block for every family.
    tolerance : float
        Of what is left out, relative.
    """
    supports = as_supports(scene)
    spring, left_out = decoupled(body, supports, tolerance)
    together: list[set[str]] = []
    for group in groups(body, supports, spring):
        components = {c for b in group for c in body.blocks[b].components}
        here = {name for name, own in FAMILIES.items() if components & set(own)}
        # bending in one plane and in the other are two groups of one family
        apart = [families for families in together if not families & here]
        together = [*apart, here.union(*(f for f in together if f & here))]
    return [tuple(f for f in FAMILIES if f in here) for here in together], left_out


def most_of(scene: Scene, body: Body, score: np.ndarray) -> str:
    """The place that holds most of a score by cells of a harmonic body, in words."""
    flat = body.geometry.meridian  # type: ignore[union-attr]
    r, y = flat.points[:, flat.cells[:, int(score.argmax())]].mean(axis=1)
    places = singular_places(scene)
    near = min(places, key=lambda p: np.hypot(p.y - y, p.r - r), default=None)
    if near is None or np.hypot(near.y - y, near.r - r) > near.reach:
        return f"cells at y = {1e3 * y:.4g} mm, r = {1e3 * r:.4g} mm"
    return f"the {near.what} at y = {1e3 * near.y:.4g} mm, r = {1e3 * near.r:.4g} mm"


def mesh_words(level: Mapping[str, Any]) -> str:
    """A mesh in a few words."""
    out = []
    for name, word in SETTINGS.items():
        if name == "layers" and "cuts" in level:
            continue
        if name == "cuts" and name in level:
            cuts, lines = sum(c for *_, c in level[name]), len(level.get("across", ()))
            if cuts:
                out.append(f"{cuts} cut{'s' if cuts > 1 else ''} at corners")
            if lines:
                out.append(f"{lines} line{'s' if lines > 1 else ''}")
        elif name in level:
            out.append(f"{word} {level[name]}")
    if "coarser" in level:
        back = level["coarser"]
        out.append(f"mesh file {back} before the last" if back else "the last mesh file")
    return ", ".join(out)


def few(names: Sequence[str]) -> str:
    """Some names, or how many there are."""
    return ", ".join(names) if len(names) <= FEW else f"{len(names)} numbers"


def shapes(families: tuple[str, ...] | None, names: Iterable[Quantity]) -> int:
    """Elastic shapes that hold the modes asked for."""
    if families is None or len(families) > 1:
        return ENOUGH
    places = [ModeName(q).number or 1 for q in names if q.is_frequency]
    return 2 * max(places) + 2
