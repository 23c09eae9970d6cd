"""Rows of a sweep of scenes: numbers with their error bars, free and under the load."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from solidgear.core import (
    LADDER,
    QUANTITIES,
    Body,
    Quantity,
    Scene,
    Settled,
    Source,
    as_supports,
    build,
    number_cautions,
    read_tolerance,
)
from solidgear.core.judge.cautions import AT_REST, SHOWN
from solidgear.core.judge.solving import quantities_at, search_modes
from solidgear.core.models.limits import number
from solidgear.guards.one_shaft import mass_of, one_shaft
from solidgear.variants.sweep.bench import surface
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.file_task import BARS, CAUTIONS, FileTask, named_kinds, without_bars
from solidgear.variants.sweep.file_variants import (
    MAIN,
    SceneVariants,
    scene_variants,
    tables_for_plan,
)
from solidgear.variants.sweep.shaft_numbers import (
    ANSWER,
    ASKED,
    columns_of,
    numbers_of,
)

#: static quantities of a row
STATICS = tuple(q for q in QUANTITIES if not q.is_frequency)
#: natural frequencies of a row at most
MOST_MODES = 30


def statics_of(scene: Scene) -> tuple[Quantity, ...]:
    """Return the static quantities of a row: none of a scene without a lumped point."""
    return STATICS if scene.ports else ()


@dataclass(frozen=True)
class SceneTask(FileTask):
    """Turns variants of a scene into rows: each is read, meshed and solved by itself."""

    variants: SceneVariants
    #: none for the cheapest mesh whose error bars are within the tolerance, variant by variant
    model: str | None
    tolerance: float | None  #: relative; that of the scene by default
    options: Mapping[str, Any]  #: of the builder of a model that is given
    n: int  #: natural frequencies
    first: int = 0  #: a variant that can be read
    ask: tuple[str, ...] = (ANSWER,)  #: some of ``ASKED``
    names: tuple[str, ...] = ()  #: of the numbers that cautions are of; all of the rows by default

    @cached_property
    def _last(self) -> dict[Any, Settled]:
        """Mesh of the last row, by its shaft."""
        return {}

    def cautions_of(self, index: int) -> list[str]:
        numbers = SHOWN if ANSWER in self.ask else AT_REST
        numbers = dict.fromkeys(self.names) if self.names else numbers
        return number_cautions(self.variant(index), numbers, self.model or "")

    @property
    def columns(self) -> dict[str, type]:
        out: dict[str, type] = {"model": str, "unknowns": int}
        out |= {"mass": float, "mass bar": float} | ({BARS: str} if self.model else {})
        if ANSWER in self.ask:
            for name in statics_of(self.variants.variant(self.first)):
                out |= self._with_bar(str(name), float)
            for k in range(1, self.n + 1):
                out |= self._with_bar(f"f{k}_hz", float) | {f"mode{k}": str}
        if {*self.ask} - {ANSWER}:
            usual = self.variants.variant(self.first)
            out |= columns_of(usual, self.ask, barred=self.model is None)
        return out | {CAUTIONS: str}

    def _with_bar(self, name: str, kind: type) -> dict[str, type]:
        return {name: kind} | ({f"{name} bar": float} if self.model is None else {})

    @property
    def plan(self) -> dict[str, Any]:
        part = self.variants.variant(self.first).body
        return {
            "scene": tables_for_plan(self.variants.tables(self.first)[MAIN]),
            "part": part and part.model_dump(mode="json"),
            "model": self.model,
            "set": tables_for_plan(self.options),
            "tolerance": self.tolerance,
            "n": self.n,
            "ask": [*self.ask],
        }

    def numbers(self, index: int) -> dict[str, Any]:
        scene = self.variant(index)
        out: dict[str, Any]
        if ANSWER in self.ask:
            out = self._settled(scene) if self.model is None else self._fixed(scene)
        else:
            mass, bar = mass_of(scene)
            out = {"model": self.model, "mass": mass, "mass bar": bar}
            out |= {} if self.model is None else {BARS: without_bars(self.model)}
        return out | numbers_of(scene, self.ask, self.model, self.tolerance)

    def _settled(self, scene: Scene) -> dict[str, Any]:
        """Return numbers with error bars, by the cheapest mesh."""
        key = surface(scene)
        tol = scene.ask.tolerance if self.tolerance is None else self.tolerance
        shaft = one_shaft(
            scene.with_changes(ask=scene.ask.with_changes(modes=self.n)),
            tol,
            before=self._last.get(key),
            guarded=False,  # rows have no column of sentences
        )
        self._last.clear()
        self._last[key] = shaft.settled
        out: dict[str, Any] = {
            "model": f"{shaft.settled.rung}, {shaft.settled.setting}",
            "unknowns": shaft.settled.body.size,
            "mass": shaft.mass,
            "mass bar": shaft.mass_bar,
        }
        for name in statics_of(scene):
            out |= {str(name): shaft.values.get(name), f"{name} bar": shaft.bar(name)}
        elastic = [mode for mode in shaft.modes.modes if mode.frequency_hz > 0]
        for k, mode in enumerate(map(shaft.seen, elastic[: self.n]), start=1):
            out |= {f"f{k}_hz": mode.frequency_hz, f"f{k}_hz bar": mode.width}
            out[f"mode{k}"] = mode.name
        return out

    def _fixed(self, scene: Scene) -> dict[str, Any]:
        """Return numbers of one model on the mesh that was asked for, without error bars."""
        assert self.model is not None
        body: Body = build(scene, self.model, **self.options)
        supports = as_supports(scene)
        modes = search_modes(body, supports, self.n, (), ovalising=True)
        points = [port.name for port in scene.ports[:1]]
        values = quantities_at(points, body, supports, modes)
        mass, bar = mass_of(scene)
        out: dict[str, Any] = {
            "model": self.model,
            "unknowns": body.size,
            "mass": mass,
            "mass bar": bar,
            BARS: without_bars(self.model),
        }
        out |= {str(name): values.get(name) for name in statics_of(scene)}
        elastic = [mode for mode in modes.modes if mode.frequency_hz > 0]
        for k, mode in enumerate(elastic[: self.n], start=1):
            out |= {f"f{k}_hz": mode.frequency_hz, f"mode{k}": str(mode.name)}
        return out


def scene_task(
    scene: Source,
    design: Design,
    *,
    model: str | None = None,
    tolerance: float | str | None = None,
    options: Mapping[str, Any] | None = None,
    n: int | None = None,
    ask: Iterable[str] = (),
) -> SceneTask:
    """Return the task of variants of a scene, with error bars: statics and natural frequencies by
    default; parameters as of :func:`solidgear.sweep`.

    Examples
    --------
    >>> design = Design(("segment.1.diameter=45 mm,50 mm",))
    >>> task = scene_task("geometry/shaft_stepped.toml", design, model="timoshenko")
    >>> thin, thick = task.rows([0, 1])
    >>> thin["C_zz"] > thick["C_zz"]
    True
    """
    if tolerance is not None:
        tolerance = read_tolerance(tolerance)
    checked = {} if model is None else LADDER[model].checked(dict(options or {}))
    variants = scene_variants(scene, design, "segment.1.diameter=30 mm:40 mm:5")
    first, usual = variants.first_sound()
    n = usual.ask.modes if n is None else n
    number("sweep", "n", n, least=1, below=MOST_MODES + 1, whole=True)
    return SceneTask(variants, model, tolerance, checked, n, first, asked_of(ask))


def asked_of(ask: Iterable[str]) -> tuple[str, ...]:
    """Return the kinds of numbers of rows in their order; refuse words of none."""
    return named_kinds(ask, ASKED, "a shaft") or (ANSWER,)
