"""The housing of a train: a rigid part under its bearings, mounts, and what both tell."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from solidgear.frames import DOF_NAMES
from solidgear.reduction.superelement import PortMotion
from solidgear.scene.housing_matrices import HousingMatrices
from solidgear.scene.planetary import Stage
from solidgear.scene.train import Train
from solidgear.scene.train_housing import CENTRE, HOUSING, LOSS, TrainHousing
from solidgear.studies.train.components import FORCE_UNITS, MOTION_UNITS, six
from solidgear.system.links import BearingSpring, Link, relative_motion
from solidgear.system.parts import Part, Placed, RigidBody
from solidgear.system.system import System

if TYPE_CHECKING:
    from solidgear.studies.train.respond import Drive

#: port at its centre of mass
BOX = f"{HOUSING}.{CENTRE}"
#: names of its motions
WAYS = [f"along {x}" for x in "xyz"] + [f"about {x}" for x in "xyz"] + ["elastic"]
ACCELERATION = "m/s²"
#: distance of a point from its bearing that is told, m
ASTRAY = 1e-3


@dataclass(frozen=True, eq=False)
class ElasticHousing:
    """A part of the motions of points and of modes."""

    matrices: HousingMatrices

    @property
    def mass(self) -> np.ndarray:
        """(n, n)."""
        return self.matrices.mass

    @property
    def strain(self) -> np.ndarray:
        """(n - 6, n)."""
        return self.matrices.elastic[1]

    @property
    def ports(self) -> Mapping[str, PortMotion]:
        """Its points, and the mean motion of all of it at the centre of mass."""
        own, axes = self.matrices, np.eye(3)
        rows = np.eye(len(own.mass))
        points = {
            name: PortMotion(rows[6 * k : 6 * k + 6], place, axes)
            for k, (name, place) in enumerate(own.positions.items())
        }
        return {CENTRE: PortMotion(own.mean, own.centre, axes), **points}


def part_of(housing: TrainHousing) -> Part:
    """The housing as a part, in the axes of the train."""
    if housing.matrices is not None:
        return ElasticHousing(housing.matrices)
    body = RigidBody(housing.mass_matrix, housing.places)
    return Placed(body, origin=np.array(housing.centre))


def mounts_of(housing: TrainHousing) -> dict[str, Link]:
    """Its springs to ground, each called ``mount NAME``."""
    return {
        f"mount {name}": BearingSpring(f"{HOUSING}.{housing.feet[name]}", np.array(mount.stiffness))
        for name, mount in housing.mounted.items()
    }


def losses_of(housing: TrainHousing) -> dict[str, float]:
    """Loss factors of mounts, and of an elastic housing."""
    own = {f"mount {name}": mount.loss for name, mount in housing.mounted.items()}
    if housing.matrices is None:
        return own
    return {HOUSING: LOSS if housing.loss is None else housing.loss, **own}


def under(train: Train, side: str, station: str) -> str | None:
    """Port of the housing that a bearing stands in, or that a place of a shaft is held against; None
    where the bearings of the shaft stand on ground.
    """
    if train.housing is None or side not in train.housed:
        return None
    own, end = train.housing.matrices, f"{side}.{station}"
    # wherever a bearing stands, a rigid housing moves it by the motion of its centre of mass
    return BOX if own is None or end not in own.positions else f"{HOUSING}.{end}"


def ring_in(train: Train, stage: Stage) -> tuple[str, np.ndarray] | None:
    """Port of the housing that holds the ring of a stage, and its place, m; None of one on ground."""
    if (box := train.housing) is None or not {*stage.shafts} & {*train.housed}:
        return None
    if box.matrices is None:
        return BOX, np.array(box.centre)
    return f"{HOUSING}.{stage.ring_point}", box.matrices.positions[stage.ring_point]


def standing_in(train: Train, side: str, links: dict[str, Link]) -> dict[str, Link]:
    """Links of a shaft to ground, its bearings to the housing where they stand in it."""
    if side not in train.housed:
        return links
    return {
        name: replace(link, to=under(train, side, link.at.removeprefix(f"{side}.")))
        if isinstance(link, BearingSpring)
        else link
        for name, link in links.items()
    }


def seat_motion(train: Train, system: System, side: str, station: str) -> np.ndarray:
    """(6, N) motion of a bearing's inner ring, or of a place beside, against what it stands in."""
    below = under(train, side, station)
    around = [system.port(below)] if below is not None else []
    return relative_motion(system.port(f"{side}.{station}"), *around)


