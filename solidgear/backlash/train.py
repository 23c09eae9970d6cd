r"""A train whose teeth have backlash, over speed: where they lose contact, where the motion jumps, and
how far off the linear answer is.

With the half gap b along the line of action and the unloaded transmission error e, the teeth carry
(Hua 2010, equation 14)

    k (s - b)  for s > b,   none between,   k (s + b)  for s < -b,      s = dte - e,

around the mean force of an operating point.  Everything else is linear: the modes of the train with
the teeth in contact, each with the damping ratio that the loss factors make.

The line of action may vary over the mesh cycle, as rows between the ports of both shafts.  Each
place of the table is a mesh vector on both shafts (Hua 2010, equation 21).  That the gear turns about
its shaft enters through the ratio of the mean line (3.2.2): a pair that turns evenly does not stretch
its teeth, wherever they touch.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from time import process_time

import numpy as np

from solidgear.backlash.periodic import AtForce, Backlash, Teeth
from solidgear.backlash.solver.apart import search
from solidgear.backlash.solver.continuation import Branch, follow
from solidgear.backlash.solver.model import Remainder, remainder
from solidgear.backlash.solver.motion import Steady, sweep
from solidgear.backlash.solver.stability import multipliers
from solidgear.core import SceneError, SolidgearError, System
from solidgear.core.system.gear_mesh import MeshVector, to_gear_frame
from solidgear.core.system.law import Gap
from solidgear.core.system.links import RowSpring
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.layout import mesh_forces
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import error_of
from solidgear.trains.file.train import Train, named_pair
from solidgear.trains.load.contact import LEVER_REFUSED, axes_of
from solidgear.trains.load.operation import loop_forces, rotor_loads
from solidgear.trains.modes.modes import refuse_unresolved, resolved_frequency

#: the first frequency of a branch by default, over the highest
BEGIN = 0.01
#: longest step of a branch, of the range of speeds
STEP = 0.02
#: share of a transient in time that may be left: torsion against engine and load fades over thousands of
#: mesh periods
FADED = 1e-4
#: orders of the mesh that are kept of a table over the cycle, and places at which it is read
CYCLE_ORDERS, CYCLE_PLACES = 8, 4096
#: a row that turns by less than this of the mean one is rounding
STILL = 1e-12
#: share of a mean force that the linear one must exceed where branches apart are looked for
LIVELY = 0.2
#: model of shafts whose loops of meshes divide a torque by their stiffness
BEAM = "timoshenko"
#: rotation about the shaft, of six components
AXIAL = 4


def teeth_of(
    assembly: Assembly,
    mean_force: float | None = None,
    contact_loss_hz: float | None = None,
    mesh: str | None = None,
) -> Teeth:
    """Return the teeth of a train by its file, with a mean force, N, in place of that of the
    operating point, those of other meshes in the ratio of the torques. Without
    `contact_loss_hz`, at which a damper in contact alone has the loss factor of the mesh, the
    mesh takes part in the damping ratios of the modes. Refused without backlash or mean force,
    with an error table over frequency, with teeth of a loop that would have to pull, and with
    another mesh that varies over another cycle.
    """
    train = assembly.train
    pair, point = named_pair(train, mesh), train.point
    _refuse_absent(train, pair, mean_force)
    _refuse_several(assembly, pair)
    source = "given"
    if mean_force is None:
        assert point is not None  # else it was refused
        forces, source = _by_torque(assembly, point), point.label
    else:
        unit = _by_torque(assembly, torque_of(assembly, pair.name, 1.0))
        forces = {name: mean_force * force for name, force in unit.items()}
    gaps = {driven.name: driven.mesh.backlash for driven in train.pairs if driven.mesh.backlash}
    for name in (pair.name, *gaps):
        if not forces[name] > 0:
            suffix = f" of the {name}" if len(forces) > 1 else ""
            raise SolidgearError(
                f"a mean force of {forces[name]:g} N holds no teeth{suffix}; give more than 0"
            )
    error, table = error_of(pair), pair.mesh.stiffness_cycle
    if error.frequency:
        raise SolidgearError(
            "the transmission error is a table over frequency; give it by orders in the file, or "
            '`error` "10 um"'
        )
    cycle: tuple[tuple[float, float], ...] = ()
    if table is not None:
        mean, orders = orders_of(np.array(table.angle), np.array(table.stiffness)[:, None])
        cycle = tuple((float(c.real), float(-c.imag)) for c in orders[:, 0] / mean[0])
    others = [
        Teeth(gaps.get(name, 0.0) / 2, float(force), (), source, mesh=name)
        for name, force in forces.items()
        if name != pair.name and name in assembly.contacts
    ]
    return Teeth(
        half_gap=(pair.mesh.backlash or 0.0) / 2,
        mean_force=float(forces[pair.name]),
        errors=error.orders,
        source=source,
        cycle=cycle,
        phases=error.phases,
        turns=pair.mesh.line_cycle is not None,
        contact_loss_hz=contact_loss_hz,
        mesh=pair.name,
        others=tuple(others),
    )


def _refuse_absent(train: Train, driver: Pair, mean_force: float | None) -> None:
    """Refuse a train without what teeth with backlash need, and name all that is missing at once."""
    absent, ways = [], []
    if not any(driven.mesh.backlash is not None for driven in train.pairs):
        absent.append("backlash")
        ways.append('backlash = "100 um" under [mesh] or `backlash`')
    if mean_force is None and train.point is None:
        absent.append("mean force")
        ways.append('[[operation]] with torque = "115 N*m" or `mean_force` "5 kN"')
    if driver.mesh.transmission_error is None:
        absent.append("transmission error")
        ways.append('transmission_error = "10 um" under [mesh] or `error`')
    if absent:
        raise SolidgearError(f"no {', no '.join(absent)}: give {'; '.join(ways)}")


def _refuse_several(assembly: Assembly, driver: Pair) -> None:
    """Refuse cycles of two meshes at once."""
    for pair in assembly.train.pairs:
        varies = pair.mesh.stiffness_cycle or pair.mesh.line_cycle
        if varies is not None and pair.name != driver.name:
            raise SolidgearError(
                f"the {pair.name} varies over its own cycle, and the train is driven at that of the "
                f"{driver.name}: give `mesh` {pair.label.strip()}, or leave its table out"
            )


def parting(system: System, teeth: Teeth, loss: float = 0.0) -> System:
    """Return the system with a law on each mesh that has teeth, whose stiffness stays, and the mean
    force positive; that of the driven mesh comes first, and `loss` is the loss factor of a
    damper in contact alone.
    """
    links = dict(system.links)
    for k, teeth_of_mesh in enumerate(teeth.meshes):
        mesh = mesh_of(system, teeth_of_mesh.mesh)
        omega = 2 * np.pi * (teeth.contact_loss_hz or np.inf)
        law = Gap(mesh.stiffness, teeth_of_mesh.half_gap, damper=loss * mesh.stiffness / omega)
        row, to_row = -np.asarray(mesh.row), -np.asarray(mesh.to_row)
        if k:
            del links[teeth_of_mesh.mesh]
        links[teeth_of_mesh.mesh] = replace(mesh, row=row, to_row=to_row, law=law)
    return System(system.parts, links)


def backlash_model(
    assembly: Assembly,
    models: Sequence[str],
    teeth: Teeth,
    highest_hz: float,
    reached_hz: float = 0.0,
) -> Remainder:
    """Return the remainder of a train with backlash, by models of the shafts; modes above the
    highest frequency give way like springs, but for those that orders of the mesh reach and the
    shafts resolve.
    """
    pair, loss, damped = named_pair(assembly.train, teeth.mesh), assembly.loss_factors(), 0.0
    if teeth.contact_loss_hz:
        damped = [loss.pop(meshed.mesh) for meshed in teeth.meshes][0]
    assembly.follow(*models, highest_hz=highest_hz)
    system, turning, name = assembly.system(*models), turning_line(assembly, pair), pair.name
    force = teeth.mean_force
    if turning is not None:
        mean = replace(mesh_of(system, name), row=turning.mean[:6], to_row=turning.mean[6:])
        system = System(system.parts, {**system.links, name: mean})
        force *= float(turning.mean[AXIAL] / assembly.contacts[name].pinion.vector[AXIAL])
    load = rotor_loads(assembly, torque_of(assembly, name, force))
    system = parting(system, teeth, damped)
    refuse_unresolved(assembly, system, highest_hz)
    sways = {}
    if turning is not None and len(turning.further):
        # both rows turned as that of the mean line is
        rows, to_rows = turning.further[:, :6], turning.further[:, 6:]
        further = replace(mesh_of(system, name), row=rows, to_row=to_rows, law=None)
        sways[name] = further, -turning.orders
    return remainder(
        system,
        loss=loss,
        load=system.load(load),
        errors={name: teeth.harmonics},
        cycles={name: [complex(c, -s) for c, s in teeth.cycle]},
        sways=sways,
        highest_hz=max(highest_hz, min(reached_hz, resolved_frequency(assembly, system))),
    )


def _by_torque(assembly: Assembly, point: OperatingPoint) -> dict[str, float]:
    """Return the forces of all meshes by a torque alone, N; those of a loop as Timoshenko shafts
    divide them.
    """
    forces = mesh_forces(assembly.train, assembly.contacts, point)
    if None in assembly.train.flows.values():
        system = assembly.system(BEAM)
        motion = system.static(system.load(rotor_loads(assembly, point)))
        forces |= loop_forces(assembly, system, motion, point.label)
    return {pair.name: forces[pair.name] for pair in assembly.train.pairs}


def torque_of(assembly: Assembly, mesh: str, force: float) -> OperatingPoint:
    """Return the torque of the engine's shaft that brings a force to a mesh, N."""
    unit = OperatingPoint(torque=1.0, of=assembly.train.reference)
    unit_force = _by_torque(assembly, unit)[mesh]
    if not unit_force:
        raise SolidgearError(f"no torque passes the {mesh} between engine and load")
    return unit.with_changes(torque=force / unit_force)


