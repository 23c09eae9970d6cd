"""A part from a STEP or mesh file: read, turned, and the body of revolution inside it recognised."""

from __future__ import annotations

import hashlib
import math
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.errors import SceneError
from solidgear.meshing.decks import universal
from solidgear.meshing.decks.deck import reader_of
from solidgear.meshing.part_file import Found, coarser_meshes, content_of, read, skin
from solidgear.meshing.placing import TURNS, Placing, Triple, turn_of
from solidgear.meshing.quality import MeshError
from solidgear.meshing.round_part import ON_LINE, RoundPart, round_part
from solidgear.meshing.section_materials import Share, shared_out
from solidgear.meshing.shared_axis import shared_axis
from solidgear.meshing.step_unit import unit_said
from solidgear.scene.body_file import NONE, UNITS, BodyFile, BodyTable
from solidgear.scene.closed_form import volume_of
from solidgear.scene.outline import Frustum, Outline
from solidgear.scene.patches import block_patches
from solidgear.scene.recognised import Recognised

#: least share of the surface that is round about the axis, for a part to be a shaft
LEAST_ROUND = 0.2
#: of a part, m
LEAST_LENGTH, MOST_LENGTH = 1e-3, 20.0
#: relative difference of a size from what it is checked against
SIZE_CHECK = 1e-3
#: distance of an axis from the one that was written, over the largest radius: below, both are the same,
#: and above, it is another
SAME_AXIS, BESIDE = ON_LINE / 10, 1e-3
#: difference of directions that are one
AXIS = 1e-9
#: factors between units that are taken for one another
SLIPS = {1e3: "mm taken for m", 1e-3: "m taken for mm", 25.4: "mm taken for inch"}
SLIPS |= {1 / 25.4: "inch taken for mm", 39.37: "m taken for inch", 1 / 39.37: "inch taken for m"}


def recognise(table: BodyTable, folder: Path) -> Recognised:
    """A part and the body of revolution inside it, from a file in a folder; SceneError for a file
    that is no part, another unit or size than the table says, or a part that is not round about the
    axis.
    """
    if table.block is not None:
        return _block(table.block)
    *coarse, path = ((folder / file).resolve() for file in table.files)
    shaft = table.axis != NONE
    try:
        content = content_of(path)
        unit, doubt = _unit(table, path, content)
        foot = _foot(table)
        place = Placing(unit, turn_of(table.axis if shaft else "y"), foot)
        found_in = read(table, path, place, content)
        if shaft:
            place, found_in = _centred(table, place, found_in)
        points, triangles = skin(found_in)
        _sizes(table, points)
        coarser = coarser_meshes(table, coarse, place, found_in)
        found = round_part(points, triangles) if shaft else _rod(points, found_in.volume)
        if shaft and not found.share >= LEAST_ROUND:
            raise SceneError(_not_round(table, place, points, triangles, found), path=("axis",))
    except MeshError as error:
        raise SceneError(str(error), path=("body", table.key)) from None
    except SceneError as error:
        raise error.located(None, prefix=("body",)) from None
    # the lower end comes to y = 0; the origin that was asked for is a place like any other
    start = float(points[1].min())
    lower = np.array(place.foot) + np.array(place.turn).T @ (0.0, start, 0.0)
    x, y, z = (float(v) for v in lower)
    points = points - [[0.0], [start], [0.0]]
    shares, kinds = _shared_out(found_in, found.walls)
    walls = tuple(
        Frustum(_rounded(w.y0 - start), _rounded(w.y1 - start), *map(_rounded, w[2:]))
        for w in (share.wall for share in shares)
    )
    body = BodyFile(
        kind="step" if table.step is not None else "mesh",
        name=path.name,
        path=str(path),
        sha256=hashlib.sha256(content).hexdigest(),
        unit=unit,
        turn=place.turn,
        foot=(x, y, z),
        volume=found_in.volume,
        round_share=found.share,
        round_volume=volume_of(Outline(walls)) / found_in.volume,
        # the volume of a STEP file is that of its surfaces, and no triangle comes into it
        facets=0.0 if table.step is not None else found.facets / found_in.volume,
        beside_arcs=found.beside_arcs,
        tori=tuple(t._replace(y0=t.y0 - start, y1=t.y1 - start, y=t.y - start) for t in found.tori),
        groups=found_in.groups,
        told=() if table.materials else found_in.told,
        mixed=tuple(f"s{k}" for k, share in enumerate(shares, 1) if share.mixed),
        remarks=(*doubt, *found_in.remarks),
        edges=None if shaft else tuple(float(v) for v in np.ptp(points, axis=1)),
        coarser=coarser,
        patches=()
        if shaft
        else tuple(
            p.with_changes(point=(p.point[0], p.point[1] - start, p.point[2]))
            for p in found_in.patches
        ),
        **found_in.own_mesh,
    )
    cylinders = tuple(
        (s.r0 + s.r1, s.y0 - start, s.y1 - start) for s in found.surfaces if s.r0 == s.r1
    )
    origin = 0.0 if table.origin is None else -start
    return Recognised(
        body,
        walls,
        origin,
        cylinders,
        partial(seat_share, points, triangles),
        tuple(tuple((kinds[k], part) for k, part in share.groups) for share in shares),
    )


