"""Reductions of the geared rotor measured: error of its frequencies up to 4 kHz beside the proven bound.

Both shafts are harmonic solids, the reference keeps 160 modes of each with residual fields.  Kept
modes are those of a whole shaft, twins counted twice.

    python -m validation.thesis.reduction
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import solidgear as sg
from solidgear.core.reduction.superelement import Superelement, Truncation, assemble
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.shaft import JUDGE
from solidgear.trains.file.train import SIDES, Train
from validation.common import ROOT, results_folder, show, write_rows

HIGHEST, REFERENCE = 4000.0, 160
KINDS = {"rubin": (8, 16, 24, 48), "craig_bampton": (8, 16, 24, 48), "no residuals": (8, 24, 48)}
MESH = {JUDGE: {"order": 3, "layers": 1}}


def without_residuals(part: Superelement, body, kept: int) -> Superelement:
    """Free modes alone, as a reduction by free modes that forgets the residual fields has them."""
    limit = np.sort(part.value)[kept + part.rigid - 1] * (1 + 1e-6)
    blocks = []
    for block in part.blocks:
        own = block.value <= limit
        blocks.append(
            replace(
                block,
                value=block.value[own],
                shapes=block.shapes[:, own],
                motions=block.motions[:, :, own],
                truncation=Truncation(np.inf, np.zeros((own.sum(),) * 2)),
            )
        )
    return assemble("free modes", body, {p: body.port_index(p) for p in part.ports}, blocks)


def measured(train: Train, kinds=KINDS, reference: int = REFERENCE, mesh=MESH) -> list[dict]:
    """Rows of the table.

    Parameters
    ----------
    train : Train
    kinds : mapping of str to tuple of int
        Modes that are kept, by reduction.
    reference : int
        Modes that the reference keeps.
    mesh : mapping
        Builder options.
    """
    finest = Assembly(train, kept=reference, settings=mesh)
    system = finest.system(JUDGE, JUDGE)
    count = int((system.elastic[0] <= 2 * np.pi * HIGHEST).sum())
    exact = system.modes(count).frequency_hz[1:]
    rows = []
    for kind, numbers in kinds.items():
        for kept in numbers:
            assembly = Assembly(train, kind if kind != "no residuals" else "rubin", kept, mesh)
            for side in SIDES:
                assembly.set_body(side, JUDGE, finest.shaft_model(side, JUDGE).body)
                if kind == "no residuals":
                    own = assembly.shaft_model(side, JUDGE)
                    assembly.add_part(
                        side, kind, without_residuals(own.part, own.body, kept), JUDGE
                    )
            rung = kind if kind == "no residuals" else JUDGE
            small = assembly.system(rung, rung)
            found = small.modes(count)
            rows.append(
                {
                    "reduction": kind,
                    "modes a shaft": kept,
                    "coordinates": small.size,
                    "largest error": float(np.abs(found.frequency_hz[1:] / exact - 1).max()),
                    "largest bound": float(found.error_bound.max()),
                }
            )
    return rows


def main() -> None:
    """Measure, and show the table."""
    rows = measured(sg.load_train(ROOT / "geometry" / "axle_overhung.toml"))
    for row in rows:
        known = row["reduction"] != "no residuals"
        row["largest bound"] = f"{row['largest bound']:.0e}" if known else "none"
        row["largest error"] = f"{row['largest error']:.1e}"
    write_rows(results_folder("axle_reduction") / "reduction.csv", rows)
    show(f"Frequencies of the geared rotor up to {HIGHEST:g} Hz, both shafts solid", rows)


if __name__ == "__main__":
    main()
