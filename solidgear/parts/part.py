"""A part from a STEP or mesh file: read, turned, and the body of revolution inside it
recognised.

The axis about which most of a surface is round, wherever it lies.

Normals of a surface of revolution meet its axis: with its direction d and moment m, and a normal n
at x, ``d . (x * n) + m . n = 0``, which is linear. Triangles have their normals to a part of their
size; corners lie on the surface itself, and all corners of a triangle on a cylinder are as far from
the axis. So normals find the axis roughly, and distances of corners to the last digits. Sides that
miss it by more than others weigh less and less, in both.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from solidgear.core import Outline, SceneError
from solidgear.core.meshing.placing import TURNS, Placing, Triple, turn_of
from solidgear.core.meshing.quality import MeshError
from solidgear.core.scene.closed_form import volume_of
from solidgear.core.scene.outline import Frustum
from solidgear.core.scene.patches import Patch, block_patches
from solidgear.parts.body_file import NONE, UNITS, BodyFile, BodyTable
from solidgear.parts.decks import universal
from solidgear.parts.decks.deck import reader_of
from solidgear.parts.part_file import PartContent, coarser_meshes, content_of, read, skin
from solidgear.parts.recognised import Recognised
from solidgear.parts.round_part import ON_LINE, RoundPart, round_part
from solidgear.parts.step_unit import SAME_UNIT, length_unit, unit_words

#: least share of the surface that is round about the axis, for a part to be a shaft
LEAST_ROUND = 0.2
#: of a part, m
LEAST_LENGTH, MOST_LENGTH = 1e-3, 20.0
#: relative difference between a size and the one in the table
SIZE_CHECK = 1e-3
#: distance of an axis from the one that was written, over the largest radius: below, both are the same,
#: and above, it is another
SAME_AXIS, NEAR_AXIS = ON_LINE / 10, 1e-3
#: difference of directions that are one
AXIS = 1e-9
#: two places along y nearer than this part of the length are one
SAME_PLACE = 2e-6
#: sections of a frustum that shares are taken from, and lines across each
SECTIONS, SCANS = 3, 200
#: factors between units that are taken for one another
SLIPS = {1e3: "mm taken for m", 1e-3: "m taken for mm", 25.4: "mm taken for inch"}
SLIPS |= {1 / 25.4: "inch taken for mm", 39.37: "m taken for inch", 1 / 39.37: "inch taken for m"}


class Share(NamedTuple):
    """A frustum and the groups of a part that it is made of."""

    wall: Frustum
    #: groups and their shares of its volume, roughly where there are several
    groups: tuple[tuple[int, float], ...]

    @property
    def mixed(self) -> bool:
        """True where several groups meet inside it."""
        return len(self.groups) > 1


def recognise(table: BodyTable, folder: Path) -> Recognised:
    """Read a part and recognise the body of revolution inside it, from a file in a folder;
    SceneError for a file that is no part, another unit or size than the table says, or a part that
    is not round about the axis.
    """
    if table.block is not None:
        return _block(table.block)
    *coarse, path = ((folder / file).resolve() for file in table.files)
    is_shaft = table.axis != NONE
    try:
        content = content_of(path)
        unit, doubt = _unit(table, path, content)
        foot = _foot(table)
        place = Placing(unit, turn_of(table.axis if is_shaft else "y"), foot)
        part = read(table, path, place, content)
        if is_shaft:
            place, part = _centred(table, place, part)
        points, triangles = skin(part)
        _check_sizes(table, points)
        coarser = coarser_meshes(table, coarse, place, part)
        body = round_part(points, triangles) if is_shaft else _rod(points, part.volume)
        if is_shaft and not body.share >= LEAST_ROUND:
            raise SceneError(_not_round(table, place, points, triangles, body), path=("axis",))
    except MeshError as error:
        raise SceneError(str(error), path=("body", table.key)) from None
    except SceneError as error:
        raise error.located(None, prefix=("body",)) from None
    # the lower end comes to y = 0; the origin of the table is a place like any other
    start = float(points[1].min())
    lower = np.array(place.foot) + np.array(place.turn).T @ (0.0, start, 0.0)
    x, y, z = (float(v) for v in lower)
    points = points - [[0.0], [start], [0.0]]
    down = np.array([0.0, start, 0.0])
    groups = tuple(g.with_changes(centre=tuple(g.centre - down)) for g in part.groups)
    _refuse_gaps(body.walls, start, float(np.ptp(points[1])))
    shares, first_groups = _shares(part, body.walls)
    walls = tuple(
        Frustum(_rounded(w.y0 - start), _rounded(w.y1 - start), *map(_rounded, w[2:]))
        for w in (share.wall for share in shares)
    )
    patches: tuple[Patch, ...] = ()
    if not is_shaft:
        patches = tuple(
            p.with_changes(point=(p.point[0], p.point[1] - start, p.point[2])) for p in part.patches
        )
    file = BodyFile(
        kind="step" if table.step is not None else "mesh",
        name=path.name,
        path=str(path),
        words=table.with_changes(materials={}, **{table.key: ""}),
        sha256=hashlib.sha256(content).hexdigest(),
        unit=unit,
        turn=place.turn,
        foot=(x, y, z),
        volume=part.volume,
        centre=tuple(part.centre - down),
        round_share=body.share,
        round_volume=volume_of(Outline(walls)) / part.volume,
        # the volume of a STEP file is that of its surfaces, and no triangle comes into it
        facets=0.0 if table.step is not None else body.facets / part.volume,
        beside_arcs=body.arc_deviation,
        tori=tuple(t._replace(y0=t.y0 - start, y1=t.y1 - start, y=t.y - start) for t in body.tori),
        uneven=tuple((lo - start, hi - start) for lo, hi in body.uneven),
        groups=groups,
        told=() if table.materials else part.material_groups,
        mixed=tuple(f"s{k}" for k, share in enumerate(shares, 1) if share.mixed),
        remarks=(*doubt, *part.remarks),
        edges=None if is_shaft else tuple(float(v) for v in np.ptp(points, axis=1)),
        coarser=coarser,
        patches=patches,
        **part.mesh_fields,
    )
    cylinders = tuple(
        (s.r0 + s.r1, s.y0 - start, s.y1 - start) for s in body.surfaces if s.r0 == s.r1
    )
    origin = 0.0 if table.origin is None else -start
    return Recognised(
        file,
        walls,
        origin,
        cylinders,
        partial(seat_share, points, triangles),
        tuple(tuple((first_groups[k], portion) for k, portion in share.groups) for share in shares),
    )


def _refuse_gaps(walls: Sequence[Frustum], start: float, length: float) -> None:
    """Refuse a part of which no section is seen from the axis somewhere along its length, m."""
    ends = [start, *(end for wall in walls for end in (wall.y0, wall.y1)), start + length]
    for before, after in zip(ends[::2], ends[1::2]):
        if after - before > SAME_PLACE * length:
            lo, hi = (1e3 * (y - start) for y in (before, after))
            raise SceneError(
                f"from {lo:.6g} to {hi:.6g} mm along it hardly anything of the part surrounds this "
                "axis: no shaft goes through there; write segments, or a mesh file with axis = "
                '"none"',
                path=("body", "axis"),
            )


def _rod(points, volume: float) -> RoundPart:
    """Return a cylinder as long along y as a body without an axis, and of the same volume: places
    are given along it, and nothing is solved.
    """
    low, high = float(points[1].min()), float(points[1].max())
    radius = math.sqrt(volume / math.pi / (high - low))
    return RoundPart((Frustum(low, high, radius, radius, 0.0, 0.0),), (), 0.0)


def _block(edges: list[float]) -> Recognised:
    """Return a rectangular block from y = 0 on; the one wall is the largest cylinder inside, along
    which places are given and nothing is solved.
    """
    for k, edge in enumerate(edges):
        if not LEAST_LENGTH <= edge <= MOST_LENGTH:
            raise SceneError(
                f"an edge of {1e3 * edge:.4g} mm is outside 1 mm to 20 m", path=("body", "block", k)
            )
    x, y, z = edges
    radius = min(x, z) / 2
    wall = Frustum(0.0, y, radius, radius, 0.0, 0.0)
    body = BodyFile(
        kind="block",
        name=f"{' x '.join(f'{1e3 * edge:.6g}' for edge in edges)} mm",
        path="",
        sha256="",
        unit=1.0,
        turn=TURNS["y"],
        foot=(0.0, 0.0, 0.0),
        volume=x * y * z,
        centre=(0.0, y / 2, 0.0),
        round_share=0.0,
        round_volume=volume_of(Outline((wall,))) / (x * y * z),
        edges=(x, y, z),
        patches=block_patches((x, y, z)),
    )
    return Recognised(body, (wall,), 0.0, (), lambda radius, lo, hi: 0.0)


def _rounded(value: float) -> float:
    return round(float(value), 13) + 0.0


def _unit(table: BodyTable, path: Path, content: bytes) -> tuple[float, tuple[str, ...]]:
    """Return metres for each unit of the file, and a remark where a universal file says another
    than the table.
    """
    if table.step is not None:
        return _unit_of_step(table, content), ()
    in_file = None
    if reader_of(str(path)) == "universal":
        in_file = universal.unit_of(content.decode("utf-8", "replace"))
    if table.unit is None:
        if in_file is None:
            raise SceneError(
                f"this key is missing: {path.name} does not give the unit; write one of "
                f"{', '.join(UNITS)}",
                path=("unit",),
            )
        return in_file, ()
    unit = UNITS[table.unit]
    if in_file is None or math.isclose(unit, in_file, rel_tol=SAME_UNIT):
        return unit, ()
    remark = (
        f"its dataset 164 says that lengths are in {unit_words(in_file)}, but unit = "
        f'"{table.unit}" of the [body] is taken: one of them is wrong by a factor of '
        f"{max(unit / in_file, in_file / unit):.4g}"
    )
    return unit, (remark,)


def _unit_of_step(table: BodyTable, content: bytes) -> float:
    """Return metres for each unit of a STEP file, and refuse another unit than that of the
    table.
    """
    head = content[:200].lstrip()
    if not head.startswith(b"ISO-10303-21"):
        raise MeshError('is no STEP file: it does not begin with "ISO-10303-21;"')
    if b"END-ISO-10303-21" not in content[-2000:]:
        raise MeshError('is cut off: it does not end with "END-ISO-10303-21;"')
    unit = length_unit(content)
    if table.unit is not None and not math.isclose(UNITS[table.unit], unit, rel_tol=SAME_UNIT):
        raise SceneError(f"the file itself says {unit_words(unit)}", path=("unit",))
    return unit


def _foot(table: BodyTable) -> Triple:
    """Return the point on the axis that comes to y = 0, in the axes of the file, m."""
    if table.origin is None:
        return (0.0, 0.0, 0.0)
    if isinstance(table.origin, tuple):
        return table.origin
    # along the axis of the file, whichever way the shaft runs
    if isinstance(table.axis, str):
        along = "y" if table.axis == NONE else table.axis[-1]
        x, y, z = (table.origin if name == along else 0.0 for name in "xyz")
    else:
        x, y, z = (table.origin * v for v in table.axis)
    return (x, y, z)


def _centred(table: BodyTable, place: Placing, part: PartContent) -> tuple[Placing, PartContent]:
    """Turn a part whose axis lies a little beside the one that was written about that axis; return
    the placing and the part.
    """
    points, triangles = skin(part)
    foot, along = shared_axis(points, triangles)
    along = along * np.sign(along[1])
    if not along[1] > 0.5:
        return place, part
    foot = foot - foot[1] / along[1] * along
    heights = np.array([points[1].min(), points[1].max()])
    distance = np.hypot(*(foot[:, None] + along[:, None] / along[1] * heights)[[0, 2]]).max()
    largest = float(np.hypot(points[0], points[2]).max())
    if not SAME_AXIS * largest < distance <= NEAR_AXIS * largest:
        return place, part
    turn = np.array(turn_of(tuple(along)))
    moved = part._replace(
        points=turn @ (part.points - foot[:, None]),
        centre=turn @ (part.centre - foot),
        groups=tuple(
            g.with_changes(centre=tuple(turn @ (np.array(g.centre) - foot))) for g in part.groups
        ),
    )
    if not round_part(*skin(moved)).share > round_part(points, triangles).share:
        return place, part
    x, y, z = (float(v) for v in place.to_file(foot[:, None])[:, 0])
    rows = (tuple(float(v) for v in row) for row in turn @ np.array(place.turn))
    remark = f"its axis lies {1e6 * distance:.2g} um beside {table.about} of the file, and is taken"
    moved = moved._replace(remarks=(*part.remarks, remark))
    return Placing(place.unit, tuple(rows), (x, y, z)), moved  # type: ignore[arg-type]


def _shares(part: PartContent, walls) -> tuple[list[Share], list[int]]:
    """Return the shares of materials in the frusta, and the first group of each material by number.

    Groups of one material are one; walls stay where they are.
    """
    if not part.groups:
        return [Share(wall, ((0, 1.0),)) for wall in walls], [0]
    materials: list[Any] = []
    for group in part.groups:
        if group.material not in materials:
            materials.append(group.material)
    material_of = np.array([materials.index(g.material) for g in part.groups] + [-1])
    sides = material_of[part.sides]
    border = sides[0] != sides[1]
    shares = shared_among_groups(part.points, part.triangles[:, border], sides[:, border], walls)
    return shares, [int(np.flatnonzero(material_of == k)[0]) for k in range(len(materials))]


def shared_among_groups(
    points: np.ndarray, triangles: np.ndarray, sides: np.ndarray, walls: Sequence[Frustum]
) -> list[Share]:
    """Cut the frusta of a part where groups meet in a plane across the axis, and return the groups
    in each: one group only if no other comes into it anywhere.

    `triangles` (3, t) are the surface of the part and the faces between groups, `sides` (2, t) the
    groups on both sides of each, -1 outside; y is the axis, m.
    """
    y = points[1][triangles]
    low, high = y.min(axis=0), y.max(axis=0)
    near = SAME_PLACE * (walls[-1].y1 - walls[0].y0)
    across = high - low <= near
    between = (sides >= 0).all(axis=0)
    out = []
    for piece in _cut_at(walls, np.unique(low[between & across]), near):
        # a triangle that only touches the end of a frustum is not in it
        inside = ~across & (high > piece.y0 + near) & (low < piece.y1 - near)
        groups = np.unique(sides[:, inside])
        groups = groups[groups >= 0]
        if len(groups) == 1:
            out.append(Share(piece, ((int(groups[0]), 1.0),)))
            continue
        areas = np.zeros(len(groups))
        for place in (np.arange(SECTIONS) + 0.4837) / SECTIONS:
            y_of_section = piece.y0 + place * (piece.y1 - piece.y0)
            for k, group in enumerate(groups):
                of_group = inside & (sides == group).any(axis=0)
                areas[k] += _section_area(points, triangles[:, of_group], y_of_section)
        shares = areas / areas.sum()
        out.append(Share(piece, tuple((int(g), float(s)) for g, s in zip(groups, shares))))
    return out


def _cut_at(walls: Sequence[Frustum], places: Iterable[float], near: float) -> Iterable[Frustum]:
    for wall in walls:
        start = wall
        for place in places:
            if start.y0 + near < place < start.y1 - near:
                t = (place - start.y0) / (start.y1 - start.y0)
                outer = start.outer0 + t * (start.outer1 - start.outer0)
                inner = start.inner0 + t * (start.inner1 - start.inner0)
                yield start._replace(y1=float(place), outer1=outer, inner1=inner)
                start = start._replace(y0=float(place), outer0=outer, inner0=inner)
        yield start


def _section_area(points: np.ndarray, triangles: np.ndarray, y: float) -> float:
    """Return the area inside a closed surface of (3, t) triangles facing either way at one place y,
    m^2, within about a hundredth, by lines across it; no node of the surface lies there.

    Examples
    --------
    >>> square = np.array([[1, 0, 1], [-1, 0, 1], [-1, 0, -1], [1, 0, -1]], float)
    >>> points = np.vstack([square, square + [0, 2, 0]]).T
    >>> k, after = np.arange(4), (np.arange(4) + 1) % 4
    >>> sides = np.hstack([[k, after, k + 4], [after, after + 4, k + 4]])
    >>> round(float(_section_area(points, sides, 0.7)), 9)
    4.0
    """
    corners = points[:, triangles]  # (3, corner, t)
    hits = []
    for i, j in ((0, 1), (1, 2), (2, 0)):
        p, q = corners[:, i], corners[:, j]
        crossed = (p[1] < y) != (q[1] < y)
        t = np.divide(y - p[1], q[1] - p[1], out=np.zeros(len(crossed)), where=crossed)
        hits.append((crossed, p + t * (q - p)))
    # two sides of a triangle are crossed, or none
    first = np.where(hits[0][0], hits[0][1], hits[1][1])
    second = np.where(hits[2][0], hits[2][1], hits[1][1])
    cut = sum(crossed.astype(int) for crossed, _ in hits) == 2
    (x0, _, z0), (x1, _, z1) = first[:, cut], second[:, cut]
    if not len(x0):
        return 0.0
    lowest, highest = min(z0.min(), z1.min()), max(z0.max(), z1.max())
    step = (highest - lowest) / SCANS
    area = 0.0
    for z in lowest + step * (np.arange(SCANS) + 0.5):
        meets = (z0 < z) != (z1 < z)
        t = (z - z0[meets]) / (z1[meets] - z0[meets])
        x = np.sort(x0[meets] + t * (x1[meets] - x0[meets]))
        area += step * float((x[1::2] - x[: len(x) // 2 * 2 : 2]).sum())
    return area


def _check_sizes(table: BodyTable, points) -> None:
    """Refuse a part whose length or largest diameter is not that of the table."""
    length = float(np.ptp(points[1]))
    diameter = float(2 * np.hypot(points[0], points[2]).max())
    for k, (name, size) in enumerate((("length", length), ("largest diameter", diameter))):
        if table.size_check is None:
            break
        ratio = size / table.size_check[k]
        if not abs(ratio - 1) <= SIZE_CHECK:
            raise SceneError(
                f"the {name} of the part about {table.about} is {1e3 * size:.6g} mm{_slip(ratio)}",
                path=("size_check", k),
            )
    about = f" about {table.about}"
    if table.axis == NONE:
        length, about = float(np.ptp(points, axis=1).max()), ""
    if not LEAST_LENGTH <= length <= MOST_LENGTH:
        raise SceneError(
            f"the part is {length:.4g} m long{about}, outside 1 mm to 20 m: probably drawn in "
            "another unit than the file's",
            path=("unit",) if table.unit else (table.key,),
        )


def _slip(ratio: float) -> str:
    for factor, words in SLIPS.items():
        if abs(ratio / factor - 1) < 5e-3:
            return f", as if {words}"
    return ""


def _not_round(table: BodyTable, place: Placing, points, triangles, body: RoundPart) -> str:
    """Return the reason why a part is no shaft about the axis, and the axis about which it would
    be.
    """
    words = f"{100 * body.share:.0f} % of the surface is round about this axis"
    foot, along = shared_axis(points, triangles)
    turned = np.array(turn_of(tuple(along))) @ (points - foot[:, None])
    share = round_part(turned, triangles).share
    if share >= LEAST_ROUND:
        return words + _other_axis(table, place, points, foot, along, share)
    # m from here on
    raw = place.to_file(points)
    words = f"{words}, at least {100 * LEAST_ROUND:.0f} % makes a shaft"
    if table.mesh:
        words += f'; write axis = "{NONE}" for a body that is none'
    coordinates = raw / place.unit
    for digits in range(6 if table.mesh else 0):
        step = 10.0**-digits * 1e3 * place.unit
        if np.abs(coordinates - np.round(coordinates, digits)).max() < 1e-4 * 10.0**-digits:
            near = 1e3 * ON_LINE * float(np.hypot(points[0], points[2]).max())
            if step > near:
                words += (
                    f"; coordinates of the file are rounded to {step:.2g} mm, and nodes of a round "
                    f"surface must lie within {near:.2g} mm of it: write more digits"
                )
            break
    return words


def _other_axis(table: BodyTable, place: Placing, points, foot, along, share: float) -> str:
    """Return a clause on an axis in the scene, a point (3,) and a direction (3,), about which a
    larger share of the surface is round: how to write it.
    """
    direction = np.array(place.turn).T @ along
    sign = np.sign(direction[np.abs(direction).argmax()])
    direction, along = sign * direction, sign * along
    heights = along @ (points - foot[:, None])
    # where it leaves the lower end, so that places count from there as they do without an origin
    lowest = float(heights.min()) if table.origin is None else float(-along @ foot)
    x, y, z = (
        round(float(v), 9) + 0.0 for v in place.to_file((foot + lowest * along)[:, None])[:, 0]
    )
    distance = float(np.linalg.norm(foot - (along @ foot) * along))
    close = [name for name in TURNS if np.abs(np.array(turn_of(name))[1] - direction).max() < AXIS]
    axis = f'"{close[0]}"' if close else f"[{', '.join(f'{v:.10g}' for v in direction)}]"
    if distance <= ON_LINE * float(np.ptp(heights)):
        return f", and {100 * share:.0f} % about {axis}"
    foot_in_mm = ", ".join(f"{1e3 * v:.4g}" for v in place.foot)
    same_axis = bool(close) and close[0] == table.axis
    return (
        f", which goes through ({foot_in_mm}) mm of the file, and {100 * share:.0f} % about "
        f"{'one' if same_axis else axis} through ({', '.join(f'{1e3 * v:.10g}' for v in (x, y, z))}) mm: "
        f"write that point as origin{', and that axis' if not same_axis else ''}"
    )


def seat_share(
    points: np.ndarray, triangles: np.ndarray, radius: float, lo: float, hi: float
) -> float:
    """Return the area of a surface of (3, t) triangles on a cylinder between two places, over that
    of the cylinder: a whole turn of chords is a little less than 1.
    """
    r = np.hypot(points[0], points[2])[triangles]
    on_cylinder = (np.abs(r - radius) <= 10 * ON_LINE * radius).all(axis=0)
    a, b, c = (points[:, corner[on_cylinder]] for corner in triangles)
    area = np.linalg.norm(np.cross((b - a).T, (c - a).T), axis=1) / 2
    steps = 16
    inside = np.zeros(len(area))
    for i in range(steps):
        for j in range(steps - i):
            for third in (1 / 3, 2 / 3) if i + j < steps - 1 else (1 / 3,):
                s, t = (i + third) / steps, (j + third) / steps
                y = a[1] + s * (b[1] - a[1]) + t * (c[1] - a[1])
                inside += (y >= lo) & (y <= hi)
    return float((area * inside).sum() / steps**2 / (2 * np.pi * radius * (hi - lo)))


#: rounds of weighing: residuals fall to rounding in some ten
ROUNDS = 40
#: residuals that normals of triangles have by themselves, and corners, over the size of the part
ROUGH, FINE = 3e-2, 1e-9


def shared_axis(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a point (3,) on the axis, m, and the direction (3,), of length one; of a surface that
    is round about nothing, of some line.

    Examples
    --------
    >>> turn = 2 * np.pi * np.arange(24) / 24
    >>> ring = np.array([2 + np.cos(turn), 0 * turn, np.sin(turn)])
    >>> points = np.hstack([ring, ring + [[0], [3], [0]]])
    >>> k, after = np.arange(24), (np.arange(24) + 1) % 24
    >>> sides = np.hstack([[k, after, 24 + k], [after, 24 + after, 24 + k]])
    >>> foot, along = shared_axis(points, sides)
    >>> abs(along).round(9).tolist(), abs(foot[[0, 2]]).round(9).tolist()
    ([0.0, 1.0, 0.0], [2.0, 0.0])
    """
    middle = points.mean(axis=1, keepdims=True)
    size = float(np.abs(points - middle).max())
    corners = ((points - middle) / size)[:, triangles]
    foot, along = _refined(corners, *_rough(corners))
    return middle[:, 0] + size * foot, along


