"""ROSS as a peer for the beam: the same nodes, tapered Timoshenko elements, and bearings as ROSS has
them, at a node each and without tilt stiffness.
"""

from __future__ import annotations

import importlib.util
import time

from validation.race.process import called

RUNS = 3


def present() -> str:
    """Empty if ROSS can be run, else the reason why not."""
    missing = "no package ross (pip install ross-rotordynamics)"
    return "" if importlib.util.find_spec("ross") else missing


def on_nodes(scene):
    """The scene with bearings that hold translations only, of the section in their middle.

    An averaged seat of ours is held in its width: 3.8 % between the third bending modes.
    """
    import numpy as np

    bearings = []
    for bearing in scene.bearings:
        k = np.diag(np.diag(bearing.stiffness))
        k[3:] = 0.0
        bearings.append(bearing.with_changes(matrix=k, axial_series=(), attachment="section"))
    return scene.with_changes(bearings=tuple(bearings))


def rotor(scene, body) -> dict:
    """What ROSS needs, as plain data.

    Parameters
    ----------
    scene : Scene
        Of :func:`on_nodes`.
    body : Body
        Timoshenko body of it, for its nodes.
    """
    nodes = [float(y) for y in body.geometry.nodes]
    elements = []
    for left, right in zip(nodes, nodes[1:]):
        middle = (left + right) / 2
        segment = next(s for s in scene.segments if s.y0 <= middle <= s.y1)
        radii = [segment.radius_at(min(max(y, segment.y0), segment.y1)) for y in (left, right)]
        material = segment.material
        # inner and outer diameter, left then right
        sides = [2 * x for radius in radii for x in radius]
        elements.append([right - left, *sides, material.E, material.nu, material.density])
    bearings = []
    for bearing in scene.bearings:
        nearest = min(range(len(nodes)), key=lambda i: abs(nodes[i] - bearing.y))
        bearings.append([nearest, *(float(bearing.stiffness[c, c]) for c in range(3))])
    return {"elements": elements, "bearings": bearings}


def solve(data: dict, *, limit: float = 300.0) -> dict:
    """Run ROSS in a process of its own: ``seconds`` of building the rotor and its modes, ``cpu``
    seconds of the process, ``frequency_hz``, ``version``.

    Raises
    ------
    PeerError
    """
    done = called("validation.race.ross_peer:solved", limit=limit, **data)
    return done.answer | {"cpu": done.cpu}


def solved(elements: list, bearings: list) -> dict:
    """What ROSS answers, as plain data."""
    import math

    import ross

    seconds = []
    for _ in range(RUNS):  # the first run pays for what is loaded late
        start = time.perf_counter()
        found = _rotor(ross, elements, bearings).run_modal(speed=0.0, num_modes=24)
        seconds.append(time.perf_counter() - start)
    # Free torsion comes out as rounding.
    frequency = sorted(w / (2 * math.pi) for w in found.wn.tolist() if w > 1.0)
    return {"seconds": min(seconds), "frequency_hz": frequency, "version": ross.__version__}


def _rotor(ross, elements: list, bearings: list):
    steels: dict[tuple, object] = {}
    shaft = []
    for n, (length, inner0, outer0, inner1, outer1, *steel) in enumerate(elements):
        key = young, poisson, density = tuple(steel)
        if key not in steels:
            name = f"M{len(steels)}"
            steels[key] = ross.Material(name=name, rho=density, E=young, Poisson=poisson)
        sides = (inner0, outer0, inner1, outer1)
        more = {"material": steels[key], "n": n, "shear_method_calc": "cowper"}
        shaft.append(ross.ShaftElement(length, *sides, **more))
    held = [ross.BearingElement(n=n, kxx=kx, kyy=kz, kzz=ky, cxx=0.0) for n, kx, ky, kz in bearings]
    return ross.Rotor(shaft, bearing_elements=held)
