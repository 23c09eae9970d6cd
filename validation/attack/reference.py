"""What a scene's compared numbers really are: harmonic solutions refined until they stand still.

A body of revolution is solved exactly by harmonics, so that only the meridian mesh is left to err. Two errors are taken
apart. *Layers*: the cells at a shoulder, at a seat's end and at a section's plane shrink geometrically, and the energy
that the last one misses shrinks by a constant factor per layer (2 lambda for a singularity r^lambda), which Aitken's
formula extrapolates. *Order*: on a geometric mesh the error falls exponentially with the polynomial order, so that the
step from one order to the next is nearly all of what is left.

    value       = Aitken(v(p, L), v(p, L+1), v(p, L+2)) + [v(p+1, L) - v(p, L)]
    uncertainty = Aitken's own step (both steps where the three do not converge geometrically)
                  + the step in order + what the solver left

All builder options are given, so that the product's defaults do not matter.
"""

from __future__ import annotations

import hashlib
import json
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from solidgear.body import as_supports
from solidgear.errors import SolidgearError
from solidgear.evidence.quantities import QUANTITIES, measure
from solidgear.fidelity import build
from solidgear.scene import Scene
from solidgear.solve.modes import modes
from solidgear.solve.statics import condense
from solidgear.whole_file import whole

FOLDER = Path(__file__).resolve().parent.parent / "results" / "attack" / "reference"
RATIO = 0.15
#: (order, first of three numbers of layers), from light to heavy
LEVELS = ((4, 1), (4, 2), (5, 3), (6, 4), (7, 5), (8, 7))
#: unknowns of the bending block above which a level is not tried: about 20 s on one core for all its solutions
MOST_UNKNOWNS = 60_000
#: below this relative step the sequence has reached rounding and is not extrapolated
ROUNDING = 1e-10
EXTRA_MODES = 6
BAD_RESIDUAL = 1e-3


@dataclass(frozen=True)
class Setting:
    """Options of one harmonic solution; ``size`` counts in least outer radii of the shaft."""

    order: int
    layers: int
    edge_layers: int
    size: float = 2.0
    ratio: float = RATIO

    def options(self, scene: Scene) -> dict:
        """For the builder, none left to its defaults."""
        least = min(min(s.outer0, s.outer1) for s in scene.segments)
        return {
            "order": self.order,
            "layers": self.layers,
            "edge_layers": self.edge_layers,
            "ratio": self.ratio,
            "size": self.size * least,
            "refinement": 1.0,
            "ovalising": (),
        }


@dataclass(frozen=True)
class Reference:
    """Values and uncertainties (relative) of the compared quantities, and the modes behind the frequencies.

    Attributes
    ----------
    values, uncertainty : dict of str to float
    modes : list of dict
        ``name``, ``frequency_hz``, ``multiplicity``, ``family``, ``uncertainty`` and ``motions`` (shapes, stations, 6).
    gram : list of list
        Weights of the stations, for correlation.
    setting : dict
        The finest that was solved.
    unknowns : int
    seconds : float
        Of processor time, for all solutions.
    reached : bool
        Whether the asked uncertainty was reached.
    """

    values: dict
    uncertainty: dict
    modes: list
    gram: list
    setting: dict
    unknowns: int
    seconds: float
    reached: bool


def reference(scene: Scene, goal: float = 1e-6, limit: int = MOST_UNKNOWNS, folder: Path | None = FOLDER) -> Reference | None:
    """The compared numbers of a scene, to a relative uncertainty of `goal` where the limit on unknowns allows.

    Returns None where not even the lightest level is within the limit. Results are kept in `folder`.
    """
    key = _key(scene, goal, limit)
    kept = _read(folder, key)
    if kept is not None:
        return Reference(**kept) if kept else None
    found, start = None, time.process_time()
    for order, layers in LEVELS:
        if _unknowns(scene, order + 1, layers + 2) > limit:
            break
        found = _level(scene, order, layers)
        if max(found.uncertainty.values(), default=0.0) <= goal:
            break
    if found is not None:
        reached = max(found.uncertainty.values(), default=0.0) <= goal
        found = Reference(**(asdict(found) | {"seconds": time.process_time() - start, "reached": reached}))
    _write(folder, key, asdict(found) if found else {})
    return found


# ------------------------------------------------------------------------------------------------- one level
def _level(scene: Scene, order: int, layers: int) -> Reference:
    runs = [solve(scene, Setting(order, n, n)) for n in (layers, layers + 1, layers + 2)]
    higher = solve(scene, Setting(order + 1, layers, layers))
    noise = max(r["noise"] for r in (*runs, higher))
    values, uncertainty = {}, {}
    for name in QUANTITIES:
        if all(name in r["values"] for r in (*runs, higher)):
            scale = _scale(runs[-1]["values"], name)
            three, top = [r["values"][name] for r in runs], higher["values"][name]
            values[name], uncertainty[name] = settle(*three, top, scale, noise)
    spectrum = _spectrum(runs, higher, noise)
    last = runs[-1]
    return Reference(values, uncertainty, spectrum, last["gram"], asdict(Setting(order, layers + 2, layers + 2)), last["unknowns"], 0.0, True)


