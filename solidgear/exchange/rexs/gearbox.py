"""A gearbox in a REXS document: shafts in one frame, gears on them, stages between them."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field

import numpy as np

from solidgear.exchange.rexs.document import JOINTS, Component, Document, RexsError
from solidgear.exchange.rexs.frames import Frame, along, frame_of
from solidgear.exchange.rexs.notes import Notes
from solidgear.exchange.rexs.shafts import Shaft, is_file_name, plain_name, sections_of

#: difference of places, m, or share of a distance, that digits leave
NEAR, SHARE = 1e-5, 1e-4
#: axes u, v, w of a shaft by those of a scene, where the file places nothing
PLAIN_TURN = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
GEARS = ("cylindrical_gear", "ring_gear")


@dataclass(frozen=True)
class GearOnShaft:
    """A gear, where it sits on its shaft."""

    name: str
    component: Component
    shaft: Shaft
    y: float  #: middle of the face, m


@dataclass(frozen=True)
class PairStage:
    """A cylindrical stage between two gears."""

    name: str
    component: Component
    gears: tuple[GearOnShaft, GearOnShaft]


@dataclass(frozen=True)
class PlanetStage:
    """A planetary stage: its parts by what they are."""

    name: str
    component: Component
    sun: GearOnShaft
    ring: Component
    planets: tuple[GearOnShaft, ...]
    pins: tuple[Shaft, ...]
    carrier: Shaft
    #: other shafts of the carrier, and its side plates
    carrier_parts: tuple[Component, ...]
    stages: tuple[Component, ...]  #: cylindrical stages of the planets with sun and ring


@dataclass
class Gearbox:
    """Shafts, gears and stages of a document, as far as trains have them."""

    document: Document
    notes: Notes
    shafts: dict[int, Shaft] = field(default_factory=dict)
    #: what is wrong with shafts that are none, by number: of no matter unless a stage needs them
    unsound: dict[int, RexsError] = field(default_factory=dict)
    gears: dict[int, GearOnShaft] = field(default_factory=dict)
    pairs: list[PairStage] = field(default_factory=list)
    planetary: list[PlanetStage] = field(default_factory=list)
    #: profile shifts that the file leaves open, as they were filled, by the number of the gear
    shifts: dict[int, float] = field(default_factory=dict)
    reference: Frame | None = None  #: of the shaft whose axes are those of the train

    def name_of(self, part: Component, taken: Collection[str], usual: str) -> str:
        """Return what a component is called in files: its name where a file had it before."""
        # files are called after shafts, wherever the names come from
        is_sound = part.kind != "shaft" or (part.name not in taken and is_file_name(part.name))
        if self.document.is_ours and part.name and is_sound:
            return part.name
        return plain_name(part.name, taken, usual)

    def shaft_of(self, part: Component) -> Shaft | None:
        """Return the shaft that a component is a part of."""
        whole = self.document.whole_of(part, "shaft")
        return None if whole is None else self.shafts.get(whole.id)

    def is_ring_held(self, shaft: Component) -> bool:
        """Return True where a coupling holds a shaft to the casing."""
        return any(other.kind == "gear_casing" for _, other in couplings_of(self.document, shaft))

    @property
    def joined(self) -> list[tuple[Shaft, Shaft]]:
        """Shafts that stages join, in pairs."""
        pairs = [(stage.gears[0].shaft, stage.gears[1].shaft) for stage in self.pairs]
        return pairs + [(stage.sun.shaft, stage.carrier) for stage in self.planetary]


def couplings_of(document: Document, part: Component) -> Iterator[tuple[Component, Component]]:
    """Yield the engaged couplings of a part, each with what is on their other side."""
    for coupling in document.of_kind("coupling", "switchable_coupling"):
        sides = document.sides_of(coupling)
        if sides is None or part not in sides or not is_engaged(document, coupling):
            continue
        yield coupling, sides[1] if sides[0] == part else sides[0]


def is_engaged(document: Document, coupling: Component) -> bool:
    """Return True for a coupling that is closed in the gear that the gear unit is in."""
    attribute = coupling.attribute("is_engaged")
    if attribute is None:
        return True
    words = attribute.value
    if isinstance(words, str):
        return words.lower() == "true"
    units = document.of_kind("gear_unit")
    index = (units[0].whole("gear_shift_index") or 1) if units else 1
    if not 1 <= index <= len(words):
        raise coupling.wrong("is_engaged", f"says nothing of gear {index}")
    return str(words[index - 1]).lower() == "true"


def gearbox_of(document: Document, notes: Notes) -> Gearbox:
    """Return the gearbox in a document.

    Raises
    ------
    RexsError
        Several gear units, no shaft, sections that are no shaft, gears of which no stage can be made.
    """
    units = document.of_kind("gear_unit")
    if len(units) > 1:
        names = ", ".join(unit.label for unit in units)
        raise RexsError(f"holds {len(units)} gear units ({names}); a train is one: export one")
    gearbox = Gearbox(document, notes)
    _add_shafts(gearbox)
    _note_joints(gearbox)
    _add_gears(gearbox)
    in_planets = _add_planetary(gearbox)
    _add_pairs(gearbox, in_planets)
    if not (gearbox.pairs or gearbox.planetary) and gearbox.gears:
        names = ", ".join(gear.component.label for gear in gearbox.gears.values())
        raise RexsError(f"no stage joins its gears ({names}): {_why_no_stage(gearbox)}")
    return gearbox


def _why_no_stage(gearbox: Gearbox) -> str:
    """Return for each stage of the file why it is none here, or that there is none."""
    reasons = []
    for component in gearbox.document.components.values():
        if component.kind.endswith("_stage"):
            why = gearbox.notes.reasons(component) or ["trains here have no such stage"]
            reasons.append(f"{component.label}: {'; '.join(why)}")
    missing = "a cylindrical_stage with gear_1 and gear_2 is missing"
    return "; ".join(reasons) or missing


def _note_joints(gearbox: Gearbox) -> None:
    """Note how fits, keys and splines are taken."""
    for joint in gearbox.document.of_kind(*JOINTS):
        sides = gearbox.document.sides_of(joint)
        if gearbox.document.joined(joint) is not None:
            gearbox.notes.assume(joint, "holds its gear to its shaft as if both were one piece")
        elif sides is None:
            gearbox.notes.drop(joint, "no relation says between what it is")
        else:
            ends = " to ".join(side.label for side in sides)
            gearbox.notes.drop(joint, f"joins {ends}: trains have no such joint")


def _add_shafts(gearbox: Gearbox) -> None:
    document, notes = gearbox.document, gearbox.notes
    shafts = document.of_kind("shaft")
    if not shafts:
        raise RexsError("holds no component of the type shaft, and no gearbox")
    frames = {shaft.id: frame_of(document, shaft) for shaft in shafts}
    placed = [shaft for shaft in shafts if frames[shaft.id] is not None]
    # that of a shaft with gears, for worms and others may stand at any angle to the train
    placed.sort(key=lambda shaft: not document.parts_of(shaft, *GEARS))
    first = gearbox.reference = frames[placed[0].id] if placed else None
    names: list[str] = []
    for shaft in shafts:
        frame = frames[shaft.id]
        sign, turn = 1, PLAIN_TURN
        if frame is not None and first is not None:
            way = along(frame, first, shaft)
            if way is not None:
                sign, turn = way, first.train_axes.T @ frame.axes
        taken = names if document.is_ours else [*names, "shaft"]
        name = gearbox.name_of(shaft, taken, f"shaft_{shaft.id}")
        try:
            sections, start = sections_of(document, shaft, sign, notes)
        except RexsError as error:
            gearbox.unsound[shaft.id] = error
            continue
        names.append(name)
        gearbox.shafts[shaft.id] = Shaft(
            name, shaft, tuple(sections), frame, sign, np.round(turn, 12), start
        )
    if not gearbox.shafts:
        raise next(iter(gearbox.unsound.values()))
    for number, problem in gearbox.unsound.items():
        if gearbox.document.parts_of(document.components[number], *GEARS):
            raise problem
        notes.drop(document.components[number], f"no shaft can be made of it ({problem})")


def _add_gears(gearbox: Gearbox) -> None:
    names: list[str] = []
    for gear in gearbox.document.of_kind("cylindrical_gear", *_bevel(gearbox, "gear")):
        shaft = gearbox.shaft_of(gear)
        if shaft is None:
            gearbox.notes.drop(gear, "sits on no shaft of the train")
            continue
        name = gearbox.name_of(gear, names, f"gear_{gear.id}")
        names.append(name)
        y = _middle(gearbox, gear, shaft)
        gearbox.gears[gear.id] = GearOnShaft(name, gear, shaft, y)


def _bevel(gearbox: Gearbox, part: str) -> list[str]:
    """Return the type of bevel gears or stages, which are read where this program wrote them: others
    give no place of the apex that files have.
    """
    return [f"bevel_{part}"] if gearbox.document.is_ours else []


def _middle(gearbox: Gearbox, gear: Component, shaft: Shaft) -> float:
    """Return the place of the middle of a face on its shaft, m: of the frame of the gear, which is
    there in every version, while the coordinate of 1.0 is that of its beginning.
    """
    place, u = _place_of_frame(gearbox, gear, shaft), gear.number("u_coordinate_on_shaft")
    width = gear.number("face_width")
    if not width or width < 0:
        reason = "is missing; teeth need a width" if width is None else "must be greater than zero"
        raise gear.wrong("face_width", reason)
    if place is None:
        if u is None:
            raise RexsError(f"{gear.label}: neither u_coordinate_on_shaft nor support_vector")
        return shaft.place(u + (width / 2 if gearbox.document.version == "1.0" else 0.0))
    if u is None or abs(place - u) <= NEAR:
        return shaft.place(place)
    if abs(place - u - width / 2) > NEAR:
        gearbox.notes.doubt(
            gear,
            f"lies at {1e3 * place:.6g} mm of its shaft by its support_vector and at "
            f"{1e3 * u:.6g} mm by u_coordinate_on_shaft; the first is taken",
        )
    return shaft.place(place)


def place_of(
    gearbox: Gearbox, part: Component, shaft: Shaft, name: str = "u_coordinate_on_shaft"
) -> float:
    """Return the coordinate of a load, a mass, a bearing or a coupling on a shaft, m: as the file gives
    it, or else by the frame of the part; note where these differ.

    Raises
    ------
    RexsError
        A part with neither.
    """
    place, u = _place_of_frame(gearbox, part, shaft), part.number(name)
    if u is None:
        if place is None:
            raise part.wrong(name, "is missing, and so is a support_vector of the part")
        return place
    if place is not None and abs(place - u) > NEAR:
        gearbox.notes.doubt(
            part,
            f"lies at {1e3 * u:.6g} mm of {shaft.component.title} by {name} and at "
            f"{1e3 * place:.6g} mm by its support_vector; the first is taken",
        )
    return u


def _place_of_frame(gearbox: Gearbox, part: Component, shaft: Shaft) -> float | None:
    """Return the coordinate on a shaft of the origin of a part, m; None where the file places one of
    them nowhere.
    """
    frame = frame_of(gearbox.document, part)
    if frame is None or shaft.frame is None:
        return None
    return float((frame.origin - shaft.frame.origin) @ shaft.frame.u)


def _add_pairs(gearbox: Gearbox, in_planets: set[int]) -> None:
    document, names = gearbox.document, [stage.name for stage in gearbox.planetary]
    for stage in document.of_kind("cylindrical_stage", *_bevel(gearbox, "stage")):
        if stage.id in in_planets:
            continue
        ids = stage_gears(document, stage)
        if ids is None:
            gearbox.notes.drop(stage, "names no gear_1 and gear_2")
            continue
        gears = [gearbox.gears.get(i) for i in ids]
        if None in gears or gears[0] is gears[1]:
            others = ", ".join(document.components[i].label for i in ids)
            gearbox.notes.drop(stage, f"between {others}, which are not two gears on shafts here")
            continue
        name = gearbox.name_of(stage, names, f"stage_{stage.id}")
        names.append(name)
        first, second = (gear for gear in gears if gear is not None)
        frames = first.shaft.frame, second.shaft.frame
        is_bevel = stage.kind == "bevel_stage"
        if not is_bevel and None not in frames and along(frames[0], frames[1], stage) is None:
            gearbox.notes.drop(
                stage, "its shafts cross, and gears of cylindrical stages have parallel ones"
            )
            continue
        if first.shaft is second.shaft:
            raise RexsError(f"{stage.label}: both gears sit on {first.shaft.component.label}")
        gearbox.pairs.append(PairStage(name, stage, (first, second)))


def stage_gears(document: Document, stage: Component) -> tuple[int, int] | None:
    """Return the numbers of the two gears of a stage; None where the file does not name them."""
    for relation in document.related("stage", stage, "stage"):
        first, second = relation.ids("gear_1"), relation.ids("gear_2")
        if first and second:
            return first[0], second[0]
    return None


def _add_planetary(gearbox: Gearbox) -> set[int]:
    """Add the planetary stages that trains have; return the cylindrical stages of all of them."""
    document = gearbox.document
    inside: set[int] = set()
    names: list[str] = []
    for stage in document.of_kind("planetary_stage"):
        parts = document.parts_of(stage, "cylindrical_stage")
        inside |= {part.id for part in parts}
        name = gearbox.name_of(stage, names, f"planetary_{stage.id}")
        reason = _try_planetary(gearbox, stage, parts, name)
        if reason:
            gearbox.notes.drop(stage, reason)
        else:
            names.append(name)
    return inside


def _try_planetary(gearbox: Gearbox, stage: Component, parts: list[Component], name: str) -> str:
    """Add a planetary stage, or return why trains do not have it."""
    document = gearbox.document
    roles = {
        role: [
            relation.ids("shaft")[0]
            for relation in document.related(role, stage, "planetary_stage")
            if relation.ids("shaft")
        ]
        for role in ("planet_shaft", "planet_pin", "planet_carrier_shaft")
    }
    suns: dict[int, None] = {}
    rings: dict[int, None] = {}
    planets: dict[int, None] = {}
    for part in parts:
        ids = stage_gears(document, part)
        for number in ids or ():
            gear = document.components[number]
            whole = document.whole_of(gear, "shaft")
            if gear.kind == "ring_gear":
                rings[number] = None
            elif whole is not None and whole.id in roles["planet_shaft"]:
                planets[number] = None
            else:
                suns[number] = None
    counts = f"{len(suns)} suns, {len(planets)} planets, {len(rings)} rings"
    if len(suns) != 1 or len(rings) != 1 or not planets:
        return f"trains have stages of one sun, planets and one ring, and it has {counts}"
    ring = document.components[next(iter(rings))]
    ring_shaft = document.whole_of(ring, "shaft")
    if ring_shaft is not None and not gearbox.is_ring_held(ring_shaft):
        return f"its ring ({ring.label}) turns, or nothing holds it; rings of trains stand"
    carriers = [gearbox.shafts[i] for i in roles["planet_carrier_shaft"] if i in gearbox.shafts]
    if not carriers:
        return "no planet_carrier_shaft is named"
    carrier = max(carriers, key=lambda shaft: _supports(document, shaft.component))
    sun = gearbox.gears.get(next(iter(suns)))
    if sun is None or sun.shaft is carrier:
        return "its sun sits on no shaft beside the carrier"
    more = _carried(document, stage, carrier.component, roles)
    gearbox.planetary.append(
        PlanetStage(
            name,
            stage,
            sun,
            ring,
            tuple(gearbox.gears[i] for i in planets if i in gearbox.gears),
            tuple(gearbox.shafts[i] for i in roles["planet_pin"] if i in gearbox.shafts),
            carrier,
            tuple(more),
            tuple(parts),
        )
    )
    return ""


def _supports(document: Document, shaft: Component) -> int:
    """Return how many bearings, loads and gears a shaft has."""
    sides = (document.sides_of(b) for b in document.components.values() if "bearing" in b.kind)
    bearings = sum(1 for pair in sides if pair is not None and shaft in pair)
    return bearings + len(document.parts_of(shaft, "external_load", "cylindrical_gear"))


def _carried(
    document: Document, stage: Component, carrier: Component, roles: dict[str, list[int]]
) -> list[Component]:
    """Return side plates, and shafts that couplings join to the carrier, without pins and planets."""
    frame = [carrier]
    for whole in document.parts_of(stage, "planet_carrier"):
        frame += [p for p in document.parts_of(whole, "side_plate") if p not in frame]
    apart = {*roles["planet_pin"], *roles["planet_shaft"]}
    k = 0
    while k < len(frame):
        for _, other in couplings_of(document, frame[k]):
            is_frame = other.kind in ("shaft", "side_plate") and other.id not in apart
            if is_frame and other not in frame:
                frame.append(other)
        k += 1
    return frame[1:]
