r"""Train with losses that a transmission error drives, or forces on its ports.

The teeth carry ``F_m = k_m (1 + i eta) (dte - e)`` with the dynamic transmission error ``dte = h_p
q_p - h_g q_g`` and the unloaded one e (Hua 2010, equations 9 to 13 and 19 to 24), so that e pushes
like the load ``h' k_m (1 + i eta) e``.  Bearings push back with their stiffness, loss included,
times the motion of the seats: all six components, the whole row and not the diagonal alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solidgear.core import DOF_NAMES, Scene, SolidgearError, System, as_supports, show
from solidgear.core.system.modes import SystemModes
from solidgear.core.system.steady import SteadyState, peaks, stands_out
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.components import FORCE_UNITS, MOTION_UNITS, six_columns
from solidgear.trains.assembly.housing import mount_rows, seat_motion
from solidgear.trains.assembly.stages import mesh_row, phases_of
from solidgear.trains.file.housing import HOUSING
from solidgear.trains.file.train import Train
from solidgear.trains.modes.modes import refuse_unresolved
from solidgear.trains.modes.naming import mode_names
from solidgear.trains.response.excitation import Excitation, excitation
from solidgear.trains.response.response import OrderCurve, Peak

#: unit of accelerations
ACCELERATION = "m/s²"
#: readings of the losses of a file: the three kinds, and the thesis's C = zeta K to the letter
DAMPING = ("hysteretic", "viscous", "modal", "literal")
#: the first frequency of a response, over the first elastic one
BEGIN = 0.25
#: half-widths from a natural frequency, and share of it where losses are small, within which a top is
#: called after its mode; and the word for one that is near none
NEAR, LEAST_NEAR = 4.0, 0.02
NO_MODE = "none near: several together"
#: peaks of a mesh force; a train has some tens of modes in any range
MOST_PEAKS = 400
#: rpm of a rad/s
RPM = 30 / np.pi
#: points between the neighbours of the top of a peak
TOP = 17


class Drive:
    """A train by models of the shafts with losses and excitation: forces (6,) at ports, N
    and N m, or the transmission error of a mesh, by default of the first, with those of all other
    meshes at the same frequencies if `together`; viscous losses are matched at a frequency, Hz.
    """

    def __init__(
        self,
        assembly: Assembly,
        *models: str,
        damping: str = "hysteretic",
        matched_hz: float = 0.0,
        forces: Mapping[str, np.ndarray] | None = None,
        mesh: str | None = None,
        together: bool = False,
    ):
        if damping not in DAMPING:
            raise SolidgearError(
                f"damping {show(damping, 30)} is unknown; use one of {', '.join(DAMPING)}"
            )
        self.assembly, self.models, self.damping = assembly, models, damping
        self.system: System = assembly.system(*models)
        self.pair = assembly.train.named_mesh(mesh)
        self._named: dict[int, tuple[SystemModes, list[str]]] = {}
        loss, kind = assembly.loss_factors(), damping
        if damping == "literal":
            loss = {name: eta / 2 for name, eta in loss.items()}
            kind, matched_hz = "viscous", 1 / (2 * np.pi)
        self.steady = SteadyState(self.system, loss, kind, matched_hz)
        self.meshes = {
            teeth.name: mesh_row(self.system, teeth.name) for teeth in assembly.train.teeth
        }
        self.rows = {name: row for name, (row, _) in self.meshes.items()}
        self.together = together
        self.first = next(iter(phases_of(self.pair, assembly.stages)))
        self.row, self.stiffness = self.meshes[self.first]
        self.forces = dict(forces or {})
        self.load = self._load()

    @cached_property
    def excitation(self) -> Excitation:
        """Transmission errors that drive the train; refused where the file has none."""
        return excitation(self.assembly, self.pair, self.together)

    def _load(self, order: int = 1) -> np.ndarray:
        """Return the (N,) load of forces, or of an error of 1 m where it drives, each behind by a
        phase.
        """
        if self.forces:
            return self.system.load(self.forces)
        weights = self.excitation.weights(order)
        rows = [weight * self.meshes[n][1] * self.meshes[n][0] for n, weight in weights.items()]
        return np.sum(rows, axis=0)

    def motion(self, frequency_hz: np.ndarray, rows: np.ndarray, order: int = 1) -> np.ndarray:
        """Return (f, q) motions at a frequency of excitation."""
        load = self.load if order == 1 else self._load(order)
        unit = self.steady.motion(frequency_hz, load, rows)
        if self.forces:
            return unit
        scale = self.excitation.amplitude(frequency_hz, order) * self.steady.factor(
            self.first, frequency_hz
        )
        return unit * scale[:, None]

    def mesh(self, frequency_hz: np.ndarray, order: int = 1) -> tuple[np.ndarray, np.ndarray]:
        """Return (f,) dynamic transmission error, m, and mesh force, N."""
        dte = self.motion(frequency_hz, self.row[None], order)[:, 0]
        return self._teeth(frequency_hz, dte, order)

    def _teeth(
        self, frequency_hz: np.ndarray, dte: np.ndarray, order: int = 1
    ) -> tuple[np.ndarray, np.ndarray]:
        error = 0.0 if self.forces else self._error(self.first, frequency_hz, order)
        factor = self.stiffness * self.steady.factor(self.first, frequency_hz)
        return dte, factor * (dte - error)

    def _error(self, mesh: str, frequency_hz: np.ndarray, order: int = 1) -> np.ndarray:
        """Return the (f,) transmission error of a mesh that drives, m; 0 of another."""
        weight = self.excitation.weights(order).get(mesh, 0.0)
        return weight * self.excitation.amplitude(frequency_hz, order)

    def reactions(self, frequency_hz: np.ndarray) -> dict[str, np.ndarray]:
        """Return (f, 6) forces of every bearing on its shaft, in the axes of that shaft, by ``side
        bearing``.
        """
        rows = self._reaction_rows()
        motions = self.motion(frequency_hz, np.vstack([force for _, force in rows.values()]))
        return self._reactions(frequency_hz, rows, motions)

    def _reaction_rows(self) -> dict[str, tuple[str, np.ndarray]]:
        """Return link and rows (6, N) of the elastic force of every bearing, by ``side bearing``."""
        out = {}
        for side in self.assembly.scenes:
            supports = as_supports(self.assembly.scenes[side])
            train, system = self.assembly.train, self.system
            seats = np.vstack([seat_motion(train, system, side, name) for name in supports.ports])
            link = next(n for n in self.system.links if n.startswith(f"{side}."))
            force = -np.array(supports.stiffness) @ seats
            for k, name in enumerate(supports.ports):
                if np.any(supports.stiffness[6 * k : 6 * k + 6]):
                    out[f"{side} bearing {name}"] = (link, force[6 * k : 6 * k + 6])
        return out

    def _reactions(self, frequency_hz, rows, motions) -> dict[str, np.ndarray]:
        """Return reactions from the motions (f, 6 b) of their rows, losses included."""
        return {
            name: motions[:, 6 * k : 6 * k + 6] * self.steady.factor(link, frequency_hz)[:, None]
            for k, (name, (link, _)) in enumerate(rows.items())
        }

    def columns(self, frequency_hz: np.ndarray) -> dict[str, np.ndarray]:
        """Return all columns of the first order, by name and unit: the mesh that drives, reactions
        of every bearing, motions of all main lumped points, forces of other meshes, and
        amplitudes of the housing.
        """
        reactions, scenes = self._reaction_rows(), self.assembly.scenes
        ports = {side: f"{side}.{scene.port.name}" for side, scene in scenes.items()}
        rows = [self.row[None], *(force for _, force in reactions.values())]
        rows += [self.system.motion(port) for port in ports.values()]
        other_meshes = [teeth for teeth in self.assembly.train.teeth if teeth.name != self.first]
        rows += [self.rows[pair.name][None] for pair in other_meshes]
        motions = self.motion(frequency_hz, np.vstack(rows))
        dte, force = self._teeth(frequency_hz, motions[:, 0])
        out = {"dynamic transmission error [m]": dte, "mesh force [N]": force}
        for name, reaction in self._reactions(frequency_hz, reactions, motions[:, 1:]).items():
            out |= six_columns(name, FORCE_UNITS, reaction)
        displacements = motions[:, 1 + 6 * len(reactions) :]
        for k, side in enumerate(ports):
            out |= six_columns(side, MOTION_UNITS, displacements[:, 6 * k : 6 * k + 6])
        for pair, stretch in zip(other_meshes, displacements.T[6 * len(ports) :]):
            factor = self.meshes[pair.name][1] * self.steady.factor(pair.name, frequency_hz)
            if not self.forces:
                stretch = stretch - self._error(pair.name, frequency_hz)
            out[f"mesh force{pair.label} [N]"] = factor * stretch
        return out | housing_columns(self, frequency_hz)

    def grid(
        self,
        highest_hz: float,
        lowest_hz: float | None = None,
        motions_of: Callable[[np.ndarray], np.ndarray] | None = None,
    ) -> np.ndarray:
        """Return frequencies on which no peak of the last of some motions (f, q) is missed; by
        default dynamic transmission error and mesh force.
        """
        refuse_unresolved(self.assembly, self.system, highest_hz)
        first = float(self.system.elastic[0][0] / (2 * np.pi))
        lowest = lowest_hz or min(BEGIN * first, highest_hz / 100)
        motions_of = motions_of or self._peak_motions
        points = self.steady.grid(lowest, highest_hz, motions_of)
        tops = peaks(np.abs(motions_of(points)[:, -1]))
        if len(tops) > MOST_PEAKS:
            raise SolidgearError(
                f"the response has {len(tops)} peaks, all rounding, since a spring or an inertia "
                "is far larger or smaller than the others; check their units"
            )
        fine = [np.linspace(points[k - 1], points[k + 1], TOP) for k in tops]
        ends = [hz for hz in self._highest_orders() if lowest < hz < highest_hz]
        return np.unique(np.concatenate([points, *fine, ends]))

    def _peak_motions(self, frequency_hz: np.ndarray) -> np.ndarray:
        """Return (f, q) motions whose peaks a grid may not miss; orders of one mesh have the same."""
        several = not self.forces and len(self.excitation.weights()) > 1
        orders = range(2, self.orders + 1) if several or self.together else ()
        forces = [self.mesh(frequency_hz, order)[1] for order in orders]
        return np.column_stack(
            [*housing_amplitudes(self, frequency_hz), *forces, *self.mesh(frequency_hz)]
        )

    def _highest_orders(self) -> list[float]:
        """Return frequencies of all orders at the highest speed in the files, Hz."""
        speed = None if self.forces else highest_speed(self.assembly.train, self.assembly.scenes)
        first = 0.0 if speed is None else speed.rpm * self.assembly.train.per_turn(self.pair) / 60
        return [order * first for order in range(1, self.orders + 1)]

    @property
    def orders(self) -> int:
        """Number of orders that drive the train."""
        return 1 if self.forces else self.excitation.orders

    def over_cycle(self, frequency_hz: np.ndarray, highest_hz: float) -> list[np.ndarray]:
        """Return the (f,) mesh force of every order at frequencies of the mesh, N; NaN of an order
        beyond the highest frequency.
        """
        out = []
        for order in range(1, self.orders + 1):
            inside = order * frequency_hz <= highest_hz
            force = np.full(len(frequency_hz), np.nan + 0j)
            force[inside] = self.mesh(order * frequency_hz[inside], order)[1]
            out.append(force)
        return out

    def curve(self, frequency_hz: np.ndarray, order: int = 1) -> OrderCurve:
        """Return the mesh force by an order, the peaks each with the mode that makes it."""
        force = np.abs(self.mesh(frequency_hz, order)[1])
        load = self.load if order == 1 else self._load(order)
        tops = self.tops(frequency_hz, force, self.row, load)
        peaks = tuple(Peak(hz, size, mode) for hz, size, mode in tops)
        return OrderCurve(order, force, peaks)

    def named_modes(self, n: int, bounded: int = 0) -> tuple[SystemModes, list[str]]:
        """Return the lowest elastic modes of the train, some of them with a bound, and free
        motions, with their names; solved once.
        """
        if n not in self._named:
            modes = self.system.modes(n, bounded=bounded)
            self._named[n] = modes, mode_names(self.assembly, self.system, modes)
        return self._named[n]

    def reach(self, highest_hz: float) -> int:
        """Return the number of elastic modes that name a response up to a frequency."""
        return max(1, int((self.system.elastic[0] <= 4 * np.pi * highest_hz).sum()))

    def tops(
        self,
        frequency_hz: np.ndarray,
        size: np.ndarray,
        row: np.ndarray,
        load: np.ndarray | None = None,
    ) -> list[tuple[float, float, str]]:
        """Return frequency, size and mode of every peak of an amplitude (f,) of the motion `row`
        (N,), under a load (N,) that is by default that of the first order.
        """
        load = self.load if load is None else load
        omega, shapes = self.system.elastic
        count = self.reach(frequency_hz[-1])
        modes, all_names = self.named_modes(count)
        names = all_names[modes.rigid :]
        share = (row @ shapes[:, :count]) * (shapes[:, :count].T @ load)
        losses = [self.steady.loss.get(name, 0.0) * share for name, share in modes.energy.items()]
        lost = np.sum(losses, axis=0)[modes.rigid :]
        out = []
        for k in peaks(size):
            if not stands_out(size, k):
                continue
            w = 2 * np.pi * frequency_hz[k]
            # a peak is made by the term that changes fastest there, not by the largest:
            # far modes give much of the force, but the same everywhere
            gap = omega[:count] ** 2 * (1 + 1j * lost) - w**2
            # a broad top between two of them is of neither
            width = np.maximum(NEAR * lost / 2, LEAST_NEAR) * omega[:count]
            near = np.abs(omega[:count] - w) <= width
            fast = np.where(near, np.abs(share / gap**2), -1.0)
            name = names[fast.argmax()] if near.any() else NO_MODE
            out.append((float(frequency_hz[k]), float(size[k]), name))
        return out


def housing_columns(drive: Drive, frequency_hz: np.ndarray) -> dict[str, np.ndarray]:
    """Return amplitudes of the housing over frequency, by name and unit: loads on every mount,
    motions and accelerations of the centre of mass and of named points; none without
    a housing. Magnitudes are the root of the sum of squares of the amplitudes in all three
    directions.
    """
    train, system = drive.assembly.train, drive.system
    out: dict[str, np.ndarray] = {}
    if train.housing is None:
        return out
    loads = mount_rows(train, system)
    places = train.housing.free_points
    rows = [*loads.values(), *(system.motion(f"{HOUSING}.{place}") for place in places)]
    motions = np.split(drive.motion(frequency_hz, np.vstack(rows)), len(rows), axis=1)
    for name, load in zip(loads, motions):
        factor = drive.steady.factor(f"mount {name}", frequency_hz)
        force = load * factor[:, None]
        out[f"mount {name} force [N]"] = _magnitude(force)
        out |= six_columns(f"mount {name}", FORCE_UNITS, force)
    square = -((2 * np.pi * frequency_hz[:, None]) ** 2)
    for place, motion in zip(places, motions[len(loads) :]):
        name, acceleration = f"{HOUSING} {place}", square * motion
        out[f"{name} acceleration [{ACCELERATION}]"] = _magnitude(acceleration)
        out |= {
            f"{name} acceleration {dof} [{ACCELERATION}]": acceleration[:, k]
            for k, dof in enumerate(DOF_NAMES[:3])
        }
        out |= six_columns(name, MOTION_UNITS, motion)
    return out


def housing_amplitudes(drive: Drive, frequency_hz: np.ndarray) -> list[np.ndarray]:
    """Return columns (f,) of forces on mounts and accelerations of points, in all three directions
    together.
    """
    columns = housing_columns(drive, frequency_hz)
    return [columns[name] for name in columns if " force [" in name or " acceleration [" in name]


def _magnitude(values: np.ndarray) -> np.ndarray:
    """Return the (f,) size of the first three components."""
    return np.linalg.norm(values[:, :3], axis=1).astype(complex)


@dataclass(frozen=True)
class GivenSpeed:
    """A speed of the engine's shaft in the files."""

    rpm: float  #: zero where all that is given stands still
    source: str  #: where it stands


def highest_speed(train: Train, scenes: Mapping[str, Scene]) -> GivenSpeed | None:
    """Return the highest speed that the files of a train and of the shafts give; None where none does."""
    return max(_speeds(train, scenes), key=lambda speed: speed.rpm, default=None)


def _speeds(train: Train, scenes: Mapping[str, Scene]) -> Iterator[GivenSpeed]:
    """Yield the speeds that the files give, and the place of each in the files."""
    for point in train.operation:
        if (speed := point.speed_of(train.reference, train.turns)) is not None:
            source = f"operation {point.name!r}" if point.name else "the operation"
            yield GivenSpeed(abs(speed) * RPM, source)
    for side, turns_of_shaft in train.turns.items():
        turns, oil = 1 / turns_of_shaft, scenes[side].lubrication
        if oil is not None and oil.speed:
            yield GivenSpeed(abs(turns * oil.speed) * RPM, f"lubrication of the {side}")
        for bearing in scenes[side].bearings:
            if bearing.catalogue is not None and bearing.catalogue.speed:
                speed = abs(turns * bearing.catalogue.speed) * RPM
                yield GivenSpeed(speed, f"bearing {bearing.name!r} of the {side}")
