"""The scene of one shaft, and the questions about it.

A shaft of cylinders and cones along y, bearings with 6x6 stiffness, lumped points (ports), and the
questions. Frozen and validated, SI inside, no numerics beyond geometry. Degrees of freedom are
everywhere in the order (x, y, z, thx, thy, thz); y runs along the shaft from its first end face.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property, partial
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeAlias

from pydantic import BeforeValidator, PrivateAttr, model_serializer, model_validator

from solidgear.core.display import Displayed
from solidgear.core.errors import SceneError
from solidgear.core.registry import addition
from solidgear.core.scene import rules
from solidgear.core.scene.ask import Ask
from solidgear.core.scene.blends import Blend
from solidgear.core.scene.corner import Corner
from solidgear.core.scene.document import Origin, read_tables
from solidgear.core.scene.ends import seat_masses, snap_seats
from solidgear.core.scene.feature_rules import Feature
from solidgear.core.scene.gravity import Direction
from solidgear.core.scene.housing import ONE_HOUSING, Housing
from solidgear.core.scene.load import BearingLoad
from solidgear.core.scene.load_case import LoadCase
from solidgear.core.scene.load_rules import load_problems, named_case, seat_loads
from solidgear.core.scene.lubrication import Lubrication
from solidgear.core.scene.materials import by_name
from solidgear.core.scene.open_range import Uncertain
from solidgear.core.scene.outline import Outline
from solidgear.core.scene.parts import STEEL, Material, Segment
from solidgear.core.scene.patches import off_patches
from solidgear.core.scene.point_mass import PointMass
from solidgear.core.scene.shaft_load import AlongAxis, ShaftLoad
from solidgear.core.scene.shapes import places_on
from solidgear.core.scene.stations import Bearing, Port
from solidgear.core.scene.tables import paired, parts
from solidgear.core.scene.typed import Model, Problems
from solidgear.core.scene.units import AxialSpring

#: fields under which bearings of catalogue data settle
LOADED = ("load", "loads", "cases", "turns", "weight")

if TYPE_CHECKING:
    BodyFile: TypeAlias = Any
else:
    BodyFile = parts().Body


def _several(value: Any) -> tuple:
    """Return the things of a field of one or of several."""
    return value if isinstance(value, tuple) else (value,)


def _paths_of(bearings: Iterable[str]) -> tuple[str, ...]:
    """Return how paths of entries of bearings begin."""
    return tuple(f"bearing.{name}." for name in bearings)


def _end_to_end(segments: Iterable[Segment], material: Material | str) -> Iterator[Segment]:
    """Yield segments at their places, those without one behind each other, and with a material."""
    y = 0.0
    for segment in segments:
        segment = segment.beginning_at(y)
        y = segment.y1
        has_material = "material" in segment.model_fields_set
        yield segment if has_material else segment.with_changes(material=material)


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
        The lumped point; with several, the main one. A file may have none: then what asks for it
        raises SceneError.
    further_ports : tuple of Port
        Other lumped points, such as a second gear.
    load : BearingLoad or None
        Load on the shaft at the main port, under which bearings of catalogue data settle.
    loads : tuple of ShaftLoad
        Loads at any places, in place of `load`.
    cases : tuple of LoadCase
        Which of the loads act together; without any all do. Bearings of catalogue data have the
        stiffness of the first.
    torque_at : str or None
        Station where torques that are left leave the shaft.
    turns : {'+y', '-y'} or None
        Sense in which the shaft turns.
    weight : str or None
        Direction of the weight of the shaft and of the masses on it, such as '-z', in every case.
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
    _aliases: ClassVar[Mapping[str, str]] = {"port": "main_port"}

    title: str = ""
    name: str = "scene"
    source: str = ""
    segments: tuple[Segment, ...]
    material: Annotated[Material, BeforeValidator(by_name)] = STEEL
    bearings: tuple[Bearing, ...] = ()
    masses: tuple[PointMass, ...] = ()
    features: tuple[Feature, ...] = ()
    body: BodyFile | None = None
    blends: tuple[Blend, ...] = ()
    housing_axial: AxialSpring | None = None
    housing: Housing | None = None
    main_port: Port | None = None
    further_ports: tuple[Port, ...] = ()
    load: BearingLoad | None = None
    loads: tuple[ShaftLoad, ...] = ()
    cases: tuple[LoadCase, ...] = ()
    torque_at: str | None = None
    turns: AlongAxis | None = None
    weight: Direction | None = None
    lubrication: Lubrication | None = None
    uncertain: tuple[Uncertain, ...] = ()
    ask: Ask = Ask()
    _origin: Origin = PrivateAttr(Origin())

    @model_serializer(mode="wrap")
    def _in_words(self, dump: Any) -> dict[str, Any]:
        words = self._words_by_field()
        return {words.get(name, name): value for name, value in dump(self).items()}

    @model_validator(mode="after")
    def _hangs_together(self) -> Scene:
        problems = rules.shaft_problems(self.segments)
        if not problems:  # a station can be judged only on a shaft that is sound
            self._place()
            for name in ("bearings", "masses", "further_ports"):
                object.__setattr__(self, name, snap_seats(getattr(self, name), self.segments))
            for port in snap_seats(self.ports[:1], self.segments):
                object.__setattr__(self, "main_port", port)
            object.__setattr__(
                self, "masses", seat_masses(self.masses, self.segments, self._stations())
            )
            stations = [*self._stations(), *(mass.name for mass in self.masses)]
            object.__setattr__(self, "loads", seat_loads(self.loads, self.segments, stations))
            things: dict[str, Any] = {"ports": self.ports} | {
                key: getattr(self, key) for key in ("bearings", "masses", "loads")
            }
            problems += rules.problems_between(
                self.segments, features=self.features, blends=self.blends, **things
            )
            acting = {key: getattr(self, key) for key in ("load", "cases", "torque_at", "turns")}
            problems += load_problems(**things, **acting)
        problems += rules.question_problems(self.ports, self.ask.quantities)
        if self.housing is not None and self.housing_axial is not None:
            problems.append(SceneError(ONE_HOUSING, path=("housing_axial",)))
        if problems:
            raise SceneError.of(problems)
        return self

    def _stations(self) -> set[str]:
        """Return the names of points and bearings that may carry a mass."""
        return {station.name for station in (*self.ports, *self.bearings)}

    def _place(self) -> None:
        """Put things made by words of a file on the shaft, bearings first, which others refer to."""
        kinds = ("bearings", "masses", "loads", "features", "blends", "further_ports")
        names = (*kinds, "main_port", "housing")
        things: dict[str, Any] = {key: getattr(self, key) for key in names}
        things = {key: value for key, value in things.items() if value is not None}
        if all(t.words is None for value in things.values() for t in _several(value)):
            return
        places, problems = places_on(self.segments, self.body), Problems()
        for key, value in things.items():
            several = isinstance(value, tuple)
            placed = []
            for k, thing in enumerate(_several(value)):
                path = (key, k) if several else (key.removeprefix("main_"),)
                placed.append(problems.read(partial(thing.placed_on, places, path)))
                if key == "bearings" and placed[-1] is not None:
                    places.add(f"bearing.{thing.name}", placed[-1].y)
            if None not in placed:
                object.__setattr__(self, key, tuple(placed) if several else placed[0])
        problems.raise_any()

    @classmethod
    def from_parts(
        cls,
        segments: Iterable[Segment],
        material: Material | str = STEEL,
        bearings: Iterable[Bearing] = (),
        port: Port | None = None,
        arrangement: Any = None,
        **rest: Any,
    ) -> Scene:
        """A scene made in Python.

        Parameters
        ----------
        segments : iterable of Segment
            End to end from y = 0. One made without a material takes `material`, and one without a
            place begins where the one before it ends.
        material : Material or str
            Constants, or the name of a material.
        bearings : iterable of Bearing
            Bearings of catalogue data settle when their stiffness is first asked for.
        port : Port, optional
            Without it, the middle of the longest segment, attached to all of that segment's outer
            surface.
        arrangement : {'O', 'X'} or dict, optional
            Mounting of two single bearings without ``holds``, or with their names,
            ``{"O": ["A", "B"]}``.
        **rest
            Other fields, such as title, name, masses, features, further_ports, load, ask.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            As for `Scene`.

        Examples
        --------
        >>> from solidgear import Port, Scene, Segment
        >>> rod = Segment.cylinder("rod", length=0.3, diameter=0.06)
        >>> scene = Scene.from_parts([rod])
        >>> scene.length, scene.port.y
        (0.3, 0.15)
        >>> seat = Segment.cylinder("seat", length="40 mm", diameter="50 mm")
        >>> gear = Port(name="gear", at="rod.middle", attach_to="rod")
        >>> scene = Scene.from_parts([seat, rod], "42CrMo4", port=gear)
        >>> scene.segments[1].y0, scene.port.y
        (0.04, 0.19)
        """
        segments = tuple(_end_to_end(segments, material))
        if not segments:
            raise SceneError("a scene needs at least one segment", path=("segments",))
        if port is None and "main_port" not in rest:
            longest = max(segments, key=lambda s: s.length)
            port = Port(y=(longest.y0 + longest.y1) / 2, lo=longest.y0, hi=longest.y1)
        rest.setdefault("main_port", port)
        bearings, pairs = paired(tuple(bearings), arrangement)
        scene = cls(segments=segments, material=material, bearings=bearings, **rest)
        turned = {
            k: scene.bearings[k].held_towards(way)
            for pair in pairs
            for k, way in pair.ways([scene.bearings[k].y for k in pair.bearings])
        }
        if not turned:
            return scene
        return scene.with_changes(
            bearings=tuple(turned.get(k, bearing) for k, bearing in enumerate(scene.bearings))
        )

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
        read = addition("document", "read scene")
        return read_tables(tables, folder, name, "scene", lambda d: read(d.tables, d.path))

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

    def to_toml(self, path: str | os.PathLike | None = None) -> str:
        """The file of the scene: that which it was read from with its words and comments, where entries
        that have changed since are written anew.

        Parameters
        ----------
        path : str or path, optional
            File to write, whole or not at all. Its name is that of the scene, unless the scene has
            another, and files are named from its folder.

        Returns
        -------
        str
            Text that `solidgear.load` reads back equal: without a path wherever it lies, for it holds
            the name of the scene and full paths of files.

        Raises
        ------
        SolidgearError
            A file that cannot be written.

        Examples
        --------
        >>> import solidgear as sg
        >>> scene = sg.load("geometry/shaft_stepped.toml")
        >>> bearing = scene.bearings[0].with_changes(seat_width="22 mm")
        >>> changed = scene.with_changes(bearings=(bearing, *scene.bearings[1:]))
        >>> before, after = (s.to_toml().splitlines() for s in (scene, changed))
        >>> [line for line in after if line not in before]
        ['seat_width = "22 mm"']
        """
        return addition("document", "text of scene")(self, path)

    @property
    def document(self) -> Any:
        """Document that the scene was read from, whatever has been changed since; None of one made in
        Python.
        """
        return self._origin.document

    @property
    def as_read(self) -> Any:
        """Document that the scene was read from; None of one that has changed since."""
        return self.document if self._origin.thing == self else None

    def read_from(self, document: Any) -> Scene:
        """Return the same scene with the document that it was read from."""
        out = self.unjudged()
        out._origin = Origin(document, out.unjudged())  # a copy: no circle through its origin
        return out

    @property
    def length(self) -> float:
        """Length of the shaft in m."""
        return self.segments[-1].y1

    def segments_at(self, y: float) -> list[Segment]:
        """Return the segments at a place along the shaft, m: both where two meet.

        Examples
        --------
        >>> import solidgear as sg
        >>> first = sg.Segment.cylinder("a", length=0.1, diameter=0.03)
        >>> further = sg.Segment.cylinder("b", y0=0.1, length=0.1, diameter=0.03)
        >>> scene = sg.Scene.from_parts([first, further])
        >>> [[s.name for s in scene.segments_at(y)] for y in (0.05, 0.1)]
        [['a'], ['a', 'b']]
        """
        return [segment for segment in self.segments if segment.y0 <= y <= segment.y1]

    @property
    def port(self) -> Port:
        """The main lumped point; SceneError where there is none."""
        if self.main_port is None:
            raise rules.without_point(self)
        return self.main_port

    @property
    def ports(self) -> tuple[Port, ...]:
        """All lumped points, the main one first; none of a scene without."""
        return () if self.main_port is None else (self.main_port, *self.further_ports)

    @property
    def stations(self) -> tuple[Port | Bearing | PointMass, ...]:
        """Stations on the shaft: the port, then bearings, masses and loads on seats of their own and
        further ports; each has name, y, lo, hi (m), attachment.
        """
        seated = (m for m in self.masses if m.on is None)
        loaded = (load.seat for load in self.loads if load.seat is not None)
        return (*self.ports[:1], *self.bearings, *seated, *loaded, *self.further_ports)

    @property
    def is_loaded(self) -> bool:
        """True where a load acts on the shaft."""
        return self.load is not None or bool(self.loads) or self.weight is not None

    def with_case(self, name: str | int) -> Scene:
        """The same scene with the case of a name first, under which bearings of catalogue data settle.

        Parameters
        ----------
        name : str or int
            Its name, or its number from one.

        Returns
        -------
        Scene

        Raises
        ------
        SolidgearError
            If there is none of that name.
        """
        first = named_case(self.cases, name)
        return self.with_changes(cases=(first, *(c for c in self.cases if c is not first)))

    @property
    def plain(self) -> Scene:
        """The same scene with segments alone: a body of revolution."""
        if not self.features and self.body is None:
            return self
        return self.with_changes(features=(), body=None, **off_patches(self))

    @property
    def settled(self) -> Scene:
        """The same scene with a stiffness for every bearing, that of catalogue data at their load."""
        waits = any(bearing.matrix is None for bearing in self.bearings)
        return self._at_load if waits else self

    @cached_property
    def _at_load(self) -> Scene:
        try:
            return addition("document", "settle scene")(self)
        except SceneError as error:
            raise SceneError.of(
                problem.located(self, path=("bearings", *problem.path[1:]))
                if problem.path[:1] == ("bearing",)
                else problem
                for problem in error.problems
            ) from None

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
            segments that have them from it, and with a new one or under a new `load` bearings of
            catalogue data wait for their stiffness again.

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
        loaded = any(changes.get(key, getattr(self, key)) != getattr(self, key) for key in LOADED)
        anew = "material" in changes and by_name(changes["material"]) != self.material
        if (loaded or anew) and "bearings" not in changes:
            changes["bearings"] = tuple(b.unsettled for b in self.bearings)
        if "bearings" in changes:
            changes["bearings"] = tuple(changes["bearings"])
            removed = {b.name for b in self.bearings} - {b.name for b in changes["bearings"]}
            ranges = [u for u in self.uncertain if not u.path.startswith(_paths_of(removed))]
            changes.setdefault("uncertain", tuple(ranges))
        out = super().with_changes(**changes)
        out._origin = self._origin
        return out

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
        ports = tuple(p.with_changes(attachment=attachment) for p in self.ports)
        return self.with_changes(
            port=ports[0] if ports else None,
            further_ports=ports[1:],
            bearings=tuple(b.attached(attachment) for b in self.bearings),
            masses=tuple(m.attached(attachment) for m in self.masses),
            loads=tuple(load.attached(attachment) for load in self.loads),
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
        bearings = self.settled.bearings
        return self.with_changes(bearings=tuple(b.scaled(factor) for b in bearings))

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
        return addition("document", "resolved scene")(self.settled)
