r"""Misalignment of a gear pair: how both gears lie to each other once shafts and bearings give.

Both gears are taken as rigid where they are attached to their shafts; the motion of one against the
other, without rotation about the axis, is four numbers.  They are linear in the motions of
the two lumped points, and given as rows on the coordinates of a system, so that the same rows serve
every model, every load and every error bar.

Bevel pairs, with unit vectors ``e_p``, ``e_g`` along the axes from the pitch apex to the back of
each gear and ``v = e_p x e_g / |e_p x e_g|``, the relative motion ``d = d_p - d_g`` at the
crossing point and the relative rotation ``t = t_p - t_g``::

    E      v . d                       offset of the axes
    P, G   d in the plane = P e_p - G e_g: each gear away from its apex along its own axis
    angle  - v . t                     growth of the shaft angle

(E, P, G and the shaft angle alpha of the Gleason contact pattern machines; Coleman, Gear Design
and Manufacturing, AGMA 229; signs are those of the formulas above, not of a machine.)

Parallel pairs, with e along the axes, n the line of action in the transverse plane: the slope of one
axis against the other, ``t x e``, in the plane of action, ``n . (t x e)``, and across it; and over
the face width b the equivalent misalignment ``f_sh = b n . (t x e) + w`` (ISO 6336-1, 7.5.2: component
of the equivalent misalignment by deformations of shafts).  Positive where the flanks open towards
larger y of the pinion's scene.

Planets mesh so with sun and ring, each by itself; a ring that is part of the ground stands still.

The wind-up w is that of both gears within their face, for the load of the teeth leaves its torque
along it.  A load that is even winds a gear up by ``int T(s) / (G J) ds``, with the torque T growing
from nothing at the end far from where it enters the shaft, ``T b / (2 G J)`` of an even section; the
flank at the far end stands back by as much times the lever.  The torque is that of all meshes of the
gear together, so that an idler has none, and a sun has that of all planets.  A gear that is a rigid
mass, or on a rigid shaft, has none.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import pi, sin

import numpy as np

from solidgear.core import System
from solidgear.core.frames import cross_matrix
from solidgear.core.reduction.superelement import PortMotion
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.mesh_place import MeshPlace, place_of_pair, place_of_planet
from solidgear.trains.assembly.stages import mesh_row
from solidgear.trains.file.gears import Member
from solidgear.trains.file.mesh_teeth import wheels_of
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh
from solidgear.trains.file.train import Train

#: axes whose angle has a sine below this are parallel
PARALLEL = 1e-6
#: names of the numbers of each kind of pair
BEVEL, PARALLELS = ("E", "P", "G", "shaft angle"), ("in plane", "across", "wind-up", "f_sh")
#: slices of a face for its wind-up
SLICES = 40


@dataclass(frozen=True, eq=False)
class Measure:
    """A number that describes how two gears lie to each other."""

    name: str
    unit: str  #: ``m moved`` or ``rad moved``
    meaning: str  #: in a few words
    row: np.ndarray  #: (N,) on the coordinates of a system
    mesh: str = ""  #: where there are several: its name at the end of `name`
    face: float | None = None  #: width that a meaning over the face is of, m


def measured_names(train: Train) -> tuple[str, ...]:
    """Return the names of the numbers of :func:`misalignment` for a train.

    Examples
    --------
    >>> import solidgear as sg
    >>> measured_names(sg.load_train("geometry/gearbox_train.toml"))
    ('in plane', 'across', 'wind-up', 'f_sh')
    """
    return tuple(f"{name}{mesh.label}" for mesh in meshes_of(train) for name in _names(mesh))


def meshes_of(train: Train) -> tuple[Pair | PlanetMesh, ...]:
    """Return the meshes whose gears can lie askew: those of pairs, and of each planet."""
    return (*train.pairs, *(mesh for stage in train.stages for mesh in stage.meshes))


def _names(mesh: Pair | PlanetMesh) -> tuple[str, ...]:
    if isinstance(mesh, Pair) and abs(sin(mesh.mesh.shaft_angle)) >= PARALLEL:
        return BEVEL
    return PARALLELS if face_of(mesh) else PARALLELS[:-2]


def face_of(mesh: Pair | PlanetMesh) -> float | None:
    """Return the width of the face that two gears share, m; None where it is not given."""
    if isinstance(mesh, PlanetMesh):
        return mesh.stage.sun.face_width
    widths = [gear.face_width for gear in mesh.members.values() if gear.face_width is not None]
    return min(widths, default=None)


def misalignment(assembly: Assembly, system: System) -> list[Measure]:
    """Return the misalignment of the gears of a train, mesh by mesh: of bevel pairs E, P, G and the
    shaft angle, of parallel ones the slopes in and across the plane of action and, with a known
    face width, f_sh.

    Examples
    --------
    >>> import solidgear as sg
    >>> assembly = Assembly(sg.load_train("geometry/axle_straddle.toml"))
    >>> [m.name for m in misalignment(assembly, assembly.system("euler", "euler"))]
    ['E', 'P', 'G', 'shaft angle']
    """
    out = []
    torques = _Torques(assembly, system)
    for mesh in meshes_of(assembly.train):
        if _names(mesh) == BEVEL:
            assert isinstance(mesh, Pair)
            measures = _bevel(system, mesh)
        else:
            measures = _parallel(system, torques, torques.places[mesh.name], face_of(mesh))
        out += [
            replace(measure, name=f"{measure.name}{mesh.label}", mesh=mesh.label)
            for measure in measures
        ]
    return out


def _from_apex(member: Member, port: PortMotion) -> np.ndarray:
    """Return the direction of a gear's axis away from its pitch apex, in the axes of the system."""
    sign = 1.0 if member.apex == "start" else -1.0
    return sign * port.axes[:, 1]


