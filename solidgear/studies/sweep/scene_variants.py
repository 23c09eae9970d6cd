"""Scenes of a sweep: a file with entries replaced, and rows of numbers with their bars."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from solidgear.body import Body, as_supports
from solidgear.errors import SolidgearError
from solidgear.judge.settle import Settled
from solidgear.judge.solving import answered
from solidgear.ladder import build
from solidgear.machine.threads import pinned
from solidgear.quantity import QUANTITIES
from solidgear.scene import Scene
from solidgear.scene.toml_file import parse
from solidgear.studies.loading import scene_of
from solidgear.studies.one_shaft import mass_of, one_shaft
from solidgear.studies.sweep.bench import surface
from solidgear.studies.sweep.design import Design
from solidgear.studies.sweep.entries import Entry
from solidgear.studies.sweep.file_variants import OWN, FileVariants, in_own_file

#: static quantities of a row
STATICS = tuple(q for q in QUANTITIES if not q.is_frequency)
#: natural frequencies of a row at most
MOST_MODES = 30


@dataclass(frozen=True)
class SceneVariants(FileVariants):
    """Points of a sweep over entries of a scene file."""

    def scene(self, index: int) -> Scene:
        """Scene of one variant, its catalogue bearings with their stiffness.

        Raises
        ------
        SceneError
            If a file with these values would be refused.
        """
        return self.read(self.entries, self.values[index].tolist())

    def read(self, varied: Sequence[Entry], row: Sequence[float]) -> Scene:
        return scene_of(self.put(OWN, varied, row), self.path)


def scene_variants(path: Path, design: Design) -> SceneVariants:
    """Points of a sweep over entries of a scene file.

    Raises
    ------
    SolidgearError
        For a file and texts that cannot be read, and too many variants.
    """
    files = {OWN: parse(str(path))}
    return SceneVariants(path, files, *design.points(files, in_own_file))


@dataclass(frozen=True)
class SceneTask:
    """Everything that turns variants of a scene into rows.

    Attributes
    ----------
    model : str or None
        None for the cheapest mesh whose bars are within the tolerance, variant by variant.
    tolerance : float or None
        Relative; that of the scene by default.
    options : mapping
        Of the builder of a model that is given.
    n : int
        Natural frequencies.
    """

    variants: SceneVariants
    model: str | None
    tolerance: float | None
    options: Mapping[str, Any]
    n: int
    _last: dict[Any, Settled] = field(default_factory=dict, repr=False, compare=False)

    def __getstate__(self) -> dict[str, Any]:
        return vars(self) | {"_last": {}}

    @cached_property
    def columns(self) -> dict[str, type]:
        """Names and types of the columns of a row, in order."""
        out: dict[str, type] = {"variant": int, **self.variants.columns}
        out |= {"status": str, "model": str, "unknowns": int, "mass": float}
        for name in STATICS:
            out |= self._with_bar(str(name), float)
        for k in range(1, self.n + 1):
            out |= self._with_bar(f"f{k}_hz", float) | {f"mode{k}": str}
        return out

    def _with_bar(self, name: str, kind: type) -> dict[str, type]:
        return {name: kind} | ({f"{name} bar": float} if self.model is None else {})

    @pinned
    def rows(self, indices: Iterable[int]) -> list[dict[str, Any]]:
        """Rows of some variants; none depends on those before it."""
        return [self._row(index) for index in indices]

    def _row(self, index: int) -> dict[str, Any]:
        row: dict[str, Any] = {"variant": index, **self.variants.told(index)}
        try:
            scene = self.variants.scene(index)
            found = self._settled(scene) if self.model is None else self._fixed(scene)
        except SolidgearError as error:
            return row | {"status": self.variants.status(error, index)}
        return row | {"status": "ok"} | found

    def _settled(self, scene: Scene) -> dict[str, Any]:
        """Numbers with bars, by the cheapest mesh."""
        key = surface(scene)
        tol = scene.ask.tolerance if self.tolerance is None else self.tolerance
        found = one_shaft(
            scene.with_changes(ask=scene.ask.with_changes(modes=self.n)),
            tol,
            before=self._last.get(key),
        )
        self._last.clear()
        self._last[key] = found.settled
        out: dict[str, Any] = {
            "model": f"{found.settled.rung}, {found.settled.setting}",
            "unknowns": found.settled.body.size,
            "mass": found.mass,
        }
        for name in STATICS:
            out |= {str(name): found.values.get(name), f"{name} bar": found.bar(name)}
        elastic = [mode for mode in found.modes.modes if mode.frequency_hz > 0]
        for k, mode in enumerate(map(found.seen, elastic[: self.n]), start=1):
            out |= {f"f{k}_hz": mode.frequency_hz, f"f{k}_hz bar": mode.width}
            out[f"mode{k}"] = mode.name
        return out

    def _fixed(self, scene: Scene) -> dict[str, Any]:
        """Numbers of one model on the mesh that was asked for, without bars."""
        assert self.model is not None
        body: Body = build(scene, self.model, **self.options)
        found = answered(body, as_supports(scene), [scene.port.name], self.n, ovalising=True)
        out: dict[str, Any] = {
            "model": self.model,
            "unknowns": body.size,
            "mass": mass_of(scene, body)[0],
        }
        out |= {str(name): found.quantities.get(name) for name in STATICS}
        elastic = [mode for mode in found.modes.modes if mode.frequency_hz > 0]
        for k, mode in enumerate(elastic[: self.n], start=1):
            out |= {f"f{k}_hz": mode.frequency_hz, f"mode{k}": str(mode.name)}
        return out
