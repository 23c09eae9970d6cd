"""A surface of revolution that moves by harmonics.

It moves by ``u_r = U cos n(t - t0), u_t = -V sin n(t - t0) + S, u_y = W cos n(t - t0)`` with ``z =
r cos t, x = r sin t``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.core.body.surface import Surface

TURNS = 48
MERIDIANS = 12


@dataclass(frozen=True)
class Rings:
    """Circles around the axis, and pieces of meridian between them."""

    r: np.ndarray  #: m
    y: np.ndarray  #: m
    pieces: np.ndarray  #: (k, 2) circles at both ends, material on the left
    drawn: np.ndarray  #: circles to draw


@dataclass(frozen=True)
class Wave:
    """Amplitudes on every ring of one term of the sum in the module's docstring."""

    n: int
    start: float
    radial: np.ndarray
    tangential: np.ndarray
    axial: np.ndarray
    swirl: np.ndarray


def wave(n, start, radial, tangential, axial, swirl=0.0) -> Wave:
    arrays = np.broadcast_arrays(
        *(np.asarray(a, float) for a in (radial, tangential, axial, swirl))
    )
    radial, tangential, axial, swirl = arrays
    return Wave(n, start, radial, tangential, axial, swirl)


def _on_axis(rings: Rings) -> np.ndarray:
    return rings.r <= 1e-9 * rings.r.max()


def ring_of(rings: Rings) -> np.ndarray:
    """Return the ring of every point of the surface."""
    return np.repeat(np.arange(len(rings.r)), np.where(_on_axis(rings), 1, TURNS))


def revolve(rings: Rings, waves: list[Wave]) -> Surface:
    """Sweep rings around the axis; a ring of no radius is one point."""
    on_axis, ring = _on_axis(rings), ring_of(rings)
    first = np.searchsorted(ring, np.arange(len(on_axis)))
    step = np.arange(len(ring)) - first[ring]
    t = 2 * np.pi * step / TURNS
    r, y = np.where(on_axis, 0.0, rings.r)[ring], rings.y[ring]
    out = np.zeros((3, len(ring)))  # radial, tangential, axial
    for w in waves:
        cos, sin = np.cos(w.n * (t - w.start)), np.sin(w.n * (t - w.start))
        out[0] += w.radial[ring] * cos
        out[1] += w.swirl[ring] - w.tangential[ring] * sin
        out[2] += w.axial[ring] * cos
    points = np.column_stack([r * np.sin(t), y, r * np.cos(t)])
    displacement = np.column_stack(
        [out[0] * np.sin(t) + out[1] * np.cos(t), out[2], out[0] * np.cos(t) - out[1] * np.sin(t)]
    )

    turn = np.arange(TURNS)

    def point(which, k):
        return first[which][:, None] + np.where(on_axis[which][:, None], 0, k % TURNS)

    a, b = rings.pieces[~on_axis[rings.pieces].all(axis=1)].T
    quads = np.stack(
        [point(a, turn), point(a, turn + 1), point(b, turn + 1), point(b, turn)], axis=-1
    )
    from_axis, to_axis = on_axis[a], on_axis[b]
    faces = quads[~(from_axis | to_axis)].reshape(-1, 4)
    triangles = np.concatenate(
        [
            quads[from_axis][:, :, [0, 2, 3]].reshape(-1, 3),
            quads[to_axis][:, :, [0, 1, 2]].reshape(-1, 3),
        ]
    )
    spokes = np.arange(0, TURNS, TURNS // MERIDIANS)
    circles = rings.drawn[~on_axis[rings.drawn]]
    lines = [
        np.stack([point(a, spokes), point(b, spokes)], axis=-1),
        np.stack([point(circles, turn), point(circles, turn + 1)], axis=-1),
    ]
    return Surface(
        points, displacement, faces, triangles, np.concatenate([x.reshape(-1, 2) for x in lines])
    )
