"""Error bars of a solid on a list of meshes, one a quantity.

A change d from one mesh to the next leaves ``d / (r^(2a) - 1)`` where the cells shrink by r and the
sharpest corner has the exponent a (Szabo and Babuska 1991, Finite Element Analysis, ch. 10); where
layers towards the corners are added with every mesh, about as much as the change itself. The error
bar is a measured factor (:mod:`solidgear.core.bounds.safety`) times that of the larger of the last two
changes, since one of them may be small by accident.

Displacement elements are too stiff, so the error of a compliance is a positive semidefinite matrix
and that of a coupling no larger than the geometric mean of its diagonal entries' errors. The error
of the solver is added, and of hexahedra the error that the cells around leave.

A harmonic solid needs none of this: :mod:`solidgear.core.judge.bounded`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from solidgear.core.body.mode_names import ModeName
from solidgear.core.bounds.safety import Safety
from solidgear.core.judge.quantities import Values, change, in_order
from solidgear.core.quantity import Quantity

#: rounding: smaller differences mean nothing
LEAST = 1e-10
#: relative difference of sizes below which cells are equally large
SAME_SIZE = 0.02
#: sides of a cell in a sentence, in the order of their sizes
SIDES = ("longest", "middle", "shortest")


@dataclass(frozen=True)
class ErrorBar:
    """Error bar of one quantity."""

    values: tuple[float, ...]  #: coarse to fine
    #: the error bar, relative to the finest value (couplings: to the geometric mean of their
    #: diagonal entries)
    width: float
    change: float  #: last change, relative; of local problems the distance of the other end
    reduction: float | None  #: last change over the one before
    factor: float  #: ratio of the error bar to the change it is computed from
    solver: float  #: share of the solver in the error bar
    extrapolated: float
    method: str = "two meshes"  #: where the error bar comes from
    #: a better value than the finest one, where there is one
    middle: float | None = None
    aside: float = 0.0  #: distance of `middle` from the finest value, relative as `width`
    geometry: float = (
        0.0  #: share of the error bar, to either side, as a mesh is not quite the body
    )

    @property
    def about_middle(self) -> float:
        """The error bar about `middle`, which is narrower; about the finest value where there is
        none.
        """
        return self.width if self.middle is None else self.width - self.aside


def step_bars(
    levels: Sequence[Values],
    solver: Values,
    safety: Safety,
    *,
    left_over: float | None = None,
    around: Values | None = None,
    effect: Values | None = None,
    shape: float = 0.0,
) -> dict[Quantity, ErrorBar]:
    """Compute error bars of the finest of two or more meshes, whose values are given coarse to
    fine.

    Parameters
    ----------
    solver : mapping
        Relative error the solver may have left in each quantity of the finest level.
    left_over : float, optional
        Share of a change that remains as error by plain refinement; None of meshes with layers.
    around : mapping, optional
        Relative error that the cells around leave in each quantity.
    effect : mapping, optional
        Change of each quantity by features, relative.
    shape : float
        Share that second moments of the finest mesh are off by, whatever the others are.

    Examples
    --------
    >>> meshes = [{Quantity("C_zz"): value} for value in (1.0, 1.1, 1.12)]
    >>> bar = step_bars(meshes, {}, Safety((3.0, 2.0)), left_over=1.0)["C_zz"]
    >>> round(bar.width, 4)  # twice the larger change
    0.1818
    """
    around, effect = around or {}, effect or {}
    factor = safety.steps[len(levels) > 2] * (left_over or 1.0)
    last, counted_steps = levels[-3:], 2 if left_over else 1
    steps = {
        name: [abs(change(a, b, name) or 0.0) for a, b in zip(last, last[1:]) if name in a]
        for name in in_order(levels[-1])
        if name in levels[-2]
    }
    out = {}
    for name, changes in steps.items():
        rests_on = max(changes[-counted_steps:])
        pair = name.diagonals
        if pair and all(d in steps for d in pair):
            change_a, change_b = (max(steps[d][-counted_steps:]) for d in pair)
            rests_on = max(rests_on, (change_a * change_b) ** 0.5)
        solver_error = solver.get(name, 0.0)
        least = safety.least_share(moves_freely(name), len(levels)) * effect.get(name, 0.0)
        finest, before = levels[-1][name], levels[-2][name]
        out[name] = ErrorBar(
            values=tuple(float(level[name]) for level in levels if name in level),
            width=float(
                max(factor * rests_on, least)
                + safety.steps[0] * _left_around(around, name)
                + solver_error
                + shape
                + LEAST
            ),
            change=float(changes[-1]),
            reduction=float(changes[-1] / changes[-2])
            if len(changes) > 1 and changes[-2]
            else None,
            factor=factor,
            solver=float(solver_error),
            extrapolated=float(finest + min(left_over or 1.0, 1.0) * (finest - before)),
        )
    return out


def sizes_of(facts: Mapping[str, Any]) -> tuple[float, ...]:
    """Return the sizes of the cells of a mesh by the facts of it, m: one of a mesh made here, which
    is refined in all directions, and three of a mesh file, where that is not certain; none without
    cells.
    """
    usual = facts.get("representative_size")
    return facts.get("cell_sizes") or ((usual,) if usual else ())


def shrinkage(coarser: Sequence[float], finer: Sequence[float]) -> float:
    """Return the factor by which cells shrink from one mesh to the next, in the direction in which
    they shrink least; 1 where there is one in which they do not.

    Examples
    --------
    >>> shrinkage((50.0, 20.0, 4.0), (25.0, 10.0, 4.0))  # layers through a wall stay
    1.0
    """
    least = min((a / b for a, b in zip(coarser, finer)), default=1.0)
    return least if least > 1 + SAME_SIZE else 1.0


def same_size(coarser: Sequence[float], finer: Sequence[float]) -> str:
    """Return the reason for no error bar from two meshes of files whose cells do not shrink in some
    direction.
    """
    ratio, place = min((a / b, k) for k, (a, b) in enumerate(zip(coarser, finer)))
    sides = f"{1e3 * coarser[place]:.3g} mm and {1e3 * finer[place]:.3g} mm"
    return (
        f"no error bar from the last two meshes, since the {SIDES[place]} sides of their cells "
        f"are {'as long' if ratio < 1 + SAME_SIZE else 'hardly shorter'}, {sides}: list a mesh "
        "with half of that in every direction"
    )


def left_over(shrunk: float, exponent: float) -> float:
    """Return the share of a change between two meshes that remains as error, by the factor by which
    cells shrink and the exponent of displacement at the sharpest corner.
    """
    return 1 / (shrunk ** (2 * exponent) - 1)


def moves_freely(name: Quantity) -> bool:
    """Return whether a quantity is a frequency of a motion that bearings may leave free."""
    return name.is_frequency and ModeName(name).family in ("axial", "torsion")


def _left_around(around: Values, name: Quantity) -> float:
    """Return the share that the cells around leave in a quantity; in a coupling as much as in the
    diagonal entries, in one that was not measured as much as in the worst.
    """
    if pair := name.diagonals:
        diagonal = [around[d] for d in pair if d in around]
        return max(
            [
                around.get(name, 0.0),
                (diagonal[0] * diagonal[1]) ** 0.5 if len(diagonal) == 2 else 0.0,
            ]
        )
    return around.get(name, max(around.values(), default=0.0))