def mesh_of(system: System, name: str) -> RowSpring:
    """Return the link of a mesh."""
    mesh = system.links[name]
    assert isinstance(mesh, RowSpring)
    return mesh


def ends(
    assembly: Assembly, highest_hz: float | None, lowest_hz: float | None
) -> tuple[float, float]:
    """Return the lowest and the highest frequency of the mesh, those of the file where they are not
    given; a range that holds zero is refused.
    """
    highest = highest_hz or assembly.train.ask.max_frequency
    lowest = BEGIN * highest if lowest_hz is None else lowest_hz
    if not 0 < lowest < highest:
        raise SolidgearError(
            f"mesh frequencies from {lowest:g} to {highest:g} Hz; give ascending ends above 0"
        )
    return lowest, highest


def with_backlash(
    assembly: Assembly,
    models: Sequence[str],
    teeth: Teeth,
    highest_hz: float | None = None,
    lowest_hz: float | None = None,
    progress: Callable[[str], None] = lambda text: None,
    search_speeds: int = 0,
) -> Backlash:
    """Compute the periodic motion of a train whose teeth have backlash, by models of the shafts,
    between frequencies of the driven mesh (the highest is by default that of the file, the
    lowest a hundredth of it), and search branches apart at so many speeds.

    Examples
    --------
    >>> import solidgear as sg
    >>> train = sg.load_train("geometry/axle_overhung.toml")
    >>> mesh = train.mesh.with_changes(backlash="100 um", transmission_error="10 um")
    >>> assembly = Assembly(train.with_changes(mesh=mesh))
    >>> teeth = teeth_of(assembly, mean_force=5000.0)
    >>> found = with_backlash(assembly, ["lumped/timoshenko"], teeth, 1000.0, 500.0)
    >>> [jump.rising for jump in found.jumps][:2]
    [True, False]
    """
    lowest, highest = ends(assembly, highest_hz, lowest_hz)
    begin = process_time()
    most = max(assembly.train.ask.max_frequency, highest)
    mix = assembly.models_by_shaft(models)
    reached = highest * _highest_order(assembly, teeth)
    model = backlash_model(assembly, models, teeth, most, reached)
    resolved = max(most, resolved_frequency(assembly, assembly.system(*models)))
    label = " + ".join(mix.values())
    progress(f"branch of {label}")
    branch = follow(model, 2 * np.pi * lowest, 2 * np.pi * highest, step=STEP)
    backlash = Backlash(
        models=mix,
        teeth=teeth,
        remainder=model,
        branch=branch,
        multiplier=largest_multipliers(branch),
        seconds=process_time() - begin,
        unmet_hz=(reached, resolved) if reached > resolved else None,
    )
    if not search_speeds:
        return backlash
    progress(f"separate branches of {label}")
    with_branches = search_branches(backlash, search_speeds, STEP)
    return replace(with_branches, seconds=process_time() - begin)


