r"""A train whose teeth have backlash, over speed: where they lose contact, where the motion jumps, and
how far off the linear answer is.

With the half gap b along the line of action and the unloaded transmission error e, the teeth carry
(Hua 2010, equation 14)

    k (s - b)  for s > b,   none between,   k (s + b)  for s < -b,      s = dte - e,

around the mean force of an operating point.  Everything else is linear: the modes of the train with
its teeth in contact, each with the damping ratio that its loss factors make.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from time import process_time

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.nonlinear.continuation import follow
from solidgear.nonlinear.model import Remainder, remainder
from solidgear.nonlinear.motion import Steady, sweep
from solidgear.scene.gears import Pair
from solidgear.scene.operation import OperatingPoint
from solidgear.scene.planetary import error_of, named_pair
from solidgear.studies.train.apart import largest, searched
from solidgear.studies.train.backlash import AtForce, Backlash, Teeth
from solidgear.studies.train.layout import mesh_forces
from solidgear.studies.train.mesh_line import AXIAL, orders_of, turning_line
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.modes import refuse_unresolved
from solidgear.studies.train.operation import SHAFT, divided, torques
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
    workshop: Workshop,
    mean_force: float | None = None,
    contact_loss_hz: float | None = None,
    mesh: str | None = None,
) -> Teeth:
    """Teeth of a train, from its file.

    Parameters
    ----------
    mean_force : float, optional
        Instead of that of the operating point, N; those of other meshes are in the ratio of the torques.
    contact_loss_hz : float, optional
        Frequency at which a damper in contact alone has the loss factor of the mesh; without it the
        mesh takes part in the damping ratios of the modes.
    mesh : str, optional
        By whose transmission error the train is driven; the first by default.

    Raises
    ------
    SolidgearError
        If there is no backlash or no mean force, the transmission error is a table over frequency,
        teeth of a loop would have to pull, or another mesh varies over its own cycle.
    """
    train = workshop.train
    pair, point = named_pair(train, mesh), train.point
    if not any(one.mesh.backlash is not None for one in train.pairs):
        raise SolidgearError(
            'no backlash is given; write backlash = "100 um" under [mesh], or give --backlash'
        )
    _refuse_several(workshop, pair)
    source = "given"
    if mean_force is None:
        if point is None:
            raise SolidgearError(
                'no mean force is given; write [[operation]] with torque = "115 N*m", or give '
                '--mean-force, such as "5 kN"'
            )
        forces, source = _by_torque(workshop, point), point.label
    else:
        unit = _by_torque(workshop, torque_of(workshop, pair.name, 1.0))
        forces = {name: mean_force * one for name, one in unit.items()}
    gaps = {one.name: one.mesh.backlash for one in train.pairs if one.mesh.backlash}
    for name in (pair.name, *gaps):
        if not forces[name] > 0:
            of = f" of the {name}" if len(forces) > 1 else ""
            raise SolidgearError(
                f"a mean force of {forces[name]:g} N holds no teeth{of}; give more than 0"
            )
    error, table = error_of(pair), pair.mesh.stiffness_cycle
    if error.frequency:
        raise SolidgearError(
            "the transmission error is a table over frequency, which has no cycle in time; give it "
            'by orders in the file, or --error "10 um"'
        )
    cycle: tuple[tuple[float, float], ...] = ()
    if table is not None:
        mean, orders = orders_of(np.array(table.angle), np.array(table.stiffness)[:, None])
        cycle = tuple((float(c.real), float(-c.imag)) for c in orders[:, 0] / mean[0])
    others = [
        Teeth(gaps.get(name, 0.0) / 2, float(force), (), source, mesh=name)
        for name, force in forces.items()
        if name != pair.name and name in workshop.contacts
    ]
    return Teeth(
        (pair.mesh.backlash or 0.0) / 2,
        float(forces[pair.name]),
        error.orders,
        source,
        cycle,
        error.phases,
        pair.mesh.line_cycle is not None,
        contact_loss_hz,
        pair.name,
        tuple(others),
    )


def _refuse_several(workshop: Workshop, driver: Pair) -> None:
    """Refuse cycles of two meshes at once."""
    for pair in workshop.train.pairs:
        varies = pair.mesh.stiffness_cycle or pair.mesh.line_cycle
        if varies is not None and pair.name != driver.name:
            raise SolidgearError(
                f"the {pair.name} varies over its own cycle, and the train is driven at that of the "
                f"{driver.name}: give --mesh {pair.label.strip()}, or leave its table out"
            )


def parting(system: System, teeth: Teeth, loss: float = 0.0) -> System:
    """The system with a law on each mesh that has teeth, whose stiffness is what it was, and the mean
    force positive; that of the driven mesh comes first.

    Parameters
    ----------
    loss : float
        Loss factor of a damper in contact alone, where the teeth say at which frequency.
    """
    links = dict(system.links)
    for k, one in enumerate(teeth.every):
        mesh = mesh_of(system, one.mesh)
        at = 2 * np.pi * (teeth.contact_loss_hz or np.inf)
        law = Gap(mesh.stiffness, one.half_gap, damper=loss * mesh.stiffness / at)
        row, other = -np.asarray(mesh.row), -np.asarray(mesh.to_row)
        if k:
            del links[one.mesh]
        links[one.mesh] = replace(mesh, row=row, to_row=other, law=law)
    return System(system.parts, links)


def backlash_model(
    workshop: Workshop, models: Sequence[str], teeth: Teeth, highest_hz: float
) -> Remainder:
    """The remainder of a train with backlash, by models of its shafts.

    Parameters
    ----------
    highest_hz : float
        Modes above it give way like springs.
    """
    pair, loss, damped = named_pair(workshop.train, teeth.mesh), workshop.losses(), 0.0
    if teeth.contact_loss_hz:
        damped = [loss.pop(one.mesh) for one in teeth.every][0]
    system, turning, name = workshop.system(*models), turning_line(workshop, pair), pair.name
    force = teeth.mean_force
    if turning is not None:
        links = {**system.links, name: turning.mean_of(mesh_of(system, name))}
        system = System(system.parts, links)
        force *= float(turning.mean[AXIAL] / workshop.contacts[name].pinion.vector[AXIAL])
    load = torques(workshop, torque_of(workshop, name, force))
    system = parting(system, teeth, damped)
    refuse_unresolved(workshop, system, highest_hz)
    sways = {}
    if turning is not None and len(turning.further):
        # both rows turned as that of the mean line is
        sways[name] = turning.further_of(mesh_of(system, name)), -turning.orders
    return remainder(
        system,
        loss=loss,
        load=system.load(load),
        errors={name: teeth.harmonics},
        cycles={name: [complex(c, -s) for c, s in teeth.cycle]},
        sways=sways,
        highest_hz=highest_hz,
    )


def _by_torque(workshop: Workshop, point: OperatingPoint) -> dict[str, float]:
    """Forces of all meshes by a torque alone, N; those of a loop as Timoshenko shafts divide them."""
    known = mesh_forces(workshop.train, workshop.contacts, point)
    if None in workshop.train.flows.values():
        system = workshop.system(SHAFT)
        held = system.static(system.load(torques(workshop, point)))
        known |= divided(workshop, system, held, point.label)
    return {pair.name: known[pair.name] for pair in workshop.train.pairs}


def torque_of(workshop: Workshop, mesh: str, force: float) -> OperatingPoint:
    """The torque of the engine's shaft that brings a force to a mesh, N."""
    unit = OperatingPoint(torque=1.0, of=workshop.train.reference)
    own = _by_torque(workshop, unit)[mesh]
    if not own:
        raise SolidgearError(f"no torque passes the {mesh} between engine and load")
    return unit.with_changes(torque=force / own)


