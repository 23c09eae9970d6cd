"""Unstructured grids as VTK keeps them in XML (``vtu``): cells, their nodes, and vectors at points.

Format: VTK file formats, https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
"""

from __future__ import annotations

import base64
import re
import zlib
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from solidgear.show.pen import escaped

#: numbers of kinds of cells, by the names of meshio
TYPES = {
    **{"triangle": 5, "quad": 9, "tetra": 10, "hexahedron": 12},
    **{"tetra10": 24, "hexahedron20": 25, "hexahedron27": 29},
}
#: corners of the unit tetrahedron and the unit cube, and corners at the ends of their edges
TETRAHEDRON = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
TETRAHEDRON_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
CUBE = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
CUBE_EDGES = [
    *((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)),
    *((0, 4), (1, 5), (2, 6), (3, 7)),
]
#: middles of the faces of the cube, and its own
CUBE_FACES = [
    *((0, 0.5, 0.5), (1, 0.5, 0.5), (0.5, 0, 0.5), (0.5, 1, 0.5), (0.5, 0.5, 0), (0.5, 0.5, 1)),
    (0.5, 0.5, 0.5),
]
#: bytes that are compressed together
BLOCK = 32768
NAMES = {"<f8": "Float64", "<i8": "Int64", "<i4": "Int32", "|u1": "UInt8"}


def vtk_nodes(cell: str) -> list[tuple[float, ...]]:
    """Return reference coordinates of the nodes of a kind of cell, in VTK's order.

    Examples
    --------
    >>> vtk_nodes("tetra10")[4]
    (0.5, 0.0, 0.0)
    """
    if cell.startswith("tetra"):
        corners, edges, inside = TETRAHEDRON, TETRAHEDRON_EDGES, []
    else:
        corners, edges, inside = CUBE, CUBE_EDGES, CUBE_FACES
    middles = [tuple((a + b) / 2 for a, b in zip(corners[i], corners[j])) for i, j in edges]
    count = int(re.sub(r"\D", "", cell) or len(corners))
    return [*corners, *middles, *inside][:count]


def unstructured_grid(
    points: np.ndarray,
    cells: Sequence[tuple[str, np.ndarray]],
    vectors: Mapping[str, np.ndarray],
) -> bytes:
    """Return a grid as the contents of a file.

    Parameters
    ----------
    points : (n, 3) array
    cells : sequence of (kind, (m, k) array)
        Kinds by the names of meshio, with their nodes in VTK's order.
    vectors : mapping of str to (n, 3) array
        At the points, by name.
    """
    nodes = np.concatenate([rows.ravel() for _, rows in cells])
    sizes = np.concatenate([np.full(len(rows), rows.shape[1]) for _, rows in cells])
    kinds = np.concatenate([np.full(len(rows), TYPES[kind]) for kind, rows in cells])
    body = {
        "Points": [_array("Points", points, "<f8")],
        "Cells": [
            _array("connectivity", nodes, "<i8"),
            _array("offsets", np.cumsum(sizes), "<i8"),
            _array("types", kinds, "|u1"),
        ],
        "PointData": [_array(name, values, "<f8") for name, values in vectors.items()],
    }
    parts = "\n".join(_tagged(tag, "\n".join(arrays), {}) for tag, arrays in body.items())
    counts = {"NumberOfPoints": str(len(points)), "NumberOfCells": str(len(sizes))}
    grid = _tagged("UnstructuredGrid", _tagged("Piece", parts, counts), {})
    how = {
        **{"type": "UnstructuredGrid", "version": "1.0", "byte_order": "LittleEndian"},
        **{"header_type": "UInt32", "compressor": "vtkZLibDataCompressor"},
    }
    return b'<?xml version="1.0"?>\n' + _tagged("VTKFile", grid, how).encode()


def _array(name: str, values: np.ndarray, kind: str) -> str:
    """Return numbers as an element of the file."""
    data = np.ascontiguousarray(values, dtype=kind).tobytes()
    blocks = [zlib.compress(part) for part in _blocks(data)]
    header = [len(blocks), BLOCK, len(data) % BLOCK, *map(len, blocks)]
    text = base64.b64encode(np.array(header, "<u4").tobytes()) + base64.b64encode(b"".join(blocks))
    looks = {"type": NAMES[kind], "Name": name, "format": "binary"}
    if np.ndim(values) == 2:
        looks["NumberOfComponents"] = str(values.shape[1])
    return _tagged("DataArray", text.decode(), looks)


def _blocks(data: bytes) -> Iterator[bytes]:
    for start in range(0, len(data), BLOCK):
        yield data[start : start + BLOCK]


def _tagged(tag: str, inside: str, looks: Mapping[str, str]) -> str:
    named = "".join(f' {name}="{escaped(value)}"' for name, value in looks.items())
    return f"<{tag}{named}>{inside}</{tag}>"
