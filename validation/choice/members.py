"""Numbers, costs and the truth of random scenes on many meshes, one line of JSON a scene."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from solidgear.body import as_supports
from solidgear.errors import SolidgearError
from solidgear.evidence.answer import ENOUGH, numbers
from solidgear.evidence.quantities import QUANTITIES
from solidgear.fidelity import build
from solidgear.machine.threads import pinned
from solidgear.scene import Scene
from solidgear.solve.modes import modes
from solidgear.solve.statics import condense
from validation.attack.reference import reference
from validation.attack.scenes import random_scene

#: order, layers, edge layers and size of cells in least radii, from cheap to dear: those of the
#: ladder, and what lies between them
MEMBERS = (
    (2, 0, 0, 4),
    (2, 1, 0, 4),
    (3, 1, 0, 4),
    (3, 2, 0, 4),
    (4, 2, 0, 4),
    (4, 2, 1, 4),
    (4, 3, 1, 4),
    (5, 3, 1, 4),
    (5, 3, 2, 4),
    (6, 4, 2, 4),
    (6, 4, 3, 4),
)
#: no further mesh is solved after one of so many unknowns
MOST = 200_000
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
def solved(scene: Scene, member: tuple[int, ...] = ()) -> dict[str, Any]:
    """One mesh: numbers, what the solver left, unknowns, and processor seconds of building, statics
    and modes; without a member the mesh that the harmonic solid has unless told otherwise.
    """
    marks = [time.process_time()]
    body = build(scene, "harmonic", **(options_of(member) if member else {}))
    marks.append(time.process_time())
    supports = as_supports(scene)
    statics = condense(body, supports, scene.port.name)
    marks.append(time.process_time())
    found = numbers(statics, modes(body, supports, ENOUGH, ovalising=False))
    marks.append(time.process_time())
    spent = [b - a for a, b in zip(marks, marks[1:])]
    return {
        "member": member,
        "size": body.size,
        "q": found.quantities,
        "solver": found.solver,
        "t": spent,
    }


def row_of(seed: int) -> dict[str, Any]:
    """Everything about one scene."""
    out: dict[str, Any] = {"seed": seed}
    scene = random_scene(seed)
    out["ties"] = [s.attachment for s in scene.stations]
    out["members"] = []
    for member in MEMBERS:
        try:
            out["members"].append(solved(scene, member))
        except (SolidgearError, ArithmeticError, ValueError) as error:
            out["members"].append({"member": member, "error": str(error)[:300]})
            continue
        if out["members"][-1]["size"] > MOST:
            break
    try:
        out["fixed"] = solved(scene)
    except SolidgearError as error:
        out["fixed"] = {"error": str(error)[:300]}
    truth = reference(scene, dict.fromkeys(QUANTITIES, GOAL))
    if truth is not None:
        out["ref"] = {"values": truth.values, "uncertainty": truth.uncertainty}
    return out


def collect(
    seeds: Iterable[int], path: Path, tell: Callable[[str], None] = lambda _: None
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
            row = row_of(seed)
        except (SolidgearError, ArithmeticError, ValueError) as error:
            row = {"seed": seed, "error": str(error)[:300]}
        known[seed] = row
        with path.open("a") as file:
            file.write(json.dumps(row) + "\n")
        tell(f"seed {seed}: {time.monotonic() - start:.0f} s {row.get('error', '')}")
    return [known[seed] for seed in seeds if seed in known]
