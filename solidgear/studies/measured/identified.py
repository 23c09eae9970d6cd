"""Parameters identified from measured resonances, in numbers and words."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from solidgear.display import Displayed
from solidgear.scene.paths import Tables
from solidgear.studies.measured.correlate import SURE
from solidgear.studies.measured.same_part import Likeness

#: relative; at a bound
EDGE = 1e-6
#: a deviation that is more than this of the one beforehand is no news; and values this many
#: deviations from what was known contradict it
LITTLE, FAR = 0.9, 3.0
#: of the fitted resonances: as many left out are few
FEW = 0.3


@dataclass(frozen=True)
class Identified:
    """An entry of the scene."""

    path: str
    #: before, value: SI; as in the file, and what the data say
    before: float
    value: float
    deviation: float  #: standard deviation of its logarithm
    #: low, high: ends of the interval of 95 %, cut off at bounds
    low: float
    high: float
    #: what was known beforehand: value, and standard deviation of its logarithm
    prior: tuple[float, float] | None = None

    @property
    def at_bound(self) -> bool:
        """Tell whether a bound holds it where it is."""
        return self.value <= self.low * (1 + EDGE) or self.value >= self.high * (1 - EDGE)

    @property
    def untold(self) -> bool:
        """Tell whether the data add nothing to what was known beforehand."""
        return self.prior is not None and self.deviation > LITTLE * self.prior[1]


@dataclass(frozen=True)
class Fitted:
    """A measured resonance and what the identified scene has there."""

    name: str
    #: measured, computed: Hz
    measured: float
    computed: float
    #: what is predicted where this resonance is left out of the fit, Hz; None where the others do
    #: not tell it
    left_out: float | None


@dataclass(frozen=True)
class Predicted:
    """A mode beyond the measured ones."""

    name: str
    multiplicity: int
    frequency_hz: float
    #: standard deviation: of the entries, of the scatter of the fit and of the mesh
    deviation_hz: float


@dataclass(frozen=True, repr=False, eq=False)
class Identification(Displayed):
    """Entries identified from measured resonances."""

    shown: ClassVar[str] = "identification"

    scene: str
    title: str
    entries: tuple[Identified, ...]
    correlations: np.ndarray  #: (p, p) between entries
    fitted: tuple[Fitted, ...]  #: resonances that were fitted
    unpaired: tuple[float, ...]  #: hz; those that were not, since no mode is surely theirs
    rms: float  #: relative differences of fit
    #: of each resonance predicted from the others; None where they tell none
    rms_left_out: float | None
    predicted: tuple[Predicted, ...]
    mesh: str
    tables: Tables  #: of the scene file with the values put in
    likeness: Likeness  #: whether the resonances can be those of this part
    remarks: tuple[str, ...] = ()  #: on how the file of resonances was read
    alike: tuple[tuple[float, ...], ...] = ()  #: other values of all entries, SI, that fit as well

    def __getitem__(self, path: str) -> Identified:
        return next(one for one in self.entries if one.path == path)

    @property
    def sentences(self) -> list[str]:
        """Conclusions."""
        return list(_sentences(self))

    @property
    def results(self) -> dict[str, Any]:
        """Plain data that JSON can hold, SI."""
        return {
            "kind": "identification",
            "scene": self.scene,
            "measurement": self.title,
            "mesh": self.mesh,
            "entries": [vars(one) for one in self.entries],
            "fit_alike": [list(one) for one in self.alike],
            "correlations": self.correlations.tolist(),
            "other_part": self.likeness.results,
            "fitted": [vars(one) for one in self.fitted],
            "unpaired_hz": list(self.unpaired),
            "rms": self.rms,
            "rms_left_out": self.rms_left_out,
            "predicted": [vars(one) for one in self.predicted],
            "sentences": self.sentences,
        }


def _sentences(found: Identification) -> Iterator[str]:
    if found.likeness.sentence:
        yield found.likeness.sentence
    for one in found.entries:
        yield (
            f"{one.path} = {one.value:.6g} (SI), standard deviation {100 * one.deviation:.2g} %; "
            f"the file has {one.before:.6g}."
        )
        if one.at_bound:
            yield f"{one.path} is held by its bound: the data ask for a value beyond it."
        if one.prior is not None:
            yield from _beside_prior(one, *one.prior)
    for values in found.alike:
        told = ", ".join(f"{e.path} = {v:.6g}" for e, v in zip(found.entries, values))
        yield (
            f"Not the only answer: {told} (SI) fits these resonances as well; measure shapes, or "
            "further modes, to tell which."
        )
    yield f"{len(found.fitted)} resonances fitted: {100 * found.rms:.2g} % rms" + (
        "."
        if found.rms_left_out is None
        else f"; each predicted from the others: {100 * found.rms_left_out:.2g} % rms."
    )
    if alone := [one.name for one in found.fitted if one.left_out is None]:
        yield (
            f"No other resonance tells {', '.join(alone)}, whose fit proves nothing: measure more that "
            "the same entries move."
        )
    if found.unpaired:
        told = ", ".join(f"{one:.6g}" for one in found.unpaired)
        yield f"Left out, since no mode is surely theirs: {told} Hz."
        if len(found.unpaired) > FEW * len(found.fitted):
            yield (
                "So many left out may hide values that fit better: begin nearer, lower --tol, or "
                "measure shapes."
            )
    yield from found.remarks
    alike = np.abs(found.correlations - np.eye(len(found.entries)))
    if len(found.entries) > 1 and alike.max() > SURE:
        i, j = np.unravel_index(int(alike.argmax()), alike.shape)
        yield (
            f"{found.entries[i].path} and {found.entries[j].path} move the same resonances alike "
            f"(correlation {found.correlations[i, j]:+.2f}): their ratio is known worse than either "
            "with the other held."
        )


def _beside_prior(one: Identified, middle: float, deviation: float) -> Iterator[str]:
    known = f"{middle:.6g}, known to {100 * deviation:.2g} % beforehand"
    if one.untold:
        yield f"The data leave {one.path} open: it is as it was, {known}."
    away = abs(math.log(one.value / middle)) / deviation
    if away > FAR:
        yield f"{one.path} lies {away:.2g} standard deviations from {known}: one of both is wrong."
