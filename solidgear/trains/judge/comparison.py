"""A train compared: the verdict on mixes of models, the judge's modes, and the data of the
file.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from time import perf_counter
from typing import Any, ClassVar

from solidgear.core import Sheeted, environment
from solidgear.core.plain import plain
from solidgear.core.scene.bearing_stiffness import stiffness_entries
from solidgear.show.turning import Turned
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.housing import housing_hz
from solidgear.trains.assembly.layout import senses
from solidgear.trains.assembly.orders import OrderMap, order_map
from solidgear.trains.assembly.tooth_stiffness import ToothStiffness, tooth_stiffness
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import Stage
from solidgear.trains.file.train import Train
from solidgear.trains.judge.judge import JUDGE, MIXED, Verdict, charted_mixes, judge_train
from solidgear.trains.modes.modes import TrainModes, train_modes
from solidgear.trains.modes.pictures import draw_modes, turning_pair
from solidgear.trains.response.loudest import Loudest, loudest
from solidgear.trains.response.response import TrainResponse

#: modes that are drawn
PICTURES = 4


@dataclass(frozen=True)
class Pictures:
    """Pictures of modes in a folder."""

    files: dict[str, str] = field(default_factory=dict)  #: by what they show
    left_out: list[str] = field(default_factory=list)  #: why some could not be drawn


@dataclass(frozen=True, eq=False, repr=False)
class TrainComparison(Sheeted):
    """Findings about a train."""

    sheeted: ClassVar[str] = "trains.judge.sheet:comparison_sheet"
    filed: ClassVar[str] = "trains.judge.sheet:drawn_sheet"

    assembly: Assembly
    verdict: Verdict
    modes: TrainModes  #: of the judge
    orders: OrderMap  #: of the judge
    seconds: float  #: the whole run
    environment: dict[str, Any] = field(default_factory=environment)

    @property
    def judge(self) -> TrainResponse:
        """Response with all shafts solid."""
        return self.verdict.responses[0]

    @property
    def top(self) -> Loudest:
        """Largest dynamic mesh force by the judge."""
        assembly = self.assembly
        return loudest(self.judge, self.modes.modes, assembly.train, assembly.scenes)

    @cached_property
    def tooth_stiffness(self) -> tuple[ToothStiffness, ...]:
        """Stiffness of the meshes whose teeth give it."""
        return tooth_stiffness(self.assembly)

    @property
    def drawn(self) -> list[TrainResponse]:
        """Responses that the chart shows, the judge's first."""
        charted = charted_mixes(len(self.modes.models))
        return [r for r in self.verdict.responses if tuple(r.models.values()) in charted]

    @property
    def marks(self) -> dict[str, float]:
        """Frequencies at which the mesh force of a mix leaves the decibels, Hz, by label."""
        mixes = self.verdict.mixes
        return {m.label: m.force_to_hz for m in mixes if m.force_to_hz is not None}

    @property
    def loud(self) -> list[str]:
        """Names of the modes that make peaks of the judge's mesh force, that of the largest first."""
        names = {mode.name for mode in self.modes.modes}
        peaks = sorted(self.judge.peaks, key=lambda peak: -peak.force)
        return [*dict.fromkeys(peak.mode for peak in peaks if peak.mode in names)]

    @property
    def loudest(self) -> list[int]:
        """Numbers, from 1, of the modes to draw, which make the largest peaks."""
        names = [mode.name for mode in self.modes.modes]
        return sorted(names.index(name) + 1 for name in self.loud[:PICTURES])

    def pictures(self, folder: Path) -> Pictures:
        """Draw the loudest modes into a folder."""
        if not self.loudest:
            return Pictures()
        renders = draw_modes(self.assembly, JUDGE, folder=folder, numbers=self.loudest)
        files = {label: render.path.name for label, render in renders.items() if render.ok}
        reasons = sorted({render.reason for render in renders.values() if not render.ok})
        return Pictures(files, reasons)

    def turned(self) -> list[Turned]:
        """Return the judge's modes and those of all shafts as the best beams, to be turned side by
        side.
        """
        return turning_pair(self.assembly, (JUDGE,), (MIXED[-2],), self.verdict.highest_hz)

    @cached_property
    def data(self) -> dict[str, Any]:
        """Train as plain data."""
        return train_data(self.assembly)

    def results(self) -> dict[str, Any]:
        """Return plain data for JSON: all numbers of the page."""
        return {
            "kind": "train",
            "train": self.data,
            "verdict": self.verdict.as_dict() | {"sentences": self.verdict.sentences()},
            "loudest": self.top.as_dict(),
            **({"tooth_stiffness": plain(of_teeth)} if (of_teeth := self.tooth_stiffness) else {}),
            "modes": self.modes.as_dict() | {"notes": self.modes.notes()},
            "peaks": plain(self.judge.peaks),
            "crossings": plain(self.orders.crossings),
            "environment": self.environment,
            "seconds_total": self.seconds,
        }


