"""Patches of a body without an axis: faces that a file names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from solidgear.core.errors import SceneError
from solidgear.core.scene.typed import Model
from solidgear.core.scene.units import three

Triple = tuple[float, float, float]
#: point in place of the middle of a patch, in the axes of the file
Point = Annotated[tuple[float, float, float] | None, three("length", "along x, y and z")]

#: faces of a block, in its own axes
FACES = ("-x", "+x", "-y", "+y", "-z", "+z")
#: tables whose entries lie on a patch, and those that a body without an axis cannot have
ON_PATCHES = ("port", "bearing")
ELSEWHERE = ("housing", "load", "lubrication", "uncertain")


class Patch(Model):
    """A named patch of the surface."""

    name: str  #: of the group of faces in the file; of a block one of `FACES`
    point: Triple  #: its middle, by area, or the point that a scene names in its place, m
    extent: float  #: diagonal of the box around it, m


def point_of(station: Any) -> Triple:
    """Return the point (m) that a station is lumped into: that of a patch, or one on the axis."""
    patch = getattr(station, "patch", None)
    return (0.0, station.y, 0.0) if patch is None else patch.point


def off_patches(scene: Any) -> dict[str, Any]:
    """Return changes of a scene that take all stations off the patches of the body."""
    if scene.body is None or scene.body.edges is None:
        return {}
    port = scene.main_port and scene.main_port.with_changes(
        patch=None, y=scene.length / 2, lo=0.0, hi=scene.length
    )
    return {"port": port, "further_ports": (), "bearings": (), "masses": ()}


def block_patches(edges: Triple) -> tuple[Patch, ...]:
    """Return the six faces of a block (edges in m) that begins at y = 0."""
    low, high = (-edges[0] / 2, 0.0, -edges[2] / 2), (edges[0] / 2, edges[1], edges[2] / 2)
    middle = (0.0, edges[1] / 2, 0.0)
    out = []
    for place, name in enumerate(FACES):
        axis, end = place // 2, (low, high)[place % 2]
        point = tuple(end[k] if k == axis else middle[k] for k in range(3))
        extent = sum(e**2 for k, e in enumerate(edges) if k != axis) ** 0.5
        out.append(Patch(name=name, point=point, extent=extent))
    return tuple(out)


def _tables(value: Any) -> Iterator[tuple[int, Mapping[str, Any]]]:
    """Yield tables of a list, or the one in place of a list, with their places; others are refused
    elsewhere.
    """
    listed = [value] if isinstance(value, Mapping) else value
    for k, table in enumerate(listed if isinstance(listed, list) else ()):
        if isinstance(table, Mapping):
            yield k, table


def refuse_elsewhere(raw: Mapping[str, Any], body_kind: str) -> None:
    """Refuse tables that a body without an axis cannot have, and stations that name no patch."""
    problems = [
        SceneError(f"a {body_kind} has no place for this: leave it out", path=(key,))
        for key in ELSEWHERE
        if key in raw
    ]
    for key in ON_PATCHES:
        for k, table in _tables(raw.get(key)):
            if "patch" not in table:
                reason = f"this key is missing: on a {body_kind} name the faces, such as patch = "
                example = (
                    '"+x"' if body_kind == "block" else '"foot", a group of surfaces of the file'
                )
                problems.append(SceneError(reason + example, path=(key, k, "patch")))
    for k, table in _tables(raw.get("mass")):
        if "on" not in table:
            reason = "this key is missing: name the port or bearing that carries the mass"
            problems.append(SceneError(reason, path=("mass", k, "on")))
    if problems:
        raise SceneError.of(problems)


def fields_on_patch(
    words: Any, table: Mapping[str, Any], places: Any, *sizes: str
) -> dict[str, Any]:
    """Return the fields of a station on a patch; along y it is as long as the patch is large."""
    reason = "a patch has its place and size itself; leave one of them out"
    words.refuse(reason, "position", "from_", "at", "attach_to", "span", "seat", table=None)
    words.refuse(reason, "face", "seat_width", table=table)
    patch = places.patch(words.patch, words.point)
    if patch is None:
        return dict.fromkeys(("y", *sizes))
    y, half = patch.point[1], patch.extent / 2
    size = {"lo": y - half, "hi": y + half, "seat_width": patch.extent}
    return {"y": y, "patch": patch, **{key: size[key] for key in sizes}}


def patch_problems(station: Any) -> Iterator[SceneError]:
    """Yield problems of stations on patches: an attachment or data that faces cannot have."""
    if station.patch is None:
        return
    if station.attachment == "section":
        yield SceneError("a patch has no section: use average or rigid", path=("attachment",))
    if getattr(station, "catalogue", None) is not None:
        reason = "catalogue data are of a bearing around an axis: give a stiffness, or hold"
        yield SceneError(reason, path=("catalogue",))
