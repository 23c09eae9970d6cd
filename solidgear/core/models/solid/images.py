"""Mirror images of the cells of a volume mesh, and of functions that live in them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from solidgear.core.body import Reflection


class Functions(Protocol):
    """Functions on a reference cell."""

    @property
    def refdom(self) -> Any:
        """Reference cell of scikit-fem."""

    def at(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return values (k, q) and slopes (k, 3, q) at reference points (3, q)."""


class Images:
    """Cells with corners (c, ne) in a mirror plane that takes every vertex to its partner (nv,).

    Examples
    --------
    Two bars in a row, which the mirror turns end for end:

    >>> images = Images(np.array([[0, 1], [1, 2]]), np.array([2, 1, 0]))
    >>> images.cells, images.corners.T
    (array([1, 0]), array([[1, 0],
           [1, 0]]))
    """

    def __init__(self, corners: np.ndarray, partner: np.ndarray):
        moved = partner[corners]
        here, there = (np.sort(c, axis=0) for c in (corners, moved))
        self.cells = np.empty(corners.shape[1], int)  #: (ne,) image of every cell
        self.cells[np.lexsort(there)] = np.lexsort(here)
        #: whether the image of every cell is a cell: nodes may have images where cells have none
        self.exact = np.array_equal(here[:, self.cells], there)
        #: (c, ne) corner of the image that every corner comes to lie at
        self.corners = (corners[:, self.cells] == moved[:, None]).argmax(axis=1)

    def are_alike(self, kinds: np.ndarray) -> bool:
        """Return whether the image of every cell is a cell of the same kind (ne,)."""
        return self.exact and np.array_equal(kinds, kinds[self.cells])

    def of_functions(
        self, further: Functions, numbers: np.ndarray, signs: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the function that every one becomes in the mirror, and the sign that it has there,
        from the numbers (k, ne) and signs (k, ne) of those of all cells.
        """
        partner = np.empty(int(numbers.max()) + 1, int)
        sign = np.empty(len(partner))
        places = np.asarray(further.refdom.p)
        points = places @ np.random.default_rng(0).dirichlet(np.ones(len(places.T)), 30).T
        value = _normed(further.at(points)[0])
        turns, which = np.unique(self.corners, axis=1, return_inverse=True)
        for index, turn in enumerate(turns.T):
            affine = np.linalg.lstsq(_with_one(places).T, places[:, turn].T, rcond=None)[0]
            there = _normed(further.at(affine.T @ _with_one(points))[0])
            # of the functions of the image, the one that takes the same values, or their opposites
            alike = value @ there.T
            image = np.abs(alike).argmax(axis=1)
            turned = np.sign(alike[np.arange(len(image)), image])
            cells = np.flatnonzero(which.ravel() == index)
            beyond = np.ix_(image, self.cells[cells])
            partner[numbers[:, cells]] = numbers[beyond]
            sign[numbers[:, cells]] = signs[:, cells] * turned[:, None] * signs[beyond]
        return partner, sign


def _normed(value: np.ndarray) -> np.ndarray:
    return value / np.linalg.norm(value, axis=1, keepdims=True)


def _with_one(points: np.ndarray) -> np.ndarray:
    return np.vstack([points, np.ones(points.shape[1])])


def images_of(corners: np.ndarray, reflections: Sequence[Reflection]) -> tuple[Images, ...]:
    """Return the images of cells in mirror planes that are given by the unknowns of their nodes."""
    return tuple(Images(corners, partner[::3] // 3) for partner, _ in reflections)


def orbits(images: Sequence[Images], cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a cell of each set that mirror planes turn into each other, and the size of the set."""
    places = [np.arange(cells)]
    for image in images:
        places += [image.cells[place] for place in places]
    first = np.min(places, axis=0)
    return np.unique(first, return_counts=True)


def of_vectors(reflection: Reflection, partner: np.ndarray, sign: np.ndarray) -> Reflection:
    """Return the mirror of vectors that belong to functions, three components each, from that of the
    unknowns of a mesh.
    """
    across, turn = (part[:3] for part in reflection)
    order = across % 3
    return (3 * partner[:, None] + order).ravel(), (sign[:, None] * turn).ravel()
