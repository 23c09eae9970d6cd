"""From the tables of bearings, masses, lumped points and the housing to what a scene holds of them,
datums resolved.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from solidgear.errors import SceneError
from solidgear.scene.body_file import BodyFile, Recognised
from solidgear.scene.housing import Housing
from solidgear.scene.parts import Segment
from solidgear.scene.point_mass import PointMass
from solidgear.scene.port_tables import PortTable, elastic
from solidgear.scene.stations import Attachment, Bearing, Port, Status
from solidgear.scene.tables import BearingTable, MassTable, SceneTable, SeatTable

#: share of a seat below which it is said what there is: chords of eight to a turn lack 2.6 %
WHOLE_SEAT = 0.97


def with_seats(part: Recognised, stations: Iterable, segments: Sequence[Segment]) -> BodyFile:
    """A part, and what is to be said of seats that are not whole.

    Parameters
    ----------
    part : Recognised
    stations : iterable of station
    segments : sequence of Segment
        Its frusta.
    """
    said = []
    for s in stations:
        under = [g for g in segments if g.y1 > s.lo and g.y0 < s.hi]
        radii = {r for g in under for r in (g.outer0, g.outer1)}
        if s.attachment == "section" or len(radii) != 1 or not s.hi > s.lo:
            continue
        share = part.seat_share(radii.pop(), s.lo, s.hi)
        if share < WHOLE_SEAT:
            said.append(
                f"the seat of {s.name!r} has {100 * share:.3g} % of the area 2 pi r b of its cylinder; "
                "its motion is the mean of what is there"
            )
    return part.body.model_copy(update={"remarks": (*part.body.remarks, *said)})


def _on_part(part: Recognised | None, seat: SeatTable, *place: str | int) -> tuple[float, float]:
    """Ends of a seat on a part."""
    assert part is not None  # tables refuse it without one
    try:
        return part.span(seat)
    except SceneError as error:
        raise error.located(None, prefix=(*place, "seat")) from None


def bearing_of(
    item: BearingTable,
    index: int,
    attachment: str,
    datums: dict[str, float],
    part: Recognised | None = None,
) -> Bearing:
    """A bearing at its place, which becomes a datum of what follows."""
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
            housing=elastic(item.housing) if item.housing is not None else None,
            attachment=item.attachment or usual,
            status=item.status or _status(item),
            note=item.note,
            face=item.face,
            **held,
        )
    except SceneError as error:
        key = error.path[0] if error.path else "matrix"
        if key == "matrix" and item.matrix is None:
            key = "stiffness"
        raise SceneError(error.reason, path=("bearing", index, key), value=error.value) from None
    datums[f"bearing.{item.name}"] = bearing.y
    return bearing


def _status(item: BearingTable) -> Status:
    """Of a bearing that does not say where its numbers come from."""
    if item.catalogue is None:
        return "assumed"
    return "estimated" if item.catalogue.estimated else "calculated"


def mass_of(item: MassTable, attachment: Attachment, datums: dict[str, float]) -> PointMass:
    """A mass, on a seat of its own or on another station."""
    place = {}
    if item.on is None:
        place = {
            "y": (item.position or 0.0) + datums[item.from_ or "start"],
            "seat_width": item.seat_width,
            "attachment": item.attachment or attachment,
        }
    given = {key: getattr(item, key) for key in ("inertia", "offset") if getattr(item, key)}
    return PointMass(name=item.name, mass=item.mass, on=item.on, **place, **given)


def port_of(
    item: PortTable,
    index: int,
    attachment: Attachment,
    datums: dict[str, float],
    surface: dict[str, tuple[float, float]],
    part: Recognised | None = None,
) -> Port | None:
    """The port, or None where it names what is not there."""
    datum = item.at or item.from_ or "start"
    span: Sequence[float] | None = item.span
    if item.seat is not None:
        span = _on_part(part, item.seat, "port", index)
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


def main_first(table: SceneTable) -> list[int]:
    """Places in the file of the lumped points, that of the main one first."""
    order = list(range(len(table.port)))
    main = [k for k in order if table.port[k].name == table.ask.port][:1]
    return main + [k for k in order if k not in main]


def of_port(path: tuple, order: Sequence[int]) -> tuple:
    """The path of an entry of a lumped point with its place in the file."""
    match path:
        case ("port", *rest):
            return ("port", order[0], *rest)
        case ("further_ports", int(k), *rest):
            return ("port", order[k + 1], *rest)
        case ("further_ports",):
            return ("port",)
    return path


def housing_of(table: SceneTable, datums: dict[str, float]) -> Housing | None:
    """The housing of all bearings, where it is more than a spring along the axis."""
    given = table.housing
    if given is None or given.axial is not None or (given.from_ or "start") not in datums:
        return None
    y = (given.position or 0.0) + datums[given.from_ or "start"]
    if given.stiffness is not None:
        return elastic(given.stiffness, Housing, y=y)
    try:
        return elastic({"matrix": given.matrix}, Housing, y=y)
    except SceneError as error:
        raise error.located(None, prefix=("housing",)) from None
