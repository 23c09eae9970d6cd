"""Facts of one shaft: numbers asked for, model trusted, shaft at rest, natural frequencies, speed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

from solidgear.bearings import study
from solidgear.bearings.catalogue import catalogue_of
from solidgear.bearings.study import BearingFacts
from solidgear.core import Scene, SolidgearError, load, number_cautions, without_axis
from solidgear.core.judge.at_rest import spin_moved
from solidgear.datasheet.assumed import absent_notch, assumed, assumed_at_rest
from solidgear.datasheet.at_rest import (
    bearing_facts,
    cautions_of_bearings,
    cautions_of_notch,
    designation,
    forces_alone,
    life_fact,
    lives_over_points,
    motions,
    sharp_corners,
    trust_at_rest,
    worst_notch,
    worst_section,
)
from solidgear.datasheet.facts import (
    BearingFact,
    DrawnShaft,
    Frequency,
    Remark,
    Resonance,
)
from solidgear.datasheet.numbers import Numbers, answered_numbers
from solidgear.datasheet.result import Datasheet
from solidgear.datasheet.spin import caution_of_spin
from solidgear.strength.deflection import at_rest
from solidgear.strength.stress.at_rest import StressSettings, stress_at_rest
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import ALONE
from solidgear.trains.load.operation import body_at_rest

Progress = Callable[[str], None]
#: orders of a shaft that excite it most: unbalance, and misalignment or a keyway
ORDERS = (1, 2)


def shaft_sheet(
    assembly: Assembly,
    point: OperatingPoint,
    settings: StressSettings | None = None,
    tol: float | str | None = None,
    speed: float | None = None,
    progress: Progress = lambda text: None,
    numbers: Numbers | None = None,
) -> Datasheet:
    """Return the sheet of a shaft alone, by numbers that are there or answered; a body without an
    axis is refused.
    """
    scene = assembly.train.shafts[ALONE].scene
    if without_axis(scene):
        raise SolidgearError(f"sheet: {scene.name} has no axis: run solidgear stiffness or modes")
    settled = load(scene)
    numbers = numbers or answered_numbers(settled, tol, progress)
    turning = speed or point.speed or speed_of(settled)
    lives = lives_of(assembly, speed or point.speed)
    sheet = Datasheet(
        title=settled.title or settled.name,
        file=settled.name,
        train=False,
        drawn=(
            DrawnShaft(settled.name, settled.as_dict(), sense=settled.turns or "", speed=turning),
        ),
        figures=numbers.figures,
        trust=numbers.trust,
        bearings=tuple(lives.get(b.name, without_load(b)) for b in scene.bearings),
        frequencies=numbers.frequencies,
        resonances=resonances(numbers.frequencies, turning),
        operation=case_of(scene),
        speed=turning,
        assumed=tuple(assumed(scene, numbers.ranges)),
        absent={} if turning else {"speeds": Remark("absent speed")},
        cautions=(
            *numbers.cautions(),
            *(
                Remark("caution seat")
                for _ in number_cautions(settled, model=numbers.trust.model)[:1]
            ),
            *_at_rest(settled, numbers, turning),
        ),
    )
    if not scene.is_loaded:
        reason = Remark("absent load")
        absent = {"worst": reason, "motions": reason}
        return replace(sheet, absent=sheet.absent | absent)
    return _under_load(sheet, assembly, point, settings or StressSettings(), lives, progress)


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
    deflected = at_rest.deflect(assembly, point)
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
        corners=sharp_corners(stressed),
        section=worst_section(stressed),
        absent=sheet.absent | absent_notch(stressed, notch),
        bearings=bearing_facts(deflected, {ALONE: assembly.scenes[ALONE]}, lives),
        motions=motions(deflected, [port.name for port in scene.ports]),
        assumed=(*sheet.assumed, *assumed_at_rest(stressed, notch)),
        cautions=(*sheet.cautions, *cautions_of_bearings(deflected), *cautions_of_notch(notch)),
        elsewhere=len({*deflected.cautions, *deflected.judge.notes, *stressed.cautions}),
    )


def _at_rest(scene: Scene, numbers: Numbers, speed: float | None) -> Iterator[Remark]:
    """Yield a caution on frequencies of a shaft that turns."""
    try:
        moved = spin_moved(scene, {f.mode: f.bar for f in numbers.frequencies}, speed)
    except SolidgearError:
        yield Remark("caution at rest")
        return
    yield from caution_of_spin(moved)


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


def lives_of(assembly: Assembly, speed: float | None) -> dict[str, BearingFact]:
    """Return lives of the catalogue bearings of a shaft by name, over the cases of its loads where
    there are several; empty without any.
    """
    scene = assembly.train.shafts[ALONE].scene
    if not any(bearing.catalogue is not None for bearing in scene.bearings):
        return {}
    if len(scene.cases) > 1:
        return lives_over_points(assembly)
    facts = study.bearing_facts(scene, body_at_rest(assembly), speed)
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
