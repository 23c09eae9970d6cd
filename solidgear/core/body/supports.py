"""Attachments of a body: springs between ports and ground, and rigid masses on ports."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from solidgear.core.body.cache import LastTwo
from solidgear.core.body.model import Body
from solidgear.core.errors import SolidgearError
from solidgear.core.frames import DOF_NAMES
from solidgear.core.springs import root_of

if TYPE_CHECKING:
    from solidgear.core.scene import Bearing, PointMass, Scene

#: sources of :func:`as_supports`
Holding: TypeAlias = "Supports | Scene | Iterable[Bearing]"


@dataclass(frozen=True, eq=False)
class Supports:
    """Springs between ports and ground, and rigid masses that move with ports.

    Attributes
    ----------
    ports : tuple of str
        Names of the ports that carry a spring or a mass.
    stiffness : (6 m, 6 m) ndarray
        Symmetric positive semidefinite, SI, port by port; off-diagonal blocks only where a common
        housing ties bearings together.
    attachments : tuple of (str or None)
        Attachment asked for at each port; None takes the body's first.
    inertia : (6 m, 6 m) ndarray or None
        Mass matrix of all that moves with the ports, symmetric positive semidefinite, SI; None where
        nothing does.

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
    inertia: np.ndarray | None = None

    @cached_property
    def root(self) -> np.ndarray:
        """(6 m, r) matrix ``L`` with ``L L' = stiffness`` and r its rank."""
        return root_of(self.stiffness) if self.ports else np.zeros((0, 0))

    @cached_property
    def masses(self) -> np.ndarray:
        """(6 m, 6 m) mass matrix of all that moves with the ports; zero where nothing does."""
        return np.zeros_like(self.stiffness) if self.inertia is None else self.inertia

    def rigid_mass(self, body: Body) -> np.ndarray:
        """Mass matrix of the masses on the ports under rigid motions about the origin.

        Parameters
        ----------
        body : Body

        Returns
        -------
        (6, 6) ndarray
            kg, kg m, kg m^2.
        """
        if self.inertia is None:
            return np.zeros((6, 6))
        moved = body.rigid_ports[self.rows(body)]
        return moved.T @ self.inertia @ moved

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
        """Refuse springs on motions that a body was built without: they would find it rigid
        there.
        """
        resisted = {int(row) % 6 for row in np.flatnonzero(self.stiffness.any(axis=1))}
        absent = resisted - {c for block in body.blocks for c in block.components}
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
        return replace(self, attachments=(attachment,) * len(self.ports))

    def on(self, components: Iterable[int]) -> Supports:
        """The same springs and masses on some components of the ports only; couplings to others are
        left out.

        Parameters
        ----------
        components : iterable of int
            Of x y z thx thy thz, by place.

        Returns
        -------
        Supports
        """
        keep = np.tile(np.isin(np.arange(6), list(components)), len(self.ports))
        both_kept = np.outer(keep, keep)
        inertia = None if self.inertia is None else np.where(both_kept, self.inertia, 0.0)
        return replace(self, stiffness=np.where(both_kept, self.stiffness, 0.0), inertia=inertia)

    def on_stations(self, stations: Iterable[Any], name: Callable[[Any], str] | None = None):
        """The same on ports as they are attached in a scene whose body carries several attachments.

        Parameters
        ----------
        stations : iterable of Port, Bearing or PointMass
        name : callable, optional
            Gives the name of a station's port in the body; by default its own.

        Returns
        -------
        Supports
        """
        by_name = {station.name: station for station in stations}
        carriers = [by_name[port] for port in self.ports]
        if name is not None:
            return replace(self, ports=tuple(map(name, carriers)))
        return replace(self, attachments=tuple(s.attachment for s in carriers))

    @cached_property
    def key(self) -> tuple:
        """Ports, attachments, springs and masses, by which they are told from others."""
        matrices = (self.stiffness, self.masses)
        return self.ports, self.attachments, *(matrix.tobytes() for matrix in matrices)

    def unresisted(self, body: Body) -> np.ndarray:
        """Rigid motions about the origin that no spring resists.

        Parameters
        ----------
        body : Body

        Returns
        -------
        (6, k) ndarray
            Orthonormal, with rotations times the length; motions that have nothing to do with one
            another in columns of their own.

        Raises
        ------
        SolidgearError
            If the body lacks a port.
        """
        return body.cache.get(_Unresisted, _Unresisted).on(self.key, lambda: self._motions(body))

    def _motions(self, body: Body) -> np.ndarray:
        """Compute the motions of :meth:`unresisted`."""
        size = np.array([1.0, 1.0, 1.0, 1 / body.length, 1 / body.length, 1 / body.length])
        if not self.ports:
            return np.eye(6) * size
        # Rank does not depend on how stiff a spring is: every row is brought to unit length first.
        a = self.root.T @ body.rigid_ports[self.rows(body)] * size
        norm = np.linalg.norm(a, axis=1, keepdims=True)
        a = a / np.where(norm > 0, norm, 1.0)
        _, s, vt = np.linalg.svd(a)
        rank = int((s > 1e-9).sum())
        return size[:, None] * separated(vt[rank:].T)


