"""The shafts of a sweep of trains, each meshed and reduced once for all variants that share it."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable, Mapping
from typing import Any, TypeVar

from solidgear.scene import Scene
from solidgear.scene.train import SIDES, Train
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.operation import Operating
from solidgear.studies.train.shaft import ShaftModel, checked_rung

T = TypeVar("T")
#: models of shafts that are kept, and trains at rest; a harmonic solid holds some 50 MB
MODELS, TRAINS = 12, 4


class Bench:
    """Models of shafts and trains at rest, kept from variant to variant.

    Parameters
    ----------
    reduction : str
    kept : int
    settings : mapping
        As of :class:`solidgear.studies.train.models.Workshop`.

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

    def workshop(self, train: Train, pinion: str, gear: str) -> Workshop:
        """Workshop of a train that has the bodies of its shafts by two models."""
        shop = Workshop(train, *self._how)
        for side, model in zip(SIDES, (pinion, gear)):
            kind, base = checked_rung(model)
            shop.keep(self._shaft(shop, side, base or kind))
        return shop

    def operating(self, key: Hashable, train: Train, pinion: str, gear: str) -> Operating:
        """A train to be put at rest, its shafts by two models; the key is alike for trains that
        differ in operating points alone.
        """

        def make() -> Operating:
            return Operating(self.workshop(train, pinion, gear), pinion, gear)

        found = _recalled(self._trains, (key, pinion, gear), TRAINS, make)
        return found.with_points(train)

    def _shaft(self, shop: Workshop, side: str, model: str) -> ShaftModel:
        def make() -> ShaftModel:
            self.made += 1
            found = shop.shaft(side, model)
            found.body.cache.clear()  # its factors, which nothing asks for again
            return found

        return _recalled(self._models, (side, model, surface(shop.scenes[side])), MODELS, make)


def surface(scene: Scene) -> Hashable:
    """All that a body is made of: the shaft, and the places that it is held and loaded at."""
    stations = (
        (type(s), s.name, s.y, s.lo, s.hi, s.attachment, getattr(s, "face", None))
        for s in scene.stations
    )
    return scene.segments, scene.features, scene.body, scene.blends, tuple(stations)


def _recalled(kept: OrderedDict[Hashable, T], key: Hashable, most: int, make: Callable[[], T]) -> T:
    """The thing of a key, made where it is not kept; the one that was asked for longest ago goes."""
    if key not in kept:
        while len(kept) >= most:
            kept.popitem(last=False)
        kept[key] = make()
    kept.move_to_end(key)
    return kept[key]
