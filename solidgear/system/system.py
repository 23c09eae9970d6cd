r"""Parts and links put together: modes, statics and forced response.

All links and elastic parts give strain rows, stacked to G with ``K = G'G``; masses add up to ``M = L L'``.  Natural frequencies are the
singular values of ``G L^-T``, which halves the digits lost between torsion at some ten Hz and bending at
some thousand.

Motions that strain nothing are rigid motions of the parts (the null space of their own rows), combined so that no link
is stretched.  They are looked for there alone, with every row brought to unit length, so that their number does not depend on how
stiff a spring is; the rest is solved on their complement.  A free rotation is an exact zero.

>>> import numpy as np
>>> from solidgear.system import Inertia, System, torsion_spring
>>> train = System(
...     {"motor": Inertia(2.0), "fan": Inertia(2.0)},
...     {"shaft": torsion_spring("motor", 400.0, "fan")},
... )
>>> modes = train.modes()
>>> [round(2 * np.pi * f, 9) for f in modes.frequency_hz]       # 0 and sqrt(400 / 1)
[0.0, 20.0]
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy.linalg as sla

from solidgear.errors import SolidgearError
from solidgear.machine.threads import pinned
from solidgear.reduction.superelement import PortMotion, Truncation, joined
from solidgear.system.bound import frequency_bound
from solidgear.system.links import Link
from solidgear.system.parts import Part

#: A row that moves rigid parts by less than this of what it moves at all is rounding.
ROUNDING = 1e-9
#: Entries of a unit vector below this are rounding, and no motion.
TINY = 1e-13
#: Work of a load on a free motion, relative to the largest it could do, that is rounding.
UNBALANCED = 1e-9


@dataclass(frozen=True, eq=False)
class SystemModes:
    """Undamped modes of a :class:`System`.

    Attributes
    ----------
    frequency_hz : (k,) ndarray
        Ascending; rigid motions are exactly 0.0.
    shapes : (N, k) ndarray
        On the coordinates of the system, mass-normalised.
    energy : dict of str to (k,) ndarray
        Fraction of each mode's strain energy in every elastic part and link; zero in rigid motions.
    error_bound : (k,) ndarray
        Largest relative error of each frequency that the reduction of parts leaves, proven
        (:mod:`solidgear.system.bound`); infinite where nothing can be promised.
    residual : float
        Largest ``|K u - w^2 M u|`` relative to ``|K| |u|``.
    """

    frequency_hz: np.ndarray
    shapes: np.ndarray
    energy: Mapping[str, np.ndarray]
    error_bound: np.ndarray
    residual: float

    @property
    def rigid(self) -> int:
        """Number of zero frequencies."""
        return int((self.frequency_hz == 0).sum())

    def dominant(self) -> list[str]:
        """Part or link with most of the strain energy of every mode, ``rigid`` where there is none."""
        names = list(self.energy)
        if not names:
            return ["rigid"] * len(self.frequency_hz)
        shares = np.array([self.energy[name] for name in names])
        most = shares.argmax(axis=0)
        return [names[i] if shares[i, k] > 0 else "rigid" for k, i in enumerate(most)]


@dataclass(frozen=True, eq=False)
class System:
    """Parts with ports, and links between ports of two parts or to ground.

    Attributes
    ----------
    parts : mapping of str to Part
        Names have no dot.
    links : mapping of str to Link
        Their ends are written ``part.port``; a part with one port may be named alone.

    Raises
    ------
    SolidgearError
        For a name twice, an end that is not there, or a mass that is not positive definite.
    """

    parts: Mapping[str, Part]
    links: Mapping[str, Link] = field(default_factory=dict)

    def __post_init__(self):
        if not self.parts:
            raise SolidgearError("a system needs at least one part")
        for name in self.parts:
            if not name or "." in name:
                raise SolidgearError(f"the part {name!r} needs a name without a dot")
            if name in self.links:
                raise SolidgearError(f"{name!r} names a part and a link; each needs its own name")
        for link in self.links.values():
            for end in link.ends:
                self._at(end)

    @cached_property
    def _places(self) -> dict[str, slice]:
        sizes = [np.shape(part.mass)[0] for part in self.parts.values()]
        cuts = np.cumsum([0, *sizes])
        return {n: slice(int(a), int(b)) for n, a, b in zip(self.parts, cuts, cuts[1:])}

    @property
    def size(self) -> int:
        """Number of coordinates N."""
        return max(place.stop for place in self._places.values())

    def place(self, part: str) -> slice:
        """Where the coordinates of a part are."""
        if part not in self._places:
            raise SolidgearError(f"there is no part {part!r}; there is {', '.join(self.parts)}")
        return self._places[part]

    def _at(self, end: str) -> tuple[str, PortMotion]:
        part, _, port = end.partition(".")
        self.place(part)
        ports = self.parts[part].ports
        if not port and len(ports) == 1:
            return part, next(iter(ports.values()))
        if port not in ports:
            raise SolidgearError(
                f"{end!r} is no port; {part} has {', '.join(f'{part}.{p}' for p in ports)}"
            )
        return part, ports[port]

    def port(self, end: str) -> PortMotion:
        """A port with its rows on the coordinates of the system.

        Parameters
        ----------
        end : str
            ``part.port``, or the name of a part with one port.

        Raises
        ------
        SolidgearError
            If there is no such port.
        """
        part, own = self._at(end)
        rows = np.zeros((6, self.size))
        rows[:, self.place(part)] = own.rows
        return PortMotion(rows, own.point, own.axes)

    def motion(self, end: str) -> np.ndarray:
        """(6, N) rows that give the motion of a port: times ``shapes``, a static answer or a
        response.
        """
        return self.port(end).rows

    def load(self, forces: Mapping[str, np.ndarray]) -> np.ndarray:
        """(N,) load on the coordinates from forces and moments (6,) at ports, in each port's axes."""
        return sum(
            (self.motion(e).T @ np.asarray(f) for e, f in forces.items()), np.zeros(self.size)
        )

    def expand(self, part: str, coordinates: np.ndarray) -> dict[int, np.ndarray]:
        """Unknowns of the body a part was made of, from coordinates (N,) or (N, k) of the system."""
        place = self.place(part)
        way = getattr(self.parts[part], "expand", None)
        if way is None:
            raise SolidgearError(
                f"the part {part!r} is no body on a mesh; there is nothing to expand"
            )
        return way(np.asarray(coordinates)[place])

    @cached_property
    def mass(self) -> np.ndarray:
        """(N, N)."""
        out = sla.block_diag(*(part.mass for part in self.parts.values()))
        for link in self.links.values():
            if hasattr(link, "mass"):
                out = out + link.mass(*map(self.port, link.ends))
        return out

    @cached_property
    def strains(self) -> tuple[np.ndarray, dict[str, slice]]:
        """G with ``K = G'G``, and which rows belong to which part or link."""
        blocks, where, start = [np.zeros((0, self.size))], {}, 0
        for name, part in self.parts.items():
            own = np.zeros((len(part.strain), self.size))
            own[:, self.place(name)] = part.strain
            blocks.append(own)
            where[name] = slice(start, start + len(own))
            start += len(own)
        for name, link in self.links.items():
            own = np.asarray(link.strain(*map(self.port, link.ends)), float)
            if own.ndim != 2 or own.shape[1] != self.size or not np.isfinite(own).all():
                raise SolidgearError(
                    f"the link {name!r} gives strain rows of shape {own.shape}; they must be finite "
                    f"and (r, {self.size})"
                )
            blocks.append(own)
            where[name] = slice(start, start + len(own))
            start += len(own)
        return np.vstack(blocks), {
            name: rows for name, rows in where.items() if rows.stop > rows.start
        }

    @property
    def stiffness(self) -> np.ndarray:
        """(N, N) ``G'G``."""
        return self.strains[0].T @ self.strains[0]

    @cached_property
    def truncation(self) -> Truncation:
        """What all reduced parts leave out."""
        every = []
        for name, part in self.parts.items():
            n = self.place(name).stop - self.place(name).start
            own = getattr(part, "truncation", None)
            every.append(Truncation(np.inf, np.zeros((n, n))) if own is None else own)
        return joined(every)

    @cached_property
    def _lower(self) -> np.ndarray:
        try:
            return np.linalg.cholesky(self.mass)
        except np.linalg.LinAlgError:
            raise SolidgearError(
                "the mass of the system is not positive definite; every part needs a mass in all its motions"
            ) from None

    @cached_property
    def free(self) -> np.ndarray:
        """(N, z) mass-normalised motions that strain nothing."""
        basis = []
        for part in self.parts.values():
            basis.append(_null(_unit(part.strain)))
        rigid = sla.block_diag(*basis)
        if not rigid.shape[1]:
            return rigid
        lower = np.linalg.cholesky(rigid.T @ self.mass @ rigid)
        rigid = sla.solve_triangular(lower, rigid.T, lower=True).T
        g, where = self.strains
        links = np.concatenate(
            [np.arange(len(g))[where[n]] for n in self.links if n in where] or [[]]
        )
        rows = g[links.astype(int)]
        whole = np.linalg.norm(sla.solve_triangular(self._lower, rows.T, lower=True), axis=0)
        rows = rows @ rigid
        rows[np.linalg.norm(rows, axis=1) < ROUNDING * whole] = 0.0
        return rigid @ _null(_unit(rows))

    @cached_property
    def _solved(self) -> tuple[np.ndarray, np.ndarray]:
        """All elastic frequencies, ascending, rad/s, and their shapes."""
        g, _ = self.strains
        lower = self._lower
        rows = sla.solve_triangular(lower, g.T, lower=True).T
        still = lower.T @ self.free
        held = np.linalg.qr(still, mode="complete")[0][:, still.shape[1] :]
        if not held.shape[1]:
            return np.zeros(0), np.zeros((self.size, 0))
        _, omega, turn = np.linalg.svd(rows @ held, full_matrices=False)
        shapes = sla.solve_triangular(lower.T, held @ turn.T, lower=False)
        return omega[::-1], shapes[:, ::-1]

    @pinned
    def modes(self, n: int | None = None) -> SystemModes:
        """Lowest modes.

        Parameters
        ----------
        n : int, optional
            Elastic modes wanted; rigid motions come on top, at 0 Hz.  Without it, as many as there are
            coordinates: the highest of reduced parts are no modes of their bodies, and their bound
            says so.

        Returns
        -------
        SystemModes
        """
        if n is not None and n < 1:
            raise SolidgearError(f"n = {n} is not a number of modes; ask for 1 or more")
        omega, elastic = self._solved
        count = len(omega) if n is None else min(n, len(omega))
        bound = frequency_bound(omega, elastic, self.truncation, count)
        zero = self.free.shape[1]
        shapes = self.signed(np.hstack([self.free, elastic[:, :count]]))
        omega = np.r_[np.zeros(zero), omega[:count]]
        return SystemModes(
            omega / (2 * np.pi),
            shapes,
            self._energy(shapes, omega),
            np.r_[np.zeros(zero), bound],
            self.residual(shapes, omega),
        )

    def signed(self, shapes: np.ndarray) -> np.ndarray:
        """Shapes with a sign that does not depend on the library: the largest component (in energy)
        is positive.
        """
        if not shapes.size:
            return shapes
        largest = np.argmax(np.abs(self._lower.T @ shapes), axis=0)
        return shapes * np.where(np.take_along_axis(shapes, largest[None, :], 0)[0] < 0, -1.0, 1.0)

    def residual(self, shapes: np.ndarray, omega: np.ndarray) -> float:
        """Largest ``|K u - w^2 M u|`` relative to ``|K| |u|``."""
        k = self.stiffness
        scale = (np.abs(k) @ np.abs(shapes)).max(axis=0, initial=0.0)
        miss = np.abs(k @ shapes - self.mass @ shapes * omega**2).max(axis=0, initial=0.0)
        # a rigid motion may touch no spring at all
        return float((miss / np.where(scale > 0, scale, 1.0)).max(initial=0.0))

    def _energy(self, shapes: np.ndarray, omega: np.ndarray) -> dict[str, np.ndarray]:
        g, where = self.strains
        stretch = (g @ shapes) ** 2
        stretch[:, omega == 0] = 0.0
        total = stretch.sum(axis=0)
        total = np.where(total > 0, total, 1.0)
        return {name: stretch[rows].sum(axis=0) / total for name, rows in where.items()}

    @pinned
    def static(self, load: np.ndarray) -> np.ndarray:
        """Displacements under constant loads, without free motions.

        Parameters
        ----------
        load : (N,) or (N, k) ndarray
            As from :meth:`load`.

        Returns
        -------
        (N,) or (N, k) ndarray

        Raises
        ------
        SolidgearError
            If a load works on a motion that nothing resists.
        """
        load = np.asarray(load, float)
        pushed = sla.solve_triangular(self._lower, load, lower=True)
        work = np.abs(self.free.T @ load).max(axis=0, initial=0.0)
        if np.any(work > UNBALANCED * np.linalg.norm(pushed, axis=0)):
            raise SolidgearError(
                "the load works on a motion that nothing resists; balance it, or hold the system"
            )
        omega, shapes = self._solved
        return shapes @ ((shapes.T @ load).T / omega**2).T

    @pinned
    def response(
        self,
        frequency_hz: np.ndarray,
        load: np.ndarray,
        *,
        damping: float = 0.0,
        loss: Mapping[str, float] | None = None,
    ) -> np.ndarray:
        """Steady motion under a load that oscillates.

        Parameters
        ----------
        frequency_hz : (f,) array_like
            Not negative.
        load : (N,) array_like
            Amplitudes, complex for phases; as from :meth:`load`.
        damping : float
            Damping ratio zeta of every elastic mode, taken as its loss factor 2 zeta: what viscous
            damping is at resonance (structural modal damping).
        loss : mapping of str to float
            Loss factor eta of parts and links: stiffness ``(1 + i eta) K`` of each.  Exact, not by
            shares of energy.

        Returns
        -------
        (f, N) complex ndarray
            Amplitudes q of ``q exp(i w t)``: ``response @ system.motion(end).T`` is what a port does.

        Notes
        -----
        Superposition of all modes of the system, so that statics is in it; with loss factors, of complex ones.

        Raises
        ------
        SolidgearError
            At 0 Hz if a free motion is driven; for an unknown name, or numbers that are not.
        """
        w2 = (2 * np.pi * np.asarray(frequency_hz, float)) ** 2
        given = dict(loss or {})
        for name, eta in {"damping": damping, **given}.items():
            if not (np.isfinite(eta) and eta >= 0):
                raise SolidgearError(f"{name} is {eta}; damping is finite and not negative")
        omega, elastic = self._solved
        shapes = np.hstack([self.free, elastic])
        zero = self.free.shape[1]
        value = np.r_[np.zeros(zero), omega**2] * (1 + 2j * damping)
        if given:
            value, turn = np.linalg.eig(np.diag(value) + self._losses(given, shapes))
            # Complex symmetric: modes are orthogonal without conjugation.
            turn = turn / np.sqrt(np.einsum("ij,ij->j", turn, turn))
            order = np.argsort(np.abs(value))
            value, shapes = value[order], shapes @ turn[:, order]
            value[:zero] = 0.0
        push = shapes.T @ np.asarray(load)
        if zero and np.any(w2 == 0):
            if np.abs(push[:zero]).max() > UNBALANCED * np.linalg.norm(push):
                raise SolidgearError(
                    "at 0 Hz the load drives a motion that nothing resists; leave 0 Hz out"
                )
            push[:zero] = 0.0
        gap = value[:, None] - w2[None, :]
        gap[:zero, w2 == 0] = 1.0
        return (shapes @ (push[:, None] / gap)).T

    def _losses(self, loss: Mapping[str, float], shapes: np.ndarray) -> np.ndarray:
        """``i sum eta_j K_j`` in modes; rigid ones strain nothing."""
        g, where = self.strains
        out = np.zeros((shapes.shape[1],) * 2, complex)
        for name, eta in loss.items():
            if name not in self.parts and name not in self.links:
                raise SolidgearError(f"a loss factor for {name!r}, which is no part and no link")
            if name in where:
                stretch = g[where[name]] @ shapes
                stretch[:, : self.free.shape[1]] = 0.0
                out += 1j * eta * (stretch.T @ stretch)
        return out


def _unit(rows: np.ndarray) -> np.ndarray:
    """Rows of unit length; those of no length stay."""
    size = np.linalg.norm(rows, axis=1, keepdims=True)
    return rows / np.where(size > 0, size, 1.0)


def _null(rows: np.ndarray) -> np.ndarray:
    """(n, z) orthonormal motions that no row feels; of unit rows."""
    _, s, vt = np.linalg.svd(rows)
    null = vt[int((s > ROUNDING).sum()) :].T
    return np.where(np.abs(null) < TINY, 0.0, null)
