"""Motion of the mesh of a harmonic solid with a parameter of the scene.

Nodes follow the ends of segments, seats and sections along the axis, linearly between them, and the
surfaces across it, linearly between the mesh lines that run from joint to joint.
"""

from __future__ import annotations

import numpy as np

from solidgear.core import TOUCH, SolidgearError, coned
from solidgear.variants.sensitivity.harmonic import HarmonicAdjoint, Push


class Motion:
    """Motion of nodes, seats and materials of a harmonic body with one parameter, from the scene a
    little before and after it; refused where places of one mesh line move apart and a rigid or
    section port lies there.
    """

    def __init__(self, adjoint: HarmonicAdjoint, low, high, step: float):
        self.low, self.high, self.step = coned(low), coned(high), step
        self.adjoint = adjoint
        scene = adjoint.scene
        names = ("y0", "y1", "outer0", "outer1", "inner0", "inner1")
        self.segment = self._rate(scene.segments, "segments", names)
        self.station = self._rate(scene.stations, "stations", ("y", "lo", "hi"))

    def _rate(self, items, key: str, names) -> np.ndarray:
        low, high = getattr(self.low, key), getattr(self.high, key)
        if not len(low) == len(high) == len(items):
            raise SolidgearError("the shaft takes another form there")
        a, b = (np.array([[getattr(x, n) for n in names] for x in side]) for side in (low, high))
        return (b - a) / self.step

    def along(self) -> np.ndarray:
        """Return the axial velocity (n,) of the nodes."""
        adjoint, scene = self.adjoint, self.adjoint.scene
        tol = 1e-9 * scene.length
        marks = {0.0: 0.0} | {s.y1: v[1] for s, v in zip(scene.segments, self.segment)}
        for (s, attachment), (y, lo, hi) in zip(adjoint.stations, self.station):
            places = [(s.y, y)] if attachment == "section" else [(s.lo, lo), (s.hi, hi)]
            for place, rate in places:
                near = [m for m in marks if abs(m - place) < tol]
                mark_rate = marks[near[0]] if near else None
                if mark_rate is None:
                    marks[place] = rate
                elif abs(mark_rate - rate) > 1e-6 * max(1.0, abs(rate)) and attachment != "average":
                    raise SolidgearError(
                        f"{s.name} is tied ({attachment}) at a line of the mesh that does not move"
                    )
        self.marks = np.array(sorted(marks))
        self.rates = np.array([marks[m] for m in self.marks])
        return np.interp(adjoint.flat.points[1], self.marks, self.rates)

    def radial(self, axial: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the radial velocity (4, m) of the corners of cells by their segment, and the mean
        (n,) at the nodes.
        """
        adjoint, flat, scene = self.adjoint, self.adjoint.flat, self.adjoint.scene
        by_segment = np.zeros(flat.cells.shape)
        for k, s in enumerate(scene.segments):
            cells = np.flatnonzero(flat.segment == k)
            corner = flat.cells[:, cells]
            t, left, right = adjoint.rings[k]
            y0, y1, *_ = self.segment[k]
            rate = (1 - t) * self._across(k, 0, left) + t * self._across(k, 1, right)
            # a node that slides along a cone follows it
            slope = (right - left) / s.length
            by_segment[:, cells] = rate + slope * (axial[corner] - (1 - t) * y0 - t * y1)
        count, total = np.zeros((2, flat.points.shape[1]))
        for k in range(len(scene.segments)):
            # once a segment, however many cells of it meet there
            cells = np.flatnonzero(flat.segment == k)
            nodes, first = np.unique(flat.cells[:, cells].ravel(), return_index=True)
            count[nodes] += 1
            total[nodes] += by_segment[:, cells].ravel()[first]
        return by_segment, total / count

    def _across(self, k: int, end: int, r: np.ndarray) -> np.ndarray:
        """Return the radial velocity on an end of a segment, at radii r."""
        segments = self.adjoint.scene.segments
        sides = [(k, end)] + [(j, 1 - end) for j in (k + 2 * end - 1,) if 0 <= j < len(segments)]
        marks: dict[float, float] = {}
        for j, side_end in sides:
            for name, column in (("inner", 4), ("outer", 2)):
                place = getattr(segments[j], f"{name}{side_end}")
                if not any(abs(place - m) < TOUCH for m in marks):
                    marks[place] = self.segment[j, column + side_end]
        marks.setdefault(0.0, 0.0)
        places = np.array(sorted(marks))
        return np.interp(r, places, [marks[m] for m in places])

    def derivative(self, push: Push) -> float:
        """Return the derivative of a number by the parameter, without actions on ports."""
        return self._shape(push) + self._matter(push)

    def _shape(self, push: Push) -> float:
        if not self.segment.any() and not self.station.any():
            return 0.0
        if not hasattr(self, "velocity"):
            self.move()
        total = float((push.nodes * self.velocity).sum() + push.planes @ self.station[:, 0])
        total += float((push.ends * self.slip).sum())
        for by_surface, bulge in zip(push.surface, self.bulge):
            total += float((by_surface * bulge).sum())
        return total

    def move(self) -> None:
        """Set the velocity of the nodes, the slip of seat ends and the bulge of surfaces beyond it."""
        adjoint, flat = self.adjoint, self.adjoint.flat
        axial = self.along()
        by_segment, mean = self.radial(axial)
        self.velocity = np.array([mean, axial])
        seats = self.station[:, 1:] - np.array(
            [np.interp([s.lo, s.hi], self.marks, self.rates) for s, _ in adjoint.stations]
        )
        averaged = np.array([a == "average" for _, a in adjoint.stations])
        self.slip = np.where(averaged[:, None], seats, 0.0)
        beyond = by_segment - mean[flat.cells]
        outer, bore = beyond[[1, 2]][:, adjoint.sides[1]], beyond[[0, 3]][:, adjoint.sides[0]]
        self.bulge = [outer.T, bore.T]
        surface_y = flat.points[1][flat.cells[[1, 2]][:, adjoint.sides[1]]]
        bulging = {float(y) for y in surface_y[np.abs(outer) > 1e-9]}
        for s, attachment in adjoint.stations:
            tol = 1e-9 * adjoint.scene.length
            if attachment != "section" and any(s.lo - tol <= y <= s.hi + tol for y in bulging):
                raise SolidgearError(f"the surface under {s.name} splits in two")

    def _matter(self, push: Push) -> float:
        out = 0.0
        for k, segments in enumerate(zip(self.low.segments, self.high.segments)):
            a, b = (segment.material for segment in segments)
            if a == b:
                continue
            mu = [m.shear_modulus for m in (a, b)]
            lame = [2 * g * m.nu / (1 - 2 * m.nu) for g, m in zip(mu, (a, b))]
            out += push.lame[k] * (lame[1] - lame[0]) + push.shear[k] * (mu[1] - mu[0])
            out += push.density[k] * (b.density - a.density)
        return out / self.step
