"""The housing of a train: a rigid or elastic part under the bearings, mounts, columns,
facts and cautions.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from solidgear.core import DOF_NAMES, System
from solidgear.core.reduction.port_matrices import PortMatrices
from solidgear.core.reduction.superelement import PortMotion
from solidgear.core.system.links import BearingSpring, Link, relative_motion
from solidgear.core.system.parts import Part, Placed, RigidBody
from solidgear.trains.file.housing import CENTRE, HOUSING, LOSS, TrainHousing
from solidgear.trains.file.planetary import Stage
from solidgear.trains.file.train import Train

#: port at its centre of mass
BOX = f"{HOUSING}.{CENTRE}"
#: names of its motions
MOTIONS = [f"along {x}" for x in "xyz"] + [f"about {x}" for x in "xyz"] + ["elastic"]
#: distance of a point from its bearing that gives a caution, m
ASTRAY = 1e-3


def housing_part(housing: TrainHousing) -> Part:
    """Return the housing as a part, in the axes of the train."""
    if housing.matrices is not None:
        return housing.matrices
    body = RigidBody(housing.mass_matrix, housing.places)
    return Placed(body, origin=np.array(housing.centre))


def mount_links(housing: TrainHousing) -> dict[str, Link]:
    """Return the springs of a housing to ground, each called ``mount NAME``."""
    return {
        f"mount {name}": BearingSpring(f"{HOUSING}.{housing.feet[name]}", np.array(mount.stiffness))
        for name, mount in housing.mounted.items()
    }


def housing_losses(housing: TrainHousing) -> dict[str, float]:
    """Return loss factors of mounts, and of an elastic housing."""
    mount_losses = {f"mount {name}": mount.loss for name, mount in housing.mounted.items()}
    if housing.matrices is None:
        return mount_losses
    return {HOUSING: LOSS if housing.loss is None else housing.loss, **mount_losses}


def housing_port(train: Train, side: str, station: str) -> str | None:
    """Return the port of the housing that a bearing stands in, or that a place of a shaft is held
    against; None where the bearings of the shaft stand on ground.
    """
    if train.housing is None or side not in train.housed:
        return None
    matrices, end = train.housing.matrices, f"{side}.{station}"
    # wherever a bearing stands, a rigid housing moves it by the motion of its centre of mass
    return BOX if matrices is None or end not in matrices.positions else f"{HOUSING}.{end}"


def ring_port(train: Train, stage: Stage) -> tuple[str, np.ndarray] | None:
    """Return the port of the housing that holds the ring of a stage, and the place, m; None for a
    ring on ground.
    """
    if (box := train.housing) is None or not {*stage.shafts} & {*train.housed}:
        return None
    if box.matrices is None:
        return BOX, np.array(box.centre)
    return f"{HOUSING}.{stage.ring_point}", box.matrices.positions[stage.ring_point]


def links_on_housing(train: Train, side: str, links: dict[str, Link]) -> dict[str, Link]:
    """Return the links of a shaft to ground, its bearings to the housing where they stand in it."""
    if side not in train.housed:
        return links
    return {
        name: replace(link, to=housing_port(train, side, link.at.removeprefix(f"{side}.")))
        if isinstance(link, BearingSpring)
        else link
        for name, link in links.items()
    }


def seat_motion(train: Train, system: System, side: str, station: str) -> np.ndarray:
    """Return the (6, N) motion of a bearing's inner ring, or of a place next to it, relative to the
    base.
    """
    port = housing_port(train, side, station)
    base = [system.port(port)] if port is not None else []
    return relative_motion(system.port(f"{side}.{station}"), *base)


def housing_motion(
    system: System, place: tuple[np.ndarray, np.ndarray], coordinates: np.ndarray
) -> np.ndarray:
    """Return the (6,) motion of the housing at the start of a shaft, without the rotation about it,
    in the axes of the shaft's scene, whose turn (3, 3) and origin (3,) in the axes of the train
    are `place`.
    """
    turn, origin = place
    start = PortMotion(np.zeros((6, system.size)), origin, turn)
    out = system.port(BOX).seen_from(start) @ coordinates
    return out * np.array([1, 1, 1, 1, 0, 1])


def mount_rows(train: Train, system: System) -> dict[str, np.ndarray]:
    """Return (6, N) rows of the load of the housing on every mount, by name."""
    if (box := train.housing) is None:
        return {}
    return {
        name: np.array(mount.stiffness) @ system.motion(f"{HOUSING}.{box.feet[name]}")
        for name, mount in box.mounted.items()
    }


def housing_energy(system: System, energy: np.ndarray, shapes: np.ndarray) -> dict[str, np.ndarray]:
    """Return the kinetic energy (k,) of the housing in every mode, under the kind of motion that
    most of it is; elastic where the mean motion has less than half of it.
    """
    rigid = rigid_mass(system.parts[HOUSING])
    motion = system.motion(BOX) @ shapes
    mean = (motion * (rigid @ motion)).sum(axis=0)
    kind = np.argmax(np.diag(rigid)[:, None] * motion**2, axis=0)
    kind = np.where(mean < energy / 2, len(MOTIONS) - 1, kind)
    return {f"{HOUSING} {name}": np.where(kind == k, energy, 0.0) for k, name in enumerate(MOTIONS)}


def rigid_mass(part: Part) -> np.ndarray:
    """Return the (6, 6) rigid mass of the housing about the centre of mass."""
    return part.rigid_mass if isinstance(part, PortMatrices) else part.mass


def housing_hz(housing: TrainHousing) -> np.ndarray:
    """Return (6,) frequencies of the housing on its mounts without the train, zero for a free
    motion.
    """
    modes = System({HOUSING: housing_part(housing)}, mount_links(housing)).modes(6)
    return modes.frequency_hz


def housing_facts(train: Train) -> Iterator[str]:
    """Yield the housing in sentences."""
    housing = train.housing
    if housing is None:
        return
    frequencies = ", ".join(f"{hz:.1f}" for hz in housing_hz(housing))
    kind = "a rigid housing"
    if (matrices := housing.matrices) is not None:
        kind = f"an elastic housing ({matrices.sentence})"
    yield (
        f"{kind} of {housing.mass:.4g} kg carries the bearings of {', '.join(train.housed)} on "
        f"{len(housing.mounts)} mounts; alone on them it has modes at {frequencies} Hz"
    )


def housing_cautions(
    train: Train, places: Mapping[str, tuple[np.ndarray, np.ndarray]]
) -> list[str]:
    """Return sentences on errors of a housing that are in no error bar, and on points of an elastic
    housing away from the bearings that stand in it.
    """
    if train.housing is None:
        return []
    if (matrices := train.housing.matrices) is None:
        return [
            "the housing is rigid: elastic walls and their modes are left out of numbers and "
            "error bars; give matrices for them"
        ]
    out = ["error bars and bounds leave out errors in the matrices of the housing"]
    out += [f"housing: {doubt}" for doubt in matrices.doubts]
    for side in train.housed:
        turn, origin = places[side]
        for bearing in train.shafts[side].scene.bearings:
            name = f"{side}.{bearing.name}"
            distance = np.linalg.norm(matrices.positions[name] - origin - turn[:, 1] * bearing.y)
            if distance > ASTRAY:
                out.append(
                    f"point {name!r} of the housing lies {1e3 * distance:.3g} mm from that bearing; "
                    "the distance is taken as rigid"
                )
    return out


def free_directions(system: System) -> list[str]:
    """Return the directions in which nothing holds the housing."""
    moved = np.abs(system.motion(BOX) @ system.free)
    return [name for name, size in zip(DOF_NAMES, moved.max(axis=1, initial=0.0)) if size > 1e-6]
