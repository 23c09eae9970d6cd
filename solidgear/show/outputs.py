"""Files for other programs that a comparison leaves of every model it has solved.

A further one is an :class:`Output`, whose writer writes by ``whole``, and a row in
``docs/guide/commands.md``.  Clearing up and the list in ``results.json`` read ``OUTPUTS``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core import ELEMENTS, whole
from solidgear.core.body.surface import Volume

if TYPE_CHECKING:
    from solidgear.core import Body, Mode, ModeSet, Solution


def write_vtu(
    body: Body,
    modes: ModeSet | Iterable[Mode],
    path: str | Path,
    *,
    most: int | None = None,
) -> Path:
    """Write a body and its mode shapes.

    A solid is written as its volume mesh, with cells of its own type; any other body as its
    surface. Every shape is a vector at the points, named such as ``bending 1a (2758.00 Hz)``,
    normalised to unit modal mass (kg^-1/2, so scale it before taking it for metres). Coordinates
    are in m.

    Parameters
    ----------
    modes : ModeSet or iterable of Mode
    path : str or Path
        Of the vtu file; there is a whole one or none.
    most : int, optional
        Write the first so many modes only.

    Raises
    ------
    SolidgearError
        For a body that carries no geometry, or modes of another body.
    OSError
        If the file cannot be written.
    """
    import meshio

    path = Path(path)
    chosen = modes if isinstance(modes, Iterable) else modes.modes
    shapes = dict(_shapes(islice(chosen, most)))
    volume = body.geometry.volume() if body.geometry is not None else None
    if volume is not None:
        points, cells, data = _volume(body, volume, shapes)
    else:
        still = body.surface({})
        points = still.points
        cells = [
            (kind, nodes)
            for kind, nodes in (("quad", still.faces), ("triangle", still.triangles))
            if len(nodes)
        ]
        data = {name: body.surface(vectors).displacement for name, vectors in shapes.items()}
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole(path) as partial:
        meshio.write(partial, meshio.Mesh(points, cells, point_data=data), file_format="vtu")
    return path


def _shapes(modes: Iterable):
    """Return the name and vectors of every shape; a letter distinguishes those of a pair."""
    for mode in modes:
        for k, vectors in enumerate(mode.vectors):
            letter = chr(ord("a") + k) if len(mode.vectors) > 1 else ""
            yield f"{mode.name}{letter} ({mode.frequency_hz:.2f} Hz)", vectors


def _volume(body: Body, mesh: Volume, shapes):
    element = ELEMENTS[mesh.element]
    order = node_order(mesh.local, element.vtk)
    motion = body.geometry.motion  # type: ignore[union-attr]  # of a mesh that has a volume
    data = {name: motion(body.mesh_unknowns(vectors)) for name, vectors in shapes.items()}
    return mesh.nodes.T, [(element.cell, mesh.cells[order].T)], data


#: places of the nodes of VTK's cells in their unit cube or tetrahedron, x y z in halves
VTK_NODES = {
    "vtkQuadraticTetra": "000 200 020 002 100 110 010 001 101 011",
    "vtkTriQuadraticHexahedron": (
        "000 200 220 020 002 202 222 022 100 210 120 010 102 212 122 012 001 201 221 021 "
        "011 211 101 121 110 112 111"
    ),
}


def node_order(doflocs: np.ndarray, vtk_name: str) -> np.ndarray:
    """Return the local nodes of an element in VTK's order, found by their reference coordinates,
    (nb, 3).

    Both sides use the unit cube or the unit tetrahedron; meshio keeps VTK's order for these types.
    `vtk_name` is the class of the VTK cell. Those with less nodes leave out the last ones.
    """
    shape = "vtkQuadraticTetra" if "Tetra" in vtk_name else "vtkTriQuadraticHexahedron"
    places = VTK_NODES[shape].split()[: len(doflocs)]
    coordinates = np.array([[int(half) / 2 for half in place] for place in places])
    distance = np.abs(coordinates[:, None] - np.asarray(doflocs)[None]).max(axis=2)
    order = distance.argmin(axis=1)
    if distance.min(axis=1).max() > 1e-12 or len(set(order)) != len(doflocs):
        raise ValueError(f"the nodes of {vtk_name} are not those of the element")
    return order


@dataclass(frozen=True)
class Output:
    """A kind of file."""

    what: str  #: named where it is left out: one that fails costs a sentence, and no number
    #: stem, ending: of its name, before and after the model
    stem: str
    ending: str
    write: Callable[[Solution, Path], object]  #: given a solution and the path

    def name(self, model: str) -> str:
        """Return the name of the file of a model."""
        return f"{self.stem}_{model}{self.ending}"

    @property
    def pattern(self) -> str:
        """Regular expression of all such names."""
        return rf"{self.stem}_\w+{re.escape(self.ending)}"


def _mode_shapes(solution: Solution, path: Path) -> None:
    write_vtu(solution.body, solution.modes, path)


OUTPUTS = (Output("vtu", "modes", ".vtu", _mode_shapes),)
