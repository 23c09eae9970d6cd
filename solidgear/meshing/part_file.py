"""Contents of the files of a part: its surface, volume, groups and coarser meshes."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from solidgear.errors import SceneError
from solidgear.machine.isolated import IsolatedError, isolated
from solidgear.meshing.mesh_file import FileMesh, mesh_from
from solidgear.meshing.placing import Placing
from solidgear.meshing.quality import MeshError
from solidgear.meshing.step import look
from solidgear.scene.body_file import BodyTable, CoarseMesh, PartGroup
from solidgear.scene.patches import Patch

#: s of processor time after which a file is given up
LOOK_SECONDS = 25.0
#: largest STEP or mesh file, bytes
LARGEST = 500_000_000
#: relative difference of volumes and sizes of two meshes of one body: chords of six to a turn lack 17 %
SAME_BODY = 0.2


def content_of(path: Path) -> bytes:
    try:
        if path.stat().st_size > LARGEST:
            raise SceneError(
                f"the file is larger than {LARGEST / 1e6:.0f} MB: simplify the part", path=("file",)
            )
        return path.read_bytes()
    except OSError as error:
        raise MeshError(f"cannot be opened: {error.strerror or error}") from None


class Found(NamedTuple):
    """Content of a file, in the scene.

    ``points`` (3, n) and ``triangles`` (3, t) of its surface and of what lies between groups;
    ``sides`` (2, t), group on each side, -1 outside; ``own_mesh``, fields of a :class:`BodyFile`.
    """

    points: np.ndarray
    triangles: np.ndarray
    sides: np.ndarray
    volume: float
    groups: tuple[PartGroup, ...]
    told: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()
    own_mesh: dict[str, Any] = {}
    patches: tuple[Patch, ...] = ()


@lru_cache(maxsize=8)
def file_mesh(path: str, sha256: str, place: Placing, named: tuple[str, ...]) -> FileMesh:
    """The mesh of a file of some content, kept: what varies other entries of a scene asks for it again."""
    return isolated(mesh_from, path, place, named, seconds=LOOK_SECONDS)


def read(table: BodyTable, path: Path, place: Placing, content: bytes) -> Found:
    """Content of the file of a part."""
    named = tuple(table.materials)
    try:
        if table.step is not None:
            seen = isolated(look, str(path), place, named, seconds=LOOK_SECONDS)
            groups = _groups(table, seen.volumes, seen.rest)
            return Found(seen.points, seen.triangles, seen.sides, seen.volume, groups)
        sha = hashlib.sha256(content).hexdigest()
        found = file_mesh(str(path), sha, place, named)
    except (IsolatedError, MemoryError) as error:
        raise MeshError(
            f"cannot be read: the reader {error or 'ran out of memory'}; the file is broken or too "
            "large"
        ) from None
    mesh = found.mesh
    counts = tuple(int(a.shape[1]) for a in (mesh.p, mesh.edges, mesh.facets, mesh.t))
    groups = _groups(table, found.volumes(len(named) + 1), found.rest)
    own_mesh = {"element": found.element, "counts": counts, "file_materials": found.materials}
    points, triangles, sides = found.faces()
    more = (found.told, found.remarks, own_mesh, tuple(_patches(found)))
    return Found(points, triangles, sides, found.volume, groups, *more)


def _patches(found: FileMesh) -> Iterator[Patch]:
    """Named faces of a mesh: their middles by area, and their sizes."""
    for name, facets in found.patches.items():
        corners = found.mesh.p[:, found.mesh.facets[:, facets]]  # (3, corner, facet)
        weight = np.linalg.norm(
            np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], axis=0), axis=0
        )
        x, y, z = (float(v) for v in corners.mean(axis=1) @ weight / weight.sum())
        extent = float(np.linalg.norm(np.ptp(corners.reshape(3, -1), axis=1)))
        yield Patch(name=name, point=(x, y, z), extent=extent)


def _groups(table: BodyTable, volumes, rest: tuple[str, ...]) -> tuple[PartGroup, ...]:
    """Groups with materials of their own, and the rest where there is one."""
    if not table.materials:
        return ()
    groups = [
        PartGroup(name=name, material=material, volume=float(volume))
        for (name, material), volume in zip(table.materials.items(), volumes)
    ]
    if len(volumes) > len(groups) and volumes[-1] > 0:
        groups.append(PartGroup(name="", volume=float(volumes[-1]), members=rest))
    return tuple(groups)


def skin(found: Found) -> tuple[np.ndarray, np.ndarray]:
    """Points and triangles of the surface alone."""
    outside = (found.sides < 0).any(axis=0)
    used, triangles = np.unique(found.triangles[:, outside], return_inverse=True)
    return found.points[:, used], triangles.reshape(3, -1)


def coarser_meshes(
    table: BodyTable, paths: list[Path], place: Placing, finest: Found
) -> tuple[CoarseMesh, ...]:
    """Coarser meshes of a part; SceneError for one of another body, and for meshes out of order."""
    out, counts = [], [finest.own_mesh["counts"][3]] if paths else []
    size = np.ptp(skin(finest)[0], axis=1)
    for k in reversed(range(len(paths))):
        try:
            content = content_of(paths[k])
            found = read(table, paths[k], place, content)
        except MeshError as error:
            raise SceneError(str(error), path=("mesh", k)) from None
        off = np.append(np.ptp(skin(found)[0], axis=1) / size, found.volume / finest.volume) - 1
        if abs(off).max() > SAME_BODY:
            worst = int(abs(off).argmax())
            what = ("size along x", "size along y", "size along z", "volume")[worst]
            raise SceneError(
                f"a mesh of another body: its {what} is {100 * off[worst]:+.3g} % from that of the "
                "last one",
                path=("mesh", k),
            )
        counts.append(found.own_mesh["counts"][3])
        if not counts[-1] < counts[-2]:
            raise SceneError(
                f"has {counts[-1]} elements and the next mesh {counts[-2]}; list meshes coarse to "
                "fine",
                path=("mesh", k),
            )
        if found.own_mesh["element"] != finest.own_mesh["element"]:
            raise SceneError(
                f"is of {found.own_mesh['element']} and the last mesh of "
                f"{finest.own_mesh['element']}; only meshes of one element are a sequence",
                path=("mesh", k),
            )
        sha = hashlib.sha256(content).hexdigest()
        out.append(CoarseMesh(name=paths[k].name, path=str(paths[k]), sha256=sha))
    return tuple(reversed(out))