def _rod(points, volume: float) -> RoundPart:
    """A cylinder as long along y as a body without an axis, and of its volume: places are told along
    it, and nothing is solved.
    """
    low, high = float(points[1].min()), float(points[1].max())
    radius = math.sqrt(volume / math.pi / (high - low))
    return RoundPart((Frustum(low, high, radius, radius, 0.0, 0.0),), (), 0.0)


def _block(edges: list[float]) -> Recognised:
    """A rectangular block from y = 0 on; its one wall is the largest cylinder inside, by which places
    along y are told and nothing is solved.
    """
    for k, edge in enumerate(edges):
        if not LEAST_LENGTH <= edge <= MOST_LENGTH:
            raise SceneError(
                f"an edge of {1e3 * edge:.4g} mm is outside 1 mm to 20 m", path=("body", "block", k)
            )
    x, y, z = edges
    wall = Frustum(0.0, y, *(2 * (min(x, z) / 2,)), 0.0, 0.0)
    body = BodyFile(
        kind="block",
        name=f"{' x '.join(f'{1e3 * edge:.6g}' for edge in edges)} mm",
        path="",
        sha256="",
        unit=1.0,
        turn=TURNS["y"],
        foot=(0.0, 0.0, 0.0),
        volume=x * y * z,
        round_share=0.0,
        round_volume=volume_of(Outline((wall,))) / (x * y * z),
        edges=(x, y, z),
        patches=block_patches((x, y, z)),
    )
    return Recognised(body, (wall,), 0.0, (), lambda radius, lo, hi: 0.0)


def _rounded(value: float) -> float:
    return round(float(value), 13) + 0.0


def _unit(table: BodyTable, path: Path, content: bytes) -> tuple[float, tuple[str, ...]]:
    """Metres for each unit of the file, and a remark where a universal file says another than the table."""
    if table.step is not None:
        return _unit_of_step(table, content), ()
    told = None
    if reader_of(str(path)) == "universal":
        told = universal.unit_of(content.decode("utf-8", "replace"))
    if table.unit is None:
        if told is None:
            raise SceneError(
                f"this key is missing: {path.name} does not say it; one of {', '.join(UNITS)}",
                path=("unit",),
            )
        return told, ()
    unit = UNITS[table.unit]
    if told is None or math.isclose(unit, told, rel_tol=1e-6):
        return unit, ()
    named = {value: name for name, value in UNITS.items()}
    own = next((n for value, n in named.items() if math.isclose(value, told, rel_tol=1e-6)), "")
    remark = (
        f"its dataset 164 says that lengths are in {own or f'units of {told:g} m'}, and unit = "
        f'"{table.unit}" of the [body] is taken: one of both is wrong by a factor of '
        f"{max(unit / told, told / unit):.4g}"
    )
    return unit, (remark,)


