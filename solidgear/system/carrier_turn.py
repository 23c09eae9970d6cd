r"""Equilibrium of a planetary stage over a turn of its carrier.

In axes that turn with the carrier the stage stays as it is, and what stands still outside turns
backwards.  With u the shift of a central member, C its flexibility and ``u_0`` what torque and
errors make of it, both on a mean bearing k, a support K fixed in space, whose seat is off by e, gives

    (1 + C (K' - k)) u = u_0 + C K' e',        K' = R' K R,    e' = R' e,

at every position R: two equations for each such support, whatever the size of the stage.

With the other members held, N >= 3 equal planets at equal angles are to the sun one spring, the same
in all directions: ``N k_e / 2`` with ``k_e`` the stiffness through one planet
(:attr:`solidgear.system.planetary.PlanetaryStage.path_stiffness`).  So the sun stands still at
``e k_s / (k_s + N k_e / 2)``, and every mesh force varies once a turn of the carrier by

    k_e e k_s / (k_s + N k_e / 2),

with phases ``2 pi / N`` apart and sum zero.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from solidgear.errors import SolidgearError, listed
from solidgear.frames import rotation
from solidgear.system.matrices import frozen
from solidgear.system.planetary import CENTRAL, ONE_LINE, PlanetaryStage
from solidgear.system.system import System

ACROSS = [0, 2]
#: rad; of a free motion, less is rounding
TURNS = 1e-9


@dataclass(frozen=True)
class FixedSupport:
    """Support of a central member that does not turn with the carrier.

    Attributes
    ----------
    stiffness : float or (2, 2) array_like
        On x and z, N/m.
    shift : (2,) array_like
        Of its seat along x and z, m.

    Examples
    --------
    >>> import solidgear as sg
    >>> sg.FixedSupport(2e7, (10e-6, 0)).matrix
    array([[20000000.,        0.],
           [       0., 20000000.]])
    """

    stiffness: ArrayLike
    shift: ArrayLike = (0.0, 0.0)

    def __post_init__(self):
        frozen("the shift of a support", self.shift, (2,))
        matrix = self.matrix
        if not np.allclose(matrix, matrix.T) or np.linalg.eigvalsh(matrix)[0] < 0:
            raise SolidgearError(
                f"a support of {self.stiffness!r} N/m is no spring; "
                "give a stiffness that is not negative, or a symmetric 2x2 of such"
            )

    @property
    def matrix(self) -> np.ndarray:
        """(2, 2) stiffness."""
        given = np.asarray(self.stiffness, float)
        full = given * np.eye(2) if given.ndim == 0 else given
        return frozen("the stiffness of a support", full, (2, 2))


@dataclass(frozen=True)
class PlanetError:
    """Errors of manufacture at one planet, m.

    Attributes
    ----------
    pin : (2,) sequence of float
        Of the pin, away from the sun and forward.
    sun_tooth, ring_tooth : float
        Thickness along the line of action in the mesh with sun and ring; more presses.

    Examples
    --------
    >>> import solidgear as sg
    >>> late = sg.PlanetError(pin=(0.0, -20e-6))     # presses against the sun first
    >>> late.sun_tooth
    0.0
    """

    pin: Sequence[float] = (0.0, 0.0)
    sun_tooth: float = 0.0
    ring_tooth: float = 0.0

    def __post_init__(self):
        frozen("the error of a pin", self.pin, (2,))
        frozen("the error of teeth at a planet", (self.sun_tooth, self.ring_tooth), (2,))


@dataclass(frozen=True, eq=False)
class CarrierTurn:
    """Forces of a planetary stage over a turn of its carrier.

    Attributes
    ----------
    angle : (a,) ndarray
        Of the carrier, rad.
    sun_mesh, ring_mesh : (a, N) ndarray
        Of every planet, N; negative ones would need teeth that pull.
    pin : (a, N, 2) ndarray
        Of every planet on the carrier, away from the sun and forward, N.
    shift : mapping of str to (a, 2) ndarray
        Of members on fixed supports, along x and z in space, m.
    support : mapping of str to (a, 2) ndarray
        Force of those members on their supports, in space, N.
    torque : mapping of str to (a,) ndarray
        Of the planets on sun, ring and carrier, N m; their sum is zero.
    """

    angle: np.ndarray
    sun_mesh: np.ndarray
    ring_mesh: np.ndarray
    pin: np.ndarray
    shift: Mapping[str, np.ndarray] = field(repr=False)
    support: Mapping[str, np.ndarray] = field(repr=False)
    torque: Mapping[str, np.ndarray] = field(repr=False)

    def amplitude(self, order: int) -> np.ndarray:
        """(N,) amplitude of every mesh force with the sun at a multiple of the carrier's frequency,
        from 1 to below half the positions, N.
        """
        if not 0 < order < len(self.angle) / 2:
            raise SolidgearError(
                f"order {order} is not among those of {len(self.angle)} positions: "
                "from 1 to below half of them"
            )
        return 2 * np.abs(np.fft.rfft(self.sun_mesh, axis=0)[order]) / len(self.angle)


def carrier_turn(
    stage: PlanetaryStage,
    torque: float,
    supports: Mapping[str, FixedSupport] | None = None,
    errors: Sequence[PlanetError] = (),
    positions: int = 72,
) -> CarrierTurn:
    """Equilibrium of a planetary stage at positions of its carrier.

    Parameters
    ----------
    torque : float
        On the sun, N m; what turns freely of carrier or ring takes the other torque.
    supports : mapping of str to FixedSupport
        Of ``sun``, ``ring`` or ``carrier``, beside bearings of the stage, which turn with it.
    errors : sequence of PlanetError
        One a planet; none without.
    positions : int
        At equal angles over one turn.

    Raises
    ------
    SolidgearError
        For a stage whose circles and pins do not fit, that nothing holds, or arguments that are no
        such thing.

    Examples
    --------
    A sun whose support is 10 um off makes the force of each planet vary once a turn:

    >>> import numpy as np
    >>> import solidgear as sg
    >>> teeth = sg.PlanetaryTeeth(17, 34, 85, module=2.5e-3)
    >>> s, p, r = teeth.base_radii
    >>> stage = sg.PlanetaryStage(
    ...     sg.CentralMember(0.2, 3e-5, s),
    ...     sg.CentralMember(2.0, 0.02, r, bearing=1e15, turning=1e13),
    ...     sg.CentralMember(1.5, 5e-3, teeth.pin_radius, bearing=1e15),
    ...     sg.Planet(0.6, 5e-4, p, pin=2e8, sun_mesh=2e8, ring_mesh=3e8).spaced(3),
    ...     teeth.pressure_angle,
    ... )
    >>> turn = sg.carrier_turn(stage, 20.0, {"sun": sg.FixedSupport(1e7, (10e-6, 0))})
    >>> k_e = stage.path_stiffness[0]
    >>> closed = k_e * 10e-6 * 1e7 / (1e7 + 3 * k_e / 2)
    >>> round(float(closed), 3), round(float(turn.amplitude(1)[0]), 3)
    (56.82, 56.82)
    """
    _fits(stage)
    frozen("the torque on the sun", torque, ())
    supports = supports or {}
    unknown = supports.keys() - set(CENTRAL)
    if unknown:
        raise SolidgearError(
            f"{min(unknown)!r} has no support; {listed(list(CENTRAL))} may have one"
        )
    if positions < 1:
        raise SolidgearError(f"{positions} positions are none; ask for 1 or more")
    errors = errors or [PlanetError()] * len(stage.planets)
    if len(errors) != len(stage.planets):
        raise SolidgearError(
            f"{len(errors)} errors for {len(stage.planets)} planets; give each its own"
        )
    mean = {name: np.trace(own.matrix) / 2 for name, own in supports.items()}
    held = replace(
        stage,
        **{
            name: replace(getattr(stage, name), bearing=getattr(stage, name).bearing + spring)
            for name, spring in mean.items()
        },
    ).system
    strains, where = held.strains
    gaps = _gaps(len(strains), where, stage, errors)
    at = [held.motion(f"{name}.centre")[ACROSS] for name in supports]
    rows = np.vstack([np.zeros((0, held.size)), *at])
    moved = held.static(np.column_stack([_torques(held, torque) - strains.T @ gaps, rows.T]))
    angle = 2 * np.pi * np.arange(positions) / positions
    shift, pushed, support = _supported(angle, supports, mean, rows @ moved)
    stretch = strains @ moved
    stretch[:, 0] += gaps
    springs = stretch[:, :1] + stretch[:, 1:] @ pushed.T
    return _turn(stage, angle, springs.T, where, shift, support)


def _fits(stage: PlanetaryStage) -> None:
    """Refusal of tooth forces that are no pairs on one line."""
    worst = max(map(abs, stage.apart))
    if worst > ONE_LINE * stage.carrier.radius:
        raise SolidgearError(
            f"base circles, pressure angle and pins do not fit: lines of action that should be one "
            f"are {1e3 * worst:.3g} mm apart, so that torques would not balance"
        )


def _torques(held: System, torque: float) -> np.ndarray:
    """Load of the sun's torque and of what balances it on a member that is free to turn."""
    load = held.load({"sun.centre": np.array([0, 0, 0, 0, torque, 0])})
    for name in ("carrier", "ring"):
        motion = held.motion(f"{name}.centre")[4]
        freely = motion @ held.free
        if held.free.shape[1] == 1 and abs(freely[0]) > TURNS:
            return load - motion * (load @ held.free[:, 0]) / freely[0]
    return load


