"""The scene of one shaft, and the questions about it.

A shaft of cylinders and cones along y, bearings with 6x6 stiffness, lumped points (ports), and the
questions. Frozen and validated, SI inside, no numerics beyond geometry. Degrees of freedom are
everywhere in the order (x, y, z, thx, thy, thz); y runs along the shaft from its first end face.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

from pydantic import model_validator

from solidgear.core.display import Displayed
from solidgear.core.errors import SceneError
from solidgear.core.registry import addition
from solidgear.core.scene import rules
from solidgear.core.scene.ask import Ask
from solidgear.core.scene.bearing_stiffness import stiffness_entries
from solidgear.core.scene.blends import Blend
from solidgear.core.scene.corner import Corner
from solidgear.core.scene.ends import seat_masses, snap_seats
from solidgear.core.scene.feature_rules import Feature
from solidgear.core.scene.housing import ONE_HOUSING, Housing
from solidgear.core.scene.load import BearingLoad
from solidgear.core.scene.lubrication import Lubrication
from solidgear.core.scene.open_range import Uncertain
from solidgear.core.scene.outline import Outline
from solidgear.core.scene.parts import STEEL, Material, Segment
from solidgear.core.scene.patches import off_patches
from solidgear.core.scene.point_mass import PointMass
from solidgear.core.scene.stations import Bearing, Port
from solidgear.core.scene.tables import parts
from solidgear.core.scene.typed import Model
from solidgear.core.scene.units import AxialSpring

if TYPE_CHECKING:
    BodyFile: TypeAlias = Any
else:
    BodyFile = parts().Body


class Scene(Displayed, Model):
    """A shaft on its bearings; read one with `solidgear.load`, or make one with `Scene.from_parts`.

    Attributes
    ----------
    title, name, source : str
        `source` holds where the data come from.
    segments : tuple of Segment
        End to end from y = 0.
    material : Material
        Material of segments without one.
    bearings : tuple of Bearing
    masses : tuple of PointMass
    features : tuple of Keyway, Flat or CrossHole
        Cuts and teeth, which are not of revolution.
    body : BodyFile or None
        The part from a file, whose round part the segments are.
    blends : tuple of Fillet or Chamfer
        At the edges of the shaft, which stays of revolution.
    housing_axial : float or None
        Spring along y between the common bearing housing and ground, N/m.
    housing : Housing or None
        A rigid housing of all bearings on a 6x6 spring; in place of `housing_axial`.
    port : Port
        The lumped point; with several, the main one.
    further_ports : tuple of Port
        Other lumped points, such as a second gear.
    load : BearingLoad or None
        Load on the shaft at the main port, under which bearings of catalogue data settle.
    lubrication : Lubrication or None
    uncertain : tuple of Uncertain
        Ranges of entries, as factors.
    ask : Ask

    Raises
    ------
    SceneError
        Every problem of its parts, of segments that do not fit, and of seats that do not lie on
        it.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> [segment.name for segment in scene.segments], scene.length
    (['left', 'middle', 'right'], 0.42)
    >>> stiff = scene.with_attachment("rigid").with_bearing_scale(10.0)
    >>> stiff.port.attachment, round(float(stiff.bearings[0].stiffness[0, 0]) / 1e9, 6)
    ('rigid', 4.0)
    """

    shown: ClassVar[str] = "scene"

    title: str = ""
    name: str = "scene"
    source: str = ""
    segments: tuple[Segment, ...]
    material: Material = STEEL
    bearings: tuple[Bearing, ...] = ()
    masses: tuple[PointMass, ...] = ()
    features: tuple[Feature, ...] = ()
    body: BodyFile | None = None
    blends: tuple[Blend, ...] = ()
    housing_axial: AxialSpring | None = None
    housing: Housing | None = None
    port: Port
    further_ports: tuple[Port, ...] = ()
    load: BearingLoad | None = None
    lubrication: Lubrication | None = None
    uncertain: tuple[Uncertain, ...] = ()
    ask: Ask = Ask()

    @model_validator(mode="after")
    def _hangs_together(self) -> Scene:
        problems = rules.shaft_problems(self.segments)
        if not problems:  # a station can be judged only on a shaft that is sound
            for name in ("bearings", "masses", "further_ports"):
                object.__setattr__(self, name, snap_seats(getattr(self, name), self.segments))
            object.__setattr__(self, "port", snap_seats([self.port], self.segments)[0])
            object.__setattr__(self, "masses", seat_masses(self.masses, self.segments))
            problems += rules.problems_between(
                self.segments,
                ports=self.ports,
                bearings=self.bearings,
                masses=self.masses,
                features=self.features,
                blends=self.blends,
            )
        problems += rules.question_problems(self.ports, self.ask.quantities)
        if self.housing is not None and self.housing_axial is not None:
            problems.append(SceneError(ONE_HOUSING, path=("housing_axial",)))
        if problems:
            raise SceneError.of(problems)
        return self

    @classmethod
    def from_parts(
        cls,
        segments: Iterable[Segment],
        material: Material = STEEL,
        bearings: Iterable[Bearing] = (),
        port: Port | None = None,
        **rest: Any,
    ) -> Scene:
        """A scene made in Python.

        Parameters
        ----------
        segments : iterable of Segment
            End to end from y = 0. One made without a material takes `material`.
        material : Material
        bearings : iterable of Bearing
        port : Port, optional
            Without it, the middle of the longest segment, attached to all of that segment's outer
            surface.
        **rest
            title, name, source, housing_axial, housing, further_ports, ask.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            As for `Scene`.

        Examples
        --------
        >>> from solidgear import Scene, Segment
        >>> rod = Segment.cylinder("rod", length=0.3, diameter=0.06)
        >>> scene = Scene.from_parts([rod])
        >>> scene.length, scene.port.y
        (0.3, 0.15)
        """
        segments = tuple(
            s if "material" in s.model_fields_set else s.with_changes(material=material)
            for s in segments
        )
        if port is None and segments:
            longest = max(segments, key=lambda s: s.length)
            port = Port(y=(longest.y0 + longest.y1) / 2, lo=longest.y0, hi=longest.y1)
        main: dict[str, Any] = {} if port is None else {"port": port}
        return cls(segments=segments, material=material, bearings=tuple(bearings), **main, **rest)

    @classmethod
    def from_dict(
        cls, tables: Mapping[str, Any], folder: str | os.PathLike = ".", name: str = "scene"
    ) -> Scene:
        """A scene from the tables of a file, as `tomllib` gives them.

        Parameters
        ----------
        tables : mapping
            By the keys of a file; numbers in SI, or texts with units.
        folder : str or path
            Names of files in the tables are relative to it.
        name : str
            Of the scene where the tables have none, and in messages.

        Returns
        -------
        Scene
            As `solidgear.load` gives it.

        Raises
        ------
        SceneError
            Every problem of the tables, by their keys.

        Examples
        --------
        >>> import solidgear as sg
        >>> tables = {
        ...     "material": "steel",
        ...     "segment": [{"kind": "cylinder", "name": "rod", "length": "300 mm", "diameter": 0.06}],
        ...     "port": {"at": "rod.middle", "attach_to": "rod"},
        ... }
        >>> scene = sg.Scene.from_dict(tables, name="rod")
        >>> scene.length, sg.Scene.from_dict(scene.to_dict()) == scene
        (0.3, True)
        """
        path = os.path.normpath(os.path.join(folder, name))
        return addition("document", "read scene")(tables, path)

    def to_dict(self) -> dict[str, Any]:
        """Tables of a file that describes the scene, as plain data in SI; `from_dict` reads them back
        equal.

        Returns
        -------
        dict
            By the keys of a file. Names of files are full paths; the stiffness that catalogue data
            have at the load of the scene stands beside them as `settled`.

        Examples
        --------
        >>> import solidgear as sg
        >>> tables = sg.load("geometry/shaft_stepped.toml").to_dict()
        >>> tables["segment"][0]
        {'kind': 'cylinder', 'name': 'left', 'length': 0.12, 'diameter': 0.05}
        """
        return addition("document", "write scene")(self)

    @property
    def length(self) -> float:
        """Length of the shaft in m."""
        return self.segments[-1].y1

    @property
    def ports(self) -> tuple[Port, ...]:
        """All lumped points, the main one first."""
        return (self.port, *self.further_ports)

    @property
    def stations(self) -> tuple[Port | Bearing | PointMass, ...]:
        """Stations on the shaft: the port, then bearings, masses on seats of their own and further
        ports; each has name, y, lo, hi (m), attachment.
        """
        seated = (m for m in self.masses if m.on is None)
        return (self.port, *self.bearings, *seated, *self.further_ports)

    @property
    def plain(self) -> Scene:
        """The same scene with segments alone: a body of revolution."""
        if not self.features and self.body is None:
            return self
        return self.with_changes(features=(), body=None, **off_patches(self))

    @cached_property
    def settled(self) -> Scene:
        """The same scene with a stiffness for every bearing, that of catalogue data at their load."""
        if all(bearing.matrix is not None for bearing in self.bearings):
            return self
        return addition("document", "settle scene")(self)

    @cached_property
    def outline(self) -> Outline[Segment]:
        """Lines and arcs of the meridian."""
        return Outline(self.segments, [blend.corner(self.segments) for blend in self.blends])

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Edges with fillets and chamfers."""
        return self.outline.corners

    @property
    def steps(self) -> tuple[float, ...]:
        """y (m) where the outer radius jumps, end faces left out."""
        return self.outline.steps

    def with_changes(self, **changes: Any) -> Scene:
        """A validated copy with some fields replaced.

        Parameters
        ----------
        **changes
            Fields by name; constants of a new `material` also replace those of the old one in the
            segments that have them from it, and under a new `load` bearings of catalogue data wait
            for their stiffness again.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            As for `Scene`.
        """
        if "material" in changes and "segments" not in changes:
            changes["segments"] = tuple(
                s.with_changes(material=s.material.following(self.material, changes["material"]))
                for s in self.segments
            )
        if changes.get("load", self.load) != self.load and "bearings" not in changes:
            changes["bearings"] = tuple(b.unsettled for b in self.bearings)
        return super().with_changes(**changes)

    def with_attachment(self, attachment: str) -> Scene:
        """The same scene with ports, bearings and masses attached in one way; faces stay sections.

        Parameters
        ----------
        attachment : {'average', 'rigid', 'section'}

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            An unknown attachment, or two rigid surfaces that overlap.
        """
        port, *further = (p.with_changes(attachment=attachment) for p in self.ports)
        return self.with_changes(
            port=port,
            further_ports=tuple(further),
            bearings=tuple(b.attached(attachment) for b in self.bearings),
            masses=tuple(m.attached(attachment) for m in self.masses),
        )

    def with_seat_width(self, width: float | str) -> Scene:
        """The same scene with every bearing seat of one width.

        Parameters
        ----------
        width : float or str
            m, or a text such as ``"20 mm"``.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            A width that is no positive length, or seats that then overlap or leave the shaft.
        """
        return self.with_changes(
            bearings=tuple(b.with_changes(seat_width=width) for b in self.bearings)
        )

    def with_material(self, **changes: Any) -> Scene:
        """The same scene with constants replaced in the default material and in every segment.

        Parameters
        ----------
        **changes
            `E` (Pa), `nu` or `density` (kg/m3), as numbers or texts with units.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            A constant out of its range.

        Examples
        --------
        >>> from solidgear import Scene, Segment
        >>> rod = Segment.cylinder("rod", length=0.3, diameter=0.06)
        >>> Scene.from_parts([rod]).with_material(E="70 GPa", density=2700).segments[0].material.E
        70000000000.0
        """
        segments = tuple(
            s.with_changes(material=s.material.with_changes(**changes)) for s in self.segments
        )
        body = None if self.body is None else self.body.with_material(**changes)
        return self.with_changes(
            material=self.material.with_changes(**changes), segments=segments, body=body
        )

    def with_bearing_scale(self, factor: float) -> Scene:
        """The same scene with every bearing's stiffness, series springs included, multiplied.

        Parameters
        ----------
        factor : float
            Above zero.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            A factor that is not above zero.
        """
        return self.with_changes(bearings=tuple(b.scaled(factor) for b in self.bearings))

    def with_port(self, **changes: Any) -> Scene:
        """The same scene with fields of the port replaced.

        Parameters
        ----------
        **changes
            Such as ``y=0.03``; the span stays unless given too.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            A port off the shaft.
        """
        return self.with_changes(port=self.port.with_changes(**changes))

    def with_main_port(self, name: str) -> Scene:
        """The same scene judged and condensed at another lumped point.

        Parameters
        ----------
        name : str
            Of one of `ports`.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            If there is none of that name.

        Examples
        --------
        >>> import solidgear as sg
        >>> scene = sg.load("geometry/intermediate_shaft.toml")
        >>> [port.name for port in scene.ports]
        ['wheel', 'pinion']
        >>> [port.name for port in scene.with_main_port("pinion").ports]
        ['pinion', 'wheel']
        """
        ports = {port.name: port for port in self.ports}
        if name not in ports:
            raise SceneError(rules.no_such_point(name, ports), field="port")
        first = ports.pop(name)
        return self.with_changes(port=first, further_ports=tuple(ports.values()))

    def as_dict(self) -> dict[str, Any]:
        """Return everything resolved, in SI, as plain data that JSON can hold."""
        if self.settled is not self:
            return self.settled.as_dict()
        data = self.model_dump(mode="json")
        for key in ("masses", "features", "blends", "further_ports", "uncertain"):
            if not data[key]:
                del data[key]
        for row, corner in zip(data.get("blends", ()), self.corners):
            lo, hi = corner.span
            row |= {"edge": "root" if corner.root else "rim", "lo": lo, "hi": hi}
            row |= {"corner": [corner.r, corner.y], "outline": [list(p) for p in corner.points()]}
            row |= {"owner": self.segments[corner.owner].name}
        for row, segment in zip(data["segments"], self.segments):
            row["length"] = segment.length
        for row, bearing in zip(data["bearings"], self.bearings):
            row |= {
                "lo": bearing.lo,
                "hi": bearing.hi,
                "stiffness": bearing.stiffness.tolist(),
                "entries": stiffness_entries(row.pop("matrix")),
            }
            if bearing.scale == 1:
                del row["scale"]
            for key in ("catalogue", "support", "hold", "face", "housing"):
                if row[key] is None:
                    del row[key]
            if bearing.housing is not None:
                row["housing"] = bearing.housing.entries
        if self.housing is not None:
            data["housing"] = {"y": self.housing.y, "entries": self.housing.entries}
        for key in ("load", "lubrication", "body", "housing"):
            if data[key] is None:
                del data[key]
        for key in ("groups", "told", "mixed", "remarks"):
            if not data.get("body", {}).get(key, True):
                del data["body"][key]
        for row, mass in zip(data.get("masses", ()), self.masses):
            carrier = next(s for s in self.stations if s.name == mass.station)
            row |= {"y": carrier.y, "lo": carrier.lo, "hi": carrier.hi}
            row |= {"attachment": carrier.attachment, "matrix": mass.matrix.tolist()}
        return data | {"length": self.length, "steps": list(self.steps)}
