"""Where the spectrum of a free shaft begins, roughly."""

from __future__ import annotations

import numpy as np


def elastic_scale(scene) -> float:
    """Rough lowest elastic eigenvalue of the free shaft, rad^2/s^2 (Euler free-free or axial, the lower).

    Used only to place spectral shifts; an error of a factor of ten is harmless.
    """
    material = scene.segments[0].material
    c2 = material.E / material.density
    mean = np.sqrt(sum(s.length * (s.outer0**2 + s.outer1**2 + s.inner0**2 + s.inner1**2) / 8 for s in scene.segments) / scene.length)
    return min(500.0 * c2 * mean**2 / scene.length**4, np.pi**2 * c2 / scene.length**2)
