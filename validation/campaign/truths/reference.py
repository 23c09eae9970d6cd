"""Numbers of a harmonic solid of its own, refined until they stand still: the spectral reference.

A body of revolution is solved exactly by harmonics, so that only the meridian mesh is left to
err, in two ways. *Layers*: the cells in a singular corner shrink geometrically and what the last
one misses shrinks by ``ratio^(2 lambda)`` per layer, lambda at least 1/2. *Order*: on a geometric
mesh the error falls exponentially with the polynomial order.

    value       = Aitken of three orders on the same mesh
    uncertainty = three times Aitken's own step (both steps where the three do not fall geometrically)
                  + what the layers beyond the last can add, from the step of the last two
                  + what the solver left

Mesh and elements are `corner_mesh` and `spectral`; from the product come the outline of the
coarsest mesh, the solvers and the definition of what is compared.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from solidgear.core.body import as_supports
from solidgear.core.judge.quantities import measure, size
from solidgear.core.judge.solving import Statics
from solidgear.core.quantity import QUANTITIES, STIFFNESS
from solidgear.core.scene import Scene
from solidgear.core.solve.modes import modes
from validation.campaign.truths.corner_mesh import TooFine, corner_mesh
from validation.campaign.truths.spectral import spectral

RATIO = 0.2
SIZE = 2.0  # least outer radii
#: (lowest of three orders, layers), from light to heavy
LEVELS = ((3, 6), (5, 8), (7, 11))
#: below this relative step the sequence has reached rounding and is not extrapolated
ROUNDING = 1e-10
EXTRA_MODES = 6
#: on Aitken's own step: of 135 figures on 18 scenes the next level moved 12 by more than it, and
#: one by more than three times it
SURE = 3.0


@dataclass(frozen=True)
class Reference:
    """Values and uncertainties (relative) of compared quantities, and modes behind frequencies.

    Attributes
    ----------
    values, uncertainty : dict of str to float
    modes : list of dict
        As `plain_mode`, with their ``uncertainty``; without ``motions`` where there is no gram.
    gram : list of list
        Weights of the stations, for correlation.
    setting : list of int
        Order and layers of the finest that was solved.
    unknowns : int
    seconds : float
        Of processor time, for all solutions.
    """

    values: dict
    uncertainty: dict
    modes: list
    gram: list
    setting: list
    unknowns: int
    seconds: float

    def meets(self, goal: Mapping[str, float]) -> bool:
        """Every quantity is known as well as asked."""
        known = self.uncertainty
        return all(known[q] <= wanted for q, wanted in goal.items() if q in known)


def plain_mode(mode) -> dict:
    """A mode as plain data, its motions (shapes, stations, 6) of unit size."""
    scale = max(np.abs(mode.motions).max(), 1e-300)
    return {
        "name": mode.name,
        "family": mode.family,
        "frequency_hz": float(mode.frequency_hz),
        "multiplicity": mode.multiplicity,
        "captured": float(mode.captured),
        "motions": np.round(mode.motions / scale, 9).tolist(),
    }


def solved(scene: Scene, body, **options) -> dict:
    """Statics at and between all points and modes of a body, as plain data."""
    supports = as_supports(scene)
    names = tuple(port.name for port in scene.ports)
    statics = Statics.at_points(body, supports, names)
    main, coupled = statics.main, statics.coupled
    found = modes(body, supports, max(scene.ask.modes, 10) + EXTRA_MODES, **options)
    return {
        "values": measure(main, found, statics.further, coupled),
        "modes": [plain_mode(mode) for mode in found.modes],
        "gram": found.gram.tolist(),
        # eigenvalues err by the square of the shapes' error, of which the residual is the size
        "noise": float(max(main.evidence["residual"], found.evidence["residual"] ** 2)),
        # what the inverse of several points makes of it
        "inverted": coupled.evidence["stiffness_error"] if coupled else 0.0,
        "unknowns": body.size,
    }


def spectral_reference(scene: Scene, level: int, limit: int) -> Reference | None:
    """One of `LEVELS`, or None if its bending block takes more unknowns than the limit."""
    start = time.process_time()
    order, layers = LEVELS[level]
    each = 3 * (order + 2) ** 2
    try:
        mesh = corner_mesh(scene, layers, SIZE, RATIO, limit // each)
    except TooFine:
        return None
    if len(mesh.cells) * each > limit:
        return None
    found = _settled(scene, mesh, order, layers)
    return replace(found, seconds=time.process_time() - start)


def _settled(scene: Scene, mesh, order: int, layers: int) -> Reference:
    runs = [solved(scene, spectral(scene, mesh, p)) for p in (order, order + 1, order + 2)]
    fewer = corner_mesh(scene, layers - 2, SIZE, RATIO)
    shallow = solved(scene, spectral(scene, fewer, order))
    noise = max(r["noise"] for r in runs)
    inverted = max(r["inverted"] for r in runs)
    values, uncertainty = {}, {}
    for name in dict.fromkeys((*QUANTITIES, *runs[-1]["values"])):
        if all(name in r["values"] for r in (*runs, shallow)):
            four = [r["values"][name] for r in (*runs, shallow)]
            left = inverted if name.pair and name.kind == STIFFNESS else noise
            values[name], uncertainty[name] = settle(*four, size(runs[-1]["values"], name), left)
    last = runs[-1]
    told = _spectrum(runs, shallow, noise), last["gram"], [order + 2, layers], last["unknowns"]
    return Reference(values, uncertainty, *told, seconds=0.0)


def settle(
    a: float, b: float, c: float, shallow: float, scale: float, noise: float = 0.0
) -> tuple[float, float]:
    """Value and relative uncertainty from three ascending orders, and the lowest with two layers
    less; `noise` is the relative error that the solver may have left.
    """
    first, second = b - a, c - b
    # two layers more take away at least 1 - ratio^2 of what is missing
    deeper = abs(a - shallow) * RATIO**2 / (1 - RATIO**2)
    factor = second / first if first else 0.0
    # steps far below the others are rounding, whose ratio says nothing
    if abs(second) <= ROUNDING * scale:
        tail, doubt = 0.0, abs(second)
    elif 0 < factor < 0.7:
        tail = second * factor / (1 - factor)
        doubt = abs(tail)
    else:
        tail, doubt = 0.0, abs(first) + abs(second)
    return c + tail, (SURE * doubt + deeper) / scale + noise


def _spectrum(runs: list[dict], shallow: dict, noise: float) -> list[dict]:
    """Modes of the finest run with extrapolated frequencies, as far as all runs have as many
    shapes at each place of the spectrum.
    """
    out = []
    for i, mode in enumerate(runs[-1]["modes"]):
        same = [r["modes"][i] if i < len(r["modes"]) else None for r in (*runs, shallow)]
        if any(m is None or m["multiplicity"] != mode["multiplicity"] for m in same):
            break
        hz, doubt = mode["frequency_hz"], 0.0
        if hz > 0:
            hz, doubt = settle(*(m["frequency_hz"] for m in same), hz, noise)
        out.append(mode | {"frequency_hz": hz, "uncertainty": doubt})
    return out
