r"""Equilibrium of a planetary stage over a turn of the carrier.

In axes that turn with the carrier the stage stays as it is, and a part that stands still outside
turns backwards. With u the shift of a central member, C the flexibility and ``u_0`` the shift by
torque and errors, both on a mean bearing k, a support K fixed in space, whose seat is off by e,
gives

    (1 + C (K' - k)) u = u_0 + C K' e',        K' = R' K R,    e' = R' e,

at every position R: six equations for each such support, whatever the size of the stage.  A load f
that keeps the direction in space, such as weight, is ``R' f`` in these axes, so that ``u_0`` of it
goes with the cosine and the sine of the position.

With the other members held, N >= 3 equal planets at equal angles are to the sun one spring, the
same in all directions: ``N k_e / 2`` with ``k_e`` the stiffness through one planet
(:attr:`solidgear.trains.system.planetary.PlanetaryStage.path_stiffness`). So the sun stands still at ``e
k_s / (k_s + N k_e / 2)``, and every mesh force varies once a turn of the carrier by

    k_e e k_s / (k_s + N k_e / 2),

with phases ``2 pi / N`` apart and sum zero. That is of a sun locked in the plane, and of spur
teeth; a helical sun that is held against tilting has ``N k_e cos^2(b) / 2`` and forces by ``cos
b``, b the base helix angle.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import cos

import numpy as np
from numpy.typing import ArrayLike

from solidgear.core import SolidgearError, System, listed, rotation
from solidgear.core.springs import root_of
from solidgear.core.system.matrices import frozen, spd
from solidgear.trains.system.planetary import ONE_LINE, PlanetaryStage
from solidgear.trains.system.planetary_members import ACROSS
from solidgear.trains.system.planetary_modes import CENTRAL

#: rad; of a free motion, less is rounding
TURNS = 1e-9


@dataclass(frozen=True)
class FixedSupport:
    """Support of a central member that does not turn with the carrier.

    Attributes
    ----------
    stiffness : float, (2, 2) or (6, 6) array_like
        On x and z, N/m, or on all motions of the member's centre.
    shift : (2,) or (6,) array_like
        Of its seat along x and z, m, or in all motions.

    Examples
    --------
    >>> import solidgear as sg
    >>> support = sg.FixedSupport(2e7, (10e-6, 0))
    >>> support.matrix[0, 0], support.off[0]
    (np.float64(20000000.0), np.float64(1e-05))
    """

    stiffness: ArrayLike
    shift: ArrayLike = (0.0, 0.0)

    def __post_init__(self):
        name = "the shift of a support"
        frozen(name, self.shift, (6,) if np.shape(self.shift) == (6,) else (2,))
        spd("the stiffness of a support", self.matrix, definite=False)

    @property
    def matrix(self) -> np.ndarray:
        """(6, 6) stiffness."""
        stiffness = np.asarray(self.stiffness, float)
        if stiffness.shape == (6, 6):
            return stiffness
        full = np.zeros((6, 6))
        planar = stiffness * np.eye(2) if stiffness.ndim == 0 else stiffness
        full[np.ix_(ACROSS, ACROSS)] = frozen("the stiffness of a support", planar, (2, 2))
        return full

    @property
    def off(self) -> np.ndarray:
        """(6,) shift of the seat."""
        shift = np.asarray(self.shift, float)
        return shift if shift.shape == (6,) else np.insert(np.zeros(4), [0, 1], shift)


@dataclass(frozen=True)
class PlanetError:
    """Errors of manufacture at one planet, m.

    Attributes
    ----------
    pin : (2,) sequence of float
        Of the pin, away from the sun and forward.
    tilt : (2,) sequence of float
        Of the pin about these two directions, rad; of no effect on a planet locked in the plane.
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
    tilt: Sequence[float] = (0.0, 0.0)

    def __post_init__(self):
        frozen("the error of a pin", self.pin, (2,))
        frozen("the tilt of a pin", self.tilt, (2,))
        frozen("the error of teeth at a planet", (self.sun_tooth, self.ring_tooth), (2,))


