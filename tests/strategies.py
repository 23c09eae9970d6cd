"""Random valid scenes for property tests: shafts of one to six segments on up to three bearings, of
realistic magnitudes.
"""

import math

import numpy as np
from hypothesis import strategies as st

from solidgear.core.scene import Bearing, Material, Port, Scene, Segment

MATERIALS = (
    Material(E=2.07e11, nu=0.30, density=7850.0),
    Material(E=7.0e10, nu=0.33, density=2700.0),
    Material(E=1.1e11, nu=0.26, density=7100.0),
    Material(E=1.6e10, nu=0.44, density=11340.0),
)
#: N/m and m: a bearing resists a tilt like its radial stiffness at this lever, so translations and
#: tilts are comparable
STIFFNESS, LEVER = (1e6, 1e10), 0.02


def _between(low, high, digits=3):
    """Numbers of few digits, so that a counterexample can be read."""
    return st.integers(0, 10**digits).map(lambda k: low + (high - low) * k / 10**digits)


def _drawn(draw, low, high):
    return draw(_between(low, high))


@st.composite
def shafts(draw, most=6):
    """Tuple of segments: cylinders, cones and bevel heads (frustum and backcone), hollow throughout
    or solid.
    """
    bore = draw(st.sampled_from((0.0, 0.0, 0.2, 0.4))) * 0.05
    segments, y = [], 0.0
    for k in range(draw(st.integers(1, most))):
        material = MATERIALS[draw(st.sampled_from((0, 0, 0, 1, 2, 3)))]
        kind = draw(st.sampled_from(("cylinder", "cylinder", "cone", "bevel_head")))
        length, one, two = (
            _drawn(draw, 0.02, 0.12),
            _drawn(draw, 0.04, 0.12),
            _drawn(draw, 0.04, 0.12),
        )
        if kind == "bevel_head":
            rows = [
                (f"s{k}", "frustum", length, min(one, two), max(one, two)),
                (
                    f"s{k}.backcone",
                    "backcone",
                    _drawn(draw, 0.005, 0.02),
                    max(one, two),
                    max(one, two),
                ),
            ]
            rows = (
                rows
                if draw(st.booleans())
                else [(name, part, long, b, a) for name, part, long, a, b in reversed(rows)]
            )
        else:
            rows = [(f"s{k}", "shaft", length, one, two if kind == "cone" else one)]
        for name, part, axial, d0, d1 in rows:
            segments.append(
                Segment(
                    name=name,
                    y0=y,
                    y1=y + axial,
                    outer0=d0 / 2,
                    outer1=d1 / 2,
                    inner0=bore / 2,
                    inner1=bore / 2,
                    material=material,
                    part=part,
                )
            )
            y = segments[-1].y1
    return tuple(segments)


@st.composite
def stiffnesses(draw, least=0):
    """(6, 6) positive semidefinite stiffness of a random rank, zero included; couplings as strong
    as definiteness allows.
    """
    rank = draw(st.integers(least, 6))
    root = np.array(
        draw(st.lists(st.integers(-9, 9), min_size=6 * rank, max_size=6 * rank)), float
    ).reshape(6, rank)
    held = (
        np.array(draw(st.lists(st.booleans(), min_size=6, max_size=6)), float)
        if draw(st.booleans())
        else np.ones(6)
    )
    lever = np.repeat((1.0, LEVER), 3)
    size = 10 ** _drawn(draw, *map(math.log10, STIFFNESS))
    root = held[:, None] * lever[:, None] * root / 9
    return size * root @ root.T


@st.composite
def bearings(draw, name, free, least=0):
    """A bearing on one of the free intervals of the outer surface, which is taken off the list."""
    lo, hi = free.pop(draw(st.integers(0, len(free) - 1)))
    width = _drawn(draw, 0.3, 0.8) * (hi - lo)
    series = tuple(10 ** _drawn(draw, 7, 10) for _ in range(draw(st.integers(0, 2))))
    attachment = draw(st.sampled_from(("average", "average", "rigid", "section")))
    return Bearing(
        name=name,
        y=(lo + hi) / 2,
        seat_width=width,
        stiffness=draw(stiffnesses(least)),
        axial_series=series,
        attachment=attachment,
    )


@st.composite
def scenes(draw, most_segments=6, least_bearings=0, least_rank=0):
    """A valid scene: bearings on segments of their own, the lumped point on the surface of any
    segment, a housing or none.
    """
    segments = draw(shafts(most_segments))
    free = [(s.y0, s.y1) for s in segments if s.part != "backcone"]
    count = min(draw(st.integers(least_bearings, 3)), len(free))
    held = [draw(bearings(str(k + 1), free, least_rank)) for k in range(count)]
    carrier = draw(st.sampled_from(segments))
    # on a bearing or clear of it: what is lost to rounding grows with the third power of the shaft
    # over the shortest beam element
    at = carrier.y0 + draw(_between(0.25, 0.75, digits=1)) * carrier.length
    attachment = draw(st.sampled_from(("average", "section")))
    port = Port(name="port", y=at, lo=carrier.y0, hi=carrier.y1, attachment=attachment)
    housing = draw(st.sampled_from((None, 1e8, 1e10)))
    return Scene.from_parts(segments, bearings=held, port=port, housing_axial=housing)
