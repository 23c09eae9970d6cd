"""The size of tetrahedra, a closed formula in radius and y, and roughly how many fill a shaft."""

from collections.abc import Sequence
from math import pi
from typing import Any

from solidgear.core.scene.outline import Outline

PER_BLEND = 0.8  # edge at a fillet or chamfer, of its size
_GROWTH = 0.5  # element size gained per distance from a lateral surface


#: elements in a cube of their edge, as gmsh makes them
PER_CUBE = 4.0


def rough_cells(
    outline: Outline,
    circles: Sequence[float] = (),
    *,
    size: float,
    graded_size: float | None = None,
    fine: Sequence[tuple[float, float, float]] = (),
) -> float:
    """Return the number of tetrahedra to within a factor of three or so, without meshing: enough to
    refuse an absurd size.

    Volume is filled at the size in the bulk, and edges that are graded towards at a size that grows
    from them. `fine` are further edges: their length and the element size at them, m, and the
    growth by the distance.

    Examples
    --------
    >>> from solidgear import Segment
    >>> from solidgear.core.scene.outline import Outline
    >>> rod = Outline([Segment.cylinder("rod", length=0.3, diameter=0.06)])
    >>> round(rough_cells(rod, size=0.005) / rough_cells(rod, size=0.01), 6)
    8.0
    """
    total, segments = 0.0, outline.segments
    for s in segments:
        a, b = pi * (s.outer0**2 - s.inner0**2), pi * (s.outer1**2 - s.inner1**2)
        bulk = min(size, max(s.outer0, s.outer1))
        total += (a + b) / 2 * (s.y1 - s.y0) / bulk**3
    graded = graded_size or size
    steps = [(s.y0, max(s.outer0, s.outer1)) for s in segments]
    rims = steps + [(y, r) for y in circles for r in [max(r for _, r in steps)]]
    edges = [(2 * pi * r, graded, (size - graded) / r) for _, r in rims if graded < size]
    edges += [(2 * pi * b.r, PER_BLEND * min(b.axial, b.radial), _GROWTH) for b in outline.corners]
    for length, least, growth in (*edges, *fine):
        # the integral of size^-3 around an edge, of which a quarter lies in the material
        slope = min(growth, _GROWTH)  # elements grow no faster, whatever the formula says
        total += pi * length / (4 * slope**2 * least) * max(0.0, 1 - least / size)
    return PER_CUBE * total


def size_formulas(
    outline: Outline,
    corners: Sequence[tuple[float, float]],
    size: float,
    graded_size: float | None,
    reach: float | None,
    around: int,
) -> list[str]:
    """Return formulas of the element edge in x, y, z, m, as gmsh's parser reads them; the least one
    counts.

    `corners` are those (y, radius) to grade towards; sizes as for
    :func:`~solidgear.core.meshing.tetrahedra.tetrahedra`.
    """
    radius = "Sqrt(x^2+z^2)"
    formulas = []
    if graded_size is not None and graded_size < size:
        for y, r in sorted(set(corners)):
            slope = (size - graded_size) / (reach or r)
            formulas.append(
                f"{_num(graded_size)}+{_num(slope)}*Sqrt(({radius}-{_num(r)})^2+(y-{_num(y)})^2)"
            )
    for blend in outline.corners:
        # an edge of an element along either half of the outline, or the size at a corner
        r, y = blend.middle
        across = min(blend.axial, blend.radial)
        least = min(size, graded_size or size, PER_BLEND * across)
        formulas.append(
            f"{_num(least)}+{_num(_GROWTH)}*Max(0,Sqrt(({radius}-{_num(r)})^2+(y-{_num(y)})^2)"
            f"-{_num(across / 2)})"
        )
    for s in outline.segments:
        for r0, r1 in ((s.outer0, s.outer1), (s.inner0, s.inner1)):
            if max(r0, r1) == 0.0:
                continue
            least = 0.1 * max(r0, r1)  # the tip of a cone would ask for elements of no size
            per_radius = 2.0 * pi / around
            wall = min(s.outer0 - s.inner0, s.outer1 - s.inner1)
            if wall > 0.0:  # an arc must not bulge through a thin wall: height edge^2 / 8r
                per_radius = min(per_radius, (wall / max(r0, r1)) ** 0.5)
            if per_radius * max(min(r0, r1), least) >= size:
                continue
            # foot of the point on the generator, as a fraction of its length
            dr, dy = r1 - r0, s.y1 - s.y0
            square = dr**2 + dy**2
            along = (
                f"({radius}-{_num(r0)})*{_num(dr / square)}+(y-{_num(s.y0)})*{_num(dy / square)}"
            )
            foot = f"Max(0,Min(1,{along}))"
            near_r, near_y = f"({_num(r0)}+{_num(dr)}*{foot})", f"({_num(s.y0)}+{_num(dy)}*{foot})"
            formulas.append(
                f"Max({_num(least)},{near_r})*{_num(per_radius)}"
                f"+{_GROWTH}*Sqrt(({radius}-{near_r})^2+(y-{near_y})^2)"
            )
    return formulas


def _num(value):
    """Return a number in brackets, since gmsh's parser ends the process at a sign after an
    operator.
    """
    return f"({float(value)!r})"


def set_size(gmsh: Any, formulas: list[str], size: float) -> None:
    """Make the least of some formulas the element size of a gmsh model, and `size` the largest
    edge, m.
    """
    field = gmsh.model.mesh.field
    tags = []
    for formula in [_num(size)] + formulas:
        tags.append(field.add("MathEval"))
        field.setString(tags[-1], "F", formula)
    least = field.add("Min")
    field.setNumbers(least, "FieldsList", tags)
    field.setAsBackgroundMesh(least)
