r"""Free-interface reduction (Rubin 1975): rigid motions, free modes, residual fields of ports.

With U the rigid motions and the free modes below a cut, and H the inverse of K with U taken out,

    V = [U, W_0, .., W_J],      W_0 = H G',      W_(j+1) = H M W_j.

W_0 are the residual attachment fields: with them statics is exact.  W_1 is the first correction for
their inertia (a Krylov step).  U and W are orthogonal in K and in M, so only W needs to be turned
to its modes, and from the moments ``mu_j = G (H M)^j H G'`` alone: with ``W z`` orthonormal in
K,

    M -> z' [mu_(i+j+1)] z =: P,      M H M -> z' [mu_(i+j+2)] z =: Q.

Fields Y left out (:mod:`solidgear.core.reduction.superelement`) are orthogonal to U, hence ``cut`` is
the first free eigenvalue that is not in U; and ``Y Y' = H - W z z' W'``, hence the defect is ``Q -
P P`` on W and zero on U.

References: S. Rubin, AIAA Journal 13 (1975), 995-1006.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from solidgear.core.body import Block, Body
from solidgear.core.errors import SolidgearError
from solidgear.core.machine.threads import pinned
from solidgear.core.reduction.moments import (
    FreeShapes,
    free_shapes,
    residual_basis,
    residual_fields,
)
from solidgear.core.reduction.superelement import (
    PortChoice,
    ReducedMotions,
    Superelement,
    Truncation,
    assemble,
    chosen_ports,
    ease,
    port_rows,
    reduced_motions,
)
from solidgear.core.solve.factor import Factor
from solidgear.core.solve.inertia_relief import relieved_fields
from solidgear.core.solve.modes import ModeSet, modes
from solidgear.core.solve.shifted import factors

#: relative error of the energy of a field; displacements are good to its root
FINE = 1e-24
#: residual fields whose 1 / eigenvalue is below this share of the largest have negligible mass
MASSLESS = 1e-13
#: residual flexibility of a port, over its `ease`, that is rounding
NOTHING = 1e-15


@pinned
def rubin(body: Body, n: int = 30, ports: PortChoice | None = None, steps: int = 1) -> Superelement:
    """Reduce a body to its ports by free modes and residual attachment fields.

    Parameters
    ----------
    body : Body
        Of any model.
    n : int
        Lowest elastic modes of the free body to keep; twins count twice. With none statics is exact
        all the same, and frequencies are not bounded.
    ports : iterable of str or (str, str), optional
        Ports to keep, by name or as (name, attachment); all names by default, each with its first
        attachment.
    steps : int
        Krylov steps J on the residual fields.  Each adds up to six coordinates a port, and makes
        the error about a power of ``(frequency / cut)^2`` smaller twice; without modes there are none.

    Returns
    -------
    Superelement
        Motions that move no port (ovalising families of a harmonic solid) are not in it: no
        spring on a port acts on them.

    Raises
    ------
    SolidgearError
        For a port the body does not have, or unusable numbers.

    Examples
    --------
    >>> import solidgear as sg
    >>> part = sg.rubin(sg.build(sg.load("geometry/shaft_stepped.toml"), "timoshenko"), n=10)
    >>> part.kind, part.rigid
    ('rubin', 6)
    """
    if n < 0 or steps < 0:
        raise SolidgearError(f"rubin: n = {n} modes and {steps} steps; neither may be negative")
    chosen = chosen_ports(body, ports)
    shapes: list[dict[int, np.ndarray]] = []
    cut = 0.0
    if n == 0:
        steps = 0
    else:
        free_modes = modes(body, (), n=min(n + 1, body.size), ovalising=False)
        shapes, cut = lowest_shapes(free_modes, n)
    blocks: dict[int, ReducedMotions] = {}
    indices = list(chosen.values())
    for index, block in enumerate(body.blocks):
        if not block.components:
            continue
        if block.mirror is not None:
            # The same matrices, so the same shapes; only the port motions differ.
            twin = blocks[block.mirror[0]]
            blocks[index] = reduced_motions(
                block, index, indices, twin.value, twin.shapes, twin.truncation
            )
            continue
        free = free_shapes(block, [v[index] for v in shapes if index in v])
        block_rows = port_rows(block, indices)
        size, rows = ease(body)[body.rows(block)[block_rows]], block.ports[block_rows]
        factor = factors(body)[index]
        value, basis, truncation = residual_block(block, factor, free, cut, rows, size, steps)
        blocks[index] = reduced_motions(block, index, indices, value, basis, truncation)
    return assemble("rubin", body, chosen, blocks.values())


def lowest_shapes(mode_set: ModeSet, n: int) -> tuple[list[dict[int, np.ndarray]], float]:
    """Return the ``n`` lowest elastic shapes, twins never separated, and the eigenvalue (rad^2/s^2)
    below which there are no others; infinite where there are none at all.
    """
    elastic = [m for m in mode_set.modes if m.frequency_hz > 0]
    if sum(m.multiplicity for m in elastic) <= n:
        return [v for m in elastic for v in m.vectors], np.inf
    # Twins have their mean frequency, which the lower one undercuts by less than this.
    cut = (2 * np.pi * elastic[-1].frequency_hz) ** 2 * (1 - 1e-6)
    return [v for m in elastic[:-1] for v in m.vectors], cut


def residual_block(
    block: Block,
    factor: Factor,
    free: FreeShapes,
    cut: float,
    rows: sp.csr_matrix,
    size: np.ndarray,
    steps: int,
) -> tuple[np.ndarray, np.ndarray, Truncation]:
    """Return eigenvalues, mass-normalised shapes and truncation of one block, from free modes,
    below an eigenvalue ``cut`` (rad^2/s^2) under which there are no others, and so many Krylov
    steps on the fields of the rows (q, n) that springs may act on; ``size`` (q,) are flexibilities
    beside which one is rounding.
    """
    u, value = free.shapes, free.value
    if u.shape[1] >= block.size or np.isinf(cut):
        return value, u, Truncation(np.inf, np.zeros((len(value),) * 2))
    heavy = block.mass @ u

    def inverse(load):
        # Displacements by inertia relief, less their part in U; a load that drives none of U needs
        # half as many corrections of the shifted factor.
        load = load - heavy @ (u.T @ load)
        _, field, _ = relieved_fields(block, factor.solve, load, FINE)
        return field - u @ (heavy.T @ field)

    moments, fields = residual_fields(inverse, block.mass, rows, steps)
    mu = np.array(moments)
    # The residual of the mean motion of a seat as long as the shaft is rounding.
    flexible = np.diag(mu[0]) > NOTHING * size
    z, mass, beyond = residual_basis(mu[:, flexible][:, :, flexible])
    theta, turn = np.linalg.eigh(mass)
    massive = theta > MASSLESS * theta.max(initial=0.0)
    theta, turn = theta[massive][::-1], turn[:, massive][:, ::-1] / np.sqrt(theta[massive][::-1])
    residual = np.hstack([w[:, flexible] for w in fields]) @ (z @ turn)
    defect = np.zeros((u.shape[1] + len(theta),) * 2)
    defect[u.shape[1] :, u.shape[1] :] = turn.T @ (beyond - mass @ mass) @ turn
    return np.concatenate([value, 1 / theta]), np.hstack([u, residual]), Truncation(cut, defect)
