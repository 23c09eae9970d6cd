"""ROSS as a peer for the beam: the same nodes, tapered Timoshenko elements, and bearings as ROSS has
them, at a node each and without tilt stiffness; and for two gears with backlash, its own example.
"""

from __future__ import annotations

import time
from typing import Any

from validation.race.process import peer

RUNS = 3


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
    return peer("ross", "validation.race.ross_peer:solved", limit=limit, **data)


def solved(elements: list, bearings: list) -> dict:
    """What ROSS answers, as plain data."""
    import math

    import ross

    def clocked(sparse: bool) -> tuple[float, Any]:
        start = time.perf_counter()
        rotor = _rotor(ross, elements, bearings)
        found = rotor.run_modal(speed=0.0, num_modes=24, sparse=sparse)
        return time.perf_counter() - start, found

    # the first run pays for what is loaded and compiled late; then the faster of both its solvers
    clocked(False)
    sparse = clocked(True)[0] < clocked(False)[0]
    runs = [clocked(sparse) for _ in range(RUNS)]
    found = runs[0][1]
    # Free torsion comes out as rounding.
    frequency = sorted(w / (2 * math.pi) for w in found.wn.tolist() if w > 1.0)
    return {
        "seconds": min(s for s, _ in runs),
        "frequency_hz": frequency,
        "version": ross.__version__,
    }


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


def in_time(*, limit: float = 900.0, **given: Any) -> dict:
    """Two gears with backlash by ROSS in a process of its own, as :func:`geared`, with ``cpu``.

    Raises
    ------
    PeerError
    """
    return peer("ross", "validation.race.ross_peer:geared", limit=limit, **given)


def geared(
    hz: list, error: float, swing: float, varying: float, damping: float, cycles: int, steps: int
) -> dict:
    """ROSS's example with backlash (its ``tests/test_multi_rotor.py``), from rest at each speed.

    Parameters
    ----------
    hz : list of float
        Mesh frequencies.
    error, swing, varying, damping : float
        Transmission error, m; torque once a turn, N m; amplitude of the stiffness over its mean;
        damping ratio of the mesh.
    cycles, steps : int
        Mesh periods of a run, and time steps of each.

    Returns
    -------
    dict
        Numbers of the pair, and of every speed the last 40 mesh periods, two turns, and the mean of
        the centre distance over them.
    """
    from copy import deepcopy

    import numpy as np
    import ross as rs

    steel = rs.Material(name="Steel", rho=7850, E=2e11, Poisson=0.3)
    light = rs.Material(name="Light", rho=0.01, E=1e15, Poisson=0.3)
    shaft = rs.ShaftElement(n=0, L=1e-4, idl=0.0, odl=1e-4, material=light)
    bearing = rs.BearingElement(n=0, kxx=1e8, kyy=1e8, cxx=512.64, cyy=512.64)
    wide, width, mass = 0.2, 0.03, 6.57
    gear = rs.GearElementTVMS(
        n=0,
        material=steel,
        width=width,
        bore_diameter=np.sqrt(wide**2 - 4 * mass / (np.pi * width * steel.rho)),
        module=0.01,
        n_teeth=20,
        pr_angle=np.radians(20.0),
        helix_angle=0,
        addendum_coeff=1,
        tip_clearance_coeff=0.25,
    )
    rotor = rs.Rotor([shaft], [gear], [bearing])
    more = {"enable": True, "initial_value": 5e-5, "error_amp": error}
    seconds, runs = 0.0, []
    for f in hz:
        pair = rs.MultiRotor(
            deepcopy(rotor),
            deepcopy(rotor),
            coupled_nodes=(0, 0),
            square_varying_stiffness={"enable": True, "amplitude_ratio": varying},
            backlash={**more, "smooth_operator": False, "sigma": 1e5},
        )
        teeth = pair.mesh.backlash
        teeth.damping_ratio = damping
        turning = 2 * np.pi * f / 20
        t = np.linspace(0.0, cycles / f, cycles * steps + 1)
        loads = np.zeros((len(t), pair.ndof))
        gears = [int(e.n) for e in pair.disk_elements]
        loads[:, [6 * n + 5 for n in gears]] = (300 + swing * np.sin(turning * t))[:, None]
        begin = time.process_time()
        found = pair.run_time_response(turning, loads, t, method="newmark", newmark_type="robust")
        seconds += time.process_time() - begin
        mesh, last = found.mesh_dynamics, slice(-40 * steps, None)
        kept = {"approach": "transmission_error", "gap": "backlash", "force": "mesh_force"}
        run = {name: np.asarray(mesh[own])[last].tolist() for name, own in kept.items()}
        run["stiffness"] = np.asarray(mesh["mesh_stiffness"])[last][:steps].tolist()
        runs.append({**run, "hz": f, "distance": float(np.mean(mesh["center_distance"][last]))})
    numbers = {"mass": gear.m, "polar": gear.Ip, "base_radius": gear.base_radius, "teeth": 20}
    damper = 2 * damping * np.sqrt(pair.mesh.stiffness * teeth.M_eq)
    return {
        "pair": {k: float(v) for k, v in numbers.items()} | {"mesh_damper": float(damper)},
        "runs": runs,
        "seconds": seconds,
        "version": rs.__version__,
    }
