"""solidgear: shafts on their bearings, alone or two in mesh, by many models, and the evidence for
which to trust.

    import solidgear as sg
    scene = sg.load("geometry/pinion_overhung.toml")
    body = sg.build(scene, "harmonic")
    sg.condense(body, scene, port="pinion").stiffness
    sg.modes(body, scene, n=10).frequency_hz
    sg.answer(scene, tol="1%", ask="f1")
    sg.compare(scene).write_report("out")

Models that `build` makes, cheapest first: euler, timoshenko, harmonic, corrected, sector, solid;
`compare` judges lumped models beside them.

What there is, each with an example in its help:

    scenes       load, Scene, Segment, Bearing, Port, PointMass, Housing, Lubrication, Material,
                 STEEL, Ask
    questions    answer, compare, condense, modes, shaft_stress, turn
    studies      sweep, sensitivities, optimise, budget
    bodies       build, Body, Supports
    trains       load_train, Train
    teeth        teeth_study, TeethStudy, TeethModel, Wheel, WheelPair, Rack
    systems      rubin, craig_bampton, Superelement, System, grounded, mesh_spring, torsion_spring,
                 MeshVector, BearingSpring, RowSpring, RigidBody, Inertia, PortInertia, Placed
    planetary    PlanetaryTeeth, PlanetaryStage, CentralMember, Planet, carrier_turn, FixedSupport,
                 PlanetError, elastic_ring
    exchange     export, port_matrices, read_matrices, PortMatrices
    errors       SolidgearError, SceneError

Names are imported when first used, so that importing the package stays cheap.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

import solidgear.rooms  # noqa: F401  # what features add to the core
from solidgear.core.machine.version import VERSION

__version__ = VERSION

_WHERE = {
    "load": "solidgear.core.loading",
    "load_train": "solidgear.trains.loading",
    "Train": "solidgear.trains.file.train",
    "Scene": "solidgear.core.scene",
    "Segment": "solidgear.core.scene",
    "Bearing": "solidgear.core.scene",
    "PointMass": "solidgear.core.scene",
    "Port": "solidgear.core.scene",
    "Housing": "solidgear.core.scene",
    "Lubrication": "solidgear.core.scene",
    "Material": "solidgear.core.scene",
    "Ask": "solidgear.core.scene",
    "STEEL": "solidgear.core.scene",
    "Body": "solidgear.core.body",
    "Supports": "solidgear.core.body",
    "build": "solidgear.core.ladder",
    "Superelement": "solidgear.core.reduction.superelement",
    "rubin": "solidgear.core.reduction.rubin",
    "craig_bampton": "solidgear.core.reduction.craig_bampton",
    "System": "solidgear.core.system",
    "RigidBody": "solidgear.core.system",
    "Inertia": "solidgear.core.system",
    "Placed": "solidgear.core.system",
    "BearingSpring": "solidgear.core.system",
    "RowSpring": "solidgear.core.system",
    "PortInertia": "solidgear.core.system",
    "PlanetaryStage": "solidgear.trains.system.planetary",
    "PlanetaryTeeth": "solidgear.core.system",
    "CentralMember": "solidgear.trains.system.planetary_members",
    "FixedSupport": "solidgear.trains.system.carrier_turn",
    "PlanetError": "solidgear.trains.system.carrier_turn",
    "carrier_turn": "solidgear.trains.system.carrier_turn",
    "elastic_ring": "solidgear.bearings.elastic_ring",
    "Planet": "solidgear.trains.system.planetary_members",
    "MeshVector": "solidgear.core.system",
    "grounded": "solidgear.core.system",
    "mesh_spring": "solidgear.core.system",
    "torsion_spring": "solidgear.core.system",
    "PortMatrices": "solidgear.core.reduction.port_matrices",
    "export": "solidgear.exchange.matrices.export",
    "port_matrices": "solidgear.exchange.matrices.source",
    "read_matrices": "solidgear.exchange.matrices.formats",
    "condense": "solidgear.core.solve.statics",
    "modes": "solidgear.core.solve.modes",
    "answer": "solidgear.core.judge.answer",
    "budget": "solidgear.variants.budget.budget",
    "compare": "solidgear.comparison.models",
    "optimise": "solidgear.variants.optimise.optimise",
    "sweep": "solidgear.variants.sweep.file_sweep",
    "sensitivities": "solidgear.variants.sensitivity.run",
    "shaft_stress": "solidgear.strength.stress.shaft",
    "teeth_study": "solidgear.teeth.study",
    "TeethStudy": "solidgear.teeth.study",
    "TeethModel": "solidgear.teeth.train_teeth",
    "Rack": "solidgear.core.gears.wheel",
    "Wheel": "solidgear.core.gears.wheel",
    "WheelPair": "solidgear.core.gears.wheel_pair",
    "turn": "solidgear.show.viewer",
    "SolidgearError": "solidgear.core.errors",
    "SceneError": "solidgear.core.errors",
}
__all__ = [
    "STEEL",
    "Ask",
    "Bearing",
    "BearingSpring",
    "Body",
    "CentralMember",
    "FixedSupport",
    "PlanetError",
    "PlanetaryTeeth",
    "carrier_turn",
    "Housing",
    "Lubrication",
    "Inertia",
    "Material",
    "MeshVector",
    "Placed",
    "Planet",
    "PlanetaryStage",
    "PointMass",
    "Port",
    "PortInertia",
    "PortMatrices",
    "Rack",
    "RigidBody",
    "RowSpring",
    "Scene",
    "SceneError",
    "Segment",
    "SolidgearError",
    "Superelement",
    "Supports",
    "System",
    "TeethModel",
    "TeethStudy",
    "Train",
    "Wheel",
    "WheelPair",
    "__version__",
    "answer",
    "budget",
    "build",
    "compare",
    "condense",
    "craig_bampton",
    "elastic_ring",
    "export",
    "grounded",
    "load",
    "load_train",
    "mesh_spring",
    "modes",
    "optimise",
    "port_matrices",
    "read_matrices",
    "rubin",
    "sensitivities",
    "shaft_stress",
    "sweep",
    "teeth_study",
    "torsion_spring",
    "turn",
]

if TYPE_CHECKING:
    from solidgear.bearings.elastic_ring import elastic_ring
    from solidgear.comparison.models import compare
    from solidgear.core.body import Body, Supports
    from solidgear.core.errors import SceneError, SolidgearError
    from solidgear.core.gears.wheel import Rack, Wheel
    from solidgear.core.gears.wheel_pair import WheelPair
    from solidgear.core.judge.answer import answer
    from solidgear.core.ladder import build
    from solidgear.core.loading import load
    from solidgear.core.reduction.craig_bampton import craig_bampton
    from solidgear.core.reduction.port_matrices import PortMatrices
    from solidgear.core.reduction.rubin import rubin
    from solidgear.core.reduction.superelement import Superelement
    from solidgear.core.scene import (
        STEEL,
        Ask,
        Bearing,
        Housing,
        Lubrication,
        Material,
        PointMass,
        Port,
        Scene,
        Segment,
    )
    from solidgear.core.solve.modes import modes
    from solidgear.core.solve.statics import condense
    from solidgear.core.system import (
        BearingSpring,
        Inertia,
        MeshVector,
        Placed,
        PlanetaryTeeth,
        PortInertia,
        RigidBody,
        RowSpring,
        System,
        grounded,
        mesh_spring,
        torsion_spring,
    )
    from solidgear.exchange.matrices.export import export
    from solidgear.exchange.matrices.formats import read_matrices
    from solidgear.exchange.matrices.source import port_matrices
    from solidgear.show.viewer import turn
    from solidgear.strength.stress.shaft import shaft_stress
    from solidgear.teeth.study import TeethStudy, teeth_study
    from solidgear.teeth.train_teeth import TeethModel
    from solidgear.trains.file.train import Train
    from solidgear.trains.loading import load_train
    from solidgear.trains.system import carrier_turn
    from solidgear.trains.system.carrier_turn import FixedSupport, PlanetError
    from solidgear.trains.system.planetary import PlanetaryStage
    from solidgear.trains.system.planetary_members import CentralMember, Planet
    from solidgear.variants.budget.budget import budget
    from solidgear.variants.optimise.optimise import optimise
    from solidgear.variants.sensitivity.run import sensitivities
    from solidgear.variants.sweep.file_sweep import sweep


class _NoSuch(AttributeError):
    """Error of a missing name; the hint is searched only when the error is printed."""

    def __str__(self) -> str:
        from solidgear.core.errors import nearest  # start-up: for this alone

        (name,) = self.args
        return f"module 'solidgear' has no attribute {name!r}{nearest(name, _WHERE)}"


def __getattr__(name: str):
    if name not in _WHERE:
        raise _NoSuch(name)
    value = getattr(importlib.import_module(_WHERE[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})