@dataclass(frozen=True, eq=False)
class CarrierTurn:
    """Forces of a planetary stage over a turn of the carrier."""

    angle: np.ndarray  #: (a,) of the carrier, rad
    #: sun_mesh, ring_mesh: (a, N) of every planet, N; negative ones would need teeth that pull
    sun_mesh: np.ndarray
    ring_mesh: np.ndarray
    #: (a, N, 6) force and moment of every planet on the carrier, in the planet's axes, N and N m
    pin_load: np.ndarray
    #: of members on fixed supports, in space, m and rad
    shift: Mapping[str, np.ndarray] = field(repr=False)
    #: force and moment of those members on their supports, in space, N and N m
    support: Mapping[str, np.ndarray] = field(repr=False)
    #: of the planets on sun, ring and carrier, N m; their sum is zero
    torque: Mapping[str, np.ndarray] = field(repr=False)

    @property
    def pin(self) -> np.ndarray:
        """(a, N, 2) force of every planet on the carrier, away from the sun and forward, N."""
        return self.pin_load[:, :, ACROSS] * [1.0, -1.0]

    def amplitude(self, order: int) -> np.ndarray:
        """Return the amplitude (N,) of every mesh force with the sun at a multiple of the carrier's
        frequency, from 1 to below half the positions, N.
        """
        if not 0 < order < len(self.angle) / 2:
            raise SolidgearError(
                f"order {order} is not among those of {len(self.angle)} positions; give 1 to less "
                "than half of them"
            )
        return 2 * np.abs(np.fft.rfft(self.sun_mesh, axis=0)[order]) / len(self.angle)


