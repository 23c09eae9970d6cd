"""How a gearbox runs: load cases, engine and load, lubricant, as tables of a train."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import exp, fsum, log, pi, radians
from typing import Any

import numpy as np

from solidgear.exchange.rexs.commented import Sourced, said
from solidgear.exchange.rexs.document import Component
from solidgear.exchange.rexs.gearbox import Gearbox, PairStage, PlanetStage
from solidgear.exchange.rexs.gears import ratio_of, teeth_of
from solidgear.exchange.rexs.materials import density_of
from solidgear.exchange.rexs.shafts import Shaft

#: twist of an elastic coupling under the torque that it is chosen for, rad (DIN 740: some degrees)
TWIST = radians(3.0)
#: difference of a sum of shares from 1 that their digits leave
ROUNDED = 1e-3
#: of unit vectors: a direction along an axis
ALONG = 1 - 1e-6


@dataclass(frozen=True)
class Case:
    """A load case: the components as they are in it."""

    name: str
    share: float | None
    components: dict[int, Component]


@dataclass(frozen=True)
class Drive:
    """Which loads of a file bring torque and take it."""

    engine: Component
    load: Component
    sides: tuple[Shaft, Shaft]
    torque: Component  #: the load whose torque the file gives
    torque_side: Shaft
    turns: dict[int, float]  #: of every shaft in one of the engine's, by the number of the shaft
    engine_sign: float  #: of the torque of the engine in the first case, about y


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
            name = f"case {case.id}"
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
    loads = [
        (first[load.id], shaft)
        for load in document.of_kind("external_load")
        if (shaft := gearbox.shaft_of(load)) is not None and shaft.component.id in joined
    ]
    given = [(x, side) for x, side in loads if any(torque_in(gearbox, c, x, side) for c in cases)]
    if not given:
        notes.ask("no load of the file has a torque: write [engine], [load] and [[operation]]")
        return None
    defining = next((pair for pair in given if pair[0].flag("defines_torque")), given[0])
    load, shaft = defining
    turns = turns_from(gearbox, shaft)
    speed = _speed_on(gearbox, cases[0], shaft)
    torque = next(t for c in cases if (t := torque_in(gearbox, c, load, shaft)))
    others = [
        (other, side)
        for other, side in loads
        if side is not shaft
        and other.flag("transmits_torque") is not False
        and side.component.id in turns
    ]
    brings = torque * (speed or torque) >= 0
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
    return Drive(engine[0], taker[0], (engine[1], taker[1]), load, shaft, turns, sign)


def torque_in(gearbox: Gearbox, case: Case, load: Component, shaft: Shaft) -> float | None:
    """Return the torque of a load about its shaft in a case, N m: as given, or of its power."""
    component = case.components[load.id]
    torque, power = component.number("torque_around_u_axis"), component.number("power")
    if torque is None and power:
        speed = _speed_on(gearbox, case, shaft)
        return power / speed if speed else None
    return torque


def _speed_on(gearbox: Gearbox, case: Case, shaft: Shaft) -> float | None:
    """Return the speed of a shaft, rad/s, from any shaft whose speed the file gives."""
    turns = turns_from(gearbox, shaft)
    shafts = [case.components[n] for n in turns]
    shafts.sort(key=lambda s: not s.flag("defines_speed"))
    for other in shafts:
        speed = other.number("rotational_speed")
        if speed:
            return speed / turns[other.id]
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


def rotor_tables(
    gearbox: Gearbox, drive: Drive, cases: list[Case], ports: dict[int, str]
) -> dict[str, Any]:
    """Return the tables of engine and load: their inertia and couplings are no part of REXS."""
    out = {}
    side = drive.torque_side
    torques = [torque_in(gearbox, c, drive.torque, side) for c in cases]
    torque = max(abs(t) for t in torques if t)
    here = drive.turns[drive.torque_side.component.id]
    for role, load, shaft in zip(("engine", "load"), (drive.engine, drive.load), drive.sides):
        ratio = drive.turns[shaft.component.id] / here
        port = ports.get(load.id) if gearbox.shaft_of(load) is shaft else None
        port = port or next(g.name for g in gearbox.gears.values() if g.shaft is shaft)
        stiffness = said(float(f"{torque / abs(ratio) / TWIST:.4g}"), "N*m/rad")
        inertia = said(float(f"{polar_inertia(gearbox, shaft):.4g}"), "kg*m^2")
        out[role] = {
            "shaft": Sourced(shaft.name, load.label),
            "inertia": Sourced(inertia, "assumed: as that of its shaft"),
            "status": "assumed",
            "spring": {
                "stiffness": Sourced(stiffness, "assumed: twists by 3 deg under the torque"),
                "at": Sourced(port, load.label),
                "status": "assumed",
            },
        }
    gearbox.notes.ask(
        "inertia and coupling of the machines at both ends, which set the lowest torsional modes: "
        "[engine] and [load] are assumed, each as heavy as its shaft, behind a coupling that twists by "
        "3 deg under the largest torque"
    )
    return out


def polar_inertia(gearbox: Gearbox, shaft: Shaft) -> float:
    """Return the inertia of a shaft about its axis, kg m^2, its wheels left out."""
    density, _ = density_of(gearbox, shaft.component)
    return (
        density
        * pi
        / 32
        * fsum(
            section.length * (_fourth(*section.outer) - _fourth(*section.inner))
            for section in shaft.sections
        )
    )


def _fourth(a: float, b: float) -> float:
    """Return the mean of the fourth power of a diameter along a cone."""
    return (a**4 + a**3 * b + a**2 * b**2 + a * b**3 + b**4) / 5


def operation_tables(
    gearbox: Gearbox, drive: Drive, cases: list[Case], ports: dict[int, str]
) -> list[dict[str, Any]]:
    """Return the operating points; `ports` names the lumped points of loads that push."""
    notes, out = gearbox.notes, []
    side = drive.torque_side
    first = None
    shares = [case.share for case in cases]
    duty = len(cases) > 1 and all(shares) and abs(fsum(s or 0.0 for s in shares) - 1) <= ROUNDED
    if any(shares) and len(cases) > 1 and not duty:
        notes.doubt(
            "load spectrum", f"its shares of time are {shares}, which do not sum to 1: left out"
        )
    for case in cases:
        speed = _speed_on(gearbox, case, side)
        load = case.components[drive.torque.id]
        torque = torque_in(gearbox, case, drive.torque, side)
        if not torque:
            notes.drop(f"load {case.name}", "has no torque")
            continue
        first = first or torque
        table: dict[str, Any] = {"name": case.name}
        word = "torque_around_u_axis" if load.attribute("torque_around_u_axis") else "power"
        source = f"{load.label}: {word}"
        table["torque"] = Sourced(
            said(abs(torque) * (1 if torque * first > 0 else -1), "N*m"), source
        )
        if side is not drive.sides[0]:
            table["of"] = side.name
        if speed:
            rpm = said(float(f"{abs(speed) * 30 / pi:.12g}"), "rpm")
            table["speed"] = Sourced(rpm, "rotational_speed")
        else:
            notes.ask("no shaft has a rotational_speed: write speed under [[operation]]")
        if duty:
            table["share"] = Sourced(case.share, "share of the operating time")
        if (weight := _weight(gearbox, case)) is not None:
            table["weight"] = weight
        if forces := _forces(gearbox, case, ports):
            table["force"] = forces
        out.append(table)
    return out


def _weight(gearbox: Gearbox, case: Case) -> Sourced | None:
    """Return the direction of weight, where it is along an axis of the first shaft."""
    for unit in (c for c in case.components.values() if c.kind == "gear_unit"):
        if unit.flag("account_for_gravity") is not True:
            return None
        names = [f"direction_vector_gravity_{axis}" for axis in "uvw"]
        vector = np.array([unit.number(name) or 0.0 for name in names])
        first = gearbox.reference
        turned = vector[[2, 0, 1]] if first is None else first.train_axes.T @ vector
        size = float(np.linalg.norm(turned))
        place = int(np.argmax(np.abs(turned)))
        if not size or abs(turned[place]) < ALONG * size:
            gearbox.notes.drop(unit, "weight does not act along an axis of the first shaft")
            return None
        word = ("-" if turned[place] < 0 else "") + "xyz"[place]
        return Sourced(word, f"{unit.label}: direction_vector_gravity")
    return None


def load_vector(load: Component, shaft: Shaft) -> tuple[np.ndarray, np.ndarray]:
    """Return force (3,), N, and moment (3,), N m, of a load in x, y, z of its scene."""
    force = [load.number(f"force_{axis}_direction") or 0.0 for axis in "uvw"]
    moment = [0.0, *(load.number(f"torque_around_{axis}_axis") or 0.0 for axis in "vw")]
    return shaft.turn @ np.array(force), shaft.turn @ np.array(moment)


def _forces(gearbox: Gearbox, case: Case, ports: dict[int, str]) -> list[Any]:
    out = []
    for number, port in ports.items():
        load = case.components[number]
        shaft = gearbox.shaft_of(load)
        if shaft is None:
            continue
        force, moment = load_vector(load, shaft)
        entry: dict[str, Any] = {"at": f"{shaft.name}.{port}"}
        entry |= {key: said(float(v), "N") for key, v in zip("xyz", force) if v}
        entry |= {
            f"th{k}": said(float(moment[i]), "N*m") for i, k in ((0, "x"), (2, "z")) if moment[i]
        }
        if len(entry) > 1:
            out.append(Sourced(entry, load.label))
    return out


def lubrication_table(gearbox: Gearbox, shaft_bearings: list[Component]) -> dict[str, Any]:
    """Return the lubrication of the bearings of a shaft; empty where the file has no lubricant."""
    document, notes = gearbox.document, gearbox.notes
    lubricants = document.of_kind("lubricant")
    factors = [b.number("contamination_factor_iso_281_2007") for b in shaft_bearings]
    case = cases_of(gearbox)[0].components
    casings = [c for c in case.values() if c.kind == "gear_casing"]
    viscosity = next((v for c in casings if (v := c.number("operating_viscosity"))), None)
    source = "operating_viscosity"
    if viscosity is None and lubricants:
        oil = lubricants[0]
        cold, hot = (oil.number(f"viscosity_at_{t}_degree_celsius") for t in (40, 100))
        temperature = next((t for c in casings if (t := c.number("temperature_lubricant"))), None)
        if cold and hot and temperature is not None:
            viscosity = viscosity_at(temperature, cold, hot)
            source = f"{oil.label} at {temperature:g} C, by Walther (ASTM D341)"
    if not viscosity or not shaft_bearings:
        return {}
    if len(lubricants) > 1:
        notes.drop("lubricants", f"all but {lubricants[0].label}: a shaft has one")
    factor = next((f for f in factors if f is not None), None)
    if factor is None:
        notes.assume(
            "bearings without contamination factor", 'are of "normal" cleanliness (ISO 281)'
        )
    cleanliness = Sourced(factor if factor is not None else "normal", "contamination factor")
    return {
        "viscosity": Sourced(said(float(f"{viscosity:.6g}"), "mm^2/s", 1e-6), source),
        "cleanliness": cleanliness,
    }


def viscosity_at(temperature: float, cold: float, hot: float) -> float:
    """Return the viscosity of an oil at a temperature (Celsius) from those at 40 and 100 degrees,
    m^2/s, by Walther's straight line.

    Examples
    --------
    >>> round(1e6 * viscosity_at(40.0, 1e-4, 1.1e-5), 6), round(1e6 * viscosity_at(70.0, 1e-4, 1.1e-5), 1)
    (100.0, 27.0)
    """

    def height(viscosity: float) -> float:
        return log(log(1e6 * viscosity + 0.7))

    places = [log(t + 273.15) for t in (40.0, 100.0, temperature)]
    slope = (height(hot) - height(cold)) / (places[1] - places[0])
    return 1e-6 * (exp(exp(height(cold) + slope * (places[2] - places[0]))) - 0.7)


def planets_of(gearbox: Gearbox, shaft: Shaft) -> list[PlanetStage]:
    """Return the stages whose carrier a shaft is."""
    return [stage for stage in gearbox.planetary if stage.carrier is shaft]
