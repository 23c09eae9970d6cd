"""Derivatives of random shafts against central differences of the whole computation.

    python -m validation.derivatives --seeds 1 50
    python -m validation.derivatives --seeds 1 50 --model timoshenko

All numbers of a file are changed up and down at once, along random directions, and the shaft is built
on the mesh that has moved with it (what is compared is exact on any mesh; light ones do). Two
differences, of a step and of half of it, leave an error of fourth order (Richardson); of two such
pairs the one counts that agrees better, as rounding spoils small steps of slender shafts, and large
ones a mode that another comes near. Told is the largest error of a change, in the strongest of its
parts, and what differences on a moved mesh
cannot tell: surfaces that part in two, seats that slide on it, entries that go one way only.
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
from solidgear.core.models.beam import body as beam_body
from solidgear.core.models.harmonic import body as harmonic_body
from solidgear.core.quantity import COMPLIANCE, Quantity
from solidgear.core.scene import Scene
from solidgear.core.scene.file import scene_of
from solidgear.core.scene.paths import entry, label_of, replace_entry
from solidgear.core.scene.toml_file import parse
from solidgear.variants.sensitivity.beam import BeamAdjoint
from solidgear.variants.sensitivity.harmonic import HarmonicAdjoint, Motion
from solidgear.variants.sensitivity.run import around, numbers
from validation.campaign.scenes.shafts import random_scene
from validation.common import toml

OF = ("bending 1", "C_zz", "K_thx", "axial 1")
#: of the steps that the program takes
SIZES = (5.0, 10.0, 20.0)
#: of each shaft
DIRECTIONS = 2
OPTIONS: dict[str, dict[str, Any]] = {
    "harmonic": {"order": 3, "layers": 1, "edge_layers": 0, "relative_size": 2.0},
    "timoshenko": {"elements": 60},
    "euler": {"elements": 60},
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
    return "\n".join(f"{key} = {toml(value)}" for key, value in tables.items()) + "\n"


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


def on_moved_mesh(
    scene: Scene, points: np.ndarray, mesh: Any, model: str, options: dict
) -> sg.Body:
    """A harmonic solid or a beam on given nodes."""
    module: Any = harmonic_body if model == "harmonic" else beam_body
    name = "meridian" if model == "harmonic" else "mesh"
    usual = getattr(module, name)
    setattr(module, name, lambda *_: replace(mesh, points=points) if mesh else points)
    try:
        return sg.build(scene, model, **options)
    finally:
        setattr(module, name, usual)


class Moved:
    """A mesh that follows a shaft from one scene to another."""

    def __init__(self, scene: Scene, base: sg.Body, model: str):
        self.model, geometry = model, base.geometry
        #: where a harmonic solid keeps its mesh, and nodes
        self.mesh: Any = getattr(geometry, "meridian", None)
        self.points = self.mesh.points if self.mesh else geometry.nodes  # type: ignore[union-attr]
        kind: Any = HarmonicAdjoint if model == "harmonic" else BeamAdjoint
        self.adjoint: Any = kind(scene, base, [])

    def velocity(self, low: Scene, high: Scene, step: float) -> tuple[np.ndarray, bool]:
        """Of the nodes, and whether it tells all."""
        if self.model != "harmonic":
            self.adjoint.by(low, high, step)
            return self.adjoint.velocity, True
        velocity, slip, bulge = Motion(self.adjoint, low, high, step).moved
        return velocity, all(abs(rates).max(initial=0.0) < 1e-9 for rates in (slip, *bulge))


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
    mesh = Moved(scene, base, model)
    for keys in numbers(tables, None):
        if label_of(keys, tables) in found.without:
            continue
        sides = around(scene, tables, keys, str(file))
        if not sides.side and mesh.velocity(sides.low, sides.high, sides.step)[1]:
            told[keys] = sides.step
        else:
            untold += 1
    errors: list[tuple[float, str]] = []
    for draw in range(DIRECTIONS):
        weights = dict(zip(told, np.random.default_rng([seed, draw]).uniform(-1, 1, len(told))))
        changes = []
        for size in SIZES:
            low, high = (_changed(file, tables, told, weights, size * sign) for sign in (-0.5, 0.5))
            velocity, _ = mesh.velocity(low, high, 1.0)
            before, after = (
                values(
                    on_moved_mesh(end, mesh.points + sign * velocity, mesh.mesh, model, options),
                    end,
                    wanted,
                )
                for sign, end in ((-0.5, low), (0.5, high))
            )
            changes.append((after - before) / size)
        both = [(4 * fine - rough) / 3 for fine, rough in zip(changes, changes[1:])]
        for one, *ends in zip(found.of, *both):
            parts = [
                one[label_of(keys, tables)].by * weight * told[keys]
                for keys, weight in weights.items()
            ]
            error = min(abs(change - sum(parts)) for change in ends) / max(map(abs, parts))
            errors.append((float(error), f"seed {seed} {one.name}, direction {draw + 1}"))
    return errors, len(told), untold, found.without


def _changed(file: Path, tables: Any, told: Mapping, weights: Mapping, sign: float) -> Scene:
    """The scene with all entries changed at once, each by its own step."""
    out = tables
    for keys, weight in weights.items():
        text = str(entry(keys, tables))
        out = replace_entry(out, keys, float(text) + sign * float(weight) * told[keys])
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
