"""The parts, and the lines of each: a model and its meshes from coarse to fine.

All scenes have torsion held by a spring of 1e6 N m/rad at every bearing, without which the matrix
of CalculiX would be singular.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from solidgear.cuts.corrected.model import FEWER
from validation.common import ROOT
from validation.race.ours import held

PARTS = {
    "keyed": "pinion_keyed.toml",
    "toothed": "pinion_toothed.toml",
    "step": "shaft_step.toml",
}
#: how a model is called in tables and legends
UNIFORM, GRADED, HALVES = "TET10 uniform, whole", "TET10 graded, whole", "TET10 graded, two halves"
SECTOR, CORRECTED, PLAIN = "one sector, graded", "defect correction", "plain part, harmonic"
HEAVY, DIFFERENCE = "smaller cone with mass, harmonic", "harmonic + difference of sectors"
CALCULIX, REFERENCE = "CalculiX C3D10, mesh of graded whole", "reference"
#: raw 3D of this program on all of the part
RAW = (UNIFORM, GRADED)
#: share of the head at which the smaller cone runs (validation/teeth.py)
SHARE = 0.9


@dataclass(frozen=True)
class Job:
    """One measurement.

    Attributes
    ----------
    part : str
        Key of ``PARTS``.
    line : str
    options : dict
        Of the builder.
    """

    part: str
    line: str
    options: dict[str, Any]

    @property
    def name(self) -> str:
        """The line and its options in words, by which a row is found again."""
        return f"{self.line}: " + ", ".join(f"{k} {v:g}" for k, v in self.options.items())


def _refined(*levels: float) -> list[dict[str, Any]]:
    return [{"refinement": r} for r in levels]


def _uniform(*sizes: float) -> list[dict[str, Any]]:
    return [{"size": s, "graded_size": s} for s in sizes]


def _harmonic(*levels: tuple[int, int, int]) -> list[dict[str, Any]]:
    names = ("order", "layers", "edge_layers")
    return [{**dict(zip(names, level)), "relative_size": 4.0} for level in levels]


def _corrected(*levels: tuple[int, int, int, float]) -> list[dict[str, Any]]:
    return [dict(zip(("order", "layers", "edge_layers", "refinement"), v)) for v in levels]


_PLAIN = _harmonic((3, 1, 0), (4, 2, 1), (5, 3, 2))
_CORRECTED = [
    *({**level, "modes": FEWER} for level in _corrected((3, 1, 1, 0.25), (3, 1, 1, 0.35))),
    *_corrected((4, 2, 2, 0.5), (5, 3, 2, 0.7)),
]
_BEST = _corrected((6, 4, 3, 0.7), (6, 4, 3, 1.0), (6, 4, 3, 1.4))

LINES: dict[str, dict[str, list[dict[str, Any]]]] = {
    "keyed": {
        UNIFORM: _uniform(0.022, 0.015, 0.011, 0.0085),
        GRADED: _refined(0.35, 0.5, 0.8, 1.1, 1.5),
        HALVES: _refined(0.35, 0.5, 0.8, 1.1, 1.5),
        CORRECTED: _CORRECTED,
        PLAIN: _PLAIN,
        CALCULIX: _refined(0.35, 0.5, 0.8),
        REFERENCE: _BEST,
    },
    "toothed": {
        UNIFORM: _uniform(0.022, 0.015, 0.011),
        GRADED: _refined(0.3, 0.5, 0.7, 1.0, 1.4),
        SECTOR: _refined(0.3, 0.5, 0.7, 1.0, 1.4, 2.0),
        DIFFERENCE: _refined(0.2, 0.3, 0.5),
        HEAVY: _PLAIN,
        PLAIN: _PLAIN,
        CALCULIX: _refined(0.3, 0.5),
        REFERENCE: _refined(0.7, 1.0, 1.4, 2.0),
    },
    "step": {
        UNIFORM: _uniform(0.011, 0.008, 0.006, 0.0045),
        GRADED: _refined(0.3, 0.5, 0.7, 1.0),
        HALVES: _refined(0.3, 0.5, 0.7, 1.0, 1.4),
        CORRECTED: _CORRECTED,
        PLAIN: _PLAIN,
        CALCULIX: _refined(0.3, 0.5, 0.7),
        REFERENCE: _BEST,
    },
}
#: what a line stands for where its name alone does not say it
NOTES = {
    "step": "Halves and defect correction: the same shaft described by segments and a keyway, "
    "for a part from a file is solved whole.",
    "toothed": "The difference of sectors (toothed, plain) is taken by hand: no model offers it.",
    "keyed": "",
}


def jobs(part: str) -> list[Job]:
    """All measurements of a part."""
    return [Job(part, line, dict(o)) for line, levels in LINES[part].items() for o in levels]


def scene_of(part: str):
    """The scene of a part, torsion held."""
    return held(ROOT / "geometry" / PARTS[part], "average")


def as_features(scene):
    """The shaft of `geometry/shaft_step.step` by segments and a keyway."""
    from validation.step_parts import shaft_step

    segments, features = shaft_step()
    return scene.with_changes(body=None, segments=tuple(segments), features=tuple(features))
