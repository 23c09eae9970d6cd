"""Natural frequencies and mode shapes of a body on its bearings.

Symmetric shift-invert about a small negative shift, with the bearings added to the factor of
the free body by the Woodbury identity.  Rigid motions that no spring resists are
known exactly; they are projected out and reported as 0 Hz instead of as noise.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import scipy.linalg as sla
import scipy.sparse.linalg as spla

from solidgear.body import Body, as_supports, component_rows
from solidgear.errors import SolidgearError
from solidgear.solve.statics import SHIFT, factors
from solidgear.solve.supported import Supported, decoupled, groups

STATIONS = 13
DENSE = 400
FAMILIES = {"bending": (0, 2, 3, 5), "axial": (1,), "torsion": (4,)}


@dataclass(frozen=True)
class Mode:
    """One natural frequency with all its shapes.

    Attributes
    ----------
    name : str
        Such as ``bending 1``, ``axial 1``, ``rigid torsion``.
    family : str
    frequency_hz : float
    multiplicity : int
        2 for a degenerate pair.
    vectors : tuple of dict
        One per shape: block index -> (n,) vector, mass-normalised over all blocks.
    motions : (multiplicity, STATIONS, 6) ndarray
        Section motions along the axis (mass-weighted projection).
    captured : float
        Share of the modal mass that section motions describe; small for ovalising or local modes.
    """

    name: str
    family: str
    frequency_hz: float
    multiplicity: int
    vectors: tuple[dict[int, np.ndarray], ...]
    motions: np.ndarray
    captured: float


@dataclass(frozen=True)
class ModeSet:
    """Modes in ascending order of frequency, and the evidence for them.

    ``evidence`` holds ``residual`` (largest ``|A^-1 M u - theta u| / theta`` in the mass norm, brought back from the shifted to
    the true eigenvalue: a bound on its relative error), ``orthogonality`` (largest entry of ``U'MU - I``),
    ``rigid_modes``, ``shift_rad2``, ``coupling_bound`` and ``backend``.
    """

    fidelity: str
    modes: tuple[Mode, ...]
    stations: np.ndarray
    gram: np.ndarray
    evidence: dict = field(default_factory=dict)

    @property
    def frequency_hz(self) -> np.ndarray:
        """Distinct natural frequencies, Hz."""
        return np.array([m.frequency_hz for m in self.modes])

    @property
    def names(self) -> tuple[str, ...]:
        """Names in the order of ``frequency_hz``."""
        return tuple(m.name for m in self.modes)

    @property
    def multiplicity(self) -> tuple[int, ...]:
        """Number of shapes at each frequency."""
        return tuple(m.multiplicity for m in self.modes)

    def named(self, name: str) -> Mode | None:
        """The mode of that name, or None."""
        return next((m for m in self.modes if m.name == name), None)


@dataclass(frozen=True)
class _Raw:
    value: float
    vectors: dict[int, np.ndarray]
    residual: float


def modes(
    body: Body,
    supports=(),
    n: int = 10,
    *,
    max_frequency: float | None = None,
    coupling_tolerance: float = 1e-6,
) -> ModeSet:
    """Lowest modes of a supported body.

    Parameters
    ----------
    body : Body
    supports : Scene, Supports or iterable of bearings
    n : int
        Number of elastic shapes wanted; twins count twice and are never torn apart.
        Rigid motions come on top, at 0 Hz.
    max_frequency : float, optional
        Leave out modes above this frequency, Hz.
    coupling_tolerance : float
        Bearing terms that couple bending planes, axial motion and torsion are left out
        when they provably change no eigenvalue by more than this, relative; the bound is reported.

    Returns
    -------
    ModeSet

    Raises
    ------
    SolidgearError
        If ``n`` is not positive.
    """
    if n < 1:
        raise SolidgearError(f"modes: n = {n} is not a number of modes; ask for 1 or more")
    supports = as_supports(supports)
    spring, bound = decoupled(body, supports, coupling_tolerance)
    raw, rigid, orthogonality = [], [], 0.0
    done: list[tuple[list[int], list[_Raw], list[_Raw]]] = []
    for group in groups(body, supports, spring):
        twin = _twin_of(body, supports, spring, group, done)
        if twin is not None:
            elastic, free = ([_Raw(r.value, {group[0]: next(iter(r.vectors.values()))}, r.residual) for r in part] for part in twin)
        else:
            elastic, free, worst = _solve_group(Supported(body, supports, spring, group), n)
            orthogonality = max(orthogonality, worst)
        done.append((group, elastic, free))
        raw += elastic
        rigid += free
    raw.sort(key=lambda r: r.value)
    stations = np.linspace(0.0, body.length, STATIONS)
    project = _Projection(body, stations)
    found = _named(body, project, raw, rigid, n, max_frequency)
    evidence = {
        "residual": max((r.residual for r in raw[: n + 2]), default=0.0),
        "orthogonality": orthogonality,
        "rigid_modes": len(rigid),
        "shift_rad2": -SHIFT * body.scale,
        "coupling_bound": bound,
        "backend": "+".join(sorted({f.backend for f in factors(body)})),
    }
    return ModeSet(body.fidelity, found, stations, project.gram, evidence)


def _twin_of(body, supports, spring, group, done):
    """Earlier result that a lone mirrored block shares, if its springs are mirrored too."""
    block = body.blocks[group[0]]
    if len(group) != 1 or block.mirror is None:
        return None
    index, signs = block.mirror
    m = len(supports.ports)
    mine, theirs = (component_rows(range(m), b.components) for b in (block, body.blocks[index]))
    sign = np.tile(signs, m)
    a, b = spring[np.ix_(mine, mine)], spring[np.ix_(theirs, theirs)] * np.outer(sign, sign)
    if np.abs(a - b).max(initial=0.0) > 1e-14 * np.abs(b).max(initial=0.0):
        return None
    return next(((elastic, free) for other, elastic, free in done if other == [index]), None)


def _solve_group(supported: Supported, n: int):
    """Elastic and rigid modes of blocks that belong together."""
    total, shift = supported.size, supported.shift
    mass, operator = supported.mass, supported.inverse
    rigid = supported.free
    wanted = min(n + 2, total - rigid.shape[1])
    if wanted < 1:
        theta, u = np.zeros(0), np.zeros((total, 0))
    elif total <= DENSE or wanted >= total - 2:
        chol = np.linalg.cholesky(mass(np.eye(total)))
        small = chol.T @ operator(chol)
        theta, w = np.linalg.eigh((small + small.T) / 2)
        theta, w = theta[::-1][:wanted], w[:, ::-1][:, :wanted]
        u = sla.solve_triangular(chol.T, w, lower=False)
    else:
        shape = (total, total)
        heavy = spla.LinearOperator(shape, matvec=mass, dtype=float)
        theta, u = spla.eigsh(
            heavy,  # only its shape is used in this mode
            k=wanted,
            M=heavy,
            sigma=-shift,
            OPinv=spla.LinearOperator(shape, matvec=operator, dtype=float),
            v0=operator(np.random.default_rng(0).standard_normal(total)),
            ncv=min(total - 1, max(2 * wanted + 10, 30)),
            tol=1e-12,
        )
        # eigsh returns lambda = 1/theta + sigma
        theta = 1.0 / (theta + shift)
        order = np.argsort(-theta)
        theta, u = theta[order], u[:, order]
    value = 1.0 / theta - shift
    back = operator(mass(u)) - u * theta
    residual = np.sqrt(np.abs(np.einsum("ij,ij->j", back, mass(back)))) / np.where(theta > 0, theta, 1.0)
    # What the shift leaves of an eigenvalue below a thousandth of it is less than a direct Ritz step gives.
    soft = value < 1e-3 * shift
    whole = supported.rigid_motions()
    if soft.any() and whole.shape[1]:
        value[soft], u[:, soft] = _soft_modes(u[:, soft], supported.purge(whole), supported)
    residual = residual * np.where(soft, 1.0, 1.0 + shift / np.maximum(value, 1e-3 * shift))
    gram = u.T @ mass(u)
    orthogonality = float(np.abs(gram - np.eye(len(theta))).max(initial=0.0))
    elastic = [_Raw(float(t), supported.split(u[:, i]), float(residual[i])) for i, t in enumerate(value)]
    free = [_Raw(0.0, supported.split(rigid[:, i]), 0.0) for i in range(rigid.shape[1])]
    return elastic, free, orthogonality


def _soft_modes(u, rigid, supported: Supported):
    """Ritz values and vectors of nearly rigid modes in the span of the rigid motions and of what is elastic in them.

    Splitting the rigid part off exactly leaves no large stiffness to cancel: ``K`` sees the elastic remainder only.

    Parameters
    ----------
    u : (n, k) ndarray
        Mass-orthonormal shapes with inaccurate eigenvalues.
    rigid : (n, r) ndarray
        Rigid motions that springs resist, perhaps linearly dependent.
    supported : Supported
    """
    mass = supported.mass
    w, v = np.linalg.eigh(rigid.T @ mass(rigid))
    keep = w > 1e-10 * w.max()
    rigid = rigid @ (v[:, keep] / np.sqrt(w[keep]))
    rest = u - rigid @ (rigid.T @ mass(u))
    rest = rest - rigid @ (rigid.T @ mass(rest))
    w, v = np.linalg.eigh(rest.T @ mass(rest))
    keep = w > 1e-18  # a remainder below 1e-9 of the shape is rounding
    rest = rest @ (v[:, keep] / np.sqrt(w[keep]))
    basis = np.hstack([rigid, rest])
    small = np.zeros((basis.shape[1],) * 2)
    k = rigid.shape[1]
    small[k:, k:] = rest.T @ supported.elastic(rest)
    held = supported.load.T @ basis
    small = small + held.T @ held
    value, vector = np.linalg.eigh((small + small.T) / 2)
    count = u.shape[1]
    return value[:count], basis @ vector[:, :count]


class _Projection:
    """Mass-weighted projection of shapes onto section motions along the axis."""

    def __init__(self, body: Body, stations: np.ndarray):
        size = 6 * len(stations)
        self.body, self.count = body, len(stations)
        self.gram = np.zeros((size, size))
        self.parts = []
        for block in body.blocks:
            fields, columns = block.station_fields(stations) if block.components else (np.zeros((block.size, 0)), [])
            loaded = block.mass @ fields
            columns = np.asarray(columns, int)
            gram = fields.T @ loaded
            self.gram[np.ix_(columns, columns)] += gram
            self.parts.append((loaded, columns, np.linalg.pinv(gram, rcond=1e-12, hermitian=True)))

    def __call__(self, vectors: dict[int, np.ndarray]) -> np.ndarray:
        """(stations, 6) motions."""
        out = np.zeros(6 * self.count)
        for b, vector in vectors.items():
            loaded, columns, inverse = self.parts[b]
            out[columns] += inverse @ (loaded.T @ vector)
        return out.reshape(self.count, 6)

    def shares(self, motion: np.ndarray) -> dict[str, float]:
        """Modal mass described by each family of section motions."""
        out = {}
        for family, components in FAMILIES.items():
            at = np.array([6 * s + c for s in range(self.count) for c in components])
            part = motion.ravel()[at]
            out[family] = float(part @ self.gram[np.ix_(at, at)] @ part)
        return out


def _named(body, project, raw, rigid, n, max_frequency):
    """Group twins, name families, and cut the list without tearing a pair apart."""
    pair_tolerance = body.mesh.get("pair_tolerance", 1e-7)
    out: list[Mode] = []
    for r in rigid:
        motion = project(r.vectors)
        shares = project.shares(motion)
        family = max(shares, key=shares.get)
        if sum(s > 0.01 for s in shares.values()) > 1:
            name = "rigid (combined)"
        else:
            name = f"rigid {family}"
        out.append(Mode(name, family, 0.0, 1, (r.vectors,), motion[None], sum(shares.values())))
    count: dict[str, int] = {}
    taken, i = 0, 0
    described = []
    for r in raw:
        motion = project(r.vectors)
        shares = project.shares(motion)
        captured = sum(shares.values())
        block_names = {body.blocks[b].name for b in r.vectors}
        own = next(iter(block_names)) if len(block_names) == 1 else ""
        if own.startswith("ovalising"):
            family = own.replace("_", " n=")
        else:
            family = max(shares, key=shares.get) if captured > 0.3 else "local"
        described.append((r, family, motion, captured))
    while i < len(described) and taken < n:
        r, family, motion, captured = described[i]
        frequency = np.sqrt(max(r.value, 0.0)) / (2 * np.pi)
        if max_frequency is not None and frequency > max_frequency:
            break
        pair = [i]
        if i + 1 < len(described) and (family in ("bending", "local") or family.startswith("ovalising")):
            other, other_family = described[i + 1][0], described[i + 1][1]
            if other_family == family and other.value - r.value <= 2 * pair_tolerance * abs(r.value):
                pair.append(i + 1)
        members = [described[j] for j in pair]
        count[family] = count.get(family, 0) + 1
        mean = np.sqrt(np.mean([max(x[0].value, 0.0) for x in members])) / (2 * np.pi)
        # An n >= 2 block stands for its cosine and its sine form.
        double = 2 if family.startswith("ovalising") and len(pair) == 1 else len(pair)
        out.append(
            Mode(
                f"{family} {count[family]}",
                family,
                float(mean),
                double,
                tuple(x[0].vectors for x in members),
                np.array([x[2] for x in members]),
                float(min(x[3] for x in members)),
            )
        )
        taken += double
        i += len(pair)
    return tuple(out)
