"""Fillets and chamfers that a model leaves out."""

from __future__ import annotations

from typing import Any

import numpy as np

from solidgear.core import listed
from solidgear.guards.notice import Notice, Notices, beams
from solidgear.guards.probe import Probe

# fillets.py: radius over the smaller diameter of a shoulder of 134 on 90 mm, then the shares that a
# fillet takes from the compliances of a point 15 mm before it in deflection and in tilt, and adds to
# first bending
FILLETS = np.array(
    [
        [0.0, 0.0, 0.0, 0.0],
        [0.02, 0.0021, 0.0074, 0.0012],
        [0.05, 0.0066, 0.0209, 0.0034],
        [0.10, 0.0164, 0.0448, 0.0078],
    ]
)
NOTICED, LARGE = 0.02, 0.07


def fillets(probe: Probe) -> Notices:
    """Yield notices on fillets at roots that a beam leaves out, from an error of a thousandth on."""
    segments = probe.scene.segments
    by_level: dict[str, list[tuple[float, Any]]] = {}
    for corner in probe.scene.outline.corners:
        ratio = min(corner.axial, corner.radial) / (2 * corner.r)
        if corner.root and corner.surface == "outer" and ratio >= NOTICED:
            by_level.setdefault("caution" if ratio >= LARGE else "fact", []).append((ratio, corner))
    for level, corners in by_level.items():
        places = listed(
            f'{corner.kind} "{corner.name}" at the shoulder of {segments[corner.owner].name!r}, '
            f"y = {1e3 * corner.y:.6g} mm, {ratio:.2g} of the diameter"
            for ratio, corner in corners
        )
        largest = max(ratio for ratio, _ in corners)
        soft, tilt, rise = (
            100 * float(np.interp(largest, FILLETS[:, 0], column)) for column in FILLETS.T[1:]
        )
        yield Notice(
            level,
            beams(),
            f"a beam leaves out the {places}: on a short overhang that is {soft:.1g} % of the "
            f"deflection, {tilt:.1g} % of the tilt and {rise:.1g} % of first bending; use "
            f"{probe.instead()}",
        )
