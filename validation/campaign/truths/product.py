"""Numbers of the harmonic solid of the product on a mesh far finer than answers take."""

from __future__ import annotations

import time

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.core.judge.quantities import size
from solidgear.core.scene import Scene
from validation.campaign.truths.reference import Reference, solved

#: orders, and the rest of the mesh; the second where rounding drowns the first
ORDERS = (7, 8)
FINEST = (
    {"layers": 6, "edge_layers": 6, "ratio": 0.15, "relative_size": 0.8},
    {"layers": 4, "edge_layers": 3, "ratio": 0.15, "relative_size": 1.0},
)
#: an edge of exponent a leaves 1 / ((8/7)^(4 a) - 1) of the last step: 3 at a shoulder, 5 at the
#: end of a rigid seat there
LEFT = 5.0


def product_reference(scene: Scene) -> Reference:
    """The finest mesh that can be solved."""
    try:
        return _product(scene, FINEST[0])
    except SolidgearError:
        return _product(scene, FINEST[1])


def _product(scene: Scene, mesh: dict) -> Reference:
    start = time.process_time()
    low, high = (
        solved(scene, sg.build(scene, "harmonic", order=order, **mesh), ovalising=False)
        for order in ORDERS
    )
    values, uncertainty = {}, {}
    for name, value in high["values"].items():
        if name in low["values"]:
            step = abs(value - low["values"][name]) / size(high["values"], name)
            values[name], uncertainty[name] = value, LEFT * step + high["noise"]
    told = _spectrum(low, high), high["gram"], [ORDERS[-1], mesh["layers"]], high["unknowns"]
    return Reference(values, uncertainty, *told, seconds=time.process_time() - start)


def _spectrum(low: dict, high: dict) -> list[dict]:
    """Modes of the higher order, as far as the lower one has the same at each place."""
    out = []
    for one, other in zip(low["modes"], high["modes"]):
        if one["name"] != other["name"] or one["multiplicity"] != other["multiplicity"]:
            break
        hz = other["frequency_hz"]
        step = abs(hz - one["frequency_hz"]) / hz if hz else 0.0
        out.append(other | {"uncertainty": LEFT * step + high["noise"]})
    return out
