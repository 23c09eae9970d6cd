"""Where torque enters a gearbox and leaves it: load cases, loads, and how fast each shaft turns."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from math import fsum, log

import numpy as np

from solidgear.exchange.rexs.document import Component
from solidgear.exchange.rexs.gearbox import SHARE, Gearbox, PairStage, couplings_of
from solidgear.exchange.rexs.gears import ratio_of, teeth_of
from solidgear.exchange.rexs.shafts import Shaft


@dataclass(frozen=True)
class Case:
    """A load case: the components as they are in it."""

    name: str
    share: float | None
    components: dict[int, Component]


@dataclass(frozen=True)
class Coupled:
    """A shaft without teeth that a coupling joins to one of the train."""

    coupling: Component
    shaft: Shaft
    inside: Shaft  #: of the train


@dataclass(frozen=True)
class Drive:
    """Which loads of a file bring torque and take it."""

    engine: Component
    load: Component
    sides: tuple[Shaft, Shaft]
    torque: Component  #: the load whose torque the file gives
    torque_side: Shaft
    turns: dict[int, float]  #: of every shaft in one of the engine's, by the number of the shaft
    engine_sign: float  #: of the torque of the engine in the first case, about y; 0 for no torque
    #: shafts behind couplings that loads of the drive sit on, by the number of the load
    coupled: dict[int, Coupled] = field(default_factory=dict)


def cases_of(gearbox: Gearbox) -> list[Case]:
    """Return the load cases, or the values of the components themselves as one."""
    document = gearbox.document
    out = []
    for spectrum in document.spectra:
        for case in spectrum.cases:
            components = dict(document.components)
            for component in case.components:
                base = document.components[component.id]
                components[component.id] = base.with_attributes(component.attributes)
            share = _share(components)
            units = [c for c in case.components if document.components[c.id].kind == "gear_unit"]
            name = f"case {case.id}"
            if document.is_ours and units and units[0].name:
                name = units[0].name
            if len(document.spectra) > 1:
                name = f"spectrum {spectrum.id} {name}"
            out.append(Case(name, share, components))
    return out or [Case("as given", None, dict(document.components))]


def _share(components: dict[int, Component]) -> float | None:
    units = [c for c in components.values() if c.kind == "gear_unit"]
    return units[0].number("operating_time_fraction") if units else None


def turns_from(gearbox: Gearbox, first: Shaft) -> dict[int, float]:
    """Return the turns of every shaft that teeth lead to, in one of the first, with their way, by the
    number of the shaft.
    """
    turns, queue = {first.component.id: 1.0}, deque([first])
    while queue:
        shaft = queue.popleft()
        here = turns[shaft.component.id]
        for other, ratio in _mates(gearbox, shaft):
            if other.component.id not in turns:
                turns[other.component.id] = here / ratio
                queue.append(other)
    return turns


def _mates(gearbox: Gearbox, shaft: Shaft) -> list[tuple[Shaft, float]]:
    """Return the shafts that teeth join to one, each with turns of this in one of that."""
    out = []
    for stage in gearbox.pairs:
        for here, there in (stage.gears, stage.gears[::-1]):
            if here.shaft is shaft:
                out.append((there.shaft, -ratio_of(here, there)))
    for planets in gearbox.planetary:
        ratio = 1 + teeth_of(planets.ring) / teeth_of(planets.sun.component)
        if planets.sun.shaft is shaft:
            out.append((planets.carrier, ratio))
        if planets.carrier is shaft:
            out.append((planets.sun.shaft, 1 / ratio))
    return out


def drive_of(gearbox: Gearbox, cases: list[Case]) -> Drive | None:
    """Return where torque comes in and goes out; None where the file gives no torque."""
    document, notes, first = gearbox.document, gearbox.notes, cases[0].components
    joined = {s.component.id for pair in gearbox.joined for s in pair}
    loads: list[tuple[Component, Shaft]] = []
    coupled: dict[int, Coupled] = {}
    for load in document.of_kind("external_load"):
        shaft = gearbox.shaft_of(load)
        if shaft is not None and shaft.component.id in joined:
            loads.append((first[load.id], shaft))
        elif shaft is not None and (behind := coupled_to(gearbox, shaft, joined)) is not None:
            loads.append((first[load.id], behind.inside))
            coupled[load.id] = behind
    given = [(x, side) for x, side in loads if any(torque_in(gearbox, c, x, side) for c in cases)]
    if not given and document.is_ours:
        given = [(x, side) for x, side in loads if x.flag("defines_torque")]
    if not given:
        notes.ask("no load of the file has a torque: write [engine], [load] and [[operation]]")
        return None
    defining = next((pair for pair in given if pair[0].flag("defines_torque")), given[0])
    load, shaft = defining
    turns = turns_from(gearbox, shaft)
    speed = speed_on(gearbox, cases[0], shaft)
    for case in cases:
        _doubt_torques(gearbox, case, loads, (load, shaft), turns)
    torques = (torque_in(gearbox, c, load, shaft) for c in cases)
    torque = next((t for t in torques if t), 0.0)
    others = [
        (other, side)
        for other, side in loads
        if side is not shaft
        and other.flag("transmits_torque") is not False
        and side.component.id in turns
    ]
    # where this program wrote it, the load that defines the torque is the engine, coasting or not
    brings = document.is_ours or torque * (speed or torque) >= 0
    if len(others) > 1:
        names = ", ".join(other.label for other, _ in others)
        notes.assume(load, f"its torque goes to {others[-1][0].label} alone, of {names}")
    if not others:
        far = _farthest(gearbox, shaft, turns)
        notes.assume(
            load, f"its torque passes to {far.component.label}; the file names no other load"
        )
        others = [(load, far)]
    other, side = others[-1]
    engine, taker = ((load, shaft), (other, side)) if brings else ((other, side), (load, shaft))
    scale = turns[engine[1].component.id]
    turns = {number: turn / scale for number, turn in turns.items()}
    sign = float(np.sign(torque)) * shaft.sign
    if not brings:
        # the engine turns its shaft, and its torque is about the way in which it turns
        sign = -sign * float(np.sign(turns[shaft.component.id]))
    sides = engine[1], taker[1]
    return Drive(engine[0], taker[0], sides, load, shaft, turns, sign, coupled)


def _doubt_torques(
    gearbox: Gearbox,
    case: Case,
    loads: list[tuple[Component, Shaft]],
    defining: tuple[Component, Shaft],
    turns: dict[int, float],
) -> None:
    """Note torques of a case that do not balance over the ratios, where all loads that transmit torque
    have one; what leaves the gearbox has either sign, as files differ.
    """
    torques: list[tuple[float, float]] = []
    for load, shaft in loads:
        if load.flag("transmits_torque") is False or shaft.component.id not in turns:
            continue
        torque = torque_in(gearbox, case, load, shaft)
        if torque is None:
            return
        if torque:
            torques.append((torque * shaft.sign, turns[shaft.component.id]))
    largest = max((abs(torque * turn) for torque, turn in torques), default=0.0)
    left = min(abs(fsum(t * w for t, w in torques)), abs(fsum(t * abs(w) for t, w in torques)))
    if len(torques) > 1 and left > SHARE * largest:
        load, shaft = defining
        gearbox.notes.doubt(
            f"torques ({case.name})",
            f"do not balance: {left:.6g} N m remain on {shaft.component.title}, perhaps as losses, which "
            f"a train at rest has not; the torque of {load.title} is taken",
        )


def coupled_to(gearbox: Gearbox, shaft: Shaft, joined: set[int]) -> Coupled | None:
    """Return how a coupling joins a shaft to one of the train; None where none does."""
    for coupling, other in couplings_of(gearbox.document, shaft.component):
        if other.id in joined:
            return Coupled(coupling, shaft, gearbox.shafts[other.id])
    return None


def torque_in(gearbox: Gearbox, case: Case, load: Component, shaft: Shaft) -> float | None:
    """Return the torque of a load about its shaft in a case, N m: as given, or of its power."""
    component = case.components[load.id]
    torque, power = component.number("torque_around_u_axis"), component.number("power")
    if torque is None and power:
        speed = speed_on(gearbox, case, shaft)
        return power / speed if speed else None
    return torque


def speed_on(gearbox: Gearbox, case: Case, shaft: Shaft) -> float | None:
    """Return the speed of a shaft, rad/s, from any shaft whose speed the file gives."""
    turns = turns_from(gearbox, shaft)
    shafts = [case.components[n] for n in turns]
    shafts.sort(key=lambda s: not s.flag("defines_speed"))
    for other in shafts:
        speed = other.number("rotational_speed")
        if speed:
            sign = gearbox.shafts[other.id].sign * shaft.sign
            return sign * speed / turns[other.id]
    return None


def _farthest(gearbox: Gearbox, shaft: Shaft, turns: dict[int, float]) -> Shaft:
    """Return the shaft that turns most unlike another."""
    others = [n for n in turns if n != shaft.component.id]
    return gearbox.shafts[max(others, key=lambda n: abs(log(abs(turns[n]))))]


def ordered(gearbox: Gearbox, drive: Drive | None) -> list[tuple[PairStage, str]]:
    """Return the pairs with the gear first that is nearer to the engine, each with the flank that it
    drives with, from the engine on.
    """
    joined = gearbox.joined
    start = drive.sides[0] if drive is not None else joined[0][0]
    order = list(turns_from(gearbox, start))
    out = []
    for stage in gearbox.pairs:
        gears = sorted(stage.gears, key=lambda g: _index(order, g.shaft.component.id))
        flank = ""
        if drive is not None and gears[0].shaft.component.id in drive.turns:
            way = drive.engine_sign * drive.turns[gears[0].shaft.component.id]
            # seen from the start of a shaft a right flank leads where it turns about +y
            flank = "right" if way > 0 else "left"
        ends = PairStage(stage.name, stage.component, (gears[0], gears[1]))
        out.append((_index(order, gears[0].shaft.component.id), ends, flank))
    return [(stage, flank) for _, stage, flank in sorted(out, key=lambda row: row[0])]


def _index(order: list[int], number: int) -> int:
    return order.index(number) if number in order else len(order)
