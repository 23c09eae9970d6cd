"""Surfaces and lines in pixels, seen by parallel rays: what is nearer hides what is behind it.

Every pixel is the mean of some samples, each of the nearest surface there. Numbers are linear over a
triangle; they are found from scan lines, all triangles at once.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

#: samples across a pixel, and down it
FINE = 2
#: samples that are looked at together
BATCH = 250_000
#: nearer than any surface, samples
TOP = 1e9


class Aim(NamedTuple):
    """Directions right, up and towards the viewer, the point (3,) in the middle, pixels per metre."""

    right: np.ndarray
    upward: np.ndarray
    back: np.ndarray
    middle: np.ndarray
    scale: float


class Canvas:
    """A picture that is being drawn, white at first.

    Parameters
    ----------
    width, height : int
        px.
    aim : Aim
    """

    def __init__(self, width: int, height: int, aim: Aim):
        self.width, self.height, self.aim = FINE * width, FINE * height, aim
        self.colour = np.ones((self.width * self.height, 3), np.float32)
        self.depth = np.full(self.width * self.height, -np.inf, np.float32)

    def places(self, points: np.ndarray) -> np.ndarray:
        """Return (n, 3) places of points across and down, in samples, and how near they are."""
        aim, fine = self.aim, FINE * self.aim.scale
        away = points - aim.middle
        across, up, near = (away @ axis * fine for axis in (aim.right, aim.upward, aim.back))
        return np.stack([across + self.width / 2, self.height / 2 - up, near], axis=-1)

    def fill(self, points: np.ndarray, triangles: np.ndarray, values: np.ndarray, shade) -> None:
        """Draw triangles; `shade` gives colours (n, 3) for values (n, k), interpolated from those of
        corners (m, 3, k).
        """
        self._fill(self.places(points)[triangles], values, shade)

    def _fill(self, corners: np.ndarray, values: np.ndarray, shade) -> None:
        # what is near comes first: of what is behind it, only the depth is found
        order = np.argsort(-corners[:, :, 2].sum(axis=1))
        corners, values = corners[order].astype(np.float64), values[order]
        spans = _spans(corners, self.width, self.height)
        slope, start = _planes(corners, np.concatenate([corners[:, :, 2:], values], axis=2), spans)
        ends = np.cumsum(spans.samples)
        batches = np.searchsorted(ends, np.arange(BATCH, ends[-1] if len(ends) else 0, BATCH))
        for part in np.split(np.arange(len(ends)), batches):
            count = spans.samples[part]
            step = _steps(count)
            along = step.astype(np.float32)
            index = np.repeat(spans.row[part] * self.width + spans.left[part], count) + step
            near = np.repeat(start[part, 0], count) + np.repeat(slope[part, 0], count) * along
            np.maximum.at(self.depth, index, near)
            seen = np.flatnonzero(near == self.depth[index])
            line = np.repeat(part, count)[seen]
            self.colour[index[seen]] = shade(start[line, 1:] + slope[line, 1:] * along[seen, None])

    def lines(
        self,
        points: np.ndarray,
        pairs: np.ndarray,
        colour: str,
        width: float,
        opacity: float = 1.0,
        nearer: float = 0.0,
    ) -> None:
        """Draw lines between pairs of points, so many pixels wide; where they lie on a surface they
        are brought nearer, m.
        """
        ends = self.places(points)[pairs]
        ends[:, :, 2] += nearer * FINE * self.aim.scale
        steps = np.ceil(np.abs(np.diff(ends[:, :, :2], axis=1)).max(axis=(1, 2))).astype(int)
        way = np.diff(ends, axis=1)[:, 0] / np.maximum(steps, 1)[:, None]
        count = steps + 1
        places = np.repeat(ends[:, 0], count, axis=0)
        places += np.repeat(way, count, axis=0) * _steps(count)[:, None]
        across, down = np.floor(places[:, :2].T).astype(int)
        near = places[:, 2].astype(np.float32)
        drawn = np.zeros(len(self.depth), bool)
        reach = FINE * width / 2
        around = range(-int(reach), int(reach) + 1)
        for dx, dy in ((dx, dy) for dx in around for dy in around if np.hypot(dx, dy) <= reach):
            x, y = across + dx, down + dy
            inside = (x >= 0) & (x < self.width) & (y >= 0) & (y < self.height)
            index = (y * self.width + x)[inside]
            drawn[index[near[inside] >= self.depth[index]]] = True
        where = np.flatnonzero(drawn)
        self.colour[where] += opacity * (rgb(colour) - self.colour[where])

    def arrow(self, start: tuple[float, float], way: np.ndarray, colour: str, width: float) -> None:
        """Draw an arrow on top of all, from a place by a way (2,) in pixels."""
        long = np.hypot(*way)
        along, aside = way, width / 2 * np.array([-way[1], way[0]]) / long
        head = max(1 - 3.6 * width / long, 0.3)
        shaft = [aside, -aside, head * along + aside, head * along - aside]
        tip = [head * along + 3.2 * aside, head * along - 3.2 * aside, along]
        corners = np.full((3, 3, 3), TOP)
        for k, triangle in enumerate((shaft[:3], shaft[1:], tip)):
            corners[k, :, :2] = FINE * (np.array(start) + np.array(triangle))
        shown = np.broadcast_to(rgb(colour), (3, 3, 3))
        self._fill(corners, shown, lambda value: value)

    def pixels(self) -> np.ndarray:
        """Return the picture (height, width, 3), 0 to 255."""
        samples = self.colour.reshape(self.height, self.width, 3)
        parts = [samples[i::FINE, k::FINE] for i in range(FINE) for k in range(FINE)]
        return np.rint((255 / len(parts)) * sum(parts)).clip(0, 255).astype(np.uint8)


class Spans(NamedTuple):
    """Scan lines within triangles: the triangle of each, and its samples."""

    triangle: np.ndarray
    row: np.ndarray
    left: np.ndarray  #: first sample
    samples: np.ndarray  #: how many


def _spans(corners: np.ndarray, width: int, height: int) -> Spans:
    """Return the scan lines of triangles (m, 3, 3) on paper of a size, in samples."""
    x, y = corners[:, :, 0], corners[:, :, 1]
    first = np.ceil(y.min(axis=1) - 0.5).clip(0).astype(int)
    last = np.floor(y.max(axis=1) - 0.5).clip(max=height - 1).astype(int)
    count = (last - first + 1).clip(0)
    which = np.repeat(np.arange(len(first)), count)
    row = np.repeat(first, count) + _steps(count)
    down = row + 0.5
    low, high = np.full(len(row), np.inf), np.full(len(row), -np.inf)
    for a in range(3):
        b = (a + 1) % 3
        rise = y[:, b] - y[:, a]
        lean = (x[:, b] - x[:, a]) / np.where(rise == 0, np.inf, rise)
        over, under = np.minimum(y[:, a], y[:, b])[which], np.maximum(y[:, a], y[:, b])[which]
        met = (over <= down) & (down <= under) & (rise != 0)[which]
        at = (x[:, a] - lean * y[:, a])[which] + lean[which] * down
        low = np.where(met, np.minimum(low, at), low)
        high = np.where(met, np.maximum(high, at), high)
    met = low <= high
    left = np.ceil(low[met] - 0.5).clip(0).astype(int)
    count = (np.floor(high[met] - 0.5).clip(max=width - 1).astype(int) - left + 1).clip(0)
    some = count > 0
    which, row = which[met][some], row[met][some]
    return Spans(which, row, left[some], count[some])


def _planes(corners, values, spans: Spans) -> tuple[np.ndarray, np.ndarray]:
    """Return what values (m, 3, k) gain from sample to sample of scan lines, and what they are at
    the first.
    """
    x, y = corners[:, :, 0], corners[:, :, 1]
    a, b = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]
    c, d = y[:, 1] - y[:, 0], y[:, 2] - y[:, 0]
    size = a * d - b * c
    size[size == 0] = np.inf
    u, v = values[:, 1] - values[:, 0], values[:, 2] - values[:, 0]
    right = u * (d / size)[:, None] - v * (c / size)[:, None]
    lower = v * (a / size)[:, None] - u * (b / size)[:, None]
    which = spans.triangle
    dx, dy = spans.left + 0.5 - x[which, 0], spans.row + 0.5 - y[which, 0]
    start = values[which, 0] + right[which] * dx[:, None] + lower[which] * dy[:, None]
    return right[which].astype(np.float32), start.astype(np.float32)


def _steps(count: np.ndarray) -> np.ndarray:
    """Return 0, 1, 2 ... up to each count, one after another."""
    ends = np.cumsum(count)
    return np.arange(ends[-1] if len(ends) else 0, dtype=np.int32) - np.repeat(ends - count, count)


def rgb(colour: str) -> np.ndarray:
    """Return red, green and blue, 0 to 1, of a colour such as ``#ff8000``."""
    return np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)], np.float32) / 255


