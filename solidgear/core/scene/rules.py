"""Rules for segments of one shaft and for things on it, one sentence for each problem.

Numbers in m. Paths of problems are those of a `Scene`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import isclose
from typing import TYPE_CHECKING, Any

from solidgear.core.errors import SceneError, listed, nearest, show
from solidgear.core.quantity import AT, STIFFNESS, Quantity
from solidgear.core.scene.feature_rules import feature_problems
from solidgear.core.scene.limits import (
    MOST_BEARINGS,
    MOST_BLENDS,
    MOST_LOADS,
    MOST_MASSES,
    MOST_OF_FACE,
    MOST_OF_LENGTH,
    MOST_PORTS,
    MOST_SEGMENTS,
    MOST_UNLIKE,
    SHORTEST,
    SLIMMEST,
    SMALLEST_BLEND,
    THINNEST,
    TOUCH,
)
from solidgear.core.scene.outline import Outline, radii_of
from solidgear.core.scene.units import TYPED

if TYPE_CHECKING:
    from solidgear.core.scene.blends import Blend
    from solidgear.core.scene.corner import Corner
    from solidgear.core.scene.feature import OnSegment
    from solidgear.core.scene.parts import Material, Segment
    from solidgear.core.scene.point_mass import PointMass
    from solidgear.core.scene.shaft_load import ShaftLoad
    from solidgear.core.scene.stations import Bearing, Port
    from solidgear.core.scene.tables import BearingData


#: surface of a load, which may lie on a seat or below a point
LOADED = "loaded surface"


def shaft_problems(segments: Sequence[Segment]) -> list[SceneError]:
    """Return problems of segments as one shaft; proportions are judged only where segments lie end to
    end and have a sensible size.
    """
    if not segments:
        return [SceneError("a scene needs at least one segment", path=("segments",))]
    if len(segments) > MOST_SEGMENTS:
        return [SceneError(too_many("segments", len(segments), MOST_SEGMENTS), path=("segments",))]
    return [*_end_to_end(segments)] or [*_sized(segments)] or [*_proportioned(segments)]


def too_many(plural: str, count: int, most: int) -> str:
    """Return the reason to refuse a list longer than that of any shaft."""
    hint = ""
    if plural == "segments":
        hint = "; join pieces into one segment, and use a few cones for a curve"
    return f"{count} {plural} are more than the {most} a shaft may have{hint}"


def _end_to_end(segments: Sequence[Segment]) -> Iterator[SceneError]:
    end, names = 0.0, set()
    for i, segment in enumerate(segments):
        if abs(segment.y0 - end) > TOUCH:
            yield SceneError(
                f"segments lie end to end from y = 0, so this must be {end:.6g}",
                path=("segments", i, "y0"),
            )
        if segment.name in names:
            yield SceneError(
                "another segment has this name; each needs its own", path=("segments", i, "name")
            )
        end = segment.y1
        names.add(segment.name)


def _sized(segments: Sequence[Segment]) -> Iterator[SceneError]:
    end = segments[-1].y1
    for i, segment in enumerate(segments):
        radius = max(segment.outer0, segment.outer1)
        if radius > 10.0:
            yield SceneError(
                f"a radius of {radius:.6g} m is above 10 m: probably wrong units",
                path=("segments", i, "outer0"),
            )
    if not 1e-3 <= end <= 20.0:
        i = max(range(len(segments)), key=lambda k: segments[k].length)
        yield SceneError(
            f"the shaft is {end:.6g} m long, outside 1 mm to 20 m: probably wrong units",
            path=("segments", i, "y1"),
        )


def _proportioned(segments: Sequence[Segment]) -> Iterator[SceneError]:
    end = segments[-1].y1
    for i, segment in enumerate(segments):
        previous = segments[i - 1] if i else None
        if previous and not (
            max(previous.inner1, segment.inner0) < min(previous.outer1, segment.outer0)
        ):
            reason = (
                f'shares no end face with "{previous.name}" '
                f"(radii {previous.inner1:.6g} to {previous.outer1:.6g} m there, "
                f"{segment.inner0:.6g} to {segment.outer0:.6g} m here); they must overlap"
            )
            yield SceneError(reason, path=("segments", i, "outer0"))
        for end_digit in "01":
            outer, inner = (
                getattr(segment, "outer" + end_digit),
                getattr(segment, "inner" + end_digit),
            )
            if 2 * outer < SLIMMEST * end:
                reason = (
                    f"a diameter of {2 * outer:.6g} m is under a thousandth of the length "
                    f"of the shaft, {end:.6g} m: probably wrong units"
                )
                yield SceneError(reason, path=("segments", i, "outer" + end_digit))
            if outer - inner < THINNEST * outer:
                reason = (
                    f"leaves a wall of {outer - inner:.3g} m at a radius of {outer:.6g} m, "
                    "under one in ten thousand: probably wrong units"
                )
                yield SceneError(reason, path=("segments", i, "inner" + end_digit))
        yield from _unlike(segments[0].material, segment.material, i)
        if segment.length < SHORTEST * end:
            reason = (
                f"a segment of {segment.length:.6g} m is under a millionth of the length "
                f"of the shaft, {end:.6g} m: probably wrong units"
            )
            yield SceneError(reason, path=("segments", i, "y1"))


def _unlike(first: Material, material: Material, i: int) -> Iterator[SceneError]:
    for key, property_name, unit, value in (
        ("E", "modulus", "Pa", lambda m: m.E),
        ("density", "density", "kg/m^3", lambda m: m.density),
        ("E", "ratio of modulus to density", "m^2/s^2", lambda m: m.E / m.density),
    ):
        a, b = value(material), value(first)
        if max(a, b) > MOST_UNLIKE * min(a, b):
            reason = (
                f"a {property_name} of {a:.3g} {unit} beside {b:.3g} in the first segment: unlike by more "
                f"than {MOST_UNLIKE:g}, which costs digits; probably wrong units"
            )
            yield SceneError(reason, path=("segments", i, "material", key))
            return


def problems_between(
    segments: Sequence[Segment],
    *,
    ports: Sequence[Port],
    bearings: Sequence[Bearing],
    masses: Sequence[PointMass],
    loads: Sequence[ShaftLoad],
    features: Sequence[OnSegment],
    blends: Sequence[Blend],
    complete: bool = True,
) -> Iterator[SceneError]:
    """Yield problems between things on a sound shaft, the main port first; names are judged only
    where ports and bearings are complete.
    """
    yield from station_problems(segments, ports, bearings, masses, loads)
    if complete:
        yield from mass_problems(ports, bearings, masses)
        yield from preload_problems(bearings)
    yield from feature_problems(segments, features)
    seated = [mass for mass in masses if mass.on is None]
    loaded = [load.seat for load in loads if load.seat is not None]
    sound = [f for f in features if any(f.segment == s.name for s in segments)]
    stations = [*ports, *bearings, *seated, *loaded]
    yield from blend_problems(segments, blends, stations, sound)


def preload_problems(bearings: Sequence[Bearing]) -> Iterator[SceneError]:
    """Yield a problem of preloaded rows that all hold the shaft the same way."""
    rows = [(k, b, b.catalogue) for k, b in enumerate(bearings) if b.catalogue is not None]
    rows = [row for row in rows if row[2].faces_one_way]
    pressed = [b for _, b, data in rows if data.preload is not None]
    ways = {data.holds for *_, data in rows}
    if len(pressed) == len(rows) == 2 and len(ways) == 2:
        yield from _two_preloads(rows)
    if len(pressed) < 2 or len(ways) > 1:
        return
    way = ways.pop()
    opposite = "-y" if way == "+y" else "+y"
    lower, *_, upper = sorted(rows, key=lambda row: row[1].y)
    # back to back, the lower one holds towards +y
    o, x = (upper, lower) if way == "+y" else (lower, upper)
    yield SceneError(
        f"{listed([repr(b.name) for b in pressed])} are preloaded and all hold the shaft towards "
        f"{way}, but a preload needs a row that holds it towards {opposite}: turn one, for an O "
        f"arrangement {o[1].name!r}, for X {x[1].name!r}, or leave the preload out",
        path=("bearings", o[0], "catalogue", "holds"),
    )


def _two_preloads(rows: Sequence[tuple[int, Bearing, BearingData]]) -> Iterator[SceneError]:
    """Yield a problem of a pair with two preloads that differ, which no shaft at rest has."""
    forces = [data.preload.force or 0.0 for *_, data in rows if data.preload is not None]
    if all(forces) and not isclose(forces[0], forces[1], rel_tol=TYPED):
        forces_text = " and ".join(
            f"{force:.6g} N at {b.name!r}" for force, (_, b, _) in zip(forces, rows)
        )
        yield SceneError(
            f"a pair of bearings has one preload, but here are {forces_text}; "
            "give it once, at either",
            path=("bearings", rows[1][0], "catalogue", "preload"),
        )


def station_problems(
    segments: Sequence[Segment],
    ports: Sequence[Port],
    bearings: Sequence[Bearing],
    masses: Sequence[PointMass] = (),
    loads: Sequence[ShaftLoad] = (),
) -> Iterator[SceneError]:
    """Yield problems of ports (the main one first) and seats that leave the shaft or its smooth
    surfaces, overlap or share a name.
    """
    length, jumps = segments[-1].y1, Outline(segments).steps
    for kind, stations, most in (
        ("bearings", bearings, MOST_BEARINGS),
        ("ports", ports, MOST_PORTS),
        ("loads", loads, MOST_LOADS),
    ):
        if len(stations) > most:
            key = "further_ports" if kind == "ports" else kind
            yield SceneError(too_many(kind, len(stations), most), path=(key,))
            return
    places: list[tuple[tuple[str | int, ...], Port | Bearing | PointMass, str]] = [
        ((*_port_path(i), "hi"), port, "attached span") for i, port in enumerate(ports)
    ]
    places += [
        (("bearings", i, "seat_width"), bearing, "seat") for i, bearing in enumerate(bearings)
    ]
    places += [
        (("masses", i, "seat_width"), mass, "seat")
        for i, mass in enumerate(masses)
        if mass.on is None
    ]
    places += [
        (("loads", i, "lo"), load.seat, LOADED)
        for i, load in enumerate(loads)
        if load.seat is not None
    ]
    for i, port in enumerate(ports):
        if port.patch is None and not -TOUCH <= port.y <= length + TOUCH:
            yield SceneError(
                f"the port is at y = {port.y:.6g} m, outside the shaft (0 to {length:.6g} m)",
                path=(*_port_path(i), "y"),
            )
    names = set()
    for k, (path, station, kind) in enumerate(places):
        if station.name in names:
            owner = "another port" if kind == "attached span" else "the port or another bearing"
            yield SceneError(
                f"{owner} has this name; each needs its own", path=(*path[:-1], "name")
            )
        names.add(station.name)
        if kind == "attached span" and len(ports) > 1 and AT in station.name:
            reason = "the name of a point must not contain @, which separates it in C_zz@name"
            yield SceneError(reason, path=(*path[:-1], "name"))
        if getattr(station, "patch", None) is not None:
            continue
        reason = _misplaced(station, kind, places[:k], length, jumps)
        if reason:
            yield SceneError(reason, path=path)


def _port_path(index: int) -> tuple[str | int, ...]:
    """Return the path of a lumped point in a scene; the main one is the first."""
    return ("further_ports", index - 1) if index else ("port",)


def without_point(scene: Any) -> SceneError:
    """Return the error of what needs a lumped point, of a scene without one, with a table that can be
    pasted into its file.
    """
    names = {station.name for station in scene.stations}
    name = next(n for n in ("gear", "point", "lumped point") if n not in names)
    body = scene.body
    if body is not None and body.edges is not None:
        patches = [patch.name for patch in body.patches]
        held = [p for p in patches if p not in {s.patch.name for s in scene.bearings if s.patch}]
        if not patches:
            return SceneError(
                f"{scene.name} has no lumped point, and no named patch that one could lie on: name a "
                "group of surfaces in the mesher, or ask for natural frequencies alone"
            )
        place = f'patch = "{(held or patches)[-1]}"'
    else:
        longest = max(scene.segments, key=lambda s: s.length).name
        place = f'at = "{longest}.middle", attach_to = "{longest}"'
    return SceneError(
        f"{scene.name} has no lumped point, at which compliances are measured: as the first line of "
        f'the file write port = {{ name = "{name}", {place} }}, or where it belongs'
    )


def no_such_point(name: str, names: Iterable[str]) -> str:
    """Return the reason to refuse the name of a lumped point."""
    names = list(names)
    hint = nearest(name, names)
    return f"there is no lumped point {show(name, 40)}{hint}; the scene has {listed(names)}"


def question_problems(
    ports: Sequence[Port], quantities: Sequence[Quantity]
) -> Iterator[SceneError]:
    """Yield problems of quantities, such as ``C_zz@gear``, at unknown lumped points."""
    names = [port.name for port in ports]
    for k, quantity in enumerate(quantities):
        points = quantity.points_among(names)
        unknown = [name for name in points if name not in names]
        reason = no_such_point(unknown[0], names) if unknown else no_term(quantity, points)
        if reason:
            yield SceneError(reason, path=("ask", "quantities", k))


def no_term(quantity: Quantity, points: Sequence[str]) -> str:
    """Return the reason to refuse a quantity at these points; empty where there is none."""
    if len(points) > 2:
        return f"a term is between two points; write for example {quantity.at(*points[:2])}"
    if len(points) == 2 and quantity.kind == STIFFNESS:
        compliance = f"C{quantity.symbol[1:]}{AT}{AT.join(points)}"
        return (
            "a stiffness between points depends on which are held; ask for the compliance "
            f"{compliance}, or run solidgear stiffness --port {','.join(points)}"
        )
    return ""


def mass_problems(
    ports: Sequence[Port], bearings: Sequence[Bearing], masses: Sequence[PointMass]
) -> Iterator[SceneError]:
    """Yield problems of masses on unknown stations, of their names, or of too many."""
    if len(masses) > MOST_MASSES:
        yield SceneError(too_many("masses", len(masses), MOST_MASSES), path=("masses",))
        return
    stations = [*(port.name for port in ports), *(b.name for b in bearings)]
    mass_names = set()
    for i, mass in enumerate(masses):
        if mass.on is not None and mass.on not in stations:
            reason = f"no lumped point, bearing or segment has this name; there are {', '.join(stations)}"
            yield SceneError(reason, path=("masses", i, "on"))
        # on seats of their own they are stations, whose names are compared there
        if mass.name in mass_names or (mass.on is not None and mass.name in stations):
            reason = "the port, a bearing or another mass has this name; each needs its own"
            yield SceneError(reason, path=("masses", i, "name"))
        if mass.on is not None:
            mass_names.add(mass.name)


def _misplaced(
    station: Port | Bearing | PointMass,
    kind: str,
    neighbours: Sequence[tuple],
    length: float,
    jumps: Sequence[float],
) -> str:
    """Return the first reason why a station cannot be where it is; empty where there is none."""
    lo, hi = _taken(station)
    if hi <= lo:
        return f"the span must end beyond its start at {lo:.6g} m"
    reach = f"the {kind} reaches from {lo:.6g} to {hi:.6g} m"
    if lo < -TOUCH or hi > length + TOUCH:
        return f"{reach}, which must lie inside the shaft (0 to {length:.6g} m)"
    if hi - lo < SHORTEST * length:
        return (
            f"{reach}, under a millionth of the length of the shaft, {length:.6g} m: "
            "probably wrong units"
        )
    for step in jumps:
        if lo + TOUCH < step < hi - TOUCH:
            return (
                f"{reach}, across the step of the outer radius at {step:.6g} m; it must end there"
            )
    for _, neighbour, neighbour_kind in neighbours:
        # a port may share the surface of a seat or of another port, unless both hold it rigid, which
        # would weld the two points together
        seats = neighbour_kind == kind == "seat"
        exclusive = seats or neighbour.attachment == station.attachment == "rigid"
        start, end = _taken(neighbour)
        if exclusive and min(hi, end) - max(lo, start) > TOUCH:
            return f'{reach} and overlaps that of "{neighbour.name}" ({start:.6g} to {end:.6g} m)'
    return ""


def _taken(station: Port | Bearing | PointMass) -> tuple[float, float]:
    """Return the ends of the surface that a station takes, m: beside a face its rim."""
    return getattr(station, "rim", (station.lo, station.hi))


def blend_problems(
    segments: Sequence[Segment],
    blends: Sequence[Blend],
    stations: Sequence[Any] = (),
    features: Sequence[Any] = (),
) -> Iterator[SceneError]:
    """Yield problems of fillets and chamfers with the shaft, its stations and its features."""
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
    """Return field and reason of the first problem of a fillet or chamfer, or two empty texts."""
    owner, kind, key = segments[corner.owner], blend.what, blend.size_key
    for neighbour, edge in earlier:
        if (edge.joint, edge.r, edge.surface) == (corner.joint, corner.r, corner.surface):
            return "y", f'this edge has "{neighbour.name}" already'
    if min(corner.axial, corner.radial) < SMALLEST_BLEND * corner.r:
        return key, (
            f"a {kind} under {SMALLEST_BLEND:g} of the radius, {corner.r:.6g} m, is too small: "
            "leave it out, or check the units"
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
                f'{reach}, and the seat of "{s.name}" ends inside it, at {ends_inside[0]:.6g} m; '
                "let it end elsewhere"
            )
        # the face itself is plane at the end of a shaft
        at_end = abs(s.y - corner.y) <= TOUCH and corner.y in (0.0, segments[-1].y1)
        if lo - TOUCH <= s.y <= hi + TOUCH and not at_end:
            return key, (
                f'{reach}, and "{s.name}" is at {s.y:.6g} m, where no section is plane; move one '
                "of them"
            )
    for f in features:
        first, last = f.span(segments)
        if first < hi - TOUCH and lo + TOUCH < last:
            return key, f'{reach}, into the {f.what} "{f.name}"'
    return "", ""


def _face_height(corner: Corner, segments: Sequence[Segment]) -> float:
    """Return the height of the plane face beside an edge, m."""
    segment = segments[corner.owner]
    k = corner.joint
    if k in (0, len(segments)):
        return segment.outer0 - segment.inner0 if k == 0 else segment.outer1 - segment.inner1
    lower, upper = (radii_of(s, corner.surface) for s in segments[k - 1 : k + 1])
    return abs(lower[1] - upper[0])


def _same_face(a: Corner, b: Corner, segments: Sequence[Segment]) -> bool:
    return a.joint == b.joint and (a.joint in (0, len(segments)) or a.surface == b.surface)
