"""Remedies for a model that does not fit into memory: other models and other factors of the same
scene, each with the memory it would take.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from solidgear.errors import SolidgearError
from solidgear.factoring import Factoring
from solidgear.ladder.registry import LADDER
from solidgear.machine.memory import NoRoom, anew, available_mb

if TYPE_CHECKING:
    from solidgear.body import Body
    from solidgear.ladder.model import Model
    from solidgear.models.size import Size
    from solidgear.scene.shaft import Shaft

#: models whose memory goes into the factor of a 3D mesh
LARGE = ("solid", "sector")
#: a mesh with less of this refinement answers for nothing
COARSEST = 0.1
#: share of the memory that a coarser mesh may fill, for the law is good to a tenth between meshes of one
#: scene; what is aimed at; and meshes that are tried for it
FILLED, AIM, TRIED = 0.85, 0.75, 4
#: refinements are offered in such steps
STEP = 0.05
#: memory goes with the power 4/3 of unknowns, and these with the cube of the refinement
BY_REFINEMENT = 4


@dataclass(frozen=True)
class Remedy:
    """One way out."""

    words: str  #: what to ask for
    mb: float  #: what it would take, about
    note: str = ""  #: what there is to be known of it

    @property
    def text(self) -> str:
        """In a list."""
        return f"{self.words} (about {self.mb:.0f} MB{', ' if self.note else ''}{self.note})"


def refusal(
    scene: Shaft, name: str, options: Mapping[str, Any], body: Body | None, error: NoRoom
) -> NoRoom:
    """A refusal of the mesh, the matrices or the factors of a model with the ways out, those that fit first."""
    model = LADDER[name]
    if name not in LARGE:
        return error.of_model(name, model.coarser)
    try:
        with anew():
            found = _Remedies(scene, model, model.given(scene, options), body, error)
            remedies = offered([*found.all()], found.room)
    except (MemoryError, ImportError):
        remedies = ""  # where memory has run out, nothing can be counted any more
    return error.of_model(name, f"{model.coarser}{remedies}")


@dataclass(frozen=True)
class _Remedies:
    """Ways out of one refusal, those first that cost least accuracy and work."""

    scene: Any
    model: Model
    options: dict[str, Any]
    body: Body | None
    error: NoRoom

    @cached_property
    def _now(self) -> Size | None:
        from solidgear.models.size import of_body

        return None if self.body is None else of_body(self.body)

    @property
    def _held(self) -> float:
        """MB of matrices, which another mesh or model would not have beside its own."""
        return 0.0 if self._now is None else self._now.matrices_mb

    @property
    def room(self) -> float:
        """MB for matrices and factors."""
        free, here = self.error.free_mb, available_mb()
        if not math.isfinite(free) and here is not None:
            free = here
        return free + self._held

    def all(self) -> Iterator[Remedy]:
        """Yield every one, fitting or not."""
        yield from self.half()
        yield from self.other_models()
        yield from self.coarser()
        if self.body is not None:
            yield from self.other_factors(self.body)

    def _sized(self, model: Model, options: dict) -> tuple[int, float] | None:
        """Unknowns and memory (MB) of a mesh that is made and counted; that of factors is as much off
        the law as what was refused.
        """
        try:
            size = model.size(self.scene, options)
        except SolidgearError:
            return None
        off = 1.0
        if model is self.model and self._now is not None:
            off = self.error.need_mb / self._now.factors_mb
        return size.unknowns, size.matrices_mb + off * size.factors_mb

    def half(self) -> Iterator[Remedy]:
        """A half of it, where there is a mirror plane that was not used."""
        if self.options.get("half", True) or not self.model.can_halve(self.scene, self.options):
            return
        found = self._sized(self.model, {**self.options, "half": True})
        what = "half a sector" if self.model.name == "sector" else "two half models"
        if found is not None:
            yield Remedy("--set half=true", found[1], what)

    def other_models(self) -> Iterator[Remedy]:
        """Other models of the same scene."""
        for other in (LADDER[name] for name in ("sector", "corrected", "harmonic")):
            if other is self.model or other.unfit(self.scene):
                continue
            found = self._sized(other, {})
            if found is not None:
                note = f"the {other.title}, {found[0]} unknowns"
                yield Remedy(f"-f {other.name}", found[1], note)

    def coarser(self) -> Iterator[Remedy]:
        """A mesh of the same kind that fits."""
        if getattr(getattr(self.scene, "body", None), "one_mesh", False):
            return  # a mesh that is given
        refinement = float(self.options.get("refinement", 1.0))
        mb = self.error.need_mb + self._held
        for _ in range(TRIED):
            known = math.isfinite(self.room) and math.isfinite(mb)
            # of what cannot even be numbered, half the refinement is tried, and so on
            share = (AIM * self.room / mb) ** (1 / BY_REFINEMENT) if known else 0.5
            refinement = round(STEP * int(min(refinement * share, refinement - STEP / 2) / STEP), 2)
            if refinement < COARSEST:
                return
            found = self._sized(self.model, {**self.options, "refinement": refinement})
            if found is None:
                return
            unknowns, mb = found
            if mb <= FILLED * self.room:
                note = f"{unknowns} unknowns, with a wider error bar"
                yield Remedy(f"--set refinement={refinement:g}", mb, note)
                return

    def other_factors(self, body: Body) -> Iterator[Remedy]:
        """Factors of the same matrices that take less, by their own analysis, and by other programs."""
        from solidgear.solve.shifted import needed_mb

        single, files = {"precision": "single"}, {"out_of_core": True}
        for words, more, note in (
            ("--set precision=single", single, "same digits, solutions refined in double"),
            ("--set out_of_core=true", files, "the factor in files, several times slower"),
            ("--set precision=single --set out_of_core=true", {**single, **files}, ""),
        ):
            try:
                mb = needed_mb(body, replace(body.factoring, **more))
            except SolidgearError:
                continue  # no back end here makes it
            # a factor in double precision may fall into pieces by mirror planes, others do not
            if mb < self.error.need_mb:
                yield Remedy(words, self._held + mb, note)
        if body.factoring.engine == "own":
            note = "MUMPS in PETSc on two ranks of this machine; SOLIDGEAR_MPIRUN names others"
            mb = needed_mb(body, Factoring(engine="petsc"))
            yield Remedy("--engine petsc", self._held + mb, note)


def offered(remedies: list[Remedy], free: float) -> str:
    """Those that fit in a list, and those that do not."""
    fit = [remedy.text for remedy in remedies if remedy.mb <= free]
    large = [remedy.text for remedy in remedies if remedy.mb > free]
    text = ""
    if fit:
        text = "; ways that fit: " + "; ".join(f"{k}. {one}" for k, one in enumerate(fit, 1))
    if large:
        text += f"; too large as well: {'; '.join(large)}"
    return text
