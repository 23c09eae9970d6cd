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
the face width b the equivalent misalignment ``f_sh = b n . (t x e)`` (ISO 6336-1, 7.5.2: component
of the equivalent misalignment by deformations of shafts).  Positive where the flanks open towards
larger y of the pinion's scene.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import sin

import numpy as np

from solidgear.core import System
from solidgear.core.frames import cross_matrix
from solidgear.core.reduction.superelement import PortMotion
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.gears import Member
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.train import Train

#: axes whose angle has a sine below this are parallel
PARALLEL = 1e-6
#: names of the numbers of each kind of pair
BEVEL, PARALLELS = ("E", "P", "G", "shaft angle"), ("in plane", "across", "f_sh")


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
    ('in plane', 'across', 'f_sh')
    """
    return tuple(f"{name}{pair.label}" for pair in train.pairs for name in _names(pair))


def _names(pair: Pair) -> tuple[str, ...]:
    if abs(sin(pair.mesh.shaft_angle)) >= PARALLEL:
        return BEVEL
    return PARALLELS if any(_widths(pair)) else PARALLELS[:-1]


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
            measures = _parallel(assembly, pair, ports)
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


def _parallel(assembly: Assembly, pair: Pair, ports: list[PortMotion]) -> list[Measure]:
    axis = ports[0].axes[:, 1]
    normal = ports[0].axes @ (assembly.contacts[pair.name].pinion.normal * [1.0, 0.0, 1.0])
    normal = normal / np.linalg.norm(normal)
    pinion, gear = (_carried_motion(port, ports[0].point) for port in ports)
    slope = -cross_matrix(axis) @ (pinion[3:] - gear[3:])
    in_plane, across, shear = PARALLELS
    out = [
        Measure(in_plane, "rad moved", "slope of the axes in the plane of action", normal @ slope),
        Measure(across, "rad moved", "slope across it", np.cross(axis, normal) @ slope),
    ]
    widths = [width for width in _widths(pair) if width is not None]
    if widths:
        meaning = "equivalent misalignment over the face, in the plane of action"
        row = min(widths) * out[0].row
        out.append(Measure(shear, "m moved", meaning, row, face=min(widths)))
    return out


def _widths(pair: Pair) -> list[float | None]:
    return [member.face_width for member in pair.members.values()]
