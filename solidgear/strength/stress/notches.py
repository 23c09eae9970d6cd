"""Features of a drawing as notches of DIN 743: which factors each has, or why it has none.

Another kind of feature is a line in `NOTCHES`: a function of the feature and its place that returns a
notch, or the reason why it is not rated.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from solidgear.core import TOUCH
from solidgear.strength.stress.din743 import LOADS
from solidgear.strength.stress.norm import forms, tested
from solidgear.strength.stress.norm_notch import (
    NotchByForm,
    NotchByTests,
    Section,
)
from solidgear.strength.stress.rated_notch import Steel

if TYPE_CHECKING:
    from solidgear.core import Scene
    from solidgear.core.scene import Segment

#: a notch with the remarks on it, or the reason why it has no rating
NotchOrReason: TypeAlias = "DrawnNotch | str"


@dataclass(frozen=True)
class DrawnNotch:
    """A notch by the norm, and what a reader must know about it."""

    notch: NotchByTests | NotchByForm
    remarks: tuple[str, ...] = ()
    counted: tuple[str, ...] = ()  #: names of other features that its factors hold


@dataclass(frozen=True)
class Place:
    """A feature on its shaft."""

    feature: Any
    segment: Segment
    scene: Scene

    @property
    def span(self) -> tuple[float, float]:
        """Ends along the shaft, m."""
        return self.feature.span(self.scene.segments)

    @property
    def section(self) -> Section:
        """The plain section of its segment."""
        return Section(2 * self.segment.outer0, 2 * self.segment.inner0)

    def floor(self, depth: float) -> Section:
        """Return the section at the floor of a groove of a depth, m."""
        return Section(2 * (self.segment.outer0 - depth), 2 * self.segment.inner0)

    def beside(self, kind: str) -> list[Place]:
        """Return the other features of a kind that this one overlaps."""
        lo, hi = self.span
        others = [
            Place(other, self.segment, self.scene)
            for other in self.scene.features
            if other is not self.feature
            and other.kind == kind
            and other.segment == self.feature.segment
        ]
        return [o for o in others if o.span[0] < hi - TOUCH and o.span[1] > lo + TOUCH]


def drawn_notch(scene: Scene, feature: Any) -> NotchOrReason:
    """Return a feature of a scene as a notch of the norm, or why it is none.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/pinion_keyed.toml")
    >>> drawn_notch(scene, scene.features[0]).notch.source
    'DIN 743-2, table 1: one keyway'
    """
    segment = next(s for s in scene.segments if s.name == feature.segment)
    notch_of = NOTCHES.get(feature.kind)
    if notch_of is None:
        return WITHOUT.get(feature.kind, "DIN 743 has no notch factor for it")
    return notch_of(Place(feature, segment, scene))


def _keyway(place: Place) -> NotchOrReason:
    others = place.beside("keyway")
    count = 1 + len(others)
    words = "one keyway" if count == 1 else "two keyways, 1.15 times one"
    notch = NotchByTests(
        place.section,
        f"DIN 743-2, table 1: {words}",
        tested=lambda steel: tested.keyway(steel.ultimate, count),
        tested_diameter=tested.KEYED,
        tested_roughness=0.0,
        revolved=False,
    )
    counted = tuple(other.feature.name for other in others)
    return DrawnNotch(notch, tuple(_keyway_remarks(place, count)), counted)


def _keyway_remarks(place: Place, count: int) -> Iterator[str]:
    if count > 2:
        yield f"{count} keyways side by side, and the norm goes to two"
    if place.feature.mill is not None:
        yield "rated as one by end mill; by disc mill it is milder"


def _press_fit(place: Place) -> NotchOrReason:
    fit, segment = place.feature, place.segment
    pressure = f"it presses with {fit.pressure(segment) / 1e6:.4g} MPa (Lame, both elastic)"
    limit = fit.hub_limit(segment)
    if limit is None:
        pressure += "; whether the hub bears that is not judged without hub_yield_point"
    else:
        pressure += f", and its hub yields at {limit / 1e6:.4g} MPa"
    notch = NotchByTests(
        place.section,
        "DIN 743-2, table 1: press fit",
        tested=lambda steel: tested.press_fit(steel.ultimate),
        tested_diameter=tested.KEYED,
        tested_roughness=0.0,
        revolved=True,
    )
    return DrawnNotch(notch, (pressure,))


def _spline(place: Place) -> NotchOrReason:
    teeth = place.feature
    root = Section(2 * teeth.root * place.segment.outer0, 2 * place.segment.inner0)
    notch = NotchByTests(
        root,
        f"DIN 743-2, table 1: {teeth.profile} profile, at the root diameter",
        tested=lambda steel: tested.profile(teeth.profile, steel.ultimate),
        tested_diameter=tested.SPLINED,
        tested_roughness=0.0,
        revolved=False,
    )
    return DrawnNotch(notch)


def _ring_groove(place: Place) -> NotchOrReason:
    groove = place.feature
    depth, radius = groove.depth_in(place.segment.outer0), groove.radius or 0.0

    def factors(steel: Steel) -> Any:
        return tested.rectangular_groove(depth, groove.width, radius, steel.yield_point)

    notch = NotchByTests(
        place.floor(depth),
        "DIN 743-2, 4.2.4: rectangular groove",
        tested=factors,
        tested_diameter=tested.GROOVED,
        tested_roughness=tested.TESTED_ROUGHNESS,
        revolved=True,
    )
    sharp = () if groove.radius else ("rated with sharp corners, since it has no radius",)
    return DrawnNotch(notch, sharp)


def _v_groove(place: Place) -> NotchOrReason:
    groove, radius = place.feature, place.segment.outer0
    depth = groove.depth_in(radius)
    floor = place.floor(depth)
    share, (least, most) = depth / floor.outer, tested.V_DEPTH
    if not least <= share <= most:
        return (
            f"the norm has V grooves with t/d from {least:g} to {most:g}, and this has {share:.2g}"
        )
    remarks = []
    if abs(groove.radius - 1e-4) > 1e-6:
        remarks.append(
            f"the norm's factor is for a radius of 0.1 mm, and this has {1e3 * groove.radius:g} mm"
        )
    notch = NotchByTests(
        floor,
        "DIN 743-2, 4.2.3: V groove",
        tested=lambda steel: tested.v_groove(steel.ultimate),
        tested_diameter=tested.V_CUT,
        tested_roughness=tested.TESTED_ROUGHNESS,
        revolved=True,
    )
    return DrawnNotch(notch, tuple(remarks))


def _round_groove(place: Place) -> NotchOrReason:
    groove = place.feature
    depth = groove.depth_in(place.segment.outer0)
    return _rounded(place.floor(depth), depth, groove.radius, "round groove")


def _rounded(
    floor: Section, depth: float, radius: float, what: str, *remarks: str
) -> NotchOrReason:
    small = floor.outer
    form = {load: forms.round_groove(load, small, depth, radius) for load in LOADS}
    reason = forms.out_of_range(small, small + 2 * depth, radius, form)
    if reason:
        return f"outside of the norm's formulas for a round groove: {reason}"
    gradient = {load: forms.round_gradient(load, small, depth, radius) for load in LOADS}
    source = f"DIN 743-2, table 2: {what}"
    return DrawnNotch(NotchByForm(floor, source, form, gradient, revolved=True), remarks)


def _thread(place: Place) -> NotchOrReason:
    thread = place.feature
    core = Section(thread.core, 2 * place.segment.inner0)
    depth = (thread.nominal - thread.core) / 2
    return _rounded(
        core,
        depth,
        thread.root,
        f"round groove with the root radius {1e3 * thread.root:.3g} mm of {thread.size} (ISO 68-1)",
        "the norm has no thread: rated as one groove, whose factor is above that of a thread",
    )


def _relief(place: Place) -> NotchOrReason:
    relief, segment = place.feature, place.segment
    floor = place.floor(relief.depth)
    shoulder = 2 * relief.shoulder(place.scene.segments)
    between = 2 * segment.outer0
    form = {
        load: forms.undercut(load, shoulder, between, floor.outer, relief.radius) for load in LOADS
    }
    groove = {
        load: forms.round_groove(load, floor.outer, relief.depth, relief.radius) for load in LOADS
    }
    reason = forms.out_of_range(floor.outer, shoulder, relief.radius, form | groove)
    if reason:
        return f"outside of the norm's formulas for an undercut: {reason}"
    gradient = {
        load: forms.round_gradient(load, floor.outer, relief.depth, relief.radius) for load in LOADS
    }
    source = f"DIN 743-2, 5.2.2: undercut of form {relief.form} beside a shoulder"
    return DrawnNotch(NotchByForm(floor, source, form, gradient, revolved=True))


def _cross_hole(place: Place) -> NotchOrReason:
    hole, segment = place.feature, place.segment
    if hole.inclination or hole.offset:
        return "the norm has holes through the axis at right angles to it, and this one leans or passes it"
    outer = 2 * segment.outer0
    section = Section(outer, 2 * segment.inner0, hole.diameter)
    form = {load: forms.cross_hole(load, hole.diameter, outer) for load in LOADS}
    gradient = {load: forms.hole_gradient(load, hole.diameter, outer) for load in LOADS}
    source = "DIN 743-2, 5.2.3: cross hole, on the section without its strip"
    return DrawnNotch(NotchByForm(section, source, form, gradient, revolved=False))


#: by kind
NOTCHES: Mapping[str, Callable[[Place], NotchOrReason]] = {
    "keyway": _keyway,
    "press_fit": _press_fit,
    "spline": _spline,
    "ring_groove": _ring_groove,
    "v_groove": _v_groove,
    "round_groove": _round_groove,
    "thread": _thread,
    "relief": _relief,
    "cross_hole": _cross_hole,
}
#: why kinds without a factor have none
WITHOUT: Mapping[str, str] = {
    "teeth": "DIN 743 has no notch factor for gear teeth; their roots are rated by ISO 6336-3",
    "flat": "DIN 743 has no notch factor for a flat",
    "bolt_circle": "DIN 743 has no notch factor for holes along the axis",
}
