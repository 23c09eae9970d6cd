"""Seeded shafts on which a seat of some kind ends at an edge of some kind, or just beside one.

    scene = seat_at_edge(7)

All that the catalogue of singular places tells apart is drawn: steps up and down, joints of two
materials, steps that are joints too, kinks, bores that step or taper, the end of the shaft; seats and
points that are averaged, rigid or sections; materials from steel to soft plastic.
"""

from __future__ import annotations

import numpy as np

from solidgear.core.scene import Ask, Bearing, Material, Port, Scene, Segment

MM = 1e-3
MATERIALS = {
    "steel": Material(E=2.1e11, nu=0.3, density=7850.0),
    "aluminium": Material(E=7.0e10, nu=0.33, density=2700.0),
    "filled plastic": Material(E=1.0e10, nu=0.35, density=1500.0),
    "plastic": Material(E=3.0e9, nu=0.38, density=1400.0),
    "soft plastic": Material(E=5.0e8, nu=0.45, density=1200.0),
}
EDGES = ("step up", "step down", "joint", "joint and step", "kink", "bore", "tapered bore", "end")
TIES = ("average", "rigid", "rigid", "section")
#: from the edge to the end of the seat, mm
GAPS = (0.0, 0.0, 0.0, 0.1, -0.1)


def seat_at_edge(seed: int) -> Scene:
    """A shaft of three parts; the point or the second bearing ends where the second one begins."""
    rng = np.random.default_rng([seed, 60])
    edge, tie = str(rng.choice(EDGES)), str(rng.choice(TIES))
    held_there, gap = bool(rng.random() < 0.5), float(rng.choice(GAPS))
    gap = abs(gap) if "step" in edge else gap  # no seat lies across a step
    names = list(MATERIALS)
    soft = MATERIALS[str(rng.choice(names[1:]))] if "joint" in edge else MATERIALS["steel"]
    swapped, steel = bool(rng.random() < 0.5), MATERIALS["steel"]
    first, second = (soft, steel) if swapped else (steel, soft)
    d = float(rng.uniform(20, 60))
    lengths = [float(rng.uniform(0.8, 2.0)) * d for _ in range(3)]
    if edge == "end":
        lengths[1:] = []
    outer = [(d, d)] * 3
    if "step" in edge:
        larger = (float(rng.uniform(1.1, 2.0)) * d,) * 2
        outer = [(d, d), larger, (d, d)] if edge != "step down" else [larger, (d, d), (d, d)]
    elif edge == "kink":
        outer = [(d, d), (d, 1.4 * d), (1.4 * d, 1.4 * d)]
    bores = [(0.0, 0.0)] * 3
    if edge == "bore":
        bores = [(0.3 * d, 0.3 * d), (0.5 * d, 0.5 * d), (0.5 * d, 0.5 * d)]
    elif edge == "tapered bore":
        bores = [(0.3 * d, 0.3 * d), (0.3 * d, 0.6 * d), (0.6 * d, 0.6 * d)]
    segments, y = [], 0.0
    for k, length in enumerate(lengths):
        segments.append(
            Segment(
                name=f"s{k}",
                y0=y * MM,
                y1=(y + length) * MM,
                outer0=outer[k][0] * MM / 2,
                outer1=outer[k][1] * MM / 2,
                inner0=bores[k][0] * MM / 2,
                inner1=bores[k][1] * MM / 2,
                material=second if k == 1 else first,
            )
        )
        y += length
    at = lengths[0] - (0.0 if edge == "end" else gap)
    width = float(rng.uniform(0.2, 0.5)) * d
    near, far = (at - width, at), (0.1 * lengths[0], 0.1 * lengths[0] + 0.15 * d)
    springs = {"kxx": 1e8, "kyy": 5e7, "kzz": 1e8, "kthx": 1e4, "kthy": 1e4, "kthz": 1e4}
    holder, loaded = (near, far) if held_there else (far, near)
    hold = {"hold": "clamped"} if held_there and tie == "rigid" else {"stiffness": springs}
    bearing = Bearing(
        name="b",
        y=sum(holder) / 2 * MM,
        seat_width=(holder[1] - holder[0]) * MM,
        attachment=tie if held_there else "average",
        **hold,
    )
    port = Port(
        name="p",
        y=sum(loaded) / 2 * MM,
        lo=loaded[0] * MM,
        hi=loaded[1] * MM,
        attachment="average" if held_there else tie,
    )
    title = f"{tie} {'seat' if held_there else 'point'} that ends {gap:g} mm before a {edge}"
    return Scene.from_parts(
        segments, first, [bearing], port, ask=Ask(modes=6), title=title, name=f"ends_{seed}"
    )
