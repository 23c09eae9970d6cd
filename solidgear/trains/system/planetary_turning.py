r"""Terms that a turning carrier adds to a planetary stage, in axes that turn with it.

With W the speed of the carrier, y its axis, and w the speed of a body about the body's axis, all in
space, rates of change in turning axes give for the shift u and the tilt t of a rigid body of mass
m, diametral and polar moments of inertia J and I

    m (u'' + 2 W y x u' - W^2 u),        J t'' + (2 J W - I w) y x t' + W (I w - J W) t,

u and t across the axis; motions along and about it are left alone.  Together

    M q'' + G q' + (K - C + P) q = 0.

P is the effect of the centrifugal force of planets, ``F = m W^2 R`` on each pin away from the axis
e: it turns with the carrier, where it has the energy ``-F e . (t x (u_p - u_c)) - F R |t x e|^2 /
2``, t the turn of the carrier. Lin and Parker (1999) have G and C in the plane and leave P out; it
is of the size of C, and without it a stage that is free to turn would run away under centrifugal
force. Pins are taken to carry all of that force; that it loads meshes, bends the ring, or shifts
frequencies by stretching loaded parts is left out.

In these axes a motion that stands still in space turns backwards at W: a frequency p in space is ``p
- W`` and ``p + W`` here.  Bearings that are not the same all around would change with time.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.linalg as sla

from solidgear.core import SolidgearError
from solidgear.core.frames import cross_matrix
from solidgear.trains.system.planetary_members import CentralMember, Members, Planet
from solidgear.trains.system.planetary_modes import CENTRAL, Phases

AXIS = cross_matrix([0.0, 1.0, 0.0])
ROUND = np.diag([1.0, 0.0, 1.0])
#: of the highest frequency: a free rotation is a double zero, which rounding parts by its root
STILL = 1e-6


class TurningTerms(NamedTuple):
    """Matrices (N, N) of ``M q'' + G q' + (K - C + P) q`` on the coordinates of the stage's system."""

    #: gyroscopic, centrifugal, pull: G, skew-symmetric, kg/s and kg m^2/s; C and P, symmetric, N/m
    #: and N m/rad
    gyroscopic: np.ndarray
    centrifugal: np.ndarray
    pull: np.ndarray


class TurningMode(NamedTuple):
    """Mode of a stage whose carrier turns."""

    kind: str  #: as of :class:`solidgear.trains.system.planetary_modes.PlanetaryMode`
    frequency_hz: float  #: in axes that turn with the carrier
    growth: float  #: 1/s; 0 but for rounding where the stage is stable
    shape: np.ndarray  #: (N,) amplitudes of ``exp(i w t)``, of unit ``q* M q``


def speeds(stage: Members, carrier: float, ring: float) -> dict[str, float]:
    """Return the speed of every body about the axis in space, rad/s, from those of carrier and
    ring.
    """
    relative = (ring - carrier) * stage.ring.radius
    out = {"sun": carrier - relative / stage.sun.radius, "ring": ring, "carrier": carrier}
    for k, planet in enumerate(stage.planets, 1):
        out[f"planet {k}"] = carrier + relative / planet.radius
    return {name: 2 * np.pi * speed for name, speed in out.items()}


def turning_terms(stage: Members, carrier: float, ring: float = 0.0) -> TurningTerms:
    """Return terms of a carrier and a ring at some speeds, turns a second."""
    for name, speed in (("carrier", carrier), ("ring", ring)):
        if not np.isfinite(speed):
            raise SolidgearError(
                f"the {name} turns at {speed}; give a finite speed in turns a second"
            )
    bodies: dict[str, CentralMember | Planet] = {n: getattr(stage, n) for n in CENTRAL}
    bodies |= {f"planet {k}": planet for k, planet in enumerate(stage.planets, 1)}
    elastic = [n for n, body in bodies.items() if body.part is not None and len(body.part.strain)]
    if elastic:
        raise SolidgearError(
            f"the {elastic[0]} is an elastic body; terms of a turning carrier are those of rigid ones"
        )
    system, about = stage.system, 2 * np.pi * carrier
    gyroscopic, centrifugal, pull = np.zeros((3, system.size, system.size))
    spins = speeds(stage, carrier, ring)
    carried = system.motion("carrier.centre")
    for name, body in bodies.items():
        shifts, tilts = np.vsplit(system.motion(f"{name}.centre"), 2)
        polar, across = body.inertia * spins[name], body.diametral * about
        gyroscopic += 2 * about * body.mass * shifts.T @ AXIS @ shifts
        gyroscopic += (2 * across - polar) * tilts.T @ AXIS @ tilts
        centrifugal += about**2 * body.mass * shifts.T @ ROUND @ shifts
        centrifugal += about * (across - polar) * tilts.T @ ROUND @ tilts
        if isinstance(body, Planet):
            relative, outward = body.axes @ shifts - carried[:3], body.axes[:, 0]
            force = body.mass * about**2 * stage.carrier.radius
            turned = -force * relative.T @ cross_matrix(outward) @ carried[3:]
            lever = stage.carrier.radius * (np.eye(3) - np.outer(outward, outward))
            pull += turned + turned.T - force * carried[3:].T @ lever @ carried[3:]
    return TurningTerms(gyroscopic, centrifugal, pull)


def turning_modes(stage: Members, carrier: float, ring: float = 0.0) -> list[TurningMode]:
    """Return all modes at some speeds, turns a second, by ascending frequency."""
    terms, system = turning_terms(stage, carrier, ring), stage.system
    lower = np.linalg.cholesky(system.mass)

    def normal(matrix):
        half = sla.solve_triangular(lower, matrix, lower=True)
        return sla.solve_triangular(lower, half.T, lower=True).T

    stiff = normal(system.stiffness - terms.centrifugal + terms.pull)
    scale = np.sqrt(np.linalg.norm(stiff, 2))
    zero, unit = np.zeros_like(stiff), np.eye(len(stiff))
    state = np.block([[zero, unit], [-stiff / scale**2, -normal(terms.gyroscopic) / scale]])
    value, vector = np.linalg.eig(state)
    # eigenvalues come in fours or in pairs of two signs: one of each is kept
    value = np.where(np.abs(value) < STILL, 0.0, value)
    still = np.abs(value.imag) < STILL
    resting = np.flatnonzero(still)[np.argsort(-value[still].real, kind="stable")]
    selected = np.concatenate([resting[: len(resting) // 2], np.flatnonzero(value.imag >= STILL)])
    selected = selected[np.argsort(np.abs(value[selected].imag), kind="stable")]
    shapes = vector[: len(stiff), selected]
    shapes = sla.solve_triangular(lower.T, shapes / np.linalg.norm(shapes, axis=0), lower=False)
    eigenvalues = scale * value[selected]
    kinds = Phases(stage).kinds(shapes)
    return [
        TurningMode(kind, float(abs(eigenvalue.imag)) / (2 * np.pi), float(eigenvalue.real), shape)
        for kind, eigenvalue, shape in zip(kinds, eigenvalues, shapes.T)
    ]
