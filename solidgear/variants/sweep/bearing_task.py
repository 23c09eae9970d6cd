"""Solution of one bearing set: statics at the lumped point and first modes, as a row."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from solidgear.core.body import Body
from solidgear.core.errors import SolidgearError
from solidgear.core.frames import DOF_NAMES
from solidgear.core.judge.quantities import size
from solidgear.core.machine.threads import pinned
from solidgear.core.quantity import Quantity
from solidgear.core.reduction.moments import Reduced
from solidgear.core.solve.modes import modes
from solidgear.core.solve.statics import condense
from solidgear.variants.sweep.bearing_variants import BearingVariants
from solidgear.variants.sweep.ritz import Seats, ritz_modes

#: Entries of the stiffness and the compliance that a row holds.
ENTRIES = {
    name: (i, i) for i, name in enumerate(2 * d if i < 3 else d for i, d in enumerate(DOF_NAMES))
} | {"x_thz": (0, 5), "z_thx": (2, 3)}


#: bound of what the reduction leaves of natural frequencies, relative, and words on all other bars
BOUND, BARS = "reduction_bound", "bars"


def without_bars(model: str) -> str:
    """Words on numbers of a mesh that nothing was told of."""
    return f"none: the {model} mesh was given; -f auto judges its own"


def columns(variants: BearingVariants, n: int, barred: bool) -> dict[str, type]:
    """Names and types of the columns of a row, in order."""

    def with_bar(name: str) -> dict[str, type]:
        names = [name, f"{name} bar"] if barred else [name]
        return dict.fromkeys(names, float)

    out: dict[str, type] = {"variant": int, **variants.columns}
    out |= {"status": str, "how": str, BOUND: float, BARS: str, "rigid_modes": int}
    for kind in "KC":
        for name in ENTRIES:
            out |= with_bar(f"{kind}_{name}")
    for k in range(1, n + 1):
        out |= with_bar(f"f{k}_hz") | {f"mode{k}": str}
    return out


@dataclass(frozen=True)
class Task:
    """Everything that is needed to turn variants into rows; small, so that it can be sent to other
    processes.
    """

    variants: BearingVariants
    #: from small to large, tried one after the other while the bound of a variant exceeds the
    #: tolerance
    bases: tuple[Reduced, ...]
    n: int  #: elastic shapes wanted, twins counted twice
    tolerance: float  #: relative error of a frequency that is let pass
    #: relative, of the mesh, by the names of numbers and modes; empty where none is known
    bars: Mapping[str, float] = field(default_factory=dict)
    said: str = ""  #: where they come from, or why there are none

    @pinned
    def rows(self, indices: Iterable[int]) -> list[dict[str, Any]]:
        """Rows of some variants.

        A row comes from the first basis that does for it, so it does not depend on which rows were
        solved before: a sweep that was stopped gives the same digits as one that was not.
        """
        seats: dict[tuple[int, ...], Seats] = {}
        return [self._first_that_does(i, seats) for i in indices]

    def _first_that_does(self, index: int, seats: dict[tuple[int, ...], Seats]) -> dict[str, Any]:
        for basis in self.bases:
            row = self._row(index, basis, seats)
            if not self.weak(row):
                break
        return row

    def _row(
        self, index: int, basis: Reduced, seats: dict[tuple[int, ...], Seats]
    ) -> dict[str, Any]:
        row: dict[str, Any] = {"variant": index, **self.variants.told(index)}
        frame = basis.frame
        try:
            scene, supports = self.variants.supports(index)
            static = condense(frame, supports, scene.port.name)
            ports = tuple(frame.port_index(name) for name in supports.ports)
            place = (basis.level, *ports)
            if place not in seats:
                seats[place] = Seats(basis, ports)
            found = ritz_modes(basis, seats[place], supports, self.n, self.tolerance)
        except SolidgearError as error:
            return row | {"status": self.variants.status(error, index), "how": ""}
        row |= {
            "status": "ok",
            "how": "reduced",
            BOUND: found.error_bound,
            BARS: self.said,
            "rigid_modes": supports.unresisted(frame).shape[1],
        }
        row |= {
            f"{kind}_{name}": float(m[at])
            for kind, m in (("K", static.stiffness), ("C", static.compliance))
            for name, at in ENTRIES.items()
        }
        row |= self._static_bars(row)
        return row | self._modal(found.frequency_hz, found.names)

    def _static_bars(self, row: Mapping[str, Any]) -> dict[str, Any]:
        """Bars of the entries of a row, in their units."""
        out = {}
        for kind in "KC":
            values = {_quantity(kind, name): row[f"{kind}_{name}"] for name in ENTRIES}
            for name, quantity in zip(ENTRIES, values):
                if quantity in self.bars:
                    width = self.bars[quantity] * size(values, quantity)
                    out[f"{kind}_{name} bar"] = width
        return out

    def _modal(self, frequency_hz: Iterable[float], names: Iterable[str]) -> dict[str, Any]:
        """Natural frequencies of a row with their bars and names."""
        out: dict[str, Any] = {}
        for k, (f, name) in enumerate(zip(frequency_hz, names), start=1):
            out |= {f"f{k}_hz": float(f), f"mode{k}": name}
            if name in self.bars:
                out[f"f{k}_hz bar"] = self.bars[name] * float(f)
        return out

    def weak(self, row: dict[str, Any]) -> bool:
        """Tell whether the error bound of a row exceeds the tolerance."""
        return row["status"] == "ok" and not row[BOUND] <= self.tolerance

    def in_full(self, row: dict[str, Any], body: Body) -> dict[str, Any]:
        """A row with its modes solved on the body itself."""
        _, supports = self.variants.supports(row["variant"])
        found = modes(body, supports, self.n, ovalising=False)
        shapes = [
            (m.frequency_hz, m.name)
            for m in found.modes
            if not m.name.rigid
            for _ in range(m.multiplicity)
        ][: self.n]
        # the residual bounds the error of an eigenvalue, twice that of a frequency
        return (
            row
            | {"how": "full", BOUND: found.evidence["residual"] / 2}
            | self._modal([f for f, _ in shapes], [str(name) for _, name in shapes])
        )


def _quantity(kind: str, name: str) -> Quantity:
    """Name of an entry among compared numbers."""
    return Quantity(f"{kind}_{name.replace('_', ',')}")
