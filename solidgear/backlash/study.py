"""A train with backlash by several mixes of models: sentences, the cheapest model for jumps and force,
and plain data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from solidgear.backlash.periodic import AtForce, Backlash, Largest, Range, Teeth, range_of
from solidgear.backlash.solver.apart import STARTS
from solidgear.backlash.speed_run import SpeedRun
from solidgear.backlash.train import LIVELY, InTime
from solidgear.core.plain import plain
from solidgear.trains.file.layout import PerTurn
from solidgear.trains.file.train import Train

#: a frequency, or several
Frequency = TypeVar("Frequency", float, np.ndarray)
CALM = "The teeth keep contact in all of the range: the linear answer holds to the last digit."
UNMET = (
    "Orders of the mesh reach {0:.0f} Hz, but the shafts resolve modes up to {1:.0f} Hz only: those "
    "above act as springs, and what orders do to them is left out; keep more modes (--kept)."
)
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
DEPENDS = (
    "All of it depends on losses, backlash and transmission error, and has no error bar; "
    "harmonics are followed to 1e-4 of the largest."
)
PERIODS = {1: "one mesh period", 2: "two mesh periods", 3: "three mesh periods"}
APART = "A separate branch of {0} from {1}: {2}."
MERGED = "Motions of {0} come off a branch from {1}: {2}."
SEARCHED = (
    "Separate branches, which a blow can reach but a slow sweep cannot, were searched from {0} "
    "starts at {1} speeds from {2}, with 1 to {3} mesh periods{4}."
)
OTHERS, NONE = "; there may be others", ": none was found, and there may be some"
UNSEARCHED = "Branches separate from this one were not searched."
QUIET = (
    "Separate branches were not searched: the linear force stays below {0:.0f} % of the mean force."
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

    @property
    def teeth_a_turn(self) -> PerTurn:
        """Teeth of the driven mesh that pass in one turn of the engine's shaft."""
        return self.train.per_turn(self.train.named_mesh(self.teeth.mesh))

    def sentences(self) -> list[str]:
        """Return sentences on the first mix, and on which of the others is enough."""
        judge, teeth = self.judge, self.teeth
        compared = [*self._run_lines(), *self._verdict()]
        if judge.unmet_hz is not None:
            reached, resolved = judge.unmet_hz
            compared.append(UNMET.format(reached, resolved))
        parts = any(mesh.lost for mesh in judge.meshes)
        if not parts and not teeth.varies and not judge.branches_apart:
            return [CALM, *self._search_lines(), *compared]
        lines = [line for mesh in judge.meshes for line in self._contact(mesh)]
        jumps = [
            f"jumps at {self._place(jump.frequency_hz)} as the speed {'rises' if jump.rising else 'falls'}"
            for jump in judge.jumps
        ]
        lines.append(f"The motion {', and '.join(jumps) or 'does not jump'}.")
        lines += self._turns_back(judge)
        lines += [WANDERS.format(self._range(span), kind) for kind, span in judge.wandering]
        lines += self._search_lines()
        lines += [self._loudest(mesh) for mesh in judge.meshes]
        if not teeth.varies:
            holding = float(judge.holding[1].max())
            lines.append(
                f"At mean forces{self._mesh(judge)} above {holding:.0f} N "
                f"({holding * self.lever:.0f} N m on the {self.train.reference}) the teeth never "
                "part on the branch from low speed."
            )
        lines += [line for mesh in judge.meshes for line in self._linear_errors(mesh)]
        lines += [*self._time_check(), *compared]
        if teeth.contact_loss_hz:
            lines.append(IN_CONTACT.format(teeth.contact_loss_hz))
        if not teeth.phases and (teeth.varies or len(teeth.errors) > 1):
            lines.append(PHASES)
        return [*lines, DEPENDS]

    def rpm(self, hz: Frequency) -> Frequency:
        """Return speeds of the engine's shaft at frequencies of the driven mesh."""
        return 60 * hz / self.teeth_a_turn

    def _place(self, hz: float) -> str:
        return f"{hz:.1f} Hz ({self.rpm(hz):.0f} rpm)"

    def _force(self, largest: Largest) -> str:
        return f"{largest.force:.0f} N at {self._place(largest.frequency_hz)}"

    def _range(self, span: Range) -> str:
        low, high = span.low, span.high
        return f"{low:.0f} to {high:.0f} Hz ({self.rpm(low):.0f} to {self.rpm(high):.0f} rpm)"

    def _mesh(self, mesh: Backlash, word: str = "of") -> str:
        """Return the name of the mesh as a suffix, where there are several."""
        return f" {word} the {mesh.teeth.mesh}" if len(self.train.meshes) > 1 else ""

    def _contact(self, mesh: Backlash) -> list[str]:
        """Return sentences on where the teeth of a mesh part, and the other flank is hit."""
        suffix = self._mesh(mesh)
        if not mesh.lost:
            has_no_gap = suffix and not mesh.teeth.half_gap
            return [] if has_no_gap else [f"The teeth{suffix} keep contact in all of the range."]
        lost, hit = ("; from ".join(map(self._range, r)) for r in (mesh.lost, mesh.both_flanks))
        lines = [f"The teeth{suffix} part from {lost}."]
        return [*lines, f"The other flank{suffix} is hit from {hit}."] if hit else lines

    def _turns_back(self, mix: Backlash) -> list[str]:
        label = mix.label[0].upper() + mix.label[1:]
        return [RETURNS.format(label, self._place(mix.returns))] if mix.returns else []

    def _search_lines(self) -> list[str]:
        """Return sentences on starts of the search for branches apart, and on those found."""
        search, branches = self.judge.search, self.judge.branches_apart
        if search is None:
            return [UNSEARCHED]
        if not len(search.omega):
            return [QUIET.format(100 * LIVELY)]
        lines = []
        for branch in branches:
            motion = "nowhere stable"
            if branch.calm:
                motion = (
                    f"stable from {self._range(branch.calm)}, up to {self._force(branch.loudest)}; "
                    f"in time a period is off by {100 * branch.departs:.1g} %"
                )
            sentence = MERGED if branch.end == "merged" else APART
            span = self._range(range_of(branch.frequency_hz))
            lines.append(sentence.format(PERIODS[branch.periods], span, motion))
        span = self._range(range_of(search.omega / (2 * np.pi)))
        outcome = OTHERS if branches else NONE
        lines.append(SEARCHED.format(search.starts, len(search.omega), span, max(STARTS), outcome))
        if search.lost:
            lost = ", ".join(self._place(omega / (2 * np.pi)) for omega in sorted({*search.lost}))
            lines.append(f"Further motions at {lost} could not be followed.")
        return lines

    def _loudest(self, mesh: Backlash) -> str:
        """Return a sentence on the largest dynamic force of a mesh, and that without backlash."""
        branch = ""
        if mesh.worst is not mesh:
            branch = f" on a separate branch, {self._force(mesh.loudest)} on this one"
        return (
            f"Largest dynamic mesh force{self._mesh(mesh)} {self._force(mesh.worst.loudest)}"
            f"{branch}; linear: {self._force(mesh.linear_loudest)}."
        )

    def _linear_errors(self, mesh: Backlash) -> list[str]:
        decibels, suffix = self.train.ask.decibels, self._mesh(mesh, "for")
        errors = mesh.linear_errors(decibels)
        if not errors:
            return [f"The linear answer{suffix} is off by less than {decibels:g} dB everywhere."]
        return [
            f"The linear answer{suffix} is off by {abs(error):.1f} dB at most, too "
            f"{'high' if error > 0 else 'low'}, from {self.rpm(span.low):.0f} to "
            f"{self.rpm(span.high):.0f} rpm ({span.low:.0f} to {span.high:.0f} Hz)."
            for span, error in errors
        ]

    def _time_check(self) -> list[str]:
        if not self.in_time:
            return []
        places: dict[int, list[str]] = {}
        for run in self.in_time:
            places.setdefault(run.cycle, []).append(self._place(run.frequency_hz))
        if 1 not in places:
            return ["In time no motion repeated itself every mesh period."]
        worst = max(abs(run.error) for run in self.in_time if run.cycle == 1)
        lines = [
            f"Integration in time agrees within {100 * worst:.2g} % in mesh "
            f"force{self._mesh(self.judge)} at {len(places[1])} of {len(self.in_time)} speeds, "
            "swept up and down."
        ]
        for cycle in sorted(cycle for cycle in places if cycle > 1):
            longer = ", ".join(places[cycle])
            lines.append(f"It repeats itself after {cycle} mesh periods at {longer}.")
        if 0 in places:
            lines.append(f"It reached no steady motion at {', '.join(places[0])}.")
        return lines

    def _run_lines(self) -> list[str]:
        """Return sentences on each run through the range, compared with the steady motions."""
        lines, tolerance = [], self.train.ask.tolerance
        for run in [mesh_run for whole_run in self.runs for mesh_run in whole_run.meshes]:
            suffix = self._mesh(run.backlash)
            contact = f"the teeth{suffix} keep contact"
            if run.lost:
                share = 100 * float(np.mean(run.parted))
                contact = f"the teeth{suffix} part in {share:.3g} %, from {self._range(run.lost)}"
            lines.append(
                f"Run {run.way} at {self.rpm(abs(run.ramp)):.6g} rpm/s: largest dynamic mesh "
                f"force{suffix} {self._force(run.loudest)}; stable motions of this branch "
                f"reach {self._force(run.backlash.loudest)}."
            )
            lines.append(
                f"In {100 * run.followed(tolerance):.0f} % of its {len(run.force)} mesh cycles the "
                f"force is within {100 * tolerance:g} % of a stable motion's; {contact}."
            )
        return lines

    def _verdict(self) -> list[str]:
        ask, lines, expected = self.train.ask, [], len(self.judge.jumps)
        for result, mix in zip(self.sufficiency(), self.mixes[1:]):
            if mix.returns:
                lines += self._turns_back(mix)
                continue
            jumps = "no jump, as here"
            if result.jumps is None:
                jumps = f"{result.count} jumps instead of {expected}"
            elif expected:
                jumps = f"jumps off by {100 * result.jumps:.1f} %"
            word = "enough" if result.enough else "not enough"
            suffix = f" of the {result.mesh}" if len(self.train.meshes) > 1 else ""
            lines.append(
                f"{result.label[0].upper()}{result.label[1:]}: {word} ({jumps}, largest "
                f"force{suffix} {100 * result.force:+.1f} %; asked {100 * ask.tolerance:g} % and "
                f"{ask.decibels:g} dB)."
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
        ratios = [a.worst.loudest.force / b.worst.loudest.force for a, b in pairs]
        levels = [abs(20 * np.log10(ratio)) for ratio in ratios]
        worst = int(np.argmax(levels))
        same_jumps = jumps is not None and jumps <= ask.tolerance
        return Sufficiency(
            label=mix.label,
            jumps=jumps,
            count=len(mix_jumps),
            force=ratios[worst] - 1,
            mesh=mix.meshes[worst].teeth.mesh,
            at=mix.worst.loudest.frequency_hz / judge.worst.loudest.frequency_hz - 1,
            lost=None if None in ends else max(end for end in ends if end is not None),
            enough=same_jumps and bool(levels[worst] <= ask.decibels),
            seconds=mix.seconds,
        )

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON, SI."""
        teeth = plain(self.teeth)
        if len(self.train.meshes) <= 1:
            del teeth["mesh"], teeth["others"]
        return {
            "teeth": teeth,
            "sentences": self.sentences(),
            "mixes": [self._mix_data(mix) for mix in self.mixes],
            "beside_the_first": plain(self.sufficiency()),
            "over_mean_force": plain(self.over_force),
            "in_time": plain(self.in_time),
            "runs": [self._run_data(run) for run in self.runs],
        }

    def _run_data(self, run: SpeedRun) -> dict[str, Any]:
        tolerance = self.train.ask.tolerance
        driven, *further = [
            {
                "mesh": mesh.backlash.teeth.mesh,
                "largest": plain(mesh.loudest),
                "parts": plain(mesh.lost),
                "share_that_parts": float(np.mean(mesh.parted)),
                "tolerance": tolerance,
                "share_within_tolerance_of_steady": mesh.followed(tolerance),
            }
            for mesh in run.meshes
        ]
        del driven["mesh"]
        out = {"mesh_frequency_hz_each_second": run.ramp, "cycles": len(run.force), **driven}
        return out | ({"other_meshes": further} if further else {})

    def _mix_data(self, mix: Backlash) -> dict[str, Any]:
        driven, *further = [self._mesh_data(mesh) for mesh in mix.meshes]
        del driven["mesh"]
        search = mix.search and {
            "frequency_hz": (mix.search.omega / (2 * np.pi)).tolist(),
            "starts": mix.search.starts,
            "not_followed_hz": [omega / (2 * np.pi) for omega in mix.search.lost],
        }
        out = {
            **(mix.models if self.train.short else {"models": mix.models}),
            "points": len(mix.points),
            "harmonics": max(point.balance.count for point in mix.points),
            "parts": driven["parts"],
            "other_flank": driven["other_flank"],
            "jumps": plain(mix.jumps),
            "unstable": [{"by": kind, **plain(span)} for kind, span in mix.wandering],
            "search": search,
            "apart": [_branch_data(branch) for branch in mix.branches_apart],
            **driven,
        }
        return out | ({"other_meshes": further} if further else {})

    def _mesh_data(self, mesh: Backlash) -> dict[str, Any]:
        errors = mesh.linear_errors(self.train.ask.decibels)
        return {
            "mesh": mesh.teeth.mesh,
            "parts": plain(mesh.lost),
            "other_flank": plain(mesh.both_flanks),
            "largest": plain(mesh.worst.loudest),
            "linear_largest": plain(mesh.linear_loudest),
            "linear_off": [{**plain(span), "decibels": error} for span, error in errors],
            "orders_at_largest": mesh.worst.spectrum().tolist(),
        }


def _branch_data(branch: Backlash) -> dict[str, Any]:
    return {
        "mesh_periods": branch.periods,
        "end": branch.end,
        **plain(range_of(branch.frequency_hz)),
        "stable": plain(branch.calm),
        "largest": plain(branch.loudest) if branch.calm else None,
        "off_in_time": branch.departs,
    }


def _range_ends(mesh: Backlash) -> list[float]:
    """Return the ends of the ranges in which teeth part, Hz."""
    return [end for span in mesh.lost for end in (span.low, span.high)]


def _largest_difference(values: Sequence[float], references: Sequence[float]) -> float | None:
    """Return the largest relative difference of pairs in order; None where one list is longer."""
    if len(values) != len(references):
        return None
    return max((abs(a / b - 1) for a, b in zip(values, references)), default=0.0)
