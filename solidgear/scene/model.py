"""The scene: what is modelled, and what is asked of it.

A shaft of cylinders and cones along y, bearings with 6x6 stiffness, one lumped point (the port),
and the questions. Frozen and validated, SI inside, no numerics beyond geometry bookkeeping. Degrees
of freedom are everywhere in the order (x, y, z, thx, thy, thz); y runs along the shaft and is 0 at
its first end face.

>>> scene = solidgear.load("geometry/pinion_overhung.toml")
>>> stiff = scene.with_attachment("rigid").with_bearing_scale(10.0)
>>> rod = Scene.from_parts([Segment.cylinder("rod", length=0.3, diameter=0.06)])
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from solidgear.errors import SceneError
from solidgear.scene.bearing_stiffness import stiffness_entries
from solidgear.scene.parts import STEEL, Bearing, Material, Model, Port, Segment
from solidgear.scene.rules import MOST_MODES, shaft_problems, station_problems, steps
from solidgear.scene.units import AxialSpring, Frequency, Tolerance

#: what a model can be judged by: compliance and stiffness at the lumped point, first modes
Quantity = Literal[
    "C_zz",
    "C_z,thx",
    "C_thx",
    "C_yy",
    "K_zz",
    "K_z,thx",
    "K_thx",
    "K_yy",
    "bending 1",
    "bending 2",
    "axial 1",
    "torsion 1",
]


class Ask(Model):
    """The questions: how many modes, up to what frequency (Hz; None is no limit), to what relative
    tolerance.

    `quantities` names what models are judged by; empty is the usual set, compliances with first
    bending and first axial mode.
    """

    modes: Annotated[int, Field(strict=True, ge=1, le=MOST_MODES)] = 10
    max_frequency: Frequency | None = None
    tolerance: Tolerance = 0.05
    quantities: tuple[Quantity, ...] = ()


class Scene(Model):
    """A shaft on its bearings; read one with `solidgear.load`, or make one with `Scene.from_parts`.

    `segments` lie end to end from y = 0; `port` is the lumped point; `housing_axial` (N/m or None)
    is the spring along y between the common bearing housing and ground; `source` says where the
    data come from.
    """

    title: str = ""
    name: str = "scene"
    source: str = ""
    segments: tuple[Segment, ...]
    material: Material = STEEL
    bearings: tuple[Bearing, ...] = ()
    housing_axial: AxialSpring | None = None
    port: Port
    ask: Ask = Ask()

    @model_validator(mode="after")
    def _hangs_together(self) -> Scene:
        # a station can be judged only on a shaft that is sound
        bearings = dict(enumerate(self.bearings))
        if problems := [*shaft_problems(self.segments)] or [
            *station_problems(self.segments, self.port, bearings)
        ]:
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
            title, name, source, housing_axial, ask.

        Raises
        ------
        SceneError
        """
        segments = tuple(
            s if "material" in s.model_fields_set else s.with_changes(material=material)
            for s in segments
        )
        if port is None and segments:
            longest = max(segments, key=lambda s: s.length)
            port = Port(y=(longest.y0 + longest.y1) / 2, lo=longest.y0, hi=longest.y1)
        given: dict[str, Any] = {} if port is None else {"port": port}
        return cls(segments=segments, material=material, bearings=tuple(bearings), **given, **rest)

    @property
    def length(self) -> float:
        """Length of the shaft in m."""
        return self.segments[-1].y1

    @property
    def stations(self) -> tuple[Port | Bearing, ...]:
        """Everything attached to the shaft, the port first: each has name, y, lo, hi, attachment."""
        return (self.port, *self.bearings)

    @property
    def steps(self) -> tuple[float, ...]:
        """y (m) where the outer radius jumps, end faces left out."""
        return steps(self.segments)

    def with_changes(self, **changes: Any) -> Scene:
        """A validated copy with some fields replaced; a new `material` also replaces the old
        default in the segments.
        """
        if "material" in changes and "segments" not in changes:
            swap = {self.material: changes["material"]}
            changes["segments"] = tuple(
                s.with_changes(material=swap.get(s.material, s.material)) for s in self.segments
            )
        return super().with_changes(**changes)

    def with_attachment(self, attachment: str) -> Scene:
        """The same scene with the port and every bearing attached by 'average', 'rigid' or
        'section'.
        """
        bearings = tuple(b.with_changes(attachment=attachment) for b in self.bearings)
        return self.with_changes(
            bearings=bearings, port=self.port.with_changes(attachment=attachment)
        )

    def with_seat_width(self, width: float | str) -> Scene:
        """The same scene with every bearing seat `width` wide."""
        return self.with_changes(
            bearings=tuple(b.with_changes(seat_width=width) for b in self.bearings)
        )

    def with_material(self, **changes: Any) -> Scene:
        """The same scene with `E`, `nu` or `density` replaced in the default material and in every
        segment.
        """
        segments = tuple(
            s.with_changes(material=s.material.with_changes(**changes)) for s in self.segments
        )
        return self.with_changes(material=self.material.with_changes(**changes), segments=segments)

    def with_bearing_scale(self, factor: float) -> Scene:
        """The same scene with every bearing's stiffness, series springs included, times `factor` >
        0.
        """
        return self.with_changes(bearings=tuple(b.scaled(factor) for b in self.bearings))

    def with_port(self, **changes: Any) -> Scene:
        """The same scene with fields of its port replaced, such as ``y=0.03``; the span stays
        unless given too.
        """
        return self.with_changes(port=self.port.with_changes(**changes))

    def as_dict(self) -> dict[str, Any]:
        """Everything resolved, in SI, as plain JSON-serialisable data."""
        data = self.model_dump(mode="json")
        for row, segment in zip(data["segments"], self.segments):
            row["length"] = segment.length
        for row, bearing in zip(data["bearings"], self.bearings):
            row |= {
                "lo": bearing.lo,
                "hi": bearing.hi,
                "stiffness": bearing.stiffness.tolist(),
                "entries": stiffness_entries(row.pop("matrix")),
            }
        return data | {"length": self.length, "steps": list(self.steps)}
