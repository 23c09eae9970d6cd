"""Solution verification: observed order, expected order and grid convergence index (GCI).

After Roache (1994), J. Fluids Eng. 116, 405, and ASME V&V 20-2009, sec. 2-4: three or more similar
meshes, safety factor 1.25 when the observed order is plausible, 3.0 with the expected order when it
is not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Convergence:
    """Verdict on a sequence of three results.

    Attributes
    ----------
    observed_order : float or None
        None when the sequence does not converge monotonically.
    plausible : bool
        Observed order between the expected one and ``highest``, with 30 per cent of slack below.
    used_order : float
        The order the error bar rests on.
    factor : float
        Safety factor used.
    gci : float
        Relative uncertainty of the finest value.
    extrapolated : float
        Richardson's extrapolation with the order that was used.
    """

    observed_order: float | None
    plausible: bool
    used_order: float
    factor: float
    gci: float
    extrapolated: float


def gci(
    values: Sequence[float],
    sizes: Sequence[float],
    expected: float,
    highest: float,
    cap: float = 2.0,
) -> Convergence:
    """Grid convergence index of the finest of three results.

    Parameters
    ----------
    values : sequence of three floats
        Coarse to fine.
    sizes : sequence of three floats
        Representative sizes, or 1 / order for a p-sequence, descending; only ratios matter.
    expected : float
        Order expected from the geometry on uniform meshes.
    highest : float
        Highest order the element can reach for this quantity.
    cap : float
        The order used is never above this one (nor the observed one).  Graded meshes converge faster than the uniform
        ones ``expected`` speaks of, but whole numbers of cells make them only roughly similar, and
        orders of 3 and more that come of it flatter the result: on the overhung pinion bars from
        uncapped orders missed the true error by up to a third, with 2 they hold it by a factor of about 2.

    Raises
    ------
    ValueError
        If there are not three results, or sizes do not descend.
    """
    if len(values) != 3 or len(sizes) != 3 or not sizes[0] > sizes[1] > sizes[2] > 0:
        raise ValueError(
            f"three results on ever finer meshes are needed, got values {list(values)} at sizes {list(sizes)}"
        )
    f1, f2, f3 = (float(v) for v in values)
    h1, h2, h3 = (float(s) for s in sizes)
    coarse, fine = f2 - f1, f3 - f2
    scale = abs(f3) or 1.0
    observed: float | None = None
    if abs(fine) <= 1e-13 * scale:
        # Nothing left to converge: the quantity is exact on these meshes.
        return Convergence(None, True, expected, 1.25, max(abs(coarse), abs(fine)) / scale, f3)
    if coarse * fine > 0:

        def gap(p):
            return (h1**p - h2**p) / (h2**p - h3**p) - coarse / fine

        if gap(1e-3) < 0 < gap(20.0):
            from scipy.optimize import brentq  # slow to import, and seldom needed

            observed = float(brentq(gap, 1e-3, 20.0))
    if observed is not None and 0.7 * expected <= observed <= highest + 0.5:
        plausible, order = True, min(observed, max(cap, expected))
    else:
        plausible, order = False, expected
    factor = 1.25 if plausible else 3.0
    # An oscillating or stalled pair says nothing about the size of the error: take the larger
    # change.
    change = abs(fine) if plausible else max(abs(fine), abs(coarse) if observed is None else 0.0)
    gain = (h2 / h3) ** order - 1
    bar = factor * change / scale / gain
    return Convergence(observed, plausible, float(order), factor, bar, f3 + fine / gain)
