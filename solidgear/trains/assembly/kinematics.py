"""Orders of a train: periods of everything that turns and meshes in one turn of the pinion, or of the
shaft that the engine turns with.

Shafts, meshes with their sidebands, and rolling bearings each give their own, so that a train of
other wheels adds up those it has.  Teeth set the ratios: orders of shafts and meshes are exact.
Those of a bearing have an error bar: an inside that is estimated from ratings lies between a softer
and a stiffer end, balls are some per cent off, rows differ in their contact angle, and rolling elements
slip.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import degrees

import numpy as np

from solidgear.bearings.catalogue import Catalogue, catalogue_of
from solidgear.bearings.catalogued import Catalogued
from solidgear.bearings.geometry import Geometry, inner_geometry
from solidgear.bearings.passing import passing, working_angle
from solidgear.bearings.solved import solved
from solidgear.core import Scene
from solidgear.core.loading import shaft
from solidgear.trains.file.planetary import Stage
from solidgear.trains.file.train import Train

#: harmonics of a shaft, of a mesh, of a bearing, and sidebands on each side of a mesh
SHAFT_ORDERS, MESH_ORDERS, BEARING_ORDERS, SIDEBANDS = (1, 2, 3, 4), (1, 2, 3), (1, 2, 3), 2
#: cages and elements in truth run 1 to 2 % off pure rolling (Randall and Antoni, Mechanical Systems
#: and Signal Processing 25, 2011, p. 485-520)
SLIP = 0.02
#: relative; of a ball's diameter that is estimated from ratings, against six published ones
BALL = 0.03
#: frequencies of a bearing by the attributes of `Passing`: name and formula, g = Dw cos(a) / Dpw
BEARING = {
    "cage": ("FTF", "(1 - g) / 2"),
    "outer": ("BPFO", "Z (1 - g) / 2"),
    "inner": ("BPFI", "Z (1 + g) / 2"),
    "element": ("BSF", "Dpw (1 - g^2) / (2 Dw)"),
}
HARRIS = "Harris and Kotzalas, inner ring turning"


@dataclass(frozen=True)
class Order:
    """One harmonic of something that turns, meshes or rolls."""

    #: ``shaft``, ``mesh``, ``sideband``, or of a bearing ``cage``, ``outer``, ``inner`` or
    #: ``element``
    kind: str
    name: str  #: ``gear 2``, ``mesh 1``, ``mesh 1 - pinion 1``, ``pinion bearing A BPFO 1``
    source: str  #: formula and its author, and the estimated dimensions
    per_turn: float  #: periods in one turn of the pinion
    #: low, high: its bar; equal where teeth alone give it
    low: float
    high: float

    def at(self, turns: float) -> tuple[float, float, float]:
        """Return the frequency and both ends of the error bar, Hz, at a speed of the pinion in
        turns a second.
        """
        return turns * self.per_turn, turns * self.low, turns * self.high


def train_orders(
    train: Train, angles: Mapping[str, Sequence[float]] | None = None
) -> tuple[Order, ...]:
    """Return the orders of all shafts, meshes, sidebands and catalogue bearings, in this sequence;
    contact angles of rows at work, rad, by ``side.bearing``, stand in place of those of the
    catalogue.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = train_orders(sg.load_train("geometry/axle_overhung.toml"))
    >>> [(order.name, round(order.per_turn, 4)) for order in found if order.name.endswith(" 1")][:3]
    [('pinion 1', 1.0), ('gear 1', 0.3111), ('mesh 1', 14.0)]
    """
    turns = train.turns
    out = [order for side in train.shafts for order in shaft_harmonics(side, turns[side])]
    for pair in train.pairs:
        out += mesh_harmonics(pair.name, train.per_turn(pair))
    for pair in train.pairs:
        wheels = {side: turns[side] for side in pair.shafts}
        out += sidebands(pair.name, train.per_turn(pair), wheels)
    for stage in train.stages:
        out += stage_orders(stage, turns, train.per_turn(stage.meshes[0]))
    for side, member in train.shafts.items():
        for bearing in member.scene.bearings:
            if (data := catalogue_of(bearing)) is not None:
                work_angles = (angles or {}).get(f"{side}.{bearing.name}", ())
                name = f"{side} bearing {bearing.name}"
                out += bearing_orders(name, data, turns[side], work_angles)
    return tuple(out)


def shaft_harmonics(
    name: str, turns: float, numbers: Iterable[int] = SHAFT_ORDERS
) -> Iterator[Order]:
    """Yield harmonics of a shaft by the turns in one turn of the pinion."""
    for n in numbers:
        yield _exact("shaft", f"{name} {n}", "turns of the shaft", n * turns)


def mesh_harmonics(
    name: str, per_turn: float, numbers: Iterable[int] = MESH_ORDERS
) -> Iterator[Order]:
    """Yield harmonics of a mesh."""
    for n in numbers:
        yield _exact("mesh", f"{name} {n}", "teeth", n * per_turn)


def sidebands(name: str, per_turn: float, wheels: Mapping[str, float]) -> Iterator[Order]:
    """Yield sidebands of a mesh: harmonics, more and less whole turns of a wheel."""
    for n in MESH_ORDERS:
        for wheel, turns in wheels.items():
            for k in range(1, SIDEBANDS + 1):
                source = f"teeth, turns of the {wheel}"
                for sign, add in (("-", -k), ("+", k)):
                    words = f"{name} {n} {sign} {wheel} {k}"
                    yield _exact("sideband", words, source, n * per_turn + add * turns)


def stage_orders(stage: Stage, turns: Mapping[str, float], per_turn: float) -> Iterator[Order]:
    """Yield harmonics of the meshes of planets, with sidebands of the carrier, and orders of
    planets that pass a point of the ring or of the sun, and turn.
    """
    sun, carrier = stage.shafts
    count, slow, name = len(stage.teeth.azimuths), turns[carrier], stage.called
    yield from mesh_harmonics(stage.name, per_turn)
    rates = {carrier: slow, f"{name} planets": count * slow}
    yield from sidebands(stage.name, per_turn, rates)
    sun_passing = count * (turns[sun] - slow)
    spin = slow * stage.teeth.ring / stage.teeth.planet
    rolling = (
        ("planets", "planets that pass a point of the ring", count * slow),
        ("sun", "planets that pass a point of the sun", sun_passing),
        ("planet", "turns of a planet against the carrier", spin),
    )
    for word, source, rate in rolling:
        for n in MESH_ORDERS:
            yield _exact("shaft", f"{name} {word} {n}", source, n * rate)


def _exact(kind: str, name: str, source: str, per_turn: float) -> Order:
    return Order(
        kind=kind, name=name, source=source, per_turn=per_turn, low=per_turn, high=per_turn
    )


def bearing_orders(
    name: str, data: Catalogue, inner: float, angles: Sequence[float] = ()
) -> Iterator[Order]:
    """Yield orders of a catalogue bearing, between the ends of inside, angles and slip; `inner`
    are the signed turns of the inner ring in one turn of the pinion, the outer one stands still.
    """
    geometry = inner_geometry(data)
    row_angles: Sequence[float | None] = angles or (None,)
    ends = [geometry.middle, geometry.softer, geometry.stiffer]
    if data.balls and "element_diameter" in geometry.estimated:
        sizes = 1 - BALL, 1 + BALL
        ends += [
            replace(inside, diameter=size * inside.diameter) for inside in ends for size in sizes
        ]
    passings = [passing(inside, angle, inner) for inside in ends for angle in row_angles]
    middle = [passing(geometry.middle, angle, inner) for angle in row_angles]
    for kind, (short, formula) in BEARING.items():
        values = [abs(getattr(rates, kind)) for rates in passings]
        usual = sum(abs(getattr(rates, kind)) for rates in middle) / len(middle)
        low, high = min(values) * (1 - SLIP), max(values) * (1 + SLIP)
        source = (
            f"{short} = {formula}: {_inside(geometry, angles)}; {HARRIS}; slip {100 * SLIP:g} %"
        )
        for n in BEARING_ORDERS:
            yield Order(
                kind=kind,
                name=f"{name} {short} {n}",
                source=source,
                per_turn=n * usual,
                low=n * low,
                high=n * high,
            )


def _inside(geometry: Geometry, angles: Sequence[float]) -> str:
    """Return an inside in words, with the estimated dimensions."""
    inside = geometry.middle
    low, high = sorted((geometry.softer.elements, geometry.stiffer.elements))
    spread = f" ({low} to {high})" if low != high else ""
    text = f"Z {inside.elements}{spread}, Dw {1e3 * inside.diameter:.4g} mm"
    text += f", Dpw {1e3 * inside.pitch:.4g} mm"
    angled = ", ".join(f"{degrees(a):.1f}" for a in angles) or f"{degrees(inside.angle):.1f}"
    text += f", a {angled} deg {'at work' if angles else 'nominal'}"
    # an estimated groove changes no frequency
    guessed = [word for word in geometry.estimated if word not in ("conformity", "element_length")]
    if not guessed:
        return text
    return text + f"; estimated {', '.join(guessed)}".replace("_", " ")


def settled_angles(scene: Scene) -> dict[str, tuple[float, ...]]:
    """Return contact angles of the loaded rows of catalogue bearings of one shaft where their
    stiffness is taken, rad, by bearing; none for a bearing that carries nothing.
    """
    if all(bearing.catalogue is None for bearing in scene.bearings):
        return {}
    state = solved(scene, shaft(scene))
    return angles_of(state.made, state.motion)


def angles_of(
    bearings: Mapping[str, Catalogued], motion: Mapping[str, np.ndarray]
) -> dict[str, tuple[float, ...]]:
    """Return contact angles of the loaded rows of bearings at motions (6,) of their inner rings,
    rad.
    """
    out = {}
    for name, catalogued in bearings.items():
        rows = map(working_angle, catalogued.bearing.contacts(motion[name]))
        if loaded := tuple(angle for angle in rows if angle is not None):
            out[name] = loaded
    return out
