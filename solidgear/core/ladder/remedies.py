"""Remedies for a model that does not fit into memory: other models and other factors of the same
scene, each with the memory it would take.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from solidgear.core.errors import SolidgearError
from solidgear.core.factoring import Factoring
from solidgear.core.ladder.registry import LADDER
from solidgear.core.machine.memory import NoRoom, available_mb, fresh_run

if TYPE_CHECKING:
    from solidgear.core.body import Body
    from solidgear.core.ladder.model import Model
    from solidgear.core.models.size import Size
    from solidgear.core.scene.shaft import Shaft

#: models whose memory goes into the factor of a 3D mesh
LARGE = ("solid", "sector")
#: a mesh of less refinement is useless
COARSEST = 0.1
#: share of the memory that a coarser mesh may fill (the law is good to a tenth between meshes of one
#: scene), and the share aimed at
FILLED, AIM = 0.85, 0.75
#: meshes that are tried for it
TRIED = 4
#: refinements are offered in such steps
STEP = 0.05
#: memory goes with the power 4/3 of unknowns, and these with the cube of the refinement
BY_REFINEMENT = 4


@dataclass(frozen=True)
class Remedy:
    """A model, mesh or factor that takes less memory."""

    words: str  #: options to use
    mb: float  #: approximate memory
    note: str = ""  #: remark in brackets

    @property
    def text(self) -> str:
        """Entry in a list."""
        return f"{self.words} (about {self.mb:.0f} MB{', ' if self.note else ''}{self.note})"


def refusal(
    scene: Shaft, name: str, options: Mapping[str, Any], body: Body | None, error: NoRoom
) -> NoRoom:
    """Return the refusal of the mesh, the matrices or the factors of a model with remedies, those
    that fit first.
    """
    model = LADDER[name]
    if name not in LARGE:
        return error.of_model(name, model.coarser)
    try:
        with fresh_run():
            finder = _Remedies(scene, model, model.given(scene, options), body, error)
            remedies = offered([*finder.all()], finder.room)
    except (MemoryError, ImportError):
        remedies = ""  # where memory has run out, nothing can be counted any more
    return error.of_model(name, f"{model.coarser}{remedies}")


@dataclass(frozen=True)
class _Remedies:
    """Remedies for one refusal, in order of the accuracy and work they cost."""

    scene: Shaft
    model: Model
    options: dict[str, Any]
    body: Body | None
    error: NoRoom

    @cached_property
    def _size(self) -> Size | None:
        from solidgear.core.models.size import size_of_body

        return None if self.body is None else size_of_body(self.body)

    @property
    def _matrices_mb(self) -> float:
        """Memory of the matrices, which another mesh or model would not need beside its own."""
        return 0.0 if self._size is None else self._size.matrices_mb

    @property
    def room(self) -> float:
        """Memory for matrices and factors, MB."""
        free, available = self.error.free_mb, available_mb()
        if not math.isfinite(free) and available is not None:
            free = available
        return free + self._matrices_mb

    def all(self) -> Iterator[Remedy]:
        """Yield every remedy, fitting or not."""
        yield from self.half()
        yield from self.other_models()
        yield from self.coarser()
        if self.body is not None:
            yield from self.other_factors(self.body)

    def _sized(self, model: Model, options: dict) -> tuple[int, float] | None:
        """Return unknowns and memory (MB) of a mesh that is made and counted; factors of the
        refused model deviate from the law as they did there.
        """
        try:
            size = model.size(self.scene, options)
        except SolidgearError:
            return None
        factor = 1.0
        if model is self.model and self._size is not None:
            factor = self.error.need_mb / self._size.factors_mb
        return size.unknowns, size.matrices_mb + factor * size.factors_mb

    def half(self) -> Iterator[Remedy]:
        """Yield half of the body, where there is a mirror plane that was not used."""
        if self.options.get("half", True) or not self.model.can_halve(self.scene, self.options):
            return
        sized = self._sized(self.model, {**self.options, "half": True})
        note = "half a sector" if self.model.name == "sector" else "two half models"
        if sized is not None:
            yield Remedy("--set half=true", sized[1], note)

    def other_models(self) -> Iterator[Remedy]:
        """Yield other models of the same scene."""
        for model in (LADDER[name] for name in ("sector", "corrected", "harmonic")):
            if model is self.model or not model.can_model(self.scene):
                continue
            sized = self._sized(model, {})
            if sized is not None:
                note = f"the {model.title}, {sized[0]} unknowns"
                yield Remedy(f"-f {model.name}", sized[1], note)

    def coarser(self) -> Iterator[Remedy]:
        """Yield a mesh of the same kind that fits."""
        if getattr(getattr(self.scene, "body", None), "one_mesh", False):
            return  # a mesh file is the only mesh
        refinement = float(self.options.get("refinement", 1.0))
        mb = self.error.need_mb + self._matrices_mb
        for _ in range(TRIED):
            sizes_known = math.isfinite(self.room) and math.isfinite(mb)
            # where sizes are unknown, half the refinement is tried, and so on
            share = (AIM * self.room / mb) ** (1 / BY_REFINEMENT) if sizes_known else 0.5
            refinement = round(STEP * int(min(refinement * share, refinement - STEP / 2) / STEP), 2)
            if refinement < COARSEST:
                return
            sized = self._sized(self.model, {**self.options, "refinement": refinement})
            if sized is None:
                return
            unknowns, mb = sized
            if mb <= FILLED * self.room:
                note = f"{unknowns} unknowns, with a wider error bar"
                yield Remedy(f"--set refinement={refinement:g}", mb, note)
                return

    def other_factors(self, body: Body) -> Iterator[Remedy]:
        """Yield factors of the same matrices that take less, by their own analysis, and by other
        programs.
        """
        from solidgear.core.solve.shifted import needed_mb

        single, files = {"precision": "single"}, {"out_of_core": True}
        for words, more, note in (
            ("--set precision=single", single, "same digits, refined in double precision"),
            ("--set out_of_core=true", files, "the factor in files, several times slower"),
            ("--set precision=single --set out_of_core=true", {**single, **files}, ""),
        ):
            try:
                mb = needed_mb(body, replace(body.factoring, **more))
            except SolidgearError:
                continue  # no back end here makes it
            if mb < self.error.need_mb:
                yield Remedy(words, self._matrices_mb + mb, note)
        if body.factoring.engine == "own":
            note = "MUMPS in PETSc on two ranks of this machine; SOLIDGEAR_MPIRUN names others"
            mb = needed_mb(body, Factoring(engine="petsc"))
            yield Remedy("--engine petsc", self._matrices_mb + mb, note)


def offered(remedies: list[Remedy], free: float) -> str:
    """Return the remedies that fit as a numbered list, and then those that do not."""
    fit = [remedy.text for remedy in remedies if remedy.mb <= free]
    large = [remedy.text for remedy in remedies if remedy.mb > free]
    text = ""
    if fit:
        text = "; ways that fit: " + "; ".join(f"{k}. {remedy}" for k, remedy in enumerate(fit, 1))
    if large:
        text += f"; too large as well: {'; '.join(large)}"
    return text
