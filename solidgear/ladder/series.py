"""Lines of a chart of error against cost: the meshes of every rung, uniform and graded, level by
level.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from solidgear.ladder.meshes import CORRECTED, SECTOR
from solidgear.ladder.registry import LADDER
from solidgear.models.solid.body import usual_size

if TYPE_CHECKING:
    from solidgear.ladder.model import Series
    from solidgear.scene.shaft import Shaft


def euler_series(scene: Shaft, full: bool) -> list[Series]:
    """Few elements and the usual number."""
    return [("beam", "Euler", [{"elements": 1}, {}])]


def timoshenko_series(scene: Shaft, full: bool) -> list[Series]:
    """Few elements and the usual number."""
    return [("beam", "Timoshenko", [{"elements": 1}, {}])]


def harmonic_series(scene: Shaft, full: bool) -> list[Series]:
    """Refinement at order 2 and rising orders, each on uniform and on graded meshes."""
    flat = {"layers": 0, "edge_layers": 0, "size": _least_radius(scene)}
    graded = {"layers": 3, "edge_layers": 1}
    orders = _levels((1, 2, 3, 4, 5, 6), (7, 8), full)
    uniform_steps = _levels((0.5, 1.0, 2.0, 4.0), (8.0,), full)
    graded_steps = _levels((0.5, 1.0, 2.0), (3.0,), full)
    lines = {
        "h uniform": [{"order": 2, **flat, "refinement": s} for s in uniform_steps],
        "h graded": [
            {"order": 2, "layers": 4, "edge_layers": 2, "refinement": s} for s in graded_steps
        ],
        "p uniform": [{"order": p, **flat} for p in orders],
        "p graded": [{"order": p, **graded} for p in orders],
    }
    return [("harmonic", f"harmonic {name}", levels) for name, levels in lines.items()]


#: element -> refinements of a quick chart, and those that a full one has on top
_GRADED_TETRAHEDRA = {
    "tet4": ((0.5, 0.8, 1.25), (1.8, 2.4)),
    "tet10": ((0.4, 0.6, 0.9), (1.2, 1.6)),
}
_UNIFORM_TETRAHEDRA = {
    "tet4": ((1.0, 1.8, 2.6), (3.4, 4.4)),
    "tet10": ((0.7, 1.3, 1.8), (2.4, 3.0)),
}
_GRADED_HEXAHEDRA = {
    "hex8": ((0.65, 1.0, 1.5), (2.0, 2.6)),
    "hex20": ((0.35, 0.65, 1.0), (1.4, 1.9)),
    "hex27": ((0.35, 0.65, 0.85), (1.0, 1.4)),
}
_UNIFORM_HEXAHEDRA = {
    "hex8": ((1.0, 1.5, 2.2), (3.0, 3.8)),
    "hex20": ((0.5, 1.0, 1.5), (2.0, 2.8)),
    "hex27": ((0.5, 1.0, 1.3), (1.6, 2.2)),
}


def solid_series(scene: Shaft, full: bool) -> list[Series]:
    """Every element type, on uniform and on graded meshes."""
    size = usual_size(scene)
    even_tetrahedra = {"size": size, "graded_size": size}
    even_hexahedra = {
        "layers": 0,
        "edge_layers": 0,
        "size": 0.6 * _least_radius(scene),
        "radial_layers": 0,
    }
    return [
        *_elements("tetrahedra", "uniform", _UNIFORM_TETRAHEDRA, even_tetrahedra, full),
        *_elements("tetrahedra", "graded", _GRADED_TETRAHEDRA, {}, full),
        *_elements("hexahedra", "uniform", _UNIFORM_HEXAHEDRA, even_hexahedra, full),
        *_elements("hexahedra", "graded", _GRADED_HEXAHEDRA, {}, full),
    ]


def _elements(family: str, grading: str, steps: dict, extra: dict, full: bool) -> list[Series]:
    out = []
    for element, (quick, more) in steps.items():
        refinements = _levels(quick, more, full)
        options = [{"element": element, **extra, "refinement": s} for s in refinements]
        out.append((family, f"{element.upper()} {grading}", options))
    return out


def _least_radius(scene: Shaft) -> float:
    return min(min(s.outer0, s.outer1) for s in scene.segments)


def _levels(quick: tuple, more: tuple, full: bool) -> tuple:
    return quick + more if full else quick


def corrected_series(scene: Shaft, full: bool) -> list[Series]:
    """The meshes of defect correction, for a scene with features."""
    if not LADDER["corrected"].concerns(scene):
        return []
    levels = CORRECTED if full else CORRECTED[:3]
    return [("solid", "corrected harmonic solid", [dict(level) for level in levels])]


def sector_series(scene: Shaft, full: bool) -> list[Series]:
    """The meshes of a cyclic sector, for a scene with such features."""
    if not LADDER["sector"].concerns(scene):
        return []
    levels = SECTOR[:4] if full else SECTOR[:3]
    return [("tetrahedra", "cyclic sector", [dict(level) for level in levels])]
