"""gmsh (.msh) and VTK (.vtu) files, as meshio reads them."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core.meshing.quality import MeshError
from solidgear.parts.decks.deck import Deck, Group, one_kind

#: modules of meshio
MODULES = {".msh": "gmsh", ".vtu": "vtu"}
#: values of an array of cells up to which they are groups, and not a result
MOST_VALUES = 200


def read(path: str) -> Deck:
    """Read the mesh of a file; MeshError where it cannot be read."""
    parsed = _parsed(path, MODULES[Path(path).suffix.lower()])
    points = np.asarray(parsed.points, float)
    if points.ndim != 2 or points.shape[1] != 3:
        raise MeshError("its nodes are not points in space")
    counts: dict[str, int] = {}
    for block in parsed.cells:
        if len(block.data):
            counts[block.type] = counts.get(block.type, 0) + len(block.data)
    kind = one_kind(counts)
    blocks = [k for k, b in enumerate(parsed.cells) if b.type == kind and len(b.data)]
    cells = np.concatenate([np.asarray(parsed.cells[k].data, np.int64) for k in blocks]).T
    groups = tuple(_groups(parsed, blocks))
    return Deck(points.T, kind, cells, groups, patches=_patches(parsed, kind))


def _parsed(path: str, module: str) -> Any:
    import meshio

    reader = importlib.import_module(f"meshio.{module}").read
    try:
        return reader(path)
    except OSError as error:
        raise MeshError(f"cannot be read ({error.strerror or error})") from error
    except (Exception, SystemExit) as error:  # whatever a parser meets in a file that is none
        words = str(error) if isinstance(error, (ValueError, meshio.ReadError)) else ""
        reason = f" ({' '.join(words.split())[:120]})" if words else ": it is broken or cut off"
        raise MeshError(f"cannot be read as {module}{reason}") from error


def _groups(parsed: Any, blocks: list[int]) -> Iterator[Group]:
    """Yield physical groups of volumes, else volumes of gmsh; else the values of arrays of
    cells.
    """
    physical = dict(_physical(parsed, blocks, 3))
    if physical:
        yield from (Group(name, elements) for name, elements in physical.items())
        return
    arrays = {}
    for name, data in parsed.cell_data.items():
        values = np.concatenate([np.asarray(data[k]) for k in blocks])
        if name == "gmsh:physical" or values.ndim != 1 or not np.isfinite(values).all():
            continue
        integers = np.rint(values).astype(np.int64)
        if (integers == values).all() and len(np.unique(integers)) <= MOST_VALUES:
            arrays[name] = integers
    for name, values in arrays.items():
        prefix = "" if len(arrays) == 1 else f"{name}:"
        for value in np.unique(values):
            elements = np.flatnonzero(values == value)
            yield Group(f"{prefix}{value}", elements, of_material="gmsh:" not in name)


def _patches(parsed: Any, kind: str) -> dict[str, np.ndarray]:
    """Return the corners of the faces of physical groups of surfaces, by their names."""
    face, corners = ("triangle", 3) if kind.startswith("tet") else ("quad", 4)
    blocks = [k for k, b in enumerate(parsed.cells) if b.type.startswith(face) and len(b.data)]
    if not blocks:
        return {}
    faces = np.concatenate(
        [np.asarray(parsed.cells[k].data, np.int64)[:, :corners] for k in blocks]
    )
    return {name: faces[places].T for name, places in _physical(parsed, blocks, 2)}


def _physical(parsed: Any, blocks: list[int], dimension: int) -> Iterator[tuple[str, np.ndarray]]:
    """Yield physical groups of some dimension, and their places in blocks of cells."""
    sizes = [len(parsed.cells[k].data) for k in blocks]
    starts = np.cumsum([0, *sizes[:-1]])
    names = {int(tag): name for name, (tag, dim) in parsed.field_data.items() if dim == dimension}
    in_sets = set()
    for name in names.values():
        # an entity of several groups is in the set of each
        sets = parsed.cell_sets.get(name)
        if sets is not None:
            places = [
                np.asarray(sets[k], np.int64) + start
                for k, start in zip(blocks, starts)
                if sets[k] is not None
            ]
            if places and len(members := np.concatenate(places)):
                in_sets.add(name)
                yield name, members
    tags = parsed.cell_data.get("gmsh:physical")
    if tags is None or len(tags) != len(parsed.cells):
        return
    values = np.concatenate([np.asarray(tags[k], np.int64) for k in blocks])
    for tag in np.unique(values[values > 0]):
        name = names.get(int(tag), str(tag))
        if name not in in_sets:
            yield name, np.flatnonzero(values == tag)
