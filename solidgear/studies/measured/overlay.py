"""Responses of a scene at the points where it was measured: a sum over its modes, rigid motions
among them, with the damping that was measured, and the static compliance of all that is stiffer.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from solidgear.body import Body
from solidgear.studies.measured.computed import motions_up_to
from solidgear.studies.measured.correlate import Correlation
from solidgear.studies.measured.responses import ResponseFit
from solidgear.studies.measured.shapes import SurfacePoints
from solidgear.studies.measured.stiffer import left_out

#: of the highest measured frequency: modes up to there count
BEYOND = 2.0
#: what is over a force, by derivatives of the displacement, and its unit
KINDS = (("receptance", "m/N"), ("mobility", "m/s/N"), ("accelerance", "m/s^2/N"))
AXES = "xyz"


@dataclass(frozen=True, eq=False)
class Overlay:
    """Measured and computed responses."""

    hertz: np.ndarray  #: (k,)
    #: measured, computed: (n, k) SI
    measured: np.ndarray
    computed: np.ndarray
    names: tuple[str, ...]  #: of the responses: point and direction, and where it was driven
    kind: str
    unit: str
    limit: float  #: hz; stiffer modes are left out
    damping: float  #: ratio of modes that were not measured, the median of those that were
    #: number of a pair -> computed modal constant over the measured one, of all responses
    constants: dict[int, float]
    #: (n, k) how far computed ones may be off by the bars of frequencies and of static compliance;
    #: None where nothing tells them
    band: np.ndarray | None
    #: around the axis, up to which what is stiffer counts; 0 of a 3D mesh, and None where it is
    #: left out
    waves: int | None

    @property
    def told(self) -> str:
        """Model of the computed ones, in words."""
        around = f", up to {self.waves} waves around" if self.waves else ""
        stiffer = (
            f"What is stiffer counts with its static compliance{around}: at the point that is driven "
            "it rests on how wide the force is, and is sure to its own size only."
            if self.waves is not None
            else "What is stiffer is left out, which moves minima more than peaks."
        )
        band = (
            "The band is that of the bars of frequencies, and of static compliance what twice their "
            "largest makes of it, which is an estimate; shapes and damping have none."
            if self.band is not None
            else "The computed response has no bar."
        )
        return (
            f"Computed: the modes up to {self.limit:.0f} Hz and the rigid motions that nothing "
            "holds, each with the damping measured of it, others with the median, "
            f"{100 * self.damping:.2g} %. {stiffer} {band}"
        )

    @property
    def loudest(self) -> int:
        """The response that was driven where it was measured, else the largest one."""
        size = np.mean(np.abs(self.measured) ** 2, axis=1)
        own = np.array([name.split(" for ")[0] == name.split(" for ")[1] for name in self.names])
        return int(np.where(own | ~own.any(), size, -1.0).argmax())


def overlay(found: Correlation) -> Overlay | None:
    """Responses of the scene beside the measured ones; None where no responses were measured, or
    nothing tells at which points, or of what kind they are.
    """
    fitted, computed = found.measured.responses, found.computed
    if fitted is None:
        return None
    responses, derivatives = fitted.responses, fitted.responses.derivatives
    if not responses.places or not responses.scaled or derivatives is None:
        return None
    ends = list(zip(responses.points, responses.references))
    kept = [
        k
        for k, pair in enumerate(ends)
        if all(1 <= abs(way) <= 3 and at in responses.places for at, way in pair)
    ]
    if not kept:
        return None
    places, own = _ends(computed.body, responses.places, [ends[k] for k in kept])
    limit = BEYOND * found.pairs[-1].measured.frequency
    ahead = responses.frequencies > 0
    hertz = responses.frequencies[ahead]
    numbers = {
        pair.computed.name: pair.number - 1 for pair in found.pairs if pair.computed is not None
    }
    usual = float(np.median(fitted.fit.damping))
    out = np.zeros((len(kept), len(hertz)), complex)
    band = np.zeros(out.shape)
    constants: dict[int, float] = {}
    omega = 2 * np.pi * hertz
    motions = motions_up_to(computed, limit)
    for mode, bar in motions:
        constant = np.zeros(len(kept))
        for vector in mode.vectors:
            along = own.along(places.of(vector))
            constant += along[own.first] * along[own.second]
        number = numbers.get(str(mode.name))
        ratio = usual if number is None else float(fitted.fit.damping[number])
        natural = 2 * np.pi * mode.frequency_hz
        unit = _unit(natural, omega, ratio)
        out += constant[:, None] * unit
        if np.isfinite(bar):
            low, high = natural * (1 - bar), natural * (1 + bar)
            moved: tuple[float | np.ndarray, ...] = low, high, omega.clip(low, high)
            off = np.max([np.abs(_unit(one, omega, ratio) - unit) for one in moved], axis=0)
            band += np.abs(constant)[:, None] * off
        if number is not None:
            measured = _constants(fitted, number)[kept]
            constants[number + 1] = float(
                abs(np.vdot(measured, constant)) / np.sum(np.abs(measured) ** 2)
            )
    bars = [bar for mode, bar in motions if mode.frequency_hz > 0]
    stiffer = left_out(computed.scene, places, own.every, [mode for mode, _ in motions])
    if stiffer is not None:
        rest = stiffer.rest[own.first, own.second]
        out += rest[:, None]
        # a frequency is the root of a stiffness
        whole = 2 * max(bars, default=np.inf) * np.diag(stiffer.static)
        sure = np.sqrt(whole[own.first] * whole[own.second])
        alike = np.equal(*np.array(own.every)[[own.first, own.second], 0])
        band += np.where(alike, np.abs(rest), sure)[:, None]
    kind, unit_ = KINDS[derivatives]
    names = tuple(f"{_end(ends[k][0])} for {_end(ends[k][1])}" for k in kept)
    return Overlay(
        hertz,
        responses.values[kept][:, ahead],
        out * (1j * omega) ** derivatives,
        names,
        kind,
        unit_,
        limit,
        usual,
        constants,
        band * omega**derivatives if np.isfinite(bars).all() else None,
        None if stiffer is None else stiffer.waves,
    )


def _unit(natural: float | np.ndarray, omega: np.ndarray, ratio: float) -> np.ndarray:
    """Receptance of one kilogram on a spring."""
    return 1 / (natural**2 - omega**2 + 2j * ratio * natural * omega)


class _Ends(NamedTuple):
    """Ends of responses: point by its place, and direction -3 to 3.

    ``every`` of them once; ``first`` and ``second``, where each response was measured and driven.
    """

    every: list[tuple[int, int]]
    first: np.ndarray
    second: np.ndarray

    def along(self, motion: np.ndarray) -> np.ndarray:
        """(e,) motions (p, 3) of points along the directions of all ends."""
        return np.array([np.sign(way) * motion[at, abs(way) - 1] for at, way in self.every])


def _ends(
    body: Body, points: Mapping[int, Sequence[float]], pairs: list[tuple[tuple[int, int], ...]]
) -> tuple[SurfacePoints, _Ends]:
    """Points of some responses on the surface, and their ends there."""
    numbers = sorted({at for pair in pairs for at, _ in pair})
    places = SurfacePoints(body, numbers, np.array([points[n] for n in numbers]))
    every = sorted({end for pair in pairs for end in pair})
    first, second = ([every.index(pair[side]) for pair in pairs] for side in (0, 1))
    known = [(numbers.index(at), way) for at, way in every]
    return places, _Ends(known, np.array(first), np.array(second))


def _constants(fitted: ResponseFit, number: int) -> np.ndarray:
    """Products of shapes of unit mass at both ends of every response, by residues of accelerances
    (Ewins 2000, Modal Testing, eq. 4.30).
    """
    pole = fitted.fit.poles[number]
    return 2j * pole.imag * fitted.fit.residues[number] / pole**2


def _end(end: tuple[int, int]) -> str:
    return f"{end[0]}{'-' if end[1] < 0 else ''}{AXES[abs(end[1]) - 1]}"
