"""A part from a STEP or mesh file in place of segments: the table of a scene file, and the part once
it is read.

The segments of such a scene are the body of revolution inside the part, which was recognised when
the file was read.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import hypot, inf
from typing import Annotated, Any, ClassVar, Literal, get_args

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from solidgear.core import Length, Model, PositiveLength, SceneError, Written, listed
from solidgear.core.scene.file_materials import FileMaterial
from solidgear.core.scene.materials import MaterialName, by_name
from solidgear.core.scene.model_table import table_of
from solidgear.core.scene.outline import Torus
from solidgear.core.scene.parts import Material
from solidgear.core.scene.patches import Patch, Triple, refuse_elsewhere
from solidgear.core.scene.units import Mass, quantity

#: units of length of a file, m
UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 0.0254, "in": 0.0254}
Unit = Literal["mm", "cm", "m", "inch", "in"]
#: axes of a shaft, and the word for a body that is no shaft
AxisWord = Literal["x", "y", "z", "-x", "-y", "-z", "none"]
NONE = "none"
#: keys that name files
FILES = ("step", "mesh", "block")
#: a vector of unit length, up to rounding
UNIT = 1e-15
#: meshes of one body, coarse to fine
MOST_MESHES = 5
#: share of the surface, and relative difference of volume, within which a part equals its segments
ALL_ROUND, SAME_VOLUME = 1 - 1e-9, 1e-6


def _place(value: Any) -> Any:
    """Return a length along the axis, or three."""
    if value is None:
        return None
    if isinstance(value, (list, tuple)):
        if len(value) != 3:
            raise SceneError("must be one length along the axis, or three: a point on the axis")
        return tuple(quantity(entry, "length") for entry in value)
    return quantity(value, "length")


def _direction(value: Any) -> Any:
    """Return a word, or three numbers as a unit vector."""
    if isinstance(value, str) and value in get_args(AxisWord):
        return value
    numbers = value if isinstance(value, (list, tuple)) and len(value) == 3 else ()
    length = 0.0
    if all(type(v) in (int, float) for v in numbers):
        length = hypot(*numbers)
    if abs(length - 1) <= UNIT:  # dividing again would move the last digit
        return tuple(map(float, numbers))
    if not 0 < length < inf:
        raise SceneError(
            "must be x, y, z, -x, -y, -z or none, or three numbers: the direction of the "
            "axis in the file"
        )
    return tuple(v / length for v in numbers)


def _several(value: Any) -> Any:
    """Return a single file as a list of one."""
    return [value] if isinstance(value, str) else value


Axis = Annotated[AxisWord | Triple, BeforeValidator(_direction), Written(AxisWord | Triple)]
Origin = Annotated[
    float | tuple[float, float, float] | None,
    BeforeValidator(_place),
    Written(Length | tuple[Length, Length, Length]),
]


class BodyTable(Model):
    """The [body] of a scene file."""

    needs: ClassVar = (("step", "mesh", "block"),)

    #: name of a STEP file
    step: str | None = None
    #: name of a mesh file, or up to five of one body, coarse to fine
    mesh: Annotated[
        Annotated[list[str], Field(min_length=1, max_length=MOST_MESHES)] | None,
        BeforeValidator(_several),
        Written(str | Annotated[list[str], Field(min_length=1, max_length=MOST_MESHES)]),
    ] = None
    #: edges of a rectangular block along x, y and z, m, in place of a file
    block: list[PositiveLength] | None = None
    #: unit of length of a file that does not say
    unit: Unit | None = None
    #: axis of the shaft in the file, or "none" for a body without an axis
    axis: Axis = "y"
    #: where y = 0 lies in the file, m: along the axis, or a point on it
    origin: Origin = None
    #: length and largest diameter that the part must have, m
    size_check: Annotated[list[PositiveLength], Field(min_length=2, max_length=2)] | None = None
    #: mass that the part must have, kg
    mass_check: Mass | None = None
    #: materials by the name or number of a group of the file
    materials: dict[
        str, Annotated[Material, BeforeValidator(by_name), Written(Material | MaterialName)]
    ] = {}

    @model_validator(mode="after")
    def _one_file(self):
        keys = [key for key in ("step", "mesh", "block") if getattr(self, key) is not None]
        if not keys:
            raise SceneError(
                'this key is missing; name a file: step = "part.step", or mesh = "part.msh"',
                path=("step",),
            )
        if len(keys) > 1:
            choices = " or ".join(keys)
            raise SceneError(f"give either {choices}, not both", path=(keys[-1],))
        if self.block is not None:
            if len(self.block) != 3:
                raise SceneError("give three edges, along x, y and z", path=("block",))
            for key in sorted(self.model_fields_set - {"block", "mass_check"}):
                raise SceneError("this key belongs to a file, and a block has none", path=(key,))
        if self.axis == NONE and self.step is not None:
            raise SceneError("a body without an axis is read from a mesh file", path=("axis",))
        if self.axis == NONE and self.size_check is not None:
            raise SceneError(
                "length and diameter belong to a shaft; check a body by its mass_check",
                path=("size_check",),
            )
        return self

    @property
    def about(self) -> str:
        """Axis in a sentence."""
        return self.axis if isinstance(self.axis, str) else "its axis"

    @property
    def key(self) -> str:
        """Key that names the file."""
        return next(k for k in ("step", "mesh", "block") if getattr(self, k) is not None)

    @property
    def files(self) -> list[str]:
        """Files as written, the finest mesh last."""
        return [self.step] if self.step is not None else self.mesh or []


def check_tables(raw: Mapping[str, Any]) -> None:
    """Refuse tables of a file that a body without an axis cannot have."""
    body = raw.get("body")
    if isinstance(body, Mapping) and ("block" in body or body.get("axis") == NONE):
        refuse_elsewhere(raw, "block" if "block" in body else 'body with axis = "none"')


class PartGroup(Model):
    """Share of a part from a file that is of one material."""

    name: str  #: of the group of elements or the solid in the file; empty for the remainder
    material: Material | None = None  #: None for that of the scene
    volume: float  #: m^3
    centre: Triple = Field((0.0, 0.0, 0.0), exclude=True, repr=False)  #: m, in the scene
    members: tuple[str, ...] = ()  #: of the remainder: groups of the file with elements in it

    @property
    def label(self) -> str:
        """Name in a sentence."""
        if self.name:
            return f'"{self.name}"'
        return f"the rest ({listed(self.members, 6)})" if self.members else "the rest"


class CoarseMesh(Model):
    """A file with a coarser mesh of a part."""

    name: str
    path: str = Field(exclude=True, repr=False)
    sha256: str


class BodyFile(Model):
    """A part from a file, or a rectangular block, as far as a scene describes it.

    Examples
    --------
    >>> import solidgear as sg
    >>> body = sg.load("geometry/shaft_step.toml").body
    >>> body.name, body.round
    ('shaft_step.step', False)
    """

    kind: Literal["step", "mesh", "block"]
    name: str  #: of the file, without its folder; of a block its edges in words
    path: str = Field(exclude=True, repr=False)  #: where it is; no part of what identifies the body
    #: unit, axis, origin and checks as a file gives them, without names of files and materials; None
    #: of a block
    words: BodyTable | None = Field(None, exclude=True, repr=False)
    sha256: str  #: of the content
    unit: float  #: m for each unit of length of the file
    #: turn, foot: place in the scene: ``turn @ (unit * x - foot)``, m
    turn: tuple[Triple, Triple, Triple]
    foot: Triple
    volume: float  #: m^3
    centre: Triple = Field((0.0, 0.0, 0.0), exclude=True, repr=False)  #: of the volume, m
    #: share of the surface, without faces across the axis, that is of revolution
    round_share: float
    round_volume: float  #: of the segments over that of the part
    #: volume between round surfaces and the facets of a mesh file, over that of the part: possible
    #: error of the volume of a part that is round
    facets: float = 0.0
    beside_arcs: float = 0.0  #: largest distance of segments from the arcs that they replace, m
    tori: tuple[Torus, ...] = Field((), exclude=True, repr=False)
    #: stretches along y, m, in which a part of the surface is not round
    uneven: tuple[tuple[float, float], ...] = Field((), exclude=True, repr=False)
    element: str = ""  #: of a mesh file
    #: vertices, edges, faces and cells of a mesh file
    counts: tuple[int, int, int, int] | None = None
    #: groups with a material, and the remainder; empty where the part is of one material
    groups: tuple[PartGroup, ...] = ()
    #: groups of the file with materials, none of which a scene names
    told: tuple[str, ...] = ()
    mixed: tuple[str, ...] = ()  #: segments of the round part with several materials across
    remarks: tuple[str, ...] = ()  #: oddities of the file
    #: along x, y and z, m, of a block, or around a body without an axis
    edges: Triple | None = None
    #: coarser meshes of the same part, coarse to fine
    coarser: tuple[CoarseMesh, ...] = ()
    patches: tuple[Patch, ...] = ()  #: named faces of a body without an axis
    file_materials: tuple[FileMaterial, ...] = ()  #: that a mesh file gives its groups

    def __hash__(self) -> int:
        # words hold lists of a file, and say nothing that the rest does not
        return hash((self.kind, self.sha256, self.turn, self.foot, self.groups, self.edges))

    @property
    def sort(self) -> str:
        """Sort among features and parts."""
        return "part" if self.edges is None else "body"

    @property
    def what(self) -> str:
        """Kind in words."""
        if self.edges is not None:
            return self.kind if self.kind == "block" else "body"
        return "part of several materials side by side," if self.mixed else "part"

    @property
    def round(self) -> bool:
        """True where the part equals its segments."""
        if self.mixed:
            return False
        difference = abs(self.round_volume - 1)
        return self.round_share >= ALL_ROUND and difference <= SAME_VOLUME + self.facets

    def doubts(self, usual: Material) -> tuple[str, ...]:
        """Return doubts about the file, and about materials of the file that the scene contradicts."""
        out = [
            f"{self.name}: {remark}" for remark in (*self.remarks, *self._other_materials(usual))
        ]
        if self.told:
            out.append(
                f"{self.name} has groups {listed(self.told, 12)}, and all of it is taken to be of "
                "[material]; where they are of others, name them under materials of the [body]"
            )
        return tuple(out)

    def _other_materials(self, usual: Material) -> Iterator[str]:
        """Yield a sentence on materials of the file that differ from those of the scene."""
        group_materials = {
            group.name: group.material for group in self.groups if group.material is not None
        }
        pairs = [
            (file_material, group_materials.get(file_material.group, usual))
            for file_material in self.file_materials
        ]
        # several groups may be of one material
        different = {
            file_material.name: (file_material, m)
            for file_material, m in pairs
            if not file_material.is_like(m)
        }
        if not different:
            return
        sentences = [
            f"{file_material.name} with {file_material.numbers} in the units of the file, where the scene has E "
            f"{m.E / 1e9:.6g} GPa, nu {m.nu:.6g}, density {m.density:.6g} kg/m^3"
            for file_material, m in different.values()
        ]
        yield (
            f"materials of the file are not read: {listed(sentences, 4)}; write them as [material], or under "
            "materials of the [body]"
        )

    def materials(self, usual: Material) -> tuple[Material, ...]:
        """Return the materials of the groups in order, in a scene of a material."""
        return tuple(g.material or usual for g in self.groups) or (usual,)

    def mass(self, usual: Material) -> float:
        """Return the mass of the part, kg, in a scene of a material."""
        if not self.groups:
            return usual.density * self.volume
        return sum(m.density * g.volume for m, g in zip(self.materials(usual), self.groups))

    def centre_of_mass(self, usual: Material) -> Triple:
        """Return the centre of mass of the part, m, in a scene of a material."""
        if not self.groups:
            return self.centre
        masses = [m.density * g.volume for m, g in zip(self.materials(usual), self.groups)]
        x, y, z = np.average([g.centre for g in self.groups], axis=0, weights=masses)
        return float(x), float(y), float(z)

    def with_material(self, **changes: Any) -> BodyFile:
        """Return the part with constants (`E`, `nu`, `density`) replaced in the materials of groups."""
        groups = tuple(
            g.with_changes(material=g.material.with_changes(**changes)) if g.material else g
            for g in self.groups
        )
        return self.with_changes(groups=groups)

    def placed(self, point: Sequence[float]) -> Triple:
        """Return a point (m) in the axes of the file in those of the scene."""
        x, y, z = np.array(self.turn) @ (np.array(point) - self.foot)
        return float(x), float(y), float(z)

    def in_file(self, point: Sequence[float]) -> Triple:
        """Return a point (m) in the axes of the scene in those of the file: the inverse of `placed`."""
        x, y, z = np.array(self.turn).T @ np.array(point) + self.foot
        return float(x), float(y), float(z)

    @property
    def one_mesh(self) -> bool:
        """True where the mesh of the file is the only one, and no finer one can be made."""
        return self.kind == "mesh"


def written(body: BodyFile) -> dict[str, Any]:
    """Return the table of a scene file that names a part, with the full paths of its files."""
    if body.words is None:
        return {"block": list(body.edges or ())}
    files = [*(mesh.path for mesh in body.coarser), body.path]
    table = {
        body.kind: files if body.coarser else body.path,
        **table_of(body.words, leave_out=FILES),
    }
    materials = {g.name: table_of(g.material) for g in body.groups if g.material is not None}
    return table | ({"materials": materials} if materials else {})
