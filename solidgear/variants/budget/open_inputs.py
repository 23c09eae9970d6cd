"""Open inputs of a scene, and its numbers at any point of their ranges.

Open are the inside of a catalogue bearing that is estimated, its clearance where that is a class,
and what ``[uncertain]`` of the file states (:mod:`solidgear.core.scene.uncertain`). A point is a place in
every range, 0 to 1.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.bearings.catalogue import catalogue_of
from solidgear.bearings.clearance import clearance_range
from solidgear.bearings.solved import Choice, solved, wants_equilibrium
from solidgear.core.body import Body
from solidgear.core.judge.correlation import pair_modes
from solidgear.core.judge.quantities import measure
from solidgear.core.ladder import build
from solidgear.core.loading import SHAFT
from solidgear.core.quantity import STIFFNESS, Quantity
from solidgear.core.scene import Scene
from solidgear.core.scene.uncertain import with_scaled_entry
from solidgear.core.solve.modes import ModeSet, modes
from solidgear.core.solve.statics import condense

BEARINGS, LOAD, MATERIAL = "bearings", "load", "material"
INSIDE, CLEARANCE, PRELOAD = ".inside", ".clearance", ".preload"
#: modes beyond those asked for, among which one may be found that has moved up
FURTHER_MODES = 4
#: ends of an estimated inside; it is one of three bearings and none between them
ENDS = ("softer", "middle", "stiffer")
#: places of a smooth input by which its variance is taken, with their weights (Gauss, five points),
#: and those of an inside
SMOOTH = tuple(
    (float(x + 1) / 2, float(w) / 2) for x, w in zip(*np.polynomial.legendre.leggauss(5))
)
THREE = tuple((place, 1 / 3) for place in (1 / 6, 0.5, 5 / 6))


@dataclass(frozen=True)
class OpenInput:
    """An input with its range."""

    path: str
    source: str  #: what it belongs to: ``bearings``, ``load`` or ``material``
    said: str  #: the range in words
    #: low, high: factors of what the scene says; places, 0 and 1, of an inside and of a clearance
    low: float = 0.0
    high: float = 1.0
    usual: float = 0.5  #: place in the range, 0 to 1, of what the scene says

    def value(self, place: float) -> float:
        """The factor, or the place, at a place of the range."""
        return self.low + (self.high - self.low) * place

    @property
    def nodes(self) -> tuple[tuple[float, float], ...]:
        """Places and weights that its variance is taken by."""
        return THREE if self.path.endswith(INSIDE) else SMOOTH


def open_inputs(scene: Scene) -> tuple[OpenInput, ...]:
    """Inputs of a scene that have a range.

    Examples
    --------
    >>> import solidgear as sg
    >>> for one in open_inputs(sg.load("geometry/gearbox_catalogue.toml"))[:2]:
    ...     print(one.path, "|", one.said)
    bearing.A.inside | estimated, softer to stiffer
    bearing.A.clearance | CN, 25 to 50 um
    """
    found = []
    for bearing in scene.bearings:
        data = catalogue_of(bearing)
        if data is None:
            continue
        path = f"bearing.{bearing.name}"
        if data.estimated:
            found.append(OpenInput(path + INSIDE, BEARINGS, "estimated, softer to stiffer"))
        if isinstance(data.clearance, str):
            least, most = (f"{1e6 * end:.3g}" for end in clearance_range(data))
            said = f"{data.clearance}, {least} to {most} um"
            found.append(OpenInput(path + CLEARANCE, BEARINGS, said))
    for one in scene.uncertain:
        source = {"material": MATERIAL, "segment": MATERIAL, "load": LOAD}.get(
            one.path.partition(".")[0], BEARINGS
        )
        usual = (1 - one.low) / (one.high - one.low)
        found.append(OpenInput(one.path, source, one.said, one.low, one.high, usual))
    return tuple(found)


class Points:
    """Numbers of a scene at points of the ranges of its open inputs.

    Parameters
    ----------
    body : Body, optional
        At which stiffnesses are taken, and no frequencies; by default, and where one of several
        moduli is open, the beam of :data:`solidgear.core.loading.SHAFT`, made anew for every
        material.

    Attributes
    ----------
    lost : dict
        Names of bearings that carried nothing at a point.
    """

    def __init__(self, scene: Scene, inputs: Sequence[OpenInput], body: Body | None = None):
        self.scene, self.inputs = scene, inputs
        self.body = body if _one_modulus(scene, inputs) else None
        self.lost: dict[str, None] = {}
        self._beams: dict[tuple, Body] = {}
        self._first: ModeSet | None = None

    @property
    def model(self) -> str:
        """Model that the numbers are of."""
        return SHAFT if self.body is None else self.body.fidelity

    def numbers(self, place: Sequence[float]) -> dict[Quantity, float]:
        """Numbers at a point.

        Raises
        ------
        SolidgearError
            Bearings that hold nothing there, or a stiffness that is none.
        """
        values = {one.path: one.value(at) for one, at in zip(self.inputs, place)}
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
        found = solved(scene, beam if wants_equilibrium(scene) else None, _choice(values))
        for name, made in found.made.items():
            if not made.bearing.load(found.motion[name]).any():
                self.lost[name] = None
        if self.body is None:
            assert beam is not None
            return self._measured(beam, found.scene, frequencies=True)
        # a shaft that is e times as stiff on its bearings is e times as stiff as one on bearings
        # that are e times softer
        e = values.get("material.E", 1.0)
        own = self._measured(self.body, _softer(found.scene, e), frequencies=False)
        return {q: v * e if q.kind == STIFFNESS else v / e for q, v in own.items()}

    def _measured(self, body: Body, scene: Scene, frequencies: bool) -> dict[Quantity, float]:
        main, *further = (condense(body, scene, port.name) for port in scene.ports)
        numbers = measure(main, None, {one.port: one for one in further})
        return numbers | (self._frequencies(body, scene) if frequencies else {})

    def _frequencies(self, body: Body, scene: Scene) -> dict[Quantity, float]:
        """Frequencies of the modes of the first point, by their shapes: names are counted anew where
        others come between.
        """
        if self._first is None:
            self._first = modes(body, scene, scene.ask.modes)
        found = modes(body, scene, scene.ask.modes + FURTHER_MODES)
        pairs = pair_modes(found, self._first)
        return {Quantity(p.reference.name): p.frequency_hz for p in pairs if p.mode is not None}


def _one_modulus(scene: Scene, inputs: Sequence[OpenInput]) -> bool:
    """True where an open modulus is that of all of the shaft, or none is open."""
    alike = len({segment.material.E for segment in scene.segments}) == 1
    moduli = [one.path for one in inputs if one.path.endswith("material.E")]
    return not moduli or (alike and moduli == ["material.E"])


def _choice(values: Mapping[str, float]) -> Choice:
    """Place in the data of catalogue bearings."""
    apart: dict[str, dict] = {}
    for path, value in values.items():
        key = next((k for k in (INSIDE, CLEARANCE, PRELOAD) if path.endswith(k)), None)
        if key is None:
            continue
        name = path.removeprefix("bearing.").removesuffix(key).removesuffix(".catalogue")
        put = ENDS[min(int(3 * value), 2)] if key == INSIDE else value
        field = {INSIDE: "end", CLEARANCE: "clearance", PRELOAD: "preload"}[key]
        apart.setdefault(name, {})[field] = put
    each = {name: Choice(**fields) for name, fields in apart.items()}
    return Choice(load=values.get("load", 1.0), overrides=each)


def _softer(scene: Scene, e: float) -> Scene:
    """The scene on springs that are e times softer."""
    if e == 1:
        return scene
    own, axial = scene.housing, scene.housing_axial
    return scene.with_bearing_scale(1 / e).with_changes(
        housing=own and own.scaled(1 / e), housing_axial=axial and axial / e
    )
