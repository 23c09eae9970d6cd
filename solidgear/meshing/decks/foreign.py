"""gmsh (.msh) and VTK (.vtu) files, as meshio reads them."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.meshing.decks.deck import Deck, Group, one_kind
from solidgear.meshing.quality import MeshError

#: modules of meshio
MODULES = {".msh": "gmsh", ".vtu": "vtu"}
#: values of an array of cells up to which it tells groups, and not a result
MOST_VALUES = 200


def read(path: str) -> Deck:
    """The mesh of a file; MeshError where it cannot be read."""
    found = _parsed(path, MODULES[Path(path).suffix.lower()])
    points = np.asarray(found.points, float)
    if points.ndim != 2 or points.shape[1] != 3:
        raise MeshError("its nodes are not points in space")
    counts: dict[str, int] = {}
    for block in found.cells:
        if len(block.data):
            counts[block.type] = counts.get(block.type, 0) + len(block.data)
    kind = one_kind(counts)
    blocks = [k for k, b in enumerate(found.cells) if b.type == kind and len(b.data)]
    cells = np.concatenate([np.asarray(found.cells[k].data, np.int64) for k in blocks]).T
    groups = tuple(_groups(found, blocks))
    return Deck(points.T, kind, cells, groups, patches=_patches(found, kind))


def _parsed(path: str, module: str) -> Any:
    import meshio

    reader = importlib.import_module(f"meshio.{module}").read
    try:
        return reader(path)
    except OSError as error:
        raise MeshError(f"cannot be read ({error.strerror or error})") from error
    except (Exception, SystemExit) as error:  # whatever a parser meets in a file that is none
        said = str(error) if isinstance(error, (ValueError, meshio.ReadError)) else ""
        what = f" ({' '.join(said.split())[:120]})" if said else ": it is broken or cut off"
        raise MeshError(f"cannot be read as {module}{what}") from error


def _groups(found: Any, blocks: list[int]) -> Iterator[Group]:
    """Physical groups of volumes, else volumes of gmsh; else the values of arrays of cells."""
    physical = dict(_physical(found, blocks, 3))
    if physical:
        yield from (Group(name, own) for name, own in physical.items())
        return
    arrays = {}
    for name, data in found.cell_data.items():
        values = np.concatenate([np.asarray(data[k]) for k in blocks])
        if name == "gmsh:physical" or values.ndim != 1 or not np.isfinite(values).all():
            continue
        whole = np.rint(values).astype(np.int64)
        if (whole == values).all() and len(np.unique(whole)) <= MOST_VALUES:
            arrays[name] = whole
    for name, values in arrays.items():
        before = "" if len(arrays) == 1 else f"{name}:"
        for value in np.unique(values):
            tells = "gmsh:" not in name
            yield Group(f"{before}{value}", np.flatnonzero(values == value), tells)


def _patches(found: Any, kind: str) -> dict[str, np.ndarray]:
    """Corners of the faces of physical groups of surfaces."""
    face, corners = ("triangle", 3) if kind.startswith("tet") else ("quad", 4)
    blocks = [k for k, b in enumerate(found.cells) if b.type.startswith(face) and len(b.data)]
    if not blocks:
        return {}
    faces = np.concatenate([np.asarray(found.cells[k].data, np.int64)[:, :corners] for k in blocks])
    return {name: faces[own].T for name, own in _physical(found, blocks, 2)}


def _physical(found: Any, blocks: list[int], dimension: int) -> Iterator[tuple[str, np.ndarray]]:
    """Physical groups of some dimension, and their places in blocks of cells."""
    sizes = [len(found.cells[k].data) for k in blocks]
    starts = np.cumsum([0, *sizes[:-1]])
    names = {int(tag): name for name, (tag, own) in found.field_data.items() if own == dimension}
    seen = set()
    for name in names.values():
        # an entity of several groups is in the set of each
        sets = found.cell_sets.get(name)
        if sets is not None:
            own = [
                np.asarray(sets[k], np.int64) + s
                for k, s in zip(blocks, starts)
                if sets[k] is not None
            ]
            every = np.concatenate(own) if own else np.zeros(0, np.int64)
            if len(every):
                seen.add(name)
                yield name, every
    tags = found.cell_data.get("gmsh:physical")
    if tags is None or len(tags) != len(found.cells):
        return
    values = np.concatenate([np.asarray(tags[k], np.int64) for k in blocks])
    for tag in np.unique(values[values > 0]):
        name = names.get(int(tag), str(tag))
        if name not in seen:
            yield name, np.flatnonzero(values == tag)
