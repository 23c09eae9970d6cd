r"""Forces of teeth and belts on a shaft, from what a designer knows of a gear or a pulley.

The contact lies at a distance r from the axis, in the direction ``e = (cos a, 0, sin a)``, an angle a
from x towards z.  A positive torque T about +y pulls the shaft there along ``t = y x e``::

            z                          y points to the reader
            |     . e
            |   .  \                   t = (sin a, 0, -cos a): where the contact moves
            | .  a  \ t                as the shaft turns about +y
            +---------- x

Teeth lie on a cone with the pitch angle d, whose apex lies against ``s = +y`` or ``-y``; a cylinder has
d = 0.  With the generator ``g = cos d s + sin d e`` and the normal ``m = cos d e - sin d s`` the tooth
line is ``cos b g + h sin b (s x e)``, with the helix or spiral angle b and h = 1 for a right hand.  The
normal force is perpendicular to that line and rises from the pitch surface by the pressure angle c, so
that with ``F_t = T / r``

    F = F_t t - h F_t tan b (s . y) g - |F_t| tan c / cos b m.

For d = 0 that is ``F_r = F_t tan c / cos b`` and ``F_a = F_t tan b`` of helical gears, for b = 0
``F_t tan c cos d`` and ``F_t tan c sin d`` of straight bevel gears, away from the apex (Shigley,
Mechanical Engineering Design, chapter 13; Niemann, Maschinenelemente 2).  c is measured in the normal
section.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, pi, sin, tan

import numpy as np

from solidgear.core.errors import SceneError, listed

#: rad, of teeth that give none
USUAL_PRESSURE_ANGLE = pi / 9
#: directions across the shaft by their words, (x, z)
ACROSS = {"+x": (1.0, 0.0), "-x": (-1.0, 0.0), "+z": (0.0, 1.0), "-z": (0.0, -1.0)}
#: words of the pulls of a belt, any two of which, with the diameter, define the others
PULLS = ("torque", "tight", "slack", "pull_ratio")


def direction(towards: str | float) -> np.ndarray:
    """Return the unit vector (3,) of a direction across the shaft: a word, or an angle from x towards
    z, rad.

    Examples
    --------
    >>> direction("-z"), direction(0.0)
    (array([ 0.,  0., -1.]), array([1., 0., 0.]))
    """
    x, z = ACROSS[towards] if isinstance(towards, str) else (cos(towards), sin(towards))
    return np.array([x, 0.0, z])


@dataclass(frozen=True)
class Teeth:
    """Teeth of a gear where they touch the other one."""

    diameter: float  #: at the middle of the face, m
    towards: str | float  #: from the axis to the contact
    pressure_angle: float = USUAL_PRESSURE_ANGLE  #: in the normal section, rad
    helix_angle: float = 0.0  #: or spiral angle, rad
    hand: str = "right"
    pitch_angle: float = 0.0  #: rad; zero for a cylinder
    apex: str = "-y"  #: where the apex of the cone lies

    def six(self, torque: float) -> np.ndarray:
        """Return the load (6,) on the axis beside the contact, N and N m, that brings a torque about
        the axis, N m.

        Examples
        --------
        Shigley, example 7-2, gear 3: 540 lbf and 197 lbf at 24 in of diameter's half, contact at -x:

        >>> x, y, z, *_ = Teeth(12 * 0.0254, "-x").six(3240 * 0.112985) / 4.44822
        >>> round(x), round(z)
        (197, 540)
        """
        along, out = np.array([0.0, 1.0, 0.0]), direction(self.towards)
        heel = along if self.apex == "-y" else -along
        generator = cos(self.pitch_angle) * heel + sin(self.pitch_angle) * out
        normal = cos(self.pitch_angle) * out - sin(self.pitch_angle) * heel
        pull = 2 * torque / self.diameter
        twist = tan(self.helix_angle) * (1.0 if self.hand == "right" else -1.0) * heel[1]
        rise = tan(self.pressure_angle) / cos(self.helix_angle)
        force = pull * np.cross(along, out) - pull * twist * generator - abs(pull) * rise * normal
        moment = np.cross(self.diameter / 2 * out, force)
        moment[1] = torque
        return np.concatenate([force, moment]) + 0.0  # without zeros below zero


@dataclass(frozen=True)
class Belt:
    """Pulls of a belt or chain on a pulley, both along one direction."""

    tight: float  #: N
    slack: float  #: N
    diameter: float  #: m
    towards: str | float  #: from the axis to the other pulley

    @property
    def torque(self) -> float:
        """Size of the torque, N m."""
        return (self.tight - self.slack) * self.diameter / 2

    def six(self, sign: float) -> np.ndarray:
        """Return the load (6,) on the axis, N and N m, with the torque in one sense about it, 1 or
        -1.
        """
        out = np.zeros(6)
        out[:3] = (self.tight + self.slack) * direction(self.towards)
        out[4] = sign * self.torque
        return out


def pulls(numbers: Mapping[str, float], diameter: float) -> tuple[float, float]:
    """Return the pulls of the tight and the slack side, N, from two of `PULLS`; other numbers of them
    are refused, and pulls that no belt has.

    Examples
    --------
    >>> pulls({"torque": 50.0, "pull_ratio": 3.0}, 0.2), pulls({"torque": 50.0, "slack": 0.0}, 0.2)
    ((750.0, 250.0), (500.0, 0.0))
    """
    if len(numbers) != 2:
        words = f"given here: {listed([*numbers])}" if numbers else "none is given"
        raise SceneError(
            "the pulls of a belt follow from its diameter and two of torque, tight, slack and "
            f"pull_ratio; {words}",
            path=("diameter",),
        )
    ratio, tight, slack = numbers.get("pull_ratio"), numbers.get("tight"), numbers.get("slack")
    if ratio is not None and ratio <= 1:
        raise SceneError(
            "must be above one: the pull of the tight side over that of the slack one",
            path=("pull_ratio",),
        )
    differ = 2 * abs(numbers.get("torque", 0.0)) / diameter
    if tight is None and slack is None and ratio is not None:
        slack = differ / (ratio - 1)
    if slack is None and tight is not None:
        slack = tight - differ if ratio is None else tight / ratio
    assert slack is not None  # of any two at least one leads to it
    if tight is None:
        tight = slack + differ if ratio is None else ratio * slack
    if slack < 0 or tight < slack:
        raise SceneError(
            f"a belt only pulls, and its tight side most; here the slack side has {slack:.6g} N and "
            f"the tight one {tight:.6g} N",
            path=("slack" if "slack" in numbers else "tight",),
        )
    return tight, slack
