"""Seeded random shafts on bearings, as a stranger would write them.

    scene = random_scene(7)                       # any kind
    scene = random_scene(7, kind="gearbox")

A draw that the scene refuses is drawn again inside, so that every seed gives a valid scene.
Lengths scale with one diameter per scene, 15 to 300 mm, so that nothing depends on the size.
"""

from __future__ import annotations

import math
import zlib

import numpy as np

from solidgear.core.errors import SceneError
from solidgear.core.scene import Ask, Bearing, Material, Port, Scene, Segment
from validation.campaign.scenes.springs import random_springs

MATERIALS = {
    "steel": Material(E=2.07e11, nu=0.3, density=7850.0),
    "aluminium": Material(E=7.0e10, nu=0.33, density=2700.0),
    "titanium": Material(E=1.14e11, nu=0.34, density=4430.0),
    "cast iron": Material(E=1.1e11, nu=0.26, density=7200.0),
    "stack": Material(E=4.0e10, nu=0.25, density=7600.0),
    "rubbery": Material(E=2.0e9, nu=0.4, density=1400.0),
}
ATTACHMENTS = ("average", "rigid", "section")
#: how often a scene has all its ties of one sort, or each drawn by itself
TIES = {"average": 0.35, "rigid": 0.2, "section": 0.15, "mixed": 0.3}
TRIES = 200


def random_scene(seed: int, kind: str | None = None, ties: str | None = None) -> Scene:
    """A valid scene that follows from its arguments alone: the seed chooses a kind and a sort of
    ties where none is given.
    """
    if kind is not None and kind not in KINDS or ties is not None and ties not in TIES:
        raise ValueError(
            f"kind {kind!r}, ties {ties!r}: choose from {', '.join(KINDS)} and {', '.join(TIES)}"
        )
    first = np.random.default_rng(seed)
    chosen = kind or str(first.choice(list(KINDS)))
    # outside of the draws that may be refused: two rigid seats share no surface, and would be
    # drawn away
    ties = ties or str(first.choice(list(TIES), p=list(TIES.values())))
    for attempt in range(TRIES):
        rng = np.random.default_rng([seed, zlib.crc32(chosen.encode()), attempt])
        try:
            return _draw(rng, f"{chosen}_{seed}", chosen, ties)
        except SceneError:
            continue
    raise ValueError(f"no valid scene of kind {chosen!r} in {TRIES} draws from seed {seed}")


def with_second_point(scene: Scene, seed: int) -> Scene:
    """A scene with another lumped point, drawn as its first one is."""
    for attempt in range(TRIES):
        rng = np.random.default_rng([seed, 2, attempt])
        tie = str(rng.choice(ATTACHMENTS[::2]))  # two rigid seats share no surface
        port = _port(rng, list(scene.segments), tie).with_changes(name="second")
        try:
            return scene.with_changes(further_ports=(port,))
        except SceneError:
            continue
    raise ValueError(f"no valid second point in {TRIES} draws from seed {seed}")


def between(rng: np.random.Generator, low: float, high: float) -> float:
    """A number between two positive ones, all orders of magnitude alike."""
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


def _draw(rng, name: str, kind: str, ties: str) -> Scene:
    diameter = between(rng, 0.015, 0.3)
    pieces = KINDS[kind](rng, diameter)
    segments = _end_to_end(pieces)
    material = MATERIALS[str(rng.choice(["steel"] * 7 + ["aluminium", "titanium", "cast iron"]))]
    seats = _seats(rng, segments, int(rng.choice([1, 2, 2, 2, 2, 3])))
    unequal = rng.random() < 0.25
    coupled = str(rng.choice(["none", "paired", "strong"], p=[0.5, 0.35, 0.15]))
    bearings = []
    for i, (y, width, seat_diameter) in enumerate(seats):
        series = (between(rng, 1e6, 1e9),) if rng.random() < 0.1 else ()
        springs = random_springs(rng, seat_diameter, unequal, coupled)
        tie = str(rng.choice(ATTACHMENTS)) if ties == "mixed" else ties
        told = {"matrix": springs, "axial_series": series, "attachment": tie}
        bearings.append(Bearing(name=str(i + 1), y=y, seat_width=width, **told))
    port = _port(rng, segments, str(rng.choice(ATTACHMENTS)) if ties == "mixed" else ties)
    housing = between(rng, 1e7, 1e9) if rng.random() < 0.12 else None
    told = {"name": name, "title": f"random {kind}", "ask": _ask(rng, segments, material)}
    return Scene.from_parts(segments, material, bearings, port, housing_axial=housing, **told)


def _ask(rng, segments, material) -> Ask:
    highest = None
    if rng.random() < 0.15:
        length, radius = segments[-1].y1, max(s.outer0 for s in segments)
        first = 3.56 * radius / 2 * math.sqrt(material.E / material.density) / length**2
        highest = first * between(rng, 2.0, 10.0)
    modes, tolerance = int(rng.integers(6, 13)), float(rng.choice([0.01, 0.05, 0.1]))
    return Ask(modes=modes, max_frequency=highest, tolerance=tolerance)


