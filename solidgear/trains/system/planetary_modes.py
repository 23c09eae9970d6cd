r"""Names of the modes of a planetary stage, by the moving members.

Of N equal planets at equal angles a turn by 2 pi / N changes nothing, so that every mode belongs to
one phase from planet to planet.  Where all planets do the same, central members turn and move along
the axis; where planets do the same times cosine and sine of their azimuths, central members shift
and tilt; in all other phases they rest.  With members that move in

    the plane: 6 rotational, 6 translational (each twice), 3 planet modes (each N - 3 times);
    all six motions: 12, 12 and 6 of them.

Of unequal planets a mode may have a part in more than one: it is mixed.

References
----------
Lin and Parker, Journal of Vibration and Acoustics 121, 1999, p. 316-321, in the plane; Eritenel and
Parker, Journal of Sound and Vibration 325, 2009, p. 397-420, for six motions.
"""

from __future__ import annotations

from math import isclose
from typing import NamedTuple

import numpy as np

from solidgear.trains.system.planetary_members import Members, weights

CENTRAL = ("sun", "ring", "carrier")
#: share of a mode's kinetic energy below which a motion is rounding
NO_SHARE = 1e-9
#: relative; natural frequencies of a symmetric stage that are one differ by rounding alone
SAME = 1e-9
#: of columns of unit length, below which they depend on one another
DEPENDENT = 1e-9
#: motions in the plane and out of it of x y z thx thy thz; turning and along the axis, the others
IN_PLANE, OUT_OF_PLANE = [0, 2, 4], [1, 3, 5]
WITH_AXIS = [1, 4]
#: names of motions of one phase: in the plane, out of it, both
NAMES = (
    ("rotational", "axial", "rotational-axial"),
    ("translational", "tilting", "translational-tilting"),
    ("planet", "planet-tilting", "planet"),
)


class PlanetaryMode(NamedTuple):
    """Modes of a stage at one natural frequency."""

    #: ``rotational`` (central members turn only), ``translational`` (they shift only), ``planet``
    #: (they rest); ``axial``, ``tilting``, ``planet-tilting`` (the same out of the plane);
    #: ``rotational-axial``, ``translational-tilting`` (helical teeth couple both); ``ring``
    #: (nothing but the waves of an elastic ring); or ``mixed``, which a stage of equal planets at
    #: equal angles has none of
    kind: str
    number: int  #: among those of its kind, from 1
    frequency_hz: float
    #: of equal frequencies; 2 of ``translational``, N - 3 of ``planet`` in a stage of N equal
    #: planets at equal angles
    multiplicity: int
    #: (n, multiplicity) on the coordinates of the stage's system, mass-normalised
    shapes: np.ndarray

    @property
    def name(self) -> str:
        """Kind and number."""
        return f"{self.kind} {self.number}"


class Phases:
    """Shares of the phases of planets in a motion of a stage."""

    def __init__(self, stage: Members):
        system = stage.system
        rows: list[list[np.ndarray]] = [[] for _ in range(6)]

        def add(phase: int, moved: np.ndarray) -> None:
            for plane, components in enumerate((IN_PLANE, OUT_OF_PLANE)):
                chosen = moved[..., components, :]
                rows[2 * phase + plane].append(chosen.reshape(-1, system.size))

        for name in CENTRAL:
            with_mass = np.sqrt(weights(getattr(stage, name)))[:, None]
            moved = with_mass * system.motion(f"{name}.centre")
            with_axis = np.isin(np.arange(6), WITH_AXIS)[:, None]
            add(0, np.where(with_axis, moved, 0.0))
            add(1, np.where(with_axis, 0.0, moved))
        planets = np.array(
            [
                np.sqrt(weights(p))[:, None] * system.motion(f"planet {k}.centre")
                for k, p in enumerate(stage.planets, 1)
            ]
        )
        for phase, pattern in enumerate(patterns([p.azimuth for p in stage.planets])):
            add(phase, np.einsum("pk,pic->kic", pattern, planets))
        self._rows = [np.vstack(parts) for parts in rows]

    def shares(self, shapes: np.ndarray) -> np.ndarray:
        """Return squares (3, 2, k) of motions (n, k) by phase, in the plane and out of it."""
        squares = [(np.abs(rows @ shapes) ** 2).sum(axis=0) for rows in self._rows]
        return np.array(squares).reshape(3, 2, -1)

    def kinds(self, shapes: np.ndarray) -> list[str]:
        """Return the kind of each of some motions."""
        out = []
        for share in np.moveaxis(self.shares(shapes), -1, 0):
            present = share > NO_SHARE * max(share.sum(), 1.0)
            phases = np.flatnonzero(present.any(axis=1))
            if len(phases) == 1:
                inside, outside = present[phases[0]]
                out.append(NAMES[phases[0]][1 + inside if outside else 0])
            else:
                out.append("mixed" if len(phases) else "ring")
        return out

    def separated(self, shapes: np.ndarray) -> np.ndarray:
        """Return shapes of one frequency, combined so that each is of one kind where possible."""
        form = sum(
            weight * (rows @ shapes).T @ (rows @ shapes)
            for weight, rows in zip(np.sqrt([1.0, 2.0, 3.0, 5.0, 6.0, 7.0]), self._rows)
        )
        return shapes @ np.linalg.eigh(form)[1]


def patterns(azimuths: list[float]) -> list[np.ndarray]:
    """Return orthonormal patterns (N, k) over the planets: all the same, cosine and sine, all
    others.
    """
    raw = np.column_stack([np.ones(len(azimuths)), np.cos(azimuths), np.sin(azimuths)])
    size = np.sqrt(len(azimuths))
    basis = np.zeros((len(azimuths), 0))
    counts = []
    for column in raw.T:
        remainder = column - basis @ (basis.T @ column)
        remainder -= basis @ (basis.T @ remainder)
        length = np.linalg.norm(remainder)
        counts.append(int(length > DEPENDENT * size))
        if counts[-1]:
            basis = np.column_stack([basis, remainder / length])
    complement = np.linalg.svd(basis)[0][:, basis.shape[1] :]
    return [basis[:, :1], basis[:, 1:], complement]


def named_modes(stage: Members) -> list[PlanetaryMode]:
    """Return all modes, by ascending frequency, those of one frequency and kind together."""
    modes, phases = stage.system.modes(), Phases(stage)
    out: list[PlanetaryMode] = []
    hz = modes.frequency_hz
    starts = [k for k in range(len(hz)) if not k or not isclose(hz[k], hz[k - 1], rel_tol=SAME)]
    for start, end in zip(starts, [*starts[1:], len(hz)]):
        shapes = modes.shapes[:, start:end]
        kinds = phases.kinds(shapes)
        if len(set(kinds)) > 1 or "mixed" in kinds:
            shapes = stage.system.signed(phases.separated(shapes))
            kinds = phases.kinds(shapes)
        for kind in dict.fromkeys(kinds):
            members = shapes[:, [k == kind for k in kinds]]
            number = 1 + sum(mode.kind == kind for mode in out)
            out.append(PlanetaryMode(kind, number, float(hz[start]), members.shape[1], members))
    return out
