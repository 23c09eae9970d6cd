r"""A train whose teeth have backlash, over speed: where they lose contact, where the motion jumps, and
how far off the linear answer is.

With the half gap b along the line of action and the unloaded transmission error e, the teeth carry
(Hua 2010, equation 14)

    k (s - b)  for s > b,   none between,   k (s + b)  for s < -b,      s = dte - e,

around the mean force of an operating point.  Everything else is linear: the modes of the train with
its teeth in contact, each with the damping ratio that its loss factors make.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from time import process_time

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.nonlinear.continuation import follow
from solidgear.nonlinear.model import Remainder, remainder
from solidgear.nonlinear.motion import Steady, sweep
from solidgear.nonlinear.stability import multipliers
from solidgear.studies.train.backlash import AtForce, Backlash, Teeth
from solidgear.studies.train.mesh_line import AXIAL, orders_of, turning_line
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.modes import refuse_unresolved
from solidgear.studies.train.operation import mesh_force
from solidgear.system.law import Gap
from solidgear.system.links import RowSpring
from solidgear.system.system import System

#: the first frequency of a branch by default, over the highest
BEGIN = 0.01
#: longest step of a branch, of the range of speeds
STEP = 0.02
#: what may be left of a transient in time: torsion against engine and load fades over thousands of
#: mesh periods
FADED = 1e-4


def teeth_of(
    workshop: Workshop, mean_force: float | None = None, contact_loss_hz: float | None = None
) -> Teeth:
    """What the teeth of a train do, from its file.

    Parameters
    ----------
    mean_force : float, optional
        Instead of that of the operating point, N.
    contact_loss_hz : float, optional
        Frequency at which a damper in contact alone has the loss factor of the mesh; without it the
        mesh takes part in the damping ratios of the modes.

    Raises
    ------
    SolidgearError
        If there is no backlash or no mean force, or the transmission error is a table over
        frequency.
    """
    mesh, point = workshop.train.mesh, workshop.train.point
    if mesh.backlash is None:
        raise SolidgearError(
            'no backlash is given; write backlash = "100 um" under [mesh], or give --backlash'
        )
    source = "given"
    if mean_force is None:
        if point is None:
            raise SolidgearError(
                'no mean force is given; write [[operation]] with torque = "115 N*m", or give '
                '--mean-force, such as "5 kN"'
            )
        mean_force, source = mesh_force(workshop, point), point.label
    if not mean_force > 0:
        raise SolidgearError(f"a mean force of {mean_force:g} N holds no teeth; give more than 0")
    if mesh.transmission_error.frequency:
        raise SolidgearError(
            "the transmission error is a table over frequency, which has no cycle in time; give it "
            'by orders in the file, or --error "10 um"'
        )
    error, table = mesh.transmission_error, mesh.stiffness_cycle
    cycle: tuple[tuple[float, float], ...] = ()
    if table is not None:
        mean, orders = orders_of(np.array(table.angle), np.array(table.stiffness)[:, None])
        cycle = tuple((float(c.real), float(-c.imag)) for c in orders[:, 0] / mean[0])
    return Teeth(
        mesh.backlash / 2,
        float(mean_force),
        error.orders,
        source,
        cycle,
        error.phases,
        mesh.line_cycle is not None,
        contact_loss_hz,
    )


def parting(system: System, teeth: Teeth, damper: float = 0.0) -> System:
    """The system with a law on its mesh whose stiffness is what it was, and the mean force positive.

    Parameters
    ----------
    damper : float
        In contact alone, N s/m.
    """
    mesh = _mesh(system)
    law = Gap(mesh.stiffness, teeth.half_gap, damper=damper)
    row, other = -np.asarray(mesh.row), -np.asarray(mesh.to_row)
    turned = replace(mesh, row=row, to_row=other, law=law)
    return System(system.parts, {**system.links, "mesh": turned})


def backlash_model(
    workshop: Workshop, pinion: str, gear: str, teeth: Teeth, highest_hz: float
) -> Remainder:
    """The remainder of a train with backlash, by two models.

    Parameters
    ----------
    highest_hz : float
        Modes above it give way like springs.
    """
    loss, damper = workshop.losses(), 0.0
    if teeth.contact_loss_hz:
        damper = loss.pop("mesh") * workshop.contact.stiffness / (2 * np.pi * teeth.contact_loss_hz)
    system, table = workshop.system(pinion, gear), workshop.train.mesh.line_cycle
    turning = None if table is None else turning_line(workshop, table)
    if turning is not None:
        system = System(system.parts, {**system.links, "mesh": turning.mean_of(_mesh(system))})
    system = parting(system, teeth, damper)
    refuse_unresolved(workshop, system, highest_hz)
    mesh = _mesh(system)
    row, other = np.ravel(np.asarray(mesh.row)), np.ravel(np.asarray(mesh.to_row))
    lever = {"engine": row[AXIAL], "load": -other[AXIAL]}
    load = system.load(
        {name: np.array([0, 0, 0, 0, teeth.mean_force * h, 0]) for name, h in lever.items()}
    )
    sways = {}
    if turning is not None and len(turning.further):
        # both rows turned as that of the mean line is
        sways["mesh"] = turning.further_of(mesh), -turning.orders
    return remainder(
        system,
        loss=loss,
        load=load,
        errors={"mesh": teeth.harmonics},
        cycles={"mesh": [complex(c, -s) for c, s in teeth.cycle]},
        sways=sways,
        highest_hz=highest_hz,
    )


def _mesh(system: System) -> RowSpring:
    mesh = system.links["mesh"]
    assert isinstance(mesh, RowSpring)
    return mesh


def ends(
    workshop: Workshop, highest_hz: float | None, lowest_hz: float | None
) -> tuple[float, float]:
    """Lowest and highest frequency of the mesh, those of the file where they are not given.

    Raises
    ------
    SolidgearError
        For a range that holds zero.
    """
    highest = highest_hz or workshop.train.ask.max_frequency
    lowest = BEGIN * highest if lowest_hz is None else lowest_hz
    if not 0 < lowest < highest:
        raise SolidgearError(
            f"mesh frequencies from {lowest:g} to {highest:g} Hz; give ascending ends above 0"
        )
    return lowest, highest


def with_backlash(
    workshop: Workshop,
    pinion: str,
    gear: str,
    teeth: Teeth,
    highest_hz: float | None = None,
    lowest_hz: float | None = None,
    told: Callable[[str], None] | None = None,
) -> Backlash:
    """Periodic motion of a train whose teeth have backlash, by two models of its shafts.

    Parameters
    ----------
    pinion, gear : str
        Models.
    highest_hz, lowest_hz : float, optional
        Of the mesh; the highest is that of the file by default, the lowest a hundredth of it.
    told : callable, optional
        Called with words as it goes on.

    Raises
    ------
    SolidgearError
        For a range that holds zero, a frequency that the reduction does not resolve, or a branch
        that cannot be followed.

    Examples
    --------
    >>> import solidgear as sg
    >>> train = sg.load_train("geometry/axle_overhung.toml")
    >>> mesh = train.mesh.with_changes(backlash="100 um", transmission_error="10 um")
    >>> shop = Workshop(train.with_changes(mesh=mesh))
    >>> teeth = teeth_of(shop, mean_force=5000.0)
    >>> found = with_backlash(shop, "lumped/timoshenko", "lumped/timoshenko", teeth, 1000.0, 500.0)
    >>> [jump.rising for jump in found.jumps][:2]
    [True, False]
    """
    lowest, highest = ends(workshop, highest_hz, lowest_hz)
    begin = process_time()
    most = max(workshop.train.ask.max_frequency, highest)
    own = backlash_model(workshop, pinion, gear, teeth, most)
    if told:
        told(f"branch of {pinion} + {gear}")
    branch = follow(own, 2 * np.pi * lowest, 2 * np.pi * highest, step=STEP)
    largest = np.array([multipliers(point)[0] for point in branch.points])
    seconds = process_time() - begin
    return Backlash(pinion, gear, teeth, own, branch, largest, seconds)


def over_force(
    found: Backlash, count: int, told: Callable[[str], None] | None = None
) -> tuple[AtForce, ...]:
    """Jumps over the mean force of the teeth, up to that above which they never part.

    Parameters
    ----------
    count : int
        Mean forces, equally apart.
    """
    most = found.linear_loudest[1]
    out = []
    for share in np.arange(1, count + 1) / count:
        force = float(share * most)
        if told:
            told(f"mean force {force:.0f} N")
        mean = found.remainder.mean * (force / found.teeth.mean_force)
        ends = found.branch.omega[0], found.branch.omega[-1]
        branch = follow(replace(found.remainder, mean=mean), *map(float, ends), step=STEP)
        jumps = tuple(
            (
                float(branch.points[k].omega / (2 * np.pi)),
                bool(branch.points[k - 1].tangent[-1] > 0),
            )
            for k in branch.turning
        )
        largest = max(float(np.ptp(point.forces()[:, 0])) / 2 for point in branch.points)
        out.append(AtForce(force, jumps, largest))
    return tuple(out)


@dataclass(frozen=True)
class InTime:
    """A motion found in time, beside the nearest of the branch.

    Attributes
    ----------
    rising : bool
        Whether the speed rose to it.
    cycle : int
        Periods of the mesh after which it repeats itself; 0 where it never did.
    branch_force : float
        N, of the stable motion nearest to it.
    """

    frequency_hz: float
    rising: bool
    cycle: int
    force: float
    branch_force: float

    @property
    def off(self) -> float:
        """Relative."""
        return self.force / self.branch_force - 1


def in_time(
    found: Backlash, count: int, told: Callable[[str], None] | None = None
) -> tuple[InTime, ...]:
    """Sweeps up and down by integration in time, over the speeds at which the teeth part, from the
    motions of the branch at both ends.

    Parameters
    ----------
    count : int
        Speeds of each sweep.
    """
    if not found.lost:
        return ()
    low = max(found.lost[0].low * 0.97, found.frequency_hz.min())
    high = min(found.lost[-1].high * 1.03, found.frequency_hz.max())
    up = np.linspace(low, high, count)
    out: list[InTime] = []
    for rising, hz in ((True, up), (False, up[::-1])):
        if told:
            told(f"in time, speed {'rising' if rising else 'falling'}")
        begin = found.branch.at(2 * np.pi * float(hz[0]))[0 if rising else -1].state()
        steady = sweep(found.remainder, (2 * np.pi * hz).tolist(), state=begin, steady=FADED)
        out += [_beside(found, one, rising) for one in steady]
    return tuple(out)


def _beside(found: Backlash, one: Steady, rising: bool) -> InTime:
    force = float(np.ptp(one.force[:, 0]) / 2)
    there = [float(np.ptp(p.forces()[:, 0]) / 2) for p in found.branch.at(one.omega)]
    nearest = min(there, key=lambda size: abs(size - force))
    return InTime(one.omega / (2 * np.pi), rising, one.cycle, force, nearest)
