"""Volume, mass and inertia of a shaft of revolution in closed form, by lines and arcs of its outline.

Between the axis and each line or arc lies a solid of revolution; those of bores count negative.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.scene.outline import Outline

if TYPE_CHECKING:
    from solidgear.core.scene.corner import Corner
    from solidgear.core.scene.model import Scene
    from solidgear.core.scene.outline import Piece
    from solidgear.core.scene.parts import Segment

#: points of Gauss along a line or an arc; three are exact on lines
GAUSS = 12


def volume_of(outline: Outline) -> float:
    """Compute the volume of a shaft, m^3.

    Examples
    --------
    >>> from solidgear import Segment
    >>> rod = Segment.cylinder("rod", length=0.6, diameter=0.02)
    >>> round(1e6 * volume_of(Outline([rod])), 6)
    188.495559
    """
    return float(sum(_inside(piece, 1.0)[0] for piece in outline.pieces))


@dataclass(frozen=True)
class MassProperties:
    """Rigid-body constants of a body of revolution about the axis y."""

    mass: float  #: [kg]
    centre: float  #: position of the centre of mass along y [m]
    #: moment of inertia about a transverse axis through the centre of mass [kg m^2]; the one about
    #: z is the same
    ixx: float
    iyy: float  #: polar moment of inertia about the axis y [kg m^2]


def mass_properties(outline: Outline[Segment]) -> MassProperties:
    """Compute mass, centre and inertia of a shaft of segments with a material, exactly.

    Examples
    --------
    >>> from solidgear import Segment
    >>> rod = mass_properties(Outline([Segment.cylinder("rod", length=0.6, diameter=0.02)]))
    >>> bool(np.isclose(rod.iyy, rod.mass * 0.01**2 / 2)), rod.centre
    (True, 0.3)
    """
    density = [segment.material.density for segment in outline.segments]
    parts = np.array([_inside(piece, density[piece.segment]) for piece in outline.pieces])
    mass, first, polar = parts[:, :3].sum(axis=0)
    centre = first / mass
    # second moment of each part about the common centre: about its own small end, then shifted
    offset = parts[:, 3] - centre
    axial = (parts[:, 5] + 2.0 * offset * parts[:, 4] + offset**2 * parts[:, 0]).sum()
    return MassProperties(
        mass=float(mass), centre=float(centre), ixx=float(0.5 * polar + axial), iyy=float(polar)
    )


@dataclass(frozen=True)
class Parts:
    """Segments of a shaft, where a fillet or chamfer fills a step both beside it as one: meshes differ
    in which of them it belongs to.
    """

    of_segments: np.ndarray  #: (n,) part that each segment is in
    middles: np.ndarray  #: (k,) m


def parts_of(outline: Outline) -> Parts:
    """Return the parts of a shaft whose moments are known one by one.

    Examples
    --------
    >>> import solidgear as sg
    >>> parts_of(sg.load("geometry/pinion_filleted.toml").outline).of_segments
    array([0, 1, 1])
    """
    segments = outline.segments
    separate = [
        not any(edge.root for edge in outline.edges_at(joint)) for joint in range(1, len(segments))
    ]
    number = np.concatenate([[0], np.cumsum(separate)]).astype(int)
    ends = [[s for s, k in zip(segments, number) if k == part] for part in range(number[-1] + 1)]
    return Parts(number, np.array([(part[0].y0 + part[-1].y1) / 2 for part in ends]))


def moments_of_parts(outline: Outline) -> np.ndarray:
    """Compute the integrals (k, 4, 4) of the products of 1, x, y and z over every part of a shaft, y
    from its middle, in m: volume, first and second moments.

    Examples
    --------
    >>> from solidgear import Segment
    >>> rod = Segment.cylinder("rod", length=0.6, diameter=0.02)
    >>> moments = moments_of_parts(Outline([rod]))[0]
    >>> bool(np.isclose(2 * moments[1, 1], moments[0, 0] * 0.01**2 / 2))
    True
    """
    parts = parts_of(outline)
    out = np.zeros((len(parts.middles), 4, 4))
    for piece in outline.pieces:
        part = parts.of_segments[piece.segment]
        volume, _, polar, y0, about, squared = _inside(piece, 1.0)
        out[part] += moments_about(y0 - parts.middles[part], volume, about, squared, polar)
    return out


def moments_about(
    beside: float, volume: float, first: float, second: float, polar: float
) -> np.ndarray:
    """Return integrals (4, 4) as :func:`moments_of_parts` does of a solid that is alike about the axis,
    whose moments along y are taken from a place beside the middle, m.
    """
    out = np.diag([volume, polar / 2, second + 2 * beside * first + beside**2 * volume, polar / 2])
    out[[0, 2], [2, 0]] = first + beside * volume
    return out


def mass_between(outline: Outline[Segment], lo: float, hi: float) -> tuple[float, float]:
    """Compute the mass of a shaft between two places, m, and its moment about the start of the shaft,
    in kg and kg m, to rounding.

    Examples
    --------
    >>> from solidgear import Segment
    >>> rod = Outline([Segment.cylinder("rod", length=0.6, diameter=0.02)])
    >>> mass, first = mass_between(rod, 0.0, 0.2)
    >>> bool(np.isclose(mass, mass_properties(rod).mass / 3)), round(first / mass, 12)
    (True, 0.1)
    """
    mass = first = 0.0
    for piece in outline.pieces:
        start, end = max(lo, piece.y0), min(hi, piece.y1)
        if start < end:
            density = outline.segments[piece.segment].material.density
            y, volumes = _volumes(piece, start, end)
            mass += density * float(volumes.sum())
            first += density * float(volumes @ y)
    return mass, first


def _volumes(piece: Piece, start: float, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Return places between two ends within a piece, m, and the volumes at them, m^3, between the axis
    and the piece; those of bores count negative.
    """
    points, weights = np.polynomial.legendre.leggauss(GAUSS)
    if piece.corner and piece.corner.centre:
        # along the angle of the arc, in which its radius is smooth
        (r, middle), reach = piece.corner.centre, piece.corner.radial
        first, last = np.arcsin(np.clip((np.array([start, end]) - middle) / reach, -1.0, 1.0))
        angle = (first + last) / 2 + (last - first) / 2 * points
        y, steps = middle + reach * np.sin(angle), (last - first) / 2 * weights
        steps = steps * reach * np.cos(angle)
        radius = r - piece.corner.out * reach * np.cos(angle)
    else:
        y, steps = (start + end) / 2 + (end - start) / 2 * points, (end - start) / 2 * weights
        radius = piece.r0 + (piece.r1 - piece.r0) * (y - piece.y0) / (piece.y1 - piece.y0)
    sign = 1.0 if piece.surface == "outer" else -1.0
    return y, sign * np.pi * radius**2 * steps


