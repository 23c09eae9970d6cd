"""The housing of a train: a rigid part under its bearings, mounts, and what both tell."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from solidgear.frames import DOF_NAMES
from solidgear.scene.train import Train
from solidgear.scene.train_housing import CENTRE, HOUSING, TrainHousing
from solidgear.studies.train.components import FORCE_UNITS, MOTION_UNITS, six
from solidgear.system.links import BearingSpring, Link, apart
from solidgear.system.parts import Part, Placed, RigidBody
from solidgear.system.system import System

if TYPE_CHECKING:
    from solidgear.studies.train.respond import Drive

#: port of the housing that its bearings stand in, wherever they are: it is rigid
BOX = f"{HOUSING}.{CENTRE}"
WAYS = [f"along {x}" for x in "xyz"] + [f"about {x}" for x in "xyz"]
ACCELERATION = "m/s²"


def part_of(housing: TrainHousing) -> Part:
    """The housing as a part, in the axes of the train."""
    body = RigidBody(housing.mass_matrix, housing.places)
    return Placed(body, origin=np.array(housing.centre))


def mounts_of(housing: TrainHousing) -> dict[str, Link]:
    """Its springs to ground, each called ``mount NAME``."""
    return {
        f"mount {name}": BearingSpring(f"{HOUSING}.{name}", np.array(mount.stiffness))
        for name, mount in housing.mounted.items()
    }


def standing_in(train: Train, side: str, links: dict[str, Link]) -> dict[str, Link]:
    """Links of a shaft to ground, its bearings to the housing where they stand in it."""
    if side not in train.housed:
        return links
    return {
        name: replace(link, to=BOX) if isinstance(link, BearingSpring) else link
        for name, link in links.items()
    }


def seat_motion(train: Train, system: System, side: str, bearing: str) -> np.ndarray:
    """(6, N) motion of a bearing's inner ring against what it stands in."""
    around = [system.port(BOX)] if side in train.housed else []
    return apart(system.port(f"{side}.{bearing}"), *around)


def mount_rows(train: Train, system: System) -> dict[str, np.ndarray]:
    """(6, N) rows of the load of the housing on every mount, by its name."""
    mounted = train.housing.mounted.items() if train.housing else ()
    return {
        name: np.array(mount.stiffness) @ system.motion(f"{HOUSING}.{name}")
        for name, mount in mounted
    }


def columns_of(drive: Drive, frequency_hz: np.ndarray) -> dict[str, np.ndarray]:
    """Amplitudes of the housing over frequency, by name and unit: loads on every mount, motions of its
    centre of mass and of its named points, and their accelerations; none without a housing.  Those
    of all three directions together are the root of the sum of squares of their amplitudes.
    """
    train, system = drive.workshop.train, drive.system
    out: dict[str, np.ndarray] = {}
    if train.housing is None:
        return out
    loads = mount_rows(train, system)
    places = [CENTRE, *train.housing.points]
    rows = [*loads.values(), *(system.motion(f"{HOUSING}.{place}") for place in places)]
    found = np.split(drive.motion(frequency_hz, np.vstack(rows)), len(rows), axis=1)
    for name, load in zip(loads, found):
        factor = drive.steady.factor(f"mount {name}", frequency_hz)
        force = load * factor[:, None]
        out[f"mount {name} force [N]"] = _together(force)
        out |= six(f"mount {name}", FORCE_UNITS, force)
    square = -((2 * np.pi * frequency_hz[:, None]) ** 2)
    for place, motion in zip(places, found[len(loads) :]):
        name, moved = f"{HOUSING} {place}", square * motion
        out[f"{name} acceleration [{ACCELERATION}]"] = _together(moved)
        out |= {
            f"{name} acceleration {dof} [{ACCELERATION}]": moved[:, k]
            for k, dof in enumerate(DOF_NAMES[:3])
        }
        out |= six(name, MOTION_UNITS, motion)
    return out


def felt(drive: Drive, frequency_hz: np.ndarray) -> list[np.ndarray]:
    """Columns (f,) of what mounts and points of the housing feel in all three directions together."""
    found = columns_of(drive, frequency_hz)
    return [found[name] for name in found if " force [" in name or " acceleration [" in name]


def _together(values: np.ndarray) -> np.ndarray:
    """(f,) size of the first three components."""
    return np.linalg.norm(values[:, :3], axis=1).astype(complex)


def shares_of(system: System, own: np.ndarray, shapes: np.ndarray) -> dict[str, np.ndarray]:
    """Kinetic energy of the housing in every mode, under the way in which most of it moves.

    Parameters
    ----------
    own : (k,) ndarray
        Its kinetic energy.
    shapes : (N, k) ndarray
    """
    mass = np.diag(system.parts[HOUSING].mass)
    way = np.argmax(mass[:, None] * (system.motion(BOX) @ shapes) ** 2, axis=0)
    return {f"{HOUSING} {name}": np.where(way == k, own, 0.0) for k, name in enumerate(WAYS)}


def alone_hz(housing: TrainHousing) -> np.ndarray:
    """(6,) frequencies of the housing on its mounts without the train, zero for a free motion."""
    found = System({HOUSING: part_of(housing)}, mounts_of(housing)).modes(6)
    return found.frequency_hz


def facts_of(train: Train) -> Iterator[str]:
    """The housing in sentences."""
    housing = train.housing
    if housing is None:
        return
    hz = alone_hz(housing)
    told = ", ".join(f"{one:.1f}" for one in hz)
    yield (
        f"a rigid housing of {housing.mass:g} kg carries the bearings of {', '.join(train.housed)} on "
        f"{len(housing.mounts)} mounts; alone on them it has its modes at {told} Hz"
    )


def loose_ways(system: System) -> list[str]:
    """Motions in which nothing holds the housing."""
    moved = np.abs(system.motion(BOX) @ system.free)
    return [name for name, size in zip(DOF_NAMES, moved.max(axis=1, initial=0.0)) if size > 1e-6]
