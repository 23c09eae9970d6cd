"""True numbers of a part with features: tetrahedra of the whole part, ever finer,
beside the plain part on the same sizes, of which the truth is known.

With ``X`` a number of the part and ``P`` that of its plain shaft, both of one mesh of tetrahedra, and
``H`` that of a fine harmonic solid,

    compliances, stiffnesses:  X + (H - P),        frequencies:  X H / P

are free of what the mesh errs at seats and shoulders. Three meshes, each 1.4 times finer than the one
before and twice as fine at features, are extrapolated. Sectors have no mesh in common with their plain
part: there the truth is that of three sectors of which the finest is two meshes beyond the last that
is judged (one, where that is too large), extrapolated at the order of the sharpest corner. Nothing of
this passes through free modes,
their turning or port numbers, which is what `corrected` is made of; bearings are on the 3D solid.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.bounds.singular_places import sharpest_exponent
from solidgear.core.judge.quantities import size
from solidgear.core.judge.solving import Answer, answer_of_body, solve
from solidgear.core.ladder.registry import LADDER
from solidgear.core.meshing.corners import SHOULDER
from solidgear.core.models.solid.plan import tetrahedra_plan
from solidgear.core.quantity import QUANTITIES
from solidgear.core.scene.shaft import resolved
from solidgear.core.solve.mixtures import mixtures
from solidgear.cuts.sector.body import sector
from solidgear.cuts.solid.cuts import mirror_plane
from solidgear.cuts.solid.featured import featured_body, meshed

#: of the plain part, and a coarser one whose distance tells how sure it is
PLAIN = {"order": 5, "layers": 3, "edge_layers": 2, "relative_size": 4.0}
COARSER = {"order": 4, "layers": 2, "edge_layers": 1, "relative_size": 4.0}
#: share of that distance that is left: what the bars of the harmonic solid count on
LEFT = 0.25
#: refinement away from features and at them
CUT_LEVELS = ((0.22, 0.45), (0.3, 0.64), (0.42, 0.9))
#: refinement of sectors: the model's meshes from the third on, which is the last that is judged, or
#: from the second on
SECTOR_LEVELS = ((1.4, 2.0, 2.8), (1.0, 1.4, 2.0))
#: estimated unknowns of the first of these above which the second are taken
MOST_OF_SECTORS = 50_000
#: elements of the finest mesh (of a half) above which all three are coarser; a part without a mirror
#: plane has twice as many
MOST = 4_000
#: doubt over what the larger of the last two changes leaves at the order of the sharpest corner
DOUBT_OF_SECTORS = 0.4
#: size of elements at seats and shoulders over the largest, of cuts
AT_EDGES = 1 / 8
#: the limit over the last step: 2.2 at the order of a right-angled shoulder (1.09), 1 at second order
AHEAD = 1.6
#: doubt over the last step, and over the one before
DOUBT = (1.2, 0.4)
#: frequencies of a pair of bending modes; with a mirror plane those of its two planes
PAIR = ("pair 1", "pair 2")
ADDED = tuple(q for q in QUANTITIES if not q.is_frequency)


@dataclass(frozen=True)
class Numbers:
    """True values of one part; all but the values relative to the size of the quantity.

    Attributes
    ----------
    values, doubt : dict of str to float
    effect : dict of str to float
        What features change.
    """

    values: dict[str, float]
    doubt: dict[str, float]
    effect: dict[str, float]


def numbers(answer: Answer) -> dict[str, float]:
    """Compared numbers, with the first bending pair by plane, or by frequency where it has none."""
    found = answer.quantities
    # a name that is a toss-up means one mode here and another on the next mesh
    tossed = {name for m in mixtures(answer.modes) for name in (m.name, m.partner)}
    out = {q: v for q, v in found.items() if not q.startswith("bending") and q not in tossed}
    by_plane = [answer.modes.named(f"bending {c} 1") for c in "zx"]
    if None in by_plane:
        by_plane = [_by_block(answer, c) for c in (2, 0)]
    if None in by_plane:
        bending = [m for m in answer.modes.modes if m.name.startswith("bending")]
        pair = sorted(m.frequency_hz for m in bending for _ in m.vectors)[:2]
    else:
        pair = [m.frequency_hz for m in by_plane if m is not None]
        if "sectors" in answer.body.mesh:
            pair.sort()  # planes of half a sector are those of no feature: as of the plain part
    return out | dict(zip(PAIR, pair))


def _by_block(answer: Answer, component: int):
    """The lowest bending mode of the block of one plane, where planes are blocks of their own."""
    blocks = answer.body.blocks
    own = [
        k
        for k, b in enumerate(blocks)
        if component in b.components and 2 - component not in b.components
    ]
    for mode in answer.modes.modes:
        if mode.name.startswith("bending") and any(k in own for v in mode.vectors for k in v):
            return mode
    return None


def truth(scene: sg.Scene, text: str, folder: Path) -> Numbers:
    """Reference of a scene with features that are cut or repeat themselves, from the folder if it
    is there under the text of its file.
    """
    key = json.dumps(
        [PLAIN, COARSER, LEFT, CUT_LEVELS, SECTOR_LEVELS, AT_EDGES, AHEAD, DOUBT, MOST]
        + [MOST_OF_SECTORS, DOUBT_OF_SECTORS]
    )
    path = folder / f"{hashlib.sha256((key + text).encode()).hexdigest()[:16]}.json"
    if path.exists():
        return Numbers(**json.loads(path.read_text()))
    found = _of_cuts(scene) if LADDER["sector"].unfit(scene) else _of_sectors(scene)
    folder.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(asdict(found)))
    return found


def _of_cuts(scene: sg.Scene) -> Numbers:
    plain, coarser = (solve(scene.plain, "harmonic", **level) for level in (PLAIN, COARSER))
    h, c = (_like(one, split=not _whole(scene)) for one in (plain, coarser))
    steps = []
    for with_, without in _cuts(scene):
        x, p = numbers(with_), numbers(without)
        known = [q for q in x if q in p and q in h]
        steps.append({q: x[q] + h[q] - p[q] if q in ADDED else x[q] * h[q] / p[q] for q in known})
    values, doubt, effect = {}, {}, {}
    for q in (q for q in steps[-1] if all(q in one for one in steps)):
        first, second, third = (one[q] for one in steps)
        values[q] = third + AHEAD * (third - second)
        doubt[q] = max(DOUBT[0] * abs(third - second), DOUBT[1] * abs(second - first))
    for q in values:
        scale = size(values, q)
        doubt[q] = (doubt[q] + LEFT * abs(h[q] - c.get(q, h[q]))) / scale
        effect[q] = (values[q] - h[q]) / scale
    return Numbers(values, doubt, effect)


def _whole(scene: sg.Scene) -> bool:
    """Its features have no mirror plane."""
    return mirror_plane(resolved(scene)) is None


def _like(plain: Answer, split: bool) -> dict[str, float]:
    """Numbers of the plain part with the pair by plane, or by frequency."""
    h = numbers(plain)
    if not split and all(p in h for p in PAIR):
        h.update(zip(PAIR, sorted(h[p] for p in PAIR)))
    return h


def _cuts(scene: sg.Scene) -> Iterator[tuple[Answer, Answer]]:
    wanted = [(s, s.attachment) for s in scene.stations]

    def made_at(level: tuple[float, float], scale: float):
        sizes = {"size": None, "graded_size": None, "refinement": scale * level[0]}
        plan = tetrahedra_plan(scene, wanted, around=16, **sizes)
        plan["graded_size"] = plan["size"] * AT_EDGES
        return meshed(scene, plan, scale * level[1], True)

    most = MOST * (2 if _whole(scene) else 1)
    scale = _affordable(lambda s: made_at(CUT_LEVELS[-1], s).mesh.t.shape[1], most)
    for level in CUT_LEVELS:
        made, own = made_at(level, scale), scale * level[1]
        yield tuple(
            _answered(partial(featured_body, scene, wanted, made, own, plain=p), scene)
            for p in (False, True)
        )


def _of_sectors(scene: sg.Scene) -> Numbers:
    coarsest = LADDER["sector"].size(scene, {"refinement": SECTOR_LEVELS[0][0]})
    large = coarsest.unknowns > MOST_OF_SECTORS
    found = []
    for refinement in SECTOR_LEVELS[large]:
        one = _answered(partial(sector, scene, refinement=refinement), scene)
        found.append((numbers(one), one.body.mesh["representative_size"]))
    return extrapolated(scene, found)


def extrapolated(scene: sg.Scene, found: list[tuple[dict[str, float], float]]) -> Numbers:
    """The truth from numbers and sizes of cells of three sectors, coarse to fine."""
    plain = numbers(solve(scene.plain, "harmonic", **PLAIN))
    order = 2 * min(SHOULDER, sharpest_exponent(scene))
    ahead = 1 / ((found[-2][1] / found[-1][1]) ** order - 1)
    values, doubt, effect = {}, {}, {}
    for q in (q for q in found[-1][0] if all(q in own for own, _ in found)):
        first, second, third = (own[q] for own, _ in found)
        values[q] = third + ahead * (third - second)
        doubt[q] = DOUBT_OF_SECTORS * ahead * max(abs(third - second), abs(second - first))
    for q in values:
        scale = size(values, q)
        doubt[q] /= scale
        effect[q] = (values[q] - plain[q]) / scale if q in plain else 0.0
    return Numbers(values, doubt, effect)


def _affordable(elements: Callable[[float], int], most: int) -> float:
    """Divisor of all sizes so that the finest mesh is not too large."""
    scale = 1.0
    for _ in range(4):
        count = elements(scale)
        if count <= most:
            break
        scale *= 0.95 * (most / count) ** (1 / 2.2)
    return scale


def _answered(build: Callable[[], Any], scene: sg.Scene) -> Answer:
    body = build()
    found = answer_of_body(body, as_supports(scene), (scene.port.name,), n=8)
    body.cache.clear()  # its factors
    return found
