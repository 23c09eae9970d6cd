"""How a gearbox runs: load cases, engine and load, lubricant, as tables of a train."""

from __future__ import annotations

from math import exp, fsum, log, pi, radians
from typing import Any

import numpy as np

from solidgear.core.scene.units import quantity
from solidgear.exchange.rexs.bearings import RIGID_TURN
from solidgear.exchange.rexs.commented import Sourced, said
from solidgear.exchange.rexs.document import Component
from solidgear.exchange.rexs.drive import Case, Drive, cases_of, speed_on, torque_in
from solidgear.exchange.rexs.gearbox import Gearbox, PlanetStage
from solidgear.exchange.rexs.materials import density_of
from solidgear.exchange.rexs.planets import point_of
from solidgear.exchange.rexs.shafts import Shaft

#: twist of an elastic coupling under the torque that it is chosen for, rad (DIN 740: some degrees)
TWIST = radians(3.0)
#: rad/s in a turn a minute as files have it, and what its digits leave, relative
RPM, RPM_DIGITS = quantity("1 rpm", "speed"), 1e-14
#: difference of a sum of shares from 1 that their digits leave
ROUNDED = 1e-3
#: of unit vectors: a direction along an axis
ALONG = 1 - 1e-6


def rotor_tables(
    gearbox: Gearbox, drive: Drive, cases: list[Case], ports: dict[int, str]
) -> dict[str, Any]:
    """Return the tables of engine and load: their inertia and couplings are no part of REXS."""
    out = {}
    side = drive.torque_side
    torques = [torque_in(gearbox, c, drive.torque, side) for c in cases]
    torque = max((abs(t) for t in torques if t), default=0.0)
    here = drive.turns[drive.torque_side.component.id]
    for role, load, shaft in zip(("engine", "load"), (drive.engine, drive.load), drive.sides):
        ratio = drive.turns[shaft.component.id] / here
        behind = drive.coupled.get(load.id)
        is_here = behind is not None or gearbox.shaft_of(load) is shaft
        port = ports.get(load.id) if is_here else None
        port = port or main_point(gearbox, shaft)
        inertia = float(f"{polar_inertia(gearbox, shaft):.4g}")
        stiffness, source = (
            float(f"{torque / abs(ratio) / TWIST:.4g}"),
            "assumed: twists by 3 deg under the torque",
        )
        rotor, rotor_source = shaft, "assumed: as that of its shaft"
        if behind is not None:
            rotor, rotor_source = behind.shaft, f"of {behind.shaft.component.label}"
            inertia = _own_inertia(gearbox, rotor)
            if given := behind.coupling.number("rotational_stiffness"):
                stiffness = min(given, RIGID_TURN)
                source = f"{behind.coupling.label}: rotational_stiffness"
        out[role] = {
            "shaft": Sourced(shaft.name, load.label),
            "inertia": Sourced(said(inertia, "kg*m^2"), rotor_source),
            "status": "assumed",
            "spring": {
                "stiffness": Sourced(said(stiffness, "N*m/rad"), source),
                "at": Sourced(port, load.label if behind is None else behind.coupling.label),
                "status": "assumed",
            },
        }
        if behind is not None and not gearbox.document.is_ours:
            gearbox.notes.assume(
                behind.shaft.component,
                f"is the inertia of the {role}, behind its coupling; it bends nothing, and its machine "
                "adds none",
            )
    if {drive.engine.id, drive.load.id} <= {*drive.coupled}:
        return out
    gearbox.notes.ask(
        "inertia and coupling of the machines at both ends, which set the lowest torsional modes: "
        "[engine] and [load] are assumed, each as heavy as its shaft, behind a coupling that twists by "
        "3 deg under the largest torque"
    )
    return out


def _own_inertia(gearbox: Gearbox, shaft: Shaft) -> float:
    """Return the inertia of a shaft about its axis with the masses on it, kg m^2."""
    masses = gearbox.document.parts_of(shaft.component, "additional_mass")
    given = fsum(mass.number("moment_of_inertia_u_axis") or 0.0 for mass in masses)
    sections = polar_inertia(gearbox, shaft)
    return given + (sections if masses else float(f"{sections:.4g}"))


def main_point(gearbox: Gearbox, shaft: Shaft) -> str:
    """Return the first lumped point of a shaft: of its gears, or of the pins that it carries."""
    names = [gear.name for gear in gearbox.gears.values() if gear.shaft is shaft]
    return [*names, *map(point_of, planets_of(gearbox, shaft))][0]


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
        speed = speed_on(gearbox, case, side)
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
            rpm = said(abs(speed), "rpm", RPM, RPM_DIGITS)
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


def load_table(gearbox: Gearbox, shaft: Shaft, case: Case, ports: dict[int, str]) -> dict[str, Any]:
    """Return the load of a shaft that stands alone, at its first lumped point."""
    for number in list(ports)[:1]:
        load = case.components[number]
        force, moment = load_vector(load, shaft)
        moment[1] = load.number("torque_around_u_axis") or 0.0
        table: dict[str, Any] = {k: said(float(v), "N") for k, v in zip("xyz", force) if v}
        return table | {f"th{k}": said(float(v), "N*m") for k, v in zip("xyz", moment) if v}
    return {}


def lubrication_table(gearbox: Gearbox, shaft_bearings: list[Component]) -> dict[str, Any]:
    """Return the lubrication of the bearings of a shaft; empty where the file has no lubricant."""
    document, notes = gearbox.document, gearbox.notes
    lubricants = document.of_kind("lubricant")
    factors = [b.number("contamination_factor_iso_281_2007") for b in shaft_bearings]
    case = cases_of(gearbox)[0].components
    casings = [c for c in case.values() if c.kind == "gear_casing"]
    viscosity = next((v for c in casings if (v := c.number("operating_viscosity"))), None)
    source, digits = "operating_viscosity", 12
    if viscosity is None and lubricants:
        oil = lubricants[0]
        cold, hot = (oil.number(f"viscosity_at_{t}_degree_celsius") for t in (40, 100))
        temperature = next((t for c in casings if (t := c.number("temperature_lubricant"))), None)
        if cold and hot and temperature is not None:
            viscosity = viscosity_at(temperature, cold, hot)
            digits = 6
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
        "viscosity": Sourced(said(float(f"{viscosity:.{digits}g}"), "mm^2/s", 1e-6), source),
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