def _carried_motion(port: PortMotion, point: np.ndarray) -> np.ndarray:
    """Return the (6, N) motion of a port carried rigidly to a point, in the axes of the system."""
    return port.seen_from(PortMotion(port.rows, point, np.eye(3)))


def _nearest(ports: list[PortMotion], along: list[np.ndarray]) -> list[np.ndarray]:
    """Return the points of both axes that are nearest to each other: one point where they cross."""
    pinion, gear = ports
    steps = np.column_stack([along[0], -along[1]])
    t, *_ = np.linalg.lstsq(steps, gear.point - pinion.point, rcond=None)
    return [pinion.point + t[0] * along[0], gear.point + t[1] * along[1]]


def _bevel(system: System, pair: Pair) -> list[Measure]:
    ports = [system.port(f"{side}.{port}") for side, port in zip(pair.shafts, pair.ports)]
    along = [_from_apex(member, port) for member, port in zip(pair.members.values(), ports)]
    pinion, gear = (
        _carried_motion(port, point) for port, point in zip(ports, _nearest(ports, along))
    )
    moved, turned = pinion[:3] - gear[:3], pinion[3:] - gear[3:]
    across = np.cross(along[0], along[1])
    across = across / np.linalg.norm(across)
    axial = np.linalg.pinv(np.column_stack([along[0], -along[1]])) @ moved
    offset, along_pinion, along_gear, angle = BEVEL
    return [
        Measure(offset, "m moved", "offset of the axes", across @ moved),
        Measure(along_pinion, "m moved", "pinion along its axis, away from the apex", axial[0]),
        Measure(along_gear, "m moved", "gear along its axis, away from the apex", axial[1]),
        Measure(angle, "rad moved", "growth of the angle of the axes", -across @ turned),
    ]


