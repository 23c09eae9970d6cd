"""Pictures of the gallery, one for each example: drawn by the program, or from what the example returns.

python docs/tools/gallery_pictures.py [EXAMPLE ...]
"""

from __future__ import annotations

import importlib
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from console import ROOT, run
from gallery import PICTURES
from matplotlib.figure import Figure
from PIL import Image

import solidgear as sg

#: pixels of a card, at twice the size it has on the page
SIZE = (640, 420)
TUBE = """material = "steel"
port = { name = "gear", at = "tube.middle", attach_to = "tube" }

[[segment]]
name = "tube"
kind = "cylinder"
length = "400 mm"
diameter = "200 mm"
bore = "190 mm"
"""


def rendered(arguments: str, target: Path) -> None:
    """A mode shape, as `solidgear render` draws it."""
    (target.parent / "tube.toml").write_text(TUBE)
    print(run(f"solidgear render {arguments} --out {target.name}", target.parent))


def charted(scene: str, target: Path) -> None:
    """The first panel of the chart of speed against accuracy."""
    print(run(f"solidgear chart {scene} --out chart", target.parent))
    with Image.open(target.parent / "chart" / "speed_accuracy.png") as picture:
        picture.crop((0, 0, round(0.54 * picture.width), round(0.39 * picture.height))).save(target)


def responded(target: Path) -> None:
    """The response of a train."""
    command = "solidgear response geometry/axle_overhung.toml --gear harmonic --against euler+euler"
    print(run(f"{command} --out response", target.parent))
    (target.parent / "response" / "response.png").rename(target)


def drawn(scene: str, target: Path) -> None:
    """The section of a shaft."""
    sg.load(ROOT / "geometry" / f"{scene}.toml").plot().write(target)


def rod(target: Path) -> None:
    """The first shapes of the rod of `shaft_in_python`."""
    scene = sg.Scene.from_parts([sg.Segment.cylinder("rod", length=0.6, diameter=0.02)])
    modes = sg.modes(sg.build(scene, "timoshenko"), scene, n=6)
    modes.plot(["bending 1", "bending 2", "bending 3"]).savefig(target, dpi=160)


def bars(example: str, unit: str, factor: float, target: Path) -> None:
    """What an example returns, a bar each."""
    found = importlib.import_module(example).main()
    names = [name for name, value in found.items() if value is not None]
    values = [factor * abs(float(found[name])) for name in names]
    figure = Figure(figsize=(5.4, 3.5), layout="constrained")
    ax = figure.subplots()
    ax.barh(names, values, color="#2f6f9f")
    ax.bar_label(ax.containers[0], labels=[f"{round(v, 4):.4g}" for v in values], padding=4)
    ax.invert_yaxis()
    ax.margins(x=0.18)
    ax.set_xlabel(unit)
    ax.spines[["top", "right"]].set_visible(False)
    figure.savefig(target, dpi=160)


def scaled_bearings(target: Path) -> None:
    """Compliance at the gear over the stiffness of all bearings."""
    scene = sg.load(ROOT / "geometry" / "shaft_stepped.toml")
    body = sg.build(scene, "timoshenko")
    scales = np.geomspace(0.01, 1e4, 120)
    at = [
        sg.condense(body, scene.with_bearing_scale(float(s)).bearings, port=scene.port.name)
        for s in scales
    ]
    figure = Figure(figsize=(5.4, 3.5), layout="constrained")
    ax = figure.subplots()
    ax.loglog(scales, [1e9 * one.compliance[2, 2] for one in at], color="#2f6f9f", lw=2)
    ax.set(xlabel="bearing stiffness, times that of the scene", ylabel="C_zz, nm/N")
    ax.grid(alpha=0.3)
    figure.savefig(target, dpi=160)


def reliefs(target: Path) -> None:
    """Transmission error over the load, a curve each amount of tip relief."""
    found = importlib.import_module("teeth_in_contact").main()
    figure = Figure(figsize=(5.4, 3.5), layout="constrained")
    ax = figure.subplots()
    for amount, error in found["error"].items():
        ax.plot(found["load"], error, marker="o", ms=4, lw=2, label=f"{1e6 * amount:.0f} µm")
    ax.set(xlabel="load, N/mm", ylabel="transmission error pp, µm", xlim=(0, None), ylim=(0, None))
    ax.legend(title="tip relief", frameon=False)
    ax.grid(alpha=0.3)
    figure.savefig(target, dpi=160)


def searched(target: Path) -> None:
    """All designs of the search of `shaft_to_report`."""
    importlib.import_module("shaft_to_report").main(target.parent)
    (target.parent / "search" / "designs.png").rename(target)


OVERHUNG = "geometry/pinion_overhung.toml"
DRAWN: dict[str, Callable[[Path], None]] = {
    "first_answer": partial(rendered, f'{OVERHUNG} -f harmonic --mode "bending 1"'),
    "shaft_in_python": rod,
    "shaft_to_report": searched,
    "before_solving": partial(drawn, "pinion_overhung"),
    "which_model": partial(charted, "geometry/shaft_hollow.toml"),
    "how_sure": partial(bars, "how_sure", "error bar, %", 100.0),
    "attachments": partial(bars, "attachments", "first bending, Hz", 1.0),
    "ovalising": partial(rendered, 'tube.toml -f harmonic --mode "ovalising n=2 1"'),
    "exact_beam": partial(rendered, 'geometry/shaft_stepped.toml -f euler --mode "bending 2"'),
    "many_bearings": scaled_bearings,
    "two_gears": partial(drawn, "intermediate_shaft"),
    "teeth_in_contact": reliefs,
    "lumped_model": partial(bars, "lumped_model", "error of first bending, %", 100.0),
    "way_back": partial(rendered, f'{OVERHUNG} -f harmonic --mode "bending 2"'),
    "two_shafts": partial(rendered, 'geometry/gear_shaft.toml -f harmonic --mode "bending 1"'),
    "geared_train": responded,
}


def card(source: Path, target: Path) -> None:
    """A picture at the size of a card, on white."""
    with Image.open(source) as picture:
        small = picture.convert("RGB")
        small.thumbnail(SIZE, Image.Resampling.LANCZOS)
    sheet = Image.new("RGB", SIZE, "white")
    sheet.paste(small, ((SIZE[0] - small.width) // 2, (SIZE[1] - small.height) // 2))
    sheet.quantize(96).save(target, optimize=True)


def main(names: list[str]) -> int:
    """Draw those that are named, or all."""
    sys.path.insert(0, str(ROOT / "examples"))
    PICTURES.mkdir(exist_ok=True)
    for name in names or DRAWN:
        with tempfile.TemporaryDirectory() as folder:
            target = Path(folder) / f"{name}.png"
            (target.parent / "geometry").symlink_to(ROOT / "geometry")
            DRAWN[name](target)
            card(target, PICTURES / target.name)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
