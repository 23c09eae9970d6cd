"""Orders of a train: periods of everything that turns and meshes in one turn of the pinion, or of the
shaft that the engine turns with.

Shafts, meshes with their sidebands, and rolling bearings each give their own, so that a train of
other wheels adds up those it has.  Teeth set the ratios: orders of shafts and meshes are exact.
Those of a bearing have a bar: an inside that is estimated from its ratings lies between its softer
and its stiffer end and balls are some per cent off, rows differ in their contact angle, and rolling elements
slip.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import degrees

import numpy as np

from solidgear.bearings.catalogued import Catalogued
from solidgear.bearings.geometry import Geometry, inner_geometry
from solidgear.bearings.passing import passing, working_angle
from solidgear.bearings.solved import solved
from solidgear.scene import Scene
from solidgear.scene.catalogue import Catalogue
from solidgear.scene.planetary import Stage
from solidgear.scene.train import Train
from solidgear.studies.loading import shaft

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
    source: str  #: formula and whose it is, and what of it is estimated
    per_turn: float  #: periods in one turn of the pinion
    #: low, high: its bar; equal where teeth alone give it
    low: float
    high: float

    def at(self, turns: float) -> tuple[float, float, float]:
        """Frequency and both ends of its bar, Hz, at a speed of the pinion in turns a second."""
        return turns * self.per_turn, turns * self.low, turns * self.high


def train_orders(
    train: Train, angles: Mapping[str, Sequence[float]] | None = None
) -> tuple[Order, ...]:
    """Orders of all shafts, of their meshes and of their catalogue bearings.

    Parameters
    ----------
    angles : mapping of str to sequence of float, optional
        Contact angles of the rows of a bearing at work, rad, by ``side.bearing``; those of the
        catalogue by default.

    Returns
    -------
    tuple of Order
        Shafts, mesh, its sidebands, bearings.

    Raises
    ------
    SceneError
        A load rating that no inside of the bearing's dimensions has.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = train_orders(sg.load_train("geometry/axle_overhung.toml"))
    >>> [(order.name, round(order.per_turn, 4)) for order in found if order.name.endswith(" 1")][:3]
    [('pinion 1', 1.0), ('gear 1', 0.3111), ('mesh 1', 14.0)]
    """
    turns = train.turns
    out = [order for side in train.shafts for order in of_shaft(side, turns[side])]
    for pair in train.pairs:
        out += of_mesh(pair.name, train.per_turn(pair))
    for pair in train.pairs:
        wheels = {side: turns[side] for side in pair.shafts}
        out += of_sidebands(pair.name, train.per_turn(pair), wheels)
    for stage in train.stages:
        out += of_stage(stage, turns, train.per_turn(stage.meshes[0]))
    for side, own in train.shafts.items():
        for bearing in own.scene.bearings:
            if bearing.catalogue is not None:
                at_work = (angles or {}).get(f"{side}.{bearing.name}", ())
                name = f"{side} bearing {bearing.name}"
                out += of_bearing(name, bearing.catalogue, turns[side], at_work)
    return tuple(out)


def of_shaft(name: str, turns: float, numbers: Iterable[int] = SHAFT_ORDERS) -> Iterator[Order]:
    """Harmonics of a shaft that turns so often in one turn of the pinion."""
    for n in numbers:
        yield _exact("shaft", f"{name} {n}", "turns of the shaft", n * turns)


def of_mesh(name: str, per_turn: float, numbers: Iterable[int] = MESH_ORDERS) -> Iterator[Order]:
    """Harmonics of a mesh."""
    for n in numbers:
        yield _exact("mesh", f"{name} {n}", "teeth", n * per_turn)


def of_sidebands(name: str, per_turn: float, wheels: Mapping[str, float]) -> Iterator[Order]:
    """Sidebands of a mesh: its harmonics, more and less whole turns of one of its wheels."""
    for n in MESH_ORDERS:
        for wheel, turns in wheels.items():
            for k in range(1, SIDEBANDS + 1):
                source = f"teeth, turns of the {wheel}"
                for sign, add in (("-", -k), ("+", k)):
                    words = f"{name} {n} {sign} {wheel} {k}"
                    yield _exact("sideband", words, source, n * per_turn + add * turns)


def of_stage(stage: Stage, turns: Mapping[str, float], per_turn: float) -> Iterator[Order]:
    """Harmonics of the meshes of planets, with sidebands of the carrier, and of planets that pass a
    point of the ring, one of the sun, and turn.
    """
    sun, carrier = stage.shafts
    count, slow, name = len(stage.teeth.azimuths), turns[carrier], stage.called
    yield from of_mesh(stage.name, per_turn)
    passing = {carrier: slow, f"{name} planets": count * slow}
    yield from of_sidebands(stage.name, per_turn, passing)
    apart = count * (turns[sun] - slow)
    spin = slow * stage.teeth.ring / stage.teeth.planet
    rolling = (
        ("planets", "planets that pass a point of the ring", count * slow),
        ("sun", "planets that pass a point of the sun", apart),
        ("planet", "turns of a planet against the carrier", spin),
    )
    for word, source, each in rolling:
        for n in MESH_ORDERS:
            yield _exact("shaft", f"{name} {word} {n}", source, n * each)


def _exact(kind: str, name: str, source: str, per_turn: float) -> Order:
    return Order(kind, name, source, per_turn, per_turn, per_turn)


def of_bearing(
    name: str, data: Catalogue, inner: float, angles: Sequence[float] = ()
) -> Iterator[Order]:
    """Orders of a catalogue bearing, between the ends of its inside, angles and slip.

    Parameters
    ----------
    inner : float
        Turns of its inner ring in one turn of the pinion, signed; the outer one stands still.
    angles : sequence of float
        Contact angles of its rows at work, rad; that of the catalogue by default.
    """
    geometry = inner_geometry(data)
    at: Sequence[float | None] = angles or (None,)
    ends = [geometry.middle, geometry.softer, geometry.stiffer]
    if data.balls and "element_diameter" in geometry.estimated:
        sizes = 1 - BALL, 1 + BALL
        ends += [replace(one, diameter=size * one.diameter) for one in ends for size in sizes]
    found = [passing(inside, angle, inner) for inside in ends for angle in at]
    middle = [passing(geometry.middle, angle, inner) for angle in at]
    for kind, (short, formula) in BEARING.items():
        values = [abs(getattr(one, kind)) for one in found]
        usual = sum(abs(getattr(one, kind)) for one in middle) / len(middle)
        low, high = min(values) * (1 - SLIP), max(values) * (1 + SLIP)
        source = (
            f"{short} = {formula}: {_inside(geometry, angles)}; {HARRIS}; slip {100 * SLIP:g} %"
        )
        for n in BEARING_ORDERS:
            yield Order(kind, f"{name} {short} {n}", source, n * usual, n * low, n * high)


def _inside(geometry: Geometry, angles: Sequence[float]) -> str:
    """An inside in words, with what of it is estimated."""
    inside = geometry.middle
    low, high = sorted((geometry.softer.elements, geometry.stiffer.elements))
    spread = f" ({low} to {high})" if low != high else ""
    told = f"Z {inside.elements}{spread}, Dw {1e3 * inside.diameter:.4g} mm"
    told += f", Dpw {1e3 * inside.pitch:.4g} mm"
    angled = ", ".join(f"{degrees(a):.1f}" for a in angles) or f"{degrees(inside.angle):.1f}"
    told += f", a {angled} deg {'at work' if angles else 'nominal'}"
    # an estimated groove changes no frequency
    guessed = [word for word in geometry.estimated if word not in ("conformity", "element_length")]
    if not guessed:
        return told
    return told + f"; estimated {', '.join(guessed)}".replace("_", " ")


def settled_angles(scene: Scene) -> dict[str, tuple[float, ...]]:
    """Contact angles of the loaded rows of catalogue bearings where their stiffness is taken, rad,
    by bearing; none of a bearing that carries nothing.

    Parameters
    ----------
    scene : Scene
        Of one shaft, with the loads of its file.
    """
    if all(bearing.catalogue is None for bearing in scene.bearings):
        return {}
    found = solved(scene, shaft(scene))
    return angles_of(found.made, found.motion)


def angles_of(
    bearings: Mapping[str, Catalogued], motion: Mapping[str, np.ndarray]
) -> dict[str, tuple[float, ...]]:
    """Contact angles of the loaded rows of bearings at motions (6,) of their inner rings, rad."""
    out = {}
    for name, made in bearings.items():
        rows = map(working_angle, made.bearing.contacts(motion[name]))
        if told := tuple(angle for angle in rows if angle is not None):
            out[name] = told
    return out
