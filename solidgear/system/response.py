r"""Steady motion of a system under a load that oscillates.

In modes, ``u = sum_r phi_r (phi_r' f) / (w_r^2 - w^2)`` over all modes of the system, those of
residual fields among them, so that no static remainder is missing.  Damping is structural, a
stiffness ``(1 + i eta) K``:

- a damping ratio zeta counts as loss factor 2 zeta of every mode, ``w_r^2 (1 + 2 i zeta)``, which
  is what viscous damping is at resonance;
- a loss factor of a part or link adds ``i eta K_j``, a full matrix in modes.  It does not depend on
  frequency, so one complex symmetric eigenproblem ``(diag(w^2) + i H) v = mu v`` with ``v'v = 1``
  (no conjugation) serves all frequencies, exactly.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from solidgear.errors import SolidgearError

if TYPE_CHECKING:
    from solidgear.system.system import System

#: Work of a load on a free motion, relative to the largest it could do, that is rounding.
UNBALANCED = 1e-9


def response(
    system: System,
    frequency_hz: np.ndarray,
    load: np.ndarray,
    damping: float,
    loss: Mapping[str, float],
) -> np.ndarray:
    """Amplitudes of all coordinates over frequency.

    Parameters
    ----------
    system : System
    frequency_hz : (f,) ndarray
        Not negative.
    load : (N,) array_like
        Amplitudes, complex for phases; as from :meth:`solidgear.system.System.load`.
    damping : float
        Damping ratio zeta of every elastic mode.
    loss : mapping of str to float
        Loss factor eta of parts and links.

    Returns
    -------
    (f, N) complex ndarray
        Amplitudes q of ``q exp(i w t)``: times ``system.motion(end).T`` the motion of a port.

    Raises
    ------
    SolidgearError
        At 0 Hz if a free motion is driven, on a resonance without damping, for an unknown name, or
        numbers that are not.

    Examples
    --------
    >>> from solidgear.system import Inertia, System, torsion_spring
    >>> fan = System({"fan": Inertia(2.0)}, {"shaft": torsion_spring("fan", 400.0)})
    >>> push = fan.load({"fan": [0, 0, 0, 0, 1, 0]})
    >>> abs(fan.response([0.0], push, loss={"shaft": 0.75})[0, 0]) * 400    # 1 / |1 + 0.75 i|
    np.float64(0.8)
    """
    for name, amount in {"damping": damping, **loss}.items():
        if not (np.isfinite(amount) and amount >= 0):
            raise SolidgearError(f"{name} is {amount}; damping is finite and not negative")
    omega, elastic = system.elastic
    value, shapes = omega**2 * (1 + 2j * damping), elastic
    if loss:
        value, turn = np.linalg.eig(np.diag(value) + 1j * lost_stiffness(system, loss))
        shapes = elastic @ (turn / np.sqrt(np.einsum("ij,ij->j", turn, turn)))
    w2 = (2 * np.pi * frequency_hz) ** 2
    load = np.asarray(load)
    gap = value[:, None] - w2
    if np.any(gap == 0):
        raise SolidgearError(
            "a frequency is that of a mode, and nothing damps it; give damping or loss"
        )
    return (shapes @ ((shapes.T @ load)[:, None] / gap) + free_motion(system, w2, load)).T


def free_motion(
    system: System, w2: np.ndarray, load: np.ndarray, rows: np.ndarray | None = None
) -> np.ndarray:
    """Accelerations of free motions, twice integrated; of all coordinates, or seen by some rows."""
    push = system.free.T @ load
    if np.any(w2 == 0):
        if np.abs(push).max(initial=0.0) > UNBALANCED * np.linalg.norm(system.elastic[1].T @ load):
            raise SolidgearError(
                "at 0 Hz the load drives a motion that nothing resists; leave 0 Hz out"
            )
    moving = np.where(w2 > 0, w2, 1.0)
    free = system.free if rows is None else rows @ system.free
    return free @ (push[:, None] * (w2 > 0) / -moving)


def lost_stiffness(system: System, loss: Mapping[str, float]) -> np.ndarray:
    """``sum eta_j K_j`` in elastic modes."""
    g, where = system.strains
    shapes = system.elastic[1]
    out = np.zeros((shapes.shape[1],) * 2)
    for name, eta in loss.items():
        if name not in system.parts and name not in system.links:
            raise SolidgearError(f"a loss factor for {name!r}, which is no part and no link")
        if name in where:
            stretch = g[where[name]] @ shapes
            out += eta * (stretch.T @ stretch)
    return out
