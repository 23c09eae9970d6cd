r"""Fixed-interface reduction (Craig and Bampton 1968): constraint modes, and modes with ports held.

Constraint modes are the static shapes under motions of the ports.  They span the same as the rigid
motions R and the elastic fields E N of port loads that are in equilibrium, ``P'N = 0`` with P = G
R, and in those the stiffness needs no subtraction:

    V = [R, E N, Phi],      K -> diag(0, N'F N, Lambda),      F = G E,

Phi being the modes with all ports fixed (``G Phi = 0``, so that port loads do no work on them).
The mass is full and is diagonalised with K.

Fields Y left out (:mod:`solidgear.core.reduction.superelement`) move no port and are orthogonal to Phi,
hence ``cut`` is the first fixed-interface eigenvalue that is not in Phi.  With H0 the inverse of K
with fixed ports, ``Y Y' = H0 - Phi Lambda^-1 Phi'``, hence the defect is that of ``M R`` and ``M E
N``.

For the same number of coordinates the free-interface basis is the better one for shafts on
bearings, this one where neighbours hold the ports as fast as the part itself.

References: R. R. Craig and M. C. C. Bampton, AIAA Journal 6 (1968), 1313-1319.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as sla

from solidgear.core.body import Block, Body, Supports
from solidgear.core.errors import SolidgearError
from solidgear.core.machine.threads import pinned
from solidgear.core.reduction.moments import free_shapes, orthonormal
from solidgear.core.reduction.rubin import FINE, lowest_shapes
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
from solidgear.core.solve.inertia_relief import relieved_fields
from solidgear.core.solve.modes import modes
from solidgear.core.solve.shifted import factors

#: stiffness of the springs that hold ports fast in a first step, over that of the body there
FAST = 1e6
#: ports whose compliances, scaled to a unit diagonal, have a direction below this move together
TOGETHER = 1e-11


@pinned
def craig_bampton(body: Body, n: int = 30, ports: PortChoice | None = None) -> Superelement:
    """Reduce a body to its ports by constraint modes and fixed-interface modes.

    Parameters
    ----------
    body : Body
        Of any model.
    n : int
        Lowest modes with all chosen ports held fast to keep; twins count twice.
    ports : iterable of str or (str, str), optional
        Ports to keep, by name or as (name, attachment); all names by default, each with its first
        attachment.

    Returns
    -------
    Superelement
        Of ``6 * ports + n`` coordinates, or as many as the body has.

    Raises
    ------
    SolidgearError
        For a port the body does not have, no port at all, or ports that cannot move apart.

    Examples
    --------
    >>> import solidgear as sg
    >>> rod = sg.Segment.cylinder("rod", length=0.5, diameter=0.05)
    >>> body = sg.build(sg.Scene.from_parts([rod]), "euler")
    >>> sg.craig_bampton(body, n=8).size
    14
    """
    if n < 1:
        raise SolidgearError(f"craig_bampton: n = {n} is not a number of modes; ask for 1 or more")
    chosen = chosen_ports(body, ports)
    indices = list(chosen.values())
    if not indices:
        raise SolidgearError("craig_bampton: there is no port to hold fast; choose one or more")
    rows = np.concatenate([6 * p + np.arange(6) for p in indices])
    springs = np.diag(FAST / ease(body)[rows])
    attachments = tuple(body.ports[p].attachment for p in indices)
    supports = Supports(tuple(chosen), springs, attachments)
    fixed_modes = modes(body, supports, n=min(n + 1, body.size), ovalising=False)
    shapes, cut = lowest_shapes(fixed_modes, n)
    blocks: dict[int, ReducedMotions] = {}
    for index, block in enumerate(body.blocks):
        if not block.components:
            continue
        if block.mirror is not None:
            twin = blocks[block.mirror[0]]
            blocks[index] = reduced_motions(
                block, index, indices, twin.value, twin.shapes, twin.truncation
            )
            continue
        # The last of a coarse body are modes of the springs, not of the fixed body.
        most = block.size - len(indices) * len(block.components)
        fixed = [v[index] for v in shapes if index in v][: max(most, 0)]
        value, basis, truncation = _basis(
            body, block, factors(body)[index].solve, fixed, cut, indices
        )
        blocks[index] = reduced_motions(block, index, indices, value, basis, truncation)
    return assemble("craig_bampton", body, chosen, blocks.values())


def _basis(body: Body, block: Block, solve, fixed: list[np.ndarray], cut: float, ports: list[int]):
    """Return eigenvalues, mass-normalised shapes and truncation of one block."""
    g = block.ports[port_rows(block, ports)].toarray()
    free = free_shapes(block, [])
    r = free.shapes
    heavy = block.mass @ r

    def field(load):
        return relieved_fields(block, solve, load, FINE)[1]

    attachment = field(g.T)
    size = np.sqrt(ease(body)[body.rows(block)[port_rows(block, ports)]])
    port_loads = _PortLoads(g @ attachment, g @ r, size, [body.ports[p].name for p in ports])

    def still(loads):
        # H0: displacements by loads while the ports are held
        moved = field(loads)
        reaction, swing = port_loads.solve(-g @ moved, -r.T @ loads)
        return moved + attachment @ reaction + r @ swing

    # Springs still give a little: a step of inverse iteration on ports held for good.
    heavy_modes = block.mass @ (np.column_stack(fixed) if fixed else np.zeros((block.size, 0)))
    phi = still(heavy_modes)
    energy = heavy_modes.T @ phi
    balanced = attachment @ port_loads.balanced
    elastic = np.hstack([balanced, phi])
    stiffness = sla.block_diag(port_loads.stiffness, (energy + energy.T) / 2)
    carried = heavy.T @ elastic
    elastic = elastic - r @ carried
    mass = elastic.T @ (block.mass @ elastic)
    z = orthonormal(stiffness, len(stiffness))
    theta, turn = np.linalg.eigh(z.T @ mass @ z)
    turn = z @ (turn[:, ::-1] / np.sqrt(theta[::-1]))
    shapes = np.hstack([r, elastic @ turn])

    # Inertia forces of rigid motions and constraint modes, on the motions that fixed ports leave free.
    loads = np.hstack([heavy, block.mass @ balanced])
    by_modes = phi.T @ loads
    q = loads.T @ still(loads) - by_modes.T @ np.linalg.solve(energy, by_modes)
    transform = np.zeros((shapes.shape[1], loads.shape[1]))
    count = r.shape[1]
    transform[:count, :count] = np.eye(count)
    transform[count:, :count] = -(carried @ turn).T
    transform[count:, count:] = turn[: balanced.shape[1]].T
    defect = transform @ ((q + q.T) / 2) @ transform.T
    return np.r_[np.zeros(count), 1 / theta[::-1]], shapes, Truncation(cut, defect)


class _PortLoads:
    """Loads on the ports of a free block that give them a motion, ``F f + P a = motion`` and ``P'f =
    resultant``: loads f move the ports by the flexibility F (q, q), and the block swings by a along the
    rigid motions P (q, r) of the ports, which have equal size in units of `size` (q,).

    Attributes
    ----------
    balanced : (q, q - r) ndarray
        Loads N in equilibrium, orthonormal in units of the ports.
    stiffness : (q - r, q - r) ndarray
        ``N'F N``, the stiffness in the fields of these loads.
    """

    def __init__(self, flexibility, swing: np.ndarray, size: np.ndarray, names: list[str]):
        self._size = size
        scaled = flexibility / np.outer(size, size)
        self._swing = swing / size[:, None]
        u = np.linalg.svd(self._swing)[0]
        self._q = u[:, swing.shape[1] :]
        inner = self._q.T @ ((scaled + scaled.T) / 2) @ self._q
        least = np.linalg.eigvalsh(inner)[0] if len(inner) else 1.0
        if least < TOGETHER:
            raise SolidgearError(
                f"the ports {', '.join(names)} cannot all move independently; leave one out"
            )
        self._scaled, self._inner = scaled, sla.cho_factor(inner) if len(inner) else None
        self.balanced = self._q / size[:, None]
        self.stiffness = inner

    def solve(self, motion: np.ndarray, resultant: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Solve for f and a."""
        motion = motion / self._size[:, None]
        # f = f0 + N g with P'f0 = resultant, and N' of the first equation gives g.
        load = np.linalg.pinv(self._swing.T) @ resultant
        if self._inner is not None:
            residual = self._q.T @ (motion - self._scaled @ load)
            load = load + self._q @ sla.cho_solve(self._inner, residual)
        swing = np.linalg.lstsq(self._swing, motion - self._scaled @ load, rcond=None)[0]
        return load / self._size[:, None], swing
