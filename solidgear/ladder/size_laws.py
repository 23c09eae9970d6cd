"""Sizes of beams, harmonic solids and 3D solids from the layout of their meshes; see
:mod:`solidgear.ladder.size`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.factoring import Factoring
from solidgear.kernel.counts import KINDS, nodes, sections, solved_as
from solidgear.ladder.factor_memory import ENTRY, MB, parts_of, solid_factor_mb
from solidgear.ladder.size import Size
from solidgear.meshing.blocks import blocks_beyond
from solidgear.models.kinds import CUTS, CYCLIC
from solidgear.scene.attached import attached_stations
from solidgear.scene.coned import coned
from solidgear.scene.shaft import resolved

if TYPE_CHECKING:
    from solidgear.scene.body_file import BodyFile
    from solidgear.scene.shaft import Shaft


def _ports(scene: Shaft, given: Mapping[str, Any]) -> int:
    return len(scene.stations) * len(given.get("attachments") or (None,))


# ------------------------------------------------------------------------------------------------- beams
def beam_size(scene: Shaft, given: Mapping[str, Any]) -> Size:
    """Size of a beam; counted."""
    from solidgear.models.beam.body import mesh

    n = len(mesh(scene, given["elements"])[0])
    inner = 1 + given["rotary_inertia"] if given["shear"] and given["mass"] == "consistent" else 0
    bending = 2 * n + inner * (n - 1)
    unknowns, entries = 2 * bending + 2 * n, (4 + inner) ** 2 * (n - 1) + 6 * n
    # narrow bands: the factor is no larger than the matrix, and Python's lists of element matrices
    # outweigh both
    memory = (3e3 * n + 16.0 * 6 * _ports(scene, given) * unknowns) / MB
    return Size(unknowns, entries, entries, memory, 2 * memory, "give fewer elements")


# ------------------------------------------------------------------------------------------------- laid out by lines
@dataclass(frozen=True)
class _Lines:
    """First and last ring line of every row of cells and of every mesh line between rows; where
    there is material up to the axis.
    """

    rows: np.ndarray
    lines: np.ndarray
    solid_rows: np.ndarray
    solid_lines: np.ndarray


def _lines(scene: Shaft, plan) -> _Lines:
    numbers = [set(plan.ring_numbers(k)) for k in range(len(scene.segments))]
    full = np.array([s.inner0 == s.inner1 == 0.0 for s in scene.segments])[plan.segment]
    count = np.array([len(numbers[k]) - 1 for k in plan.segment])
    # Where two segments meet, a mesh line has the rings of both.
    meet = [len(numbers[a] | numbers[b]) - 1 for a, b in zip(plan.segment, plan.segment[1:])]
    across = np.array([count[0], *meet, count[-1]])
    rows, lines = (np.column_stack([np.zeros_like(c), c]) for c in (count, across))
    return _Lines(rows, lines, full, np.r_[full[:1], full] | np.r_[full, full[-1:]])


def harmonic_size(scene: Shaft, given: Mapping[str, Any]) -> Size:
    """Size of a harmonic solid; counted."""
    from solidgear.models.harmonic.body import harmonic_layout

    scene = coned(scene)
    order = given["order"]
    names = ("layers", "edge_layers", "ratio", "relative_size", "size", "refinement", "plain")
    laid = harmonic_layout(scene, given["attachments"], **{k: given[k] for k in names})
    plan = _lines(scene, laid)
    across_rows, across_lines = (np.diff(part).sum() for part in (plan.rows, plan.lines))
    vertices, edges, cells = (
        across_lines + len(plan.lines),
        across_lines + across_rows + len(plan.rows),
        across_rows,
    )
    vertices, edges, cells = (
        n + more for n, more in zip((vertices, edges, cells), blocks_beyond(laid.joints))
    )
    # three cells around a corner become nine by every cut
    cut = sum(count for *_, count in given["cuts"])
    vertices, edges, cells = vertices + 7 * cut, edges + 13 * cut, cells + 6 * cut
    # and a line crosses at most all rows or all rings
    line = len(given["across"]) * len(plan.lines)
    vertices, edges, cells = vertices + line, edges + 2 * line, cells + line
    n = int(vertices + edges * (order - 1) + cells * (order - 1) ** 2)
    inner_edges = 4 * cells - edges
    inner_vertices = vertices - (edges - inner_edges)
    pairs = int(cells * (order + 1) ** 4 - inner_edges * (order + 1) ** 2 + inner_vertices)
    axis = order * int(plan.solid_rows.sum()) + int((np.diff(np.r_[0, plan.solid_rows]) > 0).sum())
    # components, conditions on the axis, motions of a port; all further waves move none
    known = {"bending": (3, 2, 2), "axial": (2, 1, 1), "torsion": (1, 0, 1)}
    blocks = [known[family] for family in given["families"] or known]
    blocks += [(3, 3, 0)] * len(given["ovalising"])
    sizes = [(c, c * n - on_axis * axis, c * c * pairs) for c, on_axis, _ in blocks]
    entries = sum(nnz for *_, nnz in sizes)
    # the other bending plane has the same matrices and unknowns of its own
    twice = sum(size for (*_, motions), (_, size, _) in zip(blocks, sizes) if motions == 2)
    unknowns = twice + sum(size for _, size, _ in sizes)
    built = (18.2 * entries + 300.0 * unknowns) / MB + min(35.0, 12.0 * entries / MB)
    held = peak = 0.0
    for c, size, nnz in sizes:
        factor = _planar_factor_mb(c, size, nnz)
        peak = max(
            peak, held + factor + ENTRY * nnz / MB
        )  # of the shifted matrix, for as long as it is factored
        held += factor
    solved = (
        16.0
        * _ports(scene, given)
        * sum(motions * size for (*_, motions), (_, size, _) in zip(blocks, sizes))
        / MB
    )
    lower = (
        "lower order, refinement or layers, or raise size"
        + ", or ask for fewer ovalising harmonics" * bool(given["ovalising"])
    )
    return Size(
        int(unknowns),
        int(entries),
        int(max(cells * (order + 1) ** 4, max(nnz for *_, nnz in sizes))),
        float(built),
        float(built + peak + solved),
        lower,
    )


def _planar_factor_mb(components: int, unknowns: int, entries: int) -> float:
    """Peak memory of factoring a block on a meridian.

    SuperLU's factor of 24 blocks of order 1 to 8 within 8 %: nodes times their degree, and a
    logarithm for the dissection of the plane. PARDISO, which takes over the largest ones, by its
    own estimate for orders 8 and 12.
    """
    from solidgear.solve.factor import LARGE_PLANAR

    if entries >= LARGE_PLANAR:
        return 33.0 * entries / MB
    n, pairs = unknowns / components, entries / components**2
    return (
        12.6 * components**2 * n * max(0.585 * pairs / n + 7.37 * np.log2(n) - 52, pairs / n) / MB
    )


# ------------------------------------------------------------------------------------------------- solids
def solid_size(scene: Shaft, given: Mapping[str, Any]) -> Size:
    """Size of a 3D solid; counted for hexahedra, estimated for tetrahedra."""
    body = getattr(scene, "body", None)
    if body is not None and body.counts is not None:
        return _given_mesh(scene, given, body)
    features = resolved(scene)
    if features and all(f.sort == CYCLIC for f in features):
        return _whole_teeth(scene, given)
    if given["element"].startswith("tet"):
        return _tetrahedra(scene, given)
    return _hexahedra(scene, given)


def corrected_size(scene: Shaft, given: Mapping[str, Any]) -> Size:
    """Size of a defect correction: that of its 3D solids, estimated, beside the harmonic one.

    The body itself is small; what it is made of decides.
    """
    from solidgear.ladder.registry import LADDER
    from solidgear.models.corrected import sizes

    plain = {**LADDER["harmonic"].defaults(), "attachments": given["attachments"]}
    plain |= {name: given[name] for name in ("order", "layers", "edge_layers")}
    plain["relative_size"] = given["harmonic_size"]
    round_part = harmonic_size(scene, plain)
    solid_part = {**LADDER["solid"].defaults(), "element": "tet10"}
    solid_part |= {"refinement": given["refinement"], "attachments": given["attachments"]}
    cut = _tetrahedra(scene, {**solid_part, **sizes(scene)}, edges=True)
    return Size(
        cut.unknowns,
        cut.entries,
        max(cut.largest, round_part.largest),
        cut.build_mb + round_part.build_mb,
        2 * cut.peak_mb + round_part.peak_mb,
        "lower refinement, order or layers",
    )


def sector_size(scene: Shaft, given: Mapping[str, Any]) -> Size:
    """Size of a cyclic sector, estimated: a share of the whole, once for motions that are alike in
    all sectors and twice, as real and imaginary parts, for others. Of half a sector the first fall
    into two, and the second are real.
    """
    from solidgear.models.sector.body import halved, sector_counts, sectors_around

    around = sectors_around(scene, given)
    counts = sector_counts(scene, given)
    unknowns, entries = (part / around for part in nodes("tet10", counts, 3))
    further = 1 + len(given["ovalising"])
    part = {**given, "element": "tet10"}
    if given["half"] and halved(scene, around):
        return _half_sector(scene, part, unknowns, entries, counts[3] / around / 2)
    one = _solid(
        scene, part, unknowns, entries, counts[3] / around, _tetrahedral_fill(unknowns, entries)
    )
    # four entries for every one, in pairs side by side: the factor is that of two-by-two blocks
    wide = 4 * _tetrahedral_fill(unknowns, entries)
    two = _solid(scene, part, 2 * unknowns, 4 * entries, counts[3] / around, wide)
    return Size(
        int(round((1 + 2 * further) * unknowns)),
        int((1 + 4 * further) * entries),
        two.largest,
        one.build_mb + further * two.build_mb,
        one.peak_mb + further * two.peak_mb,
        "lower refinement, or raise size and graded_size",
    )


def _half_sector(scene: Shaft, part, unknowns: float, entries: float, cells: float) -> Size:
    """Size of half a sector, from the unknowns and entries of the whole one, real."""
    further = len(part["ovalising"])
    half = unknowns / 2, entries / 2
    still = _solid(scene, part, *half, cells, _tetrahedral_fill(*half))
    # both parts of waves on the same elements, which meet on the cut face alone
    fill = 2 * _tetrahedral_fill(*half)
    waves = _solid(scene, part, unknowns, entries, cells, fill)
    return Size(
        # the two planes of bending are twins, of one matrix
        int(round((3 + further) * unknowns)),
        int((2 + further) * entries),
        waves.largest,
        2 * still.build_mb + (1 + further) * waves.build_mb,
        2 * still.peak_mb + (1 + further) * waves.peak_mb,
        "lower refinement, or raise size and graded_size",
    )


def _whole_teeth(scene: Shaft, given: Mapping[str, Any]) -> Size:
    """Size of all sectors as one 3D solid, estimated."""
    from solidgear.models.sector.body import sector_counts

    counts = sector_counts(scene, given)
    unknowns, entries = nodes("tet10", counts, 3)
    return _solid(scene, given, unknowns, entries, counts[3], _tetrahedral_fill(unknowns, entries))


def _tetrahedral_fill(unknowns: float, entries: float) -> float:
    """Entries of a factor: 21 meshes of 11,000 to 140,000 unknowns within 30 %."""
    return float(np.exp(0.519) * unknowns**1.313 * (entries / unknowns) ** 0.448)


def _hexahedra(scene: Shaft, given: Mapping[str, Any]) -> Size:
    from solidgear.models.solid.body import hexahedra_layout

    names = (
        "relative_size",
        "size",
        "layers",
        "edge_layers",
        "radial_layers",
        "ratio",
        "around",
        "refinement",
    )
    layout, around = hexahedra_layout(scene, given["attachments"], **{k: given[k] for k in names})
    plan = _lines(scene, layout)
    rows = sections(plan.rows, plan.solid_rows, around)
    lines = sections(plan.lines, plan.solid_lines, around)
    # a section drawn out along the shaft makes edges of its vertices, faces of its edges and cells
    # of its faces
    counts = (lines[0], lines[1] + rows[0], lines[2] + rows[1], rows[2])
    points, sides, cells = (around * more for more in blocks_beyond(layout.joints))
    # a meridian turned around: every point makes a circle of points and edges
    more = (points, points + sides, sides + cells, cells)
    counts = tuple(n + m for n, m in zip(counts, more))
    unknowns, entries = nodes(given["element"], counts, 4)
    bubbles = 3 * counts[3] if given["element"] == "hex27" else 0
    # fill grows with the whole and, as a shaft is long, with its cross-section: 30 meshes of 2,000
    # to 165,000 unknowns within 20 %
    width = unknowns / (2 * len(plan.rows))
    fill = (
        np.exp(1.448) * (unknowns - bubbles) ** 1.233 * (entries / unknowns) ** 0.165 * width**0.305
    )
    return _solid(scene, given, unknowns, entries, counts[3], fill)


def _given_mesh(scene: Shaft, given: Mapping[str, Any], body: BodyFile) -> Size:
    """Of a mesh that is what it is: counted, but for the fill of its factor."""
    assert body.counts is not None  # asked before
    element = solved_as(body.element)
    own = {**given, "element": element}
    unknowns, entries = nodes(element, body.counts, 4 if element[0] == "h" else 3)
    fill = np.exp(0.519) * unknowns**1.313 * (entries / unknowns) ** 0.448
    size = _solid(scene, own, unknowns, entries, body.counts[3], fill)
    return replace(size, lower="mesh the part coarser, or use the harmonic model of its round part")


def _tetrahedra(scene: Shaft, given: Mapping[str, Any], edges: bool = False) -> Size:
    from solidgear.meshing.cut_counts import around_cut
    from solidgear.meshing.element_size import estimated_counts
    from solidgear.models.solid.body import tetrahedra_plan

    wanted = [*attached_stations(scene.stations, given["attachments"])]
    holes = [
        partial(around_cut, feature, scene.segments, given["refinement"], edges)
        for feature in resolved(scene)
        if feature.sort == CUTS
    ]
    counts = estimated_counts(
        scene.segments,
        blends=scene.corners,
        holes=holes,
        **tetrahedra_plan(
            scene, wanted, **{k: given[k] for k in ("size", "graded_size", "refinement", "around")}
        ),
    )
    unknowns, entries = nodes(given["element"], counts, 3)
    parts = 2 if given["half"] and has_mirror_plane(scene) else 1
    # matrices, mesh and factors of both halves are held; the mesh is drawn once
    fill = parts * _tetrahedral_fill(unknowns / parts, entries / parts)
    return _solid(scene, given, unknowns, entries, counts[3] / parts, fill)


def has_mirror_plane(scene: Shaft) -> bool:
    """Whether all that is cut out of a shaft has one mirror plane."""
    from solidgear.meshing.cuts import mirror_plane

    cuts = resolved(scene)
    return bool(cuts) and all(f.sort == CUTS for f in cuts) and mirror_plane(cuts) is not None


def _solid(
    scene: Shaft,
    given: Mapping[str, Any],
    unknowns: float,
    entries: float,
    cells: float,
    fill: float,
) -> Size:
    per_cell = KINDS[given["element"]].cell
    tets = given["element"].startswith("tet")
    # matrices; mesh, its numbering and its quality; gmsh itself
    built = (1.11 * ENTRY * entries + 380.0 * per_cell * cells) / MB + 20 * tets
    # the shifted matrix while it is factored, and afterwards the vectors of the search for modes
    beside = (
        max(ENTRY * entries, 8.0 * 150 * unknowns) / MB
        + 16.0 * 6 * _ports(scene, given) * unknowns / MB
    )
    lower = (
        "lower refinement"
        + (", or raise size and graded_size" if tets else ", around or the layers, or raise size")
        + ", or use the harmonic model" * (not resolved(scene))
    )
    asked = {f.name: given[f.name] for f in fields(Factoring) if f.name in given}
    factoring = Factoring(**asked)
    parts = parts_of(scene, given["element"], given["attachments"], factoring)
    peak = built + beside + solid_factor_mb(unknowns, entries, fill, factoring, parts)
    return Size(
        int(round(unknowns)),
        int(entries),
        int(max(entries, per_cell**2 * cells)),
        float(built),
        float(peak),
        lower,
        float(fill),
    )
