"""Amplitudes of a train over frequency, and what is read off them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.studies.train.shaft import told_mix


@dataclass(frozen=True)
class Peak:
    """A peak of the mesh force.

    Attributes
    ----------
    force : float
        Amplitude, N.
    mode : str
        That makes it.
    """

    frequency_hz: float
    force: float
    mode: str


@dataclass(frozen=True, eq=False)
class OrderCurve:
    """Mesh force by one order of the transmission error.

    Attributes
    ----------
    order : int
        Counted from 1.
    force : (f,) ndarray
        Amplitude at the frequencies of the response, which are those of the order itself, N.
    peaks : tuple of Peak
    """

    order: int
    force: np.ndarray
    peaks: tuple[Peak, ...]


@dataclass(frozen=True, eq=False)
class TrainResponse:
    """Amplitudes over frequency.

    Attributes
    ----------
    models : dict of str to str
        By shaft.
    frequency_hz : (f,) ndarray
        Of the excitation; the mesh frequency of its first order.
    columns : dict of str to (f,) complex ndarray
        By name and unit, such as ``mesh force [N]``, of the mesh whose error drives the train;
        harmonics of the mesh over the frequency of the first.
    orders : tuple of OrderCurve
        Mesh force order by order.
    parting : tuple of str
        Sentences on teeth whose mean force at the operating point is smaller than a dynamic one.
    seconds : float
        To build and reduce both shafts.
    name : str
        Of the train, where it is shown beside another one.
    """

    models: dict[str, str]
    damping: str
    frequency_hz: np.ndarray
    columns: dict[str, np.ndarray]
    orders: tuple[OrderCurve, ...]
    parting: tuple[str, ...]
    cautions: tuple[str, ...]
    seconds: float
    name: str = ""

    @property
    def peaks(self) -> tuple[Peak, ...]:
        """Peaks of the mesh force by the first order."""
        return self.orders[0].peaks

    @property
    def label(self) -> str:
        """Name in a legend: the train, or the models of its shafts."""
        return self.name or told_mix(self.models)

    @property
    def force(self) -> np.ndarray:
        """(f,) dynamic mesh force, N, complex."""
        return self.columns["mesh force [N]"]


def figures(value: float) -> str:
    """Three figures, without a power of ten; as many as there are before the point."""
    return f"{value:.0f}" if value >= 1000 else f"{value:.3g}"
