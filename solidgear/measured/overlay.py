"""Responses of a scene at the points where it was measured: a sum over the modes, rigid motions
among them, with the damping that was measured, and the static compliance of all that is stiffer.

The share of stiffer modes is the static compliance less that of the listed modes (the residual term
of Ewins 2000, Modal Testing, section 4.3).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from solidgear.core import Body, Mode, Scene, as_supports
from solidgear.core.body import FURTHER, SINE
from solidgear.core.solve.coupling import decoupled, groups
from solidgear.core.solve.supported import Supported
from solidgear.measured.computed import motions_up_to
from solidgear.measured.correlate import Correlation
from solidgear.measured.shapes import SurfacePoints

#: of the highest measured frequency: modes up to there count
BEYOND = 2.0
#: names and units of motions over a force, by derivatives of the displacement
KINDS = (("receptance", "m/N"), ("mobility", "m/s/N"), ("accelerance", "m/s^2/N"))
AXES = "xyz"


@dataclass(frozen=True, eq=False)
class Overlay:
    """Measured and computed responses."""

    hertz: np.ndarray  #: (k,)
    #: measured, computed: (n, k) SI
    measured: np.ndarray
    computed: np.ndarray
    names: tuple[str, ...]  #: of the responses: point and direction, and where it was driven
    kind: str
    unit: str
    limit: float  #: hz; stiffer modes are left out
    damping: float  #: ratio of modes that were not measured, the median of those that were
    #: number of a pair -> computed modal constant over the measured one, of all responses
    constants: dict[int, float]
    #: (n, k) how far computed ones may be off by the bars of frequencies and of static compliance;
    #: None where unknown
    band: np.ndarray | None
    #: around the axis, up to which stiffer modes count; 0 of a 3D mesh, and None where it is
    #: left out
    waves: int | None

    @property
    def description(self) -> str:
        """Model of the computed ones, in words."""
        waves = f", up to {self.waves} waves around" if self.waves else ""
        stiffer = (
            f"Higher modes count by their static compliance{waves}, which at the driven point "
            "depends on how wide the force is."
            if self.waves is not None
            else "Higher modes are left out, which moves minima more than peaks."
        )
        band = (
            "The band comes from the error bars of frequencies, and for static compliance from "
            "twice the largest of them (an estimate); shapes and damping have none."
            if self.band is not None
            else "The computed response has no error bar."
        )
        return (
            f"Computed from the modes up to {self.limit:.0f} Hz and free rigid motions, with "
            f"their measured damping or else its median, {100 * self.damping:.2g} %. {stiffer} "
            f"{band}"
        )

    @property
    def loudest(self) -> int:
        """The response that was driven where it was measured, else the largest one."""
        size = np.mean(np.abs(self.measured) ** 2, axis=1)
        driving_point = np.array(
            [name.split(" for ")[0] == name.split(" for ")[1] for name in self.names]
        )
        return int(np.where(driving_point | ~driving_point.any(), size, -1.0).argmax())


def overlay(correlation: Correlation) -> Overlay | None:
    """Responses of the scene beside the measured ones.

    Parameters
    ----------
    correlation : Correlation
        Of measured responses, as of :func:`solidgear.correlate`.

    Returns
    -------
    Overlay or None
        ``hertz`` (k,), ``measured`` and ``computed`` (n, k); None where no responses were measured,
        or their points or kind are unknown.

    Examples
    --------
    >>> import solidgear as sg
    >>> rod = sg.Scene.from_parts([sg.Segment.cylinder("rod", length=0.6, diameter=0.02)])
    >>> tap = {"uncertainty": "0.1 %", "mode": [{"frequency": 251.95}, {"frequency": 690.85}]}
    >>> sg.overlay(sg.correlate(rod, tap)) is None  # frequencies alone
    True
    """
    fitted, computed = correlation.measured.responses, correlation.computed
    if fitted is None:
        return None
    responses, derivatives = fitted.responses, fitted.responses.derivatives
    if not responses.places or not responses.scaled or derivatives is None:
        return None
    pairs = {
        k: pair
        for k, pair in enumerate(zip(responses.points, responses.references))
        if all(1 <= abs(way) <= 3 and point in responses.places for point, way in pair)
    }
    if not pairs:
        return None
    usable = list(pairs)
    points = sorted({point for pair in pairs.values() for point, _ in pair})
    places = SurfacePoints(computed.body, points, np.array([responses.places[n] for n in points]))
    labels = sorted({end for pair in pairs.values() for end in pair})
    ends = [(points.index(point), way) for point, way in labels]
    # where each response was measured, and where it was driven
    first, second = np.array([[labels.index(end) for end in pair] for pair in pairs.values()]).T
    limit = BEYOND * correlation.pairs[-1].measured.frequency
    ahead = responses.frequencies > 0
    hertz = responses.frequencies[ahead]
    numbers = {
        pair.computed.name: pair.number - 1
        for pair in correlation.pairs
        if pair.computed is not None
    }
    usual = float(np.median(fitted.fit.damping))
    out = np.zeros((len(usable), len(hertz)), complex)
    band = np.zeros(out.shape)
    constants: dict[int, float] = {}
    omega = 2 * np.pi * hertz
    motions = motions_up_to(computed, limit)
    for mode, bar in motions:
        constant = np.zeros(len(usable))
        for vector in mode.vectors:
            moved = _along(places.motion(vector), ends)
            constant += moved[first] * moved[second]
        number = numbers.get(str(mode.name))
        ratio = usual if number is None else float(fitted.fit.damping[number])
        natural = 2 * np.pi * mode.frequency_hz
        unit = _unit(natural, omega, ratio)
        out += constant[:, None] * unit
        if np.isfinite(bar):
            low, high = natural * (1 - bar), natural * (1 + bar)
            tried: tuple[float | np.ndarray, ...] = low, high, omega.clip(low, high)
            error = np.max(
                [np.abs(_unit(frequency, omega, ratio) - unit) for frequency in tried], axis=0
            )
            band += np.abs(constant)[:, None] * error
        if number is not None:
            # products of shapes of unit mass, by residues of accelerances (Ewins, eq. 4.30)
            pole = fitted.fit.poles[number]
            measured = 2j * pole.imag * fitted.fit.residues[number, usable] / pole**2
            constants[number + 1] = float(
                abs(np.vdot(measured, constant)) / np.sum(np.abs(measured) ** 2)
            )
    bars = [bar for mode, bar in motions if mode.frequency_hz > 0]
    stiffer = stiffer_motions(computed.scene, places, ends, [mode for mode, _ in motions])
    if stiffer is not None:
        static_rest = stiffer.remaining[first, second]
        out += static_rest[:, None]
        # a frequency is the root of a stiffness
        static_error = 2 * max(bars, default=np.inf) * np.diag(stiffer.static)
        sure = np.sqrt(static_error[first] * static_error[second])
        at = np.array(ends)[:, 0]
        same_point = at[first] == at[second]
        band += np.where(same_point, np.abs(static_rest), sure)[:, None]
    kind, unit_ = KINDS[derivatives]
    names = [f"{n}{'-' if way < 0 else ''}{AXES[abs(way) - 1]}" for n, way in labels]
    return Overlay(
        hertz,
        responses.values[usable][:, ahead],
        out * (1j * omega) ** derivatives,
        tuple(f"{names[j]} for {names[k]}" for j, k in zip(first, second)),
        kind,
        unit_,
        limit,
        usual,
        constants,
        band * omega**derivatives if np.isfinite(bars).all() else None,
        None if stiffer is None else stiffer.waves,
    )


def _unit(natural: float | np.ndarray, omega: np.ndarray, ratio: float) -> np.ndarray:
    """Return the receptance of one kilogram on a spring."""
    return 1 / (natural**2 - omega**2 + 2j * ratio * natural * omega)


def _along(motion: np.ndarray, ends: Sequence[tuple[int, int]]) -> np.ndarray:
    """Return (e,) motions (p, 3) of points along the directions of ends."""
    points, ways = np.array(ends).T
    return np.sign(ways) * motion[points, np.abs(ways) - 1]


#: waves around of a body of revolution that a force at a point counts with, at least
WAVES = 8
#: share of an eigenvalue by which bearing terms between families may be left out
COUPLING = 1e-9


class Stiffer(NamedTuple):
    """Static motions (e, e) at points under forces at them, m/N, without free motions; those that a
    list of modes lacks; and the most waves around that count, 0 of a 3D mesh.
    """

    static: np.ndarray
    remaining: np.ndarray
    waves: int


def stiffer_motions(
    scene: Scene, places: SurfacePoints, ends: Sequence[tuple[int, int]], modes: Iterable[Mode]
) -> Stiffer | None:
    """Return the static compliance that a list of modes lacks; None for a body whose surface has no
    forces. The ends are places of points among those of `places`, and directions -3 to 3 along x,
    y, z.
    """
    body = places.body
    if not hasattr(body.geometry, "rows"):
        return None
    elastic = [mode for mode in modes if mode.frequency_hz > 0]
    waves = max([WAVES, *(mode.waves for mode in elastic)]) if body.further is not None else 0
    static = np.zeros((len(ends), len(ends)))
    for supported, forces in _forces(scene, places, ends, waves):
        free = forces - supported.mass(supported.free) @ (supported.free.T @ forces)
        static += forces.T @ supported.static(free)
    remaining = static.copy()
    for mode in elastic:
        for vector in mode.vectors:
            along = _along(places.motion(vector), ends)
            remaining -= np.outer(along, along) / (2 * np.pi * mode.frequency_hz) ** 2
    return Stiffer(static, remaining, waves)


def _forces(
    scene: Scene, places: SurfacePoints, ends: Sequence[tuple[int, int]], waves: int
) -> Iterator[tuple[Supported, np.ndarray]]:
    """Yield groups of blocks, and unit forces (n, e) at the ends on each."""
    body, supports = places.body, as_supports(scene)
    spring, _ = decoupled(body, supports, COUPLING)
    for group in groups(body, supports, spring):
        forces = [_on_block(body, places, ends, b) for b in group]
        yield Supported(body, supports, spring, group), np.vstack(forces)
    no_supports = as_supports(())
    for n in range(2, waves + 1):
        family = Supported(body.family(n), no_supports, np.zeros((0, 0)), [0])
        for index in (FURTHER + n, SINE + n):
            yield family, _on_block(body, places, ends, index)


def _on_block(
    body: Body, places: SurfacePoints, ends: Sequence[tuple[int, int]], index: int
) -> np.ndarray:
    """Return (n, e) unit forces at the ends in the unknowns of a block."""
    block = body.block(index)
    points, ways = np.array(ends).T
    corners = places.corners[points]
    rows = body.geometry.rows(block.name, corners.ravel())  # type: ignore[union-attr]
    rows = rows.reshape(*corners.shape, 3, -1)
    directed = rows[np.arange(len(ends)), :, np.abs(ways) - 1]
    along = np.einsum("ecn,ec->en", directed, places.weights[points]) * np.sign(ways)[:, None]
    return (along if block.expand is None else along @ block.expand).T
