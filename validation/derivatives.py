"""Derivatives of random shafts against central differences of the whole computation.

    python -m validation.derivatives --seeds 1 50
    python -m validation.derivatives --seeds 1 50 --model timoshenko

Every number of every file is changed up and down. The harmonic solid is then built on the mesh that
has moved with it (light meshes: what is compared is exact on any), a beam as the program builds it,
with many elements. Told is the largest error of an elasticity, in the strongest of the same number,
and what differences on a moved mesh cannot tell: surfaces that part in two, seats that slide on it.
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
from solidgear.scene.paths import label_of
from solidgear.scene.toml_file import parse
from solidgear.studies.sensitivity.entries import around, numbers
from validation.campaign.scenes.shafts import random_scene

OF = ("bending 1", "C_zz", "K_thx", "axial 1")
OPTIONS: dict[str, dict[str, Any]] = {
    "harmonic": {"order": 3, "layers": 1, "edge_layers": 0, "relative_size": 2.0},
    "timoshenko": {"elements": 100},
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
        return "[" + ", ".join(map(_written, value)) + "]"
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


def compared(seed: int, model: str, folder: Path) -> tuple[list[tuple[float, str]], int, dict]:
    """Errors of all derivatives of a shaft, in the strongest of the same number; how many the moved
    mesh cannot tell, and entries without a derivative.
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
    errors: list[tuple[float, str]] = []
    untold = 0
    for keys in numbers(tables, None):
        path = label_of(keys, tables)
        if path in found.without:
            continue
        low, high, step, at = around(scene, tables, keys, str(file))
        sides = []
        moved = None
        if model == "harmonic":
            adjoint = HarmonicAdjoint(scene, base, [])
            moved = Motion(adjoint, low, high, step)
            moved.move()
            if abs(moved.slip).max() > 1e-9 or any(abs(b).max() > 1e-9 for b in moved.bulge):
                untold += 1
                continue
        for sign, side in ((-1, low), (1, high)):
            if moved is None:
                body = sg.build(side, model, **options)
            else:
                mesh: Any = base.geometry
                points = mesh.meridian.points + sign * step / 2 * moved.velocity
                body = on_moved_mesh(side, points, mesh.meridian, options)
            sides.append(values(body, side, wanted))
        for one, change in zip(found.of, (sides[1] - sides[0]) / step):
            top = max(abs(d.elasticity) for d in one.derivatives)
            error = abs(change * at / one.value - one[path].elasticity) / top
            errors.append((float(error), f"seed {seed} {one.name} by {path}"))
    return errors, untold, found.without


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
                errors, untold, without = compared(seed, given.model, Path(folder))
            except sg.SolidgearError as error:
                print(f"seed {seed}: {error}", flush=True)
                continue
            every += errors
            worst = max(errors, default=(0.0, "nothing"))
            spent = time.process_time() - start
            print(
                f"{len(errors)} derivatives, worst {worst[0]:.1e} ({worst[1]}); {untold} not told "
                f"by a moved mesh, {len(without)} without; {spent:.0f} s",
                flush=True,
            )
            for path, why in without.items():
                print(f"    without {path}: {why}")
    for error, what in sorted(every, reverse=True)[:10]:
        print(f"{error:.2e}  {what}")
    print(f"{len(every)} derivatives, worst {max(every)[0]:.1e}")
    return int(max(every)[0] > 1e-5)


if __name__ == "__main__":
    raise SystemExit(main())
