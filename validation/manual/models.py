"""What the cases share when they solve with solidgear: shafts from spans, frequencies by family."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.core.body import Body
from solidgear.core.solve.modes import ModeSet
from validation.manual.exact import STEEL, Tube

#: a spring of this stiffness (N/m, N m/rad) holds to rounding
FIRM = 1e24


def shaft(spans: Sequence[Tube], **rest: Any) -> sg.Scene:
    """Scene of uniform spans of the reference's steel; ``rest`` as in `Scene.from_parts`."""
    material = sg.Material(E=STEEL.E, nu=STEEL.nu, density=STEEL.density)
    segments: list[sg.Segment] = []
    for number, span in enumerate(spans, start=1):
        start = segments[-1].y1 if segments else 0.0
        segments.append(
            sg.Segment.cylinder(
                f"span {number}",
                length=span.length,
                diameter=2 * span.outer,
                bore=2 * span.inner,
                y0=start,
            )
        )
    return sg.Scene.from_parts(segments, material, **rest)


def bearing(name: str, y: float, width: float, diagonal: Sequence[float]) -> sg.Bearing:
    """Bearing that acts on the mean motion of its cross-section, as on the node of a beam."""
    return sg.Bearing(
        name=name, y=y, seat_width=width, matrix=np.diag(diagonal), attachment="section"
    )


def frequencies(found: ModeSet, family: str) -> list[float]:
    """Elastic frequencies of one family, Hz, ascending."""
    return [m.frequency_hz for m in found.modes if m.family == family and m.frequency_hz > 0]


def numbered(what: str, values: Iterable[float]) -> dict[str, float]:
    """Values by name and number, from 1."""
    return {f"{what} {k}": float(v) for k, v in enumerate(values, start=1)}


def compliances(body: Body, scene: sg.Scene) -> np.ndarray:
    """(6, 6) compliance at the lumped point of a scene."""
    return sg.condense(body, scene, scene.port.name).compliance
