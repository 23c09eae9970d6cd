"""Problem: the overhung pinion of the thesis.  Reference: an independent p10 solution of the same
scene.

Models: harmonic solid at its reference setting and finer, 3D hexahedra and tetrahedra, Euler and
Timoshenko beams. Prints and writes: error of every model against the reference, attachment
variants, the like-for-like beam gap.

    python -m validation.overhung_pinion [--fine]
"""

from __future__ import annotations

import argparse
import time

import solidgear as sg
from solidgear.evidence.quantities import change, measure
from solidgear.evidence.ties import rigid_seats
from validation.common import ROOT, results_folder, show, write_rows

# Independent solution, polynomial order 10 on five graded layers, digits as published with it;
# |K_z,thx| is given.
REFERENCE = {
    "K_zz": 4.70996e9,
    "K_z,thx": 2.40051e8,
    "K_thx": 1.90022e7,
    "K_yy": 1.136330e9,
    "bending 1": 2758.003,
    "bending 2": 4038.309,
    "bending 3": 8148.228,
    "axial 1": 1385.63,
}


def solve(scene, fidelity, **options):
    """Compared numbers of one model, unknowns and seconds."""
    start = time.perf_counter()
    body = sg.build(scene, fidelity, **options)
    condensed = sg.condense(body, scene, scene.port.name)
    found = sg.modes(body, scene, n=9)
    values = measure(condensed, found)
    third = found.named("bending 3")
    if third:
        values["bending 3"] = third.frequency_hz
    return values, body.size, time.perf_counter() - start


def against_reference(scene, fine: bool) -> list[dict]:
    """One row per model and setting."""
    cases = [
        ("euler", {}),
        ("timoshenko", {}),
        ("harmonic", {"order": 2}),
        ("harmonic", {}),
        ("harmonic", {"order": 6}),
        ("solid", {"element": "tet10", "size": 0.03, "graded_size": 0.0099}),
        ("solid", {"element": "tet10", "size": 0.025, "graded_size": 0.0055}),
        ("solid", {"element": "hex20"}),
        ("solid", {"element": "hex20", "size": 0.01, "around": 8}),
        ("solid", {"element": "hex27", "size": 0.0225, "around": 8, "layers": 3, "ratio": 0.4}),
        ("solid", {"element": "hex27", "around": 12}),
    ]
    if fine:
        cases += [
            ("harmonic", {"order": 8, "layers": 4, "edge_layers": 2}),
            ("harmonic", {"order": 10, "layers": 5, "edge_layers": 2}),
            ("solid", {"element": "hex27", "around": 12, "refinement": 1.5}),
        ]
    rows = []
    for fidelity, options in cases:
        values, dofs, seconds = solve(scene, fidelity, **options)
        row = {
            "model": " ".join([fidelity, *(f"{k}={v}" for k, v in options.items())]),
            "dofs": dofs,
            "seconds": round(seconds, 2),
        }
        for name, value in REFERENCE.items():
            if name in values:
                row[name] = f"{abs(values[name]) / value - 1:+.1e}"
        rows.append(row)
    return rows


def attachments(scene) -> list[dict]:
    """Rigid over averaged seats at three widths, and the like-for-like gap of the Timoshenko beam."""
    rows = []
    for width in (0.010, 0.020, 0.040):
        wide = scene.with_seat_width(width)
        mean, _, _ = solve(wide, "harmonic")
        for what, other in (
            ("seats", rigid_seats(wide)),
            ("seats and lumped point", wide.with_attachment("rigid")),
        ):
            stiff, _, _ = solve(other, "harmonic")
            row = {"case": f"rigid {what} over average, seats {1e3 * width:.0f} mm"}
            rows.append(
                row
                | {
                    q: f"{100 * change(stiff, mean, q):+.2f} %"
                    for q in ("bending 1", "K_zz", "C_zz")
                }
            )
    section, _, _ = solve(scene.with_attachment("section"), "harmonic")
    for kappa in ("hutchinson", "cowper"):
        beam, _, _ = solve(scene, "timoshenko", kappa=kappa)
        row = {"case": f"Timoshenko ({kappa}) over harmonic, section means"}
        rows.append(
            row
            | {q: f"{100 * change(beam, section, q):+.2f} %" for q in ("bending 1", "K_zz", "C_zz")}
        )
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--fine", action="store_true", help="also the finest settings (minutes)")
    fine = parser.parse_args().fine
    scene = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    folder = results_folder("overhung_pinion")
    for name, rows in (
        ("against_reference", against_reference(scene, fine)),
        ("attachments", attachments(scene)),
    ):
        show(name.replace("_", " "), rows)
        write_rows(folder / f"{name}.csv", rows)


if __name__ == "__main__":
    main()