def _highest_order(assembly: Assembly, teeth: Teeth) -> int:
    """Return the highest order of the driven mesh that excites it."""
    turns = CYCLE_ORDERS if teeth.turns else 1
    return max(teeth.highest_order, turns)


def search_branches(backlash: Backlash, count: int, step: float) -> Backlash:
    """Return the same with the branches apart that are found from starts at so many speeds."""
    omega = 2 * np.pi * _start_frequencies(backlash, count)
    results = search(backlash.branch, omega.tolist(), step)
    branches = tuple(
        replace(
            backlash,
            branch=branch.branch,
            multiplier=largest_multipliers(branch.branch),
            periods=branch.periods,
            end=branch.end,
        )
        for branch in results.branches
    )
    return replace(backlash, search=results, branches_apart=branches)


def largest_multipliers(branch: Branch) -> np.ndarray:
    """Return the (p,) largest multiplier of each motion."""
    return np.array([multipliers(point)[0] for point in branch.points])


def _start_frequencies(backlash: Backlash, count: int) -> np.ndarray:
    """Return frequencies in even ratios over those at which the linear force of some mesh exceeds a
    share of the mean, or over all where the mesh varies, Hz.
    """
    hz = backlash.frequency_hz
    if not backlash.teeth.varies:
        hz = backlash.linear[0]
        lively = [mesh.linear[1] > LIVELY * mesh.teeth.mean_force for mesh in backlash.meshes]
        hz = hz[np.any(lively, axis=0)]
    return np.geomspace(hz.min(), hz.max(), count) if len(hz) else hz


