"""Backlash of a train told: sentences, which model is enough for jumps and force, plain data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from solidgear.scene.layout import PerTurn
from solidgear.scene.train import Train
from solidgear.studies.train.apart import plain, sentences
from solidgear.studies.train.backlash import AtForce, Backlash, Jump, Range, Teeth
from solidgear.studies.train.nonlinear import InTime
from solidgear.studies.train.speed_run import SpeedRun

#: of motions that repeat themselves otherwise than every mesh period
WANDERS = "From {0} the periodic motion is unstable: {1} comes in, and a sweep may leave it there."
PHASES = (
    "The file gives no phases of the transmission error: its orders are cosines that begin where the "
    "stiffness cycle begins, positive where teeth stand back; other phases give other forces."
)
RETURNS = (
    "{0}: the branch turns back at {1} and leaves the range where it began, on another motion, so that "
    "higher speeds are not judged; give a lower --min-frequency."
)
IN_CONTACT = (
    "The mesh loses energy in contact alone, by a damper that has its loss factor at {0:g} Hz and "
    "takes part in the mesh forces."
)


@dataclass(frozen=True)
class Sufficiency:
    """A mix of models beside the first one."""

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
class BacklashTold:
    """A train with backlash by several mixes of models, the first one the judge of the others."""

    train: Train
    found: tuple[Backlash, ...]
    lever: float  #: torque of the engine's shaft over the force of the driven mesh, m
    in_time: tuple[InTime, ...] = ()  #: of the first
    over_force: tuple[AtForce, ...] = ()  #: of the first
    runs: tuple[SpeedRun, ...] = ()  #: of the first

    @property
    def judge(self) -> Backlash:
        """The first mix."""
        return self.found[0]

    @property
    def teeth(self) -> Teeth:
        """Sentences that all mixes share."""
        return self.judge.teeth

    def _at(self, hz: float) -> str:
        return f"{hz:.1f} Hz ({self._rpm(hz):.0f} rpm)"

    @property
    def teeth_a_turn(self) -> PerTurn:
        """Teeth of the driven mesh that pass in one turn of the engine's shaft."""
        return self.train.per_turn(self.train.named_mesh(self.teeth.mesh))

    def _rpm(self, hz: float) -> float:
        return 60 * hz / self.teeth_a_turn

    def _range(self, one: Range) -> str:
        return f"{one.low:.0f} to {one.high:.0f} Hz ({self._rpm(one.low):.0f} to {self._rpm(one.high):.0f} rpm)"

    def sentences(self) -> list[str]:
        """Sentences of the first mix, and on which of the others is enough."""
        own = self.judge
        calm = not any(one.lost for one in own.every) and not own.teeth.varies
        if calm and not own.apart:
            return [
                "The teeth keep contact in all of the range: the linear answer holds to the last "
                "digit.",
                *sentences(own, self._at, self._range),
                *self._run(),
                *self._verdict(),
            ]
        lines = [line for one in own.every for line in self._contact(one)]
        lines += self._jumped(own.jumps)
        lines += self._returned(own)
        lines += [WANDERS.format(self._range(one), kind) for kind, one in own.wandering]
        lines += sentences(own, self._at, self._range)
        for one in own.every:
            (at, size), (there, linear) = one.worst.loudest, one.linear_loudest
            where = ""
            if one.worst is not one:
                own_at, own_size = one.loudest
                where = f" on a branch apart, {own_size:.0f} N at {self._at(own_at)} on this one"
            lines.append(
                f"Largest dynamic mesh force{self._of(one)} {size:.0f} N at {self._at(at)}{where}; the "
                f"linear answer says {linear:.0f} N at {self._at(there)}."
            )
        if not own.teeth.varies:
            held = float(own.holding[1].max())
            lines.append(
                f"At mean forces{self._of(own)} above {held:.0f} N ({held * self.lever:.0f} N m on the "
                f"{self.train.reference}) the teeth never part on the branch from low speed."
            )
        lines += [line for one in own.every for line in self._off(one)]
        lines += [*self._checked(), *self._run(), *self._verdict()]
        if own.teeth.contact_loss_hz:
            lines.append(IN_CONTACT.format(own.teeth.contact_loss_hz))
        if not own.teeth.phases and (own.teeth.varies or len(own.teeth.errors) > 1):
            lines.append(PHASES)
        lines.append(
            "All of it hangs on losses, backlash and transmission error, and has no bar; harmonics "
            "are followed to 1e-4 of the largest."
        )
        return lines

    def _jumped(self, jumps: Sequence[Jump]) -> list[str]:
        ways = [
            f"jumps at {self._at(jump.frequency_hz)} as the speed {'rises' if jump.rising else 'falls'}"
            for jump in jumps
        ]
        return [f"The motion {', and '.join(ways)}."] if ways else ["The motion does not jump."]

    def _returned(self, one: Backlash) -> list[str]:
        label = one.label[0].upper() + one.label[1:]
        return [RETURNS.format(label, self._at(one.returns))] if one.returns else []

    def _of(self, one: Backlash, word: str = "of") -> str:
        """Name of the mesh, where there are several."""
        return f" {word} the {one.teeth.mesh}" if len(self.train.meshes) > 1 else ""

    def _contact(self, one: Backlash) -> list[str]:
        """Sentence on where the teeth of a mesh part, and the other flank is hit."""
        if not one.lost:
            linear = len(self.train.meshes) > 1 and not one.teeth.half_gap
            return [] if linear else [f"The teeth{self._of(one)} keep contact in all of the range."]
        lines = [f"The teeth{self._of(one)} part from {self._ranges(one.lost)}."]
        if one.both_flanks:
            lines.append(
                f"The other flank{self._of(one)} is hit from {self._ranges(one.both_flanks)}."
            )
        return lines

    def _ranges(self, several: Sequence[Range]) -> str:
        return "; from ".join(map(self._range, several))

    def _off(self, one: Backlash) -> list[str]:
        band, named = self.train.ask.decibels, self._of(one, "for")
        far = one.off(band)
        if not far:
            return [f"The linear answer{named} is off by less than {band:g} dB everywhere."]
        return [
            f"The linear answer{named} is off by {abs(most):.1f} dB at most, too "
            f"{'high' if most > 0 else 'low'}, from {self._rpm(where.low):.0f} to "
            f"{self._rpm(where.high):.0f} rpm ({where.low:.0f} to {where.high:.0f} Hz)."
            for where, most in far
        ]

    def _checked(self) -> list[str]:
        periodic = [one for one in self.in_time if one.cycle == 1]
        if not self.in_time:
            return []
        if not periodic:
            return ["In time no motion came to repeat itself every mesh period."]
        worst = max(periodic, key=lambda one: abs(one.off))
        lines = [
            f"Integration in time agrees within {100 * abs(worst.off):.2g} % in mesh "
            f"force{self._of(self.judge)} at {len(periodic)} of {len(self.in_time)} speeds, swept up and down."
        ]
        longer = sorted({one.cycle for one in self.in_time if one.cycle > 1})
        for cycle in longer:
            at = [self._at(one.frequency_hz) for one in self.in_time if one.cycle == cycle]
            lines.append(f"It repeats itself after {cycle} mesh periods at {', '.join(at)}.")
        never = [self._at(one.frequency_hz) for one in self.in_time if one.cycle == 0]
        if never:
            lines.append(f"It came to no steady motion at {', '.join(never)}.")
        return lines

    def _run(self) -> list[str]:
        """Each run through the range, beside the steady motions."""
        lines = []
        for one in (own for run in self.runs for own in run.every):
            at, size = one.loudest
            steady_at, steady = one.found.loudest
            way, of = "up" if one.ramp > 0 else "down", self._of(one.found)
            band, parted = self.train.ask.tolerance, f"the teeth{of} keep contact"
            if one.lost:
                share = 100 * float(np.mean(one.apart))
                parted = f"the teeth{of} part in {share:.3g} %, from {self._range(one.lost)}"
            lines.append(
                f"Run {way} at {self._rpm(abs(one.ramp)):.6g} rpm/s: largest dynamic mesh force{of} "
                f"{size:.0f} N at {self._at(at)}; stable motions of this branch "
                f"reach {steady:.0f} N at {self._at(steady_at)}."
            )
            lines.append(
                f"In {100 * one.followed(band):.0f} % of its {len(one.force)} mesh cycles the force is "
                f"within {100 * band:g} % of such a motion's; {parted}."
            )
        return lines

    def sufficiency(self) -> tuple[Sufficiency, ...]:
        """Each further mix beside the first."""
        return tuple(self._beside(one) for one in self.found[1:])

    def _beside(self, one: Backlash) -> Sufficiency:
        ask, judge = self.train.ask, self.judge
        ours, theirs = (sorted(j.frequency_hz for j in f.jumps) for f in (one, judge))
        jumps = _worst(ours, theirs)
        both = [*zip(one.every, judge.every)]
        ends = [
            _worst(*([e for r in f.lost for e in (r.low, r.high)] for f in two)) for two in both
        ]
        lost = None if None in ends else max(e for e in ends if e is not None)
        ratio = [a.worst.loudest[1] / b.worst.loudest[1] for a, b in both]
        levels = [abs(20 * np.log10(one)) for one in ratio]
        worst = int(np.argmax(levels))
        return Sufficiency(
            one.label,
            jumps,
            len(ours),
            ratio[worst] - 1,
            one.every[worst].teeth.mesh,
            one.worst.loudest[0] / judge.worst.loudest[0] - 1,
            lost,
            jumps is not None and jumps <= ask.tolerance and bool(levels[worst] <= ask.decibels),
            one.seconds,
        )

    def _verdict(self) -> list[str]:
        ask, lines = self.train.ask, []
        for one, other in zip(self.sufficiency(), self.found[1:]):
            if other.returns:
                lines += self._returned(other)
                continue
            expected = len(self.judge.jumps)
            if one.jumps is None:
                jumps = f"{one.count} jumps instead of {expected}"
            else:
                jumps = f"jumps off by {100 * one.jumps:.1f} %" if expected else "no jump, as here"
            what = "enough" if one.enough else "not enough"
            of = f" of the {one.mesh}" if len(self.train.meshes) > 1 else ""
            lines.append(
                f"{one.label[0].upper()}{one.label[1:]}: {what} ({jumps}, largest force{of} "
                f"{100 * one.force:+.1f} %; asked {100 * ask.tolerance:g} % and {ask.decibels:g} dB)."
            )
        return lines

    def as_dict(self) -> dict[str, Any]:
        """Plain data that JSON can hold, SI."""
        return {
            "teeth": self._teeth(),
            "sentences": self.sentences(),
            "mixes": [self._plain(one) for one in self.found],
            "beside_the_first": [asdict(one) for one in self.sufficiency()],
            "over_mean_force": [asdict(one) for one in self.over_force],
            "in_time": [asdict(one) | {"off": one.off} for one in self.in_time],
            "runs": [self._ran(one) for one in self.runs],
        }

    def _teeth(self) -> dict[str, Any]:
        """Sentence on the data given; of the only mesh no name and no others."""
        told = asdict(self.teeth)
        if len(self.train.meshes) > 1:
            return told
        return {key: value for key, value in told.items() if key not in ("mesh", "others")}

    def _ran(self, one: SpeedRun) -> dict[str, Any]:
        others = [{"mesh": o.found.teeth.mesh, **self._ran_mesh(o)} for o in one.every[1:]]
        return {
            "mesh_frequency_hz_each_second": one.ramp,
            "cycles": len(one.force),
            **self._ran_mesh(one),
            **({"other_meshes": others} if others else {}),
        }

    def _ran_mesh(self, one: SpeedRun) -> dict[str, Any]:
        at, size = one.loudest
        return {
            "largest": {"frequency_hz": at, "force": size},
            "parts": asdict(one.lost) if one.lost else None,
            "share_that_parts": float(np.mean(one.apart)),
            "tolerance": self.train.ask.tolerance,
            "share_within_tolerance_of_steady": one.followed(self.train.ask.tolerance),
        }

    def _plain(self, one: Backlash) -> dict[str, Any]:
        models = one.models if self.train.short else {"models": one.models}
        others = [{"mesh": m.teeth.mesh, **self._of_mesh(m)} for m in one.every[1:]]
        own = self._of_mesh(one)
        return {
            **models,
            "points": len(one.points),
            "harmonics": max(point.balance.count for point in one.points),
            "parts": own["parts"],
            "other_flank": own["other_flank"],
            "jumps": [asdict(jump) for jump in one.jumps],
            "unstable": [{"by": kind, **asdict(r)} for kind, r in one.wandering],
            **plain(one),
            **own,
            **({"other_meshes": others} if others else {}),
        }

    def _of_mesh(self, one: Backlash) -> dict[str, Any]:
        (at, size), (there, linear) = one.worst.loudest, one.linear_loudest
        return {
            "parts": [asdict(r) for r in one.lost],
            "other_flank": [asdict(r) for r in one.both_flanks],
            "largest": {"frequency_hz": at, "force": size},
            "linear_largest": {"frequency_hz": there, "force": linear},
            "linear_off": [
                {**asdict(r), "decibels": most} for r, most in one.off(self.train.ask.decibels)
            ],
            "orders_at_largest": one.worst.spectrum().tolist(),
        }


def _worst(ours: Sequence[float], theirs: Sequence[float]) -> float | None:
    """Largest relative difference of pairs in order; None where one has more."""
    if len(ours) != len(theirs):
        return None
    return max((abs(a / b - 1) for a, b in zip(ours, theirs)), default=0.0)
