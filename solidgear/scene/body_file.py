"""A part from a STEP or mesh file in place of segments: its table, and what is known of it.

The segments of such a scene are the body of revolution inside the part, which was recognised when
the file was read.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import BeforeValidator, Field, model_validator

from solidgear.errors import SceneError, listed
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
    element : str
        Of a mesh file.
    counts : tuple of int or None
        Vertices, edges, faces and cells of a mesh file.

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
    element: str = ""
    counts: tuple[int, int, int, int] | None = None

    @property
    def what(self) -> str:
        """What it is in words."""
        return "part"

    @property
    def round(self) -> bool:
        """Whether it is its segments, and nothing else."""
        return self.round_share >= ALL_ROUND and abs(self.round_volume - 1) <= SAME_VOLUME

    @property
    def one_mesh(self) -> bool:
        """Whether its mesh is what it is, and no finer one can be made."""
        return self.kind == "mesh"


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
    """

    body: BodyFile
    walls: tuple[tuple[float, ...], ...]
    origin: float
    cylinders: tuple[tuple[float, float, float], ...]
    seat_share: Callable[[float, float, float], float]

    def segments(self, material: Material) -> list[Segment]:
        """Its frusta, named s1, s2 and so on."""
        names = ("y0", "y1", "outer0", "outer1", "inner0", "inner1")
        return [
            Segment(name=f"s{k}", material=material, **dict(zip(names, wall)))
            for k, wall in enumerate(self.walls, 1)
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
