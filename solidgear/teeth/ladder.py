r"""Which model of the teeth is enough: the norm, plane slices, teeth in 3D.

The finest model that was solved is the reference, with its error bar
(:mod:`solidgear.teeth.bars`).  Each number of a cheaper model is
held against it, and asks for its own share: the transmission error and the face load factor as they
are, the stiffness by what it does to the train, for a natural frequency moves by half the share of its
strain energy that is in the teeth, times the relative change of their stiffness (Rayleigh).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any, Literal

import numpy as np

from solidgear.core import WITHIN, gap_verdict
from solidgear.core.judge.deviations import OPEN
from solidgear.core.plain import plain
from solidgear.teeth.bars import error_bars, numbers_of
from solidgear.teeth.mesh_contact import MeshContact
from solidgear.teeth.supports import Carried
from solidgear.teeth.train_teeth import TeethModel, mesh_contact
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.stages import with_mesh_stiffness
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh

#: numbers that are judged, and what they are called
STIFFNESS, ERROR, FACE = "frequencies", "transmission error", "face load factor"
#: models, the cheapest first
NORM = "ISO 6336-1"
SLICES: Literal["slices"] = "slices"
SOLID: Literal["solid"] = "solid"
IN_WORDS = {NORM: "the norm", SLICES: "the model of plane slices", SOLID: "teeth in 3D"}


@dataclass(frozen=True)
class Judged:
    """Numbers of one model of the teeth of a mesh; None for what it does not have."""

    tangent: float  #: mean, N/m
    peak_to_peak: float | None  #: of the loaded transmission error, m
    face_load_factor: float | None

    @classmethod
    def of(cls, contact: MeshContact) -> Judged:
        """Return the numbers of a solved contact."""
        cycle = contact.cycle
        return cls(float(cycle.tangent.mean()), cycle.peak_to_peak, cycle.face_load_factor)

    def off(self, other: Judged) -> dict[str, float | None]:
        """Return by how much these numbers are off others, relative."""
        pairs = {
            STIFFNESS: (self.tangent, other.tangent),
            ERROR: (self.peak_to_peak, other.peak_to_peak),
            FACE: (self.face_load_factor, other.face_load_factor),
        }
        return {name: None if a is None or not b else a / b - 1 for name, (a, b) in pairs.items()}


@dataclass(frozen=True, eq=False)
class Solved:
    """A mesh by one model of its teeth."""

    contact: MeshContact
    seconds: float
    bars: Mapping[str, float] | None = None  #: as of :func:`solidgear.teeth.bars.error_bars`


@dataclass(frozen=True)
class Rung:
    """One model of the teeth of a mesh beside the reference."""

    model: str
    numbers: Judged
    #: off the reference, relative; of frequencies as they move; None for what it does not have
    off: Mapping[str, float | None]
    verdict: Mapping[str, str]  #: within, open or beyond the tolerance; empty for the reference
    seconds: float


@dataclass(frozen=True)
class Ladder:
    """Models of the teeth of one mesh, the cheapest first."""

    mesh: str
    tolerance: float
    rungs: tuple[Rung, ...]
    #: of the reference, relative: what its numbers move by with mesh, depth and slices
    bars: Mapping[str, float]
    share: (
        float  #: largest share of the strain energy of a mode within the asked range in the teeth
    )

    @property
    def reference(self) -> Rung:
        """The finest model."""
        return self.rungs[-1]

    def cheapest(self, name: str) -> str | None:
        """Return the cheapest model within the tolerance for a number; None where only the reference
        is.
        """
        return next((r.model for r in self.rungs[:-1] if r.verdict.get(name) == WITHIN), None)

    def sentences(self) -> list[str]:
        """Return which model is enough for what."""
        finest, lines = IN_WORDS[self.reference.model], []
        for name in (STIFFNESS, ERROR, FACE):
            cheapest = self.cheapest(name)
            state = "no cheaper model was shown to be"
            if cheapest is not None:
                state = f"{IN_WORDS[cheapest]} is"
            lines.append(
                f"{self.mesh}, {name}: {state} within {100 * self.tolerance:g} % of {finest}, whose "
                f"own error bar is {100 * self.bars[name]:.2g} %."
            )
        return lines

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON."""
        return plain(
            {
                "mesh": self.mesh,
                "tolerance": self.tolerance,
                "bars": dict(self.bars),
                "energy_share": self.share,
                "models": {
                    rung.model: {
                        "tangent": rung.numbers.tangent,
                        "peak_to_peak": rung.numbers.peak_to_peak,
                        "face_load_factor": rung.numbers.face_load_factor,
                        "off": dict(rung.off),
                        "verdict": dict(rung.verdict),
                        "seconds": rung.seconds,
                    }
                    for rung in self.rungs
                },
            }
        )


