"""Checks of a train before anything large is solved: the guards of all shafts, and cautions on the
system.

All shafts are checked up to the frequency and to the tolerance that the train asks for; the light
solids that the guards solve are coupled as well, and show which modes the reduction resolves.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from solidgear.core import HARMONIC, SolidgearError, Source, build, pinned
from solidgear.guards.check import BEST, Check, Verdict, check_scene, record
from solidgear.guards.notice import Notice, Notices
from solidgear.guards.probe import Probe
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.housing import housing_facts
from solidgear.trains.assembly.layout import senses, senses_sentence
from solidgear.trains.assembly.local import undriven
from solidgear.trains.assembly.matrices_body import matrices_facts
from solidgear.trains.assembly.shaft import JUDGE
from solidgear.trains.assembly.slips import mesh_unit_slips
from solidgear.trains.file.mesh_teeth import wheels_of
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh
from solidgear.trains.file.tables import TEETH
from solidgear.trains.file.tooth_fit import fit_line, fit_of
from solidgear.trains.file.train import Train
from solidgear.trains.modes.modes import (
    RESOLVED,
    free_motions,
    refuse_unresolved,
    unpublished_lines,
    wrench_lines,
)
from solidgear.trains.options import Reduced

#: a loss factor below this gives peaks whose height is a matter of the loss alone
LITTLE_LOSS = 1e-3
ALONE = (
    "guards judge each shaft alone; run solidgear compare to see which shaft needs the solid in "
    "mesh, and from which frequency on"
)
#: name of the guard of what concerns the train as a whole
TRAIN = "train"


def check_source(source: Source) -> Check:
    """Check a train from its path, tables or object."""
    return check_train(Reduced().assembly(source))


@pinned
def check_train(assembly: Assembly, max_frequency: float | None = None) -> Check:
    """Check a train up to a frequency, Hz, and each of its shafts by every guard; the verdict on a
    model is the worst of all shafts.

    Examples
    --------
    >>> import solidgear as sg
    >>> train_check = check_train(Assembly(sg.load_train("geometry/axle_overhung.toml")))
    >>> train_check.shafts["pinion"].verdicts["timoshenko"].verdict, train_check.faults
    ('will not hold', [])
    """
    train = assembly.train
    limit = max_frequency or train.ask.max_frequency
    shafts: dict[str, Check] = {}
    light = Assembly(train, assembly.reduction, assembly.kept)
    for side in train.shafts:
        scene = assembly.scenes[side]
        ask = scene.ask.with_changes(max_frequency=limit, tolerance=train.ask.tolerance)
        scene = scene.with_changes(ask=ask)
        probe = Probe(scene.plain, build(scene.plain, JUDGE, **HARMONIC), whole=scene)
        shafts[side] = check_scene(scene, probe.body, probe)
        light.set_body(side, JUDGE, probe.solution(JUDGE).body)
    records = tuple(record(TRAIN, notice, ()) for notice in _notices(assembly, light, limit))
    return Check(train.name, records, _worst_verdicts(shafts), shafts)


def _notices(assembly: Assembly, light: Assembly, limit: float) -> Notices:
    """Yield notices on a train as a whole; `light` has the light solids of the guards."""
    train = assembly.train
    facts = [*_facts(assembly, limit), *housing_facts(train), *matrices_facts(train)]
    facts += [line for contact in assembly.contacts.values() for line in wrench_lines(contact)]
    # those of the shafts stand with their guards
    cautions = [*assembly.cautions(), *mesh_unit_slips(assembly), *_loss_cautions(train)]
    for pair in train.drivers:
        if isinstance(pair, PlanetMesh) and pair.mate == "ring":
            continue  # it has the table of the sun
        prefix = f"{pair.name}: " if pair.label else ""
        cautions += [prefix + line for line in _error_cautions(pair, limit)]
    try:
        facts += _system_facts(light, limit)
    except SolidgearError as error:
        yield Notice("fault", (), str(error))
    for side in train.shafts:
        cautions += _undriven_caution(light, side, limit)
    facts += [*unpublished_lines(train.unpublished()), ALONE]
    yield from (Notice("caution", (), sentence) for sentence in cautions)
    yield from (Notice("fact", (), sentence) for sentence in facts)


def _facts(assembly: Assembly, limit: float) -> Iterator[str]:
    train = assembly.train
    asked = {pair.name: pair for pair in assembly.asked_train.pairs}
    at = "" if train.point is None else f" at {train.point.label}"
    for pair in train.pairs:
        contact, prefix = assembly.contacts[pair.name], f"{pair.name}: " if pair.label else ""
        levers = [1e3 * abs(vector.lever) for vector in (contact.pinion, contact.gear)]
        yield (
            f"{prefix}{pair.pinion.teeth} and {pair.gear.teeth} teeth, lever arms {levers[0]:.2f} and "
            f"{levers[1]:.2f} mm, mesh {contact.stiffness:.4g} N/m along "
            f"({', '.join(f'{v:.3f}' for v in contact.pinion.normal)}) on the {pair.shafts[0]}"
        )
        yield from (prefix + fact for fact in _tooth_facts(asked[pair.name], at))
        teeth = train.per_turn(pair)
        yield (
            f"{prefix}the {limit:g} Hz asked for is the mesh frequency at {60 * limit / teeth:.0f} "
            f"rpm of the {teeth.of}"
        )
    for stage in train.stages:
        gears, (sun, carrier) = stage.teeth, stage.shafts
        yield (
            f"{stage.called}: {gears.sun}, {gears.planet} and {gears.ring} teeth, "
            f"{len(gears.azimuths)} planets, one turn of the {carrier} in {stage.ratio:.6g} of the "
            f"{sun}; pins at {1e3 * gears.pin_radius:.6g} mm, meshes "
            f"{stage.stiffness('sun'):.4g} N/m with the sun and {stage.stiffness('ring'):.4g} N/m with "
            "the ring"
        )
    yield senses_sentence(senses(train, assembly.contacts))
    loss = train.losses
    yield (
        f"losses are loss factors, twice a damping ratio: shafts {loss.shafts:g}, bearings "
        f"{loss.bearings:g}, mesh {loss.mesh:g}, springs {loss.springs:g}"
    )


def _tooth_facts(pair: Pair, at: str) -> Iterator[str]:
    """Yield facts on the teeth of a pair at an operating point: their fit, and what is assumed where it
    counts.
    """
    fit, solves = fit_of(pair), pair.mesh.stiffness == TEETH
    is_described = any(gear.is_described for gear in pair.members.values())
    teeth = wheels_of(pair) if solves or is_described else None
    if fit is None and teeth is not None:
        fit = teeth.wheels
    if fit is not None:
        yield fit_line(fit)
    if solves:
        yield f'the teeth give this stiffness (stiffness = "{TEETH}"){at}'
    if teeth is not None and teeth.assumed:
        yield f"assumed of the teeth: {'; '.join(teeth.assumed)}"


def _loss_cautions(train: Train) -> Iterator[str]:
    loss = train.losses
    small = [
        f"{name} {value:g}"
        for name, value in loss.model_dump().items()
        if isinstance(value, float) and value < LITTLE_LOSS
    ]
    if small:
        yield (
            f"a loss factor is below {LITTLE_LOSS:g} ({', '.join(small)}): peaks of a mode in "
            "that part depend on this number alone"
        )


def _error_cautions(pair: Pair | PlanetMesh, limit: float) -> Iterator[str]:
    table = pair.mesh.transmission_error
    if table is None:
        return
    if table.frequency and table.frequency[-1] < limit:
        yield (
            f"the transmission error is given up to {table.frequency[-1]:g} Hz, and taken as "
            f"constant from there to the {limit:g} Hz asked for"
        )
    if not any((*table.orders, *table.amplitude)):
        yield "the transmission error is zero, so that there is no response; drive by --force"


def _system_facts(assembly: Assembly, limit: float) -> Iterator[str]:
    """Yield facts of the light solids coupled."""
    system = assembly.system(JUDGE)
    refuse_unresolved(assembly, system, limit)
    omega, _ = system.elastic
    count = int((omega <= 2 * np.pi * limit).sum())
    modes = system.modes(max(1, count))
    cut = float(np.sqrt(system.truncation.cut) / (2 * np.pi))
    worst = float(modes.error_bound.max())
    word = "within" if worst < RESOLVED else "NOT within"
    yield (
        f"{count} elastic modes up to {limit:g} Hz on light solids; {assembly.reduction}, {assembly.kept} "
        f"modes per shaft and the first left out at {cut:.0f} Hz: errors up to {worst:.0e} in "
        f"frequency, {word} {RESOLVED:g}"
    )
    yield from free_motions(assembly, system) or ("the whole train turns freely, at exactly 0 Hz",)


def _undriven_caution(assembly: Assembly, side: str, limit: float) -> Iterator[str]:
    """Yield a caution on modes of a light solid that averaged ports cannot drive."""
    pairs = [pair for pair in assembly.train.pairs if side in pair.shafts]
    driven = {n for pair in pairs for n in pair.mesh.local_harmonics}
    frequencies = undriven(assembly.shaft_model(side, JUDGE).body, limit, tuple(driven))
    if frequencies:
        families = ", ".join(f"n = {n} at {hz[0]:.0f} Hz" for n, hz in frequencies.items())
        yield (
            f"the {side} has modes with nodal diameters below {limit:g} Hz ({families}), which this "
            "mesh model does not drive; add them by --local-harmonics"
        )


def _worst_verdicts(shafts: dict[str, Check]) -> dict[str, Verdict]:
    """Return by model the worst of the verdicts on all shafts and the shafts that have it."""
    models = [*next(iter(shafts.values())).verdicts]
    verdicts = {}
    for model in models:
        if any(model not in check.verdicts for check in shafts.values()):
            continue
        by_side = {side: check.verdicts[model].verdict for side, check in shafts.items()}
        worst = max(by_side.values(), key=BEST.index)
        sides = [side for side in by_side if by_side[side] == worst]
        verdicts[model] = Verdict(worst, () if worst == BEST[0] else tuple(sides))
    return verdicts