def over_force(
    backlash: Backlash, count: int, progress: Callable[[str], None] = lambda text: None
) -> tuple[AtForce, ...]:
    """Return the jumps at so many mean forces of the driven teeth, equally apart, up to that above
    which none part.
    """
    most = backlash.holding[1].max()
    out = []
    for share in np.arange(1, count + 1) / count:
        force = float(share * most)
        progress(f"mean force {force:.0f} N")
        mean = backlash.remainder.mean * (force / backlash.teeth.mean_force)
        ends = backlash.branch.omega[0], backlash.branch.omega[-1]
        branch = follow(replace(backlash.remainder, mean=mean), *map(float, ends), step=STEP)
        solved = replace(backlash, branch=branch)
        jumps = tuple((jump.frequency_hz, jump.rising) for jump in solved.jumps)
        out.append(AtForce(force, jumps, float(solved.force.max())))
    return tuple(out)


@dataclass(frozen=True)
class InTime:
    """A motion found in time, compared with the nearest of the branch."""

    plain_names = ("frequency_hz", "rising", "cycle", "force", "branch_force", ("off", "error"))

    frequency_hz: float
    rising: bool  #: whether the speed rose to it
    cycle: int  #: periods of the mesh after which it repeats itself; 0 where it never did
    force: float
    branch_force: float  #: N, of the stable motion nearest to it

    @property
    def error(self) -> float:
        """Difference of the forces, relative."""
        return self.force / self.branch_force - 1


def in_time(
    backlash: Backlash, count: int, progress: Callable[[str], None] = lambda text: None
) -> tuple[InTime, ...]:
    """Sweep up and down by integration in time, over so many speeds at which the teeth part, from
    the motions of the branch at both ends.
    """
    spans = [span for mesh in backlash.meshes for span in mesh.lost]
    if not spans:
        return ()
    low = max(min(span.low for span in spans) * 0.97, backlash.frequency_hz.min())
    high = min(max(span.high for span in spans) * 1.03, backlash.frequency_hz.max())
    rising_hz = np.linspace(low, high, count)
    out: list[InTime] = []
    for rising, hz in ((True, rising_hz), (False, rising_hz[::-1])):
        progress(f"in time, speed {'rising' if rising else 'falling'}")
        begin = backlash.branch.at(2 * np.pi * float(hz[0]))[0 if rising else -1].state()
        steady = sweep(backlash.remainder, (2 * np.pi * hz).tolist(), state=begin, steady=FADED)
        out += [_nearest_motion(backlash, motion, rising) for motion in steady]
    return tuple(out)


