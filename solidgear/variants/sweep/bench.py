"""Shafts of a sweep of trains, each meshed and reduced once for all variants that share it."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Hashable, Mapping
from dataclasses import replace
from typing import Any

from solidgear.core import Scene
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.shaft import ShaftModel, checked_model
from solidgear.trains.file.train import Train
from solidgear.trains.load.operation import Operating

#: unknowns of the bodies that are kept, about 1 kB each
UNKNOWNS = 300_000
#: trains at rest that are kept
TRAINS = 1


class Bench:
    """Models of shafts and trains at rest, kept from variant to variant; parameters as of an assembly."""

    def __init__(
        self,
        reduction: str,
        kept: int,
        settings: Mapping[Any, Mapping],
        tol: float | str | None = None,
        highest_hz: float | None = None,
    ):
        self._parameters = reduction, kept, settings, tol, highest_hz
        self._models: OrderedDict[Hashable, ShaftModel] = OrderedDict()
        self._trains: OrderedDict[Hashable, Operating] = OrderedDict()
        self.made = 0  #: shafts that were meshed and reduced

    def assembly(self, train: Train, *models: str) -> Assembly:
        """Return an assembly of a train with the bodies of all shafts by these models."""
        assembly = Assembly(train, *self._parameters)
        for side, model in assembly.models_by_shaft(models).items():
            kind, base = checked_model(model)
            assembly.add_model(self._shaft(assembly, side, base or kind))
        return assembly

    def operating(self, key: Hashable, train: Train, *models: str) -> Operating:
        """Return a train to be put at rest, with shafts by these models; the key is the same for
        trains that differ in operating points alone.
        """
        key = key, *models
        if key not in self._trains:
            if len(self._trains) >= TRAINS:
                self._trains.popitem(last=False)
            self._trains[key] = Operating(self.assembly(train, *models), *models)
        self._trains.move_to_end(key)
        return self._trains[key].with_points(train)

    def _shaft(self, assembly: Assembly, side: str, model: str) -> ShaftModel:
        key = side, model, surface(assembly.scenes[side])
        if key not in self._models:
            self._make_room(side, model)
            self.made += 1
            # no variant decides the mesh of others, whatever comes first
            shaft = replace(assembly.follow_alone(side, model), mesh=None)
            shaft.body.cache.clear()  # factors, which nothing asks for again
            self._models[key] = shaft
        self._models.move_to_end(key)
        return self._models[key]

    def _make_room(self, side: str, model: str) -> None:
        """Drop the shafts used longest ago, for another as large as the last of this side and model."""
        shafts = self._models.values()
        expected = [m.unknowns for m in shafts if (m.side, m.model) == (side, model)][-1:]
        sizes = [shaft.unknowns for shaft in shafts]
        while sizes and sum(sizes) + sum(expected) > UNKNOWNS:
            self._models.popitem(last=False)
            sizes.pop(0)


def surface(scene: Scene) -> Hashable:
    """Return all that a body is made of: the shaft, and the places at which it is held and loaded."""
    stations = (
        (type(s), s.name, s.y, s.lo, s.hi, s.attachment, getattr(s, "face", None))
        for s in scene.stations
    )
    return scene.segments, scene.features, scene.body, scene.blends, tuple(stations)
