"""Do bars of a 3D solid, computed on the one mesh that was set, hold? Bodies drawn to break them and
random shafts, by themselves and in STEP and mesh files, against the harmonic solid, which shares no
mesh and no function with it; parts with features, sectors, blocks and brackets against finer meshes,
families of other bodies against elements of our own.  Numbers of several meshes of a body never exclude
each other.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import time
from collections import Counter
from collections.abc import Callable, Sequence
from itertools import takewhile
from pathlib import Path
from typing import Any

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.judge.bars import ErrorBar
from solidgear.core.judge.bounded import bounded
from solidgear.core.judge.quantities import size
from solidgear.core.judge.solving import Statics, answer_of_body, numbers, search_modes
from solidgear.core.ladder import build
from solidgear.core.ladder.registry import LADDER
from solidgear.core.ladder.solid import AROUND, HEXAHEDRA, TETRAHEDRA, Level
from solidgear.core.machine.whole_file import whole
from solidgear.core.quantity import STIFFNESS, Quantity
from solidgear.core.solve.modes import ModeSet
from validation.agree import nested
from validation.agree.relation import Number, failed
from validation.campaign.case import Case, Run
from validation.campaign.cases.answers import ASKED, kind_of, scene_of
from validation.campaign.rows import DECIDED, Cost, Found, Row, Truth
from validation.campaign.scenes.bodies import BODIES
from validation.campaign.scenes.families import FAMILIES
from validation.campaign.scenes.solids import (
    BRICKS,
    ELSEWHERE,
    FEATURES,
    HARMONIC,
    MESH_FILE,
    PARTS,
    SECTORS,
    STEP,
    Mesh,
    Part,
)
from validation.campaign.truths import features
from validation.campaign.truths.elsewhere import FREQUENCIES, reference
from validation.campaign.truths.kept import name_of

#: relative error of the true values asked for
FINE = 3e-5
#: shapes that are searched for
SHAPES = 10
#: modes of a body without an axis that are judged
MODES = 4
#: refinements of sectors that are the truth
FINER = (0.35, 0.5, 0.7)

SORTS = PARTS | FAMILIES

_LAYERED = [{**level, "around": AROUND} for level in HEXAHEDRA[:3]]
#: what is solved: by the name of an element, meshes coarse to fine
MESHES: dict[str, list[Level]] = {
    "tet10": [{"refinement": 0.2}, {"refinement": 0.3}, TETRAHEDRA[0]],
    "hex20": _LAYERED,
    "hex27": _LAYERED[:1],
}
#: kinds of rows beside those of numbers
LOWER, OF_MESH = "lower side", "value of the mesh"


class Solids(Case):
    """Every number of a mesh: its bar about the middle, that about what the mesh gives, and the least
    by which a compliance grows (`lower side`, the error in place of the bar, the growth in place of
    the error).
    """

    name, question = "solids", "bars of a 3D solid on one mesh that was set"
    parts = ((), ("part",), ("element",), ("kind",), ("part", "element", "kind"))
    details = (("element", "mesh"), ("part", "quantity"))
    seeds = (99201, 99260)
    tag_of_costs = "stage"

    def options(self, parser: argparse.ArgumentParser) -> None:
        add = parser.add_argument
        add("--words", nargs="*", help="drawn bodies whose names have one of these words")
        add("--no-drawn", action="store_true", help="leave the drawn bodies out")
        add("--no-random", action="store_true", help="leave the random shafts out")
        add("--sorts", nargs="*", default=list(SORTS), choices=list(SORTS), help="other bodies")
        add("--parts", type=int, default=10, help="of every sort, from the first seed on")
        add("--elements", nargs="+", default=list(MESHES), choices=list(MESHES), help="of shafts")
        add("--limit", type=int, default=30_000, help="unknowns of a mesh")

    def bodies(self, given: argparse.Namespace) -> list[tuple[str]]:
        words = given.words or [""]
        drawn = [name for name in BODIES if any(word in name for word in words)]
        first, last = given.seeds
        random = [f"random {seed}" for seed in range(first, last + 1)]
        chosen = drawn * (not given.no_drawn) + random * (not given.no_random)
        others = [f"{sort} {first + k}" for k in range(given.parts) for sort in given.sorts]
        return [(name,) for name in (*chosen, *others)]

    def judge(self, run: Run, body: str) -> Found:
        part, problem = run.call(part_of, body, run.folder / self.name, run.given.elements)
        if problem:
            return Found(problems=[f"{body}: {problem}"])
        out, light, densities = Found(), [], Counter[str]()
        unknowns, problem = run.call(unknowns_of, part)
        for mesh, count in zip(part.meshes, unknowns or ()):
            densities[mesh.element] += 1
            tags = {"part": part.sort, "element": mesh.element}
            tags["mesh"] = str(densities[mesh.element])
            if count > run.given.limit:
                reason = f"{count} unknowns are more than {run.given.limit}"
                out.problems.append(f"{body}, {mesh.element} {tags['mesh']}: {reason}")
            else:
                light.append((mesh, tags, count))
        if light:
            truths, problem = _kept_truths(run, part)
        if problem:
            return Found(problems=[f"{body}: {problem}"])
        for mesh, tags, count in light:
            found, problem = run.call(judged, body, mesh, tags, truths, count)
            if problem:
                out.problems.append(f"{body}, {mesh.element} {tags['mesh']}: {problem}")
                continue
            out.add(found)
        out.failures += map(str, failed(nested.beside(body, claims_of(out.rows))))
        return out


def claims_of(rows: Sequence[Row]) -> dict[str, dict[str, Number]]:
    """Numbers by their mesh, counted from the truth in sizes of the quantity: whatever that is, intervals
    of two meshes meet or exclude each other.
    """
    claims: dict[str, dict[str, Number]] = {}
    for row in rows:
        if row.tags["kind"] not in (LOWER, OF_MESH) and row.error is not None:
            mesh = claims.setdefault(f"{row.tags['element']} {row.tags['mesh']}", {})
            mesh[row.quantity] = Number.within(row.error, row.bar, 1.0)
    return claims


def _kept_truths(run: Run, part: Part) -> tuple[dict[str, Truth], str]:
    """True values of a body, kept under what they were computed from, or why there are none."""
    names = [name_of(scene) for scene in part.exact]
    name = names[0] if len(names) == 1 else hashlib.sha256("".join(names).encode()).hexdigest()[:20]
    kind = "answer" if part.source == HARMONIC else part.source
    path = run.folder / "references" / f"{kind}-{name}.json"
    if not path.exists():
        values, problem = run.call(TRUTHS[part.source], part, run.folder / "features")
        if problem:
            return {}, f"no reference: {problem}"
        path.parent.mkdir(parents=True, exist_ok=True)
        with whole(path) as partial:
            partial.write_text(json.dumps(values))
    values = json.loads(path.read_text())
    if part.sort in (STEP, MESH_FILE):  # one mode of a pair, by both its names
        values["bending 2"] = values["bending 1"]
    return {name: Truth(**value) for name, value in values.items()}, ""


# ------------------------------------------------------------------------------------------------
# - asked of a worker
def part_of(body: str, folder: Path, elements: Sequence[str]) -> Part:
    """A body by its name: with the meshes of a shaft of revolution, or a part of another sort."""
    sort, *seed = body.split()
    if sort in SORTS:
        folder.mkdir(parents=True, exist_ok=True)
        return SORTS[sort](int(seed[0]), folder)
    scene = scene_of(body)
    levels = [(element, level) for element in elements for level in MESHES[element]]
    meshes = [Mesh(scene, element, {"element": element, **level}) for element, level in levels]
    return Part("shaft", meshes, HARMONIC, [scene])


def unknowns_of(part: Part) -> list[int]:
    """Unknowns of all meshes of a body."""
    sizes = [LADDER[mesh.model].size(mesh.scene, mesh.options) for mesh in part.meshes]
    return [int(size.unknowns) for size in sizes]


def answered(part: Part, folder: Path) -> dict[str, dict]:
    """True values by their names, as plain data, of a shaft of revolution."""
    answer = sg.answer(part.exact[0], FINE, ask=ASKED)
    if answer.rung != "harmonic":
        raise ValueError(f"answered by the {answer.rung}")
    return {
        str(v.quantity): {"value": v.value, "uncertainty": v.bar, "size": v.size, "how": "harmonic"}
        for v in answer.values
    }


def of_features(part: Part, folder: Path) -> dict[str, dict]:
    """The same of a part with features, from ever finer meshes beside those of its plain shaft."""
    return _by_names(part, features.truth(part.exact[0], part.text, folder))


def of_sectors(part: Part, folder: Path) -> dict[str, dict]:
    """The same of equal sectors, from three finer meshes."""
    scene, found = part.exact[0], []
    for refinement in FINER:
        body = build(scene, "sector", refinement=refinement)
        answer = answer_of_body(body, as_supports(scene), (scene.port.name,), n=8)
        found.append((features.numbers(answer), body.mesh["representative_size"]))
        body.cache.clear()
    return _by_names(part, features.extrapolated(scene, found))


def _by_names(part: Part, found: features.Numbers) -> dict[str, dict]:
    """True values of a part with features under the names of its modes."""
    names = {SECTORS: ("bending 1", ""), "half": ("bending z 1", "bending x 1")}
    pair = names.get(part.source) or names.get(part.sort) or ("bending 1", "bending 2")
    named = dict(zip(features.PAIR, pair))
    return {
        named.get(name, name): {
            "value": value,
            "uncertainty": found.doubt[name],
            "size": size(found.values, name),
            "how": part.source,
        }
        for name, value in found.values.items()
        if named.get(name, name)
    }


def of_bricks(part: Part, folder: Path) -> dict[str, dict]:
    """The same of a body of boxes, from bricks that are graded towards edges; what the last mesh
    changed is open.
    """
    found = []
    for scene in part.exact:
        body = build(scene, "solid")
        answer = answer_of_body(body, as_supports(scene), (scene.port.name,), n=8)
        elastic = [mode for mode in answer.modes.modes if mode.frequency_hz > 0]
        found.append(answer.quantities | {m.name: m.frequency_hz for m in elastic[:MODES]})
        body.cache.clear()
    coarse, fine = found
    return {
        str(name): {
            "value": value,
            "uncertainty": abs(value - coarse[name]) / size(fine, name),
            "size": size(fine, name),
            "how": part.source,
        }
        for name, value in fine.items()
        if name in coarse
    }


def of_drawing(part: Part, folder: Path) -> dict[str, dict]:
    """The same of a body that is drawn, by elements of our own."""
    assert part.drawing is not None
    found = reference(part.drawing)
    values = {name: value for name, (value, _) in found.items()}
    return {
        name: {"value": value, "uncertainty": doubt, "size": size(values, name), "how": part.source}
        for name, (value, doubt) in found.items()
    }


TRUTHS = {
    HARMONIC: answered,
    FEATURES: of_features,
    SECTORS: of_sectors,
    BRICKS: of_bricks,
    ELSEWHERE: of_drawing,
}


def judged(
    body: str, mesh: Mesh, tags: dict[str, str], truths: dict[str, Truth], unknowns: int
) -> Found:
    """Bars of one mesh, held against the truth, and what each stage cost."""
    scene, found = mesh.scene, Found()

    def timed(stage: str, function: Callable[..., Any], *arguments: Any, **rest: Any) -> Any:
        start = time.process_time()
        result = function(*arguments, **rest)
        spent = time.process_time() - start
        found.costs.append(Cost(body, {"stage": stage, **tags}, spent, unknowns))
        return result

    solid = timed("build", build, scene, mesh.model, **mesh.options)
    supports = as_supports(scene)
    places = [name for name in FREQUENCIES if name in truths]
    known = [Quantity(name) for name in truths if name not in places]
    statics = None
    if supports.ports:
        statics = timed("statics", Statics.for_quantities, scene, solid, supports, known)
    frequencies = [name for name in known if name.is_frequency]
    if places:
        lowest = sg.modes(solid, supports, SHAPES).modes
        frequencies = [Quantity(m.name) for m in lowest if m.frequency_hz > 0][: 2 * len(places)]
    modes = timed("modes", search_modes, solid, supports, SHAPES, frequencies, spare=True)
    values = numbers(statics, modes)
    own = {name: m.frequency_hz for name in frequencies if (m := modes.named(name)) is not None}
    own |= values.quantities
    names = [name for name in dict.fromkeys((*known, *frequencies)) if name in own]
    given = (scene, solid, supports, statics, modes, names, values.solver)
    bars = timed("estimate", bounded, *given).error_bars

    def add(name: str, kind: str, bar: float, error: float) -> None:
        truth = truths[name]
        found.rows.append(
            Row(
                body=body,
                quantity=name,
                tags={**tags, "kind": kind, "quantity": name},
                bar=float(bar),
                error=float(error),
                doubt=truth.uncertainty,
                how=f"{truth.how}, {unknowns} unknowns",
                rule=DECIDED,
            )
        )

    for name in (name for name in known if name in bars):
        for kind, bar, error in rows_of(name, own[name], bars[name], size(own, name), truths[name]):
            if kind != LOWER or mesh.model != "corrected":  # which errs to both sides
                add(str(name), kind, bar, error)
    for name, (value, low) in ascending(bars, modes).items() if places else ():
        add(name, "mode", 1 - low / value, value / truths[name].value - 1)
    return found


def ascending(bars: dict[Quantity, ErrorBar], modes: ModeSet) -> dict[str, tuple[float, float]]:
    """The k-th frequency, Hz, and the k-th of the lower ends of all: where every mode lies within its
    bar, the k-th of the body lies between them, whatever its shape.
    """
    elastic = [m for m in modes.modes if m.frequency_hz > 0]
    known = takewhile(lambda m: m.name in bars, elastic)  # beyond, places are not known
    listed = [m for m in known for _ in m.vectors]
    values = sorted(m.frequency_hz for m in listed)
    lows = sorted(m.frequency_hz * (1 - bars[Quantity(m.name)].width) for m in listed)
    return dict(zip(FREQUENCIES, zip(values, lows)))


def rows_of(
    name: Quantity, value: float, bar: ErrorBar, scale: float, truth: Truth
) -> list[tuple[str, float, float]]:
    """Kind, bar and error of a number about the middle of both its ends, and about what the mesh
    gives; of one that grows with every function the whole error as a limit of its least growth.
    """
    if bar.middle is None:
        return [(kind_of(str(name)), bar.width, (value - truth.value) / scale)]
    out = [
        (kind_of(str(name)), bar.about_middle, (bar.middle - truth.value) / scale),
        (OF_MESH, bar.width, (value - truth.value) / scale),
    ]
    if name.diagonals is None:
        far = value + bar.factor * (bar.extrapolated - value)
        sign = -1.0 if name.kind == STIFFNESS else 1.0
        least = sign * (2 * bar.middle - far - value) / scale
        out.append((LOWER, sign * (truth.value - value) / scale, least))
    return out
