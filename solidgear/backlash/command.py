"""The command nonlinear: a train whose teeth have backlash, over speed; its sentences, the cheapest
model for jumps and force, and plain data."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from solidgear.backlash import train as study
from solidgear.backlash.apart import branch_data, branch_sentences
from solidgear.backlash.files import lead, mixes, over_force, write_nonlinear
from solidgear.backlash.speed_run import SpeedRun, ramp_of, speed_run
from solidgear.backlash.torque import AtForce, Backlash, Jump, Range, Teeth
from solidgear.backlash.train import InTime
from solidgear.core import SceneError, SolidgearError, show
from solidgear.core.plain import plain
from solidgear.core.scene.units import quantity
from solidgear.show.command import caution, command, say
from solidgear.show.folder import held
from solidgear.show.options import Shown
from solidgear.show.units import units_named
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.slips import unit_slips
from solidgear.trains.file.layout import PerTurn
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.train import Train, named_pair
from solidgear.trains.judge.comparison import train_data
from solidgear.trains.modes.modes import unpublished_lines
from solidgear.trains.options import Mix, Reduced, TrainFile
from solidgear.trains.options import mix as read_mix

#: speeds of a sweep in time, and mean forces of a map: each takes seconds
MOST_RUNS = 200
#: at which branches apart are looked for
SPEEDS = 32


@command
def nonlinear(
    train: TrainFile,
    *,
    models: Mix,
    backlash: Annotated[
        str | None,
        typer.Option(
            help='Backlash along the line of action, such as "100 um"; by default the file\'s.'
        ),
    ] = None,
    mean_force: Annotated[
        str | None,
        typer.Option(
            "--mean-force",
            help='Mean force of the teeth, such as "5 kN"; by default by the file\'s operating '
            "point.",
        ),
    ] = None,
    error: Annotated[
        str | None,
        typer.Option(help='Transmission error, such as "10 um"; by default the file\'s.'),
    ] = None,
    mesh: Annotated[
        str | None,
        typer.Option(
            "--mesh",
            help="Mesh whose transmission error drives the train, and to which --backlash, "
            "--mean-force and --error belong; by default the first.",
        ),
    ] = None,
    min_frequency: Annotated[
        float | None,
        typer.Option("--min-frequency", help="Hz; a hundredth of the highest by default."),
    ] = None,
    against: Annotated[
        list[str] | None,
        typer.Option(
            "--against",
            help="Further models to judge, as PINION+GEAR, one for each shaft; lumped and "
            "Timoshenko shafts by default.",
        ),
    ] = None,
    apart: Annotated[
        int,
        typer.Option(
            "--apart", help="Number of speeds at which separate branches are searched; 0 for none."
        ),
    ] = SPEEDS,
    in_time: Annotated[
        int,
        typer.Option(
            "--in-time", help="Number of speeds at which to check it by integration in time."
        ),
    ] = 0,
    run_up: Annotated[
        list[float] | None,
        typer.Option(
            "--run-up",
            help="Run through the range in time at so many rpm/s of the engine's shaft; below 0 "
            "for a run-down.",
        ),
    ] = None,
    contact_loss: Annotated[
        float | None,
        typer.Option(
            "--contact-loss",
            help="Frequency in Hz at which a damper in contact only has the loss factor of the "
            "mesh.",
        ),
    ] = None,
    forces: Annotated[
        int,
        typer.Option(
            "--forces", help="Number of mean forces for a map of jumps over speed and torque."
        ),
    ] = 0,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for the branch, its chart and a page."),
    ] = None,
    reduced: Reduced,
    run: Shown,
) -> None:
    assembly = models.assembly(reduced, train)
    first, driver = (
        tuple(models.by_shaft(assembly.train).values()),
        named_pair(assembly.train, mesh),
    )
    further_mixes = _usual(assembly)
    if against is not None:
        further_mixes = [
            tuple(assembly.models_by_shaft(read_mix(text)).values()) for text in against
        ]
    assembly = _with_teeth(assembly, driver, backlash, error)
    if contact_loss is not None and not contact_loss > 0:
        raise SolidgearError(f"--contact-loss {contact_loss:g}: give a frequency above 0 Hz")
    teeth = study.teeth_of(
        assembly, _read("--mean-force", mean_force, "load"), contact_loss, driver.name
    )
    for option, count in (("--apart", apart), ("--in-time", in_time), ("--forces", forces)):
        if not 0 <= count <= MOST_RUNS:
            raise SolidgearError(f"{option} {count}: give 0 to {MOST_RUNS}")
    low, high = study.ends(assembly, reduced.max_frequency, min_frequency)
    passing = assembly.train.per_turn(driver)
    ramps = [ramp_of(rpm, passing, low, high) for rpm in run_up or []]
    with held(out) if out else nullcontext(), run.progress() as progress:
        judged = tuple(
            study.with_backlash(
                assembly, mix, teeth, reduced.max_frequency, min_frequency, progress, apart
            )
            for mix in [first, *(mix for mix in further_mixes if mix != first)]
        )
        swept = study.in_time(judged[0], in_time, progress) if in_time else ()
        mapped = study.over_force(judged[0], forces, progress) if forces else ()
        runs = tuple(speed_run(judged[0], rate, progress) for rate in ramps)
        lever = study.torque_of(assembly, driver.name, 1.0).torque
        backlash_study = BacklashStudy(assembly.train, judged, lever, swept, mapped, runs)
        title = f"{assembly.train.called}: teeth with backlash"
        if teeth.others:
            title += f", driven by the {driver.name}"
        cautions = [*unit_slips(assembly), *assembly.cautions]
        if assembly.train.planetary:
            cautions.append("teeth of planets are springs that never part")
        cautions += _beside_torque(assembly, mean_force)
        files = []
        if out:
            files = write_nonlinear(
                out, backlash_study, title, train_data(assembly), run.units, cautions
            )
    if run.as_json:
        print(json.dumps(backlash_study.as_dict() | {"cautions": cautions}, allow_nan=False))
        return
    units = units_named(run.units)
    say(
        f"{title}.",
        lead(backlash_study, units),
        *backlash_study.sentences(),
        *map(caution, cautions),
    )
    say(mixes(backlash_study, units), soft_wrap=False)
    say(*unpublished_lines(assembly.train.unpublished()))
    if mapped:
        say(over_force(backlash_study, units), soft_wrap=False)
    if files:
        say(f"Written: {', '.join(map(str, files))}")


def _beside_torque(assembly: Assembly, mean_force: str | None) -> list[str]:
    """Return cautions on further loads in a loop of meshes, which divide the torque differently."""
    point, looped = assembly.train.point, None in assembly.train.flows.values()
    if not looped or mean_force is not None or point is None or not (point.weight or point.force):
        return []
    return [
        "weight and forces on shafts, which change the force of each mesh in a loop, are left "
        "out; run solidgear deflect"
    ]


def _usual(assembly: Assembly) -> list[tuple[str, ...]]:
    """Return the models compared by default; shafts in a housing cannot be lumped."""
    usual = ("timoshenko",) if assembly.train.housed else ("lumped", "timoshenko")
    return [(model,) * len(assembly.train.shafts) for model in usual]


def _with_teeth(
    assembly: Assembly, driver: Pair, backlash: str | None, error: str | None
) -> Assembly:
    """Return the same train with the given teeth of one mesh."""
    width, size = _read("--backlash", backlash, "length"), _read("--error", error, "length")
    if width is None and size is None:
        return assembly
    for option, value, text in (("--backlash", width, backlash), ("--error", size, error)):
        if value is not None and value < 0:
            raise SolidgearError(f"{option} {show(text, 40)}: it must not be negative")
    changes: dict[str, Any] = {} if width is None else {"backlash": width}
    if size is not None:
        changes["transmission_error"] = size
    meshes = [
        pair.mesh.with_changes(**changes) if pair.name == driver.name else pair.mesh
        for pair in assembly.train.pairs
    ]
    return assembly.with_train(assembly.train.with_changes(meshes=tuple(meshes)))


def _read(option: str, text: str | None, dimension: str) -> float | None:
    """Return a quantity of an option in SI."""
    if text is None:
        return None
    try:
        return quantity(text, dimension)
    except SceneError as error:
        raise SolidgearError(f"{option} {show(text, 40)}: {error}") from None


#: of motions that repeat themselves otherwise than every mesh period
WANDERS = "From {0} the periodic motion is unstable: {1} comes in, and a sweep may leave it there."
PHASES = (
    "The file gives no phases of the transmission error, so its orders are cosines from the start "
    "of the stiffness cycle, positive where teeth stand back; other phases give other forces."
)
RETURNS = (
    "{0}: the branch turns back at {1} and leaves the range where it began, so that higher speeds "
    "are not judged; give a lower --min-frequency."
)
IN_CONTACT = (
    "The mesh loses energy only in contact, by a damper with the mesh's loss factor at {0:g} Hz, "
    "which is part of the mesh forces."
)


@dataclass(frozen=True)
class Sufficiency:
    """A mix of models compared with the first one."""

    label: str
    #: largest relative error of the frequency of a jump; None where there are more or fewer
    jumps: float | None
    count: int  #: of its jumps
    #: relative error of the largest dynamic mesh force, of several meshes the worst in decibels
    force: float
    mesh: str  #: that mesh
    at: float  #: relative error of where that of the driven mesh is
    #: largest relative error of an end of the ranges in which teeth part; None as above
    lost: float | None
    #: jumps within the tolerance, all of them there, and the force within the decibels
    enough: bool
    seconds: float


@dataclass(frozen=True, eq=False)
class BacklashStudy:
    """A train with backlash by several mixes of models, the first one the judge of the others."""

    train: Train
    mixes: tuple[Backlash, ...]
    lever: float  #: torque of the engine's shaft over the force of the driven mesh, m
    in_time: tuple[InTime, ...] = ()  #: of the first
    over_force: tuple[AtForce, ...] = ()  #: of the first
    runs: tuple[SpeedRun, ...] = ()  #: of the first

    @property
    def judge(self) -> Backlash:
        """The first mix."""
        return self.mixes[0]

    @property
    def teeth(self) -> Teeth:
        """Teeth that all mixes share."""
        return self.judge.teeth

    def _place(self, hz: float) -> str:
        return f"{hz:.1f} Hz ({self._rpm(hz):.0f} rpm)"

    @property
    def teeth_a_turn(self) -> PerTurn:
        """Teeth of the driven mesh that pass in one turn of the engine's shaft."""
        return self.train.per_turn(self.train.named_mesh(self.teeth.mesh))

    def _rpm(self, hz: float) -> float:
        return 60 * hz / self.teeth_a_turn

    def _range(self, span: Range) -> str:
        return f"{span.low:.0f} to {span.high:.0f} Hz ({self._rpm(span.low):.0f} to {self._rpm(span.high):.0f} rpm)"

    def sentences(self) -> list[str]:
        """Return sentences on the first mix, and on which of the others is enough."""
        judge = self.judge
        calm = not any(mesh.lost for mesh in judge.meshes) and not judge.teeth.varies
        if calm and not judge.branches_apart:
            return [
                "The teeth keep contact in all of the range: the linear answer holds to the last "
                "digit.",
                *branch_sentences(judge, self._place, self._range),
                *self._run_lines(),
                *self._verdict(),
            ]
        lines = [line for mesh in judge.meshes for line in self._contact(mesh)]
        lines += self._jumps(judge.jumps)
        lines += self._turns_back(judge)
        lines += [WANDERS.format(self._range(span), kind) for kind, span in judge.wandering]
        lines += branch_sentences(judge, self._place, self._range)
        for mesh in judge.meshes:
            (hz, size), (linear_hz, linear) = mesh.worst.loudest, mesh.linear_loudest
            place = ""
            if mesh.worst is not mesh:
                branch_hz, branch_size = mesh.loudest
                place = (
                    f" on a separate branch, {branch_size:.0f} N at {self._place(branch_hz)} on "
                    "this one"
                )
            lines.append(
                f"Largest dynamic mesh force{self._mesh_suffix(mesh)} {size:.0f} N at "
                f"{self._place(hz)}{place}; linear: {linear:.0f} N at {self._place(linear_hz)}."
            )
        if not judge.teeth.varies:
            holding = float(judge.holding[1].max())
            lines.append(
                f"At mean forces{self._mesh_suffix(judge)} above {holding:.0f} N "
                f"({holding * self.lever:.0f} N m on the {self.train.reference}) the teeth never part on the branch from low speed."
            )
        lines += [line for mesh in judge.meshes for line in self._linear_errors(mesh)]
        lines += [*self._time_check(), *self._run_lines(), *self._verdict()]
        if judge.teeth.contact_loss_hz:
            lines.append(IN_CONTACT.format(judge.teeth.contact_loss_hz))
        if not judge.teeth.phases and (judge.teeth.varies or len(judge.teeth.errors) > 1):
            lines.append(PHASES)
        lines.append(
            "All of it depends on losses, backlash and transmission error, and has no error bar; "
            "harmonics are followed to 1e-4 of the largest."
        )
        return lines

    def _jumps(self, jumps: Sequence[Jump]) -> list[str]:
        jump_texts = [
            f"jumps at {self._place(jump.frequency_hz)} as the speed {'rises' if jump.rising else 'falls'}"
            for jump in jumps
        ]
        return (
            [f"The motion {', and '.join(jump_texts)}."]
            if jump_texts
            else ["The motion does not jump."]
        )

    def _turns_back(self, mix: Backlash) -> list[str]:
        label = mix.label[0].upper() + mix.label[1:]
        return [RETURNS.format(label, self._place(mix.returns))] if mix.returns else []

    def _mesh_suffix(self, mesh: Backlash, word: str = "of") -> str:
        """Return the name of the mesh as a suffix, where there are several."""
        return f" {word} the {mesh.teeth.mesh}" if len(self.train.meshes) > 1 else ""

    def _contact(self, mesh: Backlash) -> list[str]:
        """Return sentences on where the teeth of a mesh part, and the other flank is hit."""
        if not mesh.lost:
            linear = len(self.train.meshes) > 1 and not mesh.teeth.half_gap
            return (
                []
                if linear
                else [f"The teeth{self._mesh_suffix(mesh)} keep contact in all of the range."]
            )
        lines = [f"The teeth{self._mesh_suffix(mesh)} part from {self._ranges(mesh.lost)}."]
        if mesh.both_flanks:
            lines.append(
                f"The other flank{self._mesh_suffix(mesh)} is hit from {self._ranges(mesh.both_flanks)}."
            )
        return lines

    def _ranges(self, spans: Sequence[Range]) -> str:
        return "; from ".join(map(self._range, spans))

    def _linear_errors(self, mesh: Backlash) -> list[str]:
        decibels, suffix = self.train.ask.decibels, self._mesh_suffix(mesh, "for")
        errors = mesh.linear_errors(decibels)
        if not errors:
            return [f"The linear answer{suffix} is off by less than {decibels:g} dB everywhere."]
        return [
            f"The linear answer{suffix} is off by {abs(error):.1f} dB at most, too "
            f"{'high' if error > 0 else 'low'}, from {self._rpm(span.low):.0f} to "
            f"{self._rpm(span.high):.0f} rpm ({span.low:.0f} to {span.high:.0f} Hz)."
            for span, error in errors
        ]

    def _time_check(self) -> list[str]:
        periodic = [run for run in self.in_time if run.cycle == 1]
        if not self.in_time:
            return []
        if not periodic:
            return ["In time no motion repeated itself every mesh period."]
        worst = max(periodic, key=lambda run: abs(run.error))
        lines = [
            f"Integration in time agrees within {100 * abs(worst.error):.2g} % in mesh "
            f"force{self._mesh_suffix(self.judge)} at {len(periodic)} of {len(self.in_time)} speeds, swept up and down."
        ]
        longer = sorted({run.cycle for run in self.in_time if run.cycle > 1})
        for cycle in longer:
            places = [self._place(run.frequency_hz) for run in self.in_time if run.cycle == cycle]
            lines.append(f"It repeats itself after {cycle} mesh periods at {', '.join(places)}.")
        unsteady = [self._place(run.frequency_hz) for run in self.in_time if run.cycle == 0]
        if unsteady:
            lines.append(f"It reached no steady motion at {', '.join(unsteady)}.")
        return lines

    def _run_lines(self) -> list[str]:
        """Return sentences on each run through the range, compared with the steady motions."""
        lines = []
        for run in [mesh_run for whole_run in self.runs for mesh_run in whole_run.meshes]:
            hz, size = run.loudest
            steady_hz, steady = run.backlash.loudest
            direction, suffix = "up" if run.ramp > 0 else "down", self._mesh_suffix(run.backlash)
            tolerance, contact = self.train.ask.tolerance, f"the teeth{suffix} keep contact"
            if run.lost:
                share = 100 * float(np.mean(run.parted))
                contact = f"the teeth{suffix} part in {share:.3g} %, from {self._range(run.lost)}"
            lines.append(
                f"Run {direction} at {self._rpm(abs(run.ramp)):.6g} rpm/s: largest dynamic mesh force{suffix} "
                f"{size:.0f} N at {self._place(hz)}; stable motions of this branch "
                f"reach {steady:.0f} N at {self._place(steady_hz)}."
            )
            lines.append(
                f"In {100 * run.followed(tolerance):.0f} % of its {len(run.force)} mesh cycles the "
                f"force is within {100 * tolerance:g} % of a stable motion's; {contact}."
            )
        return lines

    def sufficiency(self) -> tuple[Sufficiency, ...]:
        """Compare each further mix with the first."""
        return tuple(self._against_judge(mix) for mix in self.mixes[1:])

    def _against_judge(self, mix: Backlash) -> Sufficiency:
        ask, judge = self.train.ask, self.judge
        mix_jumps, judge_jumps = (sorted(j.frequency_hz for j in b.jumps) for b in (mix, judge))
        jumps = _largest_difference(mix_jumps, judge_jumps)
        pairs = [*zip(mix.meshes, judge.meshes)]
        ends = [_largest_difference(_range_ends(a), _range_ends(b)) for a, b in pairs]
        range_error = None if None in ends else max(e for e in ends if e is not None)
        ratios = [a.worst.loudest[1] / b.worst.loudest[1] for a, b in pairs]
        levels = [abs(20 * np.log10(force_ratio)) for force_ratio in ratios]
        worst = int(np.argmax(levels))
        same_jumps = jumps is not None and jumps <= ask.tolerance
        return Sufficiency(
            label=mix.label,
            jumps=jumps,
            count=len(mix_jumps),
            force=ratios[worst] - 1,
            mesh=mix.meshes[worst].teeth.mesh,
            at=mix.worst.loudest[0] / judge.worst.loudest[0] - 1,
            lost=range_error,
            enough=same_jumps and bool(levels[worst] <= ask.decibels),
            seconds=mix.seconds,
        )

    def _verdict(self) -> list[str]:
        ask, lines = self.train.ask, []
        for result, mix in zip(self.sufficiency(), self.mixes[1:]):
            if mix.returns:
                lines += self._turns_back(mix)
                continue
            expected = len(self.judge.jumps)
            if result.jumps is None:
                jumps = f"{result.count} jumps instead of {expected}"
            else:
                jumps = (
                    f"jumps off by {100 * result.jumps:.1f} %" if expected else "no jump, as here"
                )
            word = "enough" if result.enough else "not enough"
            suffix = f" of the {result.mesh}" if len(self.train.meshes) > 1 else ""
            lines.append(
                f"{result.label[0].upper()}{result.label[1:]}: {word} ({jumps}, largest force{suffix} "
                f"{100 * result.force:+.1f} %; asked {100 * ask.tolerance:g} % and {ask.decibels:g} dB)."
            )
        return lines

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON, SI."""
        return {
            "teeth": self._teeth_data(),
            "sentences": self.sentences(),
            "mixes": [self._mix_data(mix) for mix in self.mixes],
            "beside_the_first": plain(self.sufficiency()),
            "over_mean_force": plain(self.over_force),
            "in_time": plain(self.in_time),
            "runs": [self._run_data(run) for run in self.runs],
        }

    def _teeth_data(self) -> dict[str, Any]:
        """Return the teeth as plain data; the only mesh has no name and no others."""
        data = plain(self.teeth)
        if len(self.train.meshes) > 1:
            return data
        return {key: value for key, value in data.items() if key not in ("mesh", "others")}

    def _run_data(self, run: SpeedRun) -> dict[str, Any]:
        other_meshes = [
            {"mesh": mesh_run.backlash.teeth.mesh, **self._run_of_mesh(mesh_run)}
            for mesh_run in run.meshes[1:]
        ]
        return {
            "mesh_frequency_hz_each_second": run.ramp,
            "cycles": len(run.force),
            **self._run_of_mesh(run),
            **({"other_meshes": other_meshes} if other_meshes else {}),
        }

    def _run_of_mesh(self, run: SpeedRun) -> dict[str, Any]:
        hz, size = run.loudest
        return {
            "largest": {"frequency_hz": hz, "force": size},
            "parts": plain(run.lost),
            "share_that_parts": float(np.mean(run.parted)),
            "tolerance": self.train.ask.tolerance,
            "share_within_tolerance_of_steady": run.followed(self.train.ask.tolerance),
        }

    def _mix_data(self, mix: Backlash) -> dict[str, Any]:
        models = mix.models if self.train.short else {"models": mix.models}
        other_meshes = [{"mesh": m.teeth.mesh, **self._mesh_data(m)} for m in mix.meshes[1:]]
        driven = self._mesh_data(mix)
        return {
            **models,
            "points": len(mix.points),
            "harmonics": max(point.balance.count for point in mix.points),
            "parts": driven["parts"],
            "other_flank": driven["other_flank"],
            "jumps": plain(mix.jumps),
            "unstable": [{"by": kind, **plain(span)} for kind, span in mix.wandering],
            **branch_data(mix),
            **driven,
            **({"other_meshes": other_meshes} if other_meshes else {}),
        }

    def _mesh_data(self, mesh: Backlash) -> dict[str, Any]:
        (hz, size), (linear_hz, linear) = mesh.worst.loudest, mesh.linear_loudest
        return {
            "parts": plain(mesh.lost),
            "other_flank": plain(mesh.both_flanks),
            "largest": {"frequency_hz": hz, "force": size},
            "linear_largest": {"frequency_hz": linear_hz, "force": linear},
            "linear_off": [
                {**plain(span), "decibels": error}
                for span, error in mesh.linear_errors(self.train.ask.decibels)
            ],
            "orders_at_largest": mesh.worst.spectrum().tolist(),
        }


def _range_ends(mesh: Backlash) -> list[float]:
    """Return the ends of the ranges in which teeth part, Hz."""
    return [end for span in mesh.lost for end in (span.low, span.high)]


def _largest_difference(values: Sequence[float], references: Sequence[float]) -> float | None:
    """Return the largest relative difference of pairs in order; None where one list is longer."""
    if len(values) != len(references):
        return None
    return max((abs(a / b - 1) for a, b in zip(values, references)), default=0.0)
