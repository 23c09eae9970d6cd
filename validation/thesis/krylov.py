"""Exact Euler-Bernoulli bending of a stepped shaft on point springs with lumped masses.

The initial-parameter method with Krylov-Duncan functions, arranged so that it neither overflows nor
loses roots, as described in :mod:`validation.thesis.krylov_shaft`.

There is no shear, and no rotary inertia but that of lumped parts: that is the model of the thesis,
and either would bring a second length into the functions. Nothing is shared with the finite
elements, which makes agreement with them worth having.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.models.limits import number
from validation.thesis.krylov_shaft import AFTER, GAUSS, joined_shaft, transfer, transferred


@dataclass(frozen=True)
class Span:
    """A uniform length of shaft.

    Attributes
    ----------
    length : float
        m.
    bending_stiffness : float
        E I, N m^2.
    mass_per_length : float
        kg/m.

    Raises
    ------
    SolidgearError
        If one of them is not above zero.
    """

    length: float
    bending_stiffness: float
    mass_per_length: float

    def __post_init__(self):
        for name, value in vars(self).items():
            _given("span", name, value, above=0)


@dataclass(frozen=True, eq=False)
class Station:
    """A point spring to ground and a lumped mass.

    Attributes
    ----------
    y : float
        m, from the left end of the first span.
    spring : (2, 2) ndarray
        On (z, thx), in N/m, N/rad and N m/rad, symmetric positive semidefinite.
    mass : float
        kg.
    inertia : float
        About the x axis through the station, kg m^2.

    Raises
    ------
    SolidgearError
        For a spring that is not symmetric or indefinite, or a negative mass or inertia.
    """

    y: float
    spring: np.ndarray = field(default_factory=lambda: np.zeros((2, 2)))
    mass: float = 0.0
    inertia: float = 0.0

    def __post_init__(self):
        for name, least in (("y", None), ("mass", 0), ("inertia", 0)):
            _given("station", name, getattr(self, name), least=least)
        try:
            k = np.array(self.spring, float)
        except (TypeError, ValueError):
            k = np.zeros(0)
        here = f"station at y = {self.y:g} m: the spring"
        if k.shape != (2, 2) or not np.isfinite(k).all():
            raise SolidgearError(f"{here} must be 2 rows of 2 finite numbers, on (z, thx)")
        bound = np.sqrt(abs(k[0, 0])) * np.sqrt(abs(k[1, 1]))  # of the coupling, in its own unit
        if abs(k[0, 1] - k[1, 0]) > 1e-9 * bound:
            raise SolidgearError(
                f"{here} is not symmetric: {k[0, 1]:g} and {k[1, 0]:g} off the diagonal"
            )
        if min(k[0, 0], k[1, 1]) < 0 or abs(k[0, 1]) > (1 + 1e-9) * bound:
            raise SolidgearError(
                f"{here} {k.tolist()} is indefinite; no motion may give energy back"
            )
        k.flags.writeable = False
        object.__setattr__(self, "spring", k)


@dataclass(frozen=True, eq=False)
class KrylovModes:
    """Bending modes, lowest first, each of unit modal mass and arbitrary sign.

    Attributes
    ----------
    frequency_hz : (n,) ndarray
    rigid : int
        How many of them are rigid motions, of frequency zero.
    counts : (n, 2) ndarray of int
        Modes counted below ``(1 - 1e-8) f`` and ``(1 + 1e-8) f``: none is missing up to mode k,
        from zero, when ``counts[k, 0] <= k < counts[k, 1]``. For rigid motions: 0 and their number,
        by the rank of the springs.
    distributed, lumped : (n,) ndarray
        Shares of the modal mass in the spans and in the lumped masses, in sum one.
    defect : (n,) ndarray
        Largest violation of the equations at the joints between pieces, relative to the largest
        term of each.
    y : (j,) ndarray
        Places of those joints, m.
    """

    frequency_hz: np.ndarray
    rigid: int
    counts: np.ndarray
    distributed: np.ndarray
    lumped: np.ndarray
    defect: np.ndarray
    y: np.ndarray
    _pieces: tuple = field(repr=False)  # bending stiffness and mass per length of every piece
    # (n, j, 6): z, thx, then Q, M before and Q, M after the joint
    _states: np.ndarray = field(repr=False)

    def shape(self, k: int, y):
        """Field of one mode.

        Parameters
        ----------
        k : int
            Number of the mode, from zero.
        y : float or ndarray
            Places on the shaft, m; at a station just beyond it, at the right end just before.

        Returns
        -------
        z, phi, M, Q : ndarray
            Each like `y`: deflection, m; ``phi = dz/dy = thx``; ``M = E I d2z/dy2``, N m; ``Q =
            -dM/dy``, N, the force along z by which the part beyond y acts on the part before it.

        Raises
        ------
        SolidgearError
            For a mode that was not computed, or a place off the shaft.
        """
        y, end, omega = np.asarray(y, float), self.y[-1], 2 * np.pi * self.frequency_hz
        if not 0 <= k < len(omega):
            raise SolidgearError(
                f"shape: there is no mode {k}; {len(omega)} were computed, counted from 0"
            )
        if not np.all((y >= -1e-9 * end) & (y <= end * (1 + 1e-9))):
            raise SolidgearError(f"shape: y must lie on the shaft, from 0 to {end:g} m")
        i = np.clip(np.searchsorted(self.y, y, "right") - 1, 0, len(self.y) - 2)
        t = transfer(
            np.maximum(y - self.y[i], 0.0), self._pieces[0][i], self._pieces[1][i] * omega[k] ** 2
        )
        z, phi, q, m = transferred(t, np.moveaxis(self._states[k][i][..., AFTER], -1, 0))
        return z, phi, m, q


def krylov(
    spans: Sequence[Span],
    stations: Iterable[Station] = (),
    n: int | None = 4,
    *,
    max_frequency: float | None = None,
) -> KrylovModes:
    """Exact bending modes of a stepped shaft.

    Parameters
    ----------
    spans : sequence of Span
        End to end from y = 0.
    stations : iterable of Station
        In any order; those at one place add up.
    n : int or None
        How many modes, rigid ones included; None is all below `max_frequency`.
    max_frequency : float, optional
        Hz; modes from here on are left out.

    Returns
    -------
    KrylovModes

    Raises
    ------
    SolidgearError
        For a station off the shaft, no span, or neither `n` nor `max_frequency`.

    Examples
    --------
    A free uniform beam, ``k L = 4.730041`` (Hua 2010 uses the same functions):

    >>> found = krylov([Span(length=1.0, bending_stiffness=1.0, mass_per_length=1.0)], n=3)
    >>> found.rigid, round(float(np.sqrt(2 * np.pi * found.frequency_hz[2])), 6)
    (2, 4.730041)
    """
    number("krylov", "n", n, least=1, whole=True)
    number("krylov", "max_frequency", max_frequency, above=0)
    if not len(spans):
        raise SolidgearError("krylov: a shaft needs at least one span")
    if n is None and max_frequency is None:
        raise SolidgearError(
            "krylov: give n, max_frequency or both; a shaft has infinitely many modes"
        )
    shaft = joined_shaft(tuple(spans), tuple(stations))
    free = shaft.rigid()
    rigid = min(free, n or 2)
    top = 2 * np.pi * (max_frequency or np.inf)
    omega = np.append(np.zeros(rigid), shaft.roots(rigid, n, top))
    cut = shaft.cut(omega.max(initial=0.0))
    states, defect, distributed, lumped = cut.shapes(omega)
    around = omega[:, None] * (1 + np.array([-1e-8, 1e-8]))
    counts = shaft.count(around.ravel()).reshape(-1, 2)
    counts[:rigid] = 0, free
    return KrylovModes(
        omega / (2 * np.pi),
        rigid,
        counts,
        distributed,
        lumped,
        defect,
        cut.y,
        (cut.stiff, cut.heavy),
        states,
    )


def from_scene(scene, *, pieces: int = 1) -> tuple[tuple[Span, ...], tuple[Station, ...]]:
    """Spans and stations of a scene, for bending in the plane of z.

    Cones become cylinders with the mean mass and the mean ``1 / (E I)`` of their pieces, so that
    mass, and the turn under a uniform moment, are exact; the error falls with the square of
    `pieces`.  Couplings of a bearing between this plane and the rest are left out.  A held end is a
    spring as stiff as on every other model.

    Parameters
    ----------
    scene : Scene
    pieces : int
        Number of cylinders to a cone.

    Returns
    -------
    spans : tuple of Span
    stations : tuple of Station
        The lumped points first, without a mass of their own; bearings and rigid masses follow.

    Raises
    ------
    SolidgearError
        For masses off their stations, a housing around the bearings, or a shaft that is not of
        plain segments: nothing of them fits into the model.

    Examples
    --------
    >>> import solidgear as sg
    >>> spans, stations = from_scene(sg.load("geometry/shaft_stepped.toml"))
    >>> [round(span.length, 9) for span in spans], len(stations)
    ([0.12, 0.16, 0.14], 3)
    """
    number("krylov", "pieces", pieces, least=1, whole=True)
    _refuse_what_is_left_out(scene)
    spans = []
    for segment in scene.segments:
        tapered = (segment.outer0, segment.inner0) != (segment.outer1, segment.inner1)
        count = (pieces or 1) if tapered else 1
        t = (np.arange(count)[:, None] + (GAUSS[0] + 1) / 2) / count
        outer = segment.outer0 + t * (segment.outer1 - segment.outer0)
        inner = segment.inner0 + t * (segment.inner1 - segment.inner0)
        second = 1 / ((4 / np.pi / (outer**4 - inner**4)) @ GAUSS[1] / 2)
        area = np.pi * (outer**2 - inner**2) @ GAUSS[1] / 2
        of = segment.material
        spans += [
            Span(segment.length / count, of.E * float(i), of.density * float(a))
            for i, a in zip(second, area)
        ]
    places = {station.name: station.y for station in (*scene.ports, *scene.bearings)}
    return tuple(spans), (
        *(Station(port.y) for port in scene.ports),
        *(Station(b.y, b.stiffness[2:4, 2:4]) for b in scene.bearings),
        *(
            Station(places.get(m.station, m.y), mass=m.mass, inertia=m.inertia[0])
            for m in scene.masses
        ),
    )


def _refuse_what_is_left_out(scene) -> None:
    """One sentence where a scene has what is neither a span nor a station."""
    lacking = {
        "features": scene.features,
        "fillets or chamfers": scene.blends,
        "a part from a file": scene.body,
        "a housing around its bearings": scene.housing,
        "masses with an offset from their stations": [m for m in scene.masses if any(m.offset)],
    }
    found = [name for name, there in lacking.items() if there]
    if found:
        raise SolidgearError(
            f"krylov: the scene {scene.name} has {' and '.join(found)}, and this model is of plain "
            "segments, springs and centred masses; ask another model"
        )


def _given(what, name, value, **limits):
    # None, an option left out, would pass
    number(what, name, np.nan if value is None else value, **limits)
