"""Meshes that a solid is solved on, coarse to fine, until the error bar meets a target.

Every level refines at once all that limits accuracy: the order of the harmonic elements (or the size
of 3D ones) and the layers towards shoulders and seat ends.  Errors then shrink by a nearly constant
factor from level to level, from which an error bar can be made; refining one alone runs into the
error that the other leaves (two levels that differ only in layers are one mesh on a shaft without
shoulders).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from solidgear.core.models.options import FACTORING_OPTIONS

if TYPE_CHECKING:
    pass

Options = dict[str, Any]


#: a usual mesh of the harmonic solid, good to some 1e-3: where no error bar is asked for
HARMONIC: Options = {"order": 3, "layers": 1, "edge_layers": 0, "relative_size": 4.0}
#: options that leave the choice of meshes to the program
FREE = ("element", "around", "ovalising", "attachments", "material_port", *FACTORING_OPTIONS)
#: error of the cells around a hexahedral mesh that bends as a whole: with this power of their size
ORDER_AROUND = 4
#: unknowns of the second level above which a third one, some three times as large, is solved only
#: if the error bar needs it
HEAVY = 15_000


@dataclass(frozen=True)
class Sequence:
    """Meshes of one solid, coarse to fine."""

    levels: tuple[Options, ...]  #: builder options of each
    #: all are solved, the last being the one that was asked for; otherwise the program refines until
    #: the error bar meets its target
    fixed: bool
    #: every level adds layers towards singular points (see :mod:`solidgear.core.judge.bars`)
    layered: bool
    turned: Options | None = None  #: coarsest level with another number of cells around

    @property
    def left_around(self) -> float:
        """Error of the cells around, as a multiple of the change from the coarsest level to the
        turned one.
        """
        if self.turned is None:
            return 0.0
        ratio = self.levels[0]["around"] / self.turned["around"]
        return 1 / (1 - ratio**ORDER_AROUND)


def fixed_refinements(options: Mapping[str, Any]) -> Sequence:
    """Return the mesh that was asked for, and two coarser ones by plain refinement."""
    refinement = options.get("refinement", 1.0)
    return Sequence(
        tuple({**options, "refinement": refinement * s} for s in (0.4, 0.65, 1.0)), True, False
    )


def levels(quick: tuple, more: tuple, full: bool) -> tuple:
    """Return the levels of a chart, quick or full."""
    return quick + more if full else quick