class Facets(NamedTuple):
    """Faces of a surface: their corners, the edges between them, and how they stand."""

    triangles: np.ndarray  #: (m, 3) of all faces, the halves of quadrilaterals too
    owner: np.ndarray  #: (m,) face of every triangle
    normal: np.ndarray  #: (f, 3) of every face, of length one; zero where it has no area
    edges: np.ndarray  #: (e, 2) between two faces
    beside: np.ndarray  #: (e, 2) those faces

    def creases(self, degrees: float) -> np.ndarray:
        """Return edges at which faces differ by more than an angle."""
        first, second = self.normal[self.beside[:, 0]], self.normal[self.beside[:, 1]]
        return self.edges[(first * second).sum(axis=1) < np.cos(np.deg2rad(degrees))]

    def horizon(self, back: np.ndarray) -> np.ndarray:
        """Return edges between a face that a viewer sees and one that he does not."""
        seen = (self.normal @ back > 0)[self.beside]
        return self.edges[seen[:, 0] != seen[:, 1]]

    def smooth(self, degrees: float) -> np.ndarray:
        """Return normals (m, 3, 3) at corners of triangles: the mean of the faces around that differ
        from the own face by less than an angle.
        """
        corner = self.triangles.ravel()
        face = np.repeat(self.owner, 3)
        order = np.argsort(corner, kind="stable")
        first = np.searchsorted(corner[order], corner)
        count = np.searchsorted(corner[order], corner, side="right") - first
        which, place = (
            np.repeat(np.arange(len(corner)), count),
            np.repeat(first, count) + _steps(count),
        )
        others, own = self.normal[face[order[place]]], self.normal[face[which]]
        near = (others * own).sum(axis=1) > np.cos(np.deg2rad(degrees))
        sums = [np.bincount(which[near], others[near, k], len(corner)) for k in range(3)]
        return _unit(np.column_stack(sums)).reshape(-1, 3, 3)