def _unit_of_step(table: BodyTable, content: bytes) -> float:
    """Metres for each unit of a STEP file, which is held against the table."""
    head = content[:200].lstrip()
    if not head.startswith(b"ISO-10303-21"):
        raise MeshError('is no STEP file: it does not begin with "ISO-10303-21;"')
    if b"END-ISO-10303-21" not in content[-2000:]:
        raise MeshError('is cut off: it does not end with "END-ISO-10303-21;"')
    own = unit_said(content)
    if table.unit is not None and UNITS[table.unit] != UNITS[own]:
        raise SceneError(f"the file itself says {own}", path=("unit",))
    return UNITS[own]


def _foot(table: BodyTable) -> Triple:
    """The point on the axis that comes to y = 0, in the axes of the file, m."""
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


def _centred(table: BodyTable, place: Placing, found: Found) -> tuple[Placing, Found]:
    """A part whose own axis lies a little beside the one that was written, about its own."""
    points, triangles = skin(found)
    foot, along = shared_axis(points, triangles)
    along = along * np.sign(along[1])
    if not along[1] > 0.5:
        return place, found
    foot = foot - foot[1] / along[1] * along
    heights = np.array([points[1].min(), points[1].max()])
    off = np.hypot(*(foot[:, None] + along[:, None] / along[1] * heights)[[0, 2]]).max()
    largest = float(np.hypot(points[0], points[2]).max())
    if not SAME_AXIS * largest < off <= BESIDE * largest:
        return place, found
    turn = np.array(turn_of(tuple(along)))
    moved = found._replace(points=turn @ (found.points - foot[:, None]))
    if not round_part(*skin(moved)).share > round_part(points, triangles).share:
        return place, found
    x, y, z = (float(v) for v in place.back(foot[:, None])[:, 0])
    rows = (tuple(float(v) for v in row) for row in turn @ np.array(place.turn))
    told = f"its axis lies {1e6 * off:.2g} um beside {table.about} of the file, and is taken"
    moved = moved._replace(remarks=(*found.remarks, told))
    return Placing(place.unit, tuple(rows), (x, y, z)), moved  # type: ignore[arg-type]


def _shared_out(found: Found, walls) -> tuple[list[Share], list[int]]:
    """Materials of the frusta, and the first group of each material that they speak of.

    Groups of one material are one; walls stay where they are.
    """
    if not found.groups:
        return [Share(wall, ((0, 1.0),)) for wall in walls], [0]
    materials: list[Any] = []
    for group in found.groups:
        if group.material not in materials:
            materials.append(group.material)
    of = np.array([materials.index(g.material) for g in found.groups] + [-1])
    sides = of[found.sides]
    apart_ = sides[0] != sides[1]
    shares = shared_out(found.points, found.triangles[:, apart_], sides[:, apart_], walls)
    return shares, [int(np.flatnonzero(of == k)[0]) for k in range(len(materials))]


def _sizes(table: BodyTable, points) -> None:
    """Hold length, largest diameter and mass against what the table says."""
    length = float(np.ptp(points[1]))
    diameter = float(2 * np.hypot(points[0], points[2]).max())
    for k, (what, own) in enumerate((("length", length), ("largest diameter", diameter))):
        if table.size_check is None:
            break
        ratio = own / table.size_check[k]
        if not abs(ratio - 1) <= SIZE_CHECK:
            raise SceneError(
                f"the {what} of the part about {table.about} is {1e3 * own:.6g} mm{_slip(ratio)}",
                path=("size_check", k),
            )
    about = f" about {table.about}"
    if table.axis == NONE:
        length, about = float(np.ptp(points, axis=1).max()), ""
    if not LEAST_LENGTH <= length <= MOST_LENGTH:
        raise SceneError(
            f"the part is {length:.4g} m long{about}, outside 1 mm to 20 m: probably "
            "drawn in another unit than the file says",
            path=("unit",) if table.unit else (table.key,),
        )


