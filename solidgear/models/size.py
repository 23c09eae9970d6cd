"""Size of a model, counted on its mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.kernel.assembly import Pattern
from solidgear.kernel.room import MB, PUT
from solidgear.solve.backends.memory_law import law
from solidgear.solve.choice import choice

if TYPE_CHECKING:
    from solidgear.body import Body


@dataclass(frozen=True)
class Size:
    """Unknowns, entries and memory of a model.

    Attributes
    ----------
    unknowns : int
        Of all blocks, twins counted twice: the ``size`` of the body.
    matrices : tuple of (int, int)
        Rows and entries of every matrix that is factored.
    entries : int
        That are held.
    planar : bool
        Whether they come from a 1D or 2D mesh.
    """

    unknowns: int
    matrices: tuple[tuple[int, int], ...]
    entries: int
    planar: bool = False

    @property
    def backend(self) -> str:
        """Name of the back end that will factor the largest matrix."""
        return choice(*max(self.matrices), planar=self.planar)[0]

    @property
    def factors_mb(self) -> float:
        """Memory of all factors together, about; the law of
        :mod:`solidgear.solve.backends.memory_law`.
        """
        return sum(law(self.backend, *matrix, self.planar) for matrix in self.matrices)

    @property
    def matrices_mb(self) -> float:
        """Memory of all matrices."""
        return PUT * self.entries / MB

    @property
    def mb(self) -> float:
        """Memory of matrices and factors, about."""
        return self.matrices_mb + self.factors_mb


def of_body(body: Body) -> Size:
    """Of a body that is there.

    Examples
    --------
    >>> import solidgear as sg
    >>> rod = sg.Segment.cylinder("rod", length=0.6, diameter=0.02)
    >>> size = of_body(sg.build(sg.Scene.from_parts([rod]), "timoshenko", elements=4))
    >>> size.unknowns, len(size.matrices)  # both planes of bending have one matrix
    (46, 3)
    """
    own = {id(b.stiffness): b for b in body.blocks}.values()
    matrices = tuple((b.size, b.stiffness.nnz) for b in own)
    entries = sum(n for _, n in matrices)
    in_pieces = [m for b in own for m in pieces(b.size, b.stiffness.nnz, bool(b.reflections))]
    return Size(body.size, tuple(in_pieces), entries, all(b.planar for b in own))


def of_mesh(dofs: np.ndarray, parts: int = 1, mirrors: bool = False) -> Size:
    """Of the 3D solid of a mesh by the nodes (nb, ne) of its elements, of several blocks of the
    same mesh and with a matrix that is factored in pieces, if so.
    """
    pattern = Pattern(dofs)
    unknowns, entries = 3 * pattern.n, 9 * len(pattern.indices)
    matrices = pieces(unknowns, entries, mirrors) * parts
    return Size(parts * unknowns, tuple(matrices), parts * entries)


def pieces(unknowns: int, entries: int, mirrors: bool) -> list[tuple[int, int]]:
    """Matrices that one is factored as: two mirror planes and the one between them leave three of a
    quarter (:mod:`solidgear.solve.symmetry`).
    """
    return [(unknowns // 4, entries // 4)] * 3 if mirrors else [(unknowns, entries)]
