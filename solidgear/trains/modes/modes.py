"""Natural frequencies of a train: names, proven bounds, and free motions."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from solidgear.core import BEAM, DOF_NAMES, LADDER, SolidgearError, System, listed
from solidgear.core.judge.at_rest import Moved
from solidgear.core.plain import plain
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.housing import free_directions, seat_motion
from solidgear.trains.assembly.local import undriven, waves_of
from solidgear.trains.assembly.local_give import local_lines
from solidgear.trains.assembly.meshes import mesh_bars, mesh_limit
from solidgear.trains.assembly.shaft import JUDGE, mix_label
from solidgear.trains.assembly.spin import spin_moved
from solidgear.trains.assembly.turn import frequencies_over_a_turn
from solidgear.trains.file.housing import HOUSING
from solidgear.trains.load.contact import Contact
from solidgear.trains.load.strain import mounts_together
from solidgear.trains.modes.naming import OVALISING, driven, mode_names

#: a frequency whose bound is above this is not resolved by the reduction
RESOLVED = 1e-3
#: of the first frequency that the reduction leaves out, up to which it promises something
PROMISED = 0.9
#: relative, of a frequency
ROUNDING = 1e-9


@dataclass(frozen=True)
class TrainMode:
    """One mode of a train."""

    plain_names = ("name", "frequency_hz", "rpm", "strained", "bound", "driven", ("bar", "mesh"))

    name: str
    frequency_hz: float
    #: speed of the engine's shaft at which the teeth of the first mesh pass at this frequency
    rpm: float
    strained: str  #: part or link with most of the strain energy, and its share
    #: largest relative error that the reduction leaves, proven; nothing of the mesh of a solid
    bound: float
    driven: bool = True  #: whether it strains the mesh or a bearing at all
    #: largest relative error that the meshes of harmonic shafts leave, by local problems; None
    #: where there are none, and where teeth drive families of two waves and more
    mesh: float | None = None


@dataclass(frozen=True, eq=False)
class TrainModes:
    """Modes of a train by models of the shafts."""

    train: str
    models: dict[str, str]  #: by shaft
    reduction: str
    coordinates: int  #: of the coupled system
    kept: dict[str, int]  #: coordinates of each shaft
    unknowns: dict[str, int]  #: of the bodies they were reduced from
    seconds: float  #: to build and reduce both shafts
    modes: tuple[TrainMode, ...]
    rigid: int  #: motions at exactly 0 Hz
    free: tuple[str, ...]  #: free motions but for that of the whole train, in words
    contact: tuple[str, ...]  #: moment that contact cells leave over, in words; empty without any
    unpublished: dict[str, str]
    cautions: tuple[str, ...]
    #: free modes (Hz) of harmonic solids that no port drives, by shaft and number of nodal
    #: diameters; they take no part in the train
    undriven: dict[str, dict[int, tuple[float, ...]]] = field(default_factory=dict)
    local: tuple[str, ...] = ()  #: compliance that harmonics at a local mesh point add, in words
    speeds: str = "pinion"  #: shaft that the speeds of modes belong to
    #: (N, modes) on the coordinates of the coupled system, mass-normalised
    shapes: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)), repr=False)
    turn: str = ""  #: change over a turn of a carrier, in words
    hidden: str = ""
    spin: Moved | None = field(default=None, repr=False)  #: what spin moves, which `cautions` say

    def as_dict(self) -> dict:
        """Return plain data for JSON."""
        out = plain(self)
        return {"train": out.pop("train")} | out.pop("models") | out

    @property
    def has_mesh_bars(self) -> bool:
        """Whether any mode has the error bar of a mesh."""
        return any(mode.mesh is not None for mode in self.modes)

    def heading(self) -> list[str]:
        """Return the title of the train, and the reduction in words."""
        kept = ", ".join(f"{side} {n} of {self.unknowns[side]}" for side, n in self.kept.items())
        return [
            f"{self.train}: {mix_label(self.models)}",
            f"Reduction {self.reduction}: {kept} unknowns; {self.coordinates} coordinates in all.",
        ]

    def remarks(self) -> list[str]:
        """Return remarks on the numbers, cautions included."""
        return self.notes() + [f"caution: {text}" for text in self.cautions]

    def notes(self) -> list[str]:
        """Return notes on the numbers."""
        lines = []
        if self.rigid == 1 and not self.free:
            lines.append("The whole train turns freely: one motion at exactly 0 Hz.")
        lines += list(self.free)
        lines += [*self._still(), *self.local, *filter(None, [self.turn, self.hidden])]
        bound = "Bound: largest relative error by the reduction, proven"
        if self.has_mesh_bars:
            bound += "; mesh: error bar of the harmonic shafts' meshes, by local problems."
        else:
            bound += "; it does not include the shafts' meshes."
        solids = {*LADDER.bodies} - {*LADDER.of(BEAM), JUDGE}
        if others := [side for side, model in self.models.items() if model in solids]:
            models = listed([*dict.fromkeys(self.models[side] for side in others)])
            bound += (
                f" What the meshes of {listed(others)} leave is not known: modes of a train have no "
                f"error bars by {models} shafts."
            )
        lines.append(bound)
        return lines + list(self.contact) + unpublished_lines(self.unpublished)

    def _still(self) -> list[str]:
        """Return a sentence on modes that the teeth do not drive, shaft by shaft, each n with the
        frequencies.
        """
        frequencies: dict[tuple[str, int], list[float]] = {}
        for side, families in self.undriven.items():
            for n, free in families.items():
                frequencies.setdefault((side, n), []).extend(free)
        for mode in self.modes:
            if not mode.driven and OVALISING in mode.name:
                side, _, wave, *_ = mode.name.split()
                frequencies.setdefault((side, int(wave.removeprefix("n="))), []).append(
                    mode.frequency_hz
                )
        if not frequencies:
            return []
        places = [
            f"{side} n={n} {', '.join(dict.fromkeys(f'{hz:.0f}' for hz in sorted(values)))} Hz"
            for (side, n), values in sorted(frequencies.items())
        ]
        text = f"Ovalising, not driven by this mesh model: {'; '.join(places)} (n nodal diameters)."
        if self.local:
            pair_note = "one of a driven pair does not move along the line of action"
            return [text.removesuffix(").") + f"; {pair_note})."]
        return [
            f"{text} Seats and teeth act on mean motions, which are zero in these modes; add them "
            "by --local-harmonics."
        ]


def unpublished_lines(unpublished: dict[str, str]) -> list[str]:
    """Return a sentence for each of identified and assumed values."""
    lines = []
    for status in ("identified", "assumed"):
        names = [key for key, value_status in unpublished.items() if value_status == status]
        if names:
            lines.append(f"{status.capitalize()}, not published: {', '.join(names)}.")
    return lines


def wrench_lines(contact: Contact) -> tuple[str, ...]:
    """Return the resultant of contact cells in words, and the moment that no mesh point carries."""
    wrench = contact.wrench
    if wrench is None:
        return ()

    def millimetres(point):
        return ", ".join(f"{1e3 * v:.2f}" for v in point)

    normal = ", ".join(f"{v:.4f}" for v in wrench.normal)
    least = wrench.left_over(wrench.point)
    lines = [
        f"Contact cells: {np.linalg.norm(wrench.force):.1f} N along ({normal}); point on the "
        f"central axis ({millimetres(wrench.point)}) mm.",
        f"{least:.3g} N m about the line of action remain at any mesh point (pitch "
        f"{1e3 * wrench.pitch:.3f} mm).",
    ]
    try:
        point = wrench.thesis_point
    except SolidgearError:
        return tuple(lines)
    lines.append(
        f"By the thesis's formulas the point is ({millimetres(point)}) mm, and "
        f"{wrench.left_over(point):.3g} N m remain."
    )
    return tuple(lines)


def train_modes(
    assembly: Assembly, *models: str, max_frequency: float | None = None, at_most: int | None = None
) -> TrainModes:
    """Return the modes of a train with the shafts by models, up to a frequency, Hz, by default that
    of the file, or so many elastic ones; refused beyond the frequencies that the reduction
    resolves.

    Examples
    --------
    >>> import solidgear as sg
    >>> assembly = Assembly(sg.load_train("geometry/axle_overhung.toml"))
    >>> found = train_modes(assembly, "timoshenko", "timoshenko", max_frequency=1000.0)
    >>> [mode.name for mode in found.modes][:2], found.modes[0].frequency_hz
    (['train rotation', 'load torsion 1'], 0.0)
    """
    train, by_shaft = assembly.train, assembly.models_by_shaft(models)
    limit = max_frequency or train.ask.max_frequency
    open_ended = at_most is not None and max_frequency is None
    open_ended = open_ended and "max_frequency" not in train.ask.model_fields_set
    assembly.follow(*models, highest_hz=np.inf if open_ended else limit, most=at_most)
    system = assembly.system(*models)
    omega, _ = system.elastic
    count = int((omega <= 2 * np.pi * limit).sum())
    if at_most is not None:
        count = min(at_most, len(omega) if open_ended else count)
        limit = float(omega[count - 1]) / (2 * np.pi) if open_ended else limit
    solved = system.modes(max(1, count))
    refuse_unresolved(assembly, system, limit)
    names, is_driven = mode_names(assembly, system, solved), driven(system, solved)
    solved = replace(solved, energy=mounts_together(solved.energy))
    for stage in assembly.stages.values():
        solved = replace(solved, energy=stage.strained(solved.energy))
    most = solved.dominant()
    highest_listed = min(limit, float(solved.frequency_hz[-1]) * (1 + ROUNDING))
    elastic = len(solved.frequency_hz) - solved.rigid
    bars = mesh_bars(assembly, system, by_shaft, elastic + 1)
    mesh_errors: list[float | None] = [None] * len(names)
    hidden = ""
    if bars is not None:
        mesh_errors[solved.rigid :] = bars[:elastic].tolist()
        hidden = _mode_below_limit(omega[elastic:], bars[elastic:], limit)
    per_turn = train.per_turn(train.drivers[0])
    modes = tuple(
        TrainMode(
            name=name,
            frequency_hz=float(hz),
            rpm=60 * float(hz) / per_turn,
            strained="" if hz == 0 else f"{most[k]} {100 * solved.energy[most[k]][k]:.0f} %",
            bound=float(solved.error_bound[k]),
            driven=bool(is_driven[k]),
            mesh=mesh_errors[k],
        )
        for k, (name, hz) in enumerate(zip(names, solved.frequency_hz))
    )
    undriven_modes = {
        side: undriven(
            assembly.shaft_model(side, model).body, limit, (*waves_of(system.parts[side]),)
        )
        for side, model in by_shaft.items()
        if model == JUDGE
    }
    spin = spin_moved(assembly, system, by_shaft, highest_listed)
    return TrainModes(
        train=train.called,
        models=by_shaft,
        reduction=assembly.reduction,
        coordinates=system.size,
        kept={side: system.parts[side].mass.shape[0] for side in by_shaft},
        unknowns={
            side: assembly.shaft_model(side, model).unknowns for side, model in by_shaft.items()
        },
        seconds=assembly.build_seconds(*models),
        modes=modes,
        rigid=solved.rigid,
        free=free_motions(assembly, system),
        contact=tuple(
            line for contact in assembly.contacts.values() for line in wrench_lines(contact)
        ),
        unpublished=train.unpublished(),
        cautions=(*assembly.cautions(*models), *([spin.sentence] if spin else [])),
        spin=spin,
        undriven={side: families for side, families in undriven_modes.items() if families},
        local=local_lines(assembly, system),
        speeds=train.reference,
        shapes=solved.shapes,
        turn=frequencies_over_a_turn(assembly, by_shaft, names),
        hidden=hidden,
    )


def _mode_below_limit(omega: np.ndarray, bars: np.ndarray, limit: float) -> str:
    """Return a sentence on the first mode above a list, rad/s, if the error bar reaches into it;
    those that follow lie no lower.
    """
    for hz, error_bar in zip(omega / (2 * np.pi), bars):
        if hz * (1 - error_bar) < limit:
            return (
                f"One more mode may lie below {limit:g} Hz: it is at {hz:.2f} Hz with an error "
                f"bar of {error_bar:.0e}."
            )
    return ""


def resolved_frequency(assembly: Assembly, system: System) -> float:
    """Return the frequency up to which reduction and meshes resolve the modes of a train, Hz."""
    cut = float(np.sqrt(system.truncation.cut) / (2 * np.pi))
    meshes = [mesh_limit(assembly, side, system.parts[side]) for side in assembly.scenes]
    return min(PROMISED * cut, *meshes)


def refuse_unresolved(assembly: Assembly, system: System, limit: float) -> None:
    """Refuse a frequency at which the reduction promises nothing, or the mesh of a shaft."""
    cut = float(np.sqrt(system.truncation.cut) / (2 * np.pi))
    if limit >= PROMISED * cut:
        raise SolidgearError(
            f"{limit:g} Hz is beyond the reduction, which leaves out modes from {cut:.0f} Hz on; "
            f"keep more modes (`kept`), or ask for less than {PROMISED * cut:.0f} Hz"
        )
    for side in assembly.scenes:
        highest = mesh_limit(assembly, side, system.parts[side])
        if limit > highest:
            raise SolidgearError(
                f"{limit:g} Hz is beyond the mesh of the {side}, which resolves about "
                f"{highest:.0f} Hz; ask for less"
            )


def free_motions(assembly: Assembly, system: System) -> tuple[str, ...]:
    """Return free motions in words, unless there is but the rotation of the whole train."""
    count = system.free.shape[1]
    if count == 0:
        return ("The train does not turn freely: a bearing resists the rotation of a shaft.",)
    turning = [part for part in system.parts if np.abs(system.free[system.place(part)]).max() > 0]
    moving = {*turning, HOUSING, *(stage.ring for stage in assembly.stages.values())}
    still = [part for part in system.parts if part not in moving]
    if count == 1 and not still:
        return ()
    if count == 1:
        return (f"Only {', '.join(turning)} turn freely; {', '.join(still)} do not turn along.",)
    loose = [
        words for side in assembly.scenes for words in _unheld_directions(assembly, system, side)
    ]
    if HOUSING in turning:
        ways = " ".join(free_directions(system))
        loose.insert(0, f"no mount holds the housing in {ways}")
    places = "; ".join(loose) or f"free to turn by themselves: {', '.join(turning)}"
    return (f"{count} motions are free, where a train should have one: {places}.",)


def _unheld_directions(assembly: Assembly, system: System, side: str) -> list[str]:
    """Return the directions in which the bearings do not hold a shaft, in words, without the
    rotation.
    """
    port = assembly.scenes[side].port.name
    rows = seat_motion(assembly.train, system, side, port)
    size = np.abs(rows @ system.free).max(axis=1)
    names = [d for d, s in zip(DOF_NAMES, size) if d != "thy" and s > 1e-6 * size.max()]
    if not names:
        return []
    return [f"the bearings of the {side}'s shaft do not hold it in {' '.join(names)}"]
