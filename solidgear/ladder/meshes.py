"""Which meshes a solid is solved on, coarse to fine, until its band meets a target.

Every level raises all that limits it at once: the order of the harmonic elements (or the size of 3D
ones) and the layers towards shoulders and seat ends.  Errors then shrink by a nearly constant
factor from level to level, which is what a band can be made of; raising one alone runs into what
the other leaves (two levels that differ only in layers are one mesh on a shaft without shoulders).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from solidgear.models.options import FACTORING_OPTIONS

Options = dict[str, Any]


def _harmonic(order: int, layers: int, edge_layers: int, relative_size: float) -> Options:
    return {
        "order": order,
        "layers": layers,
        "edge_layers": edge_layers,
        "relative_size": relative_size,
    }


def _hexahedra(layers: int, edge_layers: int, relative_size: float) -> Options:
    return {
        "layers": layers,
        "radial_layers": layers,
        "edge_layers": edge_layers,
        "relative_size": relative_size,
    }


#: a usual mesh of the harmonic solid, good to some 1e-3: where no bar is asked for
HARMONIC: Options = _harmonic(3, 1, 0, 4.0)
HEXAHEDRA: tuple[Options, ...] = (
    _hexahedra(0, 0, 1.5),
    _hexahedra(1, 1, 1.0),
    _hexahedra(2, 2, 0.7),
    _hexahedra(3, 3, 0.5),
    _hexahedra(4, 4, 0.35),
)
TETRAHEDRA: tuple[Options, ...] = tuple({"refinement": r} for r in (0.45, 0.65, 0.95, 1.4, 2.0))
LINEAR: tuple[Options, ...] = tuple({"refinement": r} for r in (0.6, 0.9, 1.35, 2.0))

# What leaves the choice of meshes to the program although it is given.
FREE = ("element", "around", "ovalising", "attachments", "material_port", *FACTORING_OPTIONS)
#: cells around of hexahedra that bend as a whole: eight are good to some 6e-4, and the error falls
#: with the fourth power
AROUND, ORDER_AROUND = 8, 4
#: unknowns of the second level above which a third one, some three times as large, is solved only
#: if the band needs it
HEAVY = 15_000


@dataclass(frozen=True)
class Sequence:
    """Meshes of one solid, coarse to fine.

    Attributes
    ----------
    levels : tuple of dict
        Builder options of each.
    fixed : bool
        All are solved, the last being the one that was asked for; otherwise the program climbs
        until a band is met.
    layered : bool
        Whether every level adds layers towards singular points (see
        :mod:`solidgear.judge.bars`).
    turned : dict or None
        The coarsest level with half as many cells around again: what they leave is measured there,
        where it is cheap.
    """

    levels: tuple[Options, ...]
    fixed: bool
    layered: bool
    turned: Options | None = None

    @property
    def left_around(self) -> float:
        """Error of the cells around, as a multiple of the change from the coarsest level to the
        turned one.
        """
        if self.turned is None:
            return 0.0
        ratio = self.levels[0]["around"] / self.turned["around"]
        return 1 / (1 - ratio**ORDER_AROUND)


#: free modes kept on the coarsest mesh, whose supported modes err by more than those left out give
FEWER = 10
#: defect correction: the harmonic solid and the 3D mesh finer together
CORRECTED: tuple[Options, ...] = (
    {"order": 3, "layers": 1, "edge_layers": 1, "refinement": 0.35, "modes": FEWER},
    *(
        {"order": order, "layers": layers, "edge_layers": edges, "refinement": refinement}
        for order, layers, edges, refinement in (
            (4, 2, 2, 0.5),
            (5, 3, 2, 0.7),
            (6, 4, 3, 1.0),
        )
    ),
)


def corrected_meshes(options: Mapping[str, Any]) -> Sequence:
    """Meshes on which to correct a harmonic solid; options as for :func:`harmonic_meshes`."""
    if set(options) - set(FREE):
        finest = {**CORRECTED[1], **options}
        coarser = {**finest, "refinement": finest["refinement"] / 1.4}
        return Sequence((coarser, finest), True, True)
    return Sequence(tuple({**level, **options} for level in CORRECTED), False, True)


#: one sector holds meshes that are finer than those of a whole shaft
SECTOR: tuple[Options, ...] = tuple({"refinement": r} for r in (0.7, 1.0, 1.4, 2.0, 2.8))


def sector_meshes(options: Mapping[str, Any]) -> Sequence:
    """Meshes of a cyclic sector; options as for :func:`harmonic_meshes`."""
    if set(options) - set(FREE):
        return _refinements(dict(options))
    return Sequence(tuple({**level, **options} for level in SECTOR), False, False)


def _turned(level: Options) -> Options:
    return {**level, "around": 4 * -(-3 * level["around"] // 8)}


def harmonic_meshes(options: Mapping[str, Any]) -> Sequence:
    """Meshes on which to solve a harmonic solid: the one that was asked for, or those that follow its
    bars (:mod:`solidgear.bounds.refining`).

    Parameters
    ----------
    options : mapping
        Builder options that were asked for.
    """
    if set(options) - set(FREE):
        return Sequence((dict(options),), True, False)
    return Sequence((dict(options),), False, False)


def solid_meshes(options: Mapping[str, Any]) -> Sequence:
    """Meshes on which to solve a 3D solid; options as for :func:`harmonic_meshes`."""
    element = str(options.get("element", "hex20"))
    layered = element in ("hex20", "hex27")
    if set(options) - set(FREE):
        if layered and "refinement" not in options:
            return _below_hexahedra(dict(options))
        return _refinements(dict(options))
    if layered:
        around = {"around": AROUND, **options}
        levels = tuple({**level, **around} for level in HEXAHEDRA)
        return Sequence(levels, False, True, _turned(levels[0]))
    known = TETRAHEDRA if element == "tet10" else LINEAR
    return Sequence(tuple({**level, **options} for level in known), False, False)


def _below_hexahedra(options: Options) -> Sequence:
    finest = {
        "layers": 4,
        "radial_layers": 4,
        "edge_layers": 1,
        "relative_size": 0.4,
        "around": 12,
        **options,
    }
    coarser = []
    for k in (2, 1):
        fewer = {
            name: max(finest[name] - k, 0) for name in ("layers", "radial_layers", "edge_layers")
        }
        larger = {"relative_size": finest["relative_size"] * 1.5**k}
        if finest.get("size"):
            larger = {"size": finest["size"] * 1.5**k}
        coarser.append({**finest, **fewer, **larger})
    return Sequence((*coarser, finest), True, True, _turned(coarser[0]))


def _refinements(options: Options) -> Sequence:
    given = options.get("refinement", 1.0)
    return Sequence(
        tuple({**options, "refinement": given * s} for s in (0.4, 0.65, 1.0)), True, False
    )
