"""Lowest eigenpairs of a supported group of blocks: Lanczos by blocks or by single vectors, ARPACK or
dense, all checked the same way.

All rest on one factor of the free body; bearings come in by the Woodbury identity
(:class:`~solidgear.core.solve.supported.Supported`).
"""

from __future__ import annotations

import logging
from dataclasses import dataclass

import numpy as np
import scipy.linalg as sla
import scipy.sparse.linalg as spla

from solidgear.core.body import Block
from solidgear.core.errors import SolidgearError
from solidgear.core.machine.memory import NoRoom
from solidgear.core.solve.backends.matrix import FactorError
from solidgear.core.solve.factor import indefinite
from solidgear.core.solve.lanczos import block_lanczos
from solidgear.core.solve.refine import refine
from solidgear.core.solve.supported import Supported

log = logging.getLogger(__name__)

#: unknowns up to which LAPACK is quicker: 385 take it 27 ms and ARPACK 3
DENSE = 120
METHODS = ("lanczos", "arpack", "dense")
# SuperLU solves eight right-hand sides no faster than eight times one, nor does PARDISO where the
# factor stays in the cache, and one vector at a time needs fewer: measured 0.3 s against 0.6 s on a
# meridian, 1.5 s against 1.7 s for four halves of 4,000 to 5,000 unknowns; as many for 7,000.
SINGLE = ("superlu",)
CACHED = 6_000  # unknowns
WIDTH = 8
# Numbers that a basis may always have: thin layers have dozens of modes within a per cent, of which
# Lanczos finds eight with 344 vectors, and ARPACK left out one of two twins.
BASIS = 4_000_000
TOLERANCE = 1e-7  # of shapes; frequencies are good to its square


@dataclass(frozen=True)
class Raw:
    """One eigenpair before it has a name."""

    value: float  #: rad^2/s^2
    vectors: dict[int, np.ndarray]  #: block index -> (n,) vector
    #: relative, of the eigenvalue; see :class:`solidgear.core.solve.refine.Refined`
    residual: float
    error: float


@dataclass(frozen=True)
class Solved:
    """Eigenpairs of one group."""

    elastic: list[Raw]  #: in ascending order
    free: list[Raw]  #: rigid motions that nothing resists
    orthogonality: float  #: largest entry of ``U' M U - I``
    #: ``lanczos``, ``krylov-schur (SLEPc)``, ``arpack`` or ``dense``, with the reason where one
    #: stands in for another
    method: str
    steps: int = 0  #: corrections by :func:`solidgear.core.solve.refine.refine`


def lowest(supported: Supported, n: int, method: str | None = None) -> Solved:
    """Find elastic and rigid modes of blocks that belong together: `n`, and two more, so that a
    pair at the end of the list is not cut.

    Without a method Lanczos is taken, and LAPACK's dense solver where that is quicker. If Lanczos does
    not converge ARPACK takes over; SolidgearError if that does not, or if the method is unknown.
    """
    if method not in (None, *METHODS):
        raise SolidgearError(
            f"modes: method = {method!r} is unknown; use 'lanczos', 'arpack' or 'dense'"
        )
    total, rigid = supported.size, supported.free
    wanted = min(n + 2, total - rigid.shape[1])
    if wanted < 1:
        method, theta, u = "dense", np.zeros(0), np.zeros((total, 0))
    else:
        method = method or "lanczos"
        if total <= DENSE or wanted >= total - 2 - WIDTH:
            method = "dense"
        theta, u, method = {"dense": _dense, "arpack": _arpack, "lanczos": _lanczos}[method](
            supported, wanted
        )
    value = 1.0 / theta - supported.shift
    refined = refine(supported, u, value, n)
    u = refined.vectors
    orthogonality = float(np.abs(u.T @ supported.mass(u) - np.eye(len(theta))).max(initial=0.0))
    elastic = [
        Raw(float(v), supported.split(u[:, i]), float(refined.residual[i]), float(refined.error[i]))
        for i, v in enumerate(refined.value)
    ]
    free = [Raw(0.0, supported.split(rigid[:, i]), 0.0, 0.0) for i in range(rigid.shape[1])]
    return Solved(elastic, free, orthogonality, method, refined.steps)


def _without_twins(block: Block) -> bool:
    """Return whether symmetry puts no two equal modes into a block: twins of a half of a part lie
    in the other half.
    """
    moves = set(block.components)
    return block.planar or bool(moves) and not {0, 2} <= moves


def _dense(supported: Supported, wanted: int):
    heavy = supported.mass(np.eye(supported.size))
    try:
        root = np.linalg.cholesky(heavy)
    except np.linalg.LinAlgError:
        # unknowns without mass, such as the turns of a lumped beam without rotary inertia
        w, v = np.linalg.eigh((heavy + heavy.T) / 2)
        keep = w > 1e-14 * w[-1]
        root = v[:, keep] * np.sqrt(w[keep])
    moved = supported.inverse(root)
    small = root.T @ moved
    theta, w = np.linalg.eigh((small + small.T) / 2)
    theta, w = theta[::-1][:wanted], w[:, ::-1][:, :wanted]
    if root.shape[0] == root.shape[1]:
        return theta, sla.solve_triangular(root.T, w, lower=False), "dense"
    # no more modes than there are masses, less those of free rigid motions
    full = theta > 1e-14 * theta[0]
    return theta[full], moved @ (w[:, full] / theta[full]), "dense"