# ------------------------------------------------------------------------------------------------
# - shafts
def _piece(length, start, end=None, bore=0.0, material=None, part="shaft") -> dict:
    out = {"length": length, "start": start, "end": start if end is None else end, "bore": bore}
    return out | {"material": material, "part": part}


def _end_to_end(pieces: list[dict]) -> list[Segment]:
    y, out = 0.0, []
    for i, p in enumerate(pieces, start=1):
        given = {} if p["material"] is None else {"material": p["material"]}
        radii = {"outer0": p["start"] / 2, "outer1": p["end"] / 2}
        radii |= {"inner0": p["bore"] / 2, "inner1": p["bore"] / 2}
        length = round(p["length"], 6)
        out.append(Segment(name=f"s{i}", y0=y, y1=y + length, part=p["part"], **radii, **given))
        y += length
    return out


def _bores(rng, pieces: list[dict], share: float) -> list[dict]:
    """A bore through all pieces, or stepped or blind, in a `share` of the draws."""
    least = min(min(p["start"], p["end"]) for p in pieces)
    sort = rng.random()
    if sort > share:
        return pieces
    bore = least * rng.uniform(0.15, 0.75)
    for p in pieces:
        p["bore"] = bore
    if sort < 0.4 * share and len(pieces) > 1:
        # from one end to somewhere inside the bore is wider, or ends
        stop = int(rng.integers(1, len(pieces)))
        wider = rng.choice([0.0, rng.uniform(1.05, 1.3)])
        for p in pieces[:stop] if rng.random() < 0.5 else pieces[stop:]:
            p["bore"] = min(bore * wider, 0.9 * min(p["start"], p["end"]))
    return pieces


def _bar(rng, d) -> list[dict]:
    return [_piece(d * between(rng, 0.3, 50.0), d)]


def _tube(low, high):
    def draw(rng, d):
        return [_piece(d * between(rng, 0.3, 50.0), d, bore=d * (1 - between(rng, low, high)))]

    return draw


def _gearbox(rng, d) -> list[dict]:
    """Up to eight diameters; shoulders of 1 to 2 mm between most."""
    count = int(rng.integers(2, 9))
    top = int(rng.integers(0, count))
    steps = [
        rng.uniform(0.002, 0.004) if rng.random() < 0.65 else d * rng.uniform(0.08, 0.5)
        for _ in range(count)
    ]
    diameters = [d] * count
    for i in range(top - 1, -1, -1):
        diameters[i] = max(diameters[i + 1] - steps[i], 0.4 * d)
    for i in range(top + 1, count):
        diameters[i] = max(diameters[i - 1] - steps[i], 0.4 * d)
    shares = rng.uniform(0.3, 1.7, count)
    length = d * between(rng, 2.5, 25.0)
    return _bores(
        rng, [_piece(length * w / shares.sum(), k) for w, k in zip(shares, diameters)], 0.35
    )


def _pinion(rng, d) -> list[dict]:
    """A bevel head on a stem, overhung or with a pilot stub; the stem may have a shoulder or a
    cone.
    """
    small, large = d * rng.uniform(1.1, 1.5), d * rng.uniform(1.6, 2.4)
    head = [_piece(d * rng.uniform(0.5, 1.2), small, large, part="frustum")]
    if rng.random() < 0.7:
        head.append(_piece(d * rng.uniform(0.08, 0.3), large, part="backcone"))
    stem = [_piece(d * between(rng, 1.0, 8.0), d)]
    if rng.random() < 0.5:
        stem = [_piece(d * rng.uniform(0.2, 0.6), d * 1.15), *stem]
    if rng.random() < 0.4:
        stem.append(_piece(d * rng.uniform(0.2, 0.8), d, 0.75 * d))
        stem.append(_piece(d * rng.uniform(0.6, 2.0), 0.75 * d))
    if rng.random() < 0.35:
        head = [_piece(d * rng.uniform(0.3, 0.6), 0.7 * d), *head]
    return _bores(rng, head + stem, 0.2)


def _rotor(rng, d) -> list[dict]:
    """A motor rotor: thick stack of laminations, or a pressed-on copper or plastic body, between
    two journals.
    """
    inner = _piece(
        d * between(rng, 1.0, 10.0),
        d * rng.uniform(1.8, 4.5),
        material=MATERIALS[str(rng.choice(["stack", "stack", "aluminium", "rubbery"]))],
    )
    left = [_piece(d * between(rng, 0.5, 5.0), 0.8 * d)]
    left += [_piece(d * rng.uniform(0.3, 1.0), d)] if rng.random() < 0.7 else []
    right = [_piece(d * rng.uniform(0.3, 1.0), d)] if rng.random() < 0.7 else []
    right += [_piece(d * between(rng, 0.5, 5.0), 0.8 * d)]
    return _bores(rng, [*left, inner, *right], 0.25)


