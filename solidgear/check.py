"""Cheap guards on a scene and a body: mass closed, free body free, and rules of thumb that were measured."""

from __future__ import annotations

import numpy as np

from solidgear.body import Body, as_supports
from solidgear.evidence.converge import sharpest_corner
from solidgear.meshing.quality import mass_properties

# Closure of mass and inertia that each discretisation owes to the closed form.
MASS_TOLERANCE = {"euler": 1e-9, "timoshenko": 1e-9, "harmonic": 1e-9, "solid": 1e-3}


def check_scene(scene, body: Body) -> dict[str, list[str]]:
    """Facts, cautions and faults of a scene at one fidelity, in sentences.

    Parameters
    ----------
    scene : Scene
    body : Body

    Returns
    -------
    dict
        ``facts``, ``cautions`` (will not hold as well as one might think) and ``faults`` (must not be used).
    """
    facts, cautions, faults = [], [], []
    exact = mass_properties(scene.segments)
    mass, centre, polar, transverse = exact.mass, exact.centre, exact.iyy, exact.ixx
    matrix = body.mass_matrix()
    facts.append(f"{scene.name}: {body.fidelity}, {body.size} unknowns, length {1e3 * scene.length:.6g} mm")
    facts.append(f"mass {mass:.6g} kg, centre at y = {1e3 * centre:.6g} mm, polar inertia {polar:.6g}, transverse {transverse:.6g} kg m^2 (closed form)")
    for name, got, want in (("mass", matrix[0, 0], mass), ("polar inertia", matrix[4, 4], polar)):
        error = got / want - 1
        facts.append(f"{name} of the mesh against closed form: {error:+.1e}")
        if abs(error) > MASS_TOLERANCE[body.fidelity]:
            faults.append(f"{name} of the {body.fidelity} mesh is {error:+.2e} off the closed form, limit {MASS_TOLERANCE[body.fidelity]:g}: mesh finer")
    residual = body.rigid_residual()
    facts.append(f"stiffness times rigid motions: {residual:.1e} of its size (a free body gives rounding)")
    if residual > 1e-9:
        faults.append(f"the body is not free: rigid motions meet a stiffness of {residual:.1e}")
    free = as_supports(scene).unresisted(body).shape[1]
    facts.append(f"rigid motions that no bearing resists: {free}")
    if free > 1 and scene.bearings:
        cautions.append(f"bearings leave {free} rigid motions free; only torsion is meant to be")
    slender = scene.length / (2 * max(max(s.outer0, s.outer1) for s in scene.segments))
    if slender < 16:
        cautions.append(f"length over diameter is {slender:.2f}: Euler-Bernoulli needs 16 for 1 % in first bending (uniform free shaft)")
    if slender < 2:
        cautions.append(f"length over diameter is {slender:.2f}: below 2 Timoshenko errs by more than 3e-4 even on a uniform shaft")
    if scene.steps:
        angle, exponent = sharpest_corner(scene)
        cautions.append(
            f"{len(scene.steps)} sharp shoulder(s): beams are too stiff there, and meshes that are not graded converge with order "
            f"{2 * exponent:.2f} (corner of {np.degrees(angle):.0f} degrees)"
        )
    walls = [(s.name, min(s.outer0 - s.inner0, s.outer1 - s.inner1) / max(s.outer0, s.outer1)) for s in scene.segments if s.inner0 or s.inner1]
    for name, wall in walls:
        if wall < 0.2:
            cautions.append(f"segment {name!r} has a wall of {wall:.2f} of its radius: ovalising modes may lie below bending; the harmonic option ovalising=(2, 3) computes them")
    doubtful = [f"bearing {b.name!r} ({b.status})" for b in scene.bearings if b.status in ("identified", "assumed")]
    if doubtful:
        cautions.append("data not measured or published: " + ", ".join(doubtful))
    return {"facts": facts, "cautions": cautions, "faults": faults}