def _slip(ratio: float) -> str:
    for factor, words in SLIPS.items():
        if abs(ratio / factor - 1) < 5e-3:
            return f", as if {words}"
    return ""


def _not_round(table: BodyTable, place: Placing, points, triangles, found: RoundPart) -> str:
    """Reason why a part is no shaft about its axis, and the axis about which it would be."""
    words = f"{100 * found.share:.0f} % of the surface is round about this axis"
    foot, along = shared_axis(points, triangles)
    turned = np.array(turn_of(tuple(along))) @ (points - foot[:, None])
    share = round_part(turned, triangles).share
    if share >= LEAST_ROUND:
        return words + _other_axis(table, place, points, foot, along, share)
    # m from here on
    raw = place.back(points)
    words = f"{words}, at least {100 * LEAST_ROUND:.0f} % makes a shaft"
    if table.mesh:
        words += f'; write axis = "{NONE}" for a body that is none'
    own = raw / place.unit
    for digits in range(6 if table.mesh else 0):
        step = 10.0**-digits * 1e3 * place.unit
        if np.abs(own - np.round(own, digits)).max() < 1e-4 * 10.0**-digits:
            near = 1e3 * ON_LINE * float(np.hypot(points[0], points[2]).max())
            if step > near:
                words += (
                    f"; coordinates of the file are rounded to {step:.2g} mm, and nodes of a round "
                    f"surface must lie within {near:.2g} mm of it: write more digits"
                )
            break
    return words


def _other_axis(table: BodyTable, place: Placing, points, foot, along, share: float) -> str:
    """Words on an axis in the scene, a point (3,) and a direction (3,), about which so much of the surface
    is round: how to write it.
    """
    direction = np.array(place.turn).T @ along
    sign = np.sign(direction[np.abs(direction).argmax()])
    direction, along = sign * direction, sign * along
    heights = along @ (points - foot[:, None])
    # where it leaves the lower end, so that places count from there as they do without an origin
    lowest = float(heights.min()) if table.origin is None else float(-along @ foot)
    x, y, z = (round(float(v), 9) + 0.0 for v in place.back((foot + lowest * along)[:, None])[:, 0])
    beside = float(np.linalg.norm(foot - (along @ foot) * along))
    close = [name for name in TURNS if np.abs(np.array(turn_of(name))[1] - direction).max() < AXIS]
    said = f'"{close[0]}"' if close else f"[{', '.join(f'{v:.10g}' for v in direction)}]"
    if beside <= ON_LINE * float(np.ptp(heights)):
        return f", and {100 * share:.0f} % about {said}"
    given = ", ".join(f"{1e3 * v:.4g}" for v in place.foot)
    same = bool(close) and close[0] == table.axis
    return (
        f", which goes through ({given}) mm of the file, and {100 * share:.0f} % about "
        f"{'one' if same else said} through ({', '.join(f'{1e3 * v:.10g}' for v in (x, y, z))}) mm: "
        f"write that point as origin{', and that axis' if not same else ''}"
    )


def seat_share(
    points: np.ndarray, triangles: np.ndarray, radius: float, lo: float, hi: float
) -> float:
    """Area of a surface of (3, t) triangles on a cylinder between two places, over that of the
    cylinder: a whole turn of chords is a little less than 1.
    """
    r = np.hypot(points[0], points[2])[triangles]
    on = (np.abs(r - radius) <= 10 * ON_LINE * radius).all(axis=0)
    a, b, c = (points[:, corner[on]] for corner in triangles)
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
