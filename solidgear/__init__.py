"""solidgear: shafts on their bearings, alone or two in mesh, by many models, and the evidence for
which to trust.

    import solidgear as sg
    scene = sg.load("geometry/pinion_overhung.toml")
    body = sg.build(scene, "harmonic")
    sg.condense(body, scene, port="pinion").stiffness
    sg.modes(body, scene, n=10).frequency_hz
    sg.answer(scene, tol="1%", ask="f1")
    sg.compare(scene).write_report("out")
    sg.sweep(scene, "segment.head.length=50 mm:60 mm:3").to_dataframe()
    sg.system_modes("geometry/axle_overhung.toml").write("modes")

Models that `build` makes, cheapest first: euler, timoshenko, harmonic, corrected, sector, solid;
`compare` judges lumped models beside them.

What there is, each with an example in its help:

    scenes       load, Scene, Segment, Bearing, Port, PointMass, ShaftLoad, LoadCase, Housing,
                 Lubrication, Material, STEEL, Ask
    questions    answer, compare, stiffness, modes, condense, check, bearing, deflect, stress, sheet, turn
    studies      sweep, sensitivities, optimise, budget
    measured     correlate, identify, overlay, load_measured, Measured, Responses, SurfacePoints
    bodies       build, solid_body, Body, Supports
    trains       load_train, Train, system_modes, response, receptance, judge, nonlinear
    teeth        contact, pair_contact, TeethStudy, TeethModel, Wheel, WheelPair, Rack
    systems      rubin, craig_bampton, synthesise, line_of_action, mesh_point, to_gear_frame,
                 Superelement, System, grounded, mesh_spring, torsion_spring,
                 MeshVector, BearingSpring, RowSpring, RigidBody, Inertia, PortInertia, Placed
    planetary    PlanetaryTeeth, PlanetaryStage, CentralMember, Planet, carrier_turn, FixedSupport,
                 PlanetError, elastic_ring
    exchange     import_rexs, export, port_matrices, read_matrices, PortMatrices
    errors       SolidgearError, SceneError

A study takes the path of a file, its tables as a dict, a Scene or a Train. Names are imported when
first used, so that importing the package stays cheap; ``__init__.pyi`` lists them all.
"""

from __future__ import annotations

import importlib
from functools import cache
from pathlib import Path
from types import FunctionType

import solidgear.rooms  # noqa: F401  # what features add to the core
from solidgear.core.machine.version import VERSION

__version__ = VERSION


@cache
def _listed() -> dict[str, str]:
    """Return the module of every name, from the list that type checkers read."""
    import ast  # start-up: no command reads the list

    stub = ast.parse(Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
    lines = [line for line in stub.body if isinstance(line, ast.ImportFrom)]
    return {alias.name: str(line.module) for line in lines for alias in line.names}


class _NoSuch(AttributeError):
    """Error of a missing name; the hint is searched only when the error is printed."""

    def __str__(self) -> str:
        from solidgear.core.errors import nearest  # start-up: for this alone

        (name,) = self.args
        return f"module 'solidgear' has no attribute {name!r}{nearest(name, _listed())}"


def __getattr__(name: str):
    if name.startswith("__") and name != "__all__":
        raise _NoSuch(name)  # such as Python itself asks for
    where = _listed()
    if name == "__all__":
        return sorted([*where, "__version__"])
    if name not in where:
        raise _NoSuch(name)
    value = getattr(importlib.import_module(where[name]), name)
    if isinstance(value, FunctionType):
        from solidgear.core.arguments import checked  # start-up: commands do without

        value = checked(value, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*__getattr__("__all__"), *(name for name in globals() if name.startswith("__"))})