def compare_train(
    assembly: Assembly,
    highest_hz: float | None = None,
    more: Sequence[tuple[str, ...]] = (),
    progress: Callable[[str], None] = lambda text: None,
) -> TrainComparison:
    """Judge every mix of models of a train, and solve the judge's modes and orders; arguments as of
    :func:`solidgear.trains.judge.judge.judge_train`.
    """
    start = perf_counter()
    verdict = judge_train(assembly, highest_hz, more, progress)
    modes = train_modes(assembly, JUDGE, max_frequency=verdict.highest_hz)
    progress("order lines")
    orders = order_map(assembly, JUDGE, highest_hz=verdict.highest_hz)
    return TrainComparison(assembly, verdict, modes, orders, perf_counter() - start)


def train_data(assembly: Assembly) -> dict[str, Any]:
    """Return a train as plain data: the file, and the meshes as they come out of it."""
    train = assembly.train
    out: dict[str, Any] = {
        "title": train.called,
        "name": train.name,
        "source": train.source,
        "ratio": train.ratio,
        "shafts": [*train.shafts],
        "meshes": [_mesh(assembly, pair) for pair in train.pairs],
        "stages": [_stage(stage) for stage in train.stages],
        "senses": senses(train, assembly.contacts),
        "rotors": [*train.rotors],
        "losses": train.losses.model_dump(mode="json", exclude={"status"}),
        "statuses": train.statuses(),
    }
    for name, rotor in train.rotors.items():
        out[name] = {
            "inertia": rotor.inertia,
            "share": rotor.share,
            "spring": rotor.spring.stiffness,
            "at": f"{rotor.shaft}.{train.spring_port(name)}",
        }
    if train.housing is not None:
        out["housing"] = _housing(train)
    for side, shaft in train.shafts.items():
        out[side] = {"turns": train.turns[side], "scene": shaft.scene.as_dict()}
    return out


def _housing(train: Train) -> dict[str, Any]:
    """Return the housing as plain data, in SI."""
    housing = train.housing
    assert housing is not None
    mounts = {
        name: {
            "position": housing.foot(name),
            "stiffness": stiffness_entries(mount.stiffness),
            "loss": mount.loss,
        }
        for name, mount in housing.mounted.items()
    }
    return {
        "mass": housing.mass,
        "inertia": housing.inertia,
        "centre": housing.centre,
        "carries": train.housed,
        "mounts": mounts,
        "points": {name: housing.point_places[name] for name in housing.free_points[1:]},
        "elastic": housing.matrices is not None,
        "alone_hz": housing_hz(housing).tolist(),
    }


def _stage(stage: Stage) -> dict[str, Any]:
    """Return a planetary stage as plain data."""
    teeth, ends = stage.teeth, zip(stage.shafts, stage.ports)
    sun, carrier = (f"{side}.{port}" for side, port in ends)
    return {
        "name": stage.called,
        "sun": sun,
        "carrier": carrier,
        "teeth": [teeth.sun, teeth.planet, teeth.ring],
        "ratio": stage.ratio,
        "angles": [*teeth.azimuths],
        "pin_radius": teeth.pin_radius,
        **stage.table.model_dump(mode="json", include={"position", "planet", "mesh", "ring"}),
    }


def _mesh(assembly: Assembly, pair: Pair) -> dict[str, Any]:
    """Return a mesh as plain data, the pinion first in pairs of values."""
    contact = assembly.contacts[pair.name]
    vectors, error = (contact.pinion, contact.gear), pair.mesh.transmission_error
    return {
        "name": pair.name,
        "between": [f"{side}.{port}" for side, port in zip(pair.shafts, pair.ports)],
        "per_turn": assembly.train.per_turn(pair),
        "teeth": [member.teeth for member in pair.members.values()],
        "shaft_angle": pair.mesh.shaft_angle,
        "stiffness": contact.stiffness,
        "transmission_error": None if error is None else error.model_dump(mode="json"),
        "line_of_action": [[float(v) for v in vector.normal] for vector in vectors],
        "point": [[float(v) for v in vector.point] for vector in vectors],
        "lever": [vector.lever for vector in vectors],
    }
