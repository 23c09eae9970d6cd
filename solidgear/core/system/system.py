"""Parts and links put together: modes, statics and forced response.

All links and elastic parts give strain rows, stacked to G with ``K = G'G``; masses add up to ``M =
L L'``.  Natural frequencies are the singular values of ``G L^-T``, which halves the digits lost
between torsion at some ten Hz and bending at some thousand; Jacobi's method loses none to springs
of very different stiffness.

Motions that strain nothing are rigid motions of the parts (the null space of their own rows),
combined so that no link is stretched.  They are looked for there alone, with every row brought to
unit length, so that their number does not depend on how stiff a spring is; the rest is solved on
their complement.  A free rotation is an exact zero.

>>> import numpy as np
>>> from solidgear.core.system import Inertia, System, torsion_spring
>>> train = System(
...     {"motor": Inertia(2.0), "fan": Inertia(2.0)},
...     {"shaft": torsion_spring("motor", 400.0, "fan")},
... )
>>> modes = train.modes()
>>> [round(2 * np.pi * float(f), 9) for f in modes.frequency_hz]   # 0 and sqrt(400 / 1)
[0.0, 20.0]

Bound between the frequencies of a system of reduced parts and those of the bodies themselves.

Every Ritz frequency is too high. By how much at most follows from the known properties of the
fields Y that the parts leave out (:mod:`solidgear.core.reduction.superelement`): y moves no port,
whatever holds the parts, and ``y'My <= y'By / cut``. With ``theta = 1 / w^2``, in a B-orthonormal
basis of Ritz vectors X and of Y the problem ``B^-1 M`` reads

    [[T, E'], [E, C]],      T = diag(theta~),      C <= 1 / cut,      E'E = X'M Y Y' M X,

and the last is the ``defect`` of the parts: further masses at ports do not move with Y. Eigenvalues
above 1/cut are those of ``T + E' (theta - C)^-1 E``, counted alike (Schur complement), and this is
at most ``T + E'E / (t - 1/cut)`` for ``1/cut < t <= theta``. So the k-th true theta lies between
theta~_k and the k-th eigenvalue of that matrix with t = theta~_k: an error of second order, without
any assumption on gaps, for single and repeated frequencies, and no mode can be missed. Zero
frequencies are exact and take no part.

The bound is one in exact arithmetic, on the error of reduction: not on that of a mesh.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy.linalg as sla
from numpy.typing import ArrayLike

from solidgear.core.errors import SolidgearError
from solidgear.core.machine.threads import pinned
from solidgear.core.reduction.superelement import PortMotion, Truncation
from solidgear.core.system.links import Link
from solidgear.core.system.modes import TINY, SystemModes, relative_residual, singular
from solidgear.core.system.parts import Part
from solidgear.core.system.steady import UNBALANCED, SteadyState

#: A row that moves rigid parts by less than this share of all its motion is rounding.
ROUNDING = 1e-9


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

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> shaft = sg.rubin(sg.build(scene, "timoshenko"))
    >>> system = sg.System({"shaft": shaft}, sg.grounded("shaft", scene))
    >>> first = sg.modes(sg.build(scene, "timoshenko"), scene, 4).named("bending 1").frequency_hz
    >>> bool(min(abs(system.modes(6).frequency_hz / first - 1)) < 1e-8)
    True
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
        """Return the range of the coordinates of a part."""
        if part not in self._places:
            ends = [f"{name}.{part}" for name, body in self.parts.items() if part in body.ports]
            meant = f"; did you mean {' or '.join(ends)}?" if ends else "; there is "
            names = "" if ends else ", ".join(self.parts)
            raise SolidgearError(f"there is no part {part!r}{meant}{names}")
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
        """Return a port with rows on the coordinates of the system.

        Parameters
        ----------
        end : str
            ``part.port``, or the name of a part with one port.

        Raises
        ------
        SolidgearError
            If there is no such port.
        """
        part, port = self._at(end)
        rows = np.zeros((6, self.size))
        rows[:, self.place(part)] = port.rows
        return PortMotion(rows, port.point, port.axes)

    def motion(self, end: str) -> np.ndarray:
        """Return (6, N) rows that give the motion of a port: times ``shapes``, a static answer or a
        response.
        """
        return self.port(end).rows

    def load(self, forces: Mapping[str, np.ndarray]) -> np.ndarray:
        """Return (N,) load on the coordinates from forces and moments (6,) at ports, in their own
        axes.
        """
        return sum(
            (self.motion(e).T @ np.asarray(f) for e, f in forces.items()), np.zeros(self.size)
        )

    def expand(self, part: str, coordinates: np.ndarray) -> dict[int, np.ndarray]:
        """Return unknowns of the body a part was made of, block by block, from coordinates (N,) or
        (N, k) of the system.
        """
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
        out = np.zeros((self.size, self.size))
        for name, part in self.parts.items():
            out[self.place(name), self.place(name)] = part.mass
        for link in self.links.values():
            if hasattr(link, "mass"):
                out = out + link.mass(*map(self.port, link.ends))
        return out

    @cached_property
    def strains(self) -> tuple[np.ndarray, dict[str, slice]]:
        """G with ``K = G'G``, and which rows belong to which part or link."""
        by_name: dict[str, np.ndarray] = {}
        for name, part in self.parts.items():
            if len(part.strain):
                by_name[name] = np.zeros((len(part.strain), self.size))
                by_name[name][:, self.place(name)] = part.strain
        for name, link in self.links.items():
            rows = np.asarray(link.strain(*map(self.port, link.ends)), float)
            if rows.ndim != 2 or rows.shape[1] != self.size or not np.isfinite(rows).all():
                raise SolidgearError(
                    f"the link {name!r} gives strain rows of shape {rows.shape}; "
                    f"they must be finite and (r, {self.size})"
                )
            by_name[name] = rows
        cuts = np.cumsum([0] + [len(rows) for rows in by_name.values()])
        places = {name: slice(int(a), int(b)) for name, a, b in zip(by_name, cuts, cuts[1:])}
        return np.vstack([np.zeros((0, self.size)), *by_name.values()]), places

    @property
    def stiffness(self) -> np.ndarray:
        """(N, N) ``G'G``."""
        return self.strains[0].T @ self.strains[0]

    @cached_property
    def truncation(self) -> Truncation:
        """Truncation of all reduced parts."""
        cut, defect = np.inf, np.zeros((self.size, self.size))
        for name, part in self.parts.items():
            truncation = getattr(part, "truncation", None)
            if truncation is not None:
                cut = min(cut, truncation.cut)
                defect[self.place(name), self.place(name)] = truncation.defect
        return Truncation(cut, defect)

    @cached_property
    def _lower(self) -> np.ndarray:
        try:
            return np.linalg.cholesky(self.mass)
        except np.linalg.LinAlgError:
            raise SolidgearError(
                "the mass of the system is not positive definite; "
                "every part needs a mass in all its motions"
            ) from None

    @cached_property
    def free(self) -> np.ndarray:
        """(N, z) mass-normalised motions that strain nothing."""
        basis = [np.zeros((self.size, 0))]
        for name, part in self.parts.items():
            motions = (
                _null_space(_unit_rows(part.strain))
                if len(part.strain)
                else np.eye(part.mass.shape[0])
            )
            basis.append(np.zeros((self.size, motions.shape[1])))
            basis[-1][self.place(name)] = motions
        rigid = np.hstack(basis)
        if not rigid.shape[1]:
            return rigid
        lower = np.linalg.cholesky(rigid.T @ self.mass @ rigid)
        rigid = sla.solve_triangular(lower, rigid.T, lower=True).T
        g, rows_of = self.strains
        rows = np.vstack([np.zeros((0, self.size)), *(g[rows_of[name]] for name in self.links)])
        sizes = np.linalg.norm(sla.solve_triangular(self._lower, rows.T, lower=True), axis=0)
        rows = rows @ rigid
        rows[np.linalg.norm(rows, axis=1) < ROUNDING * sizes] = 0.0
        return rigid @ _null_space(_unit_rows(rows))

    @cached_property
    def elastic(self) -> tuple[np.ndarray, np.ndarray]:
        """All elastic frequencies (m,), ascending, rad/s, and shapes (N, m), mass-normalised."""
        g, _ = self.strains
        lower = self._lower
        rows = sla.solve_triangular(lower, g.T, lower=True).T
        still = lower.T @ self.free
        complement = np.linalg.qr(still, mode="complete")[0][:, still.shape[1] :]
        if not complement.shape[1]:
            return np.zeros(0), np.zeros((self.size, 0))
        omega, turn = singular(rows @ complement)
        shapes = sla.solve_triangular(lower.T, complement @ turn.T, lower=False)
        return omega[::-1], shapes[:, ::-1]

    @pinned
    def modes(self, n: int | None = None, *, bounded: int | None = None) -> SystemModes:
        """Return the lowest modes.

        Parameters
        ----------
        n : int, optional
            Elastic modes wanted; rigid motions come on top, at 0 Hz.  Without it, as many as there
            are coordinates: the highest of reduced parts are no modes of their bodies, and their
            bound says so.
        bounded : int, optional
            So many of them get their bound, all by default; of the others nothing is promised.

        Returns
        -------
        SystemModes
        """
        if n is not None and n < 1:
            raise SolidgearError(f"n = {n} is not a number of modes; ask for 1 or more")
        omega, elastic = self.elastic
        count = len(omega) if n is None else min(n, len(omega))
        bound = np.full(count, np.inf)
        sure = count if bounded is None else min(bounded, count)
        bound[:sure] = frequency_bound(omega, elastic, self.truncation, sure)
        zero = self.free.shape[1]
        shapes = self.signed(np.hstack([self.free, elastic[:, :count]]))
        omega = np.r_[np.zeros(zero), omega[:count]]
        return SystemModes(
            omega / (2 * np.pi),
            shapes,
            self._energy(shapes, omega),
            np.r_[np.zeros(zero), bound],
            relative_residual(self.stiffness, self.mass, shapes, omega),
        )

    def signed(self, shapes: np.ndarray) -> np.ndarray:
        """Return shapes with a sign that does not depend on the library: the largest component (in
        energy) is positive.
        """
        if not shapes.size:
            return shapes
        largest = np.argmax(np.abs(self._lower.T @ shapes), axis=0)
        return shapes * np.where(np.take_along_axis(shapes, largest[None, :], 0)[0] < 0, -1.0, 1.0)

    def _energy(self, shapes: np.ndarray, omega: np.ndarray) -> dict[str, np.ndarray]:
        g, rows_of = self.strains
        stretch = (g @ shapes) ** 2
        stretch[:, omega == 0] = 0.0
        total = stretch.sum(axis=0)
        total = np.where(total > 0, total, 1.0)
        return {name: stretch[rows].sum(axis=0) / total for name, rows in rows_of.items()}

    @pinned
    def static(self, load: np.ndarray) -> np.ndarray:
        """Return displacements under constant loads, without free motions.

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
        omega, shapes = self.elastic

        def solved(loads: np.ndarray) -> np.ndarray:
            return shapes @ ((shapes.T @ loads).T / omega**2).T

        g, _ = self.strains
        moved = solved(load)
        # of held seats, millions of times stiffer than the rest, the digits that carry their forces
        return moved + solved(load - g.T @ (g @ moved))

    @pinned
    def response(
        self,
        frequency_hz: ArrayLike,
        load: np.ndarray,
        *,
        damping: float = 0.0,
        loss: Mapping[str, float] | None = None,
    ) -> np.ndarray:
        """Return the steady motion of all coordinates under a load that oscillates, with structural
        damping.

        A damping ratio zeta counts as loss factor 2 zeta of all parts and links, as
        viscous damping is at resonance; see :class:`solidgear.core.system.steady.SteadyState` for other
        losses, and for few motions of many coordinates.

        Parameters
        ----------
        frequency_hz : (f,) array_like
            Not negative.
        load : (N,) array_like
            Amplitudes, complex for phases; as from :meth:`load`.
        damping : float
            Damping ratio zeta of every elastic mode.
        loss : mapping of str to float
            Loss factor eta of parts and links.

        Returns
        -------
        (f, N) complex ndarray
            Amplitudes q of ``q exp(i w t)``: times ``system.motion(end).T`` the motion of a port.

        Raises
        ------
        SolidgearError
            At 0 Hz if a free motion is driven, on a resonance without damping, for an unknown name,
            or numbers that are not.

        Examples
        --------
        >>> from solidgear.core.system import Inertia, System, torsion_spring
        >>> fan = System({"fan": Inertia(2.0)}, {"shaft": torsion_spring("fan", 400.0)})
        >>> push = fan.load({"fan": [0, 0, 0, 0, 1, 0]})
        >>> still = fan.response([0.0], push, loss={"shaft": 0.75})
        >>> round(float(abs(still[0, 0])) * 400, 12)  # 1 / |1 + 0.75 i|
        0.8
        """
        if not (np.isfinite(damping) and damping >= 0):
            raise SolidgearError(f"damping is {damping}; damping is finite and not negative")
        losses = dict.fromkeys(self.strains[1], 2 * damping)
        losses |= {name: losses.get(name, 0.0) + eta for name, eta in (loss or {}).items()}
        return SteadyState(self, losses).motion(
            np.asarray(frequency_hz, float), load, np.eye(self.size)
        )


def _unit_rows(rows: np.ndarray) -> np.ndarray:
    """Return rows scaled to unit length; those of no length stay."""
    size = np.linalg.norm(rows, axis=1, keepdims=True)
    return rows / np.where(size > 0, size, 1.0)


def _null_space(rows: np.ndarray) -> np.ndarray:
    """Return orthonormal motions (n, z) that no unit row feels."""
    _, s, vt = np.linalg.svd(rows)
    null = vt[int((s > ROUNDING).sum()) :].T
    return np.where(np.abs(null) < TINY, 0.0, null)


def frequency_bound(
    omega: np.ndarray, shapes: np.ndarray, truncation: Truncation, n: int
) -> np.ndarray:
    """Return the largest relative error (n,) of the n lowest elastic frequencies, from all Ritz
    frequencies (m,), ascending, rad/s, and mass-normalised shapes (N, m); zero where nothing was
    left out, infinite where nothing is proven.
    """
    if np.isinf(truncation.cut):
        return np.zeros(n)
    if truncation.cut == 0:
        return np.full(n, np.inf)
    theta, limit = 1 / omega**2, 1 / truncation.cut
    weighted = shapes / omega
    excess = weighted.T @ truncation.defect @ weighted
    out = np.full(n, np.inf)
    for k in range(n):
        if theta[k] <= limit:
            break
        above = np.linalg.eigvalsh(np.diag(theta) + excess / (theta[k] - limit))
        out[k] = max(0.0, np.sqrt(above[-1 - k] / theta[k]) - 1)
    return out


def port_forces(system: System, coordinates: np.ndarray) -> dict[str, np.ndarray]:
    """Return the forces (6,) of all links on each port, ``part.port``, N and N m, in the axes and
    at the point of the port, from coordinates (N,) of the system.

    Examples
    --------
    >>> import numpy as np
    >>> from solidgear.core.system import Inertia, System, torsion_spring
    >>> pair = System({"a": Inertia(1.0), "b": Inertia(1.0)}, {"s": torsion_spring("a", 50.0, "b")})
    >>> forces = port_forces(pair, np.array([0.1, 0.0]))
    >>> round(float(forces["a"][4]), 9), round(float(forces["b"][4]), 9)
    (-5.0, 5.0)
    """
    out: dict[str, np.ndarray] = {}
    for link in system.links.values():
        ends = [system.port(end) for end in link.ends]
        size = 6 * len(ends)
        unit = np.split(np.eye(size), len(ends)) if ends else []
        alone = [PortMotion(rows, end.point, end.axes) for rows, end in zip(unit, ends)]
        rows = np.asarray(link.strain(*alone), float).reshape(-1, size)
        moved = np.concatenate([end.rows @ coordinates for end in ends])
        forces = -rows.T @ (rows @ moved)
        for name, force in zip(link.ends, np.split(forces, len(ends))):
            out[name] = out.get(name, np.zeros(6)) + force
    return out
