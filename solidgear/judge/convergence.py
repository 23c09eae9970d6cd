"""Solution verification: observed order, expected order and grid convergence index (GCI).

After Roache (1994), J. Fluids Eng. 116, 405, and ASME V&V 20-2009, sec. 2-4: three or more similar
meshes, safety factor 1.25 when the observed order is plausible, 3.0 with the expected order when it
is not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

from solidgear.meshing.corners import corner_exponent, sharpest_corner

__all__ = ["Convergence", "corner_exponent", "gci", "sharpest_corner"]


@dataclass(frozen=True)
class Convergence:
    """Verdict on a sequence of three results.

    Attributes
    ----------
    values : tuple of float
        Coarse to fine.
    sizes : tuple of float
        Representative cell sizes, or 1 / order for a p-sequence; only ratios matter.
    observed_order : float or None
        None when the sequence does not converge monotonically.
    expected_order : float
        From the sharpest corner of the geometry.
    plausible : bool
        Observed order between the expected one and ``highest``, with 30 per cent of slack below.
    used_order : float
        The order the band rests on.
    factor : float
        Safety factor used.
    gci : float
        Relative uncertainty of the finest value.
    extrapolated : float
        Richardson's extrapolation with the order that was used.
    asymptotic : float or None
        ``GCI_coarse / (r^p GCI_fine)``; 1 in the asymptotic range.
    ratio : tuple of float
        Refinement ratios, coarse to fine.
    """

    values: tuple[float, ...]
    sizes: tuple[float, ...]
    observed_order: float | None
    expected_order: float
    plausible: bool
    used_order: float
    factor: float
    gci: float
    extrapolated: float
    asymptotic: float | None
    ratio: tuple[float, ...]

    def as_dict(self) -> dict:
        """Plain data for results.json."""
        return asdict(self)


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
        Representative sizes, descending.
    expected : float
        Order expected from the geometry on uniform meshes.
    highest : float
        Highest order the element can reach for this quantity.
    cap : float
        The order used is never above this one (nor the observed one).  Graded meshes converge faster than the uniform
        ones ``expected`` speaks of, but whole numbers of cells make them only roughly similar, and
        orders of 3 and more that come of it flatter the result: on the overhung pinion bands from
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
    r21, r32 = h1 / h2, h2 / h3
    coarse, fine = f2 - f1, f3 - f2
    scale = abs(f3) or 1.0
    observed: float | None = None
    if abs(fine) <= 1e-13 * scale:
        # Nothing left to converge: the quantity is exact on these meshes.
        band = max(abs(coarse), abs(fine)) / scale
        return Convergence(
            (f1, f2, f3),
            (h1, h2, h3),
            None,
            expected,
            True,
            expected,
            1.25,
            float(band),
            f3,
            None,
            (r21, r32),
        )
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
    band = factor * change / scale / (r32**order - 1)
    extrapolated = f3 + fine / (r32**order - 1)
    asymptotic = None
    if plausible:
        # Relative to the finest value, like the band itself: the middle one may pass through zero.
        coarse_band = factor * abs(coarse) / scale / (r21**order - 1)
        asymptotic = float(coarse_band / (r32**order * band))
    return Convergence(
        (f1, f2, f3),
        (h1, h2, h3),
        observed,
        expected,
        plausible,
        float(order),
        factor,
        float(band),
        float(extrapolated),
        asymptotic,
        (r21, r32),
    )
