"""Ranges of open inputs against seeded samples of all of them together.

``python -m validation.uncertainty [--samples 2000] [--seed 1]``: of a gearbox shaft on catalogue
bearings, whether the range of every number holds all samples, and how far the root of the sum of
squares of single inputs lies from the deviation of the samples; into
``validation/results/uncertainty_SAMPLES.json``.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import solidgear as sg
from solidgear.report.open_words import NOTHING, acting

SCENE = "geometry/gearbox_catalogue.toml"
#: elastic modes; higher ones take the time and are read by nobody
MODES = 4


def main() -> None:
    """Run the campaign and write its result."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--samples", type=int, default=2000)
    options.add_argument("--seed", type=int, default=1)
    given = options.parse_args()
    scene = sg.load(SCENE).with_changes(ask=sg.Ask(modes=MODES))
    found = sg.budget(scene, samples=given.samples, seed=given.seed)
    rows, outside = [], []
    together = {one.quantity for one in acting(found, found.numbers)}
    for one in found.numbers:
        total, sampled = one.total, one.sampled
        if max(-total.low, total.high) < NOTHING:
            continue
        beyond = max(total.low - sampled.low, sampled.high - total.high, 0.0)
        if beyond:
            outside.append(one.quantity)
        rows.append(
            {
                "quantity": one.quantity,
                "range": [total.low, total.high],
                "samples": [sampled.low, sampled.high],
                "samples_95": [sampled.low95, sampled.high95],
                "beyond_range": beyond,
                "sum_of_squares": total.deviation,
                "deviation_of_samples": sampled.deviation,
                "inputs_act_on_one_another": one.quantity in together,
            }
        )
    result = {"scene": SCENE, "samples": found.samples, "seed": found.seed, "model": found.model}
    result |= {"inputs": [one.path for one in found.inputs], "points_of_range": found.points}
    result |= {"refused": found.refused, "outside": outside, "numbers": rows}
    path = Path(__file__).parent / "results" / f"uncertainty_{given.samples}.json"
    path.write_text(json.dumps(result, indent=1) + "\n")
    print(f"{len(rows)} numbers, {len(outside)} with samples outside of their range: {outside}")
    for row in rows:
        low, high = row["range"]
        ratio = row["deviation_of_samples"] / row["sum_of_squares"] - 1
        print(
            f"{row['quantity']:12s} range {low:+.4f} {high:+.4f}  "
            f"samples {row['samples'][0]:+.4f} {row['samples'][1]:+.4f}  "
            f"s {row['sum_of_squares']:.4f} {row['deviation_of_samples']:.4f} ({ratio:+.1%})"
        )


if __name__ == "__main__":
    main()