def settle(a: float, b: float, c: float, higher: float, scale: float, noise: float = 0.0) -> tuple[float, float]:
    """Value and relative uncertainty from three numbers of layers and, at the first of them, one order more.

    Parameters
    ----------
    a, b, c : float
        With L, L + 1 and L + 2 layers.
    higher : float
        As ``a`` but one order higher.
    scale : float
        What uncertainties are relative to.
    noise : float
        Relative error that the solver may have left.
    """
    first, second = b - a, c - b
    step = higher - a
    # steps far below the others are rounding, whose ratio says nothing
    settled = abs(second) <= ROUNDING * scale
    factor = second / first if first else 0.0
    if settled:
        tail, doubt = 0.0, abs(second)
    elif 0 < factor < 0.7:
        tail = second * factor / (1 - factor)
        doubt = abs(tail)
    else:
        tail, doubt = 0.0, abs(first) + abs(second)
    return c + tail + step, (doubt + abs(step)) / scale + noise


def _scale(values: dict, name: str) -> float:
    """A coupling has no size of its own: symmetry can make it zero."""
    for kind in "CK":
        direct = [values.get(f"{kind}_zz"), values.get(f"{kind}_thx")]
        if name == f"{kind}_z,thx" and None not in direct:
            return float(np.sqrt(direct[0] * direct[1]))
    return abs(values[name])


def _spectrum(runs: list[dict], higher: dict, noise: float) -> list[dict]:
    """Modes of the finest run with extrapolated frequencies; paired by their place in the spectrum, which is settled here."""
    out = []
    for i, mode in enumerate(runs[-1]["modes"]):
        same = [r["modes"][i] if i < len(r["modes"]) else None for r in (*runs, higher)]
        if any(m is None or m["multiplicity"] != mode["multiplicity"] for m in same):
            break
        hz, doubt = mode["frequency_hz"], 0.0
        if hz > 0:
            hz, doubt = settle(*(m["frequency_hz"] for m in same), hz, noise)
        out.append(mode | {"frequency_hz": hz, "uncertainty": doubt})
    return out


def solve(scene: Scene, setting: Setting, n: int | None = None, sections: bool = True) -> dict:
    """One harmonic solution: ``values``, ``modes``, ``gram``, ``noise``, ``unknowns``, ``seconds`` of processor time.

    `sections` grades the mesh at the planes of section ties too.
    """
    start = time.process_time()
    body = build(graded_sections(scene) if sections else scene, "harmonic", **setting.options(scene))
    supports = as_supports(scene)
    condensed = condense(body, supports, scene.port.name)
    found = modes(body, supports, n or max(scene.ask.modes, 10) + EXTRA_MODES)
    shapes = [
        {
            "name": m.name,
            "family": m.family,
            "frequency_hz": float(m.frequency_hz),
            "multiplicity": m.multiplicity,
            "motions": np.round(m.motions / max(np.abs(m.motions).max(), 1e-300), 9).tolist(),
        }
        for m in found.modes
    ]
    return {
        "values": measure(condensed, found),
        "modes": shapes,
        "gram": found.gram.tolist(),
        "noise": _noise(condensed, found),
        "unknowns": body.size,
        "cells": body.mesh["cells"],
        "seconds": time.process_time() - start,
    }


def _noise(condensed, found) -> float:
    """What the solver may have left, where that is more than the scatter between meshes shows.

    Frequencies err by far less than the residual bound, which grows with the grading; rounding differs from mesh to mesh, so that
    an inaccurate inverse shows as steps that do not shrink. A bad residual is believed all the same.
    """
    residual = found.evidence["residual"]
    return float(max(condensed.evidence["residual"], residual if residual > BAD_RESIDUAL else 0.0))


def graded_sections(scene: Scene) -> Scene:
    """The scene with the spans of section ties drawn together at their planes, so that mesh grading at a span's ends finds them.

    A section tie does not look at its span. A plane at a step or an end face is left: it has a mesh line of its own.
    """
    thin = 1e-5 * scene.length
    marks = [0.0, scene.length, *scene.steps]

    def clear(y):
        return min(abs(y - m) for m in marks) > 2 * thin

    bearings = tuple(b.with_changes(seat_width=2 * thin) if b.attachment == "section" and clear(b.y) else b for b in scene.bearings)
    port = scene.port
    if port.attachment == "section" and clear(port.y):
        port = port.with_changes(lo=port.y - thin, hi=port.y + thin)
    return scene.with_changes(bearings=bearings, port=port)


def _unknowns(scene: Scene, order: int, layers: int) -> int:
    """Of the largest block, from the cells of a mesh of order 1."""
    options = Setting(1, layers, layers).options(scene)
    cells = build(graded_sections(scene), "harmonic", **options).mesh["cells"]
    return 3 * cells * order**2


# ------------------------------------------------------------------------------------------------- kept results
def _key(scene: Scene, goal: float, limit: int) -> str:
    told = json.dumps([scene.as_dict(), goal, limit, LEVELS, RATIO, 1], sort_keys=True, default=str)
    return hashlib.sha256(told.encode()).hexdigest()[:24]


def _read(folder: Path | None, key: str) -> dict | None:
    if folder is None or not (folder / f"{key}.json").exists():
        return None
    return json.loads((folder / f"{key}.json").read_text())


def _write(folder: Path | None, key: str, content: dict) -> None:
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
        with whole(folder / f"{key}.json") as partial:
            partial.write_text(json.dumps(content))


def section_ties(scene: Scene) -> Scene:
    """The fair partner of a beam: section ties at the port and at every bearing."""
    return scene.with_attachment("section")


__all__ = ["Reference", "Setting", "SolidgearError", "reference", "section_ties", "settle", "solve"]
