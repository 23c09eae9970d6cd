"""Rows of a sweep of bearings alone: the body once, its reduction once, then a small problem a row,
with statics at the lumped point and the first modes.

The error of a mesh depends on the bearings: the stiffer they are, the more of the compliance is
the shaft's.  So the mesh is judged on the scene and at both ends of everything that varies, and the
finest that one of these needs serves all.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, ClassVar

import numpy as np

from solidgear.bearings.solved import waiting
from solidgear.core import (
    DOF_NAMES,
    LADDER,
    Body,
    Quantity,
    Scene,
    SceneError,
    Settled,
    SolidgearError,
    bars_of_modes,
    build,
    listed,
    modes,
    settle,
    size,
)
from solidgear.core.models.limits import number
from solidgear.core.reduction.moments import LEVELS, Reduced, reduce
from solidgear.core.solve.statics import condense
from solidgear.variants.sweep.bearing_variants import BearingVariants, SeatedShaft
from solidgear.variants.sweep.bench import surface
from solidgear.variants.sweep.curves import curves_of
from solidgear.variants.sweep.file_task import BARS, BOUND, Swept, Task, without_bars
from solidgear.variants.sweep.ritz import Seats, ritz_modes
from solidgear.variants.sweep.rows import RowFile

#: entries of the stiffness and the compliance that a row holds
ENTRIES = {
    name: (i, i) for i, name in enumerate(2 * d if i < 3 else d for i, d in enumerate(DOF_NAMES))
} | {"x,thz": (0, 5), "z,thx": (2, 3)}
#: most elastic shapes of a row, two columns each; a basis that holds as many is no small problem
MOST_SHAPES = 1000
#: variants that the basis is tried on before the run
PROBES = 24
#: sets of seats whose small problems are kept
KEPT = 50


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SweptBearings(Swept):
    """Rows of a sweep of bearings; numbers of the run are zero where nothing was left to do, and
    refusals are those of this run.
    """

    plain_names: ClassVar[tuple[Any, ...]] = (
        *(("file", "path"), "total", "skipped", "refused", "full", "unknowns", "seats", "basis"),
        *("seconds_once", "seconds_each", "whys", "settling"),
    )

    full: int  #: variants whose modes were solved on the body itself, of this run
    unknowns: int  #: of the body
    seats: int  #: on the body
    basis: int  #: unknowns of the largest small problem
    seconds_once: float  #: wall seconds for body and reduction
    seconds_each: float  #: wall seconds per variant of this run
    settling: str  #: sentence on the load at which the stiffness of catalogue bearings is taken
    task: BearingTask


@dataclass(eq=False)
class BearingTask(Task[SweptBearings]):
    """Turns bearing sets on one body into rows; other processes get the small operators alone."""

    batch: ClassVar[tuple[int, int]] = 50, 50

    variants: BearingVariants
    model: str
    options: Mapping[str, Any]  #: of the builder of the model
    n: int  #: elastic shapes, twins counted twice
    #: relative error of frequencies against the same body solved in full: a variant whose bound
    #: exceeds it makes the basis larger, and where that does not do it is solved in full
    tolerance: float
    #: relative error bars of the mesh by the names of numbers and modes; None where it has none
    bars: Mapping[str, float] | None = None
    judged_on: int = 0  #: number of bearing sets that these are the largest over
    #: from small to large, tried one after the other while the bound of a row exceeds the tolerance
    bases: tuple[Reduced, ...] = ()

    def __post_init__(self) -> None:
        self.body: Body | None = None
        self.settled: Settled | None = None  #: the mesh, where it was chosen for the sweep
        self.seats = self.full = 0
        self.whys = Counter[str]()

    @property
    def columns(self) -> dict[str, type]:
        out: dict[str, type] = {"how": str, BOUND: float, BARS: str, "rigid_modes": int}
        for kind in "KC":
            for name in ENTRIES:
                out |= self._with_bar(f"{kind}_{name}")
        for k in range(1, self.n + 1):
            out |= self._with_bar(f"f{k}_hz") | {f"mode{k}": str}
        return out

    def _with_bar(self, name: str) -> dict[str, type]:
        return {name: float} if self.bars is None else {name: float, f"{name} bar": float}

    @property
    def plan(self) -> dict[str, Any]:
        scene = self.variants.scene.as_dict()
        return {
            "scene": {
                key: scene[key] for key in scene if key not in ("title", "name", "source", "ask")
            },
            "fidelity": self.model,
            "set": {
                key: list(value) if isinstance(value, tuple) else value
                for key, value in self.options.items()
            },
            "n": self.n,
            "tolerance": self.tolerance,
        }

    # ------------------------------------------------------------------------------ before the rows
    def prepare(self, file: RowFile, progress: Callable[[str], None]) -> None:
        """Build the body with all seats, and a basis that does for some variants or the largest."""
        shaft = self.variants.shaft()
        self.seats = self._checked_seats(shaft)
        progress(f"body with {self.seats} seats")
        self.body = build(shaft, self.model, **self.options)
        progress(f"reducing {self.body.size} unknowns")
        self.bases = (reduce(self.body, self.n, file.basis or 0),)
        if file.basis is None:
            # probes are of all variants: the basis is the same after an interruption
            total = len(self.variants)
            self._enlarge_for(range(total)[:: max(1, total // PROBES)])
            file.basis = self.bases[0].level

    def _checked_seats(self, shaft: SeatedShaft) -> int:
        """Return the number of seats, which one body must carry."""
        scene = self.variants.scene
        seats, most = len(shaft.stations) - len(scene.ports), LADDER[self.model].most_seats
        if most is not None and seats > most:
            raise SolidgearError(
                f"{seats} different seats are more than the {most} one {self.model} body carries; "
                "vary fewer positions, sweep them in parts, or use a cheaper model"
            )
        attachments = self.options.get("attachments") or ()
        kinds = attachments if isinstance(attachments, (tuple, list)) else (attachments,)
        if "rigid" in kinds and seats > len(scene.bearings):
            raise SolidgearError(
                "attachments: a rigid seat stiffens the shaft wherever it is meshed, so seats "
                "cannot be rigid in a sweep of positions"
            )
        return seats

    def _enlarge_for(self, probes: Iterable[int]) -> None:
        """Begin with a basis that does for some variants, or with the largest."""
        while any(map(self.weak, self.rows(probes))) and (basis := self._larger_basis()):
            self.bases = (basis,)

    def _larger_basis(self) -> Reduced | None:
        assert self.body is not None
        level = self.bases[-1].level + 1
        return reduce(self.body, self.n, level) if level < len(LEVELS) else None

    # -------------------------------------------------------------------------------------- rows
    def numbers(self, index: int) -> dict[str, Any]:
        """Return the numbers of a variant by the first basis that does for it, which does not depend
        on the variants before: a sweep that was stopped gives the same digits as one that was not.
        """
        scene, supports = self.variants.supports(index)
        frame = self.bases[0].frame
        static = condense(frame, supports, scene.port.name)
        ports = tuple(frame.port_index(name) for name in supports.ports)
        for basis in self.bases:
            seats = self._seats_at(basis, ports)
            shapes = ritz_modes(basis, seats, supports, self.n, self.tolerance)
            if shapes.error_bound <= self.tolerance:
                break
        numbers: dict[str, Any] = {
            "how": "reduced",
            BOUND: shapes.error_bound,
            BARS: without_bars(self.model)
            if self.bars is None
            else f"of the mesh: the largest over {self.judged_on} bearing sets",
            "rigid_modes": supports.unresisted(frame).shape[1],
        }
        for kind, matrix in (("K", static.stiffness), ("C", static.compliance)):
            numbers |= {f"{kind}_{name}": float(matrix[ij]) for name, ij in ENTRIES.items()}
        numbers |= self._bars_of_statics(numbers)
        return numbers | self._columns_of_modes(shapes.frequency_hz, shapes.names)

    def _seats_at(self, basis: Reduced, ports: tuple[int, ...]) -> Seats:
        key = (basis.level, *ports)
        if key not in self._seats:
            if len(self._seats) >= KEPT:
                self._seats.clear()
            self._seats[key] = Seats(basis, ports)
        return self._seats[key]

    @cached_property
    def _seats(self) -> dict[tuple[int, ...], Seats]:
        return {}

    def _bars_of_statics(self, numbers: Mapping[str, Any]) -> dict[str, float]:
        """Return the error bars of the entries of a row, in their units."""
        bars, out = self.bars or {}, {}
        for kind in "KC":
            names = {name: Quantity(f"{kind}_{name}") for name in ENTRIES}
            values = {quantity: numbers[f"{kind}_{name}"] for name, quantity in names.items()}
            for name, quantity in names.items():
                if quantity in bars:
                    out[f"{kind}_{name} bar"] = bars[quantity] * size(values, quantity)
        return out

    def _columns_of_modes(
        self, frequency_hz: Iterable[float], names: Iterable[str]
    ) -> dict[str, Any]:
        """Return the natural frequencies of a row with their bars and names."""
        bars, out = self.bars or {}, dict[str, Any]()
        for k, (f, name) in enumerate(zip(frequency_hz, names), start=1):
            out |= {f"f{k}_hz": float(f), f"mode{k}": name}
            if name in bars:
                out[f"f{k}_hz bar"] = bars[name] * float(f)
        return out

    # ------------------------------------------------------------------------------ after the rows
    def weak(self, row: Mapping[str, Any]) -> bool:
        """True if the error bound of a row exceeds the tolerance."""
        return row["status"] == "ok" and not row[BOUND] <= self.tolerance

    def checked(self, row: dict[str, Any]) -> dict[str, Any]:
        """Return a row within the tolerance: of a larger basis, or solved on the body itself."""
        if row["status"] != "ok":
            self.whys[row["status"]] += 1
            return row
        if self.weak(row):
            row = self._again(row)  # there may be a larger basis by now
        while self.weak(row) and (basis := self._larger_basis()):
            self.bases = (*self.bases, basis)
            row = self._again(row)
        if self.weak(row):
            self.full += 1
            row |= self._modes_in_full(row["variant"])
        return row

    def _again(self, row: Mapping[str, Any]) -> dict[str, Any]:
        return self.rows([row["variant"]])[0]

    def _modes_in_full(self, index: int) -> dict[str, Any]:
        """Return the columns of the modes of a variant, solved on the body itself."""
        assert self.body is not None
        _, supports = self.variants.supports(index)
        solved = modes(self.body, supports, self.n, ovalising=False)
        shapes = [
            (mode.frequency_hz, str(mode.name))
            for mode in solved.modes
            if not mode.name.rigid
            for _ in range(mode.multiplicity)
        ][: self.n]
        frequencies = [frequency for frequency, _ in shapes]
        # the residual bounds the error of an eigenvalue, twice that of a frequency
        return {
            "how": "full",
            BOUND: solved.evidence["residual"] / 2,
            **self._columns_of_modes(frequencies, [name for _, name in shapes]),
        }

    def result(
        self, file: RowFile, skipped: int, seconds: tuple[float, float], alone: bool
    ) -> SweptBearings:
        total, (once, rows) = len(self.variants), seconds
        return SweptBearings(
            columns=file.later(),
            total=total,
            whys=dict(self.whys),
            varied=tuple(self.variants.columns),
            curves=curves_of(file.by_column, self.variants),
            error_curves=(),
            path=file.path,
            skipped=skipped,
            seconds=sum(seconds),
            full=self.full,
            unknowns=0 if self.body is None else self.body.size,
            seats=self.seats,
            basis=max((basis.size for basis in self.bases), default=0),
            seconds_once=0.0 if self.body is None else once,
            seconds_each=0.0 if self.body is None else rows / (total - skipped),
            settling=_settling(self.variants),
            task=self,
            alone=alone,
        )


def _settling(variants: BearingVariants) -> str:
    """Return the sentence on the load at which the stiffness of catalogue bearings is taken."""
    names = waiting(variants.scene)
    if not names:
        return ""
    which = f"Catalogue {'bearing' if len(names) == 1 else 'bearings'} {', '.join(names)}"
    factors = [entry.label for entry in variants.entries if variants.multiplies(entry)]
    cases = variants.scene.cases
    text = (
        f'stiffness under the load case "{cases[0].name}"' if cases else "stiffness under the loads"
    )
    if len(factors) < len(variants.entries):
        text += ", found anew for every variant"
    if not factors:
        return f"{which}: {text}."
    return f"{which}: {text}; {listed(factors)} multiplies it and leaves the loads as they are."


def bearing_task(
    variants: BearingVariants,
    *,
    model: str = "harmonic",
    options: Mapping[str, Any] | None = None,
    n: int | None = None,
    tolerance: float = 1e-6,
    bars: Mapping[str, float] | None = None,
    judged_on: int = 0,
) -> BearingTask:
    """Return the task of statics and first modes of many bearing sets on one body; parameters as of
    :class:`BearingTask`, by default as many elastic shapes as the scene asks for.

    Examples
    --------
    >>> from solidgear.variants.sweep.bearing_variants import bearing_variants
    >>> sets = bearing_variants("geometry/shaft_stepped.toml", ["bearing.A.scale=1,2"])
    >>> [*bearing_task(sets, model="timoshenko", n=1).columns][-2:]
    ['f1_hz', 'mode1']
    """
    n = variants.scene.ask.modes if n is None else n
    number("sweep", "n", n, least=1, below=MOST_SHAPES + 1, whole=True)
    number("sweep", "tolerance", tolerance, above=0, below=1)
    variants.first_sound()
    return BearingTask(variants, model, dict(options or {}), n, tolerance, bars, judged_on)


#: bearing sets, beside that of the scene, on which a mesh is judged
MOST = 8
#: modes beyond those of a row, which error bars of the last of a family need
SPARE = 6


def settled_for_sweep(
    variants: BearingVariants,
    tol: float | str | None = None,
    *,
    progress: Callable[[str], None] = lambda _: None,
) -> Settled:
    """Return the cheapest body whose error bars are within a tolerance on the scene and at the ends
    of a sweep: the finest mesh that one of these bearing sets needs, with the largest error bar of
    each quantity over all of them. The tolerance is relative, that of the scene by default.

    Examples
    --------
    >>> from solidgear.variants.sweep.bearing_variants import bearing_variants
    >>> scales = ["bearing.A.scale=log:0.1:10:9"]
    >>> variants = bearing_variants("geometry/shaft_stepped.toml", scales)
    >>> settled = settled_for_sweep(variants, 0.05)
    >>> settled.judged_on, settled.reached
    (3, True)
    """
    scenes = [variants.scene, *_ends(variants)]
    each: list[Settled] = []
    last: dict[Hashable, Settled] = {}
    for k, scene in enumerate(scenes, start=1):
        numbered = partial(_numbered, progress, k, len(scenes))
        # bearings that sit where others did are other springs on the same body
        body = surface(scene)
        last[body] = settle(scene, tol, "all", before=last.get(body), progress=numbered)
        each.append(last[body])
    finest = max(each, key=lambda settled: settled.body.size)
    bars: dict[Quantity, float] = {}
    for settled in each:
        for quantity, bar in settled.bars.items():
            bars[quantity] = max(bar, bars.get(quantity, 0.0))
    return replace(
        finest,
        bars=bars,
        reached=all(settled.reached for settled in each),
        judged_on=len(each),
    )


def bars_of_rows(variants: BearingVariants, settled: Settled, n: int) -> dict[str, float]:
    """Return relative error bars of the numbers of rows and of `n` natural frequencies by their names:
    the largest over the scene and the ends of a sweep, on the mesh that was settled on.
    """
    bars: dict[str, float] = {str(name): bar for name, bar in settled.bars.items()}
    everywhere: set[str] | None = None
    for scene in [variants.scene, *_ends(variants)]:
        body = build(scene, settled.rung, **settled.options)
        shapes = modes(body, scene, n + SPARE, ovalising=False)
        of_scene = {
            str(name): bar for name, bar in bars_of_modes(scene, body, shapes, settled).items()
        }
        everywhere = {*of_scene} if everywhere is None else everywhere & {*of_scene}
        for name, bar in of_scene.items():
            bars[name] = max(bar, bars.get(name, 0.0))
    assert everywhere is not None
    everywhere |= {*map(str, settled.bars)}
    return {name: bar for name, bar in bars.items() if name in everywhere and math.isfinite(bar)}


def _ends(variants: BearingVariants) -> list[Scene]:
    """Return the variants with the lowest and the highest value of every entry that varies."""
    # the ends of all at once first, then of one after the other
    ranks = variants.values.argsort(axis=0).argsort(axis=0).sum(axis=1)
    wanted = [int(ranks.argmin()), int(ranks.argmax())]
    for column in variants.values.T:
        wanted += [int(np.argmin(column)), int(np.argmax(column))]
    out: list[Scene] = []
    for index in list(dict.fromkeys(wanted))[:MOST]:
        try:
            out.append(variants.variant(index))
        except SceneError:
            continue  # its row will say why
    return out


def _numbered(progress: Callable[[str], None], k: int, count: int, text: str) -> None:
    progress(f"bearing set {k} of {count}: {text}")
