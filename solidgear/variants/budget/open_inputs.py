"""Open inputs of a scene, and its numbers at any point of their ranges.

Open are the inside of a catalogue bearing that is estimated, its clearance where that is a class,
and entries that ``[uncertain]`` of the file states (:mod:`solidgear.core.scene.uncertain`). A point is a place in
every range, 0 to 1.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.bearings.catalogue import catalogue_of
from solidgear.bearings.clearance import clearance_range
from solidgear.bearings.solved import Choice, solved, wants_equilibrium
from solidgear.core import STIFFNESS, Body, ModeSet, Quantity, Scene, build, modes
from solidgear.core.judge.correlation import pair_modes
from solidgear.core.judge.quantities import measure
from solidgear.core.loading import SHAFT
from solidgear.core.scene.uncertain import with_scaled_entry
from solidgear.core.solve.statics import condense

BEARINGS, LOAD, MATERIAL = "bearings", "load", "material"
INSIDE, CLEARANCE, PRELOAD = ".inside", ".clearance", ".preload"
#: modes beyond those asked for, among which a mode may be that has moved up
FURTHER_MODES = 4
#: ends of an estimated inside; the bearing is one of three and none between them
ENDS = ("softer", "middle", "stiffer")
#: places of a smooth input for its variance, with their weights (Gauss, five points), and of an
#: inside
SMOOTH = tuple(
    (float(x + 1) / 2, float(w) / 2) for x, w in zip(*np.polynomial.legendre.leggauss(5))
)
THREE = tuple((place, 1 / 3) for place in (1 / 6, 0.5, 5 / 6))


@dataclass(frozen=True)
class OpenInput:
    """Open input of a scene."""

    path: str
    source: str  #: ``bearings``, ``load`` or ``material``
    said: str  #: the range in words
    #: low, high: factors on the value of the scene; places, 0 and 1, of an inside and of a clearance
    low: float = 0.0
    high: float = 1.0
    usual: float = 0.5  #: place of the value of the scene in the range, 0 to 1

    def value(self, place: float) -> float:
        """Return the factor, or the place, at a place of the range."""
        return self.low + (self.high - self.low) * place

    @property
    def nodes(self) -> tuple[tuple[float, float], ...]:
        """Places and weights for the variance."""
        return THREE if self.path.endswith(INSIDE) else SMOOTH


def open_inputs(scene: Scene) -> tuple[OpenInput, ...]:
    """Return the inputs of a scene that have a range.

    Examples
    --------
    >>> import solidgear as sg
    >>> for open_input in open_inputs(sg.load("geometry/gearbox_catalogue.toml"))[:2]:
    ...     print(open_input.path, "|", open_input.said)
    bearing.A.inside | estimated, softer to stiffer
    bearing.A.clearance | CN, 25 to 50 um
    """
    inputs = []
    for bearing in scene.bearings:
        data = catalogue_of(bearing)
        if data is None:
            continue
        path = f"bearing.{bearing.name}"
        if data.estimated:
            inputs.append(OpenInput(path + INSIDE, BEARINGS, "estimated, softer to stiffer"))
        if isinstance(data.clearance, str):
            least, most = (f"{1e6 * end:.3g}" for end in clearance_range(data))
            words = f"{data.clearance}, {least} to {most} um"
            inputs.append(OpenInput(path + CLEARANCE, BEARINGS, words))
    for stated in scene.uncertain:
        source = {"material": MATERIAL, "segment": MATERIAL, "load": LOAD}.get(
            stated.path.partition(".")[0], BEARINGS
        )
        usual = (1 - stated.low) / (stated.high - stated.low)
        inputs.append(OpenInput(stated.path, source, stated.said, stated.low, stated.high, usual))
    return tuple(inputs)


class Points:
    """Numbers of a scene at points of the ranges of its open inputs.

    A body gives stiffnesses, and no frequencies; by default, and where one of several moduli is
    open, the beam of :data:`solidgear.core.loading.SHAFT`, made anew for every material.
    """

    def __init__(self, scene: Scene, inputs: Sequence[OpenInput], body: Body | None = None):
        self.scene, self.inputs = scene, inputs
        self.body = body if _one_modulus(scene, inputs) else None
        self.lost: dict[str, None] = {}  #: names of bearings that carried nothing at a point
        self._beams: dict[tuple, Body] = {}
        self._first: ModeSet | None = None

    @property
    def model(self) -> str:
        """Model that the numbers are of."""
        return SHAFT if self.body is None else self.body.fidelity

    def numbers(self, place: Sequence[float]) -> dict[Quantity, float]:
        """Return the numbers at a point, a place in every range; SolidgearError if bearings hold
        nothing there, or a stiffness is not usable.
        """
        values = {open_input.path: open_input.value(x) for open_input, x in zip(self.inputs, place)}
        scene = self.scene
        for path, value in values.items():
            if path != "load" and not path.endswith((INSIDE, CLEARANCE, PRELOAD)):
                scene = with_scaled_entry(scene, path, value)
        beam = None
        if self.body is None or wants_equilibrium(scene):
            key = tuple(segment.material for segment in scene.segments)
            if key not in self._beams:
                self._beams = {key: build(scene.plain, SHAFT)}
            beam = self._beams[key]
        rest = solved(scene, beam if wants_equilibrium(scene) else None, _choice(values))
        for name, made in rest.made.items():
            if not made.bearing.load(rest.motion[name]).any():
                self.lost[name] = None
        if self.body is None:
            assert beam is not None
            return self._measured(beam, rest.scene, frequencies=True)
        # a shaft that is e times as stiff on its bearings is e times as stiff as one on bearings
        # that are e times softer
        e = values.get("material.E", 1.0)
        numbers = self._measured(self.body, _softer(rest.scene, e), frequencies=False)
        return {q: v * e if q.kind == STIFFNESS else v / e for q, v in numbers.items()}

    def _measured(self, body: Body, scene: Scene, frequencies: bool) -> dict[Quantity, float]:
        main, *further = (condense(body, scene, port.name) for port in scene.ports)
        numbers = measure(main, None, {condensed.port: condensed for condensed in further})
        return numbers | (self._frequencies(body, scene) if frequencies else {})

    def _frequencies(self, body: Body, scene: Scene) -> dict[Quantity, float]:
        """Return the frequencies of the modes of the first point, paired by shapes: names change where
        other modes come between.
        """
        if self._first is None:
            self._first = modes(body, scene, scene.ask.modes)
        shapes = modes(body, scene, scene.ask.modes + FURTHER_MODES)
        pairs = pair_modes(shapes, self._first)
        return {Quantity(p.reference.name): p.frequency_hz for p in pairs if p.mode is not None}


def _one_modulus(scene: Scene, inputs: Sequence[OpenInput]) -> bool:
    """True where an open modulus is that of all of the shaft, or none is open."""
    alike = len({segment.material.E for segment in scene.segments}) == 1
    moduli = [i.path for i in inputs if i.path.endswith("material.E")]
    return not moduli or (alike and moduli == ["material.E"])


def _choice(values: Mapping[str, float]) -> Choice:
    """Return the places in the data of catalogue bearings."""
    by_bearing: dict[str, dict] = {}
    for path, value in values.items():
        key = next((k for k in (INSIDE, CLEARANCE, PRELOAD) if path.endswith(k)), None)
        if key is None:
            continue
        name = path.removeprefix("bearing.").removesuffix(key).removesuffix(".catalogue")
        field = {INSIDE: "end", CLEARANCE: "clearance", PRELOAD: "preload"}[key]
        end = ENDS[min(int(3 * value), 2)] if key == INSIDE else value
        by_bearing.setdefault(name, {})[field] = end
    choices = {name: Choice(**fields) for name, fields in by_bearing.items()}
    return Choice(load=values.get("load", 1.0), overrides=choices)


def _softer(scene: Scene, e: float) -> Scene:
    """Return the scene on springs that are e times softer."""
    if e == 1:
        return scene
    housing, axial = scene.housing, scene.housing_axial
    return scene.with_bearing_scale(1 / e).with_changes(
        housing=housing and housing.scaled(1 / e), housing_axial=axial and axial / e
    )
