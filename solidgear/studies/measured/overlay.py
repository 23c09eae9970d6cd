"""Responses of a scene at the points where it was measured: a sum over its modes, rigid motions
among them, with the damping that was measured.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.studies.measured.computed import motions_up_to
from solidgear.studies.measured.correlate import Correlation
from solidgear.studies.measured.responses import ResponseFit
from solidgear.studies.measured.shapes import SurfacePoints

#: of the highest measured frequency: modes up to there count
BEYOND = 2.0
#: what is over a force, by derivatives of the displacement, and its unit
KINDS = (("receptance", "m/N"), ("mobility", "m/s/N"), ("accelerance", "m/s^2/N"))
AXES = "xyz"


@dataclass(frozen=True, eq=False)
class Overlay:
    """Measured and computed responses.

    Attributes
    ----------
    hertz : (k,) ndarray
    measured, computed : (n, k) ndarray of complex
        SI.
    names : tuple of str
        Of the responses: point and direction, and where it was driven.
    kind, unit : str
    limit : float
        Hz; stiffer modes are left out.
    damping : float
        Ratio of modes that were not measured, the median of those that were.
    constants : mapping of int to float
        Number of a pair -> computed modal constant over the measured one, of all responses.
    """

    hertz: np.ndarray
    measured: np.ndarray
    computed: np.ndarray
    names: tuple[str, ...]
    kind: str
    unit: str
    limit: float
    damping: float
    constants: dict[int, float]

    @property
    def told(self) -> str:
        """How the computed ones were made, in words."""
        return (
            f"Computed: the modes up to {self.limit:.0f} Hz and the rigid motions that nothing "
            "holds, each with the damping measured of it, others with the median, "
            f"{100 * self.damping:.2g} %. What is stiffer is left out, which moves minima more than "
            "peaks; the computed response has no bar."
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

    Raises
    ------
    SolidgearError
        For a point that is off the surface.
    """
    fitted, computed = found.measured.responses, found.computed
    if fitted is None:
        return None
    responses, derivatives = fitted.responses, fitted.responses.derivatives
    if not responses.places or derivatives is None:
        return None
    ends = list(zip(responses.points, responses.references))
    kept = [
        k
        for k, pair in enumerate(ends)
        if all(1 <= abs(way) <= 3 and at in responses.places for at, way in pair)
    ]
    if not kept:
        return None
    numbers = sorted({at for k in kept for at, _ in ends[k]})
    places = SurfacePoints(computed.body, numbers, np.array([responses.places[n] for n in numbers]))
    limit = BEYOND * found.pairs[-1].measured.frequency
    ahead = responses.frequencies > 0
    hertz = responses.frequencies[ahead]
    own = {pair.computed.name: pair.number - 1 for pair in found.pairs if pair.computed is not None}
    usual = float(np.median(fitted.fit.damping))
    out = np.zeros((len(kept), len(hertz)), complex)
    constants: dict[int, float] = {}
    omega = 2 * np.pi * hertz
    for mode in motions_up_to(computed, limit):
        constant = np.zeros(len(kept))
        for vector in mode.vectors:
            motion = places.of(vector)
            one, other = ([_along(motion, numbers, ends[k][side]) for k in kept] for side in (0, 1))
            constant += np.multiply(one, other)
        number = own.get(str(mode.name))
        ratio = usual if number is None else float(fitted.fit.damping[number])
        natural = 2 * np.pi * mode.frequency_hz
        out += constant[:, None] / (natural**2 - omega**2 + 2j * ratio * natural * omega)
        if number is not None:
            measured = _constants(fitted, number)[kept]
            constants[number + 1] = float(
                abs(np.vdot(measured, constant)) / np.sum(np.abs(measured) ** 2)
            )
    kind, unit = KINDS[derivatives]
    names = tuple(f"{_end(ends[k][0])} for {_end(ends[k][1])}" for k in kept)
    return Overlay(
        hertz,
        responses.values[kept][:, ahead],
        out * (1j * omega) ** derivatives,
        names,
        kind,
        unit,
        limit,
        usual,
        constants,
    )


def _constants(fitted: ResponseFit, number: int) -> np.ndarray:
    """Products of shapes of unit mass at both ends of every response, by residues of accelerances
    (Ewins 2000, Modal Testing, eq. 4.30).
    """
    pole = fitted.fit.poles[number]
    return 2j * pole.imag * fitted.fit.residues[number] / pole**2


def _along(motion: np.ndarray, numbers: list[int], end: tuple[int, int]) -> float:
    """Motion of a point along the direction of a measurement."""
    return float(np.sign(end[1]) * motion[numbers.index(end[0]), abs(end[1]) - 1])


def _end(end: tuple[int, int]) -> str:
    return f"{end[0]}{'-' if end[1] < 0 else ''}{AXES[abs(end[1]) - 1]}"
