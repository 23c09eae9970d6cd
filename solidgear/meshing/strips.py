"""Rings of the blocks at fillets and chamfers among those of the sharp shaft: strips along bands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from solidgear.meshing.bands import Bands, first_of_run
from solidgear.meshing.blocks import DEPTH, Joint
from solidgear.meshing.rings import Radii, Run
from solidgear.scene.blends import Corner
from solidgear.scene.outline import SURFACES, Outline, Surface

#: how much of a band a strip takes at most
MOST_OF_BAND = 0.3


class Strip(NamedTuple):
    """Rings of blocks along one side of a band: how deep, m, where no rim says otherwise, and how
    many cells.
    """

    depth: float
    cells: int


#: strips by band, first segment of a run, and the side of the band
Strips = dict[tuple[int, int, Surface], Strip]
#: sides of a band, from the inside
SIDES: tuple[Surface, Surface] = (SURFACES[1], SURFACES[0])


def strip_of(joints: Sequence[Joint], bands: Bands, run: Run, surface: Surface) -> Strip | None:
    """The strip along one side of a band; None where no fillet or chamfer lies on it."""
    wanted = [
        (DEPTH * c.radial if c.root else c.radial, joint.cells(c))
        for joint in joints
        for c in joint.corners
        if c.surface == surface
        and c.owner in run.segments
        and run.band == _band_at(bands, c.owner, surface)
    ]
    if not wanted:
        return None
    depth = min(MOST_OF_BAND * min(run.thicknesses), max(d for d, _ in wanted))
    return Strip(depth, max(n for _, n in wanted))


def _band_at(bands: Bands, segment: int, surface: Surface) -> int:
    """The band of a segment that lies at one of its surfaces."""
    lowest, end = bands[segment]
    return lowest if surface == "bore" else end - 1


def split_bands(
    outline: Outline,
    bands: Bands,
    left: Radii,
    right: Radii,
    strips: Strips,
    fractions: Mapping[tuple[int, int], np.ndarray],
) -> tuple:
    """Bands, left, right and fractions with strips as bands of their own."""
    lowest, end = min(b[0] for b in bands), max(b[1] for b in bands)
    sides = {
        band: [s for s in SIDES if any((band, k, s) in strips for k in range(len(bands)))]
        for band in range(lowest, end)
    }
    start, count = {}, 0
    for band in range(lowest, end):
        start[band] = count
        count += 1 + len(sides[band])
    start[end] = count
    new_left, new_right = (
        tuple(
            _with_strips(outline, k, side, np.array(radii[k], float), bands, strips, sides)
            for k in range(len(bands))
        )
        for side, radii in ((1, left), (-1, right))
    )
    new_fractions = {}
    for (band, first), lines in fractions.items():
        place = start[band] + ("bore" in sides[band])
        new_fractions[place, first] = lines
        for surface in sides[band]:
            strip = strips.get((band, first, surface))
            at = place + (1 if surface == "outer" else -1)
            new_fractions[at, first] = np.linspace(0, 1, strip.cells + 1) if strip else np.zeros(1)
    new_bands = tuple((start[low], start[high]) for low, high in bands)
    return new_bands, new_left, new_right, new_fractions


def _with_strips(
    outline: Outline,
    segment: int,
    side: int,
    radii: np.ndarray,
    bands: Bands,
    strips: Strips,
    sides: Mapping[int, Sequence[Surface]],
) -> np.ndarray:
    """Radii of the boundaries at the start (side 1) or end (-1) of a segment with those of strips."""
    rims = {surface: outline.rim(segment, surface, side) for surface in SIDES}
    _clear_of_rims(segment, side, radii, bands, rims)
    roots = {}
    for surface in SIDES:
        root = outline.root(segment + (side < 0), surface)
        if root and root.face_owner == segment:
            roots[surface, _band_at(bands, root.owner, surface)] = root
    low, high = bands[segment]
    found = [radii[0]]
    for band in range(low, high):
        for surface in sides[band]:
            base = radii[band - low + (surface == "outer")]
            inwards = 1 if surface == "bore" else -1
            rim, root = rims[surface], roots.get((surface, band))
            strip = strips.get((band, first_of_run(bands, band, segment), surface))
            if strip and rim and band == _band_at(bands, segment, surface):
                base = base + inwards * rim.radial
            elif strip:
                raised = root.out * root.radial if root else 0.0
                base = base - raised + inwards * strip.depth
            found.append(base)
        found.append(radii[band - low + 1])
    return np.array(found)


def _clear_of_rims(
    segment: int,
    side: int,
    radii: np.ndarray,
    bands: Bands,
    rims: Mapping[Surface, Corner | None],
) -> None:
    """Move radii of the bands at an end of a segment clear of its rims."""
    inner, outer = (rim.radial if rim else 0.0 for rim in rims.values())
    if not (outer or inner) or len(radii) == 2:
        return
    neighbour = segment - side
    if 0 <= neighbour < len(bands):
        # boundaries shared with the neighbour stay
        high = max(0, bands[neighbour][1] - bands[segment][0])
        low = max(0, bands[neighbour][0] - bands[segment][0])
        if outer and high < len(radii) - 1:
            a, b = radii[high], radii[-1]
            radii[high:-1] = a + (radii[high:-1] - a) * (b - outer - a) / (b - a)
        if inner and low > 0:
            a, b = radii[low], radii[0]
            radii[1 : low + 1] = a + (radii[1 : low + 1] - a) * (b + inner - a) / (b - a)
        return
    a, b = radii[0], radii[-1]
    inside = (radii[1:-1] - a) / (b - a)
    a, b = a + inner, b - outer
    radii[1:-1] = a + inside * (b - a)
