"""Meshes of the shafts of a train that follow the error bars of its first state at rest: harmonic ones as
for modes, and those of other solids along their lists, coarse to fine.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from solidgear.core import LADDER
from solidgear.core.bounds.refining import Meshed
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.mesh_errors import Need
from solidgear.trains.assembly.shaft import JUDGE, Level, ShaftModel


@dataclass(frozen=True)
class MeshesAtRest:
    """Meshes of the shafts of an assembly by some models."""

    assembly: Assembly
    models: Sequence[str]

    def begin(self) -> None:
        """Build solids that have a list of meshes on the coarsest of it; those that are built already
        stay as they are.
        """
        assembly = self.assembly
        for side, model in assembly.models_by_shaft(self.models).items():
            if model not in LADDER or assembly.is_built(side, model):
                continue
            if LADDER[model].bars_by and not LADDER[model].follows:
                scene, options = (
                    assembly.meshed_scene(side, model),
                    assembly.options_of(side, model),
                )
                plan = LADDER[model].meshes_of(scene, options)
                if not plan.fixed:
                    assembly.set_mesh(side, model, Level(plan.levels))

    @property
    def following(self) -> dict[str, str]:
        """Models of the shafts whose meshes follow, by shaft."""
        solved = self.assembly.solved_models(self.models)
        return {
            side: model
            for side, model in solved.items()
            if self.assembly.is_built(side, model)
            and self.assembly.shaft_model(side, model).mesh is not None
        }

    @property
    def tolerance(self) -> float:
        """Relative error that these meshes may leave."""
        return min(map(self.assembly.tolerance_of, self.following.values()))

    def to_be_chosen(self) -> bool:
        """Return True once for every shaft whose mesh follows: the first state at rest decides."""
        sides = {*self.following}
        if sides <= self.assembly.chosen_at_rest:
            return False
        self.assembly.chosen_at_rest |= sides
        return True

    def finer(self, needs: Mapping[str, Need]) -> dict[str, Meshed | Level]:
        """Return the next meshes of the shafts that need finer ones and follow."""
        following = self.following
        harmonic = {side: need for side, need in needs.items() if following.get(side) == JUDGE}
        finer: dict[str, Meshed | Level] = dict(self.assembly.finer_meshes(harmonic))
        for side in needs.keys() & following.keys():
            mesh = self.assembly.shaft_model(side, following[side]).mesh
            if isinstance(mesh, Level) and mesh.finer is not None:
                finer[side] = mesh.finer
        return finer

    def shafts(self, sides: Iterable[str]) -> list[ShaftModel]:
        """Return shafts whose meshes follow, as they are."""
        following = self.following
        return [self.assembly.shaft_model(side, following[side]) for side in sides]

    def refine(self, meshes: Mapping[str, Meshed | Level]) -> None:
        """Build and reduce shafts on other meshes."""
        following = self.following
        for side, mesh in meshes.items():
            self.assembly.set_mesh(side, following[side], mesh)