def _gaps(size: int, where, stage: PlanetaryStage, errors: Sequence[PlanetError]) -> np.ndarray:
    """(r,) strain of rows that errors make where nothing moves."""
    out = np.zeros(size)
    for k, (planet, error) in enumerate(zip(stage.planets, errors), 1):
        out[where[f"planet {k} pin"]] = -np.sqrt(planet.pin) * np.asarray(error.pin)
        for mate in ("sun", "ring"):
            thicker = getattr(error, f"{mate}_tooth")
            stiffness = getattr(planet, f"{mate}_mesh")
            out[where[f"planet {k} {mate} mesh"]] = np.sqrt(stiffness) * thicker
    return out


def _supported(angle, supports: Mapping[str, FixedSupport], mean, seen: np.ndarray):
    """Shifts in space by name, loads (a, 2 s) on the stage beyond its mean bearings, and forces on
    supports in space, at every position; from shifts (2 s, 1 + 2 s) under load and unit forces.
    """
    size = 2 * len(supports)
    turns = np.array([rotation(1, a)[np.ix_(ACROSS, ACROSS)] for a in angle])
    stiffness = np.zeros((len(angle), size, size))
    off = np.zeros((len(angle), size))
    for k, own in enumerate(supports.values()):
        place = slice(2 * k, 2 * k + 2)
        stiffness[:, place, place] = turns.transpose(0, 2, 1) @ own.matrix @ turns
        off[:, place] = np.asarray(own.shift, float) @ turns
    beyond = stiffness - np.diag(np.repeat(list(mean.values()), 2).astype(float))
    start, give = seen[:, 0], seen[:, 1:]
    pressed = np.einsum("aij,aj->ai", stiffness, off)
    right = start + pressed @ give.T
    moved = np.linalg.solve(np.eye(size) + give @ beyond, right[..., None])[..., 0]
    pushed = pressed - np.einsum("aij,aj->ai", beyond, moved)
    carried = np.einsum("aij,aj->ai", stiffness, moved) - pressed
    shift, support = {}, {}
    for k, name in enumerate(supports):
        place = slice(2 * k, 2 * k + 2)
        shift[name] = np.einsum("aij,aj->ai", turns, moved[:, place])
        support[name] = np.einsum("aij,aj->ai", turns, carried[:, place])
    return shift, pushed, support


def _turn(stage: PlanetaryStage, angle, springs: np.ndarray, where, shift, support) -> CarrierTurn:
    """Forces from the strains (a, r) of all rows."""
    forces: dict[str, list[np.ndarray]] = {"sun mesh": [], "ring mesh": [], "pin": []}
    for k, planet in enumerate(stage.planets, 1):
        sizes = (planet.sun_mesh, planet.ring_mesh, planet.pin)
        for (name, found), stiffness in zip(forces.items(), sizes):
            own = springs[:, where[f"planet {k} {name}"]]
            none = np.zeros((len(angle), 1))
            found.append(np.sqrt(stiffness) * (own if own.shape[1] else none))
    sun, ring = (np.hstack(forces[name]) for name in ("sun mesh", "ring mesh"))
    pin = np.stack(forces["pin"], axis=1)
    torque = {
        "sun": -sun.sum(axis=1) * stage.sun.radius,
        "ring": -ring.sum(axis=1) * stage.ring.radius,
        "carrier": pin[:, :, 1].sum(axis=1) * stage.carrier.radius,
    }
    return CarrierTurn(angle, sun, ring, pin, shift, support, torque)
