"""How sure a solid is of its own numbers: one band a quantity, from the same solid on ever finer
meshes.

**Layered** sequences (harmonic solid, graded hexahedra) raise order or size and layers together.
One layer of ratio q towards a corner of exponent a leaves the share ``q^(2a)`` of what the corner
costs: 0.17 at a right-angled shoulder for q = 0.2, 0.32 for q = 0.35.  Every level then errs by a
nearly fixed share of its distance from the one before, and the band is a factor times that
distance.  The factors are measured, by ``validation/attack/bands.py`` on random shafts, and stand
in the ladder with the rung (:class:`solidgear.fidelity.rung.BandFactors`); they are no theorem.

**Pairs** are two orders on one mesh, where a rung has them and one number is wanted
(:func:`solidgear.evidence.sequence_bands.pair_bands`). The space of the lower order is part of that
of the higher one, so that the step between them is what the higher one takes away of the error, and
what it leaves is a share of that step that hardly depends on the shaft: of what a corner of
exponent a costs ``1 / ((p / (p - 1))^(4a) - 1)`` (Babuška, Szabó and Katz 1981). The band is the
factor of the pair (:attr:`solidgear.fidelity.rung.BandFactors.same_mesh`) times the step; one so
small that it may be an accident counts twice.

**Other** sequences (tetrahedra, linear elements, meshes that were asked for by refinement) use the
grid convergence index of :mod:`solidgear.evidence.converge`.

**Rough** sequences (sectors with teeth or holes) are refined plainly too, but whole numbers of cells
across narrow faces make their meshes similar only roughly: a place may keep its error over a step and
give it up in the next one. An observed order says nothing then. With the order p of the sharpest
corner a change d leaves ``d / (r^p - 1)``; the band is a measured factor times that of the largest
change so far, from two meshes on.

A change that is small by accident, since a quantity passes through an extremum on its way, is not
believed: the change before it, and for couplings the changes of both diagonal entries, set a floor.
Displacement elements are too stiff, so the error of the compliance is a positive semidefinite
matrix and that of a coupling no larger than the geometric mean of its diagonal entries'. So is a
term between two points, which is related to the geometric mean of what each point has of its own,
never to itself: it may vanish by symmetry. A rung that stands on another model's modes errs in ways
that no mesh of its own tells of: its bands hold at least a share of what features change. What the
solver leaves (residuals of statics and modes) is added, and of hexahedra what the cells around
leave, which layers do not touch: it is measured on the coarsest level with half as many cells
around again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

from solidgear.evidence.converge import gci
from solidgear.evidence.quantities import AT, change, described, diagonals, in_order, points_of
from solidgear.fidelity.rung import STEPPED

if TYPE_CHECKING:
    from solidgear.fidelity.rung import BandFactors

#: safety on the observed reduction of two regular steps, where that is the worse news
OBSERVED, SLOWEST = 1.5, 0.7
#: least factor from the fourth level on, where few errors could be measured
LATE = 0.5
#: least factor after two levels of a stiffness with several points held: only the shaft between
#: them gives, and a step off the coarsest mesh tells little of its corners. Of 388 errors of 29
#: random shafts (validation/attack/points.py) 90 % were held without it, and 11 of 78 on fresh ones,
#: all of one shaft, were up to 1.75 times the change; not judged on fresh seeds since
BETWEEN_HELD = 2.0
#: the change of a coupling counts for at least this share of those of its diagonal entries
DIAGONAL = 0.2
#: safety on what the cells around leave: in thin walls the coarsest mesh, where it is measured,
#: shows half of it
SURE_AROUND = 2.5
#: rounding: smaller differences mean nothing
LEAST = 1e-10


@dataclass(frozen=True)
class Band:
    """Band of one quantity.

    Attributes
    ----------
    values : tuple of float
        Coarse to fine.
    gci : float
        The band, relative to the finest value (couplings: to the geometric mean of their diagonal
        entries).
    change : float
        Last change, relative.
    reduction : float or None
        Last change over the one before.
    factor : float
        Band over the change it rests on, or the safety factor of the grid convergence index.
    solver : float
        Share of the solver in the band.
    extrapolated : float
    observed_order, expected_order, used_order : float or None
        Of the grid convergence index.
    method : str
        ``layers`` or ``grid convergence index``.
    """

    values: tuple[float, ...]
    gci: float
    change: float
    reduction: float | None
    factor: float
    solver: float
    extrapolated: float
    observed_order: float | None = None
    expected_order: float | None = None
    used_order: float | None = None
    method: str = "layers"

    def as_dict(self) -> dict:
        """Plain data for results.json."""
        return asdict(self)


Values = Mapping[str, float]


def layered_bands(
    levels: Sequence[Values],
    solver: Values,
    factors: BandFactors,
    *,
    edge: str = STEPPED,
    around: Values | None = None,
    effect: Values | None = None,
    diagonal: float = DIAGONAL,
) -> dict[str, Band]:
    """Bands of the finest of two or more levels of a layered sequence.

    Parameters
    ----------
    levels : sequence of mappings
        Quantity to value (see :func:`solidgear.evidence.quantities.measure`), coarse to fine.
    solver : mapping
        Relative error the solver may have left in each quantity of the finest level.
    factors : BandFactors
        Of the rung.
    edge : str
        What is sharpest on the shaft (:func:`solidgear.fidelity.edges.sharpest_edge`).
    around : mapping, optional
        Relative error that the cells around leave in each quantity.
    effect : mapping, optional
        What features change of each quantity, relative, where the rung has shares of it.
    diagonal : float
        The change of a coupling counts for at least this share of those of its diagonal entries.
    """
    around, effect = around or {}, effect or {}
    usual = factors.usual[edge]
    out = {}
    finest, before = levels[-1], levels[-2]
    for name in in_order(levels[-1]):
        if any(name not in level for level in levels[-2:]):
            continue
        last = abs(change(before, finest, name) or 0.0)
        earlier = None
        if len(levels) > 2 and name in levels[-3]:
            earlier = abs(
                (change(levels[-3], finest, name) or 0.0) - (change(before, finest, name) or 0.0)
            )
        rests_on = max(last, factors.earlier * (earlier or 0.0))
        factor = usual if len(levels) > 2 else _first(_rule(factors, edge, name), rests_on)
        if len(levels) == 2 and points_of(name) and name.startswith("K_"):
            factor = max(factor, BETWEEN_HELD)
        if earlier and len(levels) > 3:  # the step off the coarsest mesh is no regular one
            ratio = min(last / earlier, SLOWEST)
            factor = max(usual, LATE, OBSERVED * ratio / (1 - ratio))
        if pair := diagonals(name):
            own = [
                abs(change(before, finest, d) or 0.0) for d in pair if d in before and d in finest
            ]
            if len(own) == 2:
                rests_on = max(rests_on, diagonal * (own[0] * own[1]) ** 0.5)
        left = solver.get(name, 0.0)
        least = factors.least_share(name.partition(AT)[0], len(levels)) * effect.get(name, 0.0)
        out[name] = Band(
            values=tuple(float(level[name]) for level in levels if name in level),
            gci=float(
                max(factor * rests_on, least)
                + SURE_AROUND * _left_around(around, name)
                + left
                + LEAST
            ),
            change=float(last),
            reduction=float(last / earlier) if earlier else None,
            factor=factor,
            solver=float(left),
            extrapolated=float(finest[name] + factors.ahead * (finest[name] - before[name])),
        )
    return out


def _rule(factors: BandFactors, edge: str, name: str) -> tuple[float, float, float]:
    """The rule after two levels."""
    known = factors.first_of_modes if described(name)[0] == "frequency" else {}
    return known.get(edge, factors.first[edge])


def _first(rule: tuple[float, float, float], step: float) -> float:
    """Band over the change after two levels."""
    small, reach, large = rule
    return max(large, min(small, reach / step)) if step else small


def _left_around(around: Values, name: str) -> float:
    """What the cells around leave in a quantity; in a coupling as much as in its diagonal entries,
    in one that was not measured as much as in the worst.
    """
    if pair := diagonals(name):
        own = [around[d] for d in pair if d in around]
        return max([around.get(name, 0.0), (own[0] * own[1]) ** 0.5 if len(own) == 2 else 0.0])
    return around.get(name, max(around.values(), default=0.0))


def refined_bands(
    levels: Sequence[Values],
    solver: Values,
    sizes: Sequence[float],
    exponent: float,
    singular: bool,
) -> dict[str, Band]:
    """Bands of the finest of three levels of plain refinement.

    Parameters
    ----------
    levels, solver
        As for :func:`layered_bands`.
    sizes : sequence of three floats
        Representative cell sizes, descending.
    exponent : float
        Of the sharpest corner or rigid seat end.
    singular : bool
        Whether nothing lifts the meshes above the order of that corner (tetrahedra).

    Raises
    ------
    ValueError
        If there are not three results, or sizes do not descend.
    """
    expected = 2 * exponent
    out = {}
    for name in in_order(levels[-1]):
        if any(name not in level for level in levels[-3:]):
            continue
        v = [float(level[name]) for level in levels[-3:]]
        if pair := diagonals(
            name
        ):  # relative to the scale of a coupling: an offset that leaves differences alone
            scale = _scale(levels[-1], name, pair)
            v = [1.0 + x / scale - v[-1] / scale for x in v]
        found = gci(v, sizes[-3:], expected, 4.0, expected if singular else 2.0)
        left = solver.get(name, 0.0)
        out[name] = Band(
            values=tuple(float(level[name]) for level in levels[-3:]),
            gci=float(found.gci + left + LEAST),
            change=abs(v[2] - v[1]),
            reduction=abs((v[2] - v[1]) / (v[1] - v[0])) if v[1] != v[0] else None,
            factor=found.factor,
            solver=float(left),
            extrapolated=float(levels[-1][name] if pair else found.extrapolated),
            observed_order=found.observed_order,
            expected_order=found.expected_order,
            used_order=found.used_order,
            method="grid convergence index",
        )
    return out


def rough_bands(
    levels: Sequence[Values],
    solver: Values,
    sizes: Sequence[float],
    exponent: float,
    safety: tuple[float, float],
) -> dict[str, Band]:
    """Bands of the finest of two or more levels of meshes that are similar only roughly.

    Parameters
    ----------
    levels, solver
        As for :func:`layered_bands`; of more than three levels the last three count.
    sizes : sequence of float
        Representative cell size of every level, descending.
    exponent : float
        Of the sharpest corner or rigid seat end.
    safety : (float, float)
        Band over what the largest change leaves, of two levels and of more.

    Returns
    -------
    dict of str to Band
    """
    expected = 2 * exponent
    left_over = 1 / ((sizes[-2] / sizes[-1]) ** expected - 1)
    factor = safety[len(levels) > 2]
    last = levels[-3:]
    steps: dict[str, list[float]] = {
        name: [abs(change(a, b, name) or 0.0) for a, b in zip(last, last[1:]) if name in a]
        for name in in_order(levels[-1])
        if name in levels[-2]
    }
    out = {}
    for name, known in steps.items():
        rests_on = max(known)
        pair = diagonals(name)
        if pair and all(d in steps for d in pair):
            one, two = (max(steps[d]) for d in pair)
            rests_on = max(rests_on, DIAGONAL * (one * two) ** 0.5)
        left = solver.get(name, 0.0)
        finest, before = levels[-1][name], levels[-2][name]
        out[name] = Band(
            values=tuple(float(level[name]) for level in levels if name in level),
            gci=float(factor * left_over * rests_on + left + LEAST),
            change=float(known[-1]),
            reduction=float(known[-1] / known[-2]) if len(known) > 1 and known[-2] else None,
            factor=factor * left_over,
            solver=float(left),
            extrapolated=float(finest + left_over * (finest - before)),
            expected_order=expected,
            used_order=expected,
            method="order of the sharpest corner",
        )
    return out


def _scale(values: Values, name: str, pair: tuple[str, str]) -> float:
    one, two = pair
    return (
        (values[one] * values[two]) ** 0.5
        if one in values and two in values
        else abs(values[name]) or 1.0
    )
