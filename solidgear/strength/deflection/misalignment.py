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

The wind-up w is that of both gears within their face, for the load of the teeth leaves its torque
along it.  A load that is even winds a gear up by ``int T(s) / (G J) ds``, with the torque T growing
from nothing at the end far from where it enters the shaft, ``T b / (2 G J)`` of an even section; the
flank at the far end stands back by as much times the lever.  A gear that is a rigid mass, or on a
rigid shaft, has none.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi, sin

import numpy as np

from solidgear.core import System
from solidgear.core.frames import cross_matrix
from solidgear.core.reduction.superelement import PortMotion
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.stages import mesh_row
from solidgear.trains.file.gears import Member
from solidgear.trains.file.pairs import Pair
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
    return tuple(f"{name}{pair.label}" for pair in train.pairs for name in _names(pair))


def _names(pair: Pair) -> tuple[str, ...]:
    if abs(sin(pair.mesh.shaft_angle)) >= PARALLEL:
        return BEVEL
    return PARALLELS if any(_widths(pair)) else PARALLELS[:-2]


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
    for pair in assembly.train.pairs:
        ports = [system.port(f"{side}.{port}") for side, port in zip(pair.shafts, pair.ports)]
        along = [_from_apex(member, port) for member, port in zip(pair.members.values(), ports)]
        if np.linalg.norm(np.cross(along[0], along[1])) < PARALLEL:
            measures = _parallel(assembly, system, pair, ports)
        else:
            measures = _bevel(ports, along)
        out += [
            replace(measure, name=f"{measure.name}{pair.label}", mesh=pair.label)
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


def _bevel(ports: list[PortMotion], along: list[np.ndarray]) -> list[Measure]:
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
    assembly: Assembly, system: System, pair: Pair, ports: list[PortMotion]
) -> list[Measure]:
    axis = ports[0].axes[:, 1]
    normal = ports[0].axes @ (assembly.contacts[pair.name].pinion.normal * [1.0, 0.0, 1.0])
    normal = normal / np.linalg.norm(normal)
    pinion, gear = (_carried_motion(port, ports[0].point) for port in ports)
    slope = -cross_matrix(axis) @ (pinion[3:] - gear[3:])
    in_plane, across, wind_up, skew = PARALLELS
    out = [
        Measure(in_plane, "rad moved", "slope of the axes in the plane of action", normal @ slope),
        Measure(across, "rad moved", "slope across it", np.cross(axis, normal) @ slope),
    ]
    widths = [width for width in _widths(pair) if width is not None]
    if widths:
        width = min(widths)
        row, stiffness = mesh_row(system, pair.name)
        # the force of the teeth presses the row together
        wound = -stiffness * _opening_by_wind_up(assembly, system, pair, width) * row
        meaning = "equivalent misalignment over the face, in the plane of action, wind-up included"
        out += [
            Measure(wind_up, "m moved", "of both gears within their face", wound, face=width),
            Measure(skew, "m moved", meaning, width * out[0].row + wound, face=width),
        ]
    return out


def _opening_by_wind_up(assembly: Assembly, system: System, pair: Pair, width: float) -> float:
    """Return by how much flanks open over the face towards larger y of the pinion's scene, per force of
    the teeth, by the wind-up of both gears, m/N.
    """
    contact, opening = assembly.contacts[pair.name], 0.0
    axes = [assembly.places[side][0][:, 1] for side in pair.shafts]
    for k, (side, port) in enumerate(zip(pair.shafts, pair.ports)):
        member = (pair.pinion, pair.gear)[k]
        if member.head is not None or not len(system.parts[side].strain):  # rigid
            continue
        vector = (contact.pinion, contact.gear)[k]
        away, twist = _wind_up(assembly, side, port, width)
        transverse = vector.lever / np.hypot(vector.normal[0], vector.normal[2])
        turned = vector.lever * twist * away * float(np.sign(axes[k] @ axes[0]))
        opening += transverse * turned
    return opening


def _wind_up(assembly: Assembly, side: str, port: str, width: float) -> tuple[float, float]:
    """Return the sense along y in which a gear is far from where its torque enters the shaft, and its
    wind-up over the face per torque, rad/(N m).
    """
    train, scene = assembly.train, assembly.scenes[side]
    gear = train.shafts[side].gears[port]
    places = {station.name: station.y for station in scene.stations}
    middle = places[port] + gear.face_offset
    rotors = [places[train.spring_port(name)] for name in train.rotors_of(side)]
    further = [places[name] for name in train.shafts[side].gears if name != port]
    entry = next(iter([*rotors, *further]), middle - width)
    away = 1.0 if middle >= entry else -1.0
    share = (np.arange(SLICES) + 0.5) / SLICES  # of the torque, from the far end
    twist = 0.0
    for part in share:
        y = float(np.clip(middle + away * width * (0.5 - part), 0.0, scene.length))
        segment = next(s for s in scene.segments if s.y0 <= y <= s.y1)
        inner, outer = segment.radius_at(y)
        shear = segment.material.E / (2 * (1 + segment.material.nu))
        twist += part * width / SLICES / (shear * pi * (outer**4 - inner**4) / 2)
    return away, twist


def _widths(pair: Pair) -> list[float | None]:
    return [member.face_width for member in pair.members.values()]