def mesh_of(system: System, name: str) -> RowSpring:
    """The link of a mesh."""
    mesh = system.links[name]
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
    models: Sequence[str],
    teeth: Teeth,
    highest_hz: float | None = None,
    lowest_hz: float | None = None,
    told: Callable[[str], None] | None = None,
    apart: int = 0,
) -> Backlash:
    """Periodic motion of a train whose teeth have backlash, by models of its shafts.

    Parameters
    ----------
    highest_hz, lowest_hz : float, optional
        Of the driven mesh; the highest is that of the file by default, the lowest a hundredth of it.
    told : callable, optional
        Called with words as it goes on.
    apart : int
        Speeds at which branches apart are looked for.

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
    >>> found = with_backlash(shop, ["lumped/timoshenko"], teeth, 1000.0, 500.0)
    >>> [jump.rising for jump in found.jumps][:2]
    [True, False]
    """
    lowest, highest = ends(workshop, highest_hz, lowest_hz)
    begin = process_time()
    most = max(workshop.train.ask.max_frequency, highest)
    mix = workshop.mix(models)
    own = backlash_model(workshop, models, teeth, most)
    if told:
        told(f"branch of {' + '.join(mix.values())}")
    branch = follow(own, 2 * np.pi * lowest, 2 * np.pi * highest, step=STEP)
    found = Backlash(mix, teeth, own, branch, largest(branch), process_time() - begin)
    if not apart:
        return found
    if told:
        told(f"branches apart of {' + '.join(mix.values())}")
    looked = searched(found, apart, STEP)
    return replace(looked, seconds=process_time() - begin)


def over_force(
    found: Backlash, count: int, told: Callable[[str], None] | None = None
) -> tuple[AtForce, ...]:
    """Jumps over the mean force of the driven teeth, up to that above which none part.

    Parameters
    ----------
    count : int
        Mean forces, equally apart.
    """
    most = found.holding[1].max()
    out = []
    for share in np.arange(1, count + 1) / count:
        force = float(share * most)
        if told:
            told(f"mean force {force:.0f} N")
        mean = found.remainder.mean * (force / found.teeth.mean_force)
        ends = found.branch.omega[0], found.branch.omega[-1]
        branch = follow(replace(found.remainder, mean=mean), *map(float, ends), step=STEP)
        own = replace(found, branch=branch)
        jumps = tuple((jump.frequency_hz, jump.rising) for jump in own.jumps)
        out.append(AtForce(force, jumps, float(own.force.max())))
    return tuple(out)


@dataclass(frozen=True)
class InTime:
    """A motion found in time, beside the nearest of the branch."""

    frequency_hz: float
    rising: bool  #: whether the speed rose to it
    cycle: int  #: periods of the mesh after which it repeats itself; 0 where it never did
    force: float
    branch_force: float  #: N, of the stable motion nearest to it

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
    lost = [one for mesh in found.every for one in mesh.lost]
    if not lost:
        return ()
    low = max(min(one.low for one in lost) * 0.97, found.frequency_hz.min())
    high = min(max(one.high for one in lost) * 1.03, found.frequency_hz.max())
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
    there = [float(np.ptp(p.forces()[:, 0]) / 2) for p in found.along(one.omega)]
    nearest = min(there, key=lambda size: abs(size - force))
    return InTime(one.omega / (2 * np.pi), rising, one.cycle, force, nearest)
