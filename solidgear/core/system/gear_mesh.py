r"""Line of action, mesh point and mesh vector of a bevel gear pair, and of cylindrical gears, one
of which may be a ring.

Each member has its own frame, right-handed, y along its shaft from the pitch apex towards its back,
z up for both. Seen from above, z towards the reader, crossing axes at 90 degrees, O the pitch
apex::

           y_p, x_g
              ^
      M . . . |            M  mesh point, in the plane z = 0:
      .\      |               pinion frame  x_p = -r_p,  y_p = +r_g
      . \     |               gear frame    x_g = +r_g,  y_g = +r_p
      .  \    |
      .   \ g |            g  pitch angle of the pinion, between y_p and OM
      .    \  |
      .     \ |
      .      \|
     <--------O--------> x_p
    y_g                    x_g = y_p,  y_g = -x_p,  z_g = z_p

The pinion meshes on its -x side and the gear on its +x side. With a shaft angle S instead of 90
degrees the gear frame is the pinion frame turned by +S about z (at S = 90 degrees ``y_g = -x_p``).
Angles are in rad, lengths in m, rotations right-handed.

A tooth is right-handed when, seen from the apex, its outer half leans clockwise: along the tooth
from toe to heel one moves ``cos(psi) g + s sin(psi) e``, with g the cone generator pointing away
from the apex, e the direction of growing rotation about +y, and s = +1 for right, -1 for left hand.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, isfinite, pi, sin, sqrt

import numpy as np
from numpy.typing import ArrayLike

from solidgear.core.errors import SolidgearError
from solidgear.core.frames import rotation

# A line of action typed with six digits has this error; anything worse is a slip that would scale
# k_m.
UNIT_TOLERANCE = 1e-6

_SIDE_OF_MESH = {"pinion": -1.0, "gear": 1.0}  # x of the mesh point, see the drawing
_SPIRAL = {"right": 1.0, "left": -1.0}


def line_of_action(
    pitch_angle: float,
    spiral_angle: float,
    pressure_angle: float,
    hand: str,
    loaded_side: str,
    member: str = "pinion",
) -> np.ndarray:
    """Return the direction of the tooth force *on* one member, in that member's frame.

    With s as in the head of this module and t = +1 where the force turns the member about +y, the
    normal force divides into (standard spiral bevel force formulas)

        tangential   t cos(phi) cos(psi)
        along +y     sin(phi) sin(gamma) - s t cos(phi) sin(psi) cos(gamma)
        to the axis  sin(phi) cos(gamma) + s t cos(phi) sin(psi) sin(gamma)

    The concave flank faces the way its teeth lean, so a load on it pushes the other way: t = -s for
    the concave side and +s for the convex one. Hence a loaded concave side drives the member away
    from the apex and a convex one pulls it in, whatever the hand; for a *given* direction of load,
    changing the hand changes the sign of the spiral part. Left and right flanks are those of a
    tooth with its tip upwards, seen from the apex (ISO 21771: from the datum face): a load on the
    left one turns the member about +y, t = +1.

    Parameters
    ----------
    pitch_angle : float
        gamma, between the axis and the pitch cone, 0 to pi/2, rad.
    spiral_angle : float
        psi at the mesh point, 0 (straight teeth) to below pi/2, rad; without sign, which is the
        hand's.
    pressure_angle : float
        phi, normal to the tooth, 0 to below pi/2, rad.
    hand : {"left", "right"}
    loaded_side : {"concave", "convex", "left", "right"}
    member : {"pinion", "gear"}
        On which side of its axis it meshes: pinion at -x, gear at +x.

    Returns
    -------
    (3,) ndarray
        Unit vector.

    Raises
    ------
    SolidgearError
        For an angle out of range or an unknown word.

    Notes
    -----
    For straight teeth the hand only settles, together with a concave or convex side, which flank is
    loaded.

    References
    ----------
    ANSI/AGMA 2005, bevel gears: definition of hand, axial and radial thrust formulas.
    Shigley's Mechanical Engineering Design, straight bevel forces (the case psi = 0).

    Examples
    --------
    The pinion of Hua (2010), with a pressure angle of 25 degrees:

    >>> n = line_of_action(0.391, 0.478, np.radians(25), hand="left", loaded_side="concave")
    >>> [round(float(value), 2) for value in n]
    [0.23, 0.55, 0.8]
    """
    _angle("pitch_angle", pitch_angle, closed=True)
    _angle("spiral_angle", spiral_angle)
    _angle("pressure_angle", pressure_angle)
    s = _SPIRAL[_word("hand", hand, _SPIRAL)]
    turns = {"concave": -s, "convex": s, "left": 1.0, "right": -1.0}
    t = turns[_word("loaded_side", loaded_side, turns)]
    side = _SIDE_OF_MESH[_word("member", member, _SIDE_OF_MESH)]
    along_tooth = -s * t * cos(pressure_angle) * sin(spiral_angle)
    axial = sin(pressure_angle) * sin(pitch_angle) + along_tooth * cos(pitch_angle)
    inward = sin(pressure_angle) * cos(pitch_angle) - along_tooth * sin(pitch_angle)
    tangential = t * cos(pressure_angle) * cos(spiral_angle)
    # Rotation about +y moves the point at x = side * r towards -side * z.
    return np.array([-side * inward, axial, -side * tangential])


def mesh_point(
    mean_radius: float, axial: float = 0.0, height: float = 0.0, member: str = "pinion"
) -> np.ndarray:
    """Return the mesh point (3,) relative to the lumped point, in the member's frame, m, from its
    distance from the axis, from `axial`, its distance behind the lumped point along +y (zero where
    the lumped point is at the middle of the face), and `height`, its z along the path of contact,
    all m; a height beyond the radius is refused.

    Examples
    --------
    >>> mesh_point(0.055, height=0.033)
    array([-0.044,  0.   ,  0.033])
    """
    side = _SIDE_OF_MESH[_word("member", member, _SIDE_OF_MESH)]
    for name, value in (("mean_radius", mean_radius), ("axial", axial), ("height", height)):
        if not isfinite(value):
            raise SolidgearError(f"{name} of the mesh point is {value}; give a finite length in m")
    if mean_radius <= 0 or abs(height) >= mean_radius:
        raise SolidgearError(
            f"the mesh point needs mean_radius > |height|, but mean_radius = {mean_radius} m "
            f"and height = {height} m"
        )
    return np.array([side * sqrt(mean_radius**2 - height**2), axial, height])


def mean_radius(pitch_radius: float, pitch_angle: float, face_width: float) -> float:
    """Return the pitch radius at the middle of the face, m, from that at the heel, m, the angle
    between the axis and the pitch cone, rad, and the face width along the cone, m; a face that
    reaches past the apex is refused.

    Examples
    --------
    >>> round(mean_radius(0.067, 0.391, 0.063), 4)
    0.055
    """
    radius = pitch_radius - face_width / 2 * sin(pitch_angle)
    if not radius > 0:
        raise SolidgearError(
            f"a face of {face_width} m reaches past the apex "
            f"of a pitch cone of {pitch_radius} m radius"
        )
    return radius


def to_gear_frame(vector: ArrayLike, shaft_angle: float = pi / 2) -> np.ndarray:
    """Return a direction or an offset (3,) given in the pinion's frame, in the gear's frame, at an
    angle between the two axes, rad.

    Examples
    --------
    >>> np.round(to_gear_frame([-1.0, 0.0, 0.0]), 12) + 0.0  # y_g = -x_p
    array([0., 1., 0.])
    """
    c, s = cos(shaft_angle), sin(shaft_angle)
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ np.asarray(vector, float)


@dataclass(frozen=True, eq=False)
class MeshVector:
    """Coordinate transformation from the motion of a lumped point to the line of action.

    Attributes
    ----------
    normal : (3,) array_like
        n, unit line of action in the body's frame.
    point : (3,) array_like
        r, mesh point relative to the lumped point in the body's frame, m.

    Raises
    ------
    SolidgearError
        If n is not a unit vector within 1e-6, or something is not finite.

    References
    ----------
    Hua (2010), equations 21 and 22: ``h = {n, r x n}``.

    Examples
    --------
    A tooth force along z at a radius of 50 mm turns the pinion about its axis:

    >>> mesh = MeshVector([0.0, 0.0, 1.0], [-0.05, 0.0, 0.0])
    >>> mesh.lever
    0.05
    """

    normal: np.ndarray
    point: np.ndarray

    def __post_init__(self):
        for name in ("normal", "point"):
            try:
                value = np.array(getattr(self, name), float)
            except (TypeError, ValueError):
                raise SolidgearError(
                    f"the {name} of a mesh vector must be three numbers, "
                    f"not {getattr(self, name)!r}"
                ) from None
            if value.shape != (3,):
                raise SolidgearError(
                    f"the {name} of a mesh vector has shape {value.shape}; "
                    "it needs three components"
                )
            if not np.isfinite(value).all():
                raise SolidgearError(
                    f"the {name} of a mesh vector is {value.tolist()}; "
                    "all components must be finite"
                )
            value.setflags(write=False)
            object.__setattr__(self, name, value)
        length = float(np.linalg.norm(self.normal))
        if abs(length - 1) > UNIT_TOLERANCE:
            raise SolidgearError(
                f"the line of action has length {length:.9g}; "
                f"it must be a unit vector within {UNIT_TOLERANCE:g}"
            )

    @cached_property
    def vector(self) -> np.ndarray:
        """(6,) ``{n, r x n}``; its product with a motion is the displacement along the line of
        action.
        """
        return np.concatenate([self.normal, np.cross(self.point, self.normal)])

    @property
    def lever(self) -> float:
        """Fifth component, m: line-of-action displacement per rad about the shaft."""
        return float(self.vector[4])


def cylindrical_mesh(
    radius: float,
    mate_radius: float,
    pressure_angle: float,
    azimuth: float = 0.0,
    *,
    internal: bool = False,
    base_helix: float = 0.0,
) -> tuple[MeshVector, MeshVector]:
    """Return mesh vectors of two spur or helical gears on parallel axes, of one physical direction,
    in axes that both share.

    The line of action is the one of a gear that drives the mate about +y; the point is the pitch
    point, as seen from each axis. Radii are those of the base circles, m, the pressure angle is
    transverse, at work, rad, and the azimuth that of the mate's axis as seen from the gear's,
    right-handed about y from x, rad. With `internal` the gear is a ring, whose mate turns inside
    it. The helix angle on the base cylinder, ``tan b = tan(helix) cos(pressure angle)`` on any
    other, rad, is positive where the gear is right-handed; the mate outside has the other hand,
    that inside a ring the same. A radius that is not positive, an angle out of range, and a mate as
    large as the ring are refused.

    Examples
    --------
    An internal mesh turns both gears the same way:

    >>> ring, planet = cylindrical_mesh(0.06, 0.02, np.radians(20), internal=True)
    >>> round(ring.lever, 12), round(planet.lever, 12)
    (0.06, 0.02)
    """
    _angle("pressure_angle", pressure_angle)
    _angle("base_helix, its sign apart,", abs(base_helix))
    largest = radius if internal else np.inf
    if not 0 < mate_radius < largest:
        raise SolidgearError(
            f"a base circle of {mate_radius} m does not mesh with one of {radius} m; "
            "radii are positive, and a ring is larger than what turns in it"
        )
    leans = -pressure_angle if internal else pressure_angle
    turn = rotation(1, azimuth)[:3, :3]
    across = cos(base_helix)
    # the tooth of a right-handed screw that turns about +y pushes its mate back along -y
    normal = turn @ [across * sin(leans), -sin(base_helix), -across * cos(leans)]
    pitch = turn @ [1 / cos(pressure_angle), 0.0, 0.0]
    mate_pitch = mate_radius if internal else -mate_radius
    return MeshVector(normal, radius * pitch), MeshVector(normal, mate_pitch * pitch)


def _angle(name: str, value: float, closed: bool = False) -> None:
    inside = isfinite(value) and 0 <= value and (value <= pi / 2 if closed else value < pi / 2)
    if not inside:
        end = "at most" if closed else "below"
        raise SolidgearError(f"{name} is {value} rad; it must be at least 0 and {end} pi/2")


def _word(name: str, value: str, allowed) -> str:
    if value not in allowed:
        raise SolidgearError(f"{name} is {value!r}; write {' or '.join(map(repr, allowed))}")
    return value
