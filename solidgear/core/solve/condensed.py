"""Results of condensation: stiffness and compliance at one lumped point, or between several."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from solidgear.core.display import Displayed
from solidgear.core.errors import SolidgearError, listed, nearest, show
from solidgear.core.frames import DOF_NAMES


@dataclass(frozen=True, repr=False)
class Condensed(Displayed):
    """Static behaviour seen from one port, bearings included."""

    shown: ClassVar[str] = "condensed"
    plain_names = (
        "port",
        "attachment",
        "order",
        "stiffness",
        "compliance",
        ("free", "free_names"),
        ("free_oblique", "oblique_rows"),
    )
    order = DOF_NAMES  #: components of motions and loads

    port: str
    attachment: str
    #: (6, 6) N/m, N/rad, N m/rad; rows of unresisted motions are exactly zero
    stiffness: np.ndarray
    #: (6, 6) motions under loads; NaN in rows and columns that a free motion moves
    compliance: np.ndarray
    free: np.ndarray  #: (6, k) motions of the port that nothing resists
    evidence: dict = field(default_factory=dict)  #: asymmetry, refinement residual, back end

    @property
    def free_names(self) -> tuple[str, ...]:
        """Names of the components that are free by themselves."""
        return tuple(n for n, alone in zip(DOF_NAMES, self._alone()) if alone)

    @property
    def oblique(self) -> np.ndarray:
        """(6, k) free motions that no single component describes, largest entry 1."""
        largest = np.abs(self.free).max(axis=0, initial=0.0)
        largest_elsewhere = np.abs(self.free[~self._alone()]).max(axis=0, initial=0.0)
        motions = self.free[:, largest_elsewhere > 1e-9 * largest]
        size = np.abs(motions)
        # the first of several that are as large: a solver gives any sign
        first = np.argmax(size > (1 - 1e-9) * size.max(axis=0, initial=0.0), axis=0)
        return motions / motions[first, np.arange(motions.shape[1])]

    @property
    def oblique_rows(self) -> np.ndarray:
        """(k, 6) the same, a row each."""
        return self.oblique.T

    def _alone(self) -> np.ndarray:
        """Return the mask of the components whose unit motion nothing resists."""
        return np.array([not np.any(row) for row in self.stiffness])


@dataclass(frozen=True, repr=False)
class Coupled(Displayed):
    """Static behaviour seen from several ports together, bearings included.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/intermediate_shaft.toml")
    >>> body = sg.build(scene, "timoshenko")
    >>> both = sg.condense(body, scene, port=("wheel", "pinion"))
    >>> both.compliance.shape
    (12, 12)
    >>> cross = both.between("wheel", "pinion")  # motion of the wheel for loads on the pinion
    >>> bool(0 < cross[2, 2] < both.between("wheel", "wheel")[2, 2])
    True
    """

    shown: ClassVar[str] = "coupled"
    plain_names = (
        "ports",
        "attachments",
        "order",
        "stiffness",
        "compliance",
        ("free", "free_names"),
    )

    ports: tuple[str, ...]
    attachments: tuple[str, ...]
    #: (6 n, 6 n) loads that hold all ports at given motions, port by port, SI. NaN where ports move
    #: as one: then none exists. Rows of motions that nothing resists at any of them are exactly
    #: zero.
    stiffness: np.ndarray
    #: (6 n, 6 n) motions of all ports under loads at them. NaN in rows and columns that a free
    #: motion moves.
    compliance: np.ndarray
    #: (6 n, k) motions of all ports together that nothing resists; of a shaft that turns freely
    #: one, with thy of every port
    free: np.ndarray
    #: asymmetry, refinement residual, back end, and ``stiffness_error``: the relative error that
    #: inverting leaves in the stiffness
    evidence: dict = field(default_factory=dict)

    @property
    def order(self) -> list[str]:
        """Components of motions and loads, port by port."""
        return [f"{port} {name}" for port in self.ports for name in DOF_NAMES]

    def between(self, one: str, other: str, kind: str = "compliance") -> np.ndarray:
        """Return the block of two ports.

        Parameters
        ----------
        one, other : str
            Names: motion of the first for loads on the second, or of a stiffness the other way
            round. They may be the same.
        kind : {'compliance', 'stiffness'}

        Returns
        -------
        (6, 6) ndarray

        Raises
        ------
        SolidgearError
            If it was not condensed to one of them.
        """
        for name in (one, other):
            if name not in self.ports:
                raise SolidgearError(
                    f"condensed to {listed(self.ports)}, and not to {show(name, 40)}"
                    f"{nearest(name, self.ports)}"
                )
        a, b = (6 * self.ports.index(name) + np.arange(6) for name in (one, other))
        return getattr(self, kind)[np.ix_(a, b)]

    @property
    def free_names(self) -> tuple[str, ...]:
        """Names of the components that a free motion moves."""
        moved = (
            np.abs(self.free).reshape(len(self.ports), 6, -1).max(axis=(0, 2), initial=0.0).tolist()
        )
        return tuple(name for name, free in zip(DOF_NAMES, moved) if free)
