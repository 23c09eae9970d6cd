"""Checks of a train before anything large is solved: the guards of all shafts, and cautions on the
system.

All shafts are checked up to the frequency and to the tolerance that the train asks for; the light
solids that the guards solve are coupled as well, and show which modes the reduction resolves.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from solidgear.core import HARMONIC, SolidgearError, build, pinned
from solidgear.guards import Probe
from solidgear.guards.check import check_scene
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.housing import housing_facts
from solidgear.trains.assembly.layout import senses, senses_sentence
from solidgear.trains.assembly.local import undriven
from solidgear.trains.assembly.shaft import JUDGE
from solidgear.trains.assembly.slips import mesh_unit_slips
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh
from solidgear.trains.file.tooth_fit import fit_line, fit_of
from solidgear.trains.file.train import Train
from solidgear.trains.modes.modes import (
    RESOLVED,
    free_motions,
    refuse_unresolved,
    unpublished_lines,
    wrench_lines,
)

#: a loss factor below this gives peaks whose height is a matter of the loss alone
LITTLE_LOSS = 1e-3
ALONE = (
    "guards judge each shaft alone; run solidgear compare to see which shaft needs the solid in "
    "mesh, and from which frequency on"
)
#: verdicts in the order in which the worst of two is chosen
WORST = ("will not hold", "uncertain", "holds with caution", "holds")


@pinned
def check_train(assembly: Assembly, max_frequency: float | None = None) -> dict:
    """Return ``facts``, ``cautions`` and ``faults`` (sentences) of a train up to a frequency, Hz,
    the checks of each shaft under its name as of :func:`solidgear.guards.check.check_scene`,
    and ``verdicts`` by model, the worst of all shafts.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = check_train(Assembly(sg.load_train("geometry/axle_overhung.toml")))
    >>> found["pinion"]["verdicts"]["timoshenko"]["verdict"], found["faults"]
    ('will not hold', [])
    """
    train = assembly.train
    limit = max_frequency or train.ask.max_frequency
    by_shaft: dict = {}
    light = Assembly(train, assembly.reduction, assembly.kept)
    for side in train.shafts:
        scene = assembly.scenes[side]
        ask = scene.ask.with_changes(max_frequency=limit, tolerance=train.ask.tolerance)
        scene = scene.with_changes(ask=ask)
        probe = Probe(scene.plain, build(scene.plain, JUDGE, **HARMONIC), whole=scene)
        by_shaft[side] = check_scene(scene, probe.body, probe)
        light.set_body(side, JUDGE, probe.solution(JUDGE).body)
    faults: list[str] = []
    facts = [*_facts(assembly, limit), *housing_facts(train)]
    facts += [line for contact in assembly.contacts.values() for line in wrench_lines(contact)]
    # those of the shafts stand with their guards
    cautions = [*assembly.cautions, *mesh_unit_slips(assembly), *_loss_cautions(train)]
    for pair in train.drivers:
        if isinstance(pair, PlanetMesh) and pair.mate == "ring":
            continue  # it has the table of the sun
        prefix = f"{pair.name}: " if pair.label else ""
        cautions += [prefix + line for line in _error_cautions(pair, limit)]
    try:
        facts += _system_facts(light, limit)
    except SolidgearError as error:
        faults.append(str(error))
    for side in train.shafts:
        cautions += _undriven_caution(light, side, limit)
    facts += [*unpublished_lines(train.unpublished()), ALONE]
    return {"facts": facts, "cautions": cautions, "faults": faults, **by_shaft} | {
        "verdicts": _worst_verdicts({side: by_shaft[side]["verdicts"] for side in train.shafts})
    }


def _facts(assembly: Assembly, limit: float) -> Iterator[str]:
    train = assembly.train
    for pair in train.pairs:
        contact, prefix = assembly.contacts[pair.name], f"{pair.name}: " if pair.label else ""
        levers = [1e3 * abs(vector.lever) for vector in (contact.pinion, contact.gear)]
        yield (
            f"{prefix}{pair.pinion.teeth} and {pair.gear.teeth} teeth, lever arms {levers[0]:.2f} and "
            f"{levers[1]:.2f} mm, mesh {contact.stiffness:.4g} N/m along "
            f"({', '.join(f'{v:.3f}' for v in contact.pinion.normal)}) on the {pair.shafts[0]}"
        )
        if (fit := fit_of(pair)) is not None:
            yield prefix + fit_line(fit)
        teeth = train.per_turn(pair)
        yield (
            f"{prefix}the {limit:g} Hz asked for is the mesh frequency at {60 * limit / teeth:.0f} "
            f"rpm of the {teeth.of}"
        )
    for stage in train.stages:
        mesh, teeth_of_stage = stage.table.mesh, stage.teeth
        yield (
            f"{stage.called}: {teeth_of_stage.sun}, {teeth_of_stage.planet} and "
            f"{teeth_of_stage.ring} teeth, {len(teeth_of_stage.azimuths)} planets, one turn of the {stage.shafts[1]} in {stage.ratio:.6g} of the "
            f"{stage.shafts[0]}; pins at {1e3 * teeth_of_stage.pin_radius:.6g} mm, meshes "
            f"{mesh.sun_stiffness:.4g} N/m with the sun and {mesh.ring_stiffness:.4g} N/m with the ring"
        )
    yield senses_sentence(senses(train, assembly.contacts))
    loss = train.losses
    yield (
        f"losses are loss factors, twice a damping ratio: shafts {loss.shafts:g}, bearings "
        f"{loss.bearings:g}, mesh {loss.mesh:g}, springs {loss.springs:g}"
    )


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


def _worst_verdicts(verdicts: dict[str, dict]) -> dict:
    """Return by model the worst of the verdicts on all shafts and the shafts that have it."""
    first, *further = verdicts.values()
    out = {}
    for model in first:
        if any(model not in verdicts_of_shaft for verdicts_of_shaft in further):
            continue
        by_side = {side: of_shaft[model]["verdict"] for side, of_shaft in verdicts.items()}
        worst = min(by_side.values(), key=WORST.index)
        sides = [side for side in by_side if by_side[side] == worst]
        out[model] = {"verdict": worst, "shafts": sides if worst != WORST[-1] else []}
    return out
