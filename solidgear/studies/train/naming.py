"""Names for the modes of a train: what moves, and how.

Kinetic energy is shared among the parts; what a shaft has goes to bending, axial motion and
torsion as the energies its rigid mass would have in the motions of its lumped point.  A mode is
called after the largest share, and counted: ``gear bending 2``.  Where no share has 40 % of the
whole, after the two largest: ``pinion axial + gear bending 1``.  All that a housing has goes to the
way in which most of it moves: ``housing along z 1``.

Modes with n >= 2 nodal diameters are called ``gear ovalising n=2``.  Their mean motion over any seat
is zero, so that no averaged port drives or feels them; a harmonic solid has them where a local mesh
does (:mod:`solidgear.studies.train.local`), a 3D solid always.
"""

from __future__ import annotations

import numpy as np

from solidgear.body import Body
from solidgear.frames import shift
from solidgear.scene.train_housing import HOUSING
from solidgear.solve.circumference import circumference_of
from solidgear.solve.families import FAMILIES
from solidgear.studies.train.housing import shares_of
from solidgear.studies.train.local import waves_of
from solidgear.studies.train.models import Workshop
from solidgear.system.modes import SystemModes
from solidgear.system.system import System

#: a share of the kinetic energy that names a mode alone
ALONE = 0.4
TRAIN = "train rotation"
#: ends of names of motions about an axis
TURNING = ("torsion", "rotational")
#: a shaft all of whose ports move with less than this of the energy of the mode does not move
#: there: cells around a ring let some 1e-6 through
UNDRIVEN = 1e-4
OVALISING = "ovalising"


def shares(workshop: Workshop, system: System, shapes: np.ndarray) -> dict[str, np.ndarray]:
    """Fractions of the kinetic energy of every mode, by part and kind of motion."""
    out: dict[str, np.ndarray] = {}
    momentum = system.mass @ shapes
    for stage in workshop.stages.values():
        out |= stage.kinetic(system, shapes)
    for part in system.parts:
        place = system.place(part)
        each = shapes[place] * momentum[place]
        own = np.maximum(each.sum(axis=0), 0.0)
        if part == HOUSING:
            out |= shares_of(system, own, shapes)
            continue
        if part not in workshop.scenes:  # bodies of planetary stages are told together
            out |= {f"{part} torsion": own} if part in workshop.train.rotors else {}
            continue
        for n, places in waves_of(system.parts[part]).items():
            out[f"{part} {OVALISING} n={n}"] = waving = np.maximum(each[places].sum(axis=0), 0.0)
            own = np.maximum(own - waving, 0.0)
        port = workshop.scenes[part].port
        model = workshop.shaft(part, workshop_rung(workshop, part))
        back = shift([0.0, -port.y, 0.0])
        mass = np.diag(back.T @ model.rigid_mass @ back)
        energy = mass[:, None] * (system.motion(f"{part}.{port.name}") @ shapes) ** 2
        whole = energy.sum(axis=0)
        still = _still(workshop, system, part, mass, own, shapes)
        around = _diameters(model.body, system, part, shapes, still)
        for n in sorted({*around[still]}):
            out[f"{part} {OVALISING} n={n}"] = np.where(still & (around == n), own, 0.0)
        for family, rows in FAMILIES.items():
            share = energy[list(rows)].sum(axis=0) / (whole + 1e-300)
            out[f"{part} {family}"] = np.where(still, 0.0, own * share)
    total = sum(out.values())
    return {name: value / total for name, value in out.items()}


def _still(workshop: Workshop, system: System, part: str, mass, own, shapes) -> np.ndarray:
    """Mask of the modes that move no port of a shaft by anything beside their own energy."""
    moved = np.zeros(shapes.shape[1])
    for station in workshop.scenes[part].stations:
        motion = system.motion(f"{part}.{station.name}") @ shapes
        moved = np.maximum(moved, mass @ motion**2)
    return (own > ALONE * _total(system, shapes)) & (moved < UNDRIVEN * own)


def _diameters(body: Body, system: System, part: str, shapes, still: np.ndarray) -> np.ndarray:
    """Nodal diameters of the modes of a 3D solid that move none of its ports; 2 where the mesh
    does not tell.
    """
    out = np.full(shapes.shape[1], 2)
    fitted = circumference_of(body)
    if fitted is None:
        return out
    fit, displacements = fitted
    for k in np.flatnonzero(still):
        _, share = fit(displacements(system.expand(part, shapes[:, k])))
        out[k] = max(2, int(share.sum(axis=1).argmax()))
    return out


def driven(system: System, found: SystemModes) -> np.ndarray:
    """(k,) whether each mode strains a link, the mesh or a bearing, by more than a trifle."""
    links = [found.energy[name] for name in system.links if name in found.energy]
    return (found.frequency_hz == 0) | (np.sum(links, axis=0) > UNDRIVEN)


def _total(system: System, shapes: np.ndarray) -> np.ndarray:
    return (shapes * (system.mass @ shapes)).sum(axis=0)


def workshop_rung(workshop: Workshop, side: str) -> str:
    """Any model that the shop has made of a shaft: rigid masses are all alike."""
    return next(rung for (own, rung) in workshop._made if own == side)


def mode_names(workshop: Workshop, system: System, found: SystemModes) -> list[str]:
    """One name a mode, none twice."""
    parts = shares(workshop, system, found.shapes)
    labels, table = list(parts), np.array(list(parts.values()))
    count: dict[str, int] = {}
    out = []
    for k, frequency in enumerate(found.frequency_hz):
        order = np.argsort(-table[:, k], kind="stable")
        if frequency == 0:
            turns = all(labels[i].endswith(TURNING) for i in order if table[i, k] > 1e-6)
            name = TRAIN if turns else "free motion"
        elif table[order[0], k] >= ALONE:
            name = labels[order[0]]
        else:
            name = f"{labels[order[0]]} + {labels[order[1]]}"
        count[name] = count.get(name, 0) + 1
        once = frequency == 0 and count[name] == 1
        out.append(name if once else f"{name} {count[name]}")
    return out
