"""From a TOML file to a `Scene`, errors named by the keys of the file.

The format is documented by the files in ``geometry``. Every problem of a file is reported at once:
each table by itself, the names by which tables refer to each other, and the places of all parts
that are sound by themselves.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, NamedTuple, TypeAlias

from pydantic import BeforeValidator, model_validator

from solidgear.core.errors import SceneError
from solidgear.core.scene import rules
from solidgear.core.scene.acting import torque_problems
from solidgear.core.scene.ask import Ask
from solidgear.core.scene.blends import BLENDS
from solidgear.core.scene.ends import seat_masses
from solidgear.core.scene.feature import OnSegment
from solidgear.core.scene.feature_rules import kinds_of_features, unknown_kind
from solidgear.core.scene.gravity import Direction
from solidgear.core.scene.housing import Housing, read_housing
from solidgear.core.scene.limits import MOST_BEARINGS, MOST_MASSES, MOST_SEGMENTS
from solidgear.core.scene.load import BearingLoad
from solidgear.core.scene.load_case import LoadCase
from solidgear.core.scene.load_rules import load_problems, seat_loads
from solidgear.core.scene.lubrication import Lubrication
from solidgear.core.scene.materials import MaterialName, by_name
from solidgear.core.scene.model import Scene
from solidgear.core.scene.parts import STEEL, Material, Segment
from solidgear.core.scene.places import Placed, Places
from solidgear.core.scene.point_mass import PointMass
from solidgear.core.scene.shaft_load import AlongAxis, ShaftLoad
from solidgear.core.scene.shapes import SHAPES, Cylinder, Shape, lay_out
from solidgear.core.scene.stations import Attachment, Bearing, Port
from solidgear.core.scene.tables import pairing, parts, with_list
from solidgear.core.scene.toml_file import (
    FileOrder,
    describes_train,
    name_of,
    parse,
    place_of,
    with_table_paths,
)
from solidgear.core.scene.typed import Holds, Model, Problems
from solidgear.core.scene.uncertain import with_ranges
from solidgear.core.scene.writing import digest_of_scene
from solidgear.core.scene.written import Kinds, Word, Written

PAIRING, PARTS = pairing(), parts()
if TYPE_CHECKING:
    Arrangement: TypeAlias = Any
    BodyTable: TypeAlias = Any
else:
    Arrangement, BodyTable = PAIRING.Words, PARTS.Table

#: reads the part that a table of a file in some folder names
Reader = Callable[[Any, Path], Any]

Table = dict[str, Any]
#: entries of the lists of a file
MOST = {"segment": MOST_SEGMENTS, "bearing": MOST_BEARINGS, "mass": MOST_MASSES}


def _kinds() -> dict[str, type[Placed]]:
    """Return what a table of features may describe: a cut, teeth, a fillet or a chamfer."""
    return {**kinds_of_features(), **BLENDS}


Feature = Annotated[Table, Kinds(_kinds, given=("name",))]
#: a range of an entry
OpenRange = Annotated[str, Word(pattern=r".*(±|\+/-|\+-|:).*")]


class _Ask(Ask):
    """The [ask] of a file, which also names the main lumped point."""

    #: name of the main lumped point; by default the first
    port: str | None = None


def _several(tables: Any) -> Any:
    """Return a single table, such as [port], as a list of one."""
    return [tables] if isinstance(tables, Mapping) else tables


#: words for the place of a load
PLACES = {"on", *ShaftLoad.Words.model_fields, "from"} - {"from_"}


def _is_at_port(load: Any) -> bool:
    """Return True for a [load] of components alone, which acts at the main lumped point."""
    keys = {*ShaftLoad.table_keys()} - {*BearingLoad.model_fields}
    return isinstance(load, Mapping) and not keys & {*load}


class SceneFile(Model):
    """A scene file; tables of stations and features are read later, once the shaft is known."""

    needs: ClassVar = (("segment", "body"), ("material", "body"))

    #: title of the shaft in tables and pages
    title: str = ""
    #: name of the scene; by default that of the file
    name: str | None = None
    #: where the numbers come from
    source: str = ""
    #: how seats and surfaces follow what they carry, unless their tables say otherwise; without it by
    #: their means, and held seats as rigid pieces
    attachment: Attachment | None = None
    #: material of segments without one: a name, or E, nu and density
    material: Annotated[Material, BeforeValidator(by_name), Written(Material | MaterialName)]
    #: file of a list of bearings (CSV) that designations are looked up in first
    bearings: str | None = None
    #: mounting of two single bearings with a contact angle: "O" or "X", or with their names, {O =
    #: ["A", "B"]}
    arrangement: Arrangement = ()
    #: the shaft from a STEP or mesh file, or a block, in place of segments
    body: BodyTable | None = None
    #: pieces of the shaft, end to end from y = 0
    segment: list[Shape]
    # read once the shaft is known
    #: bearings, each a stiffness between a seat and ground
    bearing: Annotated[list[Table], Holds(Bearing)] = []
    #: rigid masses on the shaft: discs, coupling halves, gear blanks
    mass: Annotated[list[Table], Holds(PointMass)] = []
    #: keyways, flats, holes, teeth, splines, fillets and chamfers
    feature: Annotated[list[Table], Written(list[Feature])] = []
    #: elastic housing of all bearings
    housing: Annotated[Table | None, Holds(Housing)] = None
    #: lumped points that compliances are given for, such as the middle of a gear; natural frequencies
    #: need none
    port: Annotated[
        list[Table], BeforeValidator(_several), Holds(Port), Written(Port | list[Port])
    ] = []
    #: loads on the shaft, under which catalogue bearings settle; a single table of components acts at
    #: the main lumped point
    load: Annotated[
        list[Table],
        BeforeValidator(_several),
        Holds(ShaftLoad),
        Written(BearingLoad | ShaftLoad | list[ShaftLoad]),
    ] = []
    #: which loads act together, at which speed and how long; without any all loads do
    case: tuple[LoadCase, ...] = ()
    #: point, bearing, mass or load where torques that are left leave the shaft
    torque_at: str | None = None
    #: sense in which the shaft turns, for loads with `sense`
    turns: AlongAxis | None = None
    #: direction in which the shaft and the masses on it weigh, in every case, such as `-z`
    weight: Direction | None = None
    #: lubrication of the bearings, for their modified life
    lubrication: Lubrication | None = None
    #: ranges of entries by their paths, such as "material.E" = "206 GPa ± 3 %"
    uncertain: Annotated[Table, Written(dict[str, OpenRange | dict[str, Any]])] = {}
    #: questions: number of modes, tolerance, quantities
    ask: _Ask = _Ask()


#: keys and tables of a file
KEYS = tuple(SceneFile.model_fields)


class ScenePartFile(SceneFile):
    """A scene file with a part from another file in place of segments."""

    # not needed where the groups of the part have all their own
    material: Annotated[
        Material | None, BeforeValidator(by_name), Written(Material | MaterialName)
    ] = None  # type: ignore[assignment]
    body: BodyTable
    segment: list[Shape] = []

    @model_validator(mode="after")
    def _one_shaft(self) -> ScenePartFile:
        if self.material is None and not self.body.materials:
            raise SceneError("this key is missing", path=("material",))
        for key, verb in (("segment", "describes the shaft"), ("feature", "is cut into segments")):
            if getattr(self, key):
                raise SceneError(
                    f"a [[{key}]] {verb}, as a [body] does; leave one of them out",
                    path=(key,),
                )
        return self


def load(path: str | os.PathLike, part_of: Reader = PARTS.refuse_parts) -> Scene:
    """Read a scene file, bearings of catalogue data without stiffness; `part_of` reads the part that
    a [body] names.
    """
    file_path = os.fspath(path)
    return scene_of(parse(file_path), file_path, part_of)


def scene_of(raw: Table, file_path: str, part_of: Reader = PARTS.refuse_parts) -> Scene:
    """Resolve the tables of a scene file; files that it names lie relative to `file_path`."""
    if describes_train(raw):
        raise SceneError(
            "describes a train, not one shaft; run solidgear compare, check, system-modes, "
            "response or receptance on it, or read it with solidgear.load_train"
        ).located(raw, where=place_of(file_path))
    try:
        raw = with_list(raw, Path(file_path).parent)
        return _Reading(raw, file_path, part_of).scene()
    except SceneError as error:
        if error.where:  # of a list of bearings
            raise
        # both ends of a cylinder are one diameter
        problems = {(p.path, p.reason): p for p in with_table_paths(error, raw).problems}
        order = FileOrder(raw)
        ordered = sorted(problems.values(), key=lambda problem: order.positions(problem.path))
        raise SceneError.of(ordered).located(raw, where=place_of(file_path)) from None


def _drop_tag(path: tuple) -> tuple:
    """Return a path without the kind of a segment, which pydantic puts in and no file has."""
    tagged = path[:1] == ("segment",) and path[2:3] and path[2] in SHAPES
    return (*path[:2], *path[3:]) if tagged else path


def says_unsettled(tables: Mapping[str, Any]) -> bool:
    """Return True for tables of a scene whose catalogue bearings wait for their stiffness."""
    bearings = tables.get("bearing") or ()
    return any(isinstance(t, Mapping) and t.get("settled") is False for t in bearings)


def with_settled(scene: Scene, tables: Sequence[Table]) -> Scene:
    """Return a scene with the stiffness that catalogue bearings have in their tables, where it was
    solved for this scene and no other.
    """
    settled = {
        k: t["settled"] for k, t in enumerate(tables) if isinstance(t.get("settled"), Mapping)
    }
    if not settled:
        return scene
    digest = digest_of_scene(scene)
    bearings = tuple(
        bearing.with_changes(stiffness=settled[k]["stiffness"])
        if k in settled and settled[k]["under"] == digest
        else bearing
        for k, bearing in enumerate(scene.bearings)
    )
    return scene.unjudged(bearings=bearings)


class _Row(NamedTuple):
    """A thing that was read, None without a place, and the table that it was read from."""

    thing: Any
    kind: type[Placed]
    path: tuple
    table: Table


class _Reading:
    """A file on its way to a scene; problems are gathered until the end."""

    def __init__(self, raw: Table, file_path: str, part_of: Reader):
        self.raw, self.where = raw, file_path
        self.problems = Problems()
        self.file, self.spoilt = self._tables()
        self.part: Any = None
        if (body := self.file.body) is not None:
            self.part = self.problems.read(lambda: part_of(body, Path(file_path).parent))
            self.spoilt |= set() if self.part else {"body"}
        self.places = Places(self.file.attachment, of_body="body" in raw, part=self.part)
        self._name_datums()
        sound = not {"segment", "material", "body"} & self.spoilt
        self.segments = (self.problems.read(self._shaft) if sound else None) or []
        if not self.segments:
            self.places.forget()

    def scene(self) -> Scene:
        """Return the scene, or raise all problems."""
        file, place = self.file, self.places
        paired = None
        if "arrangement" not in self.spoilt:
            paired = self.problems.read(lambda: PAIRING.read_pairs(file.arrangement, file.bearing))
        if paired is None:
            self.spoilt.add("arrangement")
        bearings = [
            self._bearing(k, table)
            for k, table in enumerate(PAIRING.readable_tables(file.bearing, paired))
        ]
        housing = None
        if (table := file.housing) is not None:
            housing = self.problems.read(lambda: read_housing(table, place), ("housing",))
        ports = [self._row(Port, ("port", k), table) for k, table in enumerate(file.port)]
        masses = [self._row(PointMass, ("mass", k), table) for k, table in enumerate(file.mass)]
        load, loads = self._loads()
        features = [row for k, t in enumerate(file.feature) for row in self._feature(k, t)]
        rows = {
            "bearings": self._turned(bearings, paired or []),
            "ports": self._main_first(ports),
            "masses": masses,
            "loads": loads,
            "features": [row for row in features if issubclass(row.kind, OnSegment)],
            "blends": [row for row in features if row.kind in BLENDS.values()],
        }
        if self.segments:
            self._judge(rows, load)
        self.problems.raise_any()
        things: dict[str, Any] = {
            key: tuple(row.thing for row in kind_rows) for key, kind_rows in rows.items()
        }
        points = things.pop("ports")
        stations = [*points, *things["bearings"], *things["masses"]]
        stations += [seated.seat for seated in things["loads"] if seated.seat is not None]
        scene = Scene.from_parts(
            self.segments,
            self._material(),
            main_port=points[0] if points else None,
            further_ports=points[1:],
            **things,
            title=file.title,
            name=name_of(self.where) if file.name is None else file.name,
            source=file.source,
            body=PARTS.with_seats(self.part, stations, self.segments) if self.part else None,
            housing_axial=housing if isinstance(housing, float) else None,
            housing=None if isinstance(housing, float) else housing,
            load=load,
            cases=file.case,
            torque_at=file.torque_at,
            turns=file.turns,
            weight=file.weight,
            lubrication=file.lubrication,
            ask=Ask(**{key: getattr(file.ask, key) for key in Ask.model_fields}),
        )
        for problem in torque_problems(scene):
            raise problem
        return with_settled(with_ranges(scene, file.uncertain, file.bearing), file.bearing)

    def _tables(self) -> tuple[SceneFile, set[str]]:
        """Return the file without spoilt keys, and these keys."""
        raw, kind = self.raw, ScenePartFile if "body" in self.raw else SceneFile
        for key, most in MOST.items():
            if isinstance(raw.get(key), list) and len(raw[key]) > most:
                plural = "masses" if key == "mass" else f"{key}s"
                raise SceneError(rules.too_many(plural, len(raw[key]), most), path=(key,))
        try:
            PARTS.check_tables(raw)
            return kind(**raw), set()
        except SceneError as error:
            problems = [
                problem.located(raw, path=_drop_tag(problem.path)) for problem in error.problems
            ]
        self.problems += problems
        spoilt = {str(problem.path[0]) for problem in problems}
        sound = {key: value for key, value in raw.items() if key not in spoilt}
        needed = {"material": STEEL, "segment": []}
        PARTS.check_tables(sound)
        return SceneFile(**{**needed, **sound}), spoilt

    def _name_datums(self) -> None:
        """Name the datums, from the file as it stands: a segment of a wrong length has its name."""
        places = self.places
        shapes: Any = self.raw.get("segment")
        if self.part is not None:
            places.add("origin")
            shapes = [{"name": f"s{k}"} for k in range(1, len(self.part.walls) + 1)]
        tables = isinstance(shapes, list) and all(isinstance(table, Mapping) for table in shapes)
        if (
            not tables
            or "bearing" in self.spoilt
            or not all(isinstance(table.get("name"), str) for table in shapes)
        ):
            places.names = None  # without sound names, what refers to them cannot be judged
        for k, table in enumerate(shapes if places.names is not None else ()):
            if table["name"] in places.segments:
                reason = "another segment has this name; each needs its own"
                self.problems.append(SceneError(reason, path=("segment", k, "name")))
            places.segments.append(table["name"])
            for datum in SHAPES.get(str(table.get("kind")), Cylinder).datums:
                places.add(f"{table['name']}.{datum}")

    def _shaft(self) -> list[Segment]:
        """Return segments end to end, or those of the part."""
        if self.part is None and not self.file.segment:
            raise SceneError("a scene needs at least one segment", path=("segment",))
        if (part := self.part) is not None and (body := self.file.body) is not None:
            usual = self._material()
            segments, path_of = part.lay_out(usual, self.places), self._part_path
            self.problems.read(lambda: part.check_mass(body.mass_check, usual))
        else:
            laid = lay_out(self.file.segment, self._material(), self.places)
            segments, path_of = laid.segments, laid.path
        problems = rules.shaft_problems(segments)
        if problems:
            raise SceneError.of(
                problem.located(None, path=path_of(problem.path)) for problem in problems
            )
        return segments

    def _material(self) -> Material:
        """Return the material of parts without one."""
        return self.file.material or self.part.usual_material()

    def _part_path(self, path: tuple) -> tuple:
        """Return the key of the file that an entry of a segment of the part comes from."""
        assert self.file.body is not None  # that the part was read from
        return ("material", *path[3:]) if "material" in path else ("body", self.file.body.key)

    def _row(self, kind: type[Placed], path: tuple, table: Table, **usual: Any) -> _Row:
        thing = self.problems.read(lambda: kind.read(table, self.places, **usual), path)
        return _Row(thing, kind, path, table)

    def _loads(self) -> tuple[BearingLoad | None, list[_Row]]:
        """Return the load at the main lumped point, or loads at any places."""
        if _is_at_port(self.raw.get("load")):
            table = self.raw["load"]
            return self.problems.read(lambda: BearingLoad(**table), ("load",)), []
        tables = self.file.load
        if isinstance(self.raw.get("load"), Mapping) and not PLACES & {*tables[0]}:
            tables = [{**tables[0], "on": self._main_name()}]
        return None, [self._row(ShaftLoad, ("load", k), table) for k, table in enumerate(tables)]

    def _main_name(self) -> str:
        """Return the name of the main lumped point of the file."""
        usual = Port.model_fields["name"].default
        first = self.file.port[0] if self.file.port else {}
        return self.file.ask.port or first.get("name", usual)

    def _bearing(self, index: int, table: Table) -> _Row:
        """Read a bearing, whose middle is a datum for tables that follow."""
        row = self._row(Bearing, ("bearing", index), table)
        if isinstance(name := table.get("name"), str):
            self.places.add(f"bearing.{name}", row.thing.y if row.thing else None)
        return row

    @staticmethod
    def _turned(rows: list[_Row], paired: list) -> list[_Row]:
        """Turn bearings of pairs as their arrangement says, once their places are known."""
        for pair in paired:
            if all(rows[k].thing for k in pair.bearings):
                for k, way in pair.ways(rows[k].thing.y for k in pair.bearings):
                    rows[k] = rows[k]._replace(thing=rows[k].thing.held_towards(way))
        return rows

    def _feature(self, index: int, table: Table) -> list[_Row]:
        """Read a feature, which may have no name; no row for an unknown kind."""
        path, kinds = ("feature", index), _kinds()
        kind = table.get("kind")
        if isinstance(kind, str) and kind in kinds:
            return [
                self._row(kinds[kind], path, table, name=f"{kind.replace('_', ' ')} {index + 1}")
            ]
        reason = unknown_kind(kind, kinds)
        if "kind" not in table:
            reason = (
                'this key is missing; it gives the sort of the feature, such as kind = "keyway"'
            )
        self.problems.append(SceneError(reason, path=(*path, "kind")))
        return []

    def _main_first(self, ports: list[_Row]) -> list[_Row]:
        """Return the lumped points, the main one of the file first."""
        main_name = self.file.ask.port
        names = [row.table.get("name", Port.model_fields["name"].default) for row in ports]
        sound = not any(problem.path[0] == "port" for problem in self.problems)
        if ports and sound and main_name is not None and main_name not in names:
            reason = rules.no_such_point(main_name, names)
            self.problems.append(SceneError(reason, path=("ask", "port")))
        main = [row for row, name in zip(ports, names) if name == main_name][:1]
        return main + [row for row in ports if row not in main]

    def _judge(self, rows: dict[str, list[_Row]], load: BearingLoad | None) -> None:
        """Gather problems between things that are sound by themselves."""
        # names are judged where all are known
        complete = not {"bearing", "port", "arrangement"} & self.spoilt
        complete &= all(row.thing for key in ("bearings", "ports") for row in rows[key])
        sound = {key: [row for row in kind_rows if row.thing] for key, kind_rows in rows.items()}
        things = {key: [row.thing for row in kind_rows] for key, kind_rows in sound.items()}
        tables = [*self.file.port, *self.file.bearing]
        names = [table.get("name", Port.model_fields["name"].default) for table in tables]
        stations = {name for name in names if isinstance(name, str)}
        things["masses"] = [*seat_masses(things["masses"], self.segments, stations)]
        stations |= {mass.name for mass in things["masses"]}
        things["loads"] = [*seat_loads(things["loads"], self.segments, [*stations])]
        problems = [*rules.problems_between(self.segments, **things, complete=complete)]
        if complete:
            problems += rules.question_problems(things["ports"], self.file.ask.quantities)
        if complete and all(row.thing for row in rows["loads"]):
            problems += self._load_problems(things, load)
        self.problems += [
            problem.located(None, path=_in_file(problem.path, sound)) for problem in problems
        ]

    def _load_problems(
        self, things: Mapping[str, list], load: BearingLoad | None
    ) -> Iterator[SceneError]:
        """Yield problems of loads and cases with each other, where these are sound by themselves."""
        if not {"load", "case", "mass", "torque_at", "turns"} & self.spoilt:
            stations = {key: things[key] for key in ("ports", "bearings", "masses", "loads")}
            file = self.file
            yield from load_problems(
                **stations, load=load, cases=file.case, torque_at=file.torque_at, turns=file.turns
            )


#: lists of a scene by those of a file
LISTS = {"bearings": "bearing", "ports": "port", "masses": "mass", "loads": "load", "cases": "case"}


def _in_file(path: tuple, rows: Mapping[str, Sequence[_Row]]) -> tuple:
    """Return the path in the file that an entry of a scene came from."""
    if path[0] == "port":
        path = ("ports", 0, *path[1:])
    elif path[0] == "further_ports":
        path = ("ports", path[1] + 1, *path[2:]) if path[1:] else ("ports",)
    if path[0] not in rows:
        return (LISTS.get(path[0], path[0]), *path[1:])
    if len(path) == 1:
        return (LISTS.get(path[0], "feature"),)
    row = rows[path[0]][path[1]]
    return (*row.path, *row.kind.key_path(path[2:], row.table))
