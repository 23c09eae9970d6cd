"""Gates every volume mesh passes before it is worth a factorisation.

A curved element can be inverted between any points one cares to sample, and a mesh can lose a
sliver of its volume without any solver complaining. So the Jacobian determinant, a polynomial, is
bounded from below over the whole element, and the volume is held against the closed form of the
shaft.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import product
from math import factorial
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.errors import SolidgearError

if TYPE_CHECKING:
    from skfem import Mesh

# Elements in which det J is bounded from below by this part of its greatest value need no closer
# look.
_CLEAR = 0.1
# The least det J of the others is found to this part of the greatest; each cut makes the bound four
# times tighter.
_TOLERANCE, _CUTS = 1e-3, 6
_BATCH = 4000  # elements looked at at once


class MeshError(SolidgearError):
    """A mesh that cannot be made, or must not be used; the message names the element and the
    remedy.
    """


@dataclass(frozen=True)
class MeshQuality:
    """Measures of a mesh."""

    #: n_elements, n_vertices: elements, and their corner nodes (mid nodes are not counted)
    n_elements: int
    n_vertices: int
    #: volume of the elements with their curved faces, exact for the geometry of the mesh [m^3]
    volume: float
    #: min_det_j, max_det_j: extremes of the Jacobian determinant over all elements [m^3]
    min_det_j: float
    max_det_j: float
    #: smallest (min det J) / (max det J) inside one element: 1 is an affine element, 0 or less a
    #: folded one
    min_ratio: float
    #: smallest element volume over the mean one; grading lowers it rightly (size ratio cubed), a
    #: sliver wrongly
    min_volume_ratio: float
    #: error of the moments of a part of it, relative, which no estimate on the mesh sees: the most
    #: that a part has lost and the most that one has gained
    geometry: float = 0.0


def check_mesh(
    mesh: Mesh, *, volume: float | None = None, rtol: float = 1e-3, min_ratio: float = 1e-3
) -> MeshQuality:
    """Measure a volume mesh and refuse it when an element is inverted or the volume is wrong.

    Parameters
    ----------
    mesh : skfem.MeshTet1, MeshTet2, MeshHex1 or MeshHex2
        Right-handed. scikit-fem itself integrates with |det J|, and its `init_tensor` meshes are
        left-handed.
    volume : float, optional
        Volume the mesh should have [m^3], see :func:`solidgear.core.scene.closed_form.volume_of`; None
        skips the comparison.
    rtol : float
        Relative mismatch of volume that is still accepted.
    min_ratio : float
        Least accepted (min det J) / (max det J) inside an element.

    Raises
    ------
    MeshError
        Inverted or nearly folded elements, a volume off by more than `rtol`, or not a volume mesh.

    Examples
    --------
    >>> from skfem import MeshTet1
    >>> corner = MeshTet1(np.eye(3, 4, 1), np.arange(4)[:, None])  # of the unit cube
    >>> round(check_mesh(corner).volume, 6)
    0.166667
    """
    quality, low, high, ratio = _measure(mesh)
    # written so that a NaN coordinate counts as bad
    cure = (
        "move the mid-edge nodes back between their corners or order the corners right-handed, "
        "or mesh finer where the surface curves"
    )
    if (high < 0.0).all():
        cure = (
            "the whole mesh is left-handed, so exchange two local axes of the elements "
            "or mirror the coordinates"
        )
    _refuse(mesh, ~(low > 0.0), low, "inverted", "det J", "m^3", cure)
    _refuse(
        mesh,
        ~(ratio >= min_ratio),
        ratio,
        "nearly folded",
        "min/max det J",
        f"(limit {min_ratio:g})",
        "mesh finer where the surface curves, or straighten the edges of these elements",
    )
    if volume is not None and not abs(quality.volume - volume) <= rtol * abs(volume):
        raise MeshError(
            f"the mesh has volume {quality.volume:.9g} m^3 instead of {volume:.9g} m^3 "
            f"({quality.volume / volume - 1.0:+.2e}, limit {rtol:g}): mesh finer around the "
            "circumference, use second-order curved elements, or look for a missing part"
        )
    return quality


def element_ratios(mesh: Mesh) -> np.ndarray:
    """Return (min det J) / (max det J) inside each element, no gate: 1 for affine ones, -1 where no
    det J is positive. MeshError for a mesh of no volume, or without elements.
    """
    return _measure(mesh)[3]


def element_volumes(mesh: Mesh) -> np.ndarray:
    """Return the volume of each element, m^3; no gate."""
    return np.concatenate([_polynomials(mesh, part)[2] for part in _parts(mesh)])


def outward(mesh: Mesh, facets: np.ndarray) -> np.ndarray:
    """Return (3, k) normals of boundary facets by their first three corners, out of the material,
    as long as the parallelogram of these is large, m^2.
    """
    a, b, c = (mesh.p[:, corner] for corner in mesh.facets[:3, facets])
    normal = np.cross((b - a).T, (c - a).T).T
    behind = mesh.p[:, mesh.t[:, mesh.f2t[0, facets]]].mean(axis=1) - a
    return -np.sign((normal * behind).sum(axis=0)) * normal


def _parts(mesh) -> list[slice]:
    """Return elements in batches."""
    return [slice(i, i + _BATCH) for i in range(0, mesh.t.shape[1], _BATCH)]


def _measure(mesh):
    """Return the quality, and per element the least and greatest det J and their ratio."""
    if mesh.dim() != 3:
        raise MeshError(
            f"a volume mesh is needed, but {type(mesh).__name__} has dimension {mesh.dim()}: "
            "give a tetrahedral or hexahedral mesh"
        )
    if mesh.t.shape[1] == 0:
        raise MeshError("the mesh has no elements: check the geometry it was made from")

    extremes = [_extremes(mesh, part) for part in _parts(mesh)]
    low, high, volumes = (np.concatenate(x) for x in zip(*extremes))
    ratio = np.divide(low, high, out=np.full_like(low, -1.0), where=high > 0.0)
    quality = MeshQuality(
        n_elements=int(mesh.t.shape[1]),
        n_vertices=len(np.unique(mesh.t)),
        volume=float(volumes.sum()),
        min_det_j=float(low.min()),
        max_det_j=float(high.max()),
        min_ratio=float(ratio.min()),
        # elements turned inside out may cancel the others
        min_volume_ratio=float(volumes.min() / volumes.mean()) if volumes.mean() else -np.inf,
    )
    return quality, low, high, ratio


# degree of det J: total on tetrahedra, in each coordinate on hexahedra; (tetrahedron, curved)
_DEGREE = {(True, False): 0, (True, True): 3, (False, False): 2, (False, True): 5}


def _polynomials(mesh, part):
    """Return lattice values of det J, Bernstein coefficients and volumes of some elements, and
    the rule behind them.
    """
    element = mesh.elem()
    tet, curved = element.refdom.nnodes == 4, element.doflocs.shape[0] > element.refdom.nnodes
    rule = _bernstein(tet, _DEGREE[tet, curved])
    det = _determinants(mesh, element, rule.points, part)
    coefficients = rule.from_values @ det
    # the mean of a polynomial is that of its coefficients
    return det, coefficients, coefficients.mean(axis=0) / (6 if tet else 1), rule


def _extremes(mesh, part):
    """Return the least and greatest det J of some elements, and their volumes.

    det J is a polynomial, so its Bernstein coefficients bound it over the whole element; where they
    leave a doubt the element is cut in eight, again and again, and only the doubtful pieces are
    kept (Johnen, Remacle and Geuzaine 2013, J. Comput. Phys. 233, 359).
    """
    det, coefficients, volumes, rule = _polynomials(mesh, part)
    low, high = det.min(axis=0), det.max(axis=0)
    owner = np.flatnonzero((coefficients.min(axis=0) < _CLEAR * high) & (low > 0.0))
    piece = coefficients[:, owner]
    for _ in range(_CUTS):
        if not len(owner):
            break
        # (child, element, coefficient)
        pieces = np.einsum("kij,je->kei", rule.children, piece, optimize=True)
        # at a corner a coefficient is the value
        np.minimum.at(low, owner, pieces[:, :, rule.corners].min(axis=(0, 2)))
        open_ = (pieces.min(axis=2) < low[owner] - _TOLERANCE * high[owner]) & (low[owner] > 0.0)
        child, doubtful = np.nonzero(open_)
        owner, piece = owner[doubtful], pieces[child, doubtful].T
    np.minimum.at(low, owner, piece.min(axis=0) if len(owner) else 0.0)
    return low, high, volumes


def _determinants(mesh, element, points, part):
    """Return det J (points, elements)."""
    # one small dense product instead of scikit-fem's cached loop over nine Jacobian entries
    gradients = np.empty((element.doflocs.shape[0], *points.shape))  # (node, 3, point)
    for i, gradient in enumerate(gradients):
        gradient[:] = np.stack(np.broadcast_arrays(*element.lbasis(points, i)[1]))
    location = mesh.doflocs[:, mesh.dofs.element_dofs[:, part]]  # (3, node, element)
    a, b, c = np.einsum("njq,ine->jiqe", gradients, location, optimize=True)  # columns of J
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


@dataclass(frozen=True)
class _Bernstein:
    """Polynomials of one degree on a reference element."""

    points: np.ndarray  #: (3, m) the lattice
    from_values: np.ndarray  #: (m, m) makes coefficients of values there
    children: np.ndarray  #: (8, m, m) makes the coefficients of the eight pieces of the element
    corners: np.ndarray  #: coefficients that are values at its corners


@cache
def _bernstein(tet: bool, degree: int) -> _Bernstein:
    """Return the polynomials on the tetrahedron of a total degree, or on the cube of a degree in
    each coordinate.
    """
    powers = np.array(
        [p for p in product(range(degree + 1), repeat=3) if not tet or sum(p) <= degree]
    )
    if tet:
        powers = np.column_stack([degree - powers.sum(axis=1), powers])
        many = np.array([_multinomial(degree, p) for p in powers])
        # the middles of the edges make four corner pieces and an octahedron of four more
        v = np.eye(4)
        m = {(i, j): (v[i] + v[j]) / 2 for i in range(4) for j in range(4)}
        ring = [m[0, 1], m[1, 2], m[2, 3], m[0, 3]]
        pieces = []
        for i in range(4):
            pieces.append([m[i, j] for j in range(4)])
        for i in range(4):
            pieces.append([m[0, 2], m[1, 3], ring[i], ring[(i + 1) % 4]])
        local = powers / max(degree, 1) + (degree == 0) * 0.25

        def basis(bary):
            return many * np.prod(bary[:, None] ** powers, axis=2)

        places = [local @ np.array(p) for p in pieces]
        points = local[:, 1:].T
    else:
        many = np.array([_binomials(degree, p) for p in powers])
        local = powers / degree

        def basis(x):
            return many * np.prod(
                x[:, None] ** powers * (1 - x[:, None]) ** (degree - powers), axis=2
            )

        places = [(local + corner) / 2 for corner in product((0, 1), repeat=3)]
        points = local.T
    from_values = np.linalg.inv(basis(local))
    corners = np.flatnonzero(np.isin(powers, (0, degree)).all(axis=1))
    return _Bernstein(
        points, from_values, np.array([from_values @ basis(x) for x in places]), corners
    )


def _multinomial(degree: int, powers) -> float:
    return float(factorial(degree) / np.prod([factorial(int(i)) for i in powers]))


def _binomials(degree: int, powers) -> float:
    factors = [factorial(degree) / factorial(int(i)) / factorial(degree - int(i)) for i in powers]
    return float(np.prod(factors))


def _refuse(mesh, bad, value, fault, name, unit, cure):
    if not bad.any():
        return
    worst = int(np.argmin(np.where(np.isnan(value), -np.inf, value)))
    x, y, z = mesh.p[:, mesh.t[:, worst]].mean(axis=1)
    count = int(bad.sum())
    raise MeshError(
        f"{count} of {len(bad)} elements {'is' if count == 1 else 'are'} {fault}, "
        f"the worst is element {worst} at ({x:.4g}, {y:.4g}, {z:.4g}) m "
        f"with {name} {value[worst]:.3g} {unit}: {cure}"
    )