def _lanczos(supported: Supported, wanted: int):
    pairs = supported.on_ranks(wanted, TOLERANCE)
    if pairs is not None and len(pairs[0]) == wanted:
        return 1 / pairs[0], pairs[1], "krylov-schur (SLEPc)"
    return _block_lanczos(supported, wanted)


def _block_lanczos(supported: Supported, wanted: int):
    # One vector sees one of two equal modes only through rounding: it is for a group that holds no
    # twins.
    without_twins = len(supported.blocks) == 1 and _without_twins(supported.blocks[0])
    one_by_one = supported.backend in SINGLE or supported.size <= CACHED
    width = 1 if without_twins and one_by_one else WIDTH
    # Loads drawn at random excite every shape, whatever its symmetry. Static solutions under port
    # loads are no better a start (they needed one block more on a pinion of 93,000 unknowns) and
    # cannot see a mode that moves no port.
    start = supported.inverse(
        supported.mass(np.random.default_rng(0).standard_normal((supported.size, width)))
    )
    pairs = block_lanczos(
        supported.inverse,
        supported.mass,
        start,
        wanted,
        tolerance=TOLERANCE,
        most=max(160, 12 * wanted, min(640, BASIS // supported.size)),
    )
    if pairs.converged and len(pairs.theta) == wanted:
        return pairs.theta, pairs.vectors, "lanczos"
    log.warning("Lanczos did not converge within %d vectors; ARPACK takes over", pairs.columns)
    theta, u, _ = _arpack(supported, wanted)
    return theta, u, f"arpack (Lanczos did not converge within {pairs.columns} vectors)"


def _arpack(supported: Supported, wanted: int):
    total, shift = supported.size, supported.shift
    shape = (total, total)
    heavy = spla.LinearOperator(shape, matvec=supported.mass, dtype=float)
    try:
        value, u = spla.eigsh(
            heavy,  # only its shape is used in this mode
            k=wanted,
            M=heavy,
            sigma=-shift,
            OPinv=spla.LinearOperator(shape, matvec=supported.inverse, dtype=float),
            v0=supported.inverse(np.random.default_rng(0).standard_normal(total)),
            ncv=min(total - 1, max(2 * wanted + 6, 20)),
            # Tighter buys nothing: at 1e-12 frequencies are the same to 15 digits for half as many
            # solves again (30 against 21 on a pinion and a motor rotor).
            tol=TOLERANCE,
        )
    except spla.ArpackNoConvergence as error:
        raise SolidgearError(
            f"modes: ARPACK found only {len(error.eigenvalues)} of {wanted} modes; "
            "ask for fewer modes"
        ) from error
    theta = 1.0 / (value + shift)
    order = np.argsort(-theta)
    return theta[order], u[:, order], "arpack"


@dataclass(frozen=True)
class Count:
    """Number of eigenvalues below a bound, from the inertia of a factor that is independent of the
    eigensolver.
    """

    below: float  #: bound, rad^2/s^2
    computed: int  #: modes that the eigensolver gave below the bound
    existing: int  #: modes that exist below the bound
    backend: str
    distance: float  #: of the nearest eigenvalue from the bound, relative


def count_below(supported: Supported, solved: Solved, reach: float) -> Count | None:
    """Count by Sylvester's law of inertia how many modes lie below the first gap behind the highest
    eigenvalue that is used, rad^2/s^2.

    With bearings ``L L'`` kept outside the factor (Haynsworth's additivity on the bordered matrix),
    ``neg(K + L L' - mu M) = neg(K - mu M) - neg(I + L' (K - mu M)^-1 L)``. Masses ``J J'`` on ports
    are outside it too: with ``B = [L, J]`` and ``D = diag(I, -mu I)`` the same theorem gives
    ``neg(K + L L' - mu (M + J J')) = neg(K - mu M) + neg(-D^-1 - B' (K - mu M)^-1 B) - rank(L)``.

    None where the back end gives no inertia that can be trusted.
    """
    value = np.array([r.value for r in solved.elastic])
    if len(value) < 2:
        return None
    start = np.maximum(value[:-1], reach)
    clear = np.flatnonzero(value[1:] > 1.001 * start)
    # A factor of K - mu M is sound only at a distance from the spectrum, so a bound inside a
    # cluster is no use.
    place = int(clear[0]) if len(clear) else int(np.argmax(np.diff(np.log(value))))
    below = float((start[place] if len(clear) else value[place]) ** 0.6 * value[place + 1] ** 0.4)
    negative = 0
    springs, masses = supported.load.shape[1], supported.heavy.shape[1]
    load = np.hstack([supported.load, supported.heavy])
    inner = -np.diag(np.append(np.ones(springs), np.full(masses, -1 / below)))
    backends = set()
    for block, part in zip(supported.blocks, supported.parts(load)):
        try:
            factor = indefinite(
                (block.stiffness - below * block.mass).tocsr(),
                planar=block.planar,
                border=block.border,
            )
        except (
            FactorError,
            NoRoom,
        ):  # no room for a second factor, say: the result stands without the count
            factor = None
        if factor is None:
            return None
        negative += factor.negative
        backends.add(factor.backend)
        if load.shape[1]:
            inner = inner - part.T @ factor.solve(part)
    if load.shape[1]:
        # rows brought to one size: the rounding of one of 1e24 N/m has no sign that means anything
        size = 1 / np.sqrt(np.abs(np.diag(inner)))
        inner = (inner + inner.T) / 2 * np.outer(size, size)
        negative += int((np.linalg.eigvalsh(inner) < 0).sum()) - springs
    distance = float(np.abs(value / below - 1).min())
    return Count(
        below, place + 1 + len(solved.free), negative, "+".join(sorted(backends)), distance
    )
