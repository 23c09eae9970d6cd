"""Measured responses with the modes that were found in them, and shapes of those."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from solidgear.core import SolidgearError
from solidgear.core.meshing.placing import Placing
from solidgear.measured.modal_fit import ModalFit, fit_modes
from solidgear.measured.universal import Responses, Shapes

#: standard deviation to which a frequency repeats, relative, whatever the noise: the modulus of steel falls
#: by some 0.03 % a kelvin, so that 1.3 K are as much, as are 0.4 g of accelerometer or cord that move with a
#: kilogram
REPEATS = 2e-4


@dataclass(frozen=True, eq=False)
class ResponseFit:
    """Responses, and their modes."""

    repeats: ClassVar[float] = REPEATS

    responses: Responses
    fit: ModalFit
    shapes: Shapes | None  #: none where the file gives no places of its points

    @classmethod
    def of(cls, responses: Responses) -> ResponseFit:
        """Find the modes of responses over an axis that ascends."""
        hertz = responses.frequencies
        if not np.all(np.isfinite(hertz)) or not np.all(np.diff(hertz) > 0):
            raise SolidgearError("has frequencies of responses that do not ascend")
        # accelerance is a sum over poles and a polynomial; of a displacement rigid motions are not
        missing = 2 - (2 if responses.derivatives is None else responses.derivatives)
        fit = fit_modes(hertz, responses.values * (2j * np.pi * hertz) ** missing)
        return cls(responses, fit, _shapes(responses, fit) if responses.places else None)

    @property
    def widths_hz(self) -> np.ndarray:
        """(n,) standard deviations of frequencies, of noise and of repeatability."""
        return np.hypot(self.fit.deviations[0], self.repeats * self.fit.frequencies)

    def placed(self, placing: Placing) -> ResponseFit:
        """Return the same in the frame of a scene."""
        shapes = self.shapes and self.shapes.placed(placing)
        return replace(self, responses=self.responses.placed(placing), shapes=shapes)

    @property
    def remarks(self) -> Iterator[str]:
        """Sentences on parts of the file that may be meant otherwise, and on missing ones."""
        yield from self.responses.remarks
        if self.responses.places and not self.responses.scaled:
            yield (
                "The file gives no unit of its responses (dataset 164, or labels of axes), so "
                "they are not drawn over computed ones; give it by a TOML file with file = and "
                'response_unit = "m/s^2/N".'
            )


def moving(responses: Responses) -> list[tuple[int, tuple[int, int]]]:
    """Return responses of one shape, each with the point and the direction of it: those to one
    reference, or, where the hammer went round, those at one point.
    """
    fixed = [Counter(responses.references), Counter(responses.points)]
    (reference, count), (point, many) = (ends.most_common(1)[0] for ends in fixed)
    if count >= many:
        selected = [
            (k, end)
            for k, end in enumerate(responses.points)
            if responses.references[k] == reference
        ]
    else:
        selected = [
            (k, end) for k, end in enumerate(responses.references) if responses.points[k] == point
        ]
    return [(k, end) for k, end in selected if 1 <= abs(end[1]) <= 3]


def _shapes(responses: Responses, fit: ModalFit) -> Shapes | None:
    selected = moving(responses)
    if not selected:
        return None
    numbers = sorted({number for _, (number, _) in selected})
    missing = [number for number in numbers if number not in responses.places]
    if missing:
        raise SolidgearError(f"gives no place of point {missing[0]} (dataset 15 or 2411)")
    values = np.zeros((len(fit.poles), len(numbers), 3), complex)
    for k, (number, direction) in selected:
        along = abs(direction) - 1
        values[:, numbers.index(number), along] = np.sign(direction) * fit.residues[:, k]
    places = np.array([responses.places[number] for number in numbers])
    return Shapes(np.array(numbers), places, values, responses.length)