def facets(points: np.ndarray, quads: np.ndarray, triangles: np.ndarray) -> Facets:
    """Return the faces of a surface, quadrilaterals first."""
    a, b, c, d = points[quads].transpose(1, 0, 2)
    normals = [np.cross(c - a, d - b)]
    a, b, c = points[triangles].transpose(1, 0, 2)
    normals.append(np.cross(b - a, c - a))
    faces = np.arange(len(quads)), len(quads) + np.arange(len(triangles))
    halves = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]], triangles])
    owner = np.concatenate([faces[0], faces[0], faces[1]])
    pairs, of = [], []
    for cells, numbers in zip((quads, triangles), faces):
        pairs.append(np.stack([cells, np.roll(cells, -1, axis=1)], axis=2).reshape(-1, 2))
        of.append(np.repeat(numbers, cells.shape[1]))
    ends, face = np.sort(np.concatenate(pairs), axis=1), np.concatenate(of)
    key = ends[:, 0] * len(points) + ends[:, 1]
    order = np.argsort(key, kind="stable")
    twice = (
        order[:-1][key[order[:-1]] == key[order[1:]]],
        order[1:][key[order[:-1]] == key[order[1:]]],
    )
    beside = np.column_stack([face[twice[0]], face[twice[1]]])
    return Facets(halves, owner, _unit(np.concatenate(normals)), ends[twice[0]], beside)


def _unit(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)
