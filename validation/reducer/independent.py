"""Bodies in contact by another integrator: adaptive, of many orders, force law written out anew."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

from validation.reducer.stepping import Bodies


def envelope(bodies: Bodies, turns: float, instants: int, tolerance: float = 1e-7):
    """(instants, m) contact forces of the first design from rest on, N, at equal angles."""
    solid = np.linalg.inv(bodies.mass[0])
    damping, stiffness, drive = bodies.damping[0], bodies.stiffness[0], bodies.drive[0]
    still, cosine, sine = bodies.rows[:, 0]
    law, w = bodies.law, bodies.speed[0]
    orders = np.outer(np.arange(1, len(bodies.cycle) + 1), bodies.order[0])
    size, late = np.abs(bodies.cycle[:, 0]), np.angle(bodies.cycle[:, 0])
    n = len(stiffness)

    def forces(t, q, v):
        a = w * t
        rows = still + cosine * np.cos(a) + sine * np.sin(a)
        turning = w * (sine * np.cos(a) - cosine * np.sin(a))
        off, turn = bodies.error[0], 1j * bodies.error_order[0]
        s = rows @ q - (off * np.exp(turn * a)).real
        rate = rows @ v + turning @ q - w * (turn * off * np.exp(turn * a)).real
        depth = np.clip(s - law.half_gap, 0.0, None)
        u = np.clip(depth / law.ramp, 0.0, 1.0)
        teeth = 1 + (size * np.cos(orders * a + late)).sum(axis=0)
        push = depth**1.5 + law.damper * (3 * u**2 - 2 * u**3) * rate
        behind = np.clip(-s - law.half_gap, 0.0, None)
        u = np.clip(behind / law.ramp, 0.0, 1.0)
        back = behind**1.5 - law.damper * (3 * u**2 - 2 * u**3) * rate
        force = np.clip(push, 0.0, None) * (depth > 0) - np.clip(back, 0.0, None) * (behind > 0)
        return rows, drive * teeth * force

    def slope(t, y):
        q, v = y[:n], y[n:]
        rows, force = forces(t, q, v)
        load = (
            bodies.load[0, 0]
            + bodies.load[1, 0] * np.cos(w * t)
            + bodies.load[2, 0] * np.sin(w * t)
        )
        return np.concatenate([v, solid @ (load - damping @ v - stiffness @ q - rows.T @ force)])

    times = np.arange(instants) / instants * turns * 2 * np.pi / w
    begin = np.concatenate([bodies.rest()[0], np.zeros(n)])
    found = solve_ivp(
        slope, (0.0, times[-1]), begin, "LSODA", times, rtol=tolerance, atol=1e-4 * tolerance
    )
    return np.array([forces(t, y[:n], y[n:])[1] for t, y in zip(times, found.y.T)])
