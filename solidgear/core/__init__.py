"""The core: one shaft from its file to numbers with error bars, and systems of parts and links.

Rooms of features import these names from here; all that a single feature needs of the core it
imports from the module that has it.  Names are imported when they are first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from solidgear.core.body import Block, Body, Supports, as_supports
    from solidgear.core.body.mode_names import ModeName
    from solidgear.core.body.surface import Surface
    from solidgear.core.display import Sheeted
    from solidgear.core.elements import ELEMENTS
    from solidgear.core.errors import SceneError, SolidgearError, listed, near, nearest, show
    from solidgear.core.frames import DOF_NAMES, rotation
    from solidgear.core.judge.answer import read_tolerance
    from solidgear.core.judge.cautions import number_cautions
    from solidgear.core.judge.change import BarredMode
    from solidgear.core.judge.deviations import WITHIN, gap_verdict
    from solidgear.core.judge.open_numbers import OpenNumbers
    from solidgear.core.judge.quantities import change, size
    from solidgear.core.judge.record import Record
    from solidgear.core.judge.settle import Settled, bars_of_modes, settle
    from solidgear.core.judge.solution import Solution
    from solidgear.core.ladder import build
    from solidgear.core.ladder.meshes import HARMONIC
    from solidgear.core.ladder.model import BEAM
    from solidgear.core.ladder.registry import LADDER
    from solidgear.core.loading import explained, load
    from solidgear.core.machine.environment import environment
    from solidgear.core.machine.threads import pinned
    from solidgear.core.machine.whole_file import whole
    from solidgear.core.named import ByName
    from solidgear.core.quantity import (
        COMPLIANCE,
        QUANTITIES,
        STIFFNESS,
        Quantity,
    )
    from solidgear.core.reduction.effective_mass import synthesise
    from solidgear.core.reduction.rubin import rubin
    from solidgear.core.registry import addition
    from solidgear.core.scene import Bearing, Port, Scene
    from solidgear.core.scene.coned import coned
    from solidgear.core.scene.document import (
        Document,
        Source,
        document_of,
        is_train,
        name_of_source,
    )
    from solidgear.core.scene.limits import TOUCH
    from solidgear.core.scene.load_rules import named_case
    from solidgear.core.scene.outline import Outline
    from solidgear.core.scene.shaft import without_axis
    from solidgear.core.scene.typed import Model
    from solidgear.core.scene.units import DIMENSIONS, Length, PositiveLength, SignedAngle
    from solidgear.core.scene.written import Range, Written
    from solidgear.core.solve.modes import Mode, ModeSet, modes
    from solidgear.core.solve.statics import flexibility
    from solidgear.core.system.system import System

__all__ = [
    "addition",
    "Written",
    "Range",
    "BEAM",
    "BarredMode",
    "Bearing",
    "Block",
    "Body",
    "ByName",
    "COMPLIANCE",
    "named_case",
    "DIMENSIONS",
    "DOF_NAMES",
    "Document",
    "ELEMENTS",
    "HARMONIC",
    "LADDER",
    "Length",
    "Mode",
    "ModeName",
    "ModeSet",
    "Model",
    "OpenNumbers",
    "Outline",
    "Port",
    "PositiveLength",
    "QUANTITIES",
    "Quantity",
    "Record",
    "STIFFNESS",
    "Scene",
    "SceneError",
    "Settled",
    "Sheeted",
    "SignedAngle",
    "SolidgearError",
    "Solution",
    "Source",
    "Supports",
    "Surface",
    "System",
    "TOUCH",
    "WITHIN",
    "environment",
    "as_supports",
    "bars_of_modes",
    "build",
    "change",
    "coned",
    "document_of",
    "explained",
    "flexibility",
    "gap_verdict",
    "is_train",
    "listed",
    "load",
    "modes",
    "name_of_source",
    "near",
    "nearest",
    "number_cautions",
    "pinned",
    "read_tolerance",
    "rotation",
    "rubin",
    "settle",
    "show",
    "size",
    "synthesise",
    "whole",
    "without_axis",
]

#: module of each name
_WHERE = {
    "Block": "solidgear.core.body",
    "Body": "solidgear.core.body",
    "Supports": "solidgear.core.body",
    "as_supports": "solidgear.core.body",
    "ModeName": "solidgear.core.body.mode_names",
    "Surface": "solidgear.core.body.surface",
    "Sheeted": "solidgear.core.display",
    "ELEMENTS": "solidgear.core.elements",
    "SceneError": "solidgear.core.errors",
    "SolidgearError": "solidgear.core.errors",
    "listed": "solidgear.core.errors",
    "near": "solidgear.core.errors",
    "nearest": "solidgear.core.errors",
    "show": "solidgear.core.errors",
    "DOF_NAMES": "solidgear.core.frames",
    "rotation": "solidgear.core.frames",
    "WITHIN": "solidgear.core.judge.deviations",
    "gap_verdict": "solidgear.core.judge.deviations",
    "read_tolerance": "solidgear.core.judge.answer",
    "number_cautions": "solidgear.core.judge.cautions",
    "BarredMode": "solidgear.core.judge.change",
    "OpenNumbers": "solidgear.core.judge.open_numbers",
    "change": "solidgear.core.judge.quantities",
    "size": "solidgear.core.judge.quantities",
    "Record": "solidgear.core.judge.record",
    "Settled": "solidgear.core.judge.settle",
    "bars_of_modes": "solidgear.core.judge.settle",
    "settle": "solidgear.core.judge.settle",
    "Solution": "solidgear.core.judge.solution",
    "build": "solidgear.core.ladder",
    "HARMONIC": "solidgear.core.ladder.meshes",
    "BEAM": "solidgear.core.ladder.model",
    "LADDER": "solidgear.core.ladder.registry",
    "explained": "solidgear.core.loading",
    "load": "solidgear.core.loading",
    "environment": "solidgear.core.machine.environment",
    "pinned": "solidgear.core.machine.threads",
    "whole": "solidgear.core.machine.whole_file",
    "ByName": "solidgear.core.named",
    "COMPLIANCE": "solidgear.core.quantity",
    "QUANTITIES": "solidgear.core.quantity",
    "Quantity": "solidgear.core.quantity",
    "STIFFNESS": "solidgear.core.quantity",
    "addition": "solidgear.core.registry",
    "synthesise": "solidgear.core.reduction.effective_mass",
    "rubin": "solidgear.core.reduction.rubin",
    "Bearing": "solidgear.core.scene",
    "Port": "solidgear.core.scene",
    "Scene": "solidgear.core.scene",
    "coned": "solidgear.core.scene.coned",
    "Outline": "solidgear.core.scene.outline",
    "TOUCH": "solidgear.core.scene.limits",
    "without_axis": "solidgear.core.scene.shaft",
    "Document": "solidgear.core.scene.document",
    "Source": "solidgear.core.scene.document",
    "document_of": "solidgear.core.scene.document",
    "is_train": "solidgear.core.scene.document",
    "name_of_source": "solidgear.core.scene.document",
    "Model": "solidgear.core.scene.typed",
    "DIMENSIONS": "solidgear.core.scene.units",
    "Length": "solidgear.core.scene.units",
    "PositiveLength": "solidgear.core.scene.units",
    "SignedAngle": "solidgear.core.scene.units",
    "Range": "solidgear.core.scene.written",
    "Written": "solidgear.core.scene.written",
    "named_case": "solidgear.core.scene.load_rules",
    "Mode": "solidgear.core.solve.modes",
    "ModeSet": "solidgear.core.solve.modes",
    "modes": "solidgear.core.solve.modes",
    "flexibility": "solidgear.core.solve.statics",
    "System": "solidgear.core.system.system",
}


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module 'solidgear.core' has no attribute {name!r}")
    value = getattr(importlib.import_module(_WHERE[name]), name)
    globals()[name] = value
    return value