def whole_mass(scene: Scene) -> MassProperties:
    """Compute mass, centre and inertia of a shaft with its rigid masses; transverse about x."""
    shaft, places = mass_properties(scene.outline), {s.name: s.y for s in scene.stations}
    mass_places = [
        (m, places[m.on] + m.offset[1] if m.on else m.y + m.offset[1]) for m in scene.masses
    ]
    mass = shaft.mass + sum(m.mass for m, _ in mass_places)
    centre = (shaft.mass * shaft.centre + sum(m.mass * y for m, y in mass_places)) / mass
    ixx = shaft.ixx + shaft.mass * (shaft.centre - centre) ** 2
    ixx += sum(
        m.inertia[0] + m.mass * ((y - centre) ** 2 + m.offset[2] ** 2) for m, y in mass_places
    )
    iyy = shaft.iyy
    iyy += sum(
        m.inertia[1] + m.mass * (m.offset[0] ** 2 + m.offset[2] ** 2) for m, _ in mass_places
    )
    return MassProperties(mass=mass, centre=centre, ixx=ixx, iyy=iyy)


def _inside(piece: Piece, density: float) -> tuple[float, ...]:
    """Compute mass, moment of mass in y and polar inertia of the solid between the axis and a piece,
    and a place with first and second moment of mass about it.
    """
    weight = np.pi * (density if piece.surface == "outer" else -density)
    if piece.corner and piece.corner.centre:
        y0, integrals = piece.corner.centre[1], _under_arc(piece.corner)
    else:
        y0, integrals = piece.y0, integrals_along(piece.y1 - piece.y0, piece.r0, piece.r1)
    mass, first, second, fourth = (weight * integral for integral in integrals)
    return mass, first + y0 * mass, 0.5 * fourth, y0, first, second


def integrals_along(h: float, a: float, b: float) -> tuple[float, float, float, float]:
    """Compute the integrals of r^2, r^2 s, r^2 s^2, r^4 over a length h from radius a (s = 0) to b."""
    return (
        h * (a * a + a * b + b * b) / 3.0,
        h**2 * (a * a + 2.0 * a * b + 3.0 * b * b) / 12.0,
        h**3 * (a * a + 3.0 * a * b + 6.0 * b * b) / 30.0,
        h * (a**4 + a**3 * b + a**2 * b**2 + a * b**3 + b**4) / 5.0,
    )


def _under_arc(corner: Corner) -> tuple[float, ...]:
    """Compute these integrals along the arc of a fillet, s from its middle."""
    assert corner.centre is not None
    # r = c - s q with q = sqrt(f^2 - t^2), t from the centre of the arc towards the face
    c, f, s = corner.centre[0], corner.radial, corner.out
    q, q2, q3, q4 = np.pi * f**2 / 4, 2 * f**3 / 3, 3 * np.pi * f**4 / 16, 8 * f**5 / 15
    volume = c * c * f - 2 * s * c * q + q2
    first = c * c * f**2 / 2 - 2 * s * c * f**3 / 3 + f**4 / 4
    second = c * c * f**3 / 3 - 2 * s * c * np.pi * f**4 / 16 + 2 * f**5 / 15
    fourth = c**4 * f - 4 * s * c**3 * q + 6 * c * c * q2 - 4 * s * c * q3 + q4
    return volume, -corner.side * first, second, fourth
