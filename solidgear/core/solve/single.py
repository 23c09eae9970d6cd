"""Solutions in double precision from a factor that is good to three digits only.

A factor in single precision takes half the memory. It is a preconditioner: conjugate gradients on
the matrix itself (in the flexible form of Polak and Ribiere, since rounding makes the factor not
quite symmetric; Notay 2000, SIAM J. Sci. Comput. 22, 1444) shrink the error by a hundred or more
from step to step, until only the rounding of the product with the matrix is left. A factor in
double precision ends there too.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from solidgear.core.solve.backends.matrix import FactorError
from solidgear.core.solve.inertia_relief import Linear, columns, ratio

#: error of a factor in double precision in the energy norm on solids of 50,000 to 150,000 unknowns
#: (2e-12 to 6e-12)
ENOUGH = 5e-12
#: error allowed where rounding ends the steps earlier, as it does with a double factor
LEAST = 1e-7
#: more steps than a factor that is worth the name takes
MOST = 25


@dataclass
class Refining:
    """A rough inverse made exact: by ``A u`` in double precision and ``A^-1 f``, roughly.

    Examples
    --------
    >>> a = np.array([[4.0, 1.0], [1.0, 3.0]])
    >>> refining = Refining(a.__matmul__, lambda f: f / 4.0)
    >>> bool(np.allclose(a @ refining.solve(np.ones(2)), 1.0, atol=1e-10)), refining.steps > 0
    (True, True)
    """

    product: Linear
    rough: Linear
    steps: int = field(default=0, init=False)  #: most corrections that a solution took so far
    #: largest estimated relative error of a solution so far, in the energy norm
    left: float = field(default=0.0, init=False)

    def solve(self, rhs: np.ndarray) -> np.ndarray:
        """Solve for one (n,) or several (n, k) right-hand sides."""
        if rhs.ndim == 1:
            return self.solve(rhs[:, None])[:, 0]
        x, step = np.zeros(rhs.shape), np.zeros(rhs.shape)
        residual, before = np.array(rhs, float), np.zeros(rhs.shape)
        size = np.zeros(rhs.shape[1])
        energy, last = size, np.inf
        for count in range(MOST):
            z = self._scaled(residual)
            fresh = columns(z, residual)
            step = z + step * np.maximum(ratio(fresh - columns(z, before), size), 0.0)
            pull = self.product(step)
            along = ratio(columns(step, residual), columns(step, pull))
            gain = along * columns(step, residual)
            x += step * along
            before, residual, size = residual, residual - pull * along, fresh
            energy = energy + gain
            share = float(np.sqrt(ratio(np.abs(gain), energy).max(initial=0.0)))
            # errors of steps fall by a constant factor
            error_left = share if count == 0 else share * min(1.0, share / last)
            if error_left < ENOUGH or (count and share > 0.5 * last):
                break
            last = share
        if not error_left < LEAST:
            raise FactorError(
                "the factor in single precision is too far from the matrix: a correction is "
                f"{share:.0e} of the solution after {count + 1} steps; use precision = double, or a "
                "coarser mesh"
            )
        self.steps, self.left = max(self.steps, count), max(self.left, error_left)
        return x

    def _scaled(self, rhs: np.ndarray) -> np.ndarray:
        # residuals fall below what four bytes can hold
        size = np.abs(rhs).max(axis=0, initial=0.0)
        size = np.where(size > 0, size, 1.0)
        return np.asarray(self.rough(rhs / size), float) * size
