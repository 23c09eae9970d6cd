"""Rules for fillets and chamfers on their shaft: every problem in a sentence of its own."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from solidgear.errors import SceneError
from solidgear.scene.blends import Blend, Corner
from solidgear.scene.outline import TOUCH, radii_of
from solidgear.scene.parts import Segment

#: a shaft carries no more of them
MOST_BLENDS = 40
#: least size over the radius of the edge: smaller ones ask for meshes without end
SMALLEST = 2e-3
#: of a plane face, and of the cylinder between two edges, that may go to fillets and chamfers
MOST_OF_FACE, MOST_OF_LENGTH = 0.95, 0.95


def blend_problems(
    segments: Sequence[Segment],
    blends: Sequence[Blend],
    stations: Sequence[Any] = (),
    features: Sequence[Any] = (),
) -> Iterator[SceneError]:
    """Fillets and chamfers that do not fit their shaft, what sits on it, or its features."""
    if len(blends) > MOST_BLENDS:
        reason = (
            f"{len(blends)} fillets and chamfers are more than the {MOST_BLENDS} a shaft may have"
        )
        yield SceneError(reason, path=("blends",))
        return
    names = {f.name for f in features}
    earlier: list[tuple[Blend, Corner]] = []
    for i, blend in enumerate(blends):
        if blend.name in names:
            yield SceneError(
                "another feature has this name; each needs its own", path=("blends", i, "name")
            )
        names.add(blend.name)
        try:
            corner = blend.corner(segments)
        except SceneError as error:
            yield error.located(None, path=("blends", i, *error.path))
            continue
        key, reason = _misfit(blend, corner, segments, earlier, stations, features)
        if reason:
            yield SceneError(reason, path=("blends", i, key))
        earlier.append((blend, corner))


def _misfit(blend, corner, segments, earlier, stations, features) -> tuple[str, str]:
    """Field and reason of the first thing that is wrong with a fillet or chamfer, or two empty
    texts.
    """
    owner, kind, key = segments[corner.owner], blend.what, blend.size_key
    for neighbour, edge in earlier:
        if (edge.joint, edge.r, edge.surface) == (corner.joint, corner.r, corner.surface):
            return "y", f'this edge has "{neighbour.name}" already'
    if min(corner.axial, corner.radial) < SMALLEST * corner.r:
        return key, (
            f"a {kind} under {SMALLEST:g} of the radius, {corner.r:.6g} m, is no {kind}: "
            "leave it out, or look at the units"
        )
    face = _face_height(corner, segments)
    if corner.radial > face + TOUCH:
        return key, f"a {kind} of {corner.radial:.6g} m does not fit the face of {face:.6g} m"
    same_face = [edge for _, edge in earlier if _same_face(edge, corner, segments)]
    if corner.radial + sum(edge.radial for edge in same_face) > MOST_OF_FACE * face:
        hint = f' beside "{same_face[0].name}"' if same_face else ""
        return key, (
            f"a {kind} of {corner.radial:.6g} m{hint} leaves less than a twentieth of the face "
            f"of {face:.6g} m"
        )
    if corner.axial > owner.length / 2 + TOUCH:
        return key, (
            f'a {kind} reaches {corner.axial:.6g} m along "{owner.name}", beyond half its length of '
            f"{owner.length:.6g} m"
        )
    for neighbour, edge in earlier:
        if (edge.owner, edge.surface) == (corner.owner, corner.surface) and (
            edge.axial + corner.axial > MOST_OF_LENGTH * owner.length
        ):
            return key, (
                f'with "{neighbour.name}" at its other end nothing is left of the cylinder '
                f'"{owner.name}", {owner.length:.6g} m long'
            )
    lo, hi = corner.span
    reach = f"the {kind} reaches from {lo:.6g} to {hi:.6g} m"
    for s in stations:
        if corner.surface == "outer" and min(s.hi, hi) - max(s.lo, lo) > TOUCH:
            return key, (
                f'{reach}, into the seat of "{s.name}" ({s.lo:.6g} to {s.hi:.6g} m), which must '
                "stay a cylinder"
            )
        ends_inside = [y for y in (s.lo, s.hi) if lo + TOUCH < y < hi - TOUCH]
        if ends_inside:
            return key, (
                f'{reach}, and the seat of "{s.name}" ends inside of that, at '
                f"{ends_inside[0]:.6g} m; let it end elsewhere"
            )
        # the face itself is plane at the end of a shaft
        at_end = abs(s.y - corner.y) <= TOUCH and corner.y in (0.0, segments[-1].y1)
        if lo - TOUCH <= s.y <= hi + TOUCH and not at_end:
            return key, (
                f'{reach}, and "{s.name}" is at {s.y:.6g} m; put the one or the other elsewhere, '
                "since no section there is plane"
            )
    for f in features:
        first, last = f.span(segments)
        if first < hi - TOUCH and lo + TOUCH < last:
            return key, f'{reach}, into the {f.what} "{f.name}"'
    return "", ""


def _face_height(corner: Corner, segments: Sequence[Segment]) -> float:
    """Of the plane face beside an edge, m."""
    segment = segments[corner.owner]
    k = corner.joint
    if k in (0, len(segments)):
        return segment.outer0 - segment.inner0 if k == 0 else segment.outer1 - segment.inner1
    lower, upper = (radii_of(s, corner.surface) for s in segments[k - 1 : k + 1])
    return abs(lower[1] - upper[0])


def _same_face(a: Corner, b: Corner, segments: Sequence[Segment]) -> bool:
    return a.joint == b.joint and (a.joint in (0, len(segments)) or a.surface == b.surface)
