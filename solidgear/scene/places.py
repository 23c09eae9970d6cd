"""From the tables of a scene file to a `Scene`: segments laid end to end, datums resolved.

A problem of a place is reported under the key of the file that it came from.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from solidgear.errors import SceneError
from solidgear.scene.ask import Ask
from solidgear.scene.blend_rules import blend_problems
from solidgear.scene.body_file import MASS_CHECK, Recognised
from solidgear.scene.feature_places import blend_of, feature_of
from solidgear.scene.features import feature_problems
from solidgear.scene.model import Scene
from solidgear.scene.parts import Material, Segment
from solidgear.scene.rules import (
    mass_problems,
    no_such_point,
    question_problems,
    shaft_problems,
    station_problems,
)
from solidgear.scene.segment_tables import Piece
from solidgear.scene.station_places import (
    bearing_of,
    housing_of,
    main_first,
    mass_of,
    of_port,
    port_of,
    with_seats,
)
from solidgear.scene.tables import (
    ChamferTable,
    FilletTable,
    SceneTable,
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
        usual = _usual(table, part)
        segments, owner, surface, datums = _recognised(usual, part)
        problems += _weighed(table, usual, part)
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
                bearings[index] = bearing_of(item, index, table.attachment, datums, part)
            except SceneError as error:
                problems.append(error)
    order = main_first(table)
    ports, known = {}, [item.name for item in table.port]
    if table.port and table.ask.port is not None and table.ask.port not in known:
        problems.append(SceneError(no_such_point(table.ask.port, known), path=("ask", "port")))
    for place, index in enumerate(order):
        try:
            port = port_of(table.port[index], index, table.attachment, datums, surface, part)
        except SceneError as error:
            problems.append(error)
            continue
        if port is not None:
            ports[place] = port
    housing = None
    try:
        housing = housing_of(table, datums)
    except SceneError as error:
        problems.append(error)
    masses = {}
    for index, heavy in enumerate(table.mass):
        if (heavy.from_ or "start") in datums:
            try:
                masses[index] = mass_of(heavy, table.attachment, datums)
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
    stations = [*ports.values(), *bearings.values(), *masses.values()]
    seated = [s for s in stations if getattr(s, "on", None) is None]
    of_edges = blend_problems(segments, blends, seated, features)
    # names are judged where all are known
    whole = len(bearings) == len(numbers) and bool(table.port)
    if whole and len(ports) == len(table.port):
        problems += question_problems([*ports.values()], table.ask.quantities)
    problems += [
        one.located(None, path=_file_path(of_port(one.path, order), table, owner))
        for one in (
            *station_problems(segments, ports, bearings, masses),
            *(mass_problems([*ports.values()], bearings, masses) if whole else ()),
            *_of_rows(feature_problems(segments, features), cut_rows),
            *_of_rows(of_edges, blend_rows),
        )
    ]
    if problems:
        raise SceneError.of(problems)
    return Scene.from_parts(
        segments,
        table.material if part is None else usual,
        bearings.values(),
        ports.pop(0),
        title=table.title,
        name=name,
        source=table.source,
        masses=tuple(masses.values()),
        features=tuple(features),
        body=with_seats(part, stations, segments) if part is not None else None,
        blends=tuple(blends),
        housing_axial=table.housing.axial if table.housing else None,
        housing=housing,
        further_ports=tuple(ports.values()),
        load=table.load,
        ask=Ask(**{key: getattr(table.ask, key) for key in Ask.model_fields}),
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


def _usual(table: SceneTable, part: Recognised) -> Material:
    """The material of whatever has none of its own."""
    if table.material is not None:
        return table.material
    own = [g for g in part.body.groups if g.material is None]
    if own:
        raise SceneError(
            f"{own[0].said}, {1e6 * own[0].volume:.4g} cm^3, has no material: name its groups "
            "here, or write [material] for all the rest",
            path=("body", "materials"),
        )
    # all groups have one of their own, so that this is nobody's
    return next(g.material for g in part.body.groups if g.material is not None)


def _recognised(material: Material, part: Recognised):
    """What :func:`_lay_out` gives, of a part from a file."""
    segments = part.segments(material)
    datums = {"start": 0.0, "end": segments[-1].y1, "origin": part.origin}
    for s in segments:
        middle = (s.y0 + s.y1) / 2
        datums |= {f"{s.name}.start": s.y0, f"{s.name}.end": s.y1, f"{s.name}.middle": middle}
    return segments, None, {s.name: (s.y0, s.y1) for s in segments}, datums


def _weighed(table: SceneTable, material: Material, part: Recognised) -> Iterator[SceneError]:
    """The mass of a part against what the file says."""
    assert table.body is not None  # it was read from there
    said, mass = table.body.mass_check, part.body.mass(material)
    if said is not None and abs(mass / said - 1) > MASS_CHECK:
        yield SceneError(
            f"the part has {mass:.5g} kg ({1e6 * part.body.volume:.5g} cm^3 of "
            f"{mass / part.body.volume:.5g} kg/m^3), {100 * (mass / said - 1):+.3g} % from that",
            path=("body", "mass_check"),
        )


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
        case ("port", index, "y"):
            return ("port", index, "at" if table.port[index].at is not None else "position")
        case ("port", index, "lo" | "hi"):
            key = "span" if table.port[index].span is not None else "attach_to"
            return ("port", index, key)
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
        case ("port", index, "lo" | "hi") if table.port[index].seat is not None:
            return ("port", index, "seat")
    return path
