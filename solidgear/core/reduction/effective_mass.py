"""Effective mass and inertia at the lumped point: the thesis's equations, mode-matched, Guyan, and
total.

In a bending plane the lumped model is ``K_a - w^2 D`` on (z, phi), with K_a the static stiffness at
the lumped point and D the 2x2 mass. Hua (2010) asks in equations 52 and 53 for ``D = diag(M, I)``
such that

    M z^2 + I phi^2 = u'Mu  (= 1 here: kinetic energy of the first bending mode u)           (52)
    det(K_a - w1^2 D) = 0   with w1 the first natural frequency of the model                 (53)

**These have no solution in general.**  Let v = (z, phi) be the motion of the lumped point in the
mode.  Of all shapes with that motion at the lumped point the static one stores the least energy, so

    v' K_a v <= u'Ku = w1^2 u'Mu,

with equality only if the mode *is* a static shape. With (52), ``v' D v = u'Mu``, hence ``v'(K_a -
w1^2 D) v <= 0``: unless equality holds the matrix is indefinite or worse at w1, and w1 cannot be
the first frequency of the model. In the scaled unknowns ``x = M z^2, y = I phi^2`` with ``A = K_zz
z^2 / w1^2``, ``B = K_pp phi^2 / w1^2``, ``C = K_zp z phi / w1^2`` the inequality reads ``A + B + 2C
<= 1`` and (52), (53) become ``x + y = 1``, ``(A - x)(B - y) = C^2``, a quadratic in x with
discriminant ``(A + B - 1)^2 - 4 C^2``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import scipy.linalg as sla

from solidgear.core.body import Body, as_supports
from solidgear.core.body.supports import Holding
from solidgear.core.machine.threads import pinned
from solidgear.core.reduction.lumped_point import LumpedPoint, lumped_point
from solidgear.core.solve.modes import ModeSet
from solidgear.core.solve.statics import condense

METHODS = ("old", "thesis", "mode-matched", "guyan")
#: v' K_a v / w1^2 this close to 1 counts as a static shape: the double root of the quadratic then is
#: real to rounding
STATIC_SHAPE = 1e-9


@dataclass(frozen=True)
class Synthesis:
    """One lumped model of the first bending mode."""

    method: str  #: ``old``, ``thesis``, ``mode-matched`` or ``guyan``
    #: (2, 2) on (z, thx): kg, kg m, kg m^2.  None when the method has no answer.
    mass: np.ndarray | None
    feasible: bool  #: there is a real mass matrix, positive definite
    #: the frequency below is the first of the lumped model (a mode-matched pair can place it second)
    first: bool
    frequency_hz: float | None  #: first natural frequency of the lumped model
    frequency_error: float | None  #: against first bending of the body, relative
    slope_error: float | None  #: of phi / z at the lumped point against the mode, relative
    #: ``v' D v - 1``: kinetic energy of the lumped mass moving with the mode, against that of the
    #: mode
    kinetic_error: float | None
    #: the receptance z/F_z at the lumped point is within 5 per cent of that of the body up to here
    valid_to_hz: float | None
    verdict: str  #: in a sentence
    numbers: dict = field(default_factory=dict)  #: discriminant, roots and the like


def effective_masses(
    point: LumpedPoint, receptance: Callable[[float], float] | None = None
) -> dict[str, Synthesis]:
    """Compute all four lumped models of a first bending mode, in the order of ``METHODS``; the
    range of validity needs ``receptance(omega)`` of the full body, z per unit F_z at the lumped
    point, m/N.
    """
    out = {}
    out["old"] = _judge(
        point,
        "old",
        np.diag([point.total_mass, point.total_inertia]),
        receptance,
        "total mass and inertia",
    )
    out["thesis"] = _thesis(point, receptance)
    matched = point.stiffness @ point.motion / (point.omega**2 * point.motion)
    coupling = point.stiffness[0, 1] * point.motion[0] * point.motion[1]
    text = "a negative entry: no physical mass"
    if np.all(matched > 0):
        text = "keeps first frequency and slope ratio exactly"
    if np.all(matched > 0) and coupling > 0:
        text = "keeps the frequency and the slope ratio, but as the second mode of the lumped model"
    out["mode-matched"] = _judge(point, "mode-matched", np.diag(matched), receptance, text)
    out["guyan"] = _judge(
        point,
        "guyan",
        point.guyan,
        receptance,
        "static condensation, always positive, first frequency from above",
    )
    return out


def _thesis(point: LumpedPoint, receptance) -> Synthesis:
    """Solve equations 52 and 53; see the module docstring for why they usually have no solution."""
    k, (z, phi), w2 = point.stiffness, point.motion, point.omega**2
    a, b, c = k[0, 0] * z * z / w2, k[1, 1] * phi * phi / w2, k[0, 1] * z * phi / w2
    discriminant = (a + b - 1) ** 2 - 4 * c * c
    share = point.static_share
    numbers: dict[str, object] = {"discriminant": float(discriminant), "static_share": share}
    half = (a - b + 1) / 2
    root = np.sqrt(complex(discriminant)) / 2
    numbers["mass_roots"] = [
        [float(((half + s * root) / z**2).real), float(((half + s * root) / z**2).imag)]
        for s in (1, -1)
    ]
    if abs(1 - share) <= STATIC_SHAPE:
        x = half  # the double root; the mode is a static shape
        mass = np.diag([x / z**2, (1 - x) / phi**2])
        if x > 0 and 1 - x > 0 and c <= 0:
            return _judge(
                point,
                "thesis",
                mass,
                receptance,
                "equations 52 and 53 hold: the mode is a static shape",
                numbers,
            )
        return _none(
            "thesis",
            "the mode is a static shape, but its pair is not positive or not the first",
            numbers,
        )
    if discriminant < 0:
        text = f"no real pair: discriminant {discriminant:.3g} < 0"
    else:
        xs = [half + s * np.sqrt(discriminant) / 2 for s in (1, -1)]
        signs = "positive" if any(0 < x < 1 for x in xs) else "no positive pair"
        text = f"real roots ({signs}), but the frequency asked for is not the first of the model"
    return _none(
        "thesis", f"{text}; v'Kv is {share:.4f} of w1^2 u'Mu, and only 1 would do", numbers
    )


def _none(method, verdict, numbers) -> Synthesis:
    return Synthesis(
        method=method,
        mass=None,
        feasible=False,
        first=False,
        frequency_hz=None,
        frequency_error=None,
        slope_error=None,
        kinetic_error=None,
        valid_to_hz=None,
        verdict=verdict,
        numbers=numbers,
    )


def _judge(point: LumpedPoint, method, mass, receptance, verdict, numbers=None) -> Synthesis:
    """Solve a lumped model and compare it with the body it came from."""
    k, v = point.stiffness, point.motion
    numbers = dict(numbers or {})
    kinetic = float(v @ mass @ v) - 1
    if np.linalg.eigvalsh(mass)[0] <= 0:
        return replace(_none(method, verdict, numbers), mass=mass, kinetic_error=kinetic)
    w2, shapes = sla.eigh(k, mass)
    nearest = np.argmin(np.abs(np.sqrt(w2) / point.omega - 1))
    shape = shapes[:, 0]
    frequency = np.sqrt(w2[0]) / (2 * np.pi)
    slope = (shape[1] / shape[0]) / (v[1] / v[0]) - 1 if shape[0] and v[0] and v[1] else None
    valid = _valid_to(k, mass, receptance, point.omega) if receptance else None
    first = method != "mode-matched" or nearest == 0
    return Synthesis(
        method=method,
        mass=mass,
        feasible=True,
        first=bool(first),
        frequency_hz=float(frequency),
        frequency_error=float(np.sqrt(w2[0]) / point.omega - 1),
        slope_error=None if slope is None else float(slope),
        kinetic_error=kinetic,
        valid_to_hz=valid,
        verdict=verdict,
        numbers=numbers,
    )


def _valid_to(k, mass, receptance, omega, tolerance: float = 0.05) -> float:
    """Return the highest frequency (Hz) below which the lumped receptance stays within the
    tolerance, searched up to 1.5 times the first mode.
    """
    last = 0.0
    # Half steps, so that no point falls on the resonance itself.
    for w in 1.5 * (np.arange(600) + 0.5) / 600 * omega:
        lumped = np.linalg.inv(k - w * w * mass)[0, 0]
        if abs(lumped / receptance(w) - 1) > tolerance:
            break
        last = w
    return float(last / (2 * np.pi))


@pinned
def synthesise(
    body: Body, supports: Holding, port: str, mode_set: ModeSet | None = None
) -> tuple[LumpedPoint, dict[str, Synthesis]]:
    """Compute the lumped point and all four lumped models of a body, judged against the body itself, in
    the order of ``METHODS``; modes are solved if not given, and refusals are those of
    :func:`lumped_point`.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> point, models = synthesise(sg.build(scene, "timoshenko"), scene, "port")
    >>> models["guyan"].feasible, point.static_share < 1
    (True, True)
    """
    point, mode_set = lumped_point(body, supports, port, mode_set)
    receptance = modal_receptance(body, as_supports(supports), port, mode_set)
    return point, effective_masses(point, receptance)


def modal_receptance(
    body: Body, supports: Holding, port: str, mode_set: ModeSet
) -> Callable[[float], float]:
    """Return the receptance z/F_z (m/N) at a port of a body on supports, as a function of the
    frequency in rad/s: modal superposition, with the static remainder.

    The static part of the modes left out is exact, so the error is of the order of (omega /
    omega_left_out)^4.

    Examples
    --------
    At rest it is the static compliance:

    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> body = sg.build(scene, "euler")
    >>> receptance = modal_receptance(body, scene, "port", sg.modes(body, scene, n=4))
    >>> static = sg.condense(body, scene, "port").compliance[2, 2]
    >>> bool(np.isclose(receptance(0.0), static))
    True
    """
    index = body.port_index(port)
    static = condense(body, supports, port).compliance[2, 2]
    pairs = []
    for mode in (*mode_set.modes, *mode_set.beyond):
        if mode.frequency_hz > 0:
            w2 = (2 * np.pi * mode.frequency_hz) ** 2
            pairs += [(w2, body.port_motions(v)[6 * index + 2] ** 2) for v in mode.vectors]
    w2, strength = np.array(pairs).T

    def receptance(omega: float) -> float:
        # 1 / (w_i^2 - w^2) - 1 / w_i^2, the dynamic surplus of each mode
        return float(static + (strength * omega**2 / (w2 * (w2 - omega**2))).sum())

    return receptance
