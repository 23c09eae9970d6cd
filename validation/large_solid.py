"""A solid of 300,000 unknowns: seconds by stage, estimate of the factor against what the process
really took.

    python -m validation.large_solid [--size 0.0135 --graded 0.0022]

Asked: 300,000 unknowns within 5 GB.
"""

from __future__ import annotations

import argparse
import resource
import time

import solidgear as sg
from solidgear.solve.statics import factors
from validation.common import ROOT, results_folder, show, write_rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument(
        "--size", type=float, default=0.0135, help="m, tetrahedra away from shoulders"
    )
    parser.add_argument(
        "--graded", type=float, default=0.0022, help="m, at shoulders and seat ends"
    )
    options = parser.parse_args()
    scene = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    rows, clock = [], time.perf_counter()

    def stage(name, action):
        nonlocal clock
        result = action()
        now = time.perf_counter()
        rows.append(
            {
                "stage": name,
                "seconds": round(now - clock, 2),
                "peak of the process, MB": round(
                    resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
                ),
            }
        )
        clock = now
        return result

    body = stage(
        "mesh and assembly",
        lambda: sg.build(
            scene, "solid", element="tet10", size=options.size, graded_size=options.graded
        ),
    )
    factor = stage("factor", lambda: factors(body)[0])
    stage("flexibility of all ports", lambda: sg.condense(body, scene, scene.port.name))
    modes = stage("ten modes", lambda: sg.modes(body, scene, n=10))
    show(
        f"{body.size} unknowns, {factor.backend}, factor estimated at "
        f"{factor.estimate_mb:.0f} MB, first bending "
        f"{modes.named('bending 1').frequency_hz:.3f} Hz",
        rows,
    )
    write_rows(results_folder("large_solid") / "rows.csv", rows)


if __name__ == "__main__":
    main()
