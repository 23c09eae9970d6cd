"""Ring lines of a meridian: the division of every radial band.

Bands are graded towards the surfaces that carry singular points. In a disc that is thinner than a
band is high, cells along the band bend as a plate does, and near its free faces as the edge of one.
"""

from __future__ import annotations

from functools import partial, reduce

import numpy as np

from solidgear.meshing.bands import first_of_run
from solidgear.meshing.blocks import layers_at
from solidgear.meshing.grading import Grading, corner_length, graded, joint_length, segments_under

#: longest cell of a plate, in its outer radii. With one cell from the axis to the rim the second mesh
#: of a plate of 0.01 diameters was 1e-2 off in bending 1, with three 1e-4; in thicker ones cells as
#: long as they are thick do
PLATE_CELL = 0.35
#: where the layer towards a free edge of a plate begins, in thicknesses: a twisting moment ends there
#: within one. Without it bending 1 of a ring plate was 1e-3 off on the fourth mesh, with it 1e-7
FREE_EDGE = 1.0

#: layers towards a boundary of a band, and where they begin, m
Need = tuple[int, float]


def fractions_of(
    scene, grading: Grading, attachments, bands, left, right, joints, strips
) -> dict[tuple[int, int], np.ndarray]:
    """Subdivision of every radial band, graded towards the surfaces that carry singular points.

    Parameters
    ----------
    scene : Scene
    grading : Grading
    attachments : tuple of str or None
        As for :func:`solidgear.meshing.layout.layout`.
    bands, left, right
        From :func:`solidgear.meshing.bands.radial_bands`.
    joints : list of Joint
    strips : dict
        From :func:`solidgear.meshing.blocks.strips_of`.

    Returns
    -------
    dict of (band index, first segment of a run) -> (m + 1,) ndarray
        Of each band, 0 to 1 outwards.
    """
    segments = scene.segments
    needs = _needs(scene, grading, attachments, bands, joints)
    finer = partial(_finer, ratio=grading.ratio)
    fractions = {}
    for band in range(min(b[0] for b in bands), max(b[1] for b in bands)):
        having = [k for k, b in enumerate(bands) if b[0] <= band < b[1]]
        first_of = {k: first_of_run(bands, band, k) for k in having}
        for first in sorted(set(first_of.values())):
            run = [k for k in having if first_of[k] == first]
            place = {k: band - bands[k][0] for k in run}
            thickness = max(
                float(max(np.diff(left[k])[i], np.diff(right[k])[i])) for k, i in place.items()
            )
            for side in (0, 1):
                strip = strips.get((band, first, side))
                thickness -= strip.depth if strip else 0.0
            # The axis is the only band boundary that is no surface anywhere.
            on_axis = any(
                i == 0 and left[k][0] == 0.0 and right[k][0] == 0.0 for k, i in place.items()
            )
            inside, outside = (
                reduce(finer, (needs.get((boundary, k), (0, thickness)) for k in run))
                for boundary in (band, band + 1)
            )
            near, far = (min(sizes) for sizes in zip(*(grading.cell(segments[k]) for k in run)))
            thick = sum(segments[k].length for k in run)
            if thick < thickness and not grading.plain:
                longest = max(thick, PLATE_CELL * max(_outermost(segments[k]) for k in run))
                near, far = min(near, longest), min(far, longest)
                edge = min(1, grading.across), min(FREE_EDGE * thick, grading.reach * thickness)
                inside, outside = (need if need[0] else edge for need in (inside, outside))
            layers = (0 if on_axis else inside[0], outside[0])
            reach = (inside[1], outside[1])
            whole = not (on_axis and grading.core)
            part = thickness if whole else thickness / 2
            lines = graded(part, (near, far), grading.ratio, reach, grading.refinement, *layers)
            lines = lines if whole else np.concatenate([[0.0], part + lines])
            fractions[band, first] = lines / thickness
    return fractions


def _outermost(segment) -> float:
    return max(segment.outer0, segment.outer1)


def _finer(one: Need, other: Need, ratio: float) -> Need:
    """Of two needs the one with more layers; of as many, the one that begins further out, unless the
    other begins more than a layer nearer.
    """
    if one[0] != other[0]:
        return max(one, other)
    near, far = sorted((one, other))
    return near if near[1] < ratio * far[1] else far


def _needs(scene, grading: Grading, attachments, bands, joints) -> dict[tuple[int, int], Need]:
    """Layers and reach (m) that a band boundary needs in a segment."""
    segments = scene.segments
    needs: dict[tuple[int, int], Need] = {}

    def add(boundary: int, segment: int, layers: int, reach: float) -> None:
        if layers:
            known = needs.get((boundary, segment), (0, 0.0))
            needs[boundary, segment] = _finer(known, (layers, reach), grading.ratio)

    for i, (a, b) in enumerate(zip(segments, segments[1:])):
        reach = grading.radial_reach * joint_length(segments, i)
        joint = next((j for j in joints if j.index == i + 1), None)
        # A band boundary meets a shoulder where it is the surface of the smaller neighbour.
        for boundary, surface in (
            (min(bands[i][1], bands[i + 1][1]), "outer"),
            (max(bands[i][0], bands[i + 1][0]), "bore"),
        ):
            layers = layers_at(joint, a, b, surface, grading.across, reach, grading.ratio)
            for k in (i, i + 1):
                add(boundary, k, layers, reach)
    for station in scene.stations:
        ties = attachments or (station.attachment,)
        held, narrow = "rigid" in ties, grading.seat_layers(station, segments, ties)
        for i in segments_under(station, segments):
            edge = min(grading.edge, grading.across)
            reach = grading.radial_reach * corner_length(segments[i])
            add(bands[i][1], i, (grading.across if held else edge) + narrow, reach)
            if "section" in ties:  # whose plane ends in a ring of the bore as well
                add(bands[i][0], i, edge, reach)
    return needs
