"""What a keyed shaft costs: raw tetrahedra, uniform and graded, whole and in halves, and defect
correction.

    python -m validation.keyed_speed_accuracy [--read]

Rows go to validation/figures/keyed_speed_accuracy.csv and the chart beside it. Reference: the plain
pinion by a fine harmonic solid, times what the keyway changes on half models of up to 200,000
unknowns, extrapolated (C_zz +1.880e-2, first bending -1.491e-2); the last digit is by eye, so that
errors below 2e-4 mean nothing.
"""

from __future__ import annotations

import argparse
import csv
import time
from pathlib import Path

import numpy as np

import solidgear as sg
from validation.common import ROOT

FOLDER = ROOT / "validation" / "figures"
ROWS = FOLDER / "keyed_speed_accuracy.csv"
#: of the plain pinion, harmonic of order 7, and what the keyway changes
C_ZZ, BENDING = 5.961412e-10 * (1 + 1.880e-2), 2758.0037 * (1 - 1.491e-2)
DOUBT = 2e-4
#: label, rung and options from coarse to fine
LINES = (
    (
        "TET10 uniform, whole",
        "solid",
        [{"size": s, "graded_size": s, "half": False} for s in (0.022, 0.015, 0.011)],
    ),
    ("TET10 graded, whole", "solid", [{"refinement": r, "half": False} for r in (0.35, 0.5, 0.8)]),
    ("TET10 graded, two halves", "solid", [{"refinement": r} for r in (0.35, 0.5, 0.8, 1.1)]),
    (
        "defect correction",
        "corrected",
        [
            {"order": 3, "layers": 1, "edge_layers": 1, "refinement": 0.25},
            {"refinement": 0.35},
            {"refinement": 0.5},
        ],
    ),
    (
        "plain part, harmonic",
        "harmonic",
        [
            {"order": 3, "layers": 1, "edge_layers": 1, "relative_size": 4.0},
            {"order": 4, "layers": 2, "edge_layers": 2, "relative_size": 4.0},
        ],
    ),
)
MARKERS = dict(zip((label for label, *_ in LINES), "vsDo^"))


def measured() -> list[dict]:
    """One row a mesh: seconds from scene to compliance and modes, unknowns, errors."""
    keyed = sg.load(ROOT / "geometry" / "pinion_keyed.toml")
    rows = []
    for label, rung, levels in LINES:
        scene = keyed.plain if rung == "harmonic" else keyed
        for options in levels:
            start = time.perf_counter()
            body = sg.build(scene, rung, **options)
            compliance = sg.condense(body, scene, "pinion").compliance[2, 2]
            found = sg.modes(body, scene, n=8, ovalising=False).named("bending 1")
            seconds = time.perf_counter() - start
            assert found is not None
            row = {
                "line": label,
                "unknowns": int(body.mesh.get("solid_unknowns", body.size)),
                "seconds": round(seconds, 2),
                "error_C_zz": float(compliance / C_ZZ - 1),
                "error_bending_1": float(found.frequency_hz / BENDING - 1),
            }
            print(row, flush=True)
            rows.append(row)
    return rows


def chart(rows: list[dict], path: Path) -> None:
    """Errors over seconds and over unknowns."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.5, 7.2), layout="constrained")
    axes = figure.subplots(2, 2, sharey="row")
    for line, what in enumerate(("error_C_zz", "error_bending_1")):
        for column, cost in enumerate(("seconds", "unknowns")):
            ax = axes[line][column]
            for label, marker in MARKERS.items():
                own = [row for row in rows if row["line"] == label]
                x = [float(row[cost]) for row in own]
                y = [abs(float(row[what])) for row in own]
                ax.loglog(x, y, marker=marker, label=label)
            ax.axhspan(1e-5, DOUBT, color="#dddddd", zorder=0)
            ax.set_ylim(5e-5, 4e-2)
            ax.grid(True, which="both", lw=0.3)
            ax.set_xlabel("seconds, scene to answer" if cost == "seconds" else "unknowns (3D)")
        axes[line][0].set_ylabel(
            "error of C_zz" if what == "error_C_zz" else "error of first bending"
        )
    axes[0][0].legend(fontsize=8)
    figure.suptitle("Keyed pinion: error against cost (grey: the reference knows no better)")
    figure.savefig(path, dpi=110)


def main() -> None:
    """Measure, or read the rows that are there, and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--read", action="store_true", help="draw the rows that are there")
    if parser.parse_args().read:
        with open(ROWS, newline="") as file:
            rows = list(csv.DictReader(file))
    else:
        rows = measured()
        with open(ROWS, "w", newline="") as file:
            writer = csv.DictWriter(file, list(rows[0]))
            writer.writeheader()
            writer.writerows(rows)
    chart(rows, ROWS.with_suffix(".png"))
    best = {k: np.inf for k in MARKERS}
    for row in rows:
        if max(abs(float(row["error_C_zz"])), abs(float(row["error_bending_1"]))) < 1e-3:
            best[row["line"]] = min(best[row["line"]], float(row["seconds"]))
    for label, seconds in best.items():
        print(
            f"{label}: {seconds:.3g} s to 1e-3" if np.isfinite(seconds) else f"{label}: not to 1e-3"
        )


if __name__ == "__main__":
    main()
