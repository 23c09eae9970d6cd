"""The bearing sets of a sweep as validated scenes, and the one shaft that carries all their seats."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from solidgear.bearings.solved import solved, waiting
from solidgear.body import Supports, as_supports
from solidgear.errors import SceneError, SolidgearError, show
from solidgear.scene import (
    Bearing,
    Elastic,
    Feature,
    Housing,
    PointMass,
    Port,
    Scene,
    Segment,
)
from solidgear.scene.bearing_stiffness import STIFFNESS_NAMES
from solidgear.scene.body_file import BodyFile
from solidgear.scene.outline import Outline
from solidgear.studies.loading import shaft
from solidgear.studies.sweep.vary import Axis

E = TypeVar("E", bound=Elastic)


@dataclass(frozen=True)
class SeatedShaft:
    """A shaft with every seat that a sweep may use, as builders see a scene.

    A `Scene` refuses seats that overlap; here only one of them carries a bearing at a time.
    """

    segments: tuple[Segment, ...]
    stations: tuple[Port | Bearing | PointMass, ...]
    outline: Outline[Segment]
    features: tuple[Feature, ...] = ()
    body: BodyFile | None = None

    @property
    def plain(self) -> SeatedShaft:
        """The same shaft as its segments alone."""
        return replace(self, features=(), body=None)

    @property
    def length(self) -> float:
        """Length of the shaft in m."""
        return self.segments[-1].y1


@dataclass(frozen=True)
class Variants:
    """Points of a sweep and what they mean.

    Attributes
    ----------
    values : (n, len(axes)) ndarray
        SI.
    """

    scene: Scene
    axes: tuple[Axis, ...]
    values: np.ndarray

    def __len__(self) -> int:
        return len(self.values)

    @functools.cached_property
    def _moves(self) -> list[int]:
        return [k for k, axis in enumerate(self.axes) if axis.field == "position"]

    @functools.cached_property
    def _placed(self) -> dict[tuple[float, ...], Scene | str]:
        """Scene, or why there is none, for every placement of the seats that occurs."""
        out: dict[tuple[float, ...], Scene | str] = {}
        for key in dict.fromkeys(map(tuple, self.values[:, self._moves].tolist())):
            bearings = list(self.scene.bearings)
            try:
                for k, y in zip(self._moves, key):
                    b = self.axes[k].seat
                    bearings[b] = bearings[b].with_changes(y=y)
                out[key] = settled_anew(self.scene.with_changes(bearings=tuple(bearings)))
            except SceneError as error:
                # the field is that of a scene in memory: what was varied is said as it was asked for
                where = ", ".join(
                    f'bearing "{self.scene.bearings[self.axes[k].seat].name}" at {y:.6g} m'
                    for k, y in zip(self._moves, key)
                )
                out[key] = f"{where}: {error.reason}"
        return out

    def of(self, index: int) -> Scene:
        """Scene of one variant.

        Raises
        ------
        SceneError
            If a scene file with these values would be refused.
        """
        row = self.values[index]
        placed = self._placed[tuple(row[self._moves].tolist())]
        if isinstance(placed, str):
            raise SceneError(placed)
        changes: dict[tuple[int | None, bool], list[tuple[str, float]]] = {}
        for axis, value in zip(self.axes, row.tolist()):
            if axis.field != "position":
                changes.setdefault(axis.place, []).append((axis.field, value))
        if not changes:
            return placed
        around = changes.pop((None, True), [])
        if around:
            placed = _rehoused(placed, around)
        bearings = list(placed.bearings)
        for b in dict.fromkeys(bearing for bearing, _ in changes if bearing is not None):
            own, within = (tuple(changes.get((b, housed), ())) for housed in (False, True))
            try:
                bearings[b] = _changed(bearings[b], own, within)
            except SceneError as error:
                raise SceneError(error.reason, field=f'bearing "{bearings[b].name}"') from None
        return placed.with_changes(bearings=tuple(bearings))

    def supports(self, index: int) -> tuple[Scene, Supports]:
        """Scene of one variant, and its springs on the ports of the :meth:`shaft`. Raises like
        :meth:`of`.
        """
        scene = self.of(index)
        return scene, as_supports(scene).on_stations(scene.stations, _port_name)

    def shaft(self) -> SeatedShaft:
        """The shaft with the seats of all placements that can be.

        Raises
        ------
        SolidgearError
            If nothing can be solved, or a rigid seat is to move.
        """
        placed = [s for s in self._placed.values() if isinstance(s, Scene)]
        if not placed:
            raise SolidgearError(
                f"no variant can be solved; the first one is refused: {next(iter(self._placed.values()))}"
            )
        for k in self._moves:
            bearing = self.scene.bearings[self.axes[k].seat]
            if bearing.attachment == "rigid" and len(self.axes[k].values) > 1:
                raise SolidgearError(
                    f"{self.axes[k].label}: a rigid seat stiffens the shaft wherever it is "
                    "meshed, so it cannot move in one body; use attachment 'average' or 'section'"
                )
        seats = {
            seat_name(b): b.with_changes(name=seat_name(b))
            for scene in placed
            for b in scene.bearings
        }
        ordered = sorted(seats.values(), key=lambda b: b.y)
        own = (m for m in self.scene.masses if m.on is None)
        return SeatedShaft(
            self.scene.segments,
            (self.scene.port, *ordered, *own, *self.scene.further_ports),
            self.scene.outline,
            self.scene.features,
            self.scene.body,
        )


def settled_anew(scene: Scene) -> Scene:
    """A scene with seats elsewhere, whose catalogue bearings carry what the load of the scene brings
    them there.

    A bearing's tangent is that of its load, and where a seat moves, loads move with it.
    """
    if not waiting(scene):
        return scene
    try:
        return solved(scene, shaft(scene)).scene
    except SceneError:
        raise
    except SolidgearError as error:
        raise SceneError(str(error)) from None


def _port_name(station: Port | Bearing | PointMass) -> str:
    """Name of the port of a station in the shaft of a sweep: seats of bearings are shared."""
    return seat_name(station) if isinstance(station, Bearing) else station.name


def seat_name(bearing: Bearing) -> str:
    """Name of the port a bearing sits on: bearings of any stiffness share it if they hold the same
    surface alike.
    """
    return f"seat at {bearing.y!r} m, {bearing.lo!r} to {bearing.hi!r} m, {bearing.attachment}"


def _rehoused(scene: Scene, fields: list[tuple[str, float]]) -> Scene:
    """A scene with entries of its housing replaced."""
    try:
        if scene.housing is None:
            return scene.with_changes(housing_axial=fields[-1][1])
        return scene.with_changes(housing=_varied(scene.housing, fields))
    except SceneError as error:
        raise SceneError(error.reason, field="housing") from None


def _varied(housing: E, fields: list[tuple[str, float]]) -> E:
    """A housing with some of its entries replaced, then scaled."""
    given = dict(fields)
    factor = given.pop("scale", None)
    _refuse_scale(factor)
    if given:
        entries: dict[str, Any] = {"stiffness": housing.entries | given}
        if isinstance(housing, Housing):
            entries["y"] = housing.y
        housing = type(housing)(**entries)
    return housing if factor is None else housing.scaled(factor)


def _refuse_scale(factor: float | None) -> None:
    if factor is not None and not factor > 0:
        reason = f"scale = {factor:g}: must be greater than zero"
        raise SceneError(reason, field="scale", value=show(factor))


# In a product of axes the same few bearings come again and again.
@functools.lru_cache(maxsize=1024)
def _changed(
    bearing: Bearing, own: tuple[tuple[str, float], ...], within: tuple[tuple[str, float], ...]
) -> Bearing:
    """A bearing with some entries of its own matrix and of its housing replaced, then scaled."""
    matrix, factor = np.array(bearing.matrix), None
    for field, value in own:
        if field == "scale":
            _refuse_scale(factor := value)
        else:
            i, j, _ = STIFFNESS_NAMES[field]
            matrix[i, j] = matrix[j, i] = value
    bearing = bearing.with_changes(matrix=matrix)
    if within and bearing.housing is not None:
        bearing = bearing.with_changes(housing=_varied(bearing.housing, list(within)))
    return bearing if factor is None else bearing.scaled(factor)
