"""Numbers, costs and the truth of random scenes on many meshes, one line of JSON a scene."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, TypeVar

from solidgear.body import as_supports
from solidgear.errors import SolidgearError
from solidgear.evidence.answer import ENOUGH, numbers
from solidgear.evidence.quantities import QUANTITIES
from solidgear.fidelity import build
from solidgear.fidelity.ladder import LADDER
from solidgear.machine.threads import pinned
from solidgear.scene import Scene
from solidgear.solve.families import FAMILIES
from solidgear.solve.modes import modes
from solidgear.solve.statics import condense
from solidgear.studies.climb import Climb, family_of, shapes
from validation.attack.reference import reference
from validation.attack.scenes import random_scene

T = TypeVar("T")

#: order, layers, edge layers and size of cells in least radii, from cheap to dear: those of the
#: pairs, and what lies between them
MEMBERS = (
    (2, 0, 0, 4),
    (3, 0, 0, 4),
    (2, 1, 0, 4),
    (3, 1, 0, 4),
    (3, 2, 0, 4),
    (4, 2, 0, 4),
    (3, 2, 1, 4),
    (4, 2, 1, 4),
    (4, 3, 2, 4),
    (5, 3, 2, 4),
    (5, 4, 3, 4),
    (6, 4, 3, 4),
)
#: no further mesh is solved after one of so many unknowns, unless told otherwise
MOST = 200_000
#: of all tolerances, at which the fewest couplings are left out
TIGHTEST = 1e-4
#: relative uncertainty that is asked of the reference
GOAL = 1e-5


def options_of(member: Iterable[int]) -> dict[str, Any]:
    """Builder options of a member."""
    order, layers, edge_layers, size = member
    return {
        "order": order,
        "layers": layers,
        "edge_layers": edge_layers,
        "relative_size": float(size),
    }


@pinned
def solved(
    scene: Scene, member: tuple[int, ...] = (), split: Sequence[tuple[str, ...]] = ()
) -> dict[str, Any]:
    """One mesh: numbers, what the solver left, unknowns, and processor seconds of building, statics
    and modes; without a member the mesh that the harmonic solid has unless told otherwise.

    ``parts`` are the seconds of every group of families in `split` alone.
    """
    options = options_of(member) if member else {}
    supports = as_supports(scene)
    body, spent = _timed(lambda: build(scene, "harmonic", **options))
    statics, more = _timed(lambda: condense(body, supports, scene.port.name))
    modal, most = _timed(lambda: modes(body, supports, ENOUGH, ovalising=False))
    found = numbers(statics, modal)
    return {
        "member": member,
        "size": body.size,
        "q": found.quantities,
        "solver": found.solver,
        "t": [spent, more, most],
        "parts": [_alone(scene, options, families) for families in split if len(split) > 1],
    }


def _alone(scene: Scene, options: dict[str, Any], families: tuple[str, ...]) -> list[float]:
    """Seconds of building, statics and modes of some families, as a climb solves them."""
    own = as_supports(scene).on(c for f in families for c in FAMILIES[f])
    body, spent = _timed(lambda: build(scene, "harmonic", **options, families=families))
    _, more = _timed(lambda: condense(body, own, scene.port.name))
    asked = tuple(q for q, (kind, *_) in QUANTITIES.items() if kind == "frequency")
    count = shapes(families, tuple(q for q in asked if family_of(q) in families))
    _, most = _timed(lambda: modes(body, own, count, ovalising=False))
    return [spent, more, most]


def _timed(job: Callable[[], T]) -> tuple[T, float]:
    start = time.process_time()
    return job(), time.process_time() - start


def row_of(seed: int, most: int = MOST) -> dict[str, Any]:
    """Everything about one scene."""
    out: dict[str, Any] = {"seed": seed}
    scene = random_scene(seed)
    out["ties"] = [s.attachment for s in scene.stations]
    out["groups"] = together(scene)
    out["members"] = []
    solved(scene, MEMBERS[0])  # what every scene is asked but once belongs to no mesh
    for member in MEMBERS:
        try:
            out["members"].append(solved(scene, member, out["groups"]))
        except (SolidgearError, ArithmeticError, ValueError) as error:
            out["members"].append({"member": member, "error": str(error)[:300]})
            continue
        if out["members"][-1]["size"] > most:
            break
    try:
        out["fixed"] = solved(scene)
    except SolidgearError as error:
        out["fixed"] = {"error": str(error)[:300]}
    truth = reference(scene, dict.fromkeys(QUANTITIES, GOAL))
    if truth is not None:
        out["ref"] = {"values": truth.values, "uncertainty": truth.uncertainty}
    return out


def together(scene: Scene) -> list[tuple[str, ...]]:
    """Families of motion that bearings couple, at the tightest tolerance."""
    climb = Climb(scene, LADDER["harmonic"], tuple(QUANTITIES), TIGHTEST, lambda _: None)
    return climb.needed(build(scene, "harmonic", **options_of(MEMBERS[0]))) or []


def collect(
    seeds: Iterable[int],
    path: Path,
    tell: Callable[[str], None] = lambda _: None,
    most: int = MOST,
) -> list[dict[str, Any]]:
    """Rows of all seeds, from the file as far as they are there."""
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = path.read_text().splitlines() if path.exists() else []
    known = {row["seed"]: row for row in map(json.loads, lines)}
    for seed in seeds:
        if seed in known:
            continue
        start = time.monotonic()
        try:
            row = row_of(seed, most)
        except (SolidgearError, ArithmeticError, ValueError) as error:
            row = {"seed": seed, "error": str(error)[:300]}
        known[seed] = row
        with path.open("a") as file:
            file.write(json.dumps(row) + "\n")
        tell(f"seed {seed}: {time.monotonic() - start:.0f} s {row.get('error', '')}")
    return [known[seed] for seed in seeds if seed in known]
