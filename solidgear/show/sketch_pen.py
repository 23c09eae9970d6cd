"""The pen of a sketch: lines and words on paper, in inches along the shaft and from its axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

INK = "#222222"
FILL = {"shaft": "#d5dbe1", "frustum": "#ecd9b4", "backcone": "#dcc08a"}


@dataclass(frozen=True)
class Pen:
    """Axes of matplotlib, in inches: x along the shaft, 0 on the axis."""

    ax: Any
    left: float  #: where the shaft begins
    #: inch, radial: inches per metre along the shaft and across it
    inch: float
    radial: float
    top: float  #: largest radius

    def x(self, y: float) -> float:
        """Return the place of a position along the shaft, m."""
        return self.left + y * self.inch

    def line(
        self,
        x: Sequence[float],
        y: Sequence[float],
        colour: str = INK,
        width: float = 1.1,
        order: float = 5,
        **look: Any,
    ) -> None:
        """Draw a line through places, over lower orders."""
        self.ax.plot(x, y, color=colour, lw=width, zorder=order, **look)

    def words(
        self,
        x: float,
        y: float,
        text: str,
        colour: str = INK,
        order: float = 10,
        *,
        ha: str = "center",
        va: str = "center",
        size: float = 8,
        alpha: float = 0.8,
        pad: float = 0.5,
        **look: Any,
    ) -> None:
        """Draw words on white, texts from a file unchanged."""
        paper = {"facecolor": "white", "edgecolor": "none", "alpha": alpha, "pad": pad}
        how: dict[str, Any] = {"ha": ha, "va": va, "fontsize": size, "parse_math": False, **look}
        self.ax.text(x, y, text, color=colour, bbox=paper, zorder=order, **how)
