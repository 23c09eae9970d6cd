"""The shafts of a sweep of trains, each meshed and reduced once for all variants that share it."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Hashable, Mapping
from typing import Any

from solidgear.core.scene import Scene
from solidgear.trains.assembly.models import Workshop
from solidgear.trains.assembly.shaft import ShaftModel, checked_model
from solidgear.trains.file.train import Train
from solidgear.trains.load.operation import Operating

#: unknowns of the bodies that are kept, about 1 kB each
UNKNOWNS = 300_000
#: trains at rest that are kept: one by the model that bearings settle on, one by those asked for
TRAINS = 2


class Bench:
    """Models of shafts and trains at rest, kept from variant to variant.

    Parameters
    ----------
    settings : mapping
        As of :class:`solidgear.trains.assembly.models.Workshop`.

    Attributes
    ----------
    made : int
        Shafts that were meshed and reduced.
    """

    def __init__(self, reduction: str, kept: int, settings: Mapping[Any, Mapping]):
        self._how = reduction, kept, settings
        self._models: OrderedDict[Hashable, ShaftModel] = OrderedDict()
        self._trains: OrderedDict[Hashable, Operating] = OrderedDict()
        self.made = 0

    def workshop(self, train: Train, *models: str) -> Workshop:
        """Workshop of a train that has the bodies of its shafts by these models."""
        shop = Workshop(train, *self._how)
        for side, model in shop.models_by_shaft(models).items():
            kind, base = checked_model(model)
            shop.add_model(self._shaft(shop, side, base or kind))
        return shop

    def operating(self, key: Hashable, train: Train, *models: str) -> Operating:
        """A train to be put at rest, its shafts by these models; the key is alike for trains that
        differ in operating points alone.
        """

        key = key, *models
        if key not in self._trains:
            if len(self._trains) >= TRAINS:
                self._trains.popitem(last=False)
            self._trains[key] = Operating(self.workshop(train, *models), *models)
        self._trains.move_to_end(key)
        return self._trains[key].with_points(train)

    def _shaft(self, shop: Workshop, side: str, model: str) -> ShaftModel:
        key = side, model, surface(shop.scenes[side])
        if key not in self._models:
            self._make_room(side, model)
            self.made += 1
            found = shop.shaft_model(side, model)
            found.body.cache.clear()  # its factors, which nothing asks for again
            self._models[key] = found
        self._models.move_to_end(key)
        return self._models[key]

    def _make_room(self, side: str, model: str) -> None:
        """Let go of what was asked for longest ago, for another like the last of its kind."""
        like = [m.unknowns for m in self._models.values() if (m.side, m.model) == (side, model)]
        sizes = [one.unknowns for one in self._models.values()]
        while sizes and sum(sizes) + sum(like[-1:]) > UNKNOWNS:
            self._models.popitem(last=False)
            sizes.pop(0)


def surface(scene: Scene) -> Hashable:
    """All that a body is made of: the shaft, and the places that it is held and loaded at."""
    stations = (
        (type(s), s.name, s.y, s.lo, s.hi, s.attachment, getattr(s, "face", None))
        for s in scene.stations
    )
    return scene.segments, scene.features, scene.body, scene.blends, tuple(stations)