def carrier_turn(
    stage: PlanetaryStage,
    torque: float,
    supports: Mapping[str, FixedSupport] | None = None,
    errors: Sequence[PlanetError] = (),
    positions: int = 72,
    weights: Mapping[str, ArrayLike] | None = None,
    carried: Mapping[str, ArrayLike] | None = None,
) -> CarrierTurn:
    """Return the equilibrium of a planetary stage at positions of the carrier.

    Parameters
    ----------
    torque : float
        On the sun, N m; carrier or ring, whichever turns freely, takes the other torque, and that
        of the other loads.
    supports : mapping of str to FixedSupport
        Of ``sun``, ``ring`` or ``carrier``, beside bearings of the stage, which turn with it.
    errors : sequence of PlanetError
        One for each planet; by default none.
    positions : int
        At equal angles over one turn.
    weights : mapping of str to (6,) array_like
        Forces and moments on centres of members, such as ``planet 1``, that keep their direction in
        space, in the axes of the stage at the first position, N and N m.
    carried : mapping of str to (6,) array_like
        The same of those that turn with the carrier, such as centrifugal forces.

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
    _refuse_misfit(stage)
    frozen("the torque on the sun", torque, ())
    supports = supports or {}
    unknown = supports.keys() - set(CENTRAL)
    if unknown:
        raise SolidgearError(
            f"{min(unknown)!r} has no support; {listed(list(CENTRAL))} may have one"
        )
    if positions < 1:
        raise SolidgearError(f"{positions} positions; give 1 or more")
    errors = errors or [PlanetError()] * len(stage.planets)
    if len(errors) != len(stage.planets):
        raise SolidgearError(
            f"{len(errors)} errors for {len(stage.planets)} planets; give each its own"
        )
    mean = {name: _mean(fixed.matrix) for name, fixed in supports.items()}
    members = {name: getattr(stage, name) for name in supports}
    system = replace(
        stage,
        **{
            name: replace(member, bearing=member.support + mean[name], turning=0.0)
            for name, member in members.items()
        },
    ).system
    strains, rows_of = system.strains
    gaps = _gaps(len(strains), rows_of, stage, errors)
    motions = [system.motion(f"{name}.centre") for name in supports]
    roots = [root_of(matrix) for matrix in mean.values()]
    rows = np.vstack(
        [np.zeros((0, system.size)), *(root.T @ motion for root, motion in zip(roots, motions))]
    )
    angle = 2 * np.pi * np.arange(positions) / positions
    turns = np.array([rotation(1, a) for a in angle])
    always, *swinging = _swinging(system, stage, weights or {})
    always += system.load({"sun.centre": np.array([0, 0, 0, 0, torque, 0])})
    always += _load(system, stage, carried or {})
    loads = [_balanced(system, load) for load in (always, *swinging)]
    loads[0] -= strains.T @ gaps
    solution = system.static(np.column_stack([*loads, rows.T]))
    moved, give = solution[:, : len(loads)] @ _swing(angle), solution[:, len(loads) :]
    loads_beyond = _loads_beyond_mean(
        turns, list(supports.values()), roots, (rows @ moved).T, rows @ give
    )
    moved = moved + give @ loads_beyond.T
    shift, support = {}, {}
    for (name, fixed), motion in zip(supports.items(), motions):
        shift[name] = np.einsum("aij,ja->ai", turns, motion @ moved)
        support[name] = (shift[name] - fixed.off) @ fixed.matrix
    springs = (strains @ moved).T + gaps
    return _turn(stage, angle, springs, rows_of, shift, support)


def _refuse_misfit(stage: PlanetaryStage) -> None:
    """Refuse tooth forces that are no pairs on one line."""
    worst = max(map(abs, stage.apart))
    if worst > ONE_LINE * stage.carrier.radius:
        raise SolidgearError(
            f"base circles, pressure angle and pins do not fit: lines of action that should be one "
            f"are {1e3 * worst:.3g} mm apart, so that torques would not balance"
        )


def _load(system: System, stage: PlanetaryStage, forces: Mapping[str, ArrayLike]) -> np.ndarray:
    """Return the load (N,) of forces (6,) on centres of members in the axes of the stage."""
    out = np.zeros(system.size)
    for name, six in forces.items():
        if name not in stage.parts:
            raise SolidgearError(
                f"{name!r} is no member to be loaded; {listed([*stage.parts])} are"
            )
        axes = np.kron(np.eye(2), system.port(f"{name}.centre").axes)
        out += system.load({f"{name}.centre": axes.T @ frozen(f"the load of {name}", six, (6,))})
    return out


def _swinging(
    system: System, stage: PlanetaryStage, weights: Mapping[str, ArrayLike]
) -> list[np.ndarray]:
    """Return the loads (N,) of forces that keep their direction in space: the part constant over
    positions, and those that go with the cosine and the sine of the position.
    """
    arrays = {name: frozen(f"the weight of {name}", six, (6,)) for name, six in weights.items()}
    axial = np.diag([0.0, 1.0, 0.0, 0.0, 1.0, 0.0])
    across, quarter = np.eye(6) - axial, rotation(1, np.pi / 2).T
    ways = (axial, across, quarter @ across)
    return [_load(system, stage, {name: way @ six for name, six in arrays.items()}) for way in ways]


def _swing(angle: np.ndarray) -> np.ndarray:
    """Return (3, a) shares of the loads of :func:`_swinging` at positions."""
    return np.array([np.ones_like(angle), np.cos(angle), np.sin(angle)])


def _balanced(system: System, load: np.ndarray) -> np.ndarray:
    """Return a load with the reaction that balances the torque on a member that is free to turn."""
    for name in ("carrier", "ring"):
        motion = system.motion(f"{name}.centre")[4]
        freely = motion @ system.free
        if np.linalg.norm(freely) > TURNS:
            return load - motion * (load @ system.free @ freely) / (freely @ freely)
    return load


def _gaps(size: int, rows_of, stage: PlanetaryStage, errors: Sequence[PlanetError]) -> np.ndarray:
    """Return the strain (r,) of rows that errors make where nothing moves."""
    out = np.zeros(size)
    for k, (planet, error) in enumerate(zip(stage.planets, errors), 1):
        (away, forward), (about_away, about_forward) = error.pin, error.tilt
        error_motion = np.array([away, 0.0, -forward, about_away, 0.0, -about_forward])
        out[rows_of[f"planet {k} pin"]] = -root_of(planet.support).T @ error_motion
        for mate in ("sun", "ring"):
            rows = rows_of[f"planet {k} {mate} mesh"]
            stiffness = getattr(planet, f"{mate}_mesh")
            out[rows] = _root_share(stiffness, rows) * getattr(error, f"{mate}_tooth")
    return out


def _root_share(stiffness: float, rows: slice) -> float:
    """Return the root of the share of each spring of a mesh in the stiffness."""
    return float(np.sqrt(stiffness / max(rows.stop - rows.start, 1)))


def _mean(matrix: np.ndarray) -> np.ndarray:
    """Return the mean (6, 6) of a stiffness over a turn: a quarter turn cancels two harmonics."""
    quarters = [rotation(1, k * np.pi / 2) for k in range(4)]
    mean = sum((turn.T @ matrix @ turn for turn in quarters), np.zeros((6, 6))) / 4
    return (mean + mean.T) / 2


def _loads_beyond_mean(
    turns: np.ndarray,
    supports: Sequence[FixedSupport],
    roots: Sequence[np.ndarray],
    motions: np.ndarray,
    give: np.ndarray,
) -> np.ndarray:
    """Return loads (a, s) on the stage beyond the mean bearings ``L L'``, in the coordinates
    ``L'u`` in which these are one; from ``L'u`` (a, s) under load and (s, s) under unit loads.
    """
    size = len(give)
    stiffness, pressed = np.zeros((len(turns), size, size)), np.zeros((len(turns), size))
    start = 0
    for fixed, root in zip(supports, roots):
        place = slice(start, start := start + root.shape[1])
        to_stage = np.linalg.pinv(root) @ turns.transpose(0, 2, 1)
        stiffness[:, place, place] = to_stage @ fixed.matrix @ to_stage.transpose(0, 2, 1)
        pressed[:, place] = to_stage @ (fixed.matrix @ fixed.off)
    excess = stiffness - np.eye(size)
    right = motions + pressed @ give.T
    moved = np.linalg.solve(np.eye(size) + give @ excess, right[..., None])[..., 0]
    return pressed - np.einsum("aij,aj->ai", excess, moved)


def _turn(
    stage: PlanetaryStage, angle, springs: np.ndarray, rows_of, shift, support
) -> CarrierTurn:
    """Return forces from the strains (a, r) of all rows."""
    forces: dict[str, list[np.ndarray]] = {"sun": [], "ring": []}
    pins = []
    for k, planet in enumerate(stage.planets, 1):
        for mate, mesh_forces in forces.items():
            rows = rows_of[f"planet {k} {mate} mesh"]
            root_share = _root_share(getattr(planet, f"{mate}_mesh"), rows)
            mesh_forces.append(root_share * springs[:, rows].sum(axis=1))
        pins.append(springs[:, rows_of[f"planet {k} pin"]] @ root_of(planet.support).T)
    sun, ring = (np.column_stack(mesh_forces) for mesh_forces in forces.values())
    pin = np.stack(pins, axis=1)
    across = cos(stage.base_helix)
    torque = {
        "sun": -sun.sum(axis=1) * across * stage.sun.radius,
        "ring": -ring.sum(axis=1) * across * stage.ring.radius,
        "carrier": -pin[:, :, 2].sum(axis=1) * stage.carrier.radius,
    }
    return CarrierTurn(angle, sun, ring, pin, shift, support, torque)
