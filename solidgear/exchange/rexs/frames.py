"""Where components lie: the frames that a REXS document gives, each in that of another component.

A frame has its origin (``support_vector``) and the axes u along the shaft, v and w; a train has y
along u, z along v and x along w of its first shaft.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.exchange.rexs.document import Component, Document, RexsError

#: of unit vectors: what vectors of a file lose by their digits
ROUNDED = 1e-6


@dataclass(frozen=True)
class Frame:
    """An origin (3,), m, and axes (3, 3) with u, v, w as columns."""

    origin: np.ndarray
    axes: np.ndarray

    @property
    def u(self) -> np.ndarray:
        """Direction of the shaft."""
        return self.axes[:, 0]

    @property
    def train_axes(self) -> np.ndarray:
        """(3, 3) axes x, y, z of a train whose first shaft this is, as columns."""
        return self.axes[:, [2, 0, 1]]


def frame_of(document: Document, component: Component) -> Frame | None:
    """Return the frame of a component in that of the gear unit; None where the file gives none."""
    chain, frame = [component], Frame(np.zeros(3), np.eye(3))
    while True:
        reference = chain[-1].whole("reference_component_for_position")
        if reference is None or reference == chain[-1].id:
            break
        if reference not in document.components:
            raise component.wrong("reference_component_for_position", "there is no such component")
        chain.append(document.components[reference])
        if chain[-1] in chain[:-1]:
            raise component.wrong("reference_component_for_position", "closes a circle")
    if component.attribute("support_vector") is None:
        return None
    for link in reversed(chain):
        local = _local(link)
        frame = Frame(frame.origin + frame.axes @ local.origin, frame.axes @ local.axes)
    return frame


def _local(component: Component) -> Frame:
    """Return the frame of a component in that of its reference."""
    origin = _vector(component, "support_vector", (0.0, 0.0, 0.0))
    # lengths of directions are no lengths: the factor of their unit falls out
    u = _direction(component, "u_axis_vector", (1.0, 0.0, 0.0))
    w = _direction(component, "w_axis_vector", (0.0, 0.0, 1.0))
    if abs(u @ w) > ROUNDED:
        raise component.wrong("w_axis_vector", "must be across u_axis_vector")
    return Frame(origin, np.column_stack([u, np.cross(w, u), w]))


def _vector(component: Component, name: str, usual: tuple[float, float, float]) -> np.ndarray:
    numbers = component.numbers(name)
    if numbers is None:
        return np.array(usual)
    if len(numbers) != 3:
        raise component.wrong(name, "must be three numbers")
    return np.array(numbers)


def _direction(component: Component, name: str, usual: tuple[float, float, float]) -> np.ndarray:
    vector = _vector(component, name, usual)
    length = float(np.linalg.norm(vector))
    if not length:
        raise component.wrong(name, "has no direction: all of it is zero")
    return vector / length


def along(frame: Frame | None, first: Frame | None, component: Component) -> int | None:
    """Return 1 or -1 where a shaft runs along the first or against it; None where it does neither."""
    if frame is None or first is None:
        return None
    cosine = float(frame.u @ first.u)
    if abs(abs(cosine) - 1) > ROUNDED:
        return None
    if not np.all(np.isfinite(frame.origin)):
        raise RexsError(f"{component.label}: support_vector is not finite")
    return 1 if cosine > 0 else -1
