"""Error bars of the contact of teeth: what its numbers move by with each part of the discretisation.

Cells are made twice as large, readings go twice as deep, the face has half as many slices; plane slices
are spread along the face over as much less and more as single wheels need; hollow and helical wheels are
made solid and flat, as what stands beside the face may make them.  The bar is the sum of what each moves
a number by.  A coarser mesh moves numbers by more than the finer one is off, so that the sum
is wide rather than narrow.  Slices are too stiff against teeth in 3D by an amount that was measured, and
that the bar holds as well.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import sin

import numpy as np

from solidgear.teeth.compliance.slices import (
    SPREAD_OFF,
    TOO_EVEN_BY_HELIX,
    TOO_STIFF,
    TOO_STIFF_BY_HELIX,
)
from solidgear.teeth.mesh_contact import MeshContact
from solidgear.teeth.supports import Carried
from solidgear.teeth.train_teeth import TeethModel, mesh_contact
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh

#: orders of the transmission error that have bars
BARRED_ORDERS = 3


def numbers_of(contact: MeshContact) -> dict[str, float]:
    """Return the numbers of a contact that have bars, SI."""
    cycle = contact.cycle
    orders = np.abs(cycle.orders(BARRED_ORDERS))
    return {
        "tangent": float(cycle.tangent.mean()),
        "secant": float(cycle.secant.mean()),
        "peak_to_peak": cycle.peak_to_peak,
        **{f"order {n}": float(a) for n, a in enumerate(orders, start=1)},
        "face_load_factor": cycle.face_load_factor,
        "pressure": cycle.pressure,
    }


def error_bars(
    carried: Carried, mesh: Pair | PlanetMesh, model: TeethModel, contact: MeshContact
) -> dict[str, float]:
    """Return the error bars of the numbers of a solved contact, by name, SI."""
    numbers = numbers_of(contact)
    bars = dict.fromkeys(numbers, 0.0)
    for moved in _moved(carried, mesh, model, contact, numbers):
        for name in bars:
            bars[name] += moved[name]
    return bars


def _moved(
    carried: Carried,
    mesh: Pair | PlanetMesh,
    model: TeethModel,
    contact: MeshContact,
    numbers: dict[str, float],
) -> Iterator[dict[str, float]]:
    """Yield by how much numbers move with each part of the discretisation."""

    def solved(other: TeethModel) -> dict[str, float]:
        return numbers_of(mesh_contact(carried, mesh, other))

    def distance(a: dict[str, float], b: dict[str, float]) -> dict[str, float]:
        return {name: abs(a[name] - b[name]) for name in numbers}

    yield distance(solved(replace(model, coarse=True)), numbers)
    yield distance(solved(replace(model, depth=2 * model.depth)), numbers)
    # slices are those of plane teeth in 3D as well, where each would be solved anew
    plane = TeethModel(slices=model.slices, positions=model.positions)
    usual = numbers if model == plane else solved(plane)
    yield distance(solved(replace(plane, slices=plane.slices // 2)), usual)
    if any(contact.rims) or contact.wheels.base_helix:
        yield distance(solved(replace(plane, beside=True)), usual)
    if model.name == plane.name:
        both = [
            distance(solved(replace(model, spread=model.spread + off)), numbers)
            for off in (-SPREAD_OFF, SPREAD_OFF)
        ]
        yield {name: max(side[name] for side in both) for name in numbers}
        yield _against_3d(contact.wheels.base_helix, numbers)


def _against_3d(base_helix: float, numbers: dict[str, float]) -> dict[str, float]:
    """Return by how much numbers of slices are off those of teeth in 3D; of a transmission error twice
    the share of the stiffness, whose changes over the cycle it adds up.
    """
    helix = sin(base_helix) ** 2
    stiff = TOO_STIFF + TOO_STIFF_BY_HELIX * helix
    shares = {"tangent": stiff, "secant": stiff, "pressure": 0.0}
    shares["face_load_factor"] = TOO_EVEN_BY_HELIX * helix
    return {name: shares.get(name, 2 * stiff) * abs(number) for name, number in numbers.items()}
