"""A part from a STEP or mesh file in place of segments: its table, and what is known of it.

The segments of such a scene are the body of revolution inside the part, which was recognised when
the file was read.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import BeforeValidator, Field, model_validator

from solidgear.errors import SceneError, listed
from solidgear.scene.materials import by_name
from solidgear.scene.parts import Material, Model, Segment
from solidgear.scene.units import Length, Mass, PositiveLength, quantity

#: units of length of a file, m
UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 0.0254, "in": 0.0254}
Unit = Literal["mm", "cm", "m", "inch", "in"]
Axis = Literal["x", "y", "z", "-x", "-y", "-z"]
#: least share of the cylinder of a seat that must be there
LEAST_SEAT = 0.5
#: relative difference of the mass of a part from what it is checked against
MASS_CHECK = 1e-2
#: relative difference of diameters that are one
SAME_DIAMETER = 1e-3
#: share of the surface and relative difference of volume to which a part is its segments
ALL_ROUND, SAME_VOLUME = 1 - 1e-9, 1e-6


def _place(value: Any) -> Any:
    """A length along the axis, or three."""
    if value is None:
        return None
    if isinstance(value, (list, tuple)):
        if len(value) != 3:
            raise SceneError("must be one length along the axis, or three: a point on the axis")
        return tuple(quantity(entry, "length") for entry in value)
    return quantity(value, "length")


Origin = Annotated[float | tuple[float, float, float] | None, BeforeValidator(_place)]


class BodyTable(Model):
    """The [body] of a scene file."""

    step: str | None = None
    mesh: str | None = None
    unit: Unit | None = None
    axis: Axis = "y"
    origin: Origin = None
    size_check: Annotated[list[PositiveLength], Field(min_length=2, max_length=2)] | None = None
    mass_check: Mass | None = None
    #: by the name or number of a group of the file
    materials: dict[str, Annotated[Material, BeforeValidator(by_name)]] = {}

    @model_validator(mode="after")
    def _one_file(self):
        given = [key for key in ("step", "mesh") if getattr(self, key) is not None]
        if not given:
            raise SceneError(
                'this key is missing; name a file: step = "part.step", or mesh = "part.msh"',
                path=("step",),
            )
        if len(given) == 2:
            raise SceneError("give either step or mesh, not both", path=("mesh",))
        if self.mesh is not None and self.unit is None:
            raise SceneError(
                f"this key is missing: a mesh file does not say it; one of {', '.join(UNITS)}",
                path=("unit",),
            )
        return self

    @property
    def key(self) -> str:
        """The key that names the file."""
        return "step" if self.step is not None else "mesh"

    @property
    def file(self) -> str:
        """The file as written."""
        return self.step if self.step is not None else str(self.mesh)


class SeatTable(Model):
    """A stretch of a cylinder of the part, counted from the origin of the body."""

    diameter: PositiveLength
    from_: Length = Field(alias="from")
    to: Length

    @model_validator(mode="after")
    def _long(self):
        if self.to <= self.from_:
            raise SceneError("must lie beyond from", path=("to",))
        return self


Triple = tuple[float, float, float]


class PartGroup(Model):
    """What of a part from a file is of one material.

    Attributes
    ----------
    name : str
        Of the group of elements or the solid in the file; empty for all the rest.
    material : Material or None
        None is that of the scene.
    volume : float
        m^3.
    members : tuple of str
        Of the rest: groups of the file with elements in it.
    """

    name: str
    material: Material | None = None
    volume: float
    members: tuple[str, ...] = ()

    @property
    def said(self) -> str:
        """Its name in a sentence."""
        if self.name:
            return f'"{self.name}"'
        return f"the rest{self.members and f' ({listed(self.members, 6)})' or ''}"


class BodyFile(Model):
    """A part from a file, as far as a scene knows it.

    Attributes
    ----------
    kind : {'step', 'mesh'}
    name : str
        Of the file, without its folder.
    path : str
        Where it is; no part of what identifies the body.
    sha256 : str
        Of what is in it.
    unit : float
        m for each unit of length of the file.
    turn, foot
        Its place in the scene: ``turn @ (unit * x - foot)``, m.
    volume : float
        m^3.
    round_share : float
        Share of its surface, faces across the axis left out, that is of revolution.
    round_volume : float
        Of the segments over that of the part.
    facets : float
        Volume between round surfaces and the facets that a mesh file has of them, over that of the
        part: so far its volume may be off of a part that is round.
    element : str
        Of a mesh file.
    counts : tuple of int or None
        Vertices, edges, faces and cells of a mesh file.
    groups : tuple of PartGroup
        What has a material of its own, and the rest; empty where all of it is of one.
    told : tuple of str
        Groups of the file that tell materials, none of which a scene names.
    mixed : tuple of str
        Segments of the round part that are of several materials across.
    remarks : tuple of str
        What is odd about the file.

    Raises
    ------
    SceneError
        A field that is missing.

    Examples
    --------
    >>> import solidgear as sg
    >>> body = sg.load("geometry/shaft_step.toml").body
    >>> body.name, body.round
    ('shaft_step.step', False)
    """

    kind: Literal["step", "mesh"]
    name: str
    path: str = Field(exclude=True, repr=False)
    sha256: str
    unit: float
    turn: tuple[Triple, Triple, Triple]
    foot: Triple
    volume: float
    round_share: float
    round_volume: float
    facets: float = 0.0
    element: str = ""
    counts: tuple[int, int, int, int] | None = None
    groups: tuple[PartGroup, ...] = ()
    told: tuple[str, ...] = ()
    mixed: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def what(self) -> str:
        """What it is in words."""
        return "part of several materials side by side," if self.mixed else "part"

    @property
    def round(self) -> bool:
        """Whether it is its segments, and nothing else."""
        if self.mixed:
            return False
        off = abs(self.round_volume - 1)
        return self.round_share >= ALL_ROUND and off <= SAME_VOLUME + self.facets

    @property
    def doubts(self) -> tuple[str, ...]:
        """Sentences on what its file may not mean."""
        out = [f"{self.name}: {remark}" for remark in self.remarks]
        if self.told:
            out.append(
                f"{self.name} has groups {listed(self.told, 12)}, and all of it is taken to be of "
                "[material]; where they are of others, name them under materials of the [body]"
            )
        return tuple(out)

    def materials(self, usual: Material) -> tuple[Material, ...]:
        """Of its groups in their order.

        Parameters
        ----------
        usual : Material
            That of the scene.
        """
        return tuple(g.material or usual for g in self.groups) or (usual,)

    def mass(self, usual: Material) -> float:
        """Of the whole part, kg.

        Parameters
        ----------
        usual : Material
            That of the scene.
        """
        if not self.groups:
            return usual.density * self.volume
        return sum(m.density * g.volume for m, g in zip(self.materials(usual), self.groups))

    def with_material(self, **changes: Any) -> BodyFile:
        """The same part with constants replaced in the materials of its groups.

        Parameters
        ----------
        **changes
            `E`, `nu` or `density`.
        """
        groups = tuple(
            g.with_changes(material=g.material.with_changes(**changes)) if g.material else g
            for g in self.groups
        )
        return self.with_changes(groups=groups)

    @property
    def one_mesh(self) -> bool:
        """Whether its mesh is what it is, and no finer one can be made."""
        return self.kind == "mesh"


def mean_material(materials: Sequence[Material], shares: Sequence[tuple[int, float]]) -> Material:
    """One material for several side by side: stretched together they are as stiff and as heavy.

    Parameters
    ----------
    materials : sequence of Material
    shares : sequence of (int, float)
        Places of materials, and shares of the volume that add up to 1.

    Examples
    --------
    >>> steel = Material(E=200e9, nu=0.3, density=8000)
    >>> light = Material(E=100e9, nu=0.3, density=2000)
    >>> mean = mean_material([steel, light], [(0, 0.25), (1, 0.75)])
    >>> mean.E, mean.density
    (125000000000.0, 3500.0)
    """
    if len(shares) == 1:
        return materials[shares[0][0]]
    parts = [(materials[place], share) for place, share in shares]
    modulus = sum(share * m.E for m, share in parts)
    return Material(
        E=modulus,
        nu=sum(share * m.E * m.nu for m, share in parts) / modulus,
        density=sum(share * m.density for m, share in parts),
    )


class Recognised(NamedTuple):
    """A part and the body of revolution inside it.

    Attributes
    ----------
    body : BodyFile
    walls : sequence of (y0, y1, outer0, outer1, inner0, inner1)
        Frusta end to end from y = 0, m.
    origin : float
        Where the origin of the body lies, m from the lower end.
    cylinders : sequence of (diameter, y0, y1)
        Of its surface, m.
    seat_share : callable
        ``seat_share(radius, lo, hi)``: area of the surface that lies on a cylinder between two
        places, over that of the cylinder.
    shares : tuple of tuple of (int, float)
        Of each frustum: groups of the body and their shares; empty for a body without groups.
    """

    body: BodyFile
    walls: tuple[tuple[float, ...], ...]
    origin: float
    cylinders: tuple[tuple[float, float, float], ...]
    seat_share: Callable[[float, float, float], float]
    shares: tuple[tuple[tuple[int, float], ...], ...] = ()

    def segments(self, material: Material) -> list[Segment]:
        """Its frusta, named s1, s2 and so on.

        Parameters
        ----------
        material : Material
            That of the scene.
        """
        names = ("y0", "y1", "outer0", "outer1", "inner0", "inner1")
        materials = self.body.materials(material)
        return [
            Segment(
                name=f"s{k}",
                material=mean_material(materials, share),
                **dict(zip(names, wall)),
            )
            for k, (wall, share) in enumerate(
                zip(self.walls, self.shares or [((0, 1.0),)] * len(self.walls)), 1
            )
        ]

    def span(self, seat: SeatTable) -> tuple[float, float]:
        """Ends of a seat, m from the lower end.

        Parameters
        ----------
        seat : SeatTable

        Raises
        ------
        SceneError
            Where the part has no such cylinder, or less than half of it.
        """
        lo, hi = seat.from_ + self.origin, seat.to + self.origin
        near = [c for c in self.cylinders if abs(c[0] / seat.diameter - 1) <= SAME_DIAMETER]
        if not near:
            there = listed(
                f"{1e3 * d:.6g} mm" for d in sorted({round(c[0], 7) for c in self.cylinders})
            )
            raise SceneError(
                f"the part has no cylinder of this diameter; there are {there or 'none'}",
                path=("diameter",),
            )
        share = self.seat_share(near[0][0] / 2, lo, hi)
        if share < LEAST_SEAT:
            raise SceneError(
                f"only {100 * share:.0f} % of this cylinder is there, at least "
                f"{100 * LEAST_SEAT:.0f} % is wanted; cylinders of this diameter reach from "
                + ", ".join(
                    f"{1e3 * (a - self.origin):.6g} to {1e3 * (b - self.origin):.6g} mm"
                    for _, a, b in near
                ),
                path=("from",),
            )
        return lo, hi


#: reads the part that a table of a file in some folder names
Reader = Callable[[BodyTable, Path], Recognised]


def unread(table: BodyTable, folder: Path) -> Recognised:
    """A reader that reads no parts.

    Raises
    ------
    SceneError
        Always.
    """
    raise SceneError(
        "a part from a file is read by solidgear.load alone; a train or a study of bearings takes "
        "segments",
        path=("body", table.key),
    )
