"""Integrals over a volume mesh: stiffness, mass, and the mean motion of a surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTet

from solidgear.core.body.mass import ScalarMass
from solidgear.core.elements import ELEMENTS
from solidgear.core.frames import cross_matrix, on_axis
from solidgear.core.kernel.assembly import Pattern, Sum, Tabulation, batches, inverted, straight
from solidgear.core.meshing.lobatto import gauss_box
from solidgear.core.models.solid.images import Images, orbits
from solidgear.core.models.solid.mesh import SolidMesh

if TYPE_CHECKING:
    from solidgear.core.scene import Material


def _matrices(m: SolidMesh, materials: Sequence[Material]) -> tuple[sp.csr_matrix, ScalarMass]:
    """Assemble stiffness (3n, 3n) and consistent mass of a solid of isotropic materials."""
    points, weights = _cell_rule(m.name)
    basis = Tabulation(m.element, m.element, points)
    stiffness, mass = integrals(m, materials, basis, weights, m.dofs)
    return stiffness.matrix(), ScalarMass(mass.matrix(), 3)


def matrices_by_images(
    m: SolidMesh, materials: Sequence[Material], images: Sequence[Images]
) -> tuple[sp.csr_matrix, ScalarMass, np.ndarray]:
    """Assemble the matrices of one cell of each set of images, times the cells of it; return them with
    the nodes (s,) that they have rows for.
    """
    points, weights = _cell_rule(m.name)
    basis = Tabulation(m.element, m.element, points)
    cells, multiples = orbits(images, m.dofs.shape[1])
    part = replace(m, dofs=m.dofs[:, cells], segment=m.segment[cells])
    nodes, places = np.unique(part.dofs, return_inverse=True)
    numbers = places.reshape(part.dofs.shape)
    stiffness, mass = integrals(part, materials, basis, weights, numbers, multiples=multiples)
    return stiffness.matrix(), ScalarMass(mass.matrix(), 3), nodes


def integrals(
    m: SolidMesh,
    materials: Sequence[Material],
    basis: Tabulation,
    weights: np.ndarray,
    numbers: np.ndarray,
    signs: np.ndarray | None = None,
    multiples: np.ndarray | None = None,
    first: int = 0,
) -> tuple[Sum, Sum]:
    """Sum up stiffness (3n, 3n) and mass of one component (n, n) in some basis, tabulated at the
    points of the weights, whose functions have numbers (nb, ne) and signs (nb, ne) in the cells;
    each cell counts so many times (ne,).  Rows are those of the `first` function of a cell and of
    all after it.
    """
    nb, nq = basis.value.shape
    pattern = Pattern(numbers, first)
    stiffness, mass = pattern.sum(3), pattern.sum()
    # products of basis functions, and of reference gradients, of which straight elements take one
    # multiple each
    products = (basis.value[first:, None] * basis.value).reshape(-1, nq).T
    slopes = np.einsum(
        "apq,brq,q->prab", basis.slope[first:], basis.slope, weights, optimize=True
    ).reshape(9, -1)
    is_straight, jac = straight(m.element, m.nodes[:, m.dofs])
    for index, material in enumerate(materials):
        nu, mu, rho = material.nu, material.shear_modulus, material.density
        lame = 2 * mu * nu / (1 - 2 * nu)
        members = m.segment == index
        for part in batches(np.flatnonzero(members & is_straight), 8 * 20 * nb * nb):
            inverse, det = inverted(jac[:, :, part])
            det = det if multiples is None else det * multiples[part]
            along = (inverse * det)[:, :, None, None] * inverse  # (reference, space) twice
            tensor = _elastic(along.transpose(1, 3, 4, 0, 2).reshape(3, 3, len(part), 9), lame, mu)
            turned = 1.0 if signs is None else _products_of_signs(signs, part, first)
            stiffness.add(part, tensor @ slopes * turned)
            mass.add(part, np.outer(rho * det, weights @ products) * turned)
        for part in batches(
            np.flatnonzero(members & ~is_straight), 8 * (3 * nb * nq + 30 * nb * nb)
        ):
            places = m.nodes[:, m.dofs[:, part]]
            # from a node of each: absolute places would round the differences in a thin cell
            t = basis.on(places - places[:, :1])
            dv = t.det * weights
            dv = dv if multiples is None else dv * multiples[part, None]
            g = t.gradient(np.sqrt(dv))
            inertia = rho * dv @ products
            if signs is not None:
                g *= signs[:, part].T[:, None, :, None]
                inertia *= _products_of_signs(signs, part, first)
            of_rows = g[:, :, first:].reshape(len(part), -1, nq)
            gram = of_rows @ g.reshape(len(part), 3 * nb, nq).transpose(0, 2, 1)
            gram = gram.reshape(-1, 3, nb - first, 3, nb).transpose(1, 3, 0, 2, 4)
            stiffness.add(part, _elastic(gram, lame, mu))
            mass.add(part, inertia)
    return stiffness, mass


def _products_of_signs(signs: np.ndarray, cells: np.ndarray, first: int) -> np.ndarray:
    """Return the products (e, nr nb) of the signs of functions of some cells from a first one on,
    and of all.
    """
    own = signs[:, cells].T
    return (own[:, first:, None] * own[:, None, :]).reshape(len(cells), -1)


def _elastic(gram, lame: float, mu: float):
    """Return the isotropic stiffness from the integrals of products of gradients, components (3, 3,
    ...) of row and column first.
    """
    out = lame * gram
    shear = mu * gram
    out += shear.swapaxes(0, 1)
    trace = shear[0, 0] + shear[1, 1] + shear[2, 2]
    for i in range(3):
        out[i, i] += trace
    return out


def _mean(m: SolidMesh, facets, place, n, within=None) -> sp.csr_matrix:
    """Return the area-weighted least-squares rigid motion (6, 3n) of facets about a point, or the axis
    point at some y; of their parts between two places along y where these are given.
    """
    gram, loads = weighed(m.over_facets(facets, within), place, n)
    return rigid_part(gram, loads, tuple(range(6)))


def rigid_part(gram: np.ndarray, loads: np.ndarray, components: tuple[int, ...]) -> sp.csr_matrix:
    """Return some components (c, 3n) of the least-squares rigid motion from :func:`weighed`."""
    chosen = list(components)
    g = np.linalg.solve(gram[np.ix_(chosen, chosen)], loads.T[chosen])
    g[np.abs(g) < 1e-14 * np.abs(g).max(axis=1, keepdims=True)] = 0.0
    return sp.csr_matrix(g)


def weighed(pieces, place: float | Sequence[float], n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the normal equations of the rigid motion about a place (m) nearest to the motion of some
    pieces, of :meth:`SolidMesh.over_facets` or :meth:`SolidMesh.over_cells`, of a mesh of n nodes.

    With gram (6, 6) and loads (3 n, 6) the rigid motion of displacements u is ``gram^-1 loads' u``.
    """
    a = np.zeros((6, 6))
    b = np.zeros((n, 3, 6))
    for value, x, weight, dofs in pieces:
        offset = np.moveaxis(x, 0, -1) - on_axis(place)  # (e, q, 3)
        motion = np.zeros((*offset.shape, 6))
        motion[..., :3] = np.eye(3)
        motion[..., 3:] = -np.einsum("abc,eqc->eqab", _CROSS, offset)
        a += np.einsum("eq,eqci,eqcj->ij", weight, motion, motion)
        index = "ebq" if value.ndim == 3 else "bq"
        part = np.einsum(f"{index},eq,eqci->ebci", value, weight, motion, optimize=True)
        np.add.at(b, dofs.T, part)
    return a, b.reshape(3 * n, 6)


# cross_matrix(r)[a, b] = sum_c _CROSS[a, b, c] r[c]
_CROSS = np.stack([cross_matrix(e) for e in np.eye(3)], axis=-1)


def _cell_rule(name):
    """Return the quadrature of an element: points and weights."""
    degree = ELEMENTS[name].degree
    if name.startswith("tet"):
        return get_quadrature(RefTet, degree)  # the rules in use have positive weights only
    return gauss_box((degree + 1) // 2, 3)
