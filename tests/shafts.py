"""Shafts that more than one test file meshes, and a matrix seen from elsewhere."""

import numpy as np

from solidgear.core.frames import shift
from solidgear.core.scene import Scene, Segment

#: (length, outer at both ends, inner at both ends): steps up and down outside and in the bore,
#: cones next to steps, a blind bore, a conical bore
NASTY = (
    (0.04, 0.030, 0.030, 0.010, 0.010),
    (0.03, 0.030, 0.050, 0.010, 0.010),
    (0.02, 0.080, 0.080, 0.020, 0.020),
    (0.03, 0.060, 0.025, 0.020, 0.008),
    (0.03, 0.025, 0.025, 0.008, 0.008),
    (0.02, 0.040, 0.040, 0.0, 0.0),
    (0.05, 0.020, 0.035, 0.0, 0.0),
)


def shaft(*parts, **rest):
    """A scene of parts end to end: (length, outer at both ends, inner at both ends or none), m."""
    segments, y = [], 0.0
    for k, (length, a, b, *bore) in enumerate(parts):
        i, j = bore or (0.0, 0.0)
        segments.append(
            Segment(
                name=f"s{k}", y0=y, y1=round(y + length, 9), outer0=a, outer1=b, inner0=i, inner1=j
            )
        )
        y = segments[-1].y1
    if "port" not in rest:
        return Scene.from_parts(segments, **rest)
    return Scene(segments=tuple(segments), **rest)


def moved_by(matrix, offset):
    """A 6x6 stiffness or mass seen from a displaced reference point that is joined rigidly."""
    back = shift(-np.asarray(offset, float))
    return back.T @ matrix @ back
