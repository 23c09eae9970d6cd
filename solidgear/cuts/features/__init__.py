"""Features of a shaft that are not of revolution: one file for each kind, with data and rules.

A cut into a cylinder is a class of :class:`~solidgear.cuts.features.cut.Cut`, or of ``Long`` where it
has a plane floor: fields with its ``kind``, rules (``_sized``), ``tool``, ``volume``, ``edges`` and
``distance``.  Files, models that hold it, meshes, sizes, the sketch and error bars ask the class.
What no model holds and ratings of strength read is a class of
:class:`~solidgear.cuts.features.detail.Detail`.
"""

from __future__ import annotations

from typing import TypeAlias

import solidgear.core.scene  # noqa: F401  # first, for a scene reads the features of this room
from solidgear.cuts.features.bolt_circle import BoltCircle
from solidgear.cuts.features.cross_hole import CrossHole
from solidgear.cuts.features.flat import Flat
from solidgear.cuts.features.grooves import RingGroove, RoundGroove, VGroove
from solidgear.cuts.features.keyway import Keyway
from solidgear.cuts.features.press_fit import PressFit
from solidgear.cuts.features.relief import Relief
from solidgear.cuts.features.thread import Thread
from solidgear.cuts.features.toothed import Spline, Teeth

Detail: TypeAlias = RingGroove | RoundGroove | VGroove | Relief | Thread | PressFit
Feature: TypeAlias = Keyway | Flat | CrossHole | Teeth | Spline | BoltCircle | Detail
