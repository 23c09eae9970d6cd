r"""Steady response of a train to its transmission error, or to forces on its ports.

The teeth carry ``F_m = k_m (1 + i eta) (dte - e)`` with the dynamic transmission error ``dte = h_p
q_p - h_g q_g`` and the unloaded one e (Hua 2010, equations 9 to 13 and 19 to 24), so that e pushes
like the load ``h' k_m (1 + i eta) e``.  Bearings push back with their stiffness, loss included,
times what their seats move: all six components, the whole row and not the diagonal alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property

import numpy as np

from solidgear.body import as_supports
from solidgear.errors import SolidgearError, show
from solidgear.machine.threads import pinned
from solidgear.scene.planetary import error_of
from solidgear.scene.train_tables import ErrorTable
from solidgear.studies.train.components import FORCE_UNITS, MOTION_UNITS, six
from solidgear.studies.train.housing import columns_of, felt, seat_motion
from solidgear.studies.train.local import local_lines
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.modes import refuse_unresolved
from solidgear.studies.train.naming import mode_names
from solidgear.studies.train.parting import parting_lines
from solidgear.studies.train.response import OrderCurve, Peak, TrainResponse
from solidgear.studies.train.speeds import fastest
from solidgear.studies.train.spin import spin_cautions
from solidgear.studies.train.stages import mesh_row, phases_of
from solidgear.system.modes import SystemModes
from solidgear.system.steady import SteadyState, peaks, stands_out
from solidgear.system.system import System

#: readings of the losses of a file: the three kinds, and the thesis's C = zeta K to the letter
DAMPING = ("hysteretic", "viscous", "modal", "literal")
#: the first frequency of a response, over the first elastic one
BEGIN = 0.25
#: half-widths from a natural frequency, and share of it where losses are small, within which a top is
#: called after its mode; and what is told of one that is near none
NEAR, LEAST_NEAR = 4.0, 0.02
NO_MODE = "none near: several together"
#: peaks of a mesh force; a train has some tens of modes in any range
MOST_PEAKS = 400
#: points between the neighbours of the top of a peak
TOP = 17

LITERAL = (
    "damping: C = zeta K is read to the letter, so that the ratios count as seconds; "
    "at {0:.0f} Hz the mesh then has a loss factor of {1:.0f}. Read them as loss factors 2 zeta "
    "(--damping hysteretic) unless this very reading is what is asked"
)


class Drive:
    """A train by models of its shafts with its losses and its excitation.

    Parameters
    ----------
    damping : {'hysteretic', 'viscous', 'modal', 'literal'}
    matched_hz : float
        Of viscous losses, Hz.
    forces : mapping of str to (6,) array_like, optional
        At ports, N and N m; instead of the transmission error.
    mesh : str, optional
        By whose transmission error it is driven; the first by default.
    """

    def __init__(
        self,
        workshop: Workshop,
        *models: str,
        damping: str = "hysteretic",
        matched_hz: float = 0.0,
        forces: Mapping[str, np.ndarray] | None = None,
        mesh: str | None = None,
    ):
        if damping not in DAMPING:
            raise SolidgearError(
                f"damping {show(damping, 30)} is unknown; use one of {', '.join(DAMPING)}"
            )
        self.workshop, self.rungs, self.damping = workshop, models, damping
        self.system: System = workshop.system(*models)
        self.pair = workshop.train.named_mesh(mesh)
        self._named: dict[int, tuple[SystemModes, list[str]]] = {}
        loss = workshop.losses()
        kind = damping
        if damping == "literal":
            loss = {name: eta / 2 for name, eta in loss.items()}
            kind, matched_hz = "viscous", 1 / (2 * np.pi)
        self.steady = SteadyState(self.system, loss, kind, matched_hz)
        self.meshes = {one.name: mesh_row(self.system, one.name) for one in workshop.train.teeth}
        self.rows = {name: row for name, (row, _) in self.meshes.items()}
        self.phases = phases_of(self.pair, workshop.stages)
        self.first = next(iter(self.phases))
        self.row, self.stiffness = self.meshes[self.first]
        self.forces = dict(forces or {})
        self.load = self._load()

    @cached_property
    def error(self) -> ErrorTable:
        """Transmission error that drives the train; refused where the file has none."""
        return error_of(self.pair)

    def _load(self, order: int = 1) -> np.ndarray:
        """(N,) load of forces, or of an error of 1 m where it drives, each behind by its phase."""
        if self.forces:
            return self.system.load(self.forces)
        turned = {
            name: np.exp(-1j * order * angle) if angle else 1.0
            for name, angle in self.phases.items()
        }
        rows = [turn * self.meshes[n][1] * self.meshes[n][0] for n, turn in turned.items()]
        return np.sum(rows, axis=0)

    def amplitude(self, frequency_hz: np.ndarray, order: int = 1) -> np.ndarray:
        """(f,) transmission error e at a frequency of excitation, m."""
        if self.error.frequency:
            return np.interp(frequency_hz, self.error.frequency, self.error.amplitude)
        return np.full(len(frequency_hz), self.error.orders[order - 1])

    def motion(self, frequency_hz: np.ndarray, rows: np.ndarray, order: int = 1) -> np.ndarray:
        """(f, q) motions at a frequency of excitation."""
        load = self.load if order == 1 else self._load(order)
        unit = self.steady.motion(frequency_hz, load, rows)
        if self.forces:
            return unit
        scale = self.amplitude(frequency_hz, order) * self.steady.factor(self.first, frequency_hz)
        return unit * scale[:, None]

    def mesh(self, frequency_hz: np.ndarray, order: int = 1) -> tuple[np.ndarray, np.ndarray]:
        """(f,) dynamic transmission error, m, and mesh force, N."""
        dte = self.motion(frequency_hz, self.row[None], order)[:, 0]
        return self._teeth(frequency_hz, dte, order)

    def _teeth(
        self, frequency_hz: np.ndarray, dte: np.ndarray, order: int = 1
    ) -> tuple[np.ndarray, np.ndarray]:
        error = 0.0 if self.forces else self.amplitude(frequency_hz, order)
        factor = self.stiffness * self.steady.factor(self.first, frequency_hz)
        return dte, factor * (dte - error)

    def reactions(self, frequency_hz: np.ndarray) -> dict[str, np.ndarray]:
        """(f, 6) forces of every bearing on its shaft, in the axes of that shaft, by ``side
        bearing``.
        """
        rows = self._reaction_rows()
        found = self.motion(frequency_hz, np.vstack([force for _, force in rows.values()]))
        return self._reactions(frequency_hz, rows, found)

    def _reaction_rows(self) -> dict[str, tuple[str, np.ndarray]]:
        """Link and rows (6, N) of the elastic force of every bearing, by ``side bearing``."""
        out = {}
        for side in self.workshop.scenes:
            supports = as_supports(self.workshop.scenes[side])
            here = self.workshop.train, self.system, side
            seats = np.vstack([seat_motion(*here, name) for name in supports.ports])
            link = next(n for n in self.system.links if n.startswith(f"{side}."))
            force = -np.array(supports.stiffness) @ seats
            for k, name in enumerate(supports.ports):
                if np.any(supports.stiffness[6 * k : 6 * k + 6]):
                    out[f"{side} bearing {name}"] = (link, force[6 * k : 6 * k + 6])
        return out

    def _reactions(self, frequency_hz, rows, found) -> dict[str, np.ndarray]:
        """Reactions from the motions (f, 6 b) of their rows, losses included."""
        return {
            name: found[:, 6 * k : 6 * k + 6] * self.steady.factor(link, frequency_hz)[:, None]
            for k, (name, (link, _)) in enumerate(rows.items())
        }

    def columns(self, frequency_hz: np.ndarray) -> dict[str, np.ndarray]:
        """All that a response tells of the first order, by name and unit: the mesh that drives it,
        reactions of every bearing, motions of all main lumped points, forces of other meshes, and what
        the housing does.
        """
        reactions, scenes = self._reaction_rows(), self.workshop.scenes
        ports = {side: f"{side}.{scene.port.name}" for side, scene in scenes.items()}
        rows = [self.row[None], *(force for _, force in reactions.values())]
        rows += [self.system.motion(port) for port in ports.values()]
        others = [one for one in self.workshop.train.teeth if one.name != self.first]
        rows += [self.rows[pair.name][None] for pair in others]
        found = self.motion(frequency_hz, np.vstack(rows))
        dte, force = self._teeth(frequency_hz, found[:, 0])
        out = {"dynamic transmission error [m]": dte, "mesh force [N]": force}
        for name, reaction in self._reactions(frequency_hz, reactions, found[:, 1:]).items():
            out |= six(name, FORCE_UNITS, reaction)
        moved = found[:, 1 + 6 * len(reactions) :]
        for k, side in enumerate(ports):
            out |= six(side, MOTION_UNITS, moved[:, 6 * k : 6 * k + 6])
        for pair, stretch in zip(others, moved.T[6 * len(ports) :]):
            factor = self.meshes[pair.name][1] * self.steady.factor(pair.name, frequency_hz)
            if pair.name in self.phases and not self.forces:
                behind = np.exp(-1j * self.phases[pair.name])
                stretch = stretch - behind * self.amplitude(frequency_hz)
            out[f"mesh force{pair.label} [N]"] = factor * stretch
        return out | columns_of(self, frequency_hz)

    def grid(
        self,
        highest_hz: float,
        lowest_hz: float | None = None,
        seen: Callable[[np.ndarray], np.ndarray] | None = None,
    ) -> np.ndarray:
        """Frequencies on which no peak of the last of some motions is missed.

        Parameters
        ----------
        seen : callable, optional
            ``seen(frequency_hz)`` gives motions (f, q); by default the dynamic transmission error
            and the mesh force.
        """
        refuse_unresolved(self.workshop, self.system, highest_hz)
        first = float(self.system.elastic[0][0] / (2 * np.pi))
        lowest = lowest_hz or min(BEGIN * first, highest_hz / 100)

        seen = seen or self._seen
        points = self.steady.grid(lowest, highest_hz, seen)
        tops = peaks(np.abs(seen(points)[:, -1]))
        if len(tops) > MOST_PEAKS:
            raise SolidgearError(
                f"the response has {len(tops)} peaks, which is rounding: a spring or an inertia "
                "is so large or small beside the others that no digit is left; check their units"
            )
        fine = [np.linspace(points[k - 1], points[k + 1], TOP) for k in tops]
        ends = [hz for hz in self._ends() if lowest < hz < highest_hz]
        return np.unique(np.concatenate([points, *fine, ends]))

    def _seen(self, frequency_hz: np.ndarray) -> np.ndarray:
        """(f, q) motions whose peaks a grid may not miss; orders of one mesh have the same."""
        further = range(2, self.orders + 1) if len(self.phases) > 1 else ()
        forces = [self.mesh(frequency_hz, order)[1] for order in further]
        return np.column_stack([*felt(self, frequency_hz), *forces, *self.mesh(frequency_hz)])

    def _ends(self) -> list[float]:
        """Frequencies of all orders at the highest speed in the files, Hz."""
        speed = None if self.forces else fastest(self.workshop.train, self.workshop.scenes)
        first = 0.0 if speed is None else speed.rpm * self.workshop.train.per_turn(self.pair) / 60
        return [order * first for order in range(1, self.orders + 1)]

    @property
    def orders(self) -> int:
        """Orders that drive the train."""
        return 1 if self.forces else max(1, len(self.error.orders))

    def over_cycle(self, frequency_hz: np.ndarray, highest_hz: float) -> list[np.ndarray]:
        """(f,) mesh force of every order at frequencies of the mesh, N; NaN of an order beyond the
        highest frequency.
        """
        out = []
        for order in range(1, self.orders + 1):
            there = order * frequency_hz <= highest_hz
            force = np.full(len(frequency_hz), np.nan + 0j)
            force[there] = self.mesh(order * frequency_hz[there], order)[1]
            out.append(force)
        return out

    def curve(self, frequency_hz: np.ndarray, order: int = 1) -> OrderCurve:
        """Mesh force by one order, its peaks each with the mode that makes it."""
        force = np.abs(self.mesh(frequency_hz, order)[1])
        load = self.load if order == 1 else self._load(order)
        peaks = tuple(Peak(*top) for top in self.tops(frequency_hz, force, self.row, load))
        return OrderCurve(order, force, peaks)

    def named_modes(self, n: int, bounded: int = 0) -> tuple[SystemModes, list[str]]:
        """Lowest elastic modes of the train, some of them with a bound, and free motions, with their
        names; found once.
        """
        if n not in self._named:
            found = self.system.modes(n, bounded=bounded)
            self._named[n] = found, mode_names(self.workshop, self.system, found)
        return self._named[n]

    def reach(self, highest_hz: float) -> int:
        """Elastic modes that a response up to a frequency is named by."""
        return max(1, int((self.system.elastic[0] <= 4 * np.pi * highest_hz).sum()))

    def tops(
        self,
        frequency_hz: np.ndarray,
        size: np.ndarray,
        row: np.ndarray,
        load: np.ndarray | None = None,
    ) -> list[tuple[float, float, str]]:
        """Frequency, size and mode of every peak of an amplitude.

        Parameters
        ----------
        frequency_hz, size : (f,) ndarray
        row : (N,) ndarray
            Of the motion that is looked at.
        load : (N,) ndarray, optional
            That drives it, where it is not that of the first order.
        """
        load = self.load if load is None else load
        omega, shapes = self.system.elastic
        within = self.reach(frequency_hz[-1])
        found, every = self.named_modes(within)
        names = every[found.rigid :]
        share = (row @ shapes[:, :within]) * (shapes[:, :within].T @ load)
        each = [self.steady.loss.get(name, 0.0) * share for name, share in found.energy.items()]
        lost = np.sum(each, axis=0)[found.rigid :]
        out = []
        for k in peaks(size):
            if not stands_out(size, k):
                continue
            w = 2 * np.pi * frequency_hz[k]
            # what makes a peak is the term that changes fastest there, not the largest one:
            # far modes give much of the force, but the same everywhere
            gap = omega[:within] ** 2 * (1 + 1j * lost) - w**2
            # a broad top between two of them is of neither
            width = np.maximum(NEAR * lost / 2, LEAST_NEAR) * omega[:within]
            near = np.abs(omega[:within] - w) <= width
            fast = np.where(near, np.abs(share / gap**2), -1.0)
            name = names[fast.argmax()] if near.any() else NO_MODE
            out.append((float(frequency_hz[k]), float(size[k]), name))
        return out


@pinned
def respond(
    workshop: Workshop,
    *models: str,
    highest_hz: float | None = None,
    damping: str = "hysteretic",
    matched_hz: float = 0.0,
    forces: Mapping[str, np.ndarray] | None = None,
    frequency_hz: np.ndarray | None = None,
    mesh: str | None = None,
    turns: float | None = None,
) -> TrainResponse:
    """Steady response of a train with its shafts by models.

    Parameters
    ----------
    highest_hz : float, optional
        That of the file by default.
    damping, matched_hz, forces, mesh
        As :class:`Drive`.
    frequency_hz : (f,) ndarray, optional
        Instead of an adaptive grid.
    turns : float, optional
        Of the engine's shaft in a second, for what spin does to modes; by default at the fastest
        operating point.

    Raises
    ------
    SolidgearError
        For a frequency beyond what the reduction resolves, unknown damping or ports.

    Examples
    --------
    >>> import solidgear as sg
    >>> shop = Workshop(sg.load_train("geometry/axle_overhung.toml"))
    >>> found = respond(shop, "timoshenko", "timoshenko", highest_hz=1000.0)
    >>> found.peaks[0].mode, round(found.peaks[0].frequency_hz)
    ('load torsion 1', 16)
    """
    drive = Drive(
        workshop, *models, damping=damping, matched_hz=matched_hz, forces=forces, mesh=mesh
    )
    highest = highest_hz or workshop.train.ask.max_frequency
    hz = drive.grid(highest) if frequency_hz is None else np.asarray(frequency_hz, float)
    told = drive.columns(hz)
    first = list(told)[:2]
    columns = {name: told.pop(name) for name in first}
    for order, force in enumerate(drive.over_cycle(hz, highest)[1:], start=2):
        columns[f"mesh force, order {order} [N]"] = force
    columns |= told
    rungs = workshop.mix(models)
    cautions = [*workshop.cautions, *local_lines(workshop, drive.system)]
    cautions += spin_cautions(workshop, drive.system, rungs, highest, turns)
    if damping == "literal":
        at = float(highest)
        cautions.append(LITERAL.format(at, np.pi * at * workshop.train.losses.mesh))
    parting = tuple(parting_lines(drive, hz, columns))
    curves = tuple(drive.curve(hz, order) for order in range(1, drive.orders + 1))
    seconds = workshop.seconds(*models)
    return TrainResponse(rungs, damping, hz, columns, curves, parting, tuple(cautions), seconds)
