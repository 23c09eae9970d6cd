"""Facts of one shaft: numbers asked for, model trusted, shaft at rest, natural frequencies, speed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

from solidgear.bearings.catalogue import catalogue_of
from solidgear.bearings.study import BearingFacts
from solidgear.bearings.study import bearing_facts as catalogue_facts
from solidgear.core import LADDER, OpenNumbers, Quantity, Scene, SolidgearError, load, without_axis
from solidgear.core.judge.answer import Answered, answer
from solidgear.core.judge.quantities import judged
from solidgear.core.loading import shaft as settling_body
from solidgear.core.scene.acting import loads_of
from solidgear.datasheet.at_rest import (
    bearing_facts,
    cautions_of_bearings,
    cautions_of_notch,
    designation,
    forces_alone,
    life_fact,
    lives_over_points,
    motions,
    trust_at_rest,
    worst_notch,
    worst_section,
)
from solidgear.datasheet.facts import (
    Amount,
    BearingFact,
    DrawnShaft,
    Figure,
    Frequency,
    Remark,
    Resonance,
    Trust,
    WorstNotch,
)
from solidgear.datasheet.result import Datasheet
from solidgear.show.remarks import open_ranges
from solidgear.strength.acting import FEW
from solidgear.strength.deflection import at_rest
from solidgear.strength.load import LoadsAlone
from solidgear.strength.stress.at_rest import StressAtRest, StressSettings, stress_at_rest
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.shaft import JUDGE
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import ALONE, Train

Progress = Callable[[str], None]
#: frequencies that a sheet lists beside the numbers asked for
FREQUENCIES = tuple(map(Quantity, ("bending 1", "bending 2", "axial 1", "torsion 1")))
#: orders of a shaft that excite it most: unbalance, and misalignment or a keyway
ORDERS = (1, 2)
#: share of a speed within which a resonance is listed
NEAR = 0.2


def shaft_sheet(
    assembly: Assembly,
    point: OperatingPoint,
    settings: StressSettings,
    tol: float | None,
    speed: float | None,
    progress: Progress,
) -> Datasheet:
    """Return the sheet of a shaft alone, its bearings settled once; a body without an axis is
    refused.
    """
    scene = assembly.train.shafts[ALONE].scene
    if without_axis(scene):
        raise SolidgearError(f"sheet: {scene.name} has no axis: run solidgear stiffness or modes")
    settled = load(scene)
    progress("numbers")
    wanted = judged(settled)
    names = [*wanted]
    if not LADDER[JUDGE].unfit(settled):  # of other solids every further number is dear
        names += [q for q in FREQUENCIES if q not in wanted]
    answered = answer(settled, tol, names)
    progress("what the data leave open")
    ranges = open_ranges(settled)
    turning = speed or point.speed or speed_of(settled)
    figures = {value.quantity: figure(value, ranges) for value in answered.values}
    frequencies = tuple(
        Frequency(name, f.value, f.bar, f.open) for name, f in figures.items() if name.is_frequency
    )
    lives = lives_of(assembly.train, speed or point.speed)
    sheet = Datasheet(
        title=settled.title or settled.name,
        file=settled.name,
        train=False,
        drawn=(
            DrawnShaft(settled.name, settled.as_dict(), sense=settled.turns or "", speed=turning),
        ),
        figures=tuple(figures[q] for q in wanted if q in figures),
        trust=trust(answered, wanted),
        bearings=tuple(lives.get(b.name, without_load(b)) for b in scene.bearings),
        frequencies=frequencies,
        resonances=resonances(frequencies, turning),
        operation=case_of(scene),
        speed=turning,
        assumed=tuple(assumed(scene, ranges)),
        absent={} if turning else {"speeds": Remark("absent speed")},
        cautions=tuple(cautions(answered, ranges)),
    )
    if not scene.is_loaded:
        reason = Remark("absent load")
        absent = {"worst": reason, "motions": reason}
        return replace(sheet, absent=sheet.absent | absent)
    return _under_load(sheet, assembly, point, settings, lives, progress)


def _under_load(
    sheet: Datasheet,
    assembly: Assembly,
    point: OperatingPoint,
    settings: StressSettings,
    lives: dict[str, BearingFact],
    progress: Progress,
) -> Datasheet:
    """Return the sheet with what the load does to the shaft at rest."""
    progress("deflection")
    scene = assembly.train.shafts[ALONE].scene
    cuts = tuple(feature.name for feature in scene.features) if LADDER[JUDGE].unfit(scene) else ()
    # what is cut out moves loads of bearings by next to nothing
    deflected = at_rest.deflect(Assembly.of(scene.plain, kept=FEW) if cuts else assembly, point)
    progress("stress")
    stressed = stress_at_rest(assembly, point, asked=settings)
    notch = worst_notch(stressed)
    bars = [f.bar for f in sheet.frequencies if f.bar is not None]
    trust_under_load = trust_at_rest(deflected, max(bars, default=None), "within motion")
    (drawn,) = sheet.drawn
    return replace(
        sheet,
        drawn=(replace(drawn, forces=forces_alone(deflected)),),
        trust=replace(
            sheet.trust,
            cheapest=trust_under_load.cheapest,
            gap=trust_under_load.gap,
            demand="within motion",
        ),
        notch=notch,
        section=worst_section(stressed),
        absent=sheet.absent | absent_notch(stressed, notch),
        bearings=bearing_facts(deflected, {ALONE: assembly.scenes[ALONE]}, lives),
        motions=motions(deflected, [port.name for port in scene.ports]),
        assumed=(*sheet.assumed, *assumed_at_rest(stressed, notch, cuts)),
        cautions=(*sheet.cautions, *cautions_of_bearings(deflected), *cautions_of_notch(notch)),
        elsewhere=len({*deflected.cautions, *deflected.judge.notes, *stressed.cautions}),
    )


def figure(value: Any, ranges: OpenNumbers) -> Figure:
    """Return a number of an answer with both error bars."""
    number = ranges.of(value.quantity)
    total = None if number is None else number.total
    open_ = None if total is None else (total.low or 0.0, total.high or 0.0)
    bar = value.bar if math.isfinite(value.bar) else None
    return Figure(str(value.quantity), value.value, value.unit, bar, open_)


def trust(answered: Answered, wanted: tuple[Quantity, ...]) -> Trust:
    """Return the model of an answer, with the widest error bars of the numbers asked for."""
    values = [v for v in answered.values if v.quantity in wanted and math.isfinite(v.bar)]
    static = [v.bar for v in values if not v.quantity.is_frequency]
    frequency = [v.bar for v in values if v.quantity.is_frequency]
    return Trust(
        model=answered.rung,
        tolerance=answered.tolerance,
        reached=all(v.bar <= answered.tolerance for v in answered.values if v.quantity in wanted),
        static_bar=max(static, default=None),
        frequency_bar=max(frequency, default=None),
    )


def speed_of(scene: Scene) -> float | None:
    """Return the speed that a scene gives, rad/s; None without one."""
    oil = scene.lubrication
    speeds = [oil.speed] if oil is not None and oil.speed else []
    data = [catalogue_of(bearing) for bearing in scene.bearings]
    speeds += [d.speed for d in data if d is not None and d.speed]
    return max(map(abs, speeds), default=None)


def case_of(scene: Scene) -> Remark | None:
    """Return the case of the loads that a sheet is of; None of a scene without cases."""
    if not scene.cases:
        return None
    count = len(scene.cases)
    return Remark(
        "case" if count == 1 else "case of", {"name": scene.cases[0].name, "count": count}
    )


def lives_of(train: Train, speed: float | None) -> dict[str, BearingFact]:
    """Return lives of the catalogue bearings of a shaft by name, over the cases of its loads where
    there are several; empty without any.
    """
    scene = train.shafts[ALONE].scene
    if not any(bearing.catalogue is not None for bearing in scene.bearings):
        return {}
    if len(scene.cases) > 1:
        return lives_over_points(train)
    facts = catalogue_facts(scene, settling_body(scene), speed)
    return {fact.name: _alone(fact) for fact in facts}


def _alone(fact: BearingFacts) -> BearingFact:
    life = life_fact(fact.name, fact.bearing, fact.life)
    radial = math.hypot(fact.load[0], fact.load[2])
    return replace(life, radial=radial, axial=float(fact.load[1]))


def without_load(bearing: Any) -> BearingFact:
    """Return a bearing whose load is not known."""
    return BearingFact(bearing.name, designation(bearing))


def resonances(frequencies: tuple[Frequency, ...], speed: float | None) -> tuple[Resonance, ...]:
    """Return speeds at which orders of a shaft meet its bending modes, the nearest first."""
    if not speed:
        return ()
    met = []
    for frequency in frequencies:
        if not frequency.mode.startswith("bending"):
            continue
        bar, (low, high) = frequency.bar or 0.0, frequency.open or (0.0, 0.0)
        for order in ORDERS:
            critical = 2 * math.pi * frequency.hz / order
            met.append(
                Resonance(
                    order=order,
                    source="",
                    by_teeth=False,
                    mode=frequency.mode,
                    speed=critical,
                    low=critical * (1 + low) * (1 - bar),
                    high=critical * (1 + high) * (1 + bar),
                    distance=speed / critical - 1,
                )
            )
    return tuple(sorted(met, key=lambda resonance: abs(resonance.distance)))


def assumed(scene: Scene, ranges: OpenNumbers) -> Iterator[Remark]:
    """Yield what the data of a shaft leave to be assumed."""
    data = {b.name: catalogue_of(b) for b in scene.bearings}
    estimated = [name for name, d in data.items() if d is not None and d.estimated]
    if estimated:
        yield Remark("assumed inside", {"names": tuple(estimated)})
    classes = [n for n, d in data.items() if d is not None and isinstance(d.clearance, str)]
    if classes:
        yield Remark("assumed clearance", {"names": tuple(classes)})
    stiffness = [b.name for b in scene.bearings if b.status == "assumed" and not b.hold]
    if stiffness:
        yield Remark("assumed stiffness", {"names": tuple(stiffness)})
    loads = loads_of(scene)
    angles = [load.name for load in loads if load.kind == "gear" and load.pressure_angle is None]
    if angles:
        yield Remark("assumed angle", {"names": tuple(angles)})
    belts = [load.name for load in loads if load.kind == "belt"]
    if belts:
        yield Remark("assumed belt", {"names": tuple(belts)})
    stated = [entry.path for entry in scene.uncertain]
    if stated:
        yield Remark("assumed ranges", {"names": tuple(stated)})
    if ranges.left_out:
        yield Remark("assumed without ranges")


def assumed_at_rest(
    stressed: StressAtRest, notch: WorstNotch | None, cuts: tuple[str, ...] = ()
) -> Iterator[Remark]:
    """Yield what deflection and stress at rest assume, the former without some cuts."""
    if cuts:
        yield Remark("assumed plain", {"names": cuts})
    names = () if notch is None else notch.assumed
    if factors := tuple(name for name in names if name.startswith("K")):
        yield Remark("assumed factors", {"names": factors})
    if len(factors) < len(names):
        yield Remark("assumed steady")
    under = stressed.under
    if isinstance(under, LoadsAlone) and not any(load.six[4] for load in under.acting):
        yield Remark("assumed no torque")


def absent_notch(stressed: StressAtRest, notch: WorstNotch | None) -> dict[str, Remark]:
    """Return why no notch is rated, by section; empty where one is."""
    if notch is None:
        return {"notch": Remark("absent notch")}
    if notch.fatigue is None:
        weak = [name for shaft in stressed.shafts for name in shaft.weak]
        return {"notch": Remark("absent strength", {"names": tuple(dict.fromkeys(weak))})}
    return {}


def cautions(answered: Answered, ranges: OpenNumbers) -> Iterator[Remark]:
    """Yield cautions on numbers of a shaft."""
    if not answered.reached:
        bar = max((v.bar for v in answered.values), default=math.inf)
        if math.isfinite(bar):
            values = {
                "bar": Amount(100 * bar, "%", 2),
                "tolerance": Amount(100 * answered.tolerance, "%", 2),
            }
            yield Remark("caution tolerance", values)
    for name in ranges.lost:
        yield Remark("caution lost", {"name": name})