def ladder(
    carried: Carried,
    mesh: Pair | PlanetMesh,
    tolerance: float,
    model: TeethModel | None = None,
    reference: Literal["slices", "solid"] = SOLID,
    solved: Mapping[str, Solved] | None = None,
    progress: Callable[[str], None] = lambda text: None,
) -> Ladder:
    """Solve a mesh with every model of its teeth up to the reference, and judge them; slices and positions
    are those of `model`, and what is `solved` by some model is not solved again.
    """
    model, solved = model or TeethModel(), dict(solved or {})
    models: dict[str, TeethModel] = {SLICES: replace(model, name=SLICES)}
    if reference == SOLID:
        models[SOLID] = replace(model, name=SOLID)
    for name, teeth in models.items():
        if name not in solved:
            progress(f"teeth of the {mesh.name}: {name}")
            start = perf_counter()
            contact = mesh_contact(carried, mesh, teeth)
            solved[name] = Solved(contact, perf_counter() - start)
    finest = solved[reference].contact
    numbers = {NORM: (_norm(finest), 0.0)}
    numbers |= {name: (Judged.of(solved[name].contact), solved[name].seconds) for name in models}
    judge, own_bars = Judged.of(finest), solved[reference].bars
    if own_bars is None:
        progress(f"error bars of the {mesh.name}")
        own_bars = error_bars(carried, mesh, models[reference], finest)
    bars = _bars(finest, own_bars)
    share = energy_share(carried, mesh, judge.tangent)
    bars[STIFFNESS] *= share / 2
    rungs = []
    for name, (judged, seconds) in numbers.items():
        off = judged.off(judge)
        off[STIFFNESS] = (judged.tangent / judge.tangent - 1) * share / 2
        verdict = {
            key: OPEN if value is None else gap_verdict(value, bars[key], tolerance)
            for key, value in off.items()
        }
        rungs.append(Rung(name, judged, off, {} if name == reference else verdict, seconds))
    return Ladder(mesh.name, tolerance, tuple(rungs), bars, share)


def _norm(contact: MeshContact) -> Judged:
    return Judged(contact.along_line(contact.norm.mesh), None, None)


def _bars(contact: MeshContact, own_bars: Mapping[str, float]) -> dict[str, float]:
    """Return the error bars of the judged numbers, relative."""
    numbers = numbers_of(contact)
    names = {STIFFNESS: "tangent", ERROR: "peak_to_peak", FACE: "face_load_factor"}
    return {judged: own_bars[name] / (numbers[name] or np.inf) for judged, name in names.items()}


def energy_share(carried: Carried, mesh: Pair | PlanetMesh, tangent: float) -> float:
    """Return the largest share of the strain energy in the teeth of a mesh, of planets in those of all,
    with their tangent stiffness, N/m, of the modes up to the highest frequency that the train asks for.
    """
    assembly: Assembly = carried.assembly
    names = [mesh.name]
    if isinstance(mesh, PlanetMesh):
        names = [m.name for m in mesh.stage.meshes if m.mate == mesh.mate]
    modes = with_mesh_stiffness(carried.system, dict.fromkeys(names, tangent)).modes()
    wanted = (modes.frequency_hz > 0) & (modes.frequency_hz <= assembly.train.ask.max_frequency)
    share = np.sum([modes.energy[name] for name in names], axis=0)[wanted]
    return float(np.max(share, initial=0.0))
