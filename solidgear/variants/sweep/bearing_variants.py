"""Bearing sets of a sweep as scenes of a file, and the one shaft that carries all their seats.

Entries are read by the paths and rules of every sweep over a file; here places of seats are read
once each, and springs from the tables of their bearings alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from solidgear.bearings.solved import solved
from solidgear.core import (
    Bearing,
    Outline,
    Port,
    Scene,
    SceneError,
    SolidgearError,
    Source,
    Supports,
    as_supports,
)
from solidgear.core.loading import scene_of, shaft
from solidgear.core.scene import PointMass, Segment
from solidgear.core.scene.feature import OnSegment
from solidgear.core.scene.paths import Keys, Tables, entries, entry
from solidgear.core.scene.sprung import resprung
from solidgear.parts.body_file import BodyFile
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.entries import Entry
from solidgear.variants.sweep.file_variants import MAIN, SceneVariants, scene_variants

#: keys of a bearing that make its springs, and those of the housing of all
SPRINGS = ("stiffness", "matrix", "axial_series", "housing", "scale")
HOUSING = ("stiffness", "matrix", "axial", "scale")
POSITION = "position"
#: words that may name the middle of a bearing
DATUMS = ("from", "at")
#: scenes whose catalogue bearings have settled that are kept
KEPT = 200


@dataclass(frozen=True)
class SeatedShaft:
    """A shaft with every seat that a sweep may use, which builders take as a scene; seats may overlap,
    as only one of them carries a bearing at a time.
    """

    segments: tuple[Segment, ...]
    stations: tuple[Port | Bearing | PointMass, ...]
    outline: Outline[Segment]
    features: tuple[OnSegment, ...] = ()
    body: BodyFile | None = None

    @property
    def plain(self) -> SeatedShaft:
        """Shaft of the segments alone."""
        return replace(self, features=(), body=None)

    @property
    def length(self) -> float:
        """Length of the shaft in m."""
        return self.segments[-1].y1


@dataclass(frozen=True)
class BearingVariants(SceneVariants):
    """Points of a sweep over springs and positions of bearings alone."""

    @cached_property
    def scene(self) -> Scene:
        """Scene of the file as it is."""
        return scene_of(self.files[MAIN], self.path)

    @cached_property
    def moves(self) -> list[int]:
        """Indices of the entries that move seats."""
        return [k for k, varying in enumerate(self.entries) if varying.keys[-1] == POSITION]

    @cached_property
    def _placed(self) -> dict[tuple[float, ...], Scene | SceneError]:
        """Scene, or the error of it, for every placement of seats that occurs; catalogue bearings
        without stiffness.
        """
        moving = [self.entries[k] for k in self.moves]
        out: dict[tuple[float, ...], Scene | SceneError] = {}
        for key in dict.fromkeys(map(tuple, self.values[:, self.moves].tolist())):
            try:
                out[key] = scene_of(self.put(MAIN, moving, key), self.path, alone=False)
            except SceneError as error:
                out[key] = error
        return out

    def variant(self, index: int) -> Scene:
        row = self.values[index].tolist()
        placed = self._placed[tuple(row[k] for k in self.moves)]
        if isinstance(placed, SceneError):
            raise placed
        springs = [k for k in range(len(row)) if k not in self.moves]
        if springs:
            varied = [self.entries[k] for k in springs]
            tables = self.put(MAIN, varied, [row[k] for k in springs])
            keys = [place.keys for varying in varied for place in varying.places]
            placed = resprung(placed, tables, keys)
        if all(bearing.catalogue is None for bearing in placed.bearings):
            return placed
        return self._at_load(placed, row)

    def _at_load(self, scene: Scene, row: Sequence[float]) -> Scene:
        """Return a scene whose catalogue bearings are stiff as under the load of the scene, which the
        factors of their stiffness do not change.
        """
        key = tuple(
            value for varying, value in zip(self.entries, row) if not self.multiplies(varying)
        )
        if key not in self._at_rest:
            if len(self._at_rest) >= KEPT:
                self._at_rest.clear()
            self._at_rest[key] = settled_anew(scene)
        settled = {bearing.name: bearing for bearing in self._at_rest[key].bearings}
        return scene.unjudged(
            bearings=tuple(
                bearing
                if bearing.catalogue is None
                else bearing.with_changes(matrix=settled[bearing.name].matrix)
                for bearing in scene.bearings
            )
        )

    @cached_property
    def _at_rest(self) -> dict[tuple[float, ...], Scene]:
        return {}

    def __getstate__(self) -> dict[str, Any]:
        return {key: value for key, value in self.__dict__.items() if key != "_at_rest"}

    def multiplies(self, varying: Entry) -> bool:
        """True for an entry that multiplies catalogue bearings alone."""
        return all(
            place.keys[0] == "bearing"
            and place.keys[2:] == ("scale",)
            and self.scene.bearings[int(place.keys[1])].catalogue is not None
            for place in varying.places
        )

    def supports(self, index: int) -> tuple[Scene, Supports]:
        """Return the scene of a variant, and springs on ports of the :meth:`shaft`; raises like
        :meth:`variant`.
        """
        scene = self.variant(index)
        return scene, as_supports(scene).on_stations(
            scene.stations, lambda s: seat_name(s) if isinstance(s, Bearing) else s.name
        )

    def shaft(self) -> SeatedShaft:
        """Return the shaft with the seats of all placements that can be solved; SolidgearError if
        there is none, or a rigid seat is to move.
        """
        placed = [scene for scene in self._placed.values() if isinstance(scene, Scene)]
        if not placed:
            raise SolidgearError(
                f"no variant can be solved; the first one is refused: {next(iter(self._placed.values()))}"
            )
        for k in self.moves:
            varying = self.entries[k]
            moved = [self.scene.bearings[int(place.keys[1])] for place in varying.places]
            if len(varying.values) > 1 and any(b.attachment == "rigid" for b in moved):
                raise SolidgearError(
                    f"{varying.label}: a rigid seat stiffens the shaft, so it cannot move in one "
                    "body; use attachment 'average' or 'section'"
                )
        seats = {seat_name(b): b for scene in placed for b in scene.bearings}
        named = [b.with_changes(name=name) for name, b in seats.items()]
        ordered = sorted(named, key=lambda b: b.y)
        masses = (mass for mass in self.scene.masses if mass.on is None)
        return SeatedShaft(
            self.scene.segments,
            stations=(self.scene.port, *ordered, *masses, *self.scene.further_ports),
            outline=self.scene.outline,
            features=self.scene.features,
            body=self.scene.body,
        )


def bearing_variants(
    scene: Source, vary: Iterable[str], sample: int | None = None, seed: int = 0
) -> BearingVariants | None:
    """Return the points of a sweep over springs and positions of bearings, all combinations or a sample
    of them; None if another entry varies, or a place is counted from a bearing that moves.

    Examples
    --------
    >>> path = "geometry/shaft_stepped.toml"
    >>> len(bearing_variants(path, ["bearing.A.kxx=1e8,2e8", "bearing.B.position=-40 mm,-30 mm"]))
    4
    >>> bearing_variants(path, ["segment.left.diameter=50 mm,52 mm"]) is None
    True
    """
    design = Design(tuple(vary), sample, seed)
    variants = scene_variants(scene, design, "bearing.1.kxx=log:1e8 N/m:1e10 N/m:9")
    tables, varied, values = variants.files[MAIN], variants.entries, variants.values
    keys = [place.keys for varying in varied for place in varying.places]
    if not all(varying.numeric for varying in varied) or not all(map(_of_bearings, keys)):
        return None
    moved = [entry((*key[:2], "name"), tables) for key in keys if key[-1] == POSITION]
    if _counted_from(tables, moved):
        return None
    if sample is not None:
        # every seat is meshed: a position is one of those listed
        varied = tuple(
            replace(varying, spacing="list") if varying.keys[-1] == POSITION else varying
            for varying in varied
        )
        values = design.drawn(varied)
    return BearingVariants(variants.path, variants.files, varied, values, variants.sums, design)


def _of_bearings(keys: Keys) -> bool:
    """True for an entry of springs or positions of bearings, or of their housing."""
    if keys[0] == "housing":
        return keys[1] in HOUSING
    return keys[0] == "bearing" and (keys[2] in SPRINGS or keys[2:] == (POSITION,))


def _counted_from(tables: Tables, names: Sequence[Any]) -> bool:
    """True where a place that is not of a bearing is counted from one of these bearings."""
    middles = {f"bearing.{name}" for name in names}
    return any(
        keys[-1] in DATUMS and keys[0] != "bearing" and entry(keys, tables) in middles
        for keys in entries(tables)
    )


def settled_anew(scene: Scene) -> Scene:
    """Return a scene with catalogue bearings stiff as under its load: their stiffness depends on the
    load, and where a seat moves, loads move with it.
    """
    try:
        return solved(scene, shaft(scene)).scene
    except SceneError:
        raise
    except SolidgearError as error:
        raise SceneError(str(error)) from None


def seat_name(bearing: Bearing) -> str:
    """Return the name of the port of a bearing, which all share that hold the same surface the same
    way.
    """
    return f"seat at {bearing.y!r} m, {bearing.lo!r} to {bearing.hi!r} m, {bearing.attachment}"
