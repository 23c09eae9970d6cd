"""ROSS as a peer for the beam: the same nodes, tapered Timoshenko elements, bearings without tilt
stiffness (ROSS has none).

It is run in a process of its own, because it prints on import:  python ross_peer.py rotor.json
"""

from __future__ import annotations

import importlib.util
import json
import sys
import tempfile
import time
from pathlib import Path

RUNS = 3


def present() -> str:
    """Empty if ROSS can be run, else the reason why not."""
    return (
        ""
        if importlib.util.find_spec("ross")
        else "no package ross (pip install ross-rotordynamics)"
    )


def tiltless(scene):
    """The scene with bearings that hold translations only."""
    import numpy as np

    bearings = []
    for bearing in scene.bearings:
        k = np.diag(np.diag(bearing.stiffness))
        k[3:] = 0.0
        bearings.append(bearing.with_changes(matrix=k, axial_series=()))
    return scene.with_changes(bearings=tuple(bearings))


def rotor(scene, body) -> dict:
    """What ROSS needs, as plain data.

    Parameters
    ----------
    scene : Scene
        With bearings that hold translations only.
    body : Body
        Timoshenko body of it, for its nodes.
    """
    nodes = [float(y) for y in body.geometry.nodes]
    elements = []
    for left, right in zip(nodes, nodes[1:]):
        middle = (left + right) / 2
        segment = next(s for s in scene.segments if s.y0 <= middle <= s.y1)
        radii = [segment.radius_at(min(max(y, segment.y0), segment.y1)) for y in (left, right)]
        material = segment.material
        sides = [
            2 * x for radius in radii for x in radius
        ]  # inner and outer diameter, left then right
        elements.append([right - left, *sides, material.E, material.nu, material.density])
    bearings = [
        [
            min(range(len(nodes)), key=lambda i: abs(nodes[i] - b.y)),
            *(float(b.stiffness[c, c]) for c in range(3)),
        ]
        for b in scene.bearings
    ]
    return {"elements": elements, "bearings": bearings}


def solve(data: dict, *, limit: float = 300.0) -> dict:
    """Run ROSS: ``seconds`` of building the rotor and its modes, ``whole`` of the process,
    ``frequency_hz``, ``version``.

    Raises
    ------
    PeerError
    """
    from validation.peers.process import PeerError, last_words, run

    with tempfile.TemporaryDirectory(prefix="ross-") as name:
        folder = Path(name)
        (folder / "rotor.json").write_text(json.dumps(data))
        whole, cpu, out = run(
            [sys.executable, str(Path(__file__).resolve()), "rotor.json"], folder, limit=limit
        )
        if not (folder / "answer.json").exists():
            raise PeerError("ROSS gave no answer: " + last_words(out))
        return json.loads((folder / "answer.json").read_text()) | {"whole": whole, "cpu": cpu}


def _child(path: str) -> None:
    import math

    import ross

    data = json.loads(Path(path).read_text())
    seconds = []
    for _ in range(RUNS):  # the first run pays for what is loaded late
        start = time.perf_counter()
        steels: dict[tuple, object] = {}
        elements = []
        for n, (length, inner0, outer0, inner1, outer1, young, poisson, density) in enumerate(
            data["elements"]
        ):
            key = (young, poisson, density)
            if key not in steels:
                steels[key] = ross.Material(
                    name=f"M{len(steels)}", rho=density, E=young, Poisson=poisson
                )
            elements.append(
                ross.ShaftElement(
                    length,
                    inner0,
                    outer0,
                    inner1,
                    outer1,
                    material=steels[key],
                    n=n,
                    shear_method_calc="cowper",
                )
            )
        bearings = [
            ross.BearingElement(n=n, kxx=kx, kyy=kz, kzz=ky, cxx=0.0)
            for n, kx, ky, kz in data["bearings"]
        ]
        rotor = ross.Rotor(elements, bearing_elements=bearings)
        found = rotor.run_modal(speed=0.0, num_modes=24)
        seconds.append(time.perf_counter() - start)
    # Free torsion comes out as rounding.
    frequency = sorted(w / (2 * math.pi) for w in found.wn.tolist() if w > 1.0)
    answer = {"seconds": min(seconds), "frequency_hz": frequency}
    Path("answer.json").write_text(json.dumps(answer | {"version": ross.__version__}))


if __name__ == "__main__":
    _child(sys.argv[1])
