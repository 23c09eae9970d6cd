"""Findings on file, and the page of documentation that tells them."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path

import matplotlib
from matplotlib.figure import Figure
from PIL import Image

from validation.common import ROOT, results_folder, write_rows
from validation.stability.frame import Finding

PAGE = ROOT / "docs" / "validation" / "stability.md"
PICTURES = ROOT / "docs" / "pictures" / "stability"
#: width of a chart on the page, pixels
WIDTH = 760
#: how charts look, whatever the user's own matplotlibrc says
STYLE = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 9.5,
    "axes.titlelocation": "left",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e3e3e3",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "lines.markersize": 4.5,
    "lines.linewidth": 1.2,
}
#: chapters, and the findings of each
CHAPTERS = {
    "Beams": [
        "slenderness_euler",
        "slenderness_timoshenko",
        "shoulder_step",
        "thin_hollow_shaft",
        "krylov_duncan",
    ],
    "Elements and meshes": [
        "linear_elements",
        "nearly_incompressible",
        "bad_elements",
        "sharp_shoulder",
        "ties",
        "split_pairs",
    ],
    "Modes": ["free_body_shift", "shift_on_eigenvalue", "clusters", "circumferential_families"],
    "Lumped models": ["guyan_in_frequency", "effective_mass_limits"],
    "Bearings and scenes": [
        "bearing_extremes",
        "doubtful_six_by_six",
        "strong_coupling",
        "odd_geometry",
        "impossible_geometry",
        "wrong_units",
    ],
    "The machine": ["operation"],
}
HEAD = """# Where methods fail

Every method was driven to its edge: what fails, where it was measured to fail, and what the program does about it. `python -m validation.stability` measures all, `--only NAME` one, and `--page` makes the page.
"""


def folder_of(name: str) -> Path:
    """Folder of a finding's results."""
    return results_folder("stability") / name


def keep(finding: Finding, draw: Callable) -> Path:
    """Write rows.csv, chart.png and finding.json of one finding; returns their folder."""
    folder = folder_of(finding.name)
    folder.mkdir(exist_ok=True)
    write_rows(folder / "rows.csv", finding.rows)
    words = {f.name: getattr(finding, f.name) for f in fields(finding) if f.name != "rows"}
    (folder / "finding.json").write_text(json.dumps(words, indent=1, ensure_ascii=False) + "\n")
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        figure = Figure(figsize=(8.0, 4.4), dpi=150, layout="constrained")
        draw(finding, figure.subplots())
        figure.savefig(folder / "chart.png")
    return folder


def kept(name: str) -> Finding:
    """A finding on file, without its rows."""
    return Finding(**json.loads((folder_of(name) / "finding.json").read_text()))


def page(found: dict[str, Finding]) -> str:
    """The page, of findings by name."""
    lines = [HEAD]
    for chapter, names in CHAPTERS.items():
        lines.append(f"## {chapter}\n")
        for f in (found[name] for name in names):
            lines += [f"### {f.method}\n", f"{f.fails}\n", f"**Measured.** {f.edge}\n"]
            lines.append(f"**What the program does.** {f.program}\n")
            lines.append(
                f"```{{image}} ../pictures/stability/{f.name}.png\n"
                f":alt: {f.method}\n:class: picture\n```\n"
            )
            if f.guard:
                lines.append(f"Held by the test `{f.guard}`.\n")
    return "\n".join(lines).rstrip() + "\n"


def missing() -> list[str]:
    """Findings of the page that are not on file."""
    names = [name for chapter in CHAPTERS.values() for name in chapter]
    return [name for name in names if not (folder_of(name) / "finding.json").exists()]


def write_page() -> None:
    """Write the page and its charts, smaller and in few colours."""
    found = {name: kept(name) for names in CHAPTERS.values() for name in names}
    PAGE.write_text(page(found))
    PICTURES.mkdir(parents=True, exist_ok=True)
    for name in found:
        with Image.open(folder_of(name) / "chart.png") as chart:
            height = round(chart.height * WIDTH / chart.width)
            small = chart.convert("RGB").resize((WIDTH, height), Image.Resampling.LANCZOS)
            small.quantize(32).save(PICTURES / f"{name}.png", optimize=True)