class _Unresisted(LastTwo[np.ndarray]):
    """Rigid motions of a body that no spring resists."""


def separated(basis: np.ndarray) -> np.ndarray:
    """Return another orthonormal basis (n, k) of the same space, in which motions that have nothing
    to do with one another share no column: a coordinate that lies in the space is a column of its
    own, and rounding mixed into it becomes an exact zero.
    """
    onto = basis @ basis.T
    onto[np.abs(onto) < 1e-9] = 0.0
    count, group = connected_components(sp.csr_array(onto != 0), directed=False)
    out = np.zeros(basis.shape)
    column = 0
    for number in range(count):
        rows = np.flatnonzero(group == number)
        if len(rows) == 1:
            inside = np.ones((1, int(onto[rows[0], rows[0]] > 0.5)))
        else:
            values, vectors = np.linalg.eigh(onto[np.ix_(rows, rows)])  # ones and zeros
            inside = np.where(np.abs(vectors) < 1e-9, 0.0, vectors)[:, values > 0.5]
        out[rows, column : column + inside.shape[1]] = inside
        column += inside.shape[1]
    return out


def as_supports(source: Holding) -> Supports:
    """Return the supports of a scene (housing and masses included), of bearings (neither), or
    supports as they are.

    A housing spring sits between ground and the axially rigid ring that carries all outer races:
    eliminating that ring leaves ``K - K e (e'K e + k)^-1 e'K`` with e the common axial motion. A
    housing that yields in other motions too is eliminated by :func:`solidgear.core.springs.in_series`.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> as_supports(scene).ports, as_supports(scene.bearings[:1]).ports
    (('A', 'B'), ('A',))
    """
    if isinstance(source, Supports):
        return source
    source = getattr(source, "settled", source)
    housing, around = (getattr(source, key, None) for key in ("housing_axial", "housing"))
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
    if around is not None:
        k = around.beneath(k, [b.y for b in bearings])
    names = tuple(b.name for b in bearings)
    masses = tuple(getattr(source, "masses", ()))
    return _with_masses(names, k, masses) if masses else Supports(names, k)


def masses_alone(scene: Scene) -> Supports:
    """Return the rigid masses of a scene on their ports, those of bearings among them, without
    springs.
    """
    return _with_masses((), np.zeros((0, 0)), scene.masses)


def _with_masses(names: tuple[str, ...], k: np.ndarray, masses: Iterable[PointMass]) -> Supports:
    """Return the springs of bearings, with masses on their ports and on further ones."""
    ports = tuple(dict.fromkeys((*names, *(mass.station for mass in masses))))
    stiffness, inertia = np.zeros((2, 6 * len(ports), 6 * len(ports)))
    stiffness[: len(k), : len(k)] = k
    for mass in masses:
        rows = 6 * ports.index(mass.station) + np.arange(6)
        inertia[np.ix_(rows, rows)] += mass.matrix
    return Supports(ports, stiffness, (), inertia)
