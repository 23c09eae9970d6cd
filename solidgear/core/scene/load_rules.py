"""Rules for the loads of a shaft and their cases, one sentence for each problem; paths are those of a
`Scene`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import fsum
from typing import TYPE_CHECKING, Any

from solidgear.core.errors import SceneError, SolidgearError, listed, nearest, show
from solidgear.core.scene.ends import snap_seats
from solidgear.core.scene.load_case import LoadCase
from solidgear.core.scene.shaft_load import ShaftLoad
from solidgear.core.scene.units import TYPED

if TYPE_CHECKING:
    from solidgear.core.scene.load import BearingLoad
    from solidgear.core.scene.parts import Segment
    from solidgear.core.scene.point_mass import PointMass
    from solidgear.core.scene.stations import Bearing, Port

#: name of the load of a file with one [load], and of the case of a scene without any
ONLY, ALL = "load", "all loads"


def all_loads(
    load: BearingLoad | None, loads: Sequence[ShaftLoad], port: str
) -> tuple[ShaftLoad, ...]:
    """Return loads of a scene, one at the main point as any other."""
    if load is None:
        return tuple(loads)
    words: dict[str, Any] = {"x": load.x, "y": load.y, "z": load.z}
    words |= {key: value for key in ("thx", "thz") if (value := getattr(load, key)) is not None}
    return (ShaftLoad(name=ONLY, on=port, **words), *loads)


def named_case(cases: Sequence[LoadCase], name: str | int | None = None) -> LoadCase:
    """Return the case of a name or number, counted from one; by default the first, or all loads."""
    if name is None:
        return cases[0] if cases else LoadCase(name=ALL)
    for k, case in enumerate(cases, start=1):
        if str(name) in (case.name, str(k)):
            return case
    names = listed([f"{k} {case.name!r}" for k, case in enumerate(cases, start=1)])
    raise SolidgearError(
        f"there is no case {show(name, 40)}; "
        + (f"there are {names}" if cases else "the scene has no [[case]]")
    )


def seat_loads(
    loads: Sequence[ShaftLoad], segments: Sequence[Segment], stations: Sequence[str]
) -> tuple[ShaftLoad, ...]:
    """Return loads with names, those on a segment, which is no station of that name, with a place of
    their own on all of it.
    """
    by_name = {segment.name: segment for segment in segments if segment.name not in stations}
    out = []
    for number, load in enumerate(loads, 1):
        if not load.name:
            load = load.with_changes(name=load.on or f"load {number}")
        if (segment := by_name.get(load.on or "")) is not None:
            load = load.with_changes(on=None, lo=segment.y0, hi=segment.y1)
        if load.seat is not None:
            seat = snap_seats([load.seat], segments)[0]
            load = load.with_changes(lo=seat.lo, hi=seat.hi)
        out.append(load)
    return tuple(out)


def load_problems(
    *,
    load: BearingLoad | None,
    loads: Sequence[ShaftLoad],
    cases: Sequence[LoadCase],
    torque_at: str | None,
    turns: str | None,
    ports: Sequence[Port],
    bearings: Sequence[Bearing],
    masses: Sequence[PointMass],
) -> Iterator[SceneError]:
    """Yield problems of loads and cases with each other and with the stations of a sound shaft."""
    if load is not None and loads:
        yield SceneError(
            "give either one load at the main point or loads, not both", path=("loads",)
        )
        return
    stations = [s.name for s in (*ports, *bearings, *masses)]
    stations += [seated.name for seated in loads if seated.on is None]
    yield from _misplaced(loads, stations, turns)
    yield from _unknown(torque_at, [*dict.fromkeys(stations)])
    yield from _case_problems(
        cases, [entry.name for entry in all_loads(load, loads, ports[0].name if ports else "")]
    )


def _misplaced(
    loads: Sequence[ShaftLoad], stations: Sequence[str], turns: str | None
) -> Iterator[SceneError]:
    """Yield problems of single loads: their names, their stations, and their sense."""
    names = set()
    for k, load in enumerate(loads):
        if load.name in names:
            reason = "another load has this name; each needs its own"
            yield SceneError(reason, path=("loads", k, "name"))
        names.add(load.name)
        if load.on is not None and load.on not in stations:
            hint = nearest(load.on, stations)
            yield SceneError(
                f"no lumped point, bearing, mass or segment has this name{hint}; there are "
                f"{listed(stations)}",
                path=("loads", k, "on"),
            )
        if load.sense is not None and turns is None:
            yield SceneError(
                'asks how the shaft turns: write turns = "+y" or turns = "-y" at the top of the '
                "file, or leave sense out and give the torque a sign",
                path=("loads", k, "sense"),
            )


def _unknown(torque_at: str | None, stations: Sequence[str]) -> Iterator[SceneError]:
    """Yield the problem of a place for torques that the shaft does not have."""
    if torque_at is not None and torque_at not in stations:
        yield SceneError(
            f"there is no point, bearing, mass or load {show(torque_at, 40)}"
            f"{nearest(torque_at, stations)}; there are {listed(stations)}",
            path=("torque_at",),
        )


def _case_problems(cases: Sequence[LoadCase], loads: Sequence[str]) -> Iterator[SceneError]:
    """Yield problems of cases: the duty table, and names of loads."""
    yield from duty_problems(cases, "cases", "case")
    for k, case in enumerate(cases):
        for i, name in enumerate(case.loads or ()):
            if name not in loads:
                yield SceneError(_no_load(name, loads), path=("cases", k, "loads", i))
        for name in case.factors:
            if name not in loads:
                yield SceneError(_no_load(name, loads), path=("cases", k, "factors", name))
            elif case.loads is not None and name not in case.loads:
                reason = "this load does not act in the case; name it in loads as well"
                yield SceneError(reason, path=("cases", k, "factors", name))


def duty_problems(rows: Sequence[Any], table: str, kind: str) -> Iterator[SceneError]:
    """Yield problems of the rows of a duty table, cases or operating points: names that are there
    twice, a share or hours that rows lack, and shares that do not sum to one.
    """
    names = set()
    for k, row in enumerate(rows):
        if row.name and row.name in names:
            reason = f"another {kind} has this name; each needs its own"
            yield SceneError(reason, path=(table, k, "name"))
        names.add(row.name)
    for key in ("share", "hours"):
        lacking = [k for k, row in enumerate(rows) if getattr(row, key) is None]
        if lacking and len(lacking) < len(rows):
            reason = f"this key is missing: other {kind}s have {key}, so that each needs it"
            yield SceneError(reason, path=(table, lacking[0], key))
            return
    shares = [row.share for row in rows if row.share is not None]
    if shares and abs(fsum(shares) - 1) > TYPED:
        yield SceneError(
            f"the shares of {len(shares)} {kind}s sum to {fsum(shares):.6g}; they must sum to one "
            "(write hours for times that do not)",
            path=(table, 0, "share"),
        )


def _no_load(name: str, loads: Sequence[str]) -> str:
    """Return the reason to refuse the name of a load in a case."""
    others = f"there are {listed(loads)}" if loads else "the file has none"
    return f"there is no load {show(name, 40)}{nearest(name, loads)}; {others}"
