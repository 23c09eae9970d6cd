"""Meshes that a solid is solved on, coarse to fine, until the error bar meets a target.

Every level refines at once all that limits accuracy: the order of the harmonic elements (or the size
of 3D ones) and the layers towards shoulders and seat ends; refining one alone runs into the error
that the other leaves.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from solidgear.core.models.options import FACTORING_OPTIONS

Options = dict[str, Any]


#: a usual mesh of the harmonic solid, good to some 1e-3: where no error bar is asked for
HARMONIC: Options = {"order": 3, "layers": 1, "edge_layers": 0, "relative_size": 4.0}
#: options that leave the choice of meshes to the program
FREE = ("element", "around", "ovalising", "attachments", "material_port", *FACTORING_OPTIONS)


@dataclass(frozen=True)
class Sequence:
    """Meshes of one solid, coarse to fine."""

    levels: tuple[Options, ...]  #: builder options of each
    fixed: bool  #: the one mesh that was asked for


def levels(quick: tuple, more: tuple, full: bool) -> tuple:
    """Return the levels of a chart, quick or full."""
    return quick + more if full else quick
