"""Contents of the files of a part: surface, volume, groups and coarser meshes."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from solidgear.core import SceneError
from solidgear.core.machine.isolated import IsolatedError, isolated
from solidgear.core.meshing.placing import Placing
from solidgear.core.meshing.quality import MeshError
from solidgear.core.scene.patches import Patch
from solidgear.parts.body_file import BodyTable, CoarseMesh, PartGroup
from solidgear.parts.mesh_file import FileMesh, mesh_from
from solidgear.parts.step import survey

#: s of processor time after which a file is given up
LOOK_SECONDS = 25.0
#: largest STEP or mesh file, bytes
LARGEST = 500_000_000
#: relative difference of volumes and sizes of two meshes of one body: chords of six to a turn lack 17 %
SAME_BODY = 0.2


def content_of(path: Path) -> bytes:
    """Read the bytes of a file; SceneError where it is too large, MeshError where it cannot be
    opened.
    """
    try:
        if path.stat().st_size > LARGEST:
            raise SceneError(
                f"the file is larger than {LARGEST / 1e6:.0f} MB: simplify the part", path=("file",)
            )
        return path.read_bytes()
    except OSError as error:
        raise MeshError(f"cannot be opened: {error.strerror or error}") from None


class PartContent(NamedTuple):
    """Content of a file, in the scene."""

    points: np.ndarray  #: (3, n) on the surface and between groups, m
    triangles: np.ndarray  #: (3, t) of both
    sides: np.ndarray  #: (2, t) group on each side, -1 outside
    volume: float  #: m^3
    centre: np.ndarray  #: (3,) of the volume, m
    groups: tuple[PartGroup, ...]
    material_groups: tuple[str, ...] = ()  #: groups that stand for materials, where several do
    remarks: tuple[str, ...] = ()  #: oddities of the file
    mesh_fields: dict[str, Any] = {}  #: of a :class:`BodyFile`, where the file holds a mesh
    patches: tuple[Patch, ...] = ()


@lru_cache(maxsize=8)
def file_mesh(path: str, sha256: str, place: Placing, names: tuple[str, ...]) -> FileMesh:
    """Read the mesh of a file of some content; kept, since sweeps over other entries of a scene ask
    for it again.
    """
    return isolated(mesh_from, path, place, names, seconds=LOOK_SECONDS)


def read(table: BodyTable, path: Path, place: Placing, content: bytes) -> PartContent:
    """Read the content of the file of a part, placed in the scene."""
    names = tuple(table.materials)
    try:
        if table.step is not None:
            part = isolated(survey, str(path), place, names, seconds=LOOK_SECONDS)
            groups = _groups(table, part.volumes, part.moments, part.unnamed)
            centre = part.moments.sum(axis=0) / part.volume
            return PartContent(part.points, part.triangles, part.sides, part.volume, centre, groups)
        sha = hashlib.sha256(content).hexdigest()
        mesh_in_file = file_mesh(str(path), sha, place, names)
    except (IsolatedError, MemoryError) as error:
        raise MeshError(
            f"cannot be read: the reader {error or 'ran out of memory'}; the file is broken or too "
            "large"
        ) from None
    mesh = mesh_in_file.mesh
    points, triangles, sides = mesh_in_file.faces()
    volumes, moments = mesh_in_file.volumes(len(names) + 1)
    return PartContent(
        points,
        triangles,
        sides,
        volume=mesh_in_file.volume,
        centre=moments.sum(axis=0) / volumes.sum(),
        groups=_groups(table, volumes, moments, mesh_in_file.unnamed_groups),
        material_groups=mesh_in_file.material_groups,
        remarks=mesh_in_file.remarks,
        mesh_fields={
            "element": mesh_in_file.element,
            "counts": tuple(int(a.shape[1]) for a in (mesh.p, mesh.edges, mesh.facets, mesh.t)),
            "file_materials": mesh_in_file.materials,
        },
        patches=tuple(_patches(mesh_in_file)),
    )


def _patches(file: FileMesh) -> Iterator[Patch]:
    """Yield named faces of a mesh: their middles by area, and their sizes, m."""
    for name, facets in file.patches.items():
        corners = file.mesh.p[:, file.mesh.facets[:, facets]]  # (3, corner, facet)
        weight = np.linalg.norm(
            np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], axis=0), axis=0
        )
        x, y, z = (float(v) for v in corners.mean(axis=1) @ weight / weight.sum())
        extent = float(np.linalg.norm(np.ptp(corners.reshape(3, -1), axis=1)))
        yield Patch(name=name, point=(x, y, z), extent=extent)


def _groups(
    table: BodyTable, volumes: np.ndarray, moments: np.ndarray, unnamed: tuple[str, ...]
) -> tuple[PartGroup, ...]:
    """Return the groups with materials of their own, and the rest where there is one."""
    if not table.materials:
        return ()
    groups = [
        PartGroup(
            name=name, material=material, volume=float(volume), centre=_centre(moment, volume)
        )
        for (name, material), volume, moment in zip(table.materials.items(), volumes, moments)
    ]
    if len(volumes) > len(groups) and volumes[-1] > 0:
        centre = _centre(moments[-1], volumes[-1])
        groups.append(PartGroup(name="", volume=float(volumes[-1]), centre=centre, members=unnamed))
    return tuple(groups)


def _centre(moment: np.ndarray, volume: float) -> tuple[float, float, float]:
    """Return the centre of a volume, m, from its first moment (3,), m^4."""
    x, y, z = (float(v) / float(volume) if volume else 0.0 for v in moment)
    return x, y, z


def skin(part: PartContent) -> tuple[np.ndarray, np.ndarray]:
    """Return points (3, n) and triangles (3, t) of the surface alone."""
    outside = (part.sides < 0).any(axis=0)
    used, triangles = np.unique(part.triangles[:, outside], return_inverse=True)
    return part.points[:, used], triangles.reshape(3, -1)


def coarser_meshes(
    table: BodyTable, paths: list[Path], place: Placing, finest: PartContent
) -> tuple[CoarseMesh, ...]:
    """Read the coarser meshes of a part; SceneError for a mesh of another body, and for meshes out
    of order.
    """
    out, counts = [], [finest.mesh_fields["counts"][3]] if paths else []
    size = np.ptp(skin(finest)[0], axis=1)
    for k in reversed(range(len(paths))):
        try:
            content = content_of(paths[k])
            part = read(table, paths[k], place, content)
        except MeshError as error:
            raise SceneError(str(error), path=("mesh", k)) from None
        difference = (
            np.append(np.ptp(skin(part)[0], axis=1) / size, part.volume / finest.volume) - 1
        )
        if abs(difference).max() > SAME_BODY:
            worst = int(abs(difference).argmax())
            size_name = ("size along x", "size along y", "size along z", "volume")[worst]
            raise SceneError(
                f"a mesh of another body: its {size_name} is {100 * difference[worst]:+.3g} % from that "
                "of the last one",
                path=("mesh", k),
            )
        counts.append(part.mesh_fields["counts"][3])
        if not counts[-1] < counts[-2]:
            raise SceneError(
                f"has {counts[-1]} elements and the next mesh {counts[-2]}; list meshes coarse to "
                "fine",
                path=("mesh", k),
            )
        if part.mesh_fields["element"] != finest.mesh_fields["element"]:
            raise SceneError(
                f"is of {part.mesh_fields['element']} and the last mesh of "
                f"{finest.mesh_fields['element']}; only meshes of one element are a sequence",
                path=("mesh", k),
            )
        sha = hashlib.sha256(content).hexdigest()
        out.append(CoarseMesh(name=paths[k].name, path=str(paths[k]), sha256=sha))
    return tuple(reversed(out))
