"""From the tables of a scene file to a `Scene`: segments laid end to end, datums resolved.

A problem of a place is reported under the key of the file that it came from.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from solidgear.errors import SceneError
from solidgear.scene.blend_rules import blend_problems
from solidgear.scene.body_file import MASS_CHECK, Recognised
from solidgear.scene.feature_places import blend_of, feature_of
from solidgear.scene.features import feature_problems
from solidgear.scene.model import Scene
from solidgear.scene.parts import Material, Segment
from solidgear.scene.point_mass import PointMass
from solidgear.scene.rules import mass_problems, shaft_problems, station_problems
from solidgear.scene.segment_tables import Piece
from solidgear.scene.stations import Attachment, Bearing, Port, Status
from solidgear.scene.tables import (
    BearingTable,
    ChamferTable,
    FilletTable,
    MassTable,
    PortTable,
    SceneTable,
    SeatTable,
)


def resolve(
    table: SceneTable,
    numbers: list[int],
    name: str,
    problems: list[SceneError],
    part: Recognised | None = None,
) -> Scene:
    """The scene of a file, once nothing is wrong with it.

    Parameters
    ----------
    table : SceneTable
        Tables that are sound each by itself.
    numbers : list of int
        Place in the file of every bearing of `table`.
    name : str
        Of the scene.
    problems : list of SceneError
        What was found before; problems of places are added to it.
    part : Recognised, optional
        In place of segments.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError
        If anything is wrong with the places of its parts, or was before: all of it.
    """
    if not table.segment and part is None:
        raise SceneError.of(
            [*problems, SceneError("a scene needs at least one [[segment]]", path=("segment",))]
        )
    if part is None:
        segments, owner, surface, datums = _lay_out(table, problems)
    else:
        segments, owner, surface, datums = _recognised(table, part)
        problems += _weighed(table, part)
    if segments is not None:
        shaft = shaft_problems(segments)
        problems += [one.located(None, path=_file_path(one.path, table, owner)) for one in shaft]
        segments = None if shaft else segments
    if segments is None:
        raise SceneError.of(problems)
    bearings = {}
    for index, item in zip(numbers, table.bearing):
        # a datum that is missing was reported before, or is a bearing that was refused
        if (item.from_ or "start") in datums:
            try:
                bearings[index] = _bearing(item, index, table.attachment, datums, part)
            except SceneError as error:
                problems.append(error)
    port = None
    try:
        port = _port(table.port, table.attachment, datums, surface, part) if table.port else None
    except SceneError as error:
        problems.append(error)
    masses = {}
    for index, heavy in enumerate(table.mass):
        if (heavy.from_ or "start") in datums:
            try:
                masses[index] = _mass(heavy, table.attachment, datums)
            except SceneError as error:
                problems.append(error.located(None, path=("mass", index, *error.path)))
    features, cut_rows, blends, blend_rows = [], [], [], []
    for index, entry in enumerate(table.feature):
        # a datum that is missing was reported before
        if isinstance(entry, FilletTable | ChamferTable):
            if entry.at in datums:
                blends.append(blend_of(entry, index, datums))
                blend_rows.append(index)
        elif getattr(entry, "from_", None) in (None, *datums):
            try:
                features.append(feature_of(entry, index, datums))
                cut_rows.append(index)
            except SceneError as error:
                problems += error.problems
    stations = [s for s in (port, *bearings.values(), *masses.values()) if s is not None]
    seated = [s for s in stations if getattr(s, "on", None) is None]
    of_edges = blend_problems(segments, blends, seated, features)
    whole = len(bearings) == len(numbers) and table.port is not None
    problems += [
        one.located(None, path=_file_path(one.path, table, owner))
        for one in (
            *station_problems(segments, port, bearings, masses),
            *(mass_problems(port, bearings, masses) if whole else ()),
            *_of_rows(feature_problems(segments, features), cut_rows),
            *_of_rows(of_edges, blend_rows),
        )
    ]
    if problems:
        raise SceneError.of(problems)
    return Scene.from_parts(
        segments,
        table.material,
        bearings.values(),
        port,
        title=table.title,
        name=name,
        source=table.source,
        masses=tuple(masses.values()),
        features=tuple(features),
        body=part.body if part is not None else None,
        blends=tuple(blends),
        housing_axial=table.housing.axial if table.housing else None,
        load=table.load,
        ask=table.ask,
    )


def _of_rows(problems: Iterable[SceneError], rows: Sequence[int]) -> Iterator[SceneError]:
    """Problems of a list with the number of each entry among the [[feature]] of the file."""
    for one in problems:
        rest = (rows[one.path[1]], *one.path[2:]) if one.path[1:] else ()
        yield one.located(None, path=(one.path[0], *rest))


def _lay_out(table: SceneTable, problems: list[SceneError]):
    """Segments end to end (None if one cannot be); which [[segment]] each came from; the surface of
    each by name; and all datums.
    """
    segments, owner, surface, datums, y = [], [], {}, {"start": 0.0}, 0.0
    for index, piece in enumerate(table.segment):
        material = table.material.with_changes(**piece.material.model_dump(exclude_none=True))
        start = y
        for part in piece.pieces():
            if part.length <= 1e-9:
                problems.append(
                    SceneError(
                        "is less than a nanometre along the shaft: probably wrong units",
                        path=("segment", index, _LENGTH_KEY[part.part]),
                    )
                )
                continue
            try:
                segments.append(_segment(part, y, piece.bore / 2, material))
            except SceneError as error:
                key = _file_path(("segments", index, error.path[0]), table, range(index + 1))
                problems.append(error.located(None, path=key))
                continue
            owner.append(index)
            y = segments[-1].y1
            if part.part != "backcone":
                surface[piece.name] = (segments[-1].y0, y)
                if piece.kind == "bevel_head":
                    datums[f"{piece.name}.mid_face"] = (segments[-1].y0 + y) / 2
        datums |= {
            f"{piece.name}.start": start,
            f"{piece.name}.end": y,
            f"{piece.name}.middle": (start + y) / 2,
        }
    whole = len(segments) == sum(len(piece.pieces()) for piece in table.segment)
    return segments if whole else None, owner, surface, datums | {"end": y}


def _recognised(table: SceneTable, part: Recognised):
    """What :func:`_lay_out` gives, of a part from a file."""
    segments = part.segments(table.material)
    datums = {"start": 0.0, "end": segments[-1].y1, "origin": part.origin}
    for s in segments:
        middle = (s.y0 + s.y1) / 2
        datums |= {f"{s.name}.start": s.y0, f"{s.name}.end": s.y1, f"{s.name}.middle": middle}
    return segments, None, {s.name: (s.y0, s.y1) for s in segments}, datums


def _weighed(table: SceneTable, part: Recognised) -> Iterator[SceneError]:
    """The mass of a part against what the file says."""
    assert table.body is not None  # it was read from there
    said, mass = table.body.mass_check, table.material.density * part.body.volume
    if said is not None and abs(mass / said - 1) > MASS_CHECK:
        yield SceneError(
            f"the part has {mass:.5g} kg ({1e6 * part.body.volume:.5g} cm^3 of "
            f"{table.material.density:.5g} kg/m^3), {100 * (mass / said - 1):+.3g} % from that",
            path=("body", "mass_check"),
        )


def _on_part(part: Recognised | None, seat: SeatTable, *place: str | int) -> tuple[float, float]:
    """Ends of a seat on a part."""
    assert part is not None  # tables refuse it without one
    try:
        return part.span(seat)
    except SceneError as error:
        raise error.located(None, prefix=(*place, "seat")) from None


_LENGTH_KEY = {"frustum": "face_width", "backcone": "backcone", "shaft": "length"}


def _segment(piece: Piece, y: float, bore_radius: float, material: Material) -> Segment:
    return Segment(
        name=piece.name,
        y0=y,
        y1=y + piece.length,
        outer0=piece.outer0,
        outer1=piece.outer1,
        inner0=bore_radius,
        inner1=bore_radius,
        material=material,
        part=piece.part,
    )


def _bearing(
    item: BearingTable,
    index: int,
    attachment: str,
    datums: dict[str, float],
    part: Recognised | None = None,
) -> Bearing:
    width = item.seat_width
    if item.seat is not None:
        lo, hi = _on_part(part, item.seat, "bearing", index)
        y, width = (lo + hi) / 2, hi - lo
    elif item.face is None:
        y = (item.position or 0.0) + datums[item.from_ or "start"]
    else:
        y = datums[item.face]
    # the middle of an end face is a section; a seat would be the rim beside it
    usual = attachment if item.face is None else "section"
    given = item.stiffness if item.matrix is None else item.matrix
    held = {"matrix": given} if item.hold is None else {"hold": item.hold}
    try:
        bearing = Bearing(
            name=item.name,
            y=y,
            seat_width=width,
            catalogue=item.catalogue,
            axial_series=item.axial_series,
            attachment=item.attachment or usual,
            status=item.status or _status(item),
            note=item.note,
            face=item.face,
            **held,
        )
    except SceneError as error:
        key = "stiffness" if item.matrix is None else "matrix"
        raise SceneError(error.reason, path=("bearing", index, key), value=error.value) from None
    datums[f"bearing.{item.name}"] = bearing.y
    return bearing


def _status(item: BearingTable) -> Status:
    """Of a bearing that does not say where its numbers come from."""
    if item.catalogue is None:
        return "assumed"
    return "estimated" if item.catalogue.estimated else "calculated"


def _mass(item: MassTable, attachment: Attachment, datums: dict[str, float]) -> PointMass:
    place = {}
    if item.on is None:
        place = {
            "y": (item.position or 0.0) + datums[item.from_ or "start"],
            "seat_width": item.seat_width,
            "attachment": item.attachment or attachment,
        }
    given = {key: getattr(item, key) for key in ("inertia", "offset") if getattr(item, key)}
    return PointMass(name=item.name, mass=item.mass, on=item.on, **place, **given)


def _port(
    item: PortTable,
    attachment: Attachment,
    datums: dict[str, float],
    surface: dict[str, tuple[float, float]],
    part: Recognised | None = None,
) -> Port | None:
    """The port, or None where it names what is not there."""
    datum = item.at or item.from_ or "start"
    span: Sequence[float] | None = item.span
    if item.seat is not None:
        span = _on_part(part, item.seat, "port")
    elif span is None and item.attach_to is not None:
        span = surface.get(item.attach_to)
    if datum not in datums or span is None:
        return None
    lo, hi = span
    placed = item.at is not None or item.position is not None
    return Port(
        name=item.name,
        y=datums[datum] + (item.position or 0.0) if placed else (lo + hi) / 2,
        lo=lo,
        hi=hi,
        attachment=item.attachment or attachment,
    )


def _file_path(path: tuple, table: SceneTable, owner: Sequence[int] | None) -> tuple:
    """The key in the file that an entry of the resolved scene came from."""
    if owner is None:
        assert table.body is not None  # in place of segments
        path = _part_path(path, table)
        owner = ()
    match path:
        case ("segments", index, key):
            kind = table.segment[owner[index]].kind
            start, end = {
                "cylinder": ("diameter",) * 2,
                "cone": ("start_diameter", "end_diameter"),
                "bevel_head": ("pitch_radius",) * 2,
            }[kind]
            length = "face_width" if kind == "bevel_head" else "length"
            key = {
                "outer0": start,
                "outer1": end,
                "inner0": "bore",
                "inner1": "bore",
                "y1": length,
            }.get(key, key)
            return ("segment", owner[index], key)
        case ("segments", index, "material", key):
            own = getattr(table.segment[owner[index]].material, key) is not None
            return ("segment", owner[index], "material", key) if own else ("material", key)
        case ("bearings", index, key):
            return ("bearing", index, {"y": "position"}.get(key, key))
        case ("masses", index, key):
            return ("mass", index, {"y": "position"}.get(key, key))
        case ("features", index, key):
            return ("feature", index, {"y": "position"}.get(key, key))
        case ("blends", index, key):
            return ("feature", index, {"y": "at"}.get(key, key))
        case ("features" | "blends",):
            return ("feature",)
        case ("port", "y"):
            return ("port", "at" if table.port.at is not None else "position")
        case ("port", "lo" | "hi"):
            return ("port", "span" if table.port.span is not None else "attach_to")
        case ("housing_axial",):
            return ("housing", "axial")
    return path


def _part_path(path: tuple, table: SceneTable) -> tuple:
    """Of an entry that was recognised on a part, the key that named the file or the seat."""
    match path:
        case ("segments", _, "material", key):
            return ("material", key)
        case ("segments", *_):
            return ("body", table.body.key if table.body is not None else "step")
        case ("bearings", index, "seat_width") if table.bearing[index].seat is not None:
            return ("bearings", index, "seat")
        case ("port", "lo" | "hi") if table.port.seat is not None:
            return ("port", "seat")
    return path
