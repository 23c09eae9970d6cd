"""Facts of a train: misalignment, model trusted, shafts at rest, natural frequencies, speeds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

from solidgear.core import OpenNumbers, number_cautions
from solidgear.datasheet.assumed import absent_notch, assumed, assumed_at_rest
from solidgear.datasheet.at_rest import (
    bearing_facts,
    cautions_of_bearings,
    cautions_of_notch,
    designation,
    forces,
    lives_over_points,
    motions,
    sharp_corners,
    trust_at_rest,
    worst_notch,
    worst_section,
)
from solidgear.datasheet.facts import (
    NEAR,
    Amount,
    BearingFact,
    DrawnShaft,
    Figure,
    Frequency,
    Remark,
    Resonance,
    Speed,
    Trust,
)
from solidgear.datasheet.result import Datasheet
from solidgear.datasheet.spin import caution_of_spin
from solidgear.strength.deflection import at_rest
from solidgear.strength.deflection.at_rest import Deflections, Measured
from solidgear.strength.stress.at_rest import StressSettings, stress_at_rest
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.kinematics import train_orders
from solidgear.trains.assembly.shaft import JUDGE, usual_models
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import Train
from solidgear.trains.load.operation import settled_at
from solidgear.trains.modes.modes import TrainMode, train_modes

Progress = Callable[[str], None]
#: elastic modes that a sheet lists
MODES = 6
#: kinds of orders that are held against modes: those that excite most
EXCITING = ("mesh", "shaft")


def train_sheet(
    train: Train,
    assembly: Assembly | None,
    point: OperatingPoint | None,
    settings: StressSettings,
    progress: Progress,
) -> Datasheet:
    """Return the sheet of a train, at an operating point where it has one."""
    progress("natural frequencies")
    settled = Assembly(settled_at(train, point) if point else train)
    # all that system-modes lists, for they decide the meshes
    modes = train_modes(settled, *usual_models(train.shafts).values(), at_most=train.ask.modes)
    models = tuple(dict.fromkeys(modes.models.values()))
    # only meshes of harmonic shafts have an error bar in modes of a train
    listed = modes.modes[: modes.rigid + MODES]
    if models != (JUDGE,):
        listed = tuple(replace(mode, mesh=None) for mode in listed)
    frequencies = tuple(map(_frequency, (mode for mode in listed if mode.frequency_hz > 0)))
    speed = None if point is None else point.speed_of(train.reference, train.turns)
    drawn = tuple(DrawnShaft(side, shaft.scene.as_dict()) for side, shaft in train.shafts.items())
    bars = [f.bar for f in frequencies if f.bar is not None]
    sheet = Datasheet(
        title=train.title or train.name,
        file=train.name,
        train=True,
        trust=Trust(" + ".join(models), train.ask.tolerance, True, None, max(bars, default=None)),
        drawn=drawn,
        frequencies=frequencies,
        resonances=resonances(train, listed, speed),
        turns=train.reference,
        speed=speed,
        bearings=tuple(
            BearingFact(f"{side}.{bearing.name}", designation(bearing))
            for side, shaft in train.shafts.items()
            for bearing in shaft.scene.bearings
        ),
        assumed=tuple(_assumed(train)),
        absent={} if speed else {"speeds": Remark("absent train speed")},
        cautions=(*_on_seats_and_teeth(settled), *caution_of_spin(modes.spin)),
    )
    if assembly is None or point is None:
        reason = Remark("absent operation")
        absent = {"figures": reason, "worst": reason, "motions": reason}
        return replace(sheet, absent=sheet.absent | absent)
    return _at_point(sheet, train, assembly, point, settings, progress)


def _on_seats_and_teeth(assembly: Assembly) -> Iterator[Remark]:
    """Yield cautions on seats of shafts, and on teeth whose contact gave a stiffness."""
    if any(number_cautions(scene, model=JUDGE) for scene in assembly.scenes.values()):
        yield Remark("caution seat")
    if assembly.train.solved_meshes.cautions:
        yield Remark("caution teeth")


def _at_point(
    sheet: Datasheet,
    train: Train,
    assembly: Assembly,
    point: OperatingPoint,
    settings: StressSettings,
    progress: Progress,
) -> Datasheet:
    """Return the sheet with what the torque does to the train at rest."""
    progress("deflection")
    deflected = at_rest.deflect(assembly, point)
    progress("stress")
    stressed = stress_at_rest(assembly, point, asked=settings)
    notch = worst_notch(stressed)
    shafts = {shaft.name: shaft for shaft in stressed.shafts}
    weight = [Remark("assumed weight")] if point.weight else []
    drawn = tuple(
        replace(
            shaft,
            forces=forces(shafts[shaft.name]),
            sense=deflected.senses.get(shaft.name, ""),
            speed=point.speed_of(shaft.name, train.turns),
        )
        for shaft in sheet.drawn
    )
    return replace(
        sheet,
        drawn=drawn,
        operation=_operation(point),
        figures=tuple(figures(deflected)),
        trust=trust_at_rest(deflected, sheet.trust.frequency_bar, "within misalignment"),
        notch=notch,
        corners=sharp_corners(stressed),
        section=worst_section(stressed),
        absent=sheet.absent | absent_notch(stressed, notch),
        bearings=bearing_facts(deflected, assembly.scenes, lives_over_points(assembly, point)),
        motions=motions(deflected),
        assumed=(*sheet.assumed, *weight, *assumed_at_rest(stressed, notch)),
        cautions=(*sheet.cautions, *cautions_of_bearings(deflected), *cautions_of_notch(notch)),
        elsewhere=len({*deflected.cautions, *deflected.judge.notes, *stressed.cautions}),
    )


def _operation(point: OperatingPoint) -> Remark:
    values = {"torque": Amount(point.torque, "N m", None), "shaft": point.of, "name": point.name}
    key = "under named point" if point.name else "under point"
    if point.speed is None:
        return Remark(key, values)
    return Remark(f"{key} at speed", values | {"speed": Speed(point.speed)})


def figures(deflected: Deflections) -> Iterator[Figure]:
    """Yield the misalignment of the gears and the face load factors, with both error bars."""
    for measure in deflected.judge.misalignment:
        yield _relative(measure)
    for load in deflected.judge.face_loads:
        bar = None if load.bar is None else load.bar / load.factor
        yield Figure(f"KHb{load.mesh.removeprefix('mesh')}", load.factor, "1", bar)


def _relative(measure: Measured) -> Figure:
    size = abs(measure.value)
    if not size:
        return Figure(measure.name, measure.value, measure.unit, None)
    open_ = None
    if measure.open is not None:
        ends = sorted((end - measure.value) / measure.value for end in measure.open)
        open_ = ends[0], ends[1]
    bar = None if measure.bar is None else measure.bar / size
    return Figure(measure.name, measure.value, measure.unit, bar, open_)


def _frequency(mode: TrainMode) -> Frequency:
    bar = None if mode.mesh is None else mode.mesh + mode.bound
    return Frequency(mode.name, mode.frequency_hz, bar)


def resonances(
    train: Train, modes: tuple[TrainMode, ...], speed: float | None
) -> tuple[Resonance, ...]:
    """Return speeds near that of the engine's shaft at which orders of meshes and shafts meet modes,
    the nearest first.
    """
    if not speed:
        return ()
    met = []
    for order in train_orders(train):
        if order.kind not in EXCITING:
            continue
        source, _, number = order.name.rpartition(" ")
        for mode in modes:
            if not mode.frequency_hz or not mode.driven:
                continue
            critical = 2 * math.pi * mode.frequency_hz / order.per_turn
            distance, bar = abs(speed) / critical - 1, (mode.mesh or 0.0) + mode.bound
            if abs(distance) <= NEAR:
                resonance = Resonance(
                    order=int(number),
                    source=source,
                    by_teeth=order.kind == "mesh",
                    mode=mode.name,
                    speed=critical,
                    low=critical * (1 - bar),
                    high=critical * (1 + bar),
                    distance=distance,
                )
                met.append(resonance)
    return tuple(sorted(met, key=lambda resonance: abs(resonance.distance)))


def _assumed(train: Train) -> Iterator[Remark]:
    """Yield what the data of a train leave to be assumed, with the shafts of bearings."""
    names: dict[str, list[str]] = {}
    for side, shaft in train.shafts.items():
        for remark in assumed(shaft.scene, OpenNumbers()):
            entries = (f"{side}.{name}" for name in remark.values["names"])
            names.setdefault(remark.key, []).extend(entries)
    for key, several in names.items():
        yield Remark(key, {"names": tuple(several)})
    # bearings are named above
    unpublished = tuple(key for key in train.unpublished() if " bearing " not in key)
    if unpublished:
        yield Remark("assumed entries", {"names": unpublished})