def _parallel(
    system: System, torques: _Torques, place: MeshPlace, width: float | None
) -> list[Measure]:
    axis, normal = place.axis, place.normal - (place.normal @ place.axis) * place.axis
    normal = normal / np.linalg.norm(normal)
    first, second = (
        np.zeros(system.size)
        if end is None
        else _carried_motion(system.port(end), place.pitch_point)[3:]
        for end in place.ends
    )
    slope = -cross_matrix(axis) @ (first - second)
    in_plane, across, wind_up, skew = PARALLELS
    out = [
        Measure(in_plane, "rad moved", "slope of the axes in the plane of action", normal @ slope),
        Measure(across, "rad moved", "slope across it", np.cross(axis, normal) @ slope),
    ]
    if width:
        wound = torques.wind_up(place, width)
        meaning = "equivalent misalignment over the face, in the plane of action, wind-up included"
        out += [
            Measure(wind_up, "m moved", "of both gears within their face", wound, face=width),
            Measure(skew, "m moved", meaning, width * out[0].row + wound, face=width),
        ]
    return out


@dataclass(frozen=True, eq=False)
class _Torques:
    """Torques of the teeth on every gear, and how they wind up its face."""

    assembly: Assembly
    system: System

    @cached_property
    def places(self) -> dict[str, MeshPlace]:
        """Places of all meshes with parallel axes, by name."""
        meshes = [mesh for mesh in meshes_of(self.assembly.train) if _names(mesh) != BEVEL]
        return {mesh.name: self._place(mesh) for mesh in meshes}

    def _place(self, mesh: Pair | PlanetMesh) -> MeshPlace:
        if isinstance(mesh, Pair):
            return place_of_pair(self.assembly, self.system, mesh)
        teeth = wheels_of(mesh)
        assert teeth is not None  # a stage is refused without a module
        return place_of_planet(self.assembly, self.system, mesh, teeth)

    @cached_property
    def rows(self) -> dict[str, np.ndarray]:
        """Rows (N,) of the torque about y of all teeth on every gear, N m, by end."""
        torque: dict[str, np.ndarray] = {}
        for place in self.places.values():
            loads = place.load(self.system)
            opening = np.sum([self.system.motion(end).T @ load for end, load in loads], axis=0)
            _, stiffness = mesh_row(self.system, place.link)
            for end, load in loads:
                torque[end] = torque.get(end, 0.0) - stiffness * load[4] * opening
        return torque

    def wind_up(self, place: MeshPlace, width: float) -> np.ndarray:
        """Return the row (N,) by which flanks open over the face towards larger y of the first gear's
        scene, by the wind-up of both gears.
        """
        opening = np.zeros(self.system.size)
        transverse = np.linalg.norm(place.normal - (place.normal @ place.axis) * place.axis)
        for end, load in place.load(self.system):
            side, _, port = end.partition(".")
            if side not in self.assembly.train.shafts or self._is_rigid(side, port):
                continue
            away, twist = _wind_up(self.assembly, side, port, width)
            way = float(np.sign(self.system.port(end).axes[:, 1] @ place.axis))
            opening += load[4] / transverse * twist * away * way * self.rows[end]
        return opening

    def _is_rigid(self, side: str, port: str) -> bool:
        gear = self.assembly.train.shafts[side].gears[port]
        return gear.head is not None or not len(self.system.parts[side].strain)


def _wind_up(assembly: Assembly, side: str, port: str, width: float) -> tuple[float, float]:
    """Return the sense along y in which a gear is far from where its torque enters the shaft, and its
    wind-up over the face per torque, rad/(N m).
    """
    scene = assembly.scenes[side]
    gear = assembly.train.shafts[side].gears[port]
    places = {station.name: station.y for station in scene.stations}
    middle = places[port] + gear.face_offset
    entry = assembly.train.torque_entry(side, port)
    away = 1.0 if entry is None or middle >= places[entry] else -1.0
    share = (np.arange(SLICES) + 0.5) / SLICES  # of the torque, from the far end
    twist = 0.0
    for part in share:
        y = float(np.clip(middle + away * width * (0.5 - part), 0.0, scene.length))
        segment = scene.segments_at(y)[0]
        inner, outer = segment.radius_at(y)
        shear = segment.material.E / (2 * (1 + segment.material.nu))
        twist += part * width / SLICES / (shear * pi * (outer**4 - inner**4) / 2)
    return away, twist
