"""What is sharpest on a shaft: it limits how fast meshes of a solid converge."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from solidgear.fidelity.rung import (
    HELD,
    HELD_AT_A_STEP,
    HELD_PLANE,
    PLANE,
    SMOOTH,
    STEPPED,
    STEPPED_PLANE,
)
from solidgear.meshing.corners import corner_angle, filled_at
from solidgear.scene.rules import TOUCH

if TYPE_CHECKING:
    from solidgear.scene import Corner, Scene, Segment

#: a seat that ends this near to a step, in least outer radii, ends at it: no mesh tells them apart
NEAR = 0.01
#: and one that ends this near to it, in the same measure, is what the corner's next layers meet
BESIDE = 0.02
#: marks nearer to each other than this, in least outer radii, are crowded: two rigid seats 0.006 apart
#: left 20 steps of two orders without layers, and 1.1 with one layer
CROWDED = 0.1
#: a wall thinner than this share of its outer radius is a shell, that bends along its edges
THIN_WALL = 0.1
#: a shaft shorter than this many of its diameters is a plate, whose modes bend it
PLATE = 0.05
#: a notch narrower than this, rad, and a surface that rises by more than this over its length, leave
#: cells so acute that errors go on as more than bars expect
NARROW_NOTCH, STEEP_SURFACE = np.pi / 6, 4.0


def sharpest_edge(scene: Scene) -> str:
    """What limits how fast meshes converge: one of `SMOOTH`, `PLANE`, `STEPPED`,
    `STEPPED_PLANE`, `HELD`, `HELD_PLANE`, `HELD_AT_A_STEP`.

    Exponents of displacement there are 1 (the jump of the load at the end of a seat), 0.54, 0.50
    and 0.33, so that a layer of ratio q leaves the shares ``q^2``, ``q^1.09``, ``q`` and
    ``q^0.67``.  Williams (1952), J. Appl. Mech. 19, 526, free and clamped-free corners.

    A fillet is none of them: its mesh is made for it, and converges as a smooth shaft does.

    Parameters
    ----------
    scene : Scene

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> sharpest_edge(scene), sharpest_edge(scene.with_attachment("rigid"))
    ('shoulder', 'rigid seat at a shoulder')
    """
    # a chamfer in a shoulder leaves two corners, a fillet none
    corners = [b.y0 for _, b in _re_entrant(scene)] + [c.y for c in chamfered_roots(scene)]
    seats = [s for s in scene.stations if s.attachment == "rigid"]
    near = NEAR * _least_radius(scene)
    touched = any(s.lo - near <= y <= s.hi + near for s in seats for y in corners)
    # a plane that carries a load ends in a ring of the surface
    plane = any(s.attachment == "section" for s in scene.stations)
    if seats:
        return HELD_AT_A_STEP if touched else HELD_PLANE if plane else HELD
    if corners:
        return STEPPED_PLANE if plane else STEPPED
    return PLANE if plane else SMOOTH


def acute(scene: Scene) -> bool:
    """Whether cells are acute somewhere: in a notch between a steep cone and a face, or in a disc
    that is all cone.

    Parameters
    ----------
    scene : Scene

    Examples
    --------
    >>> import solidgear as sg
    >>> acute(sg.load("geometry/gear_shaft.toml"))  # a bevel gear: its cone rises by 3.4
    False
    """
    if _re_entrant(scene, 2 * np.pi - NARROW_NOTCH):
        return True
    rises = (
        max(abs(s.outer1 - s.outer0), abs(s.inner1 - s.inner0)) / s.length for s in scene.segments
    )
    return any(rise > STEEP_SURFACE for rise in rises)


def beside_a_step(scene: Scene) -> bool:
    """Whether an averaged seat ends close beside a shoulder, but not at it: two singular points in
    one cell of coarse meshes.

    Parameters
    ----------
    scene : Scene

    Examples
    --------
    >>> import solidgear as sg
    >>> beside_a_step(sg.load("geometry/shaft_stepped.toml"))
    False
    """
    near = BESIDE * _least_radius(scene)
    steps = [b.y0 for _, b in _re_entrant(scene)]
    ends = [y for s in scene.stations if s.attachment == "average" for y in (s.lo, s.hi)]
    return any(TOUCH < abs(y - step) < near for y in ends for step in steps)


def steepest_kink(scene: Scene) -> float:
    """Rise over length of the steepest surface that turns up from another without a step; zero of
    none. Cells there are as acute as the surface is steep.

    Parameters
    ----------
    scene : Scene

    Examples
    --------
    >>> import solidgear as sg
    >>> steepest_kink(sg.load("geometry/shaft_stepped.toml"))
    0.0
    """
    kinks = [pair for pair in _re_entrant(scene) if abs(pair[0].outer1 - pair[1].outer0) < TOUCH]
    rises = (abs(s.outer1 - s.outer0) / s.length for pair in kinks for s in pair)
    return max(rises, default=0.0)


def is_plate(scene: Scene) -> bool:
    """Whether the whole shaft is shorter than `PLATE` of its largest diameter: its modes bend it,
    and rounding of its thin cells shows in them.

    Parameters
    ----------
    scene : Scene

    Examples
    --------
    >>> from solidgear import Scene, Segment
    >>> discs = [Segment.cylinder("disc", length=length, diameter=0.1) for length in (0.004, 0.006)]
    >>> [is_plate(Scene.from_parts([disc])) for disc in discs]
    [True, False]
    """
    return scene.length < PLATE * 2 * max(max(s.outer0, s.outer1) for s in scene.segments)


def crowded(scene: Scene) -> bool:
    """Whether ends of seats or joints of segments stand closer than `CROWDED` of the least outer
    radius: one cell of a mesh without layers holds two of them, and no order tells what is between.

    Parameters
    ----------
    scene : Scene

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> seat = scene.bearings[0]
    >>> near = seat.with_changes(name="near", y=seat.y + seat.seat_width + 1e-4)
    >>> crowded(scene), crowded(scene.with_changes(bearings=(*scene.bearings, near)))
    (False, True)
    """
    ends = {y for s in scene.stations for y in (s.lo, s.hi)}
    marks = sorted(ends | {s.y0 for s in scene.segments} | {scene.segments[-1].y1})
    gaps = [b - a for a, b in zip(marks, marks[1:])]
    return any(TOUCH < gap < CROWDED * _least_radius(scene) for gap in gaps)


def thin_disc(scene: Scene) -> bool:
    """Whether a segment of the shaft is shorter than `PLATE` of its diameter: it bends towards its
    free edge, which no order tells without layers.

    Parameters
    ----------
    scene : Scene

    Examples
    --------
    >>> from solidgear import Scene, Segment
    >>> disc = Segment.cylinder("disc", y0=0.0, length=0.004, diameter=0.1)
    >>> rod = Segment.cylinder("rod", y0=0.004, length=0.1, diameter=0.03)
    >>> alone = rod.with_changes(y0=0.0)
    >>> thin_disc(Scene.from_parts([disc, rod])), thin_disc(Scene.from_parts([alone]))
    (True, False)
    """
    return any(s.length < PLATE * 2 * max(s.outer0, s.outer1) for s in scene.segments)


def thin_walled(scene: Scene) -> bool:
    """Whether a wall of the shaft is thinner than `THIN_WALL` of its outer radius somewhere: a
    shell, that bends along its edges.

    Parameters
    ----------
    scene : Scene

    Examples
    --------
    >>> from solidgear import Scene, Segment
    >>> thick = Segment.cylinder("tube", length=0.2, diameter=0.1, bore=0.085)
    >>> thin = Segment.cylinder("tube", length=0.2, diameter=0.1, bore=0.095)
    >>> [thin_walled(Scene.from_parts([tube])) for tube in (thick, thin)]
    [False, True]
    """
    return any(
        outer - inner < THIN_WALL * outer
        for s in scene.segments
        for outer, inner in ((s.outer0, s.inner0), (s.outer1, s.inner1))
    )


def chamfered_roots(scene: Scene) -> list[Corner]:
    """Chamfers that fill a shoulder: each leaves two corners, to which no layers lead.

    Parameters
    ----------
    scene : Scene
    """
    return [c for c in scene.corners if c.root and c.kind == "chamfer"]


def _re_entrant(scene: Scene, beyond: float = np.pi * (1 + 1e-9)) -> list[tuple[Segment, Segment]]:
    """Neighbours whose sharp corner holds more material than this angle, rad."""
    pairs = zip(scene.segments, scene.segments[1:])
    return [(a, b) for a, b in pairs if corner_angle(a, b, filled_at(scene, b.y0)) > beyond]


def _least_radius(scene: Scene) -> float:
    return min(min(s.outer0, s.outer1) for s in scene.segments)
