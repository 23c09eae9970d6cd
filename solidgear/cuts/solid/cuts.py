"""Tools of features: the solid of OCC that one cuts out of a shaft, and the formula of element
size.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import TYPE_CHECKING, Any

from solidgear.core.meshing.element_size import _num
from solidgear.cuts.features.cut import Frame

if TYPE_CHECKING:
    from solidgear.cuts.features.cut import Cut

#: elements across the smaller size of a feature, at the size asked for
ACROSS = 2.0
#: and as many times more at its re-entrant edges, where those are graded towards. On the keyed pinion
#: 15,000 unknowns give C_zz to 1.7e-4 so, where 18,000 without gave it to 2.8e-4
EDGES = 3.0
#: refinement from which on a hole has more than eight edges around where sizes are graded towards edges
LEAST = 0.35
#: growth of the element size per distance from a feature
GROWTH = 1.0
#: how far a tool reaches out of the surface, in radii
OVERHANG = 0.2


def tool(occ: Any, feature: Cut, radius: float) -> int:
    """Return the tag of the solid that cuts a feature into a segment of some outer radius, m; it
    reaches out of the shaft, and is not yet cut with it.
    """
    solid = feature.tool(occ, radius, OVERHANG * radius)
    if feature.angle:
        occ.rotate([(3, solid)], 0, 0, 0, 0, 1, 0, feature.angle)
    return solid


def feature_size(
    feature: Cut, radius: float, refinement: float, finer: float = 1.0
) -> tuple[str, float]:
    """Return a formula (in x, y, z, m) of the element edge around a feature of a segment of some
    radius, m, and the least value, m.

    `refinement` divides the size; `finer` divides it too, and the largest that a hole or a round
    end may have.
    """
    straight, curved = feature.edges(radius)
    divided = ACROSS * refinement
    # curved edges are round at any refinement
    least = min(straight / divided, curved / max(1.0, divided)) / finer
    return f"{_num(least)}+{_num(GROWTH)}*{feature.distance(radius, _frame(feature))}", least


def edge_size(feature: Cut, radius: float, refinement: float) -> tuple[str, float]:
    """Return a formula of the element edge where stresses around a feature are highest, and the
    least value, m: at the re-entrant edges of the floor of a keyway and of the ends of a flat, at
    the wall of a hole.

    The least of a hole, which eight edges around are the least of, differs from refinement
    ``LEAST`` on.

    Examples
    --------
    >>> from solidgear.cuts.features import Flat
    >>> flat = Flat(name="flat", segment="rod", y=0.1, length=0.03, depth=0.006)
    >>> round(edge_size(flat, 0.03, 1.0)[1], 12)
    0.001
    """
    at_edges = feature.from_edges(radius, _frame(feature))
    if at_edges is None:
        away = feature.distance(radius, _frame(feature))
        least = feature.edges(radius)[1] / max(1.0, refinement / LEAST)
    else:
        away, least = at_edges
        least /= ACROSS * EDGES * refinement
    return f"{_num(least)}+{_num(GROWTH)}*{away}", least


def fine_lines(
    feature: Cut, radius: float, refinement: float, edges: bool
) -> tuple[float, float, float]:
    """Return a cut as edges that elements grow from: see
    :func:`solidgear.core.meshing.element_size.rough_cells`; parameters as for :func:`edge_size`, which
    `edges` chooses.
    """
    least = (edge_size if edges else feature_size)(feature, radius, refinement)[1]
    length, wall = feature.lines(radius)
    # around a wall there are more than along a line by its radius over that of an element
    return length * (1 + wall * GROWTH / least), least, GROWTH


def _frame(feature: Cut) -> Frame:
    c, s = _num(cos(feature.angle)), _num(sin(feature.angle))
    return Frame(f"(x*{c}-z*{s})", f"(z*{c}+x*{s})", _num)


def mirror_plane(features: tuple[Cut, ...]) -> int | None:
    """Return the plane that all features are symmetric about: 0 for x = 0, 2 for z = 0; None where
    there is neither.

    Examples
    --------
    >>> from solidgear.cuts.features import CrossHole
    >>> mirror_plane((CrossHole(name="oil", segment="rod", y=0.1, diameter=0.01),))
    0
    """
    for plane, first in ((0, 0.0), (2, pi / 2)):
        quarter = [(feature.angle - first) / (pi / 2) for feature in features]
        straight = all(abs(q - round(q)) < 1e-9 for q in quarter)
        if straight and all(f.mirrored(round(q) % 2 == 1) for f, q in zip(features, quarter)):
            return plane
    return None
