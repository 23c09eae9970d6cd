"""Amplitudes of a train over frequency, and the peaks read off them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from solidgear.trains.assembly.shaft import mix_label


class Peak(NamedTuple):
    """A peak of the mesh force."""

    frequency_hz: float
    force: float  #: amplitude, N
    mode: str


@dataclass(frozen=True, eq=False)
class OrderCurve:
    """Mesh force by an order of the transmission error."""

    order: int  #: counted from 1
    #: (f,) amplitude at the frequencies of the response, of the order itself, N
    force: np.ndarray
    peaks: tuple[Peak, ...]


@dataclass(frozen=True, eq=False)
class TrainResponse:
    """Amplitudes over frequency."""

    models: dict[str, str]  #: by shaft
    damping: str
    frequency_hz: np.ndarray  #: (f,) of the excitation; the mesh frequency of its first order
    #: by name and unit, such as ``mesh force [N]``, of the mesh whose error drives the train;
    #: harmonics of the mesh over the frequency of the first
    columns: dict[str, np.ndarray]
    orders: tuple[OrderCurve, ...]  #: mesh force order by order
    #: sentences on teeth whose mean force at the operating point is smaller than a dynamic one
    parting: tuple[str, ...]
    cautions: tuple[str, ...]
    seconds: float  #: to build and reduce both shafts
    #: relative error bars of frequencies by the meshes of harmonic shafts, by mode
    bars: dict[str, float] = field(default_factory=dict)
    name: str = ""  #: of the train, where two are compared

    @property
    def peaks(self) -> tuple[Peak, ...]:
        """Peaks of the mesh force by the first order."""
        return self.orders[0].peaks

    @property
    def label(self) -> str:
        """Name in a legend: the train, or the models of the shafts."""
        return self.name or mix_label(self.models)

    @property
    def force(self) -> np.ndarray:
        """(f,) dynamic mesh force, N, complex."""
        return self.columns["mesh force [N]"]


def figures(value: float) -> str:
    """Return a number with three figures, without a power of ten; as many as there are before the
    point.
    """
    return f"{value:.0f}" if value >= 1000 else f"{value:.3g}"
