"""Names for the modes of a train: the part that moves, and the motion.

Kinetic energy is shared among the parts; that of a shaft goes to bending, axial motion and
torsion as the energies of the rigid mass in the motions of the lumped point.  A mode is
called after the largest share, and counted: ``gear bending 2``.  Where no share has 40 % of the
whole, after the two largest: ``pinion axial + gear bending 1``.  All that a housing has goes to the
way in which most of it moves: ``housing along z 1``.

Modes with n >= 2 nodal diameters are called ``gear ovalising n=2``.  Their mean motion over any seat
is zero, so that no averaged port drives or feels them; a harmonic solid has them where a local mesh
does (:mod:`solidgear.trains.assembly.local`), a 3D solid always.
"""

from __future__ import annotations

import numpy as np

from solidgear.core import Body, System
from solidgear.core.frames import shift
from solidgear.core.solve.circumference import circumference_of
from solidgear.core.solve.families import FAMILIES
from solidgear.core.system.modes import SystemModes
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.housing import housing_energy
from solidgear.trains.assembly.local import waves_of
from solidgear.trains.file.housing import HOUSING

#: a share of the kinetic energy that names a mode alone
ALONE = 0.4
TRAIN = "train rotation"
#: ends of names of motions about an axis
TURNING = ("torsion", "rotational")
#: a shaft all of whose ports move with less than this of the energy of the mode does not move
#: there: cells around a ring let some 1e-6 through
UNDRIVEN = 1e-4
OVALISING = "ovalising"


def shares(assembly: Assembly, system: System, shapes: np.ndarray) -> dict[str, np.ndarray]:
    """Return fractions (k,) of the kinetic energy of every mode, by part and kind of motion."""
    by_motion: dict[str, np.ndarray] = {}
    momentum = system.mass @ shapes
    for stage in assembly.stages.values():
        by_motion |= stage.kinetic(system, shapes)
    for part in system.parts:
        place = system.place(part)
        products = shapes[place] * momentum[place]
        energy_of_part = np.maximum(products.sum(axis=0), 0.0)
        if part == HOUSING:
            by_motion |= housing_energy(system, energy_of_part, shapes)
            continue
        if part not in assembly.scenes:  # bodies of planetary stages are named together
            by_motion |= (
                {f"{part} torsion": energy_of_part} if part in assembly.train.rotors else {}
            )
            continue
        for n, places in waves_of(system.parts[part]).items():
            by_motion[f"{part} {OVALISING} n={n}"] = wave_energy = np.maximum(
                products[places].sum(axis=0), 0.0
            )
            energy_of_part = np.maximum(energy_of_part - wave_energy, 0.0)
        port = assembly.scenes[part].port
        # rigid masses of all models are equal
        built = next(model for side, model in assembly._models if side == part)
        model = assembly.shaft_model(part, built)
        to_port = shift([0.0, -port.y, 0.0])
        mass = np.diag(to_port.T @ model.rigid_mass @ to_port)
        energy = mass[:, None] * (system.motion(f"{part}.{port.name}") @ shapes) ** 2
        total_energy = energy.sum(axis=0)
        still = _still(assembly, system, part, mass, energy_of_part, shapes)
        diameters = _diameters(model.body, system, part, shapes, still)
        for n in sorted({*diameters[still]}):
            by_motion[f"{part} {OVALISING} n={n}"] = np.where(
                still & (diameters == n), energy_of_part, 0.0
            )
        for family, rows in FAMILIES.items():
            share = energy[list(rows)].sum(axis=0) / (total_energy + 1e-300)
            by_motion[f"{part} {family}"] = np.where(still, 0.0, energy_of_part * share)
    total = sum(by_motion.values())
    return {name: value / total for name, value in by_motion.items()}


def _still(
    assembly: Assembly, system: System, part: str, mass, energy_of_part, shapes
) -> np.ndarray:
    """Return a mask of the modes that move no port of a shaft by any notable part of the shaft's
    energy.
    """
    port_energy = np.zeros(shapes.shape[1])
    for station in assembly.scenes[part].stations:
        motion = system.motion(f"{part}.{station.name}") @ shapes
        port_energy = np.maximum(port_energy, mass @ motion**2)
    total = (shapes * (system.mass @ shapes)).sum(axis=0)
    return (energy_of_part > ALONE * total) & (port_energy < UNDRIVEN * energy_of_part)


def _diameters(body: Body, system: System, part: str, shapes, still: np.ndarray) -> np.ndarray:
    """Return the nodal diameters of the modes of a 3D solid that move no port; 2 where
    the mesh shows none.
    """
    out = np.full(shapes.shape[1], 2)
    fitted = circumference_of(body)
    if fitted is None:
        return out
    fit, displacements = fitted
    for k in np.flatnonzero(still):
        _, wave_shares = fit(displacements(system.expand(part, shapes[:, k])))
        out[k] = max(2, int(wave_shares.sum(axis=1).argmax()))
    return out


def driven(system: System, modes: SystemModes) -> np.ndarray:
    """Return (k,) whether each mode strains a link, a mesh or a bearing, by more than a trifle."""
    links = [modes.energy[name] for name in system.links if name in modes.energy]
    return (modes.frequency_hz == 0) | (np.sum(links, axis=0) > UNDRIVEN)


def mode_names(assembly: Assembly, system: System, modes: SystemModes) -> list[str]:
    """Return a name for each mode, each once."""
    parts = shares(assembly, system, modes.shapes)
    labels, table = list(parts), np.array(list(parts.values()))
    count: dict[str, int] = {}
    out = []
    for k, frequency in enumerate(modes.frequency_hz):
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