def carried_by(
    system: System, place: tuple[np.ndarray, np.ndarray], coordinates: np.ndarray
) -> np.ndarray:
    """(6,) motion of the housing at the start of a shaft, in the axes of the shaft's scene, without
    the rotation about it.

    Parameters
    ----------
    place : ((3, 3) ndarray, (3,) ndarray)
        Turn and origin of that scene in the axes of the train.
    """
    turn, origin = place
    start = PortMotion(np.zeros((6, system.size)), origin, turn)
    out = system.port(BOX).seen_from(start) @ coordinates
    return out * np.array([1, 1, 1, 1, 0, 1])


def mount_rows(train: Train, system: System) -> dict[str, np.ndarray]:
    """(6, N) rows of the load of the housing on every mount, by its name."""
    if (box := train.housing) is None:
        return {}
    return {
        name: np.array(mount.stiffness) @ system.motion(f"{HOUSING}.{box.feet[name]}")
        for name, mount in box.mounted.items()
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
    places = train.housing.free_points
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
    """Kinetic energy of the housing in every mode, under the way in which most of it moves; elastic
    where that of its mean motion is less than half of it.

    Parameters
    ----------
    own : (k,) ndarray
        Its kinetic energy.
    shapes : (N, k) ndarray
    """
    rigid = rigid_mass(system.parts[HOUSING])
    moved = system.motion(BOX) @ shapes
    mean = (moved * (rigid @ moved)).sum(axis=0)
    way = np.argmax(np.diag(rigid)[:, None] * moved**2, axis=0)
    way = np.where(mean < own / 2, len(WAYS) - 1, way)
    return {f"{HOUSING} {name}": np.where(way == k, own, 0.0) for k, name in enumerate(WAYS)}


def rigid_mass(part: Part) -> np.ndarray:
    """(6, 6) of the housing about its centre of mass."""
    return part.matrices.rigid_mass if isinstance(part, ElasticHousing) else part.mass


def alone_hz(housing: TrainHousing) -> np.ndarray:
    """(6,) frequencies of the housing on its mounts without the train, zero for a free motion."""
    found = System({HOUSING: part_of(housing)}, mounts_of(housing)).modes(6)
    return found.frequency_hz


def facts_of(train: Train) -> Iterator[str]:
    """The housing in sentences."""
    housing = train.housing
    if housing is None:
        return
    alone = ", ".join(f"{hz:.1f}" for hz in alone_hz(housing))
    kind = "a rigid housing"
    if (own := housing.matrices) is not None:
        first = own.elastic[0][0] / (2 * np.pi)
        kind = f"an elastic housing (free, its first mode is at {first:.1f} Hz)"
    yield (
        f"{kind} of {housing.mass:.4g} kg carries the bearings of {', '.join(train.housed)} on "
        f"{len(housing.mounts)} mounts; alone on them it has modes at {alone} Hz"
    )


def cautions_of(train: Train, places: Mapping[str, tuple[np.ndarray, np.ndarray]]) -> list[str]:
    """Sentences on what no bar says of a housing, and on points of an elastic one that are not where
    the bearings in it stand.

    Parameters
    ----------
    places : mapping of str to ((3, 3) ndarray, (3,) ndarray)
        Turn and origin of every shaft's scene in the axes of the train.
    """
    if train.housing is None:
        return []
    if (own := train.housing.matrices) is None:
        return [
            "the housing is rigid: what its walls give, and their modes, are in no number and in no "
            "bar; matrices of it tell both"
        ]
    out = ["what the matrices of the housing leave out is in no bar and in no bound"]
    for side in train.housed:
        turn, origin = places[side]
        for bearing in train.shafts[side].scene.bearings:
            name = f"{side}.{bearing.name}"
            off = np.linalg.norm(own.positions[name] - origin - turn[:, 1] * bearing.y)
            if off > ASTRAY:
                out.append(
                    f"point {name!r} of the housing lies {1e3 * off:.3g} mm from that bearing, which "
                    "it is taken to carry over that distance rigidly"
                )
    return out


def loose_ways(system: System) -> list[str]:
    """Motions in which nothing holds the housing."""
    moved = np.abs(system.motion(BOX) @ system.free)
    return [name for name, size in zip(DOF_NAMES, moved.max(axis=1, initial=0.0)) if size > 1e-6]
