"""What holds a body: springs between its ports and ground."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from solidgear.body.model import Body
from solidgear.errors import SolidgearError
from solidgear.frames import DOF_NAMES

if TYPE_CHECKING:
    from solidgear.scene import Bearing, Scene

    #: what :func:`as_supports` takes
    Holding: TypeAlias = "Supports | Scene | Iterable[Bearing]"


@dataclass(frozen=True, eq=False)
class Supports:
    """Springs between ports and ground.

    Attributes
    ----------
    ports : tuple of str
        Names of the supported ports.
    stiffness : (6 m, 6 m) ndarray
        Symmetric positive semidefinite, SI, port by port; off-diagonal blocks only where a common
        housing ties bearings together.
    attachments : tuple of (str or None)
        Attachment asked for at each port; None takes the body's first.

    Examples
    --------
    >>> import numpy as np
    >>> from solidgear import Supports
    >>> spring = Supports(("A",), np.diag([1e8, 0.0, 1e8, 0.0, 0.0, 0.0]))
    >>> spring.root.shape  # of rank two
    (6, 2)
    >>> bool(np.allclose(spring.root @ spring.root.T, spring.stiffness))
    True
    """

    ports: tuple[str, ...]
    stiffness: np.ndarray
    attachments: tuple[str | None, ...] = ()

    @cached_property
    def root(self) -> np.ndarray:
        """(6 m, r) matrix ``L`` with ``L L' = stiffness`` and r its rank.

        Cholesky's factor with the stiffest pivots first, of the matrix scaled to a unit diagonal: a
        spring of 1e-3 N/m beside one of 1e24 keeps its own precision, in a column of its own.
        (Eigenvectors would mix equal entries of the scaled matrix, whatever they couple.)
        """
        if not self.ports:
            return np.zeros((0, 0))
        d = np.sqrt(np.abs(np.diag(self.stiffness)))
        order = np.argsort(-d, kind="stable")
        unit = np.where(d > 0, d, 1.0)[order]
        left = self.stiffness[np.ix_(order, order)] / np.outer(unit, unit)
        columns = []
        for j in range(len(left)):
            if left[j, j] > 1e-12:
                column = left[:, j] / np.sqrt(left[j, j])
                column[:j] = 0.0
                columns.append(column)
                left = left - np.outer(column, column)
        out = np.zeros((len(d), len(columns)))
        out[order] = d[order, None] * np.array(columns).reshape(len(columns), len(d)).T
        return out

    def rows(self, body: Body) -> np.ndarray:
        """Places of the supported components among the port components of a body.

        Parameters
        ----------
        body : Body

        Returns
        -------
        (6 m,) ndarray of int

        Raises
        ------
        SolidgearError
            If the body lacks a port, or motions that springs hold.
        """
        self._refuse_absent(body)
        wanted = self.attachments or (None,) * len(self.ports)
        places = [6 * body.port_index(n, a) + np.arange(6) for n, a in zip(self.ports, wanted)]
        return np.concatenate(places) if places else np.zeros(0, int)

    def _refuse_absent(self, body: Body) -> None:
        """Springs on motions that a body was built without would find it rigid there."""
        held = {int(row) % 6 for row in np.flatnonzero(self.stiffness.any(axis=1))}
        absent = held - {c for block in body.blocks for c in block.components}
        if absent:
            names = " ".join(DOF_NAMES[c] for c in sorted(absent))
            raise SolidgearError(
                f"the {body.fidelity} body was built without the motions {names}, "
                "which bearings hold; build all families, or leave these springs out"
            )

    def with_attachment(self, attachment: str | None) -> Supports:
        """The same springs acting on another attachment of the same ports.

        Parameters
        ----------
        attachment : str or None

        Returns
        -------
        Supports
        """
        return Supports(self.ports, self.stiffness, (attachment,) * len(self.ports))

    def on(self, components: Iterable[int]) -> Supports:
        """The same springs on some components of the ports only; couplings to others are left out.

        Parameters
        ----------
        components : iterable of int
            Of x y z thx thy thz, by place.

        Returns
        -------
        Supports
        """
        keep = np.tile(np.isin(np.arange(6), list(components)), len(self.ports))
        stiffness = np.where(np.outer(keep, keep), self.stiffness, 0.0)
        return Supports(self.ports, stiffness, self.attachments)

    def unresisted(self, body: Body) -> np.ndarray:
        """Rigid motions about the origin that no spring resists.

        Parameters
        ----------
        body : Body

        Returns
        -------
        (6, k) ndarray
            Orthonormal, with rotations times the length.

        Raises
        ------
        SolidgearError
            If the body lacks a port.
        """
        size = np.array([1.0, 1.0, 1.0, 1 / body.length, 1 / body.length, 1 / body.length])
        if not self.ports:
            return np.eye(6) * size
        # Rank does not depend on how stiff a spring is: every row is brought to unit length first.
        a = self.root.T @ body.rigid_ports[self.rows(body)] * size
        norm = np.linalg.norm(a, axis=1, keepdims=True)
        a = a / np.where(norm > 0, norm, 1.0)
        _, s, vt = np.linalg.svd(a)
        rank = int((s > 1e-9).sum())
        null = vt[rank:].T
        null[np.abs(null) < 1e-9] = 0.0
        return size[:, None] * null


def as_supports(source: Holding) -> Supports:
    """Supports of a scene (housing included), of bearings (no housing), or as they are.

    A housing spring sits between ground and the axially rigid ring that carries all outer races:
    eliminating that ring leaves ``K - K e (e'K e + k)^-1 e'K`` with e the common axial motion.

    Parameters
    ----------
    source : Scene, Supports or iterable of Bearing

    Returns
    -------
    Supports

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> as_supports(scene).ports, as_supports(scene.bearings[:1]).ports
    (('A', 'B'), ('A',))
    """
    if isinstance(source, Supports):
        return source
    housing = getattr(source, "housing_axial", None)
    bearings: Iterable = getattr(source, "bearings", source) or ()
    bearings = tuple(bearings)
    n = len(bearings)
    k = np.zeros((6 * n, 6 * n))
    for i, bearing in enumerate(bearings):
        k[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] = bearing.stiffness
    if housing is not None and n:
        e = np.zeros(6 * n)
        e[1::6] = 1.0
        ke = k @ e
        k = k - np.outer(ke, ke) / (e @ ke + housing)
    return Supports(tuple(b.name for b in bearings), k)
