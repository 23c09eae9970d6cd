"""Chamfers in shoulders as short cones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from solidgear.core.errors import SceneError

if TYPE_CHECKING:
    from solidgear.core.scene.corner import Corner
    from solidgear.core.scene.parts import Segment


def coned(scene: Any) -> Any:
    """Return a scene without features, with a short cone for every chamfer that fills a shoulder; the
    scene unchanged where there is none, or where another fillet or chamfer needs the length.

    Both ends of a cone are corners of the outline, to which meshes have layers.

    Examples
    --------
    >>> from solidgear import Scene, Segment
    >>> from solidgear.core.scene import Chamfer
    >>> head, rod = (
    ...     Segment.cylinder("ab"[k], y0=0.1 * k, length=0.1, diameter=0.08 - 0.04 * k) for k in (0, 1)
    ... )
    >>> scene = Scene.from_parts([head, rod], blends=[Chamfer(name="c", y=0.1, length="5 mm")])
    >>> [(s.name, round(s.outer0, 3), round(s.outer1, 3)) for s in coned(scene).segments]
    [('a', 0.04, 0.04), ('b (c)', 0.025, 0.02), ('b', 0.02, 0.02)]
    """
    filled = [c for c in scene.outline.corners if c.root and c.kind == "chamfer"]
    if not filled:
        return scene
    segments: list[Segment] = []
    for k, segment in enumerate(scene.segments):
        segments += _pieces(segment, [c for c in filled if c.owner == k])
    names = {c.name for c in filled}
    blends = tuple(b for b in scene.blends if b.name not in names)
    try:
        return scene.with_changes(segments=tuple(segments), blends=blends, features=())
    except SceneError:
        return scene


def _pieces(segment: Segment, chamfers: list[Corner]) -> list[Segment]:
    """Return the pieces of a segment cut where its chamfers end; the longest piece keeps the name."""
    marks = sorted({segment.y0, segment.y1, *(y for c in chamfers for y in c.span)})
    cuts = list(zip(marks, marks[1:]))
    longest = max(cuts, key=lambda ends: ends[1] - ends[0])
    pieces = []
    for a, b in cuts:
        fields: dict[str, Any] = {"y0": a, "y1": b}
        for field in ("outer", "inner"):
            for end, y in (("0", a), ("1", b)):
                position = (y - segment.y0) / (segment.y1 - segment.y0)
                low, high = getattr(segment, field + "0"), getattr(segment, field + "1")
                fields[field + end] = low + position * (high - low)
        present = [c for c in chamfers if c.span[0] <= a and b <= c.span[1]]
        for c in present:
            field = "outer" if c.surface == "outer" else "inner"
            for end, y in (("0", a), ("1", b)):
                # all of its height at the step, and nothing where it meets the cylinder
                share = round(1 - abs(y - c.y) / c.axial, 12)
                fields[field + end] += c.out * c.radial * share
        if (a, b) != longest:
            fields["name"] = f"{segment.name} ({', '.join(c.name for c in present)})"
        pieces.append(segment.with_changes(**fields))
    return pieces