def _nearest_motion(backlash: Backlash, steady: Steady, rising: bool) -> InTime:
    force = float(np.ptp(steady.force[:, 0]) / 2)
    sizes = [float(np.ptp(p.forces()[:, 0]) / 2) for p in backlash.motions_at(steady.omega)]
    nearest = min(sizes, key=lambda size: abs(size - force))
    return InTime(steady.omega / (2 * np.pi), rising, steady.cycle, force, nearest)


@dataclass(frozen=True, eq=False)
class TurningLine:
    """A line of action over the mesh cycle."""

    mean: np.ndarray  #: (12,) row of the mean line on the pinion, and on the gear
    further: np.ndarray  #: (r, 12) rows by which it turns
    orders: np.ndarray  #: (o, r) how much of each, by orders of the mesh


def orders_of(angle: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean (c,) of a table (n, c) over a mesh cycle, linear between the angles, and
    complex orders (o, c) from 1.
    """
    angles = np.linspace(angle[0], angle[-1], CYCLE_PLACES, endpoint=False)
    values_at = np.column_stack(
        [np.interp(angles, angle, column) for column in np.transpose(values)]
    )
    parts = np.fft.rfft(values_at, axis=0) / CYCLE_PLACES
    return parts[0].real, 2 * parts[1 : CYCLE_ORDERS + 1]


def turning_line(assembly: Assembly, pair: Pair) -> TurningLine | None:
    """Return the mean row of the teeth of a mesh, and how it turns; None where the line stays.
    Refused for teeth that hold their mesh point or act on the other flank, and for lever arms
    that are not in the ratio of the teeth.
    """
    table, path = pair.mesh.line_cycle, (*pair.paths["mesh"], "line_cycle")
    if table is None:
        return None
    if pair.mesh.local_harmonics:
        raise SceneError(
            "moves the mesh point, which local_harmonics fix on the rim; leave one out",
            path=path,
        )
    if pair.point is not None and pair.point.coast:
        raise SceneError(
            "belongs to one flank; a torque on the other flank (coast, below zero) needs a file "
            "with its own",
            path=path,
        )
    rows = [
        _row(assembly, pair, np.array(normal), np.array(point), path)
        for normal, point in zip(table.normal, table.point)
    ]
    mean, orders = orders_of(np.array(table.angle), np.array(rows))
    left_vectors, size, right = np.linalg.svd(
        np.vstack([orders.real, orders.imag]), full_matrices=False
    )
    notable = size > STILL * np.abs(mean).max()
    shares = (left_vectors * size)[:, notable]
    shares = shares[: len(orders)] + 1j * shares[len(orders) :]
    scale = np.abs(shares).sum(axis=0)  # so that shares are one at most
    return TurningLine(mean, scale[:, None] * right[notable], shares / scale)


def _row(
    assembly: Assembly, pair: Pair, normal: np.ndarray, point: np.ndarray, path: tuple
) -> np.ndarray:
    """Return the (12,) row of the teeth on both shafts while they touch at a point."""
    contact = assembly.contacts[pair.name]
    normal = normal / np.linalg.norm(normal)
    angle = pair.mesh.shaft_angle
    vectors = (
        MeshVector(normal, point),
        MeshVector(to_gear_frame(normal, angle), to_gear_frame(point - contact.origin, angle)),
    )
    turns = [axes_of(pair, side) for side in pair.members]
    in_scenes = [
        MeshVector(turn @ vector.normal, turn @ vector.point)
        for turn, vector in zip(turns, vectors)
    ]
    ratio = contact.gear.lever / contact.pinion.lever
    levers = in_scenes[1].lever / in_scenes[0].lever if in_scenes[0].lever else np.inf
    if not abs(levers / ratio - 1) < LEVER_REFUSED or in_scenes[0].lever * contact.pinion.lever < 0:
        place = ", ".join(f"{1e3 * v:.2f}" for v in point)
        raise SceneError(
            f"has lever arms of {1e3 * in_scenes[0].lever:.2f} mm on the pinion and "
            f"{1e3 * in_scenes[1].lever:.2f} mm on the gear where the mesh point is ({place}) mm; those of "
            f"the mesh are {1e3 * contact.pinion.lever:.2f} and {1e3 * contact.gear.lever:.2f} mm",
            path=path,
        )
    gear = in_scenes[1].vector.copy()
    gear[AXIAL] = ratio * in_scenes[0].vector[AXIAL]
    return np.concatenate([in_scenes[0].vector, gear])
