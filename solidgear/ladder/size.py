"""How large a body will be, from the layout of its mesh alone: unknowns, matrix entries and peak
memory, before anything large is made.

Unknowns and entries of hexahedra and of harmonic solids are counted, not estimated: a mesh laid out
by lines has as many vertices, edges, faces and cells as its lines say, and a pair of unknowns that
meet in a cell makes one entry, whatever number of cells they share (cells less the inner faces
between them, plus their inner edges, less their inner vertices, is one).  Tetrahedra fill volume
and surface at the sizes asked of the mesher.

Memory is that of mesh, assembly and factor together.  Its laws were fitted to peaks of resident
memory, each in a process of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from solidgear.ladder.registry import LADDER

if TYPE_CHECKING:
    from solidgear.scene.shaft import Shaft


@dataclass(frozen=True)
class Size:
    """What a model takes.

    Attributes
    ----------
    unknowns : int
        Of all blocks, twins counted twice: the ``size`` of the body.
    entries : int
        Of all stiffness matrices, twins counted once.
    largest : int
        Entries of the largest list of element matrices or of one matrix, which 32-bit indices must
        number.
    build_mb, peak_mb : float
        Memory beyond what the process holds: of the body, and at the peak of building, factoring
        and first modes.
    lower : str
        What to lower, in words.
    fill : float
        Entries of the factors of a 3D solid were its matrix factored whole.
    """

    unknowns: int
    entries: int
    largest: int
    build_mb: float
    peak_mb: float
    lower: str
    fill: float = 0.0


def estimated_unknowns(scene: Shaft, model: str, options: dict | None = None) -> int:
    """Unknowns of ``build(scene, model, **options)``, without building it.

    Parameters
    ----------
    scene : Scene
    model : str
        A rung that builds a body.
    options : dict, optional
        Builder options.

    Returns
    -------
    int
        Exact for beams, hexahedra and harmonic solids without rigid seats (each takes some hundreds
        away); tetrahedra within a quarter.
    """
    return estimated_size(scene, model, options).unknowns


def estimated_size(scene: Shaft, model: str, options: dict | None = None) -> Size:
    """Unknowns, entries and memory of ``build(scene, model, **options)`` and what is solved on it;
    parameters as :func:`estimated_unknowns`.
    """
    rung = LADDER[model]
    assert rung.size is not None  # of a rung that builds a body
    return rung.size(scene, rung.defaults() | rung.checked(options or {}))