def _rough(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the axis by the normals of triangles, with corners (3, 3, t)."""
    a, b, c = corners.transpose(1, 0, 2)
    normal = np.cross((b - a).T, (c - a).T)
    area = np.linalg.norm(normal, axis=1)
    normal /= np.maximum(area, 1e-300)[:, None]
    rows = np.hstack([np.cross(corners.mean(axis=1).T, normal), normal])
    weight = area
    for _ in range(ROUNDS):
        gram = (rows * weight[:, None]).T @ rows
        # of all lines with a direction of length one
        dd, dm, mm = gram[:3, :3], gram[:3, 3:], gram[3:, 3:]
        back = -np.linalg.pinv(mm, rcond=1e-12) @ dm.T
        along = np.linalg.eigh(dd + dm @ back)[1][:, 0]
        residual = rows @ np.concatenate([along, back @ along])
        weight = area / (residual**2 + ROUGH**2)
    return np.cross(along, back @ along), along


def _refined(corners, foot, along) -> tuple[np.ndarray, np.ndarray]:
    """Return the axis by the distances of corners from it."""
    a, b, c = corners.transpose(1, 0, 2)
    area = np.linalg.norm(np.cross((b - a).T, (c - a).T), axis=1)
    near = ROUGH
    for _ in range(ROUNDS):
        side = np.linalg.svd(along[None])[2][1:]
        arm = corners - foot[:, None, None]
        height = np.einsum("i,ict->ct", along, arm)
        across = np.einsum("ki,ict->kct", side, arm)
        radius = np.maximum(np.linalg.norm(across, axis=0), 1e-12)
        out = across / radius
        # of a shift along either side, and a tilt towards it
        slope = np.concatenate([-out, -out * height])
        residual = (radius - radius.mean(axis=0)).ravel()
        slope = (slope - slope.mean(axis=1, keepdims=True)).reshape(4, -1)
        # faces across the axis say nothing of it
        steep = np.ptp(height, axis=0) > 1e-6
        share = np.tile(area * steep, 3)
        weight = share / (residual**2 + near**2)
        step = np.linalg.lstsq(
            (slope * weight) @ slope.T, -(slope * weight) @ residual, rcond=1e-12
        )[0]
        foot = foot + step[:2] @ side
        along = along + step[2:] @ side
        along /= np.linalg.norm(along)
        near = max(FINE, near / 2)
    return foot - (foot @ along) * along, along