def _flange(rng, d) -> list[dict]:
    """A shaft with a flange at its end or within."""
    flange = _piece(d * rng.uniform(0.08, 0.4), d * rng.uniform(1.6, 3.5))
    a = _piece(d * between(rng, 0.8, 12.0), d)
    b = _piece(d * between(rng, 0.5, 6.0), d * rng.uniform(0.6, 1.0))
    return _bores(rng, [a, flange] if rng.random() < 0.5 else [a, flange, b], 0.35)


def _disc(rng, d) -> list[dict]:
    """A disc: by itself with its bearing on the rim, or on a short hub."""
    if rng.random() < 0.3:
        bore = d * rng.uniform(0.2, 0.6) if rng.random() < 0.5 else 0.0
        return [_piece(d * between(rng, 0.3, 0.8), d, bore=bore)]
    stub = d * rng.uniform(0.25, 0.5)
    parts = [
        _piece(d * rng.uniform(0.15, 0.6), stub),
        _piece(d * rng.uniform(0.08, 0.3), d),
        _piece(d * rng.uniform(0.15, 0.6), stub),
    ]
    return _bores(rng, parts, 0.4)


KINDS = {
    "bar": _bar,
    "tube_thick": _tube(0.3, 0.7),
    "tube_thin": _tube(0.04, 0.25),
    "gearbox": _gearbox,
    "pinion": _pinion,
    "rotor": _rotor,
    "flange": _flange,
    "disc": _disc,
}


# ------------------------------------------------------------------------------------------------
# - stations
def _seats(rng, segments: list[Segment], count: int) -> list[tuple[float, float, float]]:
    """(middle, width, diameter) of `count` seats on cylinders, 0.1 to 1 diameters wide and apart
    from each other.
    """
    length = segments[-1].y1
    places = [s for s in segments if s.outer0 == s.outer1]
    if not places:
        raise SceneError("no cylinder to sit on")
    share = np.array([s.length for s in places]) / sum(s.length for s in places)
    out: list[tuple[float, float, float]] = []
    for _ in range(60):
        segment = places[int(rng.choice(len(places), p=share))]
        diameter = 2 * segment.outer0
        wide, room = diameter * between(rng, 0.1, 1.0), float(rng.choice([1.0, 0.6]))
        width = round(min(wide, segment.length * room), 7)
        at_end = rng.random() < 0.25
        lo = segment.y0 if at_end else rng.uniform(segment.y0, max(segment.y1 - width, segment.y0))
        y = round(lo + width / 2, 7)
        apart = all(abs(y - o) > max((width + w) / 2, 0.15 * length) for o, w, _ in out)
        if width >= 0.1 * diameter and apart:
            out.append((y, width, diameter))
        if len(out) == count:
            break
    if not out:
        raise SceneError("no room for a seat")
    return out


def _port(rng, segments: list[Segment], tie: str) -> Port:
    """On a whole segment, on part of it, or with its point beside its surface."""
    share = np.array([s.length * max(s.outer0, s.outer1) for s in segments])
    segment = segments[int(rng.choice(len(segments), p=share / share.sum()))]
    lo, hi = segment.y0, segment.y1
    if rng.random() < 0.5:
        part = segment.length * between(rng, 0.05, 0.8)
        lo = round(rng.uniform(segment.y0, segment.y1 - part), 7)
        hi = round(lo + part, 7)
    y = (lo + hi) / 2
    if rng.random() < 0.25:
        y = min(max(y + (hi - lo) * rng.uniform(-1.0, 1.0), 0.0), segments[-1].y1)
    return Port(y=round(y, 7), lo=lo, hi=hi, attachment=tie)


# ------------------------------------------------------------------------------------------------
# - what was drawn
def traits(scene: Scene) -> dict:
    """Kind of a scene, its slenderness, thinnest wall, ties and bearings."""
    sorts = {s.attachment for s in scene.stations}
    matrices = [np.array(b.matrix) for b in scene.bearings]
    return {
        "kind": scene.title.removeprefix("random "),
        "l_over_d": scene.length / max(2 * max(s.outer0, s.outer1) for s in scene.segments),
        "segments": len(scene.segments),
        "wall_over_radius": min(1 - s.inner0 / s.outer0 for s in scene.segments),
        "ties": sorts.pop() if len(sorts) == 1 else "mixed",
        "bearings": len(scene.bearings),
        "coupled": any(np.any(k - np.diag(np.diag(k))) for k in matrices),
        "unequal": any(k[0, 0] != k[2, 2] for k in matrices),
        "tolerance": scene.ask.tolerance,
    }
