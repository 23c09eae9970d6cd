"""A thousand bearing sets on one body: the shaft is factored once.

It illustrates how to:

* keep bearings outside of the body,
* scale them, and solve the statics again at next to no cost.
"""

from pathlib import Path

import numpy as np

import solidgear as sg

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    scene = sg.load(GEOMETRY / "shaft_stepped.toml")
    body = sg.build(scene, "timoshenko")
    scales = np.geomspace(0.01, 1e6, 200)
    compliance = []
    for scale in scales:
        bearings = scene.with_bearing_scale(float(scale)).bearings
        compliance.append(sg.condense(body, bearings, port=scene.port.name).compliance[2, 2])
    shaft_alone = compliance[-1]
    share = 1 - shaft_alone / np.interp(1.0, scales, compliance)
    print(f"{100 * share:.0f} % of the compliance at the gear is that of the bearings")
    return {"share": float(share), "falls": bool(np.all(np.diff(compliance) < 0))}


if __name__ == "__main__":
    main()
