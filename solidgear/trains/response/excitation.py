r"""Transmission errors that drive a train at one frequency: of one mesh, or of all that meet there.

Order n of a mesh of f1 periods in a turn of the engine meets order m of one with f2 where ``n f1 = m f2``.
With the errors ``Re(E exp(2 pi i n p))`` over their phases p (:mod:`solidgear.trains.assembly.mesh_phases`)
they are one sum of vectors there.  A stretch of teeth is positive where those of two shafts part, and
where those of planets press, so that errors of both kinds count with opposite signs.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from solidgear.core import SolidgearError
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.mesh_phases import MeshPhase, MeshPhases
from solidgear.trains.assembly.stages import phases_of
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh, error_of
from solidgear.trains.file.tables import ErrorTable

#: relative difference of two frequencies that are one
SAME = 1e-9
#: cycles that are whole ones
WHOLE = 1e-6
#: orders of a mesh at most
MOST_ORDERS = 20


@dataclass(frozen=True)
class Meeting:
    """Order of a further mesh that meets an order of the one that drives."""

    mesh: str
    order: int  #: of the mesh that drives
    own_order: int  #: of the further one
    #: error in step with the mesh that drives, m; None where its phase is not known
    error: complex | None


@dataclass(frozen=True)
class Excitation:
    """Transmission errors of one driver, and of further meshes in step with it.

    Attributes
    ----------
    error : ErrorTable
        Of the driver.
    lags : dict of str to float
        By which every mesh of the driver is behind the first, rad of the first order.
    further : tuple of Meeting
        Errors of further meshes, none by default.
    """

    error: ErrorTable
    lags: Mapping[str, float]
    further: tuple[Meeting, ...] = field(default=())

    @property
    def first(self) -> str:
        """Mesh that phases refer to."""
        return next(iter(self.lags))

    @property
    def orders(self) -> int:
        """Number of orders that drive."""
        return max(1, len(self.error.orders), *(meeting.order for meeting in self.further))

    @property
    def phases(self) -> tuple[float, ...]:
        """Phases of the orders of the driver, rad; none where it gives none."""
        if not self.error.phases:
            return ()
        return self.error.phases + (0.0,) * (self.orders - len(self.error.phases))

    def amplitude(self, frequency_hz: np.ndarray, order: int = 1) -> np.ndarray:
        """Return the (f,) amplitude that the weights of an order refer to, m."""
        if self.error.frequency:
            return np.interp(frequency_hz, self.error.frequency, self.error.amplitude)
        return np.full(len(frequency_hz), self._largest(order))

    def weights(self, order: int = 1) -> dict[str, complex]:
        """Return the error of every mesh that drives by an order, of the amplitude."""
        share = self._of_driver(order) / (self._largest(order) or 1.0)
        weights = {
            name: share * np.exp(-1j * order * lag) if lag else complex(share)
            for name, lag in self.lags.items()
        }
        for meeting in self.further:
            if meeting.order == order and meeting.error is not None:
                weights[meeting.mesh] = meeting.error / self._largest(order)
        return weights

    def _of_driver(self, order: int) -> float:
        if self.error.frequency:
            return 1.0
        return self.error.orders[order - 1] if order <= len(self.error.orders) else 0.0

    def _largest(self, order: int) -> float:
        """Return the error of the driver, of an order that it lacks the largest of others."""
        sizes = [abs(m.error or 0.0) for m in self.further if m.order == order]
        return self._of_driver(order) or max(sizes, default=0.0)


def excitation(assembly: Assembly, driver: Pair | PlanetMesh, together: bool = False) -> Excitation:
    """Return the errors that drive a train with a mesh, with those of all other meshes that meet its
    orders if `together`.

    Raises
    ------
    SolidgearError
        For a mesh without a transmission error, and together for one over frequency and for meshes
        whose phase is not known.
    """
    error, lags = error_of(driver), phases_of(driver, assembly.stages)
    if not together:
        return Excitation(error, lags)
    if error.frequency:
        raise SolidgearError(
            f"{driver.name} has a transmission error over frequency, which has no phase; give orders "
            "to drive by all meshes together"
        )
    further = tuple(meetings(assembly, driver))
    for meeting in further:
        if meeting.error is None:
            raise SolidgearError(f"{_met(driver.name, meeting)}; {unknown(assembly)}")
    return Excitation(error, lags, further)


def meetings(assembly: Assembly, driver: Pair | PlanetMesh) -> Iterator[Meeting]:
    """Yield the orders of other meshes that meet those of a driver."""
    train, lags = assembly.train, phases_of(driver, assembly.stages)
    first = next(iter(lags))
    phases = MeshPhases(assembly, first).by_mesh
    passing = train.per_turn(driver)
    for mesh in train.teeth:
        error = mesh.error
        if mesh.name in lags or error is None or not error.orders:
            continue
        for own_order, size in enumerate(error.orders, start=1):
            order = own_order * train.per_turn(mesh) / passing
            if not size or abs(order - round(order)) > SAME * order or order > MOST_ORDERS:
                continue
            meeting = round(order), own_order
            value = None
            if mesh.name in phases and first in phases:
                value = _in_step(mesh, driver, phases[mesh.name], phases[first], meeting)
            yield Meeting(mesh.name, *meeting, value)


def _in_step(
    mesh: Pair | PlanetMesh,
    driver: Pair | PlanetMesh,
    phase: MeshPhase,
    reference: MeshPhase,
    orders: tuple[int, int],
) -> complex | None:
    """Return the error of a mesh beside that of the driver, whose own is real; None where teeth may
    meet otherwise.
    """
    order, own_order = orders
    if any(abs(own_order * f - round(own_order * f)) > WHOLE for f in phase.freedom):
        return None
    error = error_of(mesh)
    turn = _turned(error, own_order, phase) / _turned(driver.error, order, reference)
    sign = 1 if isinstance(mesh, PlanetMesh) == isinstance(driver, PlanetMesh) else -1
    return complex(sign * error.orders[own_order - 1] * turn)


def _turned(table: ErrorTable | None, order: int, phase: MeshPhase) -> complex:
    """Return the unit vector of an order of an error in time."""
    given = () if table is None else table.phases
    angle = given[order - 1] if order <= len(given) else 0.0
    return complex(np.exp(1j * phase.way * (2 * np.pi * order * phase.pitches + angle)))


def meeting_cautions(
    assembly: Assembly, driver: Pair | PlanetMesh, together: bool
) -> Iterator[str]:
    """Yield a sentence on other meshes that drive at the same frequencies, or on none that do."""
    first = next(meetings(assembly, driver), None)
    if together and first is None:
        yield f"no other mesh drives at the frequencies of {driver.name}"
    if together or first is None:
        return
    remedy = unknown(assembly)
    if all(meeting.error is not None for meeting in meetings(assembly, driver)):
        remedy = "--together adds them up"
    yield f"{_met(driver.name, first)}, and {driver.name} drives alone here; {remedy}"


def _met(driver: str, meeting: Meeting) -> str:
    return (
        f"order {meeting.order} of {driver} has the frequency of order {meeting.own_order} of "
        f"{meeting.mesh}"
    )


def unknown(assembly: Assembly) -> str:
    """Return what a file needs to tie the phases of its meshes."""
    gears = next(
        (
            f"{listed_gears} of the {side}"
            for side, shaft in assembly.train.shafts.items()
            if len(shaft.gears) > 1 and any(gear.angle is None for gear in shaft.gears.values())
            for listed_gears in [" and ".join(shaft.gears)]
        ),
        "",
    )
    if not gears:
        return "how their teeth stand to each other is not known"
    return f"how their teeth stand to each other is not known: give the angle of the gears {gears}"
