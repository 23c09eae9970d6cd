"""Facts of shafts at rest under load: forces, worst place, bearing loads, motions of gears."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from solidgear.bearings.bearing_life import BearingLife
from solidgear.bearings.catalogue import catalogue_of
from solidgear.core import Bearing, Scene
from solidgear.core.scene.acting import ROUNDING
from solidgear.core.scene.load_rules import ONLY
from solidgear.datasheet.facts import (
    BearingFact,
    Force,
    LesserSafety,
    MotionFact,
    Range,
    Remark,
    Trust,
    UnratedCorner,
    WorstNotch,
    WorstSection,
)
from solidgear.strength.deflection.at_rest import ROUNDING as ROUNDED
from solidgear.strength.deflection.at_rest import Deflections, Measured
from solidgear.strength.deflection.shaft import BearingState
from solidgear.strength.stress.at_rest import StressAtRest, StressedShaft, lesser_elsewhere
from solidgear.strength.stress.rating import Rating
from solidgear.strength.stress.shaft import Notch
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.load.lives import lives_of

#: share of P over C beyond which ISO 281 does not vouch for a life (ISO 281:2007, clause 1)
MOST_LOAD = 0.5
#: safety that DIN 743-1 asks for where loads and strength are sure
LEAST_SAFETY = 1.2


def forces(shaft: StressedShaft) -> tuple[Force, ...]:
    """Return the loads on a shaft in the order of their places."""
    scene = shaft.scene
    bearings = {bearing.name: bearing for bearing in scene.bearings}
    places = {station.name: station.y for station in (*scene.stations, *scene.masses)}
    loads = []
    for name, load in shaft.acting.loads.items():
        if name not in places:
            continue
        six = tuple(map(float, load))
        if name in bearings and six[4] and _turns(bearings[name]):
            # the torque comes from a coupling at its place
            loads.append(Force(name, places[name], (0.0, 0.0, 0.0, 0.0, six[4], 0.0), False))
            six = (*six[:4], 0.0, six[5])
        loads.append(Force(name, places[name], six, name in bearings))
    return tuple(sorted(loads, key=lambda force: force.y))


def forces_alone(deflected: Deflections) -> tuple[Force, ...]:
    """Return the loads on a shaft alone, those on one station together, and its reactions."""
    (shaft,), load = deflected.judge.shafts, deflected.load
    assert load is not None  # of a shaft alone
    names: dict[str, list[str]] = {}
    sums: dict[str, np.ndarray] = {}
    places: dict[str, float] = {}
    for acting in load.acting:
        station = acting.station
        names.setdefault(station, [])
        if acting.name != ROUNDING:
            by_place = acting.name == ONLY or acting.name.endswith(f" at {station}")
            names[station].append(station if by_place else acting.name)
        sums[station] = sums.get(station, np.zeros(6)) + acting.six
        places[station] = acting.y
    loads = [
        Force(
            name=", ".join(dict.fromkeys(names[station])),
            y=places[station],
            six=tuple(map(float, six)),
            by_bearing=False,
        )
        for station, six in sums.items()
    ]
    loads += [
        Force(bearing.name, bearing.place, tuple(map(float, -bearing.load)), True)
        for bearing in shaft.bearings
    ]
    return tuple(sorted(loads, key=lambda force: force.y))


def lives_over_points(
    assembly: Assembly, point: OperatingPoint | None = None
) -> dict[str, BearingFact]:
    """Return lives of the catalogue bearings of a train at an operating point, by default the first, or
    of a shaft over its cases, over the duty table where there is one; empty without such bearings.
    """
    train = assembly.train
    bearings = {
        bearing.name if train.is_one_shaft else f"{side}.{bearing.name}": bearing
        for side, shaft in train.shafts.items()
        for bearing in shaft.scene.bearings
    }
    if not train.operation or all(b.catalogue is None for b in bearings.values()):
        return {}
    out = {}
    for lives in lives_of(assembly):
        first = lives.points[0]
        shown = next((p for p in lives.points if point and p.label == point.label), first)
        fact = life_fact(lives.name, bearings[lives.name], shown.life)
        duty = lives.duty
        if duty is not None and len(lives.points) > 1:
            fact = replace(
                fact,
                kind=lives.kind,
                life=duty.revolutions,
                hours=duty.hours,
                open=None,
                over_table=True,
            )
        out[lives.name] = fact
    return out


def _turns(bearing: Bearing) -> bool:
    return bearing.matrix is None or not bearing.matrix[4][4]


def worst_notch(stressed: StressAtRest) -> WorstNotch | None:
    """Return the notch with the least safety against fatigue, without one that with the largest
    stress.
    """
    worst = [(shaft, shaft.found.worst[0]) for shaft in stressed.shafts if shaft.found.worst]
    if not worst:
        return None
    shaft, notch = min(worst, key=lambda pair: pair[1].severity)
    # stress on the surface is that of fillets, which the solid has
    local = notch.local if isinstance(notch, Notch) else None
    rating = notch.rating
    return WorstNotch(
        shaft=shaft.name,
        place=notch.name,
        y=notch.y,
        amplitude=notch.nominal.bending if local is None else local.amplitude,
        bar=None if local is None else local.amplitude_bar,
        fatigue=None if rating is None else rating.fatigue,
        yielding=None if rating is None else rating.yielding,
        assumed=() if rating is None else rating.assumed,
        least=None if rating is None else rating.least,
        open=shaft.open.get(notch.name),
        elsewhere=() if rating is None else tuple(_elsewhere(stressed, rating)),
    )


def _elsewhere(stressed: StressAtRest, worst: Rating) -> Iterator[LesserSafety]:
    """Yield the safeties that other notches have less of than that of the least against fatigue."""
    for kind, least in lesser_elsewhere(stressed.shafts, worst):
        yield LesserSafety(kind, least.shaft.name, least.notch.name, least.notch.y, least.value)


def sharp_corners(stressed: StressAtRest) -> tuple[UnratedCorner, ...]:
    """Return the sharp corners of all shafts, which have no stress and no rating."""
    return tuple(
        UnratedCorner(shaft.name, corner.y)
        for shaft in stressed.shafts
        for corner in shaft.found.sharp
    )


def worst_section(stressed: StressAtRest) -> WorstSection | None:
    """Return the section with the largest nominal stress; None where nothing is stressed."""
    sections = [
        WorstSection(
            shaft=shaft.name,
            segment=row.segment,
            y=row.y,
            equivalent=math.hypot(
                row.stress.bending + abs(row.stress.tension), math.sqrt(3) * row.stress.torsion
            ),
            bending=row.stress.bending,
            torsion=row.stress.torsion,
            tension=row.stress.tension,
        )
        for shaft in stressed.shafts
        for row in shaft.found.nominal
    ]
    return max(sections, key=lambda section: section.equivalent, default=None)


def designation(bearing: Bearing) -> str:
    """Return the designation of a bearing; empty without catalogue data that have one."""
    data = catalogue_of(bearing)
    return data.designation if data is not None else ""


def bearing_facts(
    deflected: Deflections, scenes: Mapping[str, Scene], lives: Mapping[str, BearingFact]
) -> tuple[BearingFact, ...]:
    """Return loads of all bearings at rest, with lives by shaft and name where there are any."""
    alone = len(deflected.judge.shafts) == 1
    facts = []
    for shaft in deflected.judge.shafts:
        for bearing in scenes[shaft.name].bearings:
            state = next((b for b in shaft.bearings if b.name == bearing.name), None)
            if state is None:
                continue
            name = bearing.name if alone else f"{shaft.name}.{bearing.name}"
            facts.append(_with_load(name, bearing, state, lives.get(name)))
    return tuple(facts)


def _with_load(
    name: str, bearing: Bearing, state: BearingState, life: BearingFact | None
) -> BearingFact:
    return BearingFact(
        name=name,
        designation=designation(bearing),
        radial=state.radial,
        axial=float(state.load[1]),
        kind=life.kind if life else "",
        life=life.life if life else None,
        open=life.open if life else None,
        hours=life.hours if life else None,
        static_safety=state.static_safety,
        over_table=bool(life and life.over_table),
    )


def life_fact(name: str, bearing: Bearing, rated: BearingLife) -> BearingFact:
    """Return the life of a bearing: the modified one where there is one."""
    kind = "modified" if "modified" in rated.lives else "reference"
    turns = abs(rated.speed) / (2 * math.pi) * 3600
    life = rated.lives[kind]
    return BearingFact(
        name=name,
        designation=designation(bearing),
        kind=kind,
        life=life,
        open=rated.range(kind) if rated.unknown or kind == "modified" else None,
        hours=life / turns if turns else None,
        static_safety=rated.life.static_safety,
    )


def motions(deflected: Deflections, ports: Collection[str] = ()) -> tuple[MotionFact, ...]:
    """Return motions of the lumped points of a train, or of some places of a shaft alone."""
    places = deflected.judge.displacement
    if ports:
        places = {name: six for name, six in places.items() if name in ports}
    solution = deflected.judge
    return tuple(
        _motion(name, [_without_rounding(m, solution.largest_beside(m)) for m in six])
        for name, six in places.items()
        if len(six) == 6
    )


def _without_rounding(measure: Measured, size: float) -> Measured:
    """Return a number, zero where it is rounding beside a size."""
    return measure if abs(measure.value) > ROUNDED * size else replace(measure, value=0.0)


def _motion(place: str, six: Sequence[Measured]) -> MotionFact:
    across, along, about = (six[0], six[2]), (six[1],), (six[3], six[5])
    return MotionFact(
        place=place,
        radial=_size(across),
        radial_bar=_size_of_bars(across),
        axial=_size(along),
        axial_bar=_size_of_bars(along),
        tilt=_size(about),
        tilt_bar=_size_of_bars(about),
        open=_size_open(across),
        open_axial=_size_open(along),
        open_tilt=_size_open(about),
    )


def _length(components: Iterable[float]) -> float:
    """Return the length of a vector."""
    return math.sqrt(sum(component**2 for component in components))


def _size(pair: Sequence[Measured]) -> float:
    return _length(m.value for m in pair)


def _size_of_bars(pair: Sequence[Measured]) -> float | None:
    bars = [m.bar for m in pair if m.bar is not None]
    return _length(bars) if len(bars) == len(pair) else None


def _size_open(pair: Sequence[Measured]) -> Range:
    """Return the least and largest size while both components lie in their ranges."""
    if any(m.open is None for m in pair):
        return None
    ends = [m.open for m in pair if m.open is not None]
    least = [0.0 if low <= 0 <= high else min(abs(low), abs(high)) for low, high in ends]
    most = [max(abs(low), abs(high)) for low, high in ends]
    return _length(least), _length(most)


def trust_at_rest(deflected: Deflections, frequency_bar: float | None, demand: str) -> Trust:
    """Return the judge of a deflection, and the cheapest model within the tolerance."""
    judge, cheapest = deflected.judge, deflected.cheapest
    scales: dict[str, float] = {}
    for m in judge.compared:
        scales[m.unit] = math.hypot(scales.get(m.unit, 0.0), m.value)
    shares = [
        m.bar / scales[m.unit] for m in judge.compared if m.bar is not None and scales[m.unit]
    ]
    return Trust(
        model=judge.model,
        tolerance=deflected.tolerance,
        reached=bool(shares) and max(shares) <= deflected.tolerance,
        static_bar=max(shares, default=None),
        frequency_bar=frequency_bar,
        cheapest="" if cheapest is None else cheapest.model,
        gap=None if cheapest is None else cheapest.gap,
        demand=demand,
    )


def cautions_of_bearings(deflected: Deflections) -> Iterator[Remark]:
    """Yield cautions on bearings beyond what they are rated for."""
    alone = len(deflected.judge.shafts) == 1
    for shaft in deflected.judge.shafts:
        for bearing in shaft.bearings:
            name = bearing.name if alone else f"{shaft.name}.{bearing.name}"
            if bearing.life is None:
                continue
            safety = bearing.life.static_safety
            if safety < 1:
                yield Remark("caution static", {"name": name, "safety": f"{safety:.2f}"})
            share = bearing.life.equivalent.load / bearing.life.rated.dynamic
            if share > MOST_LOAD:
                yield Remark("caution overloaded", {"name": name, "share": f"{share:.2f}"})


def cautions_of_notch(worst: WorstNotch | None) -> Iterator[Remark]:
    """Yield cautions on safeties below the least that the norm asks for."""
    if worst is None or worst.fatigue is None or worst.yielding is None:
        return
    safeties = [
        (worst.place, "fatigue", worst.fatigue),
        (worst.place, "yielding", worst.yielding),
        *((other.place, other.kind, other.safety) for other in worst.elsewhere),
    ]
    for place, kind, safety in safeties:
        if safety < LEAST_SAFETY:
            values = {"place": place, "safety": f"{safety:.2f}", "least": f"{LEAST_SAFETY:g}"}
            yield Remark(f"caution {kind}", values)
