"""Derivatives of random shafts against central differences of the whole computation.

    python -m validation.derivatives --seeds 1 50
    python -m validation.derivatives --seeds 1 50 --model timoshenko

All numbers of a file are changed up and down at once, along random directions. The harmonic solid is then built on the mesh that
has moved with it (light meshes: what is compared is exact on any), a beam as the program builds it,
with many elements. Told is the largest error of a change, in the strongest of its parts, and what differences on a moved mesh cannot tell: surfaces that part in two, seats that slide on it.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.models.harmonic import body as harmonic_body
from solidgear.models.harmonic.derivative import HarmonicAdjoint
from solidgear.models.harmonic.motion import Motion
from solidgear.quantity import COMPLIANCE, Quantity
from solidgear.scene import Scene
from solidgear.scene.file import scene_of
from solidgear.scene.paths import entry, label_of
from solidgear.scene.toml_file import parse
from solidgear.studies.sensitivity.entries import around, numbers, put
from validation.campaign.scenes.shafts import random_scene

OF = ("bending 1", "C_zz", "K_thx", "axial 1")
#: of each shaft
DIRECTIONS = 2
OPTIONS: dict[str, dict[str, Any]] = {
    "harmonic": {"order": 3, "layers": 1, "edge_layers": 0, "relative_size": 2.0},
    "timoshenko": {"elements": 500},
    "euler": {"elements": 200},
}


def toml_of(scene: Scene) -> str:
    """The file of a scene of segments, bearings, housing and a port."""

    def material(one: Any) -> dict:
        return {"E": one.E, "nu": one.nu, "density": one.density}

    shapes: list[dict] = []
    for s in scene.segments:
        ends = {"start_diameter": 2 * s.outer0, "end_diameter": 2 * s.outer1}
        if s.outer0 == s.outer1:
            ends = {"diameter": 2 * s.outer0}
        kind = {"kind": "cylinder" if s.outer0 == s.outer1 else "cone", "name": s.name}
        own = {"bore": 2 * s.inner0, "material": material(s.material)}
        shapes.append({**kind, "length": s.y1 - s.y0, **ends, **own})
    bearings = [
        {
            "name": b.name,
            "position": b.y,
            "seat_width": b.seat_width,
            "attachment": b.attachment,
            "matrix": [list(row) for row in b.matrix or ()],
            "axial_series": list(b.axial_series),
        }
        for b in scene.bearings
    ]
    port: dict[str, Any] = {
        "name": "gear",
        "position": scene.port.y,
        "attachment": scene.port.attachment,
    }
    spans = {(s.y0, s.y1): s.name for s in scene.segments}
    span = scene.port.lo, scene.port.hi
    port |= {"attach_to": spans[span]} if span in spans else {"span": list(span)}
    tables = {
        "material": material(scene.material),
        "segment": shapes,
        "bearing": bearings,
        "port": port,
    }
    if scene.housing_axial is not None:
        tables["housing"] = {"axial": scene.housing_axial}
    return "\n".join(f"{key} = {_written(value)}" for key, value in tables.items()) + "\n"


def _written(value: Any) -> str:
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_written(own)}" for key, own in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ",\n".join(map(_written, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else repr(float(value))


def values(body: sg.Body, scene: Scene, wanted: Mapping[str, bool]) -> np.ndarray:
    """Numbers of a body; of a pair, which a change may split, the mean."""
    static = sg.condense(body, scene, port=scene.port.name)
    shapes = sg.modes(body, scene, n=scene.ask.modes)
    out = []
    for name, pair in wanted.items():
        one = Quantity(name)
        if not one.is_frequency:
            out.append(one.of(static.compliance if one.kind == COMPLIANCE else static.stiffness))
        elif not pair:
            out.append(shapes.named(name).frequency_hz)
        else:
            both = [
                m.frequency_hz
                for m in shapes.solved
                if m.name.startswith("bending")
                for _ in range(m.multiplicity)
            ]
            out.append(np.sqrt(np.mean(np.square(sorted(both)[:2]))))
    return np.array(out)


def on_moved_mesh(scene: Scene, points: np.ndarray, mesh: Any, options: dict) -> sg.Body:
    """A harmonic solid on given nodes."""
    usual = harmonic_body.meridian
    harmonic_body.meridian = lambda *_: replace(mesh, points=points)
    try:
        return sg.build(scene, "harmonic", **options)
    finally:
        harmonic_body.meridian = usual


def compared(seed: int, model: str, folder: Path) -> tuple[list[tuple[float, str]], int, int, dict]:
    """Errors along directions, in their strongest part; how many entries these are of, how many the
    moved mesh cannot tell, and entries without a derivative.
    """
    options = OPTIONS[model]
    file = folder / f"shaft_{seed}.toml"
    file.write_text(toml_of(random_scene(seed)))
    scene, tables = sg.load(file), parse(str(file))
    base = sg.build(scene, model, **options)
    names = set(sg.modes(base, scene, n=scene.ask.modes).names)
    of = [name for name in OF if name in names or not Quantity(name).is_frequency]
    found = sg.sensitivities(file, model, of=of, coarser=False, **options)
    wanted = {one.name: one.pair for one in found.of}
    told: dict[Any, float] = {}
    untold = 0
    adjoint = HarmonicAdjoint(scene, base, []) if model == "harmonic" else None
    for keys in numbers(tables, None):
        if label_of(keys, tables) in found.without:
            continue
        low, high, step, _ = around(scene, tables, keys, str(file))
        if adjoint is not None:
            moved = Motion(adjoint, low, high, step)
            moved.move()
            if abs(moved.slip).max() > 1e-9 or any(abs(b).max() > 1e-9 for b in moved.bulge):
                untold += 1
                continue
        told[keys] = step
    errors: list[tuple[float, str]] = []
    for draw in range(DIRECTIONS):
        weights = dict(zip(told, np.random.default_rng([seed, draw]).uniform(-1, 1, len(told))))
        ends = [_changed(file, tables, told, weights, sign) for sign in (-0.5, 0.5)]
        bodies = []
        if adjoint is None:
            bodies = [sg.build(end, model, **options) for end in ends]
        else:
            moved = Motion(adjoint, *ends, 1.0)
            moved.move()
            mesh: Any = base.geometry
            for sign, end in zip((-0.5, 0.5), ends):
                points = mesh.meridian.points + sign * moved.velocity
                bodies.append(on_moved_mesh(end, points, mesh.meridian, options))
        low, high = (values(body, end, wanted) for body, end in zip(bodies, ends))
        for one, change in zip(found.of, high - low):
            parts = [
                one[label_of(keys, tables)].by * weight * told[keys]
                for keys, weight in weights.items()
            ]
            error = abs(change - sum(parts)) / max(map(abs, parts))
            errors.append((float(error), f"seed {seed} {one.name}, direction {draw + 1}"))
    return errors, len(told), untold, found.without


def _changed(file: Path, tables: Any, told: Mapping, weights: Mapping, sign: float) -> Scene:
    """The scene with all entries changed at once, each by its own step."""
    out = tables
    for keys, weight in weights.items():
        text = str(entry(keys, tables))
        out = put(out, keys, float(text) + sign * float(weight) * told[keys])
    return scene_of(dict(out), str(file))


def main() -> int:
    """Command line; the exit code is 1 if a derivative is off by more than 1e-5."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", type=int, nargs=2, default=(1, 50))
    parser.add_argument("--model", choices=OPTIONS, default="harmonic")
    given = parser.parse_args()
    every: list[tuple[float, str]] = []
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(given.seeds[0], given.seeds[1] + 1):
            start = time.process_time()
            try:
                errors, count, untold, without = compared(seed, given.model, Path(folder))
            except sg.SolidgearError as error:
                print(f"seed {seed}: {error}", flush=True)
                continue
            every += errors
            worst = max(errors, default=(0.0, "nothing"))
            spent = time.process_time() - start
            print(
                f"{count} entries, worst {worst[0]:.1e} ({worst[1]}); {untold} not told "
                f"by a moved mesh, {len(without)} without; {spent:.0f} s",
                flush=True,
            )
    for error, what in sorted(every, reverse=True)[:10]:
        print(f"{error:.2e}  {what}")
    print(f"{len(every)} numbers along directions, worst {max(every)[0]:.1e}")
    return int(max(every)[0] > 1e-5)


if __name__ == "__main__":
    raise SystemExit(main())
