"""The cyclic sector, coarse to fine."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from solidgear.core.ladder.meshes import FREE, Sequence
from solidgear.core.ladder.model import Options, Series
from solidgear.core.ladder.solid import PER_TETRAHEDRON, Volume
from solidgear.core.models.kinds import CYCLIC
from solidgear.core.models.options import SECTOR_OPTIONS

if TYPE_CHECKING:
    from solidgear.core import Body
    from solidgear.core.models.size import Size
    from solidgear.core.scene.shaft import Shaft

#: one sector holds meshes that are finer than those of a whole shaft
SECTOR: tuple[dict[str, Any], ...] = tuple({"refinement": r} for r in (0.7, 1.0, 1.4, 2.0, 2.8))

#: unknowns of axial motion, torsion and bending in both planes, in those of half a sector
OF_A_HALF = 6


class Sector(Volume):
    """Elasticity of a part of equal sectors, from one of them."""

    name = "sector"
    title = "cyclic sector"
    heading = "sector"
    theory = "full 3D elasticity of a part of equal sectors, with its teeth"
    colour = "#c2185b"
    marker = "h"
    options = SECTOR_OPTIONS
    coarser = "lower refinement, or raise size and graded_size"
    holds = (CYCLIC,)
    for_features = True
    _nature = "one sector that repeats itself around the axis,"

    def builder(self) -> Callable[..., Body]:
        from solidgear.cuts.sector.body import sector

        return sector

    def _size(self, scene: Shaft, options: dict[str, Any]) -> Size:
        from solidgear.cuts.sector.body import sector_size

        return sector_size(scene, **self.split(options)[0])

    def rough_unknowns(self, scene: Shaft, options: Options) -> float:
        """Estimate the unknowns of all that is solved on half a sector."""
        from solidgear.cuts.sector.body import rough_sector

        full_options = self.defaults() | self.given(scene, options)
        sizes = {n: full_options[n] for n in ("size", "graded_size", "refinement", "count")}
        return (
            PER_TETRAHEDRON
            * OF_A_HALF
            * rough_sector(scene, self.wanted(scene, full_options), **sizes)
        )

    def can_halve(self, scene: Shaft, options: Options) -> bool:
        """Return True where the middle of a sector can lie in a mirror plane of all features."""
        from solidgear.cuts.sector.body import halved, sectors_around

        return halved(scene, sectors_around(scene, options))

    def meshes(self, options: Options) -> Sequence:
        """Return the mesh that was asked for, or meshes of plain refinement."""
        if set(options) - set(FREE):
            return Sequence((dict(options),), True)
        return Sequence(tuple({**level, **options} for level in SECTOR), False)

    def series(self, scene: Shaft, full: bool) -> list[Series]:
        """Return the meshes, for a scene with such features."""
        if not self.concerns(scene):
            return []
        return [("tetrahedra", self.title, [dict(x) for x in SECTOR[: 4 if full else 3]])]
