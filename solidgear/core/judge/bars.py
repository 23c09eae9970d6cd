"""Error bar of one quantity, computed on one mesh (:mod:`solidgear.core.judge.bounded`)."""

from __future__ import annotations

from dataclasses import dataclass

#: rounding: smaller differences mean nothing
LEAST = 1e-10


@dataclass(frozen=True)
class ErrorBar:
    """Error bar of one quantity."""

    #: the error bar, relative to the value of the mesh (couplings: to the geometric mean of their
    #: diagonal entries)
    width: float
    change: float  #: distance of the other end of the bounds, relative as `width`
    factor: float  #: safety in that
    solver: float  #: share of the solver in the error bar
    extrapolated: float  #: the other end without the safety
    #: a better value than that of the mesh, where there is one
    middle: float | None = None
    aside: float = 0.0  #: distance of `middle` from the value of the mesh, relative as `width`
    #: share of the error bar, to either side, as a mesh is not quite the body
    geometry: float = 0.0
    method: str = ""  #: where the error bar comes from

    @property
    def about_middle(self) -> float:
        """The error bar about `middle`, which is narrower; about the value of the mesh where there is
        none.
        """
        return self.width if self.middle is None else self.width - self.aside
