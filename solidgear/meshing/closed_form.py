"""Volume, mass and inertia of a shaft of revolution in closed form."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from solidgear.scene import Corner, Segment


def volume_of(segments: Iterable[Segment], corners: Sequence[Corner] = ()) -> float:
    """Volume of hollow frusta end to end with fillets and chamfers, closed form.

    Parameters
    ----------
    segments : iterable
        Objects with y0, y1, outer0, outer1, inner0, inner1 [m].
    corners : sequence of Corner
        Edges with fillets and chamfers.

    Returns
    -------
    float
        [m^3]

    Examples
    --------
    >>> from solidgear import Segment
    >>> rod = Segment.cylinder("rod", length=0.6, diameter=0.02)
    >>> round(1e6 * volume_of([rod]), 6)
    188.495559
    """
    whole = sum(
        np.pi * (s.y1 - s.y0) * (_squares(s.outer0, s.outer1) - _squares(s.inner0, s.inner1))
        for s in segments
    )
    return float(whole + sum(row[0] for c in corners for row in _at_edge(c, 1.0)))


@dataclass(frozen=True)
class MassProperties:
    """Rigid-body constants of a body of revolution about the axis y.

    Attributes
    ----------
    mass : float
        [kg]
    centre : float
        Position of the centre of mass along y [m].
    ixx : float
        Moment of inertia about a transverse axis through the centre of mass [kg m^2]; the one about
        z is the same.
    iyy : float
        Polar moment of inertia about the axis y [kg m^2].
    """

    mass: float
    centre: float
    ixx: float
    iyy: float


def mass_properties(segments: Sequence[Segment], corners: Sequence[Corner] = ()) -> MassProperties:
    """Mass, centre and inertia of hollow frusta with fillets and chamfers, by exact integration.

    Parameters
    ----------
    segments : sequence
        Objects with y0, y1, outer0, outer1, inner0, inner1 [m] and material.density [kg/m^3].
    corners : sequence of Corner
        Edges with fillets and chamfers.

    Returns
    -------
    MassProperties

    Examples
    --------
    >>> from solidgear import Segment
    >>> rod = mass_properties([Segment.cylinder("rod", length=0.6, diameter=0.02)])
    >>> bool(np.isclose(rod.iyy, rod.mass * 0.01**2 / 2)), rod.centre
    (True, 0.3)
    """
    parts = np.array(
        [_frustum(s.y0, s.y1, s.outer0, s.outer1, s.material.density) for s in segments]
        + [_frustum(s.y0, s.y1, s.inner0, s.inner1, -s.material.density) for s in segments]
        + [row for c in corners for row in _at_edge(c, segments[c.owner].material.density)]
    )
    mass, first, polar = parts[:, :3].sum(axis=0)
    centre = first / mass
    # second moment of each part about the common centre: about its own small end, then shifted
    offset = parts[:, 3] - centre
    axial = (parts[:, 5] + 2.0 * offset * parts[:, 4] + offset**2 * parts[:, 0]).sum()
    return MassProperties(
        mass=float(mass), centre=float(centre), ixx=float(0.5 * polar + axial), iyy=float(polar)
    )


def _frustum(y0, y1, a, b, density):
    """Mass, moment of mass in y, polar inertia, and y0 with first and second moment about y0, of a
    solid frustum.
    """
    h = y1 - y0
    mass = density * np.pi * h * _squares(a, b)
    first = density * np.pi * h**2 * (a * a + 2.0 * a * b + 3.0 * b * b) / 12.0  # int r^2 s
    second = density * np.pi * h**3 * (a * a + 3.0 * a * b + 6.0 * b * b) / 30.0  # int r^2 s^2
    fourth = (a**4 + a**3 * b + a**2 * b**2 + a * b**3 + b**4) / 5.0  # int r^4
    return mass, first + y0 * mass, 0.5 * density * np.pi * h * fourth, y0, first, second


def _at_edge(corner: Corner, density: float):
    """Rows of :func:`_frustum` for what a fillet or chamfer adds (a rim: takes away): the solid
    inside its outline less the cylinder inside the edge, the other way round in a bore.
    """
    a, b = sorted((corner.y, corner.on_cylinder[1]))
    sign = density if corner.surface == "outer" else -density
    yield _frustum(a, b, corner.r, corner.r, -sign)
    if corner.centre is None:
        ends = {corner.y: corner.on_face[0], corner.on_cylinder[1]: corner.r}
        yield _frustum(a, b, ends[a], ends[b], sign)
        return
    # r = c - s q with q = sqrt(f^2 - t^2), t from the centre of the arc towards the face
    c, f, s = corner.centre[0], corner.radial, corner.out
    q, q2, q3, q4 = np.pi * f**2 / 4, 2 * f**3 / 3, 3 * np.pi * f**4 / 16, 8 * f**5 / 15
    volume = c * c * f - 2 * s * c * q + q2
    first = c * c * f**2 / 2 - 2 * s * c * f**3 / 3 + f**4 / 4
    second = c * c * f**3 / 3 - 2 * s * c * np.pi * f**4 / 16 + 2 * f**5 / 15
    fourth = c**4 * f - 4 * s * c**3 * q + 6 * c * c * q2 - 4 * s * c * q3 + q4
    y0, weight, turned = corner.centre[1], sign * np.pi, -corner.side
    yield (
        weight * volume,
        weight * (turned * first + y0 * volume),
        0.5 * weight * fourth,
        y0,
        weight * turned * first,
        weight * second,
    )


def _squares(a, b):
    """Mean of r^2 along a cone from radius a to radius b."""
    return (a * a + a * b + b * b) / 3.0
