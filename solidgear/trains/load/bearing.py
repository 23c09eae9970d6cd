"""Catalogue bearings of a shaft under its load, or of a train over its operating points, from a path,
tables or an object.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

from solidgear.bearings import sheet as sheets
from solidgear.bearings.chart import draw_bearings
from solidgear.bearings.duty import LivesOverPoints
from solidgear.bearings.study import BearingFacts, bearing_facts, loaded_by, over_load
from solidgear.core import (
    Body,
    ByName,
    Scene,
    Sheeted,
    SolidgearError,
    Source,
    explained,
    is_train,
    name_of_source,
)
from solidgear.core.loading import as_written
from solidgear.core.scene.load_rules import named_case
from solidgear.core.scene.toml_file import name_of
from solidgear.show.options import speed_of
from solidgear.show.sheet import Sheet
from solidgear.show.units import Units
from solidgear.trains.assembly.assembly import NO_MODES, Assembly
from solidgear.trains.load.lives import lives_of
from solidgear.trains.load.operation import body_at_rest
from solidgear.trains.loading import load_train


@dataclass(frozen=True, eq=False, repr=False)
class SolvedBearings(ByName[BearingFacts | LivesOverPoints], Sheeted):
    """Catalogue bearings of a shaft at its load, or of a train over its operating points."""

    sheeted: ClassVar[str] = "trains.load.bearing:bearings_sheet"

    name: str
    facts: tuple[BearingFacts, ...] = ()  #: of a shaft
    lives: tuple[LivesOverPoints, ...] = ()  #: of a train, or over the cases of a shaft
    cautions: tuple[str, ...] = ()  #: of a train, sentences on what its numbers leave out
    case: str = ""  #: of the loads of a shaft that has several, of `facts`
    scene: Scene | None = field(default=None, repr=False)  #: of a shaft, under its load
    body: Body | None = field(default=None, repr=False)  #: on which its bearings settle
    speed: float | None = None  #: of the shaft, rad/s, in place of those of the file

    @property
    def by_name(self) -> dict[str, BearingFacts | LivesOverPoints]:
        """Facts of a bearing, or its lives, by its name."""
        return {
            **{life.name: life for life in self.lives},
            **{fact.name: fact for fact in self.facts},
        }

    def draw(self, path: str | Path) -> None:
        """Write a chart of stiffness over load, a file that ends in ``.png`` or ``.svg``; of a shaft
        alone.
        """
        if self.scene is None:
            raise SolidgearError(
                "`out` belongs to a scene; for a train give torque and speed in [operation]"
            )
        with explained(self.scene):
            curves = over_load(self.scene, self.body, speed=self.speed)
        draw_bearings(Path(path), self.facts, curves)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return dict(self.sheet().data)


def bearings_sheet(solved: SolvedBearings, units: Units, chart: Path | None = None) -> Sheet:
    """Return the sheet of catalogue bearings, which has units of its own; `chart` is drawn already."""
    if solved.scene is None:
        return sheets.train_sheet(solved.name, solved.lives, solved.cautions)
    return sheets.scene_sheet(solved.name, solved.facts, chart, solved.case, solved.lives)


def bearing(
    source: Source,
    name: str | None = None,
    *,
    load: str | Mapping[str, Any] | None = None,
    speed: str | None = None,
    case: str | int | None = None,
) -> SolvedBearings:
    """Catalogue bearings: stiffness at load, load of every element, pressure, life; of a train with
    an operation lives over its points, and of a shaft over the cases of its loads.

    Parameters
    ----------
    source : path, dict, Scene or Train
        A scene or train: its file (TOML), the tables of one, or an object.
    name : str, optional
        This bearing alone; of a train with its shaft, such as ``"pinion.A"``.
    load : str or dict, optional
        Of a shaft: another load, ``"x=2 kN, z=-500 N, thx=10 N*m"``, on the port, or on the bearing.
    speed : str, optional
        Of a shaft: its speed, such as ``"3000 rpm"``, for lives in hours and the inertia of balls;
        by default that of the case.
    case : str or int, optional
        Of a shaft: case of its loads, by name or number; by default the first.

    Returns
    -------
    SolvedBearings
        ``facts`` of the bearings of a shaft, ``lives`` of those of a train, or over several cases.

    Raises
    ------
    SolidgearError
        Where there are no such bearings, and for a load or a speed given for a train.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = sg.bearing("geometry/gearbox_catalogue.toml")
    >>> [(fact.name, fact.data.kind, round(fact.life.life.basic / 1e9, 1)) for fact in found.facts]
    [('A', 'cylindrical', 13.9), ('B', 'angular_contact', 22.8)]
    """
    if is_train(source):
        for option, value in {"`load`": load, "`speed`": speed, "`case`": case}.items():
            if value:
                raise SolidgearError(
                    f"{option} belongs to a scene; for a train give torque and speed in [operation]"
                )
        return _of_train(source, name)
    turns, scene = speed_of(speed), as_written(source)
    if load is not None:
        scene = loaded_by(scene, load, name)
    if case is not None:
        scene = scene.with_case(case)
    first = named_case(scene.cases)
    with explained(source):
        assembly = Assembly.of(scene, kept=NO_MODES)
        body = body_at_rest(assembly)
        facts = [fact for fact in bearing_facts(scene, body, turns) if name in (None, fact.name)]
        if not facts:
            raise SolidgearError(f"`name` {name}: no bearing of catalogue data has this name")
        over_cases = lives_of(assembly) if len(scene.cases) > 1 else []
        lives = tuple(life for life in over_cases if name in (None, life.name))
    label = first.name if scene.cases else ""
    return SolvedBearings(scene.name, tuple(facts), lives, (), label, scene, body, turns)


def _of_train(source: Source, name: str | None) -> SolvedBearings:
    """Return the bearings of a train, or one of them."""
    assembly = Assembly(load_train(source), kept=NO_MODES)
    lives = [life for life in lives_of(assembly) if name in (None, life.name)]
    if not lives:
        raise SolidgearError(
            f"`name` {name}: no bearing of catalogue data has this name; write shaft and name, "
            "such as pinion.A"
        )
    points = assembly.asked_train.operation
    cautions = [text for point in points for text in assembly.at(point).cautions_at_rest()]
    title = name_of(name_of_source(source))
    return SolvedBearings(title, lives=tuple(lives), cautions=tuple(dict.fromkeys(cautions)))
