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
    systems      rubin, craig_bampton, Superelement, System, grounded, mesh_spring, torsion_spring,
                 MeshVector, BearingSpring, RowSpring, RigidBody, Inertia, PortInertia, Placed
    planetary    PlanetaryTeeth, PlanetaryStage, CentralMember, Planet, carrier_turn, FixedSupport,
                 PlanetError, elastic_ring
    errors       SolidgearError, SceneError

Names are imported when first used, so that importing the package stays cheap.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

__version__ = "0.1.0"

_WHERE = {
    "load": "solidgear.studies.loading",
    "load_train": "solidgear.studies.loading",
    "Train": "solidgear.scene.train",
    "Scene": "solidgear.scene",
    "Segment": "solidgear.scene",
    "Bearing": "solidgear.scene",
    "PointMass": "solidgear.scene",
    "Port": "solidgear.scene",
    "Housing": "solidgear.scene",
    "Lubrication": "solidgear.scene",
    "Material": "solidgear.scene",
    "Ask": "solidgear.scene",
    "STEEL": "solidgear.scene",
    "Body": "solidgear.body",
    "Supports": "solidgear.body",
    "build": "solidgear.ladder",
    "Superelement": "solidgear.reduction.superelement",
    "rubin": "solidgear.reduction.rubin",
    "craig_bampton": "solidgear.reduction.craig_bampton",
    "System": "solidgear.system",
    "RigidBody": "solidgear.system",
    "Inertia": "solidgear.system",
    "Placed": "solidgear.system",
    "BearingSpring": "solidgear.system",
    "RowSpring": "solidgear.system",
    "PortInertia": "solidgear.system",
    "PlanetaryStage": "solidgear.system",
    "PlanetaryTeeth": "solidgear.system",
    "CentralMember": "solidgear.system",
    "FixedSupport": "solidgear.system",
    "PlanetError": "solidgear.system",
    "carrier_turn": "solidgear.system",
    "elastic_ring": "solidgear.studies.elastic_ring",
    "Planet": "solidgear.system",
    "MeshVector": "solidgear.system",
    "grounded": "solidgear.system",
    "mesh_spring": "solidgear.system",
    "torsion_spring": "solidgear.system",
    "condense": "solidgear.solve.statics",
    "modes": "solidgear.solve.modes",
    "answer": "solidgear.judge.answer",
    "budget": "solidgear.studies.budget",
    "compare": "solidgear.studies.comparison",
    "optimise": "solidgear.studies.optimise",
    "sweep": "solidgear.studies.sweep.file_sweep",
    "sensitivities": "solidgear.studies.sensitivity.run",
    "shaft_stress": "solidgear.studies.stress.shaft",
    "turn": "solidgear.report.viewer",
    "SolidgearError": "solidgear.errors",
    "SceneError": "solidgear.errors",
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
    "RigidBody",
    "RowSpring",
    "Scene",
    "SceneError",
    "Segment",
    "SolidgearError",
    "Superelement",
    "Supports",
    "System",
    "Train",
    "__version__",
    "answer",
    "budget",
    "build",
    "compare",
    "condense",
    "craig_bampton",
    "elastic_ring",
    "grounded",
    "load",
    "load_train",
    "mesh_spring",
    "modes",
    "optimise",
    "rubin",
    "sensitivities",
    "shaft_stress",
    "sweep",
    "torsion_spring",
    "turn",
]

if TYPE_CHECKING:
    from solidgear.body import Body, Supports
    from solidgear.errors import SceneError, SolidgearError
    from solidgear.judge.answer import answer
    from solidgear.ladder import build
    from solidgear.reduction.craig_bampton import craig_bampton
    from solidgear.reduction.rubin import rubin
    from solidgear.reduction.superelement import Superelement
    from solidgear.report.viewer import turn
    from solidgear.scene import (
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
    from solidgear.scene.train import Train
    from solidgear.solve.modes import modes
    from solidgear.solve.statics import condense
    from solidgear.studies.budget import budget
    from solidgear.studies.comparison import compare
    from solidgear.studies.elastic_ring import elastic_ring
    from solidgear.studies.loading import load, load_train
    from solidgear.studies.optimise import optimise
    from solidgear.studies.sensitivity.run import sensitivities
    from solidgear.studies.stress.shaft import shaft_stress
    from solidgear.studies.sweep.file_sweep import sweep
    from solidgear.system import (
        BearingSpring,
        CentralMember,
        FixedSupport,
        Inertia,
        MeshVector,
        Placed,
        Planet,
        PlanetaryStage,
        PlanetaryTeeth,
        PlanetError,
        PortInertia,
        RigidBody,
        RowSpring,
        System,
        carrier_turn,
        grounded,
        mesh_spring,
        torsion_spring,
    )


def __getattr__(name: str):
    if name not in _WHERE:
        from solidgear.errors import nearest  # start-up

        raise AttributeError(f"module 'solidgear' has no attribute {name!r}{nearest(name, _WHERE)}")
    value = getattr(importlib.import_module(_WHERE[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})
