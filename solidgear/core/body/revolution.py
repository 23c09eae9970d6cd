"""A surface of revolution that moves by harmonics.

It moves by ``u_r = U cos n(t - t0), u_t = -V sin n(t - t0) + S, u_y = W cos n(t - t0)`` with ``z =
r cos t, x = r sin t``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from solidgear.core.body.surface import Surface

TURNS = 48
MERIDIANS = 12
#: rad; of the points of a circle
TURN = 2 * np.pi * np.arange(TURNS) / TURNS


@dataclass(frozen=True, eq=False)
class Rings:
    """Circles around the axis, and pieces of meridian between them."""

    r: np.ndarray  #: m
    y: np.ndarray  #: m
    pieces: np.ndarray  #: (k, 2) circles at both ends, material on the left
    drawn: np.ndarray  #: circles to draw

    @cached_property
    def on_axis(self) -> np.ndarray:
        """Whether a ring has no radius, and is one point."""
        return self.r <= 1e-9 * self.r.max()

    @cached_property
    def ring(self) -> np.ndarray:
        """The ring of every point of the surface."""
        return np.repeat(np.arange(len(self.r)), np.where(self.on_axis, 1, TURNS))

    @cached_property
    def step(self) -> np.ndarray:
        """How many points of its ring stand before every point."""
        return np.arange(len(self.ring)) - self._first[self.ring]

    @cached_property
    def _first(self) -> np.ndarray:
        return np.searchsorted(self.ring, np.arange(len(self.r)))

    @cached_property
    def at_rest(self) -> Surface:
        """The surface that they sweep."""
        on_axis, first = self.on_axis, self._first
        r, y, t = np.where(on_axis, 0.0, self.r)[self.ring], self.y[self.ring], TURN[self.step]
        points = np.column_stack([r * np.sin(t), y, r * np.cos(t)])
        turn = np.arange(TURNS)

        def point(which, k):
            return first[which][:, None] + np.where(on_axis[which][:, None], 0, k % TURNS)

        a, b = self.pieces[~on_axis[self.pieces].all(axis=1)].T
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
        circles = self.drawn[~on_axis[self.drawn]]
        lines = [
            np.stack([point(a, spokes), point(b, spokes)], axis=-1),
            np.stack([point(circles, turn), point(circles, turn + 1)], axis=-1),
        ]
        lines_of_all = np.concatenate([x.reshape(-1, 2) for x in lines])
        return Surface(points, np.zeros_like(points), faces, triangles, lines_of_all)


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


def revolve(rings: Rings, waves: list[Wave]) -> Surface:
    """Sweep rings around the axis and move them by waves."""
    ring, step = rings.ring, rings.step
    out = np.zeros((3, len(ring)))  # radial, tangential, axial
    for w in waves:
        phase = w.n * (TURN - w.start)
        cos, sin = np.cos(phase)[step], np.sin(phase)[step]
        out[0] += w.radial[ring] * cos
        out[1] += w.swirl[ring] - w.tangential[ring] * sin
        out[2] += w.axial[ring] * cos
    cos, sin = np.cos(TURN)[step], np.sin(TURN)[step]
    moved = [out[0] * sin + out[1] * cos, out[2], out[0] * cos - out[1] * sin]
    return replace(rings.at_rest, displacement=np.column_stack(moved))
