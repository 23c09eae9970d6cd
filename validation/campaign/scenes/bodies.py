"""Bodies drawn to break error bars, each with the reason why it might.

    scene = BODIES["groove 1 mm"].make()

Lengths are written in mm here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from solidgear.core.scene import Ask, Bearing, Material, Port, Scene, Segment

MM = 1e-3
STEEL = Material(E=2.07e11, nu=0.3, density=7850)
ALUMINIUM = Material(E=7.0e10, nu=0.34, density=2700)
RUBBERY = Material(E=2.0e9, nu=0.49, density=1400)
RUBBER = Material(E=2.0e7, nu=0.4999, density=1100)

#: walls of the rings in which a shaft meets a sleeve, mm
RINGS = (2.0, 1.0, 0.5, 0.2, 0.05, 0.02)


@dataclass(frozen=True)
class Drawn:
    """A drawn body, and why a bar may fail there."""

    name: str
    reason: str
    make: Callable[[], Scene]


BODIES: dict[str, Drawn] = {}


def _drawn(name: str, reason: str) -> Callable[[Callable[[], Scene]], Callable[[], Scene]]:
    def keep(make: Callable[[], Scene]) -> Callable[[], Scene]:
        BODIES[name] = Drawn(name, reason, make)
        return make

    return keep


# ------------------------------------------------------------------------------------------------
# - pieces, all lengths in mm
def _piece(
    length: float,
    diameter: float,
    end: float | None = None,
    bore: float = 0.0,
    material: Material | None = None,
) -> dict:
    """A cylinder, or a cone with another diameter at its end."""
    radii = {"outer0": diameter / 2, "outer1": (diameter if end is None else end) / 2}
    radii |= {"inner0": bore / 2, "inner1": bore / 2}
    given = {} if material is None else {"material": material}
    return {"length": length, "radii": radii, "given": given}


def _segments(pieces: Iterable[dict]) -> list[Segment]:
    out: list[Segment] = []
    y = 0.0
    for k, piece in enumerate(pieces, start=1):
        top = y + piece["length"]
        radii = {name: value * MM for name, value in piece["radii"].items()}
        out.append(Segment(name=f"s{k}", y0=y * MM, y1=top * MM, **radii, **piece["given"]))
        y = top
    return out


def _seat(y: float, width: float, k: float = 1e9, tie: str = "average", **springs: float) -> dict:
    """A bearing alike in both planes that also holds along the shaft; tilt and twist if given."""
    stiffness = {"kxx": k, "kyy": 0.5 * k, "kzz": k} | springs
    return {"y": y * MM, "seat_width": width * MM, "stiffness": stiffness, "attachment": tie}


def _point(y: float, width: float, tie: str = "average", name: str = "p") -> Port:
    ends = (y - width / 2) * MM, (y + width / 2) * MM
    return Port(name=name, y=y * MM, lo=ends[0], hi=ends[1], attachment=tie)


def _scene(
    pieces: Iterable[dict],
    port: Port,
    *seats: dict,
    material: Material = STEEL,
    modes: int = 10,
    **rest,
) -> Scene:
    bearings = [Bearing(name=f"b{k}", **seat) for k, seat in enumerate(seats, start=1)]
    return Scene.from_parts(
        _segments(pieces), material, bearings, port, ask=Ask(modes=modes), **rest
    )


def _ends(length: float, k: float = 1e9, width: float = 15) -> tuple[dict, dict]:
    """Seats 20 mm from both ends; the first holds twist too."""
    return _seat(20, width, k, kthy=2e4), _seat(length - 20, width, k)


# ------------------------------------------------------------------------------------------------
# - seats on smooth shafts
@_drawn("plain bar, seats 2 mm", "narrow seats on 1e10 N/m: all of the error sits at their ends")
def _narrow() -> Scene:
    held = _seat(20, 2, 1e10, kthy=2e4), _seat(180, 2, 1e10)
    return _scene([_piece(200, 40)], _point(100, 2), *held)


@_drawn("rigid seat, smooth shaft", "root of the distance in the stress at the ends of a seat")
def _rigid() -> Scene:
    return _scene([_piece(200, 40)], _point(90, 20, "rigid"), *_ends(200))


@_drawn("rigid seat ends at a shoulder", "the sharpest edge there is, exponent a third")
def _rigid_corner() -> Scene:
    pieces = [_piece(100, 40), _piece(100, 60)]
    return _scene(pieces, _point(90, 20, "rigid"), *_ends(200))


def _rigid_pair(gap: float) -> Scene:
    held = _seat(20, 15, kthy=2e4), _seat(70, 20, tie="rigid")
    return _scene([_piece(200, 40)], _point(90 + gap, 20, "rigid"), *held)


for _gap in (0.04, 0.2):
    _drawn(f"two rigid seats {_gap:g} mm apart", "all strain of the surface in a sliver")(
        lambda gap=_gap: _rigid_pair(gap)
    )


@_drawn("averaged seats 0.04 mm apart", "two ends of seats in one cell")
def _average_pair() -> Scene:
    held = _seat(20, 15, kthy=2e4), _seat(70, 20)
    return _scene([_piece(200, 40)], _point(90.04, 20), *held)


@_drawn("stiff bearings", "1e11 N/m: the shaft alone gives way, and only under the seats")
def _stiff() -> Scene:
    return _scene([_piece(200, 40)], _point(100, 10), *_ends(200, 1e11))


@_drawn("soft bearings", "1e5 N/m: numbers are rigid motion, errors are rounding")
def _soft() -> Scene:
    return _scene([_piece(200, 40)], _point(100, 10), *_ends(200, 1e5))


@_drawn("coupled bearing", "a full matrix of 6 by 6: axial, bending and torsion are one problem")
def _coupled() -> Scene:
    arm = np.repeat([1.0, 0.02], 3)
    draw = np.random.default_rng(7).standard_normal((6, 6))
    matrix = 2e8 * (draw @ draw.T / 6 + 0.5 * np.eye(6)) * np.outer(arm, arm)
    held = {"y": 30 * MM, "seat_width": 15 * MM, "matrix": matrix, "attachment": "average"}
    return _scene([_piece(120, 40), _piece(80, 50)], _point(100, 20), held, _seat(180, 15))


@_drawn("free shaft", "no bearing at all: frequencies only, rigid motions beside them")
def _free() -> Scene:
    return _scene([_piece(80, 40), _piece(60, 70), _piece(60, 30)], _point(110, 20))


@_drawn("slender shaft", "60 diameters long: bending by far the softest, rounding near")
def _slender() -> Scene:
    return _scene([_piece(1800, 30)], _point(700, 20), *_ends(1800, 3e8), modes=30)


@_drawn("three lumped points", "terms at further points and between them")
def _points() -> Scene:
    pieces = [_piece(60, 40), _piece(80, 60), _piece(60, 40)]
    further = (_point(85, 10, name="q"), _point(160, 6, "rigid", name="r"))
    return _scene(pieces, _point(115, 20), *_ends(200), further_ports=further)


# ------------------------------------------------------------------------------------------------
# - shoulders, grooves and bores
for _ratio in (1.02, 1.2, 3.0):
    _drawn(f"shoulder {_ratio:g}", "a re-entrant corner beside the loaded seat")(
        lambda ratio=_ratio: _scene(
            [_piece(100, 40), _piece(100, 40 * ratio)], _point(85, 10), *_ends(200)
        )
    )


@_drawn("groove 1 mm", "two corners 1 mm apart, 5 mm deep")
def _groove() -> Scene:
    pieces = [_piece(100, 50), _piece(1, 40), _piece(100, 50)]
    return _scene(pieces, _point(90, 10), *_ends(200))


@_drawn("step of 0.05 mm beside a seat", "a step too small to see at the end of a seat")
def _tiny_step() -> Scene:
    return _scene([_piece(100, 40), _piece(100, 40.1)], _point(94.95, 10), *_ends(200))


@_drawn("seat 0.07 mm beside a step", "an end of a seat and a corner in one cell")
def _seat_at_step() -> Scene:
    return _scene([_piece(100, 40), _piece(100, 56)], _point(94.93, 10), *_ends(200))


@_drawn("bore steps", "corners inside, and a web between two bores")
def _bores() -> Scene:
    pieces = [_piece(80, 60, bore=50), _piece(40, 60, bore=20), _piece(80, 60, bore=40)]
    return _scene(pieces, _point(90, 10), *_ends(200))


@_drawn("bore as wide as the neck", "two corners at one radius, 2 mm of web between them")
def _neck() -> Scene:
    pieces = [_piece(60, 50, bore=30), _piece(2, 50), _piece(15, 30), _piece(80, 50)]
    return _scene(pieces, _point(110, 10), *_ends(157))


@_drawn("section ties at a shoulder", "a plane held stiff where the radius jumps")
def _sections() -> Scene:
    pieces = [_piece(100, 40), _piece(100, 56)]
    held = _seat(20, 15, tie="section", kthy=2e4), _seat(180, 15, tie="section")
    port = _point(95, 10, "section").with_changes(y=100 * MM)
    return _scene(pieces, port, *held)


@_drawn("shoulder of Poisson's ratio 0.49", "volume all but kept: elements of low order lock")
def _incompressible() -> Scene:
    pieces = [_piece(100, 40), _piece(100, 60)]
    return _scene(pieces, _point(85, 10), *_ends(200, 1e7), material=RUBBERY)


@_drawn(
    "rubber shoulder of Poisson's ratio 0.4999", "shear gives way five thousand times as easily"
)
def _rubber_shoulder() -> Scene:
    pieces = [_piece(40, 40), _piece(30, 60)]
    held = _seat(8, 8, 1e6, kthy=20), _seat(60, 10, 1e6)
    return _scene(pieces, _point(25, 10), *held, material=RUBBER)


@_drawn(
    "rubber bush between steel rings", "a soft joint that hardly changes its volume, glued to both"
)
def _bush() -> Scene:
    pieces = [_piece(30, 40), _piece(6, 40, material=RUBBER), _piece(30, 40)]
    return _scene(pieces, _point(8, 10), *_ends(66, 1e7, 8))


@_drawn("aluminium sleeve on steel", "the material changes at corners of its own exponent")
def _sleeve() -> Scene:
    pieces = [_piece(80, 40), _piece(50, 90, material=ALUMINIUM), _piece(80, 40)]
    return _scene(pieces, _point(105, 30), *_ends(210))


@_drawn("rubber between two steel ends", "stiffness jumps a hundredfold on one plane")
def _rubber() -> Scene:
    pieces = [_piece(80, 40), _piece(8, 40, material=RUBBERY), _piece(80, 40)]
    return _scene(pieces, _point(60, 10), *_ends(168, 1e8))


# ------------------------------------------------------------------------------------------------
# - cones
@_drawn("chamfer of 60 degrees", "two obtuse corners in place of a shoulder's one")
def _chamfer() -> Scene:
    pieces = [_piece(100, 40), _piece(5.7735, 40, 60), _piece(94.2265, 60)]
    return _scene(pieces, _point(85, 10), *_ends(200))


def _cone(angle: float) -> Scene:
    length = 40 / np.tan(np.radians(angle))
    pieces = [_piece(100, 40), _piece(length, 40, 120), _piece(40, 120)]
    held = _seat(20, 15, kthy=2e4), _seat(60, 15)
    return _scene(pieces, _point(length + 120, 20), *held)


for _angle in (65, 75):
    _drawn(f"cone of {_angle} degrees", "cells of a steep cone are skew")(
        lambda angle=_angle: _cone(angle)
    )


# ------------------------------------------------------------------------------------------------
# - discs and tubes
def _disc(thick: float) -> Scene:
    """Of 400 mm between two stubs, loaded on its rim."""
    pieces = [_piece(60, 40), _piece(thick, 400), _piece(60, 40)]
    held = _seat(15, 15, kthy=2e4), _seat(105 + thick, 15)
    return _scene(pieces, _point(60 + thick / 2, thick), *held, modes=20)


for _share in (0.03, 0.005):
    _drawn(f"disc of {_share:g} diameters", "a plate that bends towards its free edge")(
        lambda share=_share: _disc(400 * share)
    )


@_drawn("flange at the end", "a thin disc with nothing behind it")
def _flange() -> Scene:
    pieces = [_piece(150, 40), _piece(6, 160)]
    return _scene(pieces, _point(153, 6), _seat(20, 15, kthy=2e4), _seat(110, 15))


@_drawn("short plate", "shorter than thick: no beam, one seat on its rim")
def _plate() -> Scene:
    held = _seat(4, 4, 1e9, kthx=1e5, kthz=1e5, kthy=1e5)
    return _scene([_piece(12, 120, bore=40)], _point(9, 3), held)


@_drawn("bell", "a drum of 2 mm on a disc of 4 mm")
def _bell() -> Scene:
    pieces = [_piece(60, 40), _piece(4, 200), _piece(60, 200, bore=196)]
    held = _seat(15, 10, kthy=2e4), _seat(45, 10)
    return _scene(pieces, _point(100, 10), *held, modes=16)


@_drawn("pulley", "rim and web: thin in both directions, a bore through both")
def _pulley() -> Scene:
    pieces = [_piece(20, 160, bore=148), _piece(5, 160, bore=15), _piece(60, 30, bore=15)]
    held = _seat(40, 12, kthy=2e4), _seat(75, 12)
    return _scene(pieces, _point(10, 10), *held, modes=16)


for _wall in (0.05, 0.02):
    _drawn(f"tube, wall {_wall:g} radii", "edge effects decay within a few walls")(
        lambda wall=_wall: _scene(
            [_piece(300, 100, bore=100 * (1 - wall))], _point(150, 20), *_ends(300, 3e8, 20)
        )
    )


@_drawn("short tube, wall 0.005 radii", "walls of a quarter millimetre, cells of it slender")
def _foil() -> Scene:
    held = _seat(3, 4, 1e7, kthy=2e4), _seat(27, 4, 1e7)
    return _scene([_piece(30, 100, bore=99.5)], _point(15, 4), *held)


@_drawn("section beside a rigid seat on a thin tube", "two edge effects 2 mm apart")
def _section_tube() -> Scene:
    held = _seat(20, 20, 3e8, kthy=2e4), _seat(200, 20, 3e8, "rigid")
    return _scene([_piece(300, 100, bore=94)], _point(212, 4, "section"), *held)


@_drawn("rigid seat at the end of a cup", "a seat's end on a thin wall")
def _cup() -> Scene:
    pieces = [_piece(60, 30), _piece(5, 80), _piece(50, 80, bore=74)]
    held = _seat(15, 12, kthy=2e4), _seat(45, 12)
    return _scene(pieces, _point(107.5, 15, "rigid"), *held)


# ------------------------------------------------------------------------------------------------
# - thin rings
def _ring(wall: float) -> Scene:
    """A shaft of 40 mm whose end face meets a sleeve of 80 mm in a ring of some wall."""
    pieces = [_piece(50, 40), _piece(65, 80, bore=40 - 2 * wall)]
    held = _seat(20, 12, 2e8, kthy=2e4), _seat(95, 15, 3e8)
    return _scene(pieces, _point(75, 10), *held)


for _thin in RINGS:
    _drawn(f"ring joint {_thin:g} mm", "a shaft and a sleeve hang together by a ring alone")(
        lambda wall=_thin: _ring(wall)
    )
