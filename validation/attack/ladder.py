"""How far harmonic solids of several settings are from the reference, scene by scene: one JSON
line each.

    python -m validation.attack.ladder --seeds 0:60 --out validation/results/attack/ladder.jsonl

Scenes that are in the file already are passed over, so that a run can be stopped and continued.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

from solidgear.body import as_supports
from solidgear.errors import SolidgearError
from solidgear.evidence.quantities import measure
from solidgear.fidelity import build
from solidgear.solve.modes import modes
from solidgear.solve.statics import condense
from validation.attack import reference as finest
from validation.attack.scenes import TIES, random_scene, traits

#: order, layers, edge layers, cell size in least outer radii
SETTINGS = (
    (2, 0, 0, 4),
    (3, 1, 0, 4),
    (3, 2, 1, 4),
    (4, 2, 1, 4),
    (4, 3, 1, 4),
    (5, 3, 1, 4),
    (5, 4, 2, 4),
)
RATIO = 0.2
#: s of processor time; after a setting that took longer, the finer ones are left out
DEAR = 2.5
FIELDS = {
    "seed, kind, l_over_d, steps, segments, wall_over_radius, ties, attachments, bearings, "
    "coupled, unequal, stiffest, tolerance": "of the scene",
    "reference": "quantity (as in solidgear.evidence.quantities) -> value",
    "uncertainty": "quantity -> relative uncertainty of the reference (couplings: of sqrt(zz thx))",
    "reference_setting": "order and layers (ratio 0.2, corners only) of the finest of its meshes",
    "runs": "one per setting: order, layers, edge_layers, size (times least outer radius), ratio, "
    "values (quantity -> value), unknowns (all blocks), cells, "
    "seconds (processor time: build, statics, modes), or failed (the reason); "
    "the dearest are left out",
    "skipped": "in place of the reference: why there is none",
}


def rung(scene, order: int, layers: int, edge_layers: int, size: float) -> dict:
    """One setting on one scene."""
    told = {
        "order": order,
        "layers": layers,
        "edge_layers": edge_layers,
        "size": size,
        "ratio": RATIO,
    }
    least = min(min(s.outer0, s.outer1) for s in scene.segments)
    options = {
        "order": order,
        "layers": layers,
        "edge_layers": edge_layers,
        "size": size * least,
        "ratio": RATIO,
        "refinement": 1.0,
        "ovalising": (),
    }
    start = time.process_time()
    try:
        body = build(scene, "harmonic", **options)
        supports = as_supports(scene)
        values = measure(
            condense(body, supports, scene.port.name),
            modes(body, supports, max(scene.ask.modes, 10)),
        )
    except SolidgearError as error:
        return told | {"failed": str(error)}
    return told | {
        "values": values,
        "unknowns": body.size,
        "cells": body.mesh["cells"],
        "seconds": time.process_time() - start,
    }


def line(seed: int, ties: str | None, goal: float, limit: int) -> dict:
    """All settings on the scene of one seed."""
    scene = random_scene(seed, ties=ties)
    out = {"seed": seed} | traits(scene)
    truth = finest.reference(scene, goal, limit)
    if truth is None:
        return out | {"skipped": f"more than {limit} unknowns"}
    out |= {
        "reference": truth.values,
        "uncertainty": truth.uncertainty,
        "reference_setting": truth.setting,
        "reference_seconds": truth.seconds,
    }
    runs = []
    for setting in SETTINGS:
        if runs and runs[-1].get("seconds", 0.0) > DEAR:
            break
        runs.append(rung(scene, *setting))
    return out | {"runs": runs}


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", default="0:60", help="first:end")
    parser.add_argument("--out", type=Path, default=finest.FOLDER.parent / "ladder.jsonl")
    parser.add_argument(
        "--ties", choices=TIES, nargs="*", help="in turn, instead of as the seed says"
    )
    parser.add_argument(
        "--goal", type=float, default=1e-5, help="relative uncertainty of the reference"
    )
    parser.add_argument(
        "--limit",
        type=int,
        default=finest.MOST_UNKNOWNS,
        help="unknowns of the reference's bending block",
    )
    parser.add_argument("--minutes", type=float, default=15.0)
    options = parser.parse_args()
    options.out.parent.mkdir(parents=True, exist_ok=True)
    done = set()
    if options.out.exists():
        done = {json.loads(text).get("seed") for text in options.out.read_text().splitlines()}
    else:
        options.out.write_text(json.dumps({"fields": FIELDS}) + "\n")
    first, end = map(int, options.seeds.split(":"))
    start = time.monotonic()
    for seed in range(first, end):
        if seed in done or time.monotonic() - start > 60 * options.minutes:
            continue
        ties = options.ties[seed % len(options.ties)] if options.ties else None
        row = line(seed, ties, options.goal, options.limit)
        with options.out.open("a") as file:
            file.write(json.dumps(row) + "\n")
        print(
            f"{time.monotonic() - start:6.0f} s  {seed:5d} {row['kind']:10s} {row['ties']:8s}",
            row.get("skipped", ""),
            flush=True,
        )


if __name__ == "__main__":
    main()
