"""Checks of a train, before anything large is solved: the guards of both shafts, and
what concerns the system.

Both shafts are looked at up to the frequency and to the tolerance that the train asks for; the
light solids that the guards solve are coupled as well, and tell what the reduction resolves.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.ladder import build
from solidgear.ladder.meshes import HARMONIC
from solidgear.machine.threads import pinned
from solidgear.scene import Scene
from solidgear.scene.gears import Pair
from solidgear.scene.planetary import PlanetMesh
from solidgear.scene.tooth_fit import fit_line, fit_of
from solidgear.scene.train import Train
from solidgear.studies.check import check_scene
from solidgear.studies.guards import Probe
from solidgear.studies.train.housing import facts_of
from solidgear.studies.train.layout import senses, senses_told
from solidgear.studies.train.local import undriven
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.modes import (
    RESOLVED,
    free_motions,
    refuse_unresolved,
    unpublished_lines,
    wrench_lines,
)
from solidgear.studies.train.shaft import JUDGE
from solidgear.studies.train.slips import slips_of_meshes

#: a loss factor below this gives peaks whose height is a matter of the loss alone
LITTLE_LOSS = 1e-3
ALONE = (
    "guards judge each shaft alone; which of them needs the solid for modes and mesh force, and from "
    "which frequency on, is what solidgear compare says of a train"
)
#: verdicts in the order in which the worst of two is chosen
WORST = ("will not hold", "uncertain", "holds with caution", "holds")


@pinned
def check_train(workshop: Workshop, max_frequency: float | None = None) -> dict:
    """Facts and cautions of a train, in sentences, those of both shafts, and what each model is
    worth for both.

    Parameters
    ----------
    workshop : Workshop
        Fresh, or with bodies that are there already.
    max_frequency : float, optional
        Hz; that of the file by default.

    Returns
    -------
    dict
        ``facts``, ``cautions``, ``faults`` (lists of sentences) of the system; ``pinion`` and
        ``gear`` as :func:`solidgear.studies.check.check_scene` gives them; ``verdicts`` by model:
        the worse of both shafts.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = check_train(Workshop(sg.load_train("geometry/axle_overhung.toml")))
    >>> found["pinion"]["verdicts"]["timoshenko"]["verdict"], found["faults"]
    ('will not hold', [])
    """
    train = workshop.train
    limit = max_frequency or train.ask.max_frequency
    out: dict = {}
    light = Workshop(train, workshop.reduction, workshop.kept)
    for side in train.shafts:
        scene = _asked(workshop.scenes[side], train, limit)
        probe = Probe(scene.plain, build(scene.plain, JUDGE, **HARMONIC), whole=scene)
        out[side] = check_scene(scene, probe.body, probe)
        light.take(side, JUDGE, probe.solution(JUDGE).body)
    faults: list[str] = []
    facts = [*_facts(workshop, limit), *facts_of(train)]
    facts += [line for met in workshop.contacts.values() for line in wrench_lines(met)]
    # those of the shafts are told with their guards
    cautions = [*workshop.cautions, *slips_of_meshes(workshop), *_losses(train)]
    for pair in train.drivers:
        if isinstance(pair, PlanetMesh) and pair.mate == "ring":
            continue  # it has the table of the sun
        of = f"{pair.name}: " if pair.label else ""
        cautions += [of + line for line in _error(pair, limit)]
    try:
        facts += _system(light, limit)
    except SolidgearError as error:
        faults.append(str(error))
    for side in train.shafts:
        cautions += _still(light, side, limit)
    facts += [*unpublished_lines(train.unpublished()), ALONE]
    return {"facts": facts, "cautions": cautions, "faults": faults, **out} | {
        "verdicts": _worse({side: out[side]["verdicts"] for side in train.shafts})
    }


def _asked(scene: Scene, train: Train, limit: float) -> Scene:
    """A shaft that is asked what the train is."""
    ask = scene.ask.with_changes(max_frequency=limit, tolerance=train.ask.tolerance)
    return scene.with_changes(ask=ask)


def _facts(workshop: Workshop, limit: float) -> Iterator[str]:
    train = workshop.train
    for pair in train.pairs:
        met, of = workshop.contacts[pair.name], f"{pair.name}: " if pair.label else ""
        levers = [1e3 * abs(vector.lever) for vector in (met.pinion, met.gear)]
        yield (
            f"{of}{pair.pinion.teeth} and {pair.gear.teeth} teeth, lever arms {levers[0]:.2f} and "
            f"{levers[1]:.2f} mm, mesh {met.stiffness:.4g} N/m along "
            f"({', '.join(f'{v:.3f}' for v in met.pinion.normal)}) on the {pair.shafts[0]}"
        )
        if (fit := fit_of(pair)) is not None:
            yield of + fit_line(fit)
        teeth = train.per_turn(pair)
        yield (
            f"{of}{limit:g} Hz are asked for: teeth mesh at them at {60 * limit / teeth:.0f} "
            f"rpm of the {teeth.of}"
        )
    for stage in train.stages:
        mesh, own = stage.table.mesh, stage.teeth
        yield (
            f"{stage.called}: {own.sun}, {own.planet} and {own.ring} teeth, {len(own.azimuths)} "
            f"planets, one turn of the {stage.shafts[1]} in {stage.ratio:.6g} of the "
            f"{stage.shafts[0]}; pins at {1e3 * own.pin_radius:.6g} mm, meshes "
            f"{mesh.sun_stiffness:.4g} N/m with the sun and {mesh.ring_stiffness:.4g} N/m with the ring"
        )
    yield senses_told(senses(train, workshop.contacts))
    loss = train.losses
    yield (
        "losses are read as loss factors, twice a damping ratio: "
        f"shafts {loss.shafts:g}, bearings {loss.bearings:g}, mesh {loss.mesh:g}, "
        f"springs {loss.springs:g}"
    )


def _losses(train: Train) -> Iterator[str]:
    loss = train.losses
    small = [
        f"{name} {value:g}"
        for name, value in loss.model_dump().items()
        if isinstance(value, float) and value < LITTLE_LOSS
    ]
    if small:
        yield (
            f"a loss factor is below {LITTLE_LOSS:g} ({', '.join(small)}): where such a part takes "
            "all the energy, the height of a peak is that number and nothing else"
        )


def _error(pair: Pair | PlanetMesh, limit: float) -> Iterator[str]:
    table = pair.mesh.transmission_error
    if table is None:
        return
    if table.frequency and table.frequency[-1] < limit:
        yield (
            f"the transmission error is given up to {table.frequency[-1]:g} Hz and is taken as "
            f"constant from there to the {limit:g} Hz asked for"
        )
    if not any((*table.orders, *table.amplitude)):
        yield "the transmission error is zero: there will be no response to it; drive by --force"


def _system(shop: Workshop, limit: float) -> Iterator[str]:
    """Of both light solids coupled."""
    system = shop.system(JUDGE)
    refuse_unresolved(shop, system, limit)
    omega, _ = system.elastic
    count = int((omega <= 2 * np.pi * limit).sum())
    found = system.modes(max(1, count))
    cut = float(np.sqrt(system.truncation.cut) / (2 * np.pi))
    worst = float(found.error_bound.max())
    word = "within" if worst < RESOLVED else "NOT within"
    yield (
        f"{count} elastic modes up to {limit:g} Hz on light solids; {shop.kept} modes a shaft "
        f"({shop.reduction}, the first left out at {cut:.0f} Hz) leave at most {worst:.0e} of a "
        f"frequency, {word} {RESOLVED:g}"
    )
    yield from free_motions(shop, system) or ("the whole train turns freely, at exactly 0 Hz",)


def _still(shop: Workshop, side: str, limit: float) -> Iterator[str]:
    """Modes of a light solid that averaged ports cannot drive."""
    pairs = [pair for pair in shop.train.pairs if side in pair.shafts]
    asked = {n for pair in pairs for n in pair.mesh.local_harmonics}
    found = undriven(shop.shaft(side, JUDGE).body, limit, tuple(asked))
    if found:
        told = ", ".join(f"n = {n} at {hz[0]:.0f} Hz" for n, hz in found.items())
        yield (
            f"the {side} has modes with nodal diameters below {limit:g} Hz ({told}) that are not "
            "driven by this mesh model; --local-harmonics shows what they add"
        )


def _worse(verdicts: dict[str, dict]) -> dict:
    """By model, the worst of the verdicts on all shafts and whose it is."""
    first, *others = verdicts.values()
    out = {}
    for model in first:
        if any(model not in other for other in others):
            continue
        each = {side: own[model]["verdict"] for side, own in verdicts.items()}
        worst = min(each.values(), key=WORST.index)
        sides = [side for side in each if each[side] == worst]
        out[model] = {"verdict": worst, "shafts": sides if worst != WORST[-1] else []}
    return out
