"""Factors of the shifted stiffness of a body, which statics, modes and reductions share."""

from __future__ import annotations

from dataclasses import dataclass

from solidgear.core.body import Block, Body
from solidgear.core.factoring import Factoring
from solidgear.core.machine.memory import NoRoom, available_mb
from solidgear.core.registry import addition
from solidgear.core.solve.factor import Planned, factored, planned
from solidgear.core.solve.factored import Factor

# Of the lowest elastic eigenvalue.  Rounding in the factor is amplified by the highest eigenvalue
# of the mesh over the shift: 1e-3 left 5e-3 of the frequencies of slender tubes wrong, 3e-2 leaves
# what refinement can mend.  Statics takes a solve more for it.
SHIFT = 0.03


@dataclass(frozen=True)
class Factored:
    """Factors of the shifted stiffness of a body."""

    of_block: list[Factor]  #: one per block, twins sharing theirs


def factors(body: Body) -> list[Factor]:
    """Return one factor of ``K + sigma M`` per block, which twins share, kept with the body;
    FactorError as :func:`~solidgear.core.solve.factor.factorise`, NoRoom if they will not fit into
    memory together, with the ways out that the body knows.
    """
    return body.cache.get(Factored, lambda: _factored(body)).of_block


def plans(body: Body, factoring: Factoring) -> dict[int, Planned]:
    """Analyse the factors of a body in full without making them, by the identity of the stiffness,
    which twins share.
    """
    by_stiffness: dict[int, Planned] = {}
    for block in body.blocks:
        key = id(block.stiffness)
        if key not in by_stiffness:
            by_stiffness[key] = _plan(block, SHIFT * body.scale, factoring)
    return by_stiffness


def needed_mb(body: Body, factoring: Factoring) -> float:
    """Return the memory that the factors of a body would take, by analysis, MB."""
    return sum(plan.estimate_mb for plan in plans(body, factoring).values())


def _factored(body: Body) -> Factored:
    # what factors planar matrices takes no memory to analyse them
    free = None if all(block.planar for block in body.blocks) else available_mb()
    analysed = plans(body, body.factoring)
    try:
        factors_made = dict(zip(analysed, factored([*analysed.values()], free)))
    except NoRoom as error:
        analysed.clear()  # ways out are analysed in their place
        if body.remedies is None:
            raise
        raise body.remedies(body, error) from None
    return Factored([factors_made[id(block.stiffness)] for block in body.blocks])


def _plan(block: Block, shift: float, factoring: Factoring) -> Planned:
    matrix = (block.stiffness + shift * block.mass).tocsr()
    if factoring.engine != "own":
        return addition("engine", "ranks")(block, matrix, factoring)
    return planned(
        matrix,
        planar=block.planar,
        border=block.border,
        factoring=factoring,
        # by what the body holds anyway, not by a copy
        product=lambda u: block.stiffness @ u + shift * (block.mass @ u),
    )
