"""Two parallel shafts coupled by spur gears: the turbine and generator of Rao, Shiau and Chang."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from math import cos, pi, radians, sin

import numpy as np
import scipy.linalg as sla

from solidgear.core.scene import Bearing, Material, Port, Scene, Segment
from solidgear.core.scene.point_mass import PointMass
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.reading import ShortFile
from solidgear.trains.file.train import Train
from validation.manual.case import Answer, Case, Model, Reference, references

RAO = (
    "Rao, Shiau and Chang (1998), turbo-alternator coupled by spur gears; data of "
    "ross/tests/test_multi_rotor.py (github.com/petrobras/ross)"
)
#: lengths and diameters, m; discs as (node, kg, diametral, polar kg m^2); bearings as (node, N/m
#: across and along the tangent of the teeth)
GENERATOR = {
    "lengths": (0.1, 4.24, 1.16, 0.3),
    "diameters": (0.3, 0.3, 0.22, 0.22),
    "discs": ((1, 525.7, 16.1, 32.2), (2, 116.04, 3.115, 6.23)),
    "wheel": (4, 726.4, 56.95, 113.9),
    "bearings": ((0, 183.9e6, 200.4e6), (3, 183.9e6, 200.4e6)),
    "base_radius": 0.5086,
}
TURBINE = {
    "lengths": (0.3, 5.0, 0.1),
    "diameters": (0.15, 0.15, 0.15),
    "discs": ((2, 7.45, 0.0745, 0.149),),
    "wheel": (0, 5.0, 0.002, 0.004),
    "bearings": ((1, 10.1e6, 41.6e6), (3, 10.1e6, 41.6e6)),
    "base_radius": 0.03567,
}
TEETH = {"generator": 328, "turbine": 23}
PRESSURE, MESH = radians(22.5), 1e8
#: E, G, density: of the example, and ROSS's own steel
EXAMPLE, ROSS_STEEL = (207e9, 79.5e9, 7800.0), (211e9, 81.2e9, 7810.0)
PRINTED = 74.160244
COUNT = 6
#: m; seats of beams follow their section, whatever their width
NARROW = 1e-4


# --------------------------------------------------------------------------- elements written out
def _rotor(data: dict, steel: Sequence[float], pieces: int):
    """K, M and first unknown of every node of the data; a node has x and its slope, z and its
    slope, axial motion and twist.
    """
    e, g, density = steel
    nu = e / (2 * g) - 1
    kappa = 6 * (1 + nu) / (7 + 6 * nu)
    widths = np.repeat(np.array(data["lengths"]) / pieces, pieces)
    size = 6 * (len(widths) + 1)
    k, m = np.zeros((size, size)), np.zeros((size, size))
    for i, (length, d) in enumerate(zip(widths, np.repeat(data["diameters"], pieces))):
        area, inertia = pi * d**2 / 4, pi * d**4 / 64
        ke, me = _bending(length, area, inertia, e, g * kappa, density)
        for start in (0, 2):
            at = 6 * i + start + np.array([0, 1, 6, 7])
            k[np.ix_(at, at)] += ke
            m[np.ix_(at, at)] += me
        rods = ((4, e * area, density * area), (5, 2 * g * inertia, 2 * density * inertia))
        for start, stiff, heavy in rods:
            at = 6 * i + start + np.array([0, 6])
            k[np.ix_(at, at)] += stiff / length * np.array([[1, -1], [-1, 1]])
            m[np.ix_(at, at)] += heavy * length / 6 * np.array([[2, 1], [1, 2]])
    for node, mass, across, polar in (*data["discs"], data["wheel"]):
        at = 6 * pieces * node + np.arange(6)
        m[at, at] += (mass, across, mass, across, mass, polar)
    for node, kx, kz in data["bearings"]:
        at = 6 * pieces * node
        k[at, at] += kx
        k[at + 2, at + 2] += kz
    return k, m, 6 * pieces * data["wheel"][0]


def _bending(length, area, inertia, e, shear, density):
    """Consistent Timoshenko element (Friswell et al. 2010, section 5.4)."""
    s, phi = length, 12 * e * inertia / (shear * area * length**2)
    a, b = (4 + phi) * s * s, (2 - phi) * s * s
    k = np.array([[12, 6 * s, -12, 6 * s], [6 * s, a, -6 * s, b]])
    k = np.vstack([k, [-12, -6 * s, 12, -6 * s], [6 * s, b, -6 * s, a]])
    c, d = 312 + 588 * phi + 280 * phi**2, (44 + 77 * phi + 35 * phi**2) * s
    f, h = 108 + 252 * phi + 140 * phi**2, -(26 + 63 * phi + 35 * phi**2) * s
    p, q = (8 + 14 * phi + 7 * phi**2) * s * s, -(6 + 14 * phi + 7 * phi**2) * s * s
    m = np.array([[c, d, f, h], [d, p, -h, q], [f, -h, c, -d], [h, q, -d, p]])
    t, u = (3 - 15 * phi) * s, (4 + 5 * phi + 10 * phi**2) * s * s
    v = (-1 - 5 * phi + 5 * phi**2) * s * s
    turn = np.array([[36, t, -36, t], [t, u, -t, v], [-36, -t, 36, -t], [t, v, -t, u]])
    m = density * area * s / (840 * (1 + phi) ** 2) * m
    m = m + density * inertia / (30 * (1 + phi) ** 2 * s) * turn
    return e * inertia / ((1 + phi) * s**3) * k, m


@cache
def written_out(steel: Sequence[float], pieces: int) -> np.ndarray:
    """Elastic frequencies, rad/s, with so many elements a span."""
    (k1, m1, at1), (k2, m2, at2) = (_rotor(data, steel, pieces) for data in (GENERATOR, TURBINE))
    k, m = sla.block_diag(k1, k2), sla.block_diag(m1, m2)
    row, at2 = np.zeros(len(k)), len(k1) + at2
    row[[at1, at1 + 2, at1 + 5]] = sin(PRESSURE), cos(PRESSURE), GENERATOR["base_radius"]
    row[[at2, at2 + 2, at2 + 5]] = -sin(PRESSURE), -cos(PRESSURE), TURBINE["base_radius"]
    square = sla.eigh(k + MESH * np.outer(row, row), m, eigvals_only=True)
    # two shafts slide and one train turns: three free motions
    return np.sqrt(square[3 : 3 + COUNT])


# --------------------------------------------------------------------------- the train
def _scene(name: str, data: dict) -> Scene:
    e, g, density = EXAMPLE
    nodes = np.concatenate([[0.0], np.cumsum(data["lengths"])])
    length = float(nodes[-1])
    segments = [
        Segment.cylinder(f"{name} {i}", length=s, diameter=d, y0=float(y))
        for i, (s, d, y) in enumerate(zip(data["lengths"], data["diameters"], nodes), start=1)
    ]

    steps = {
        n for n, (a, b) in enumerate(zip(data["diameters"], data["diameters"][1:]), 1) if a != b
    }

    def seat(node: int) -> dict:
        """On a node; beside it where the shaft has a step, which no seat may reach across."""
        place = {"y": float(nodes[node]), "seat_width": NARROW, "attachment": "section"}
        if node in (0, len(nodes) - 1):
            place["face"] = "start" if node == 0 else "end"
        elif node in steps:
            place["y"] -= NARROW / 2
        return place

    bearings = [
        Bearing(
            name=f"{name} bearing {i}",
            stiffness=np.diag([kx, 0.0, kz, 0.0, 0.0, 0.0]).tolist(),
            **seat(node),
        )
        for i, (node, kx, kz) in enumerate(data["bearings"], start=1)
    ]
    masses = tuple(
        PointMass(name=f"{name} disc {i}", mass=kg, inertia=(across, polar, across), **seat(node))
        for i, (node, kg, across, polar) in enumerate(data["discs"], start=1)
    )
    y = float(nodes[data["wheel"][0]])
    low = min(max(y - 0.05, 0.0), length - 0.1)
    port = Port(name=name, y=y, lo=low, hi=low + 0.1, attachment="section")
    steel = Material(E=e, nu=e / (2 * g) - 1, density=density)
    return Scene.from_parts(segments, steel, bearings, port, name=name, masses=masses)


def spur_train() -> Train:
    """The turbine drives: its small wheel is the pinion. Engine and load are not there: a
    milligram behind a spring each, at 5 kHz.
    """
    radius = {n: d["base_radius"] / cos(PRESSURE) for n, d in _MEMBERS.items()}
    members = {}
    for side, (name, data) in zip(("pinion", "gear"), _MEMBERS.items()):
        _, mass, across, polar = data["wheel"]
        members[side] = {
            "scene": _scene(name, data),
            "teeth": TEETH[name],
            "pitch_radius": radius[name],
            "head": {"mass": mass, "torsional": polar, "bending": across},
        }
    between = sum(radius.values())
    mesh = {
        "shaft_angle": 0.0,
        "stiffness": MESH,
        "line_of_action": (sin(PRESSURE), 0.0, cos(PRESSURE)),
        "point": (-radius["turbine"], 0.0, 0.0),
        "gear_position": (-between, 0.0, 0.0),
        "transmission_error": 1e-6,
    }
    idle = {
        n: {"inertia": 1e-9, "spring": {"stiffness": 1.0, "at": at}}
        for n, at in zip(("engine", "load"), _MEMBERS)
    }
    return ShortFile(name="spur_train", mesh=mesh, **members, **idle).build_train()


_MEMBERS = {"turbine": TURBINE, "generator": GENERATOR}


def _of_train(rung: str) -> Answer:
    # Cowper's shear coefficient, as ROSS and the elements beside
    assembly = Assembly(spur_train(), settings={rung: {"kappa": "cowper", "elements": 60}})
    found = assembly.system(rung, rung).modes(COUNT)
    omega = 2 * pi * found.frequency_hz
    values = {_name(i): float(w) for i, w in enumerate(omega[found.rigid :], start=1)}
    values["free motions"] = float(found.rigid)
    unknowns = sum(assembly.shaft_model(side, rung).unknowns for side in ("pinion", "gear"))
    return Answer(values, unknowns)


def _of_elements(pieces: int) -> Answer:
    found = written_out(EXAMPLE, pieces)
    values = {_name(i): float(w) for i, w in enumerate(found, start=1)}
    values["first, ROSS's steel, one element a span"] = float(written_out(ROSS_STEEL, 1)[0])
    return Answer(values, 6 * (9 * pieces))


def _name(number: int) -> str:
    return f"frequency {number}"


SPUR = Case(
    name="spur_train",
    title="Turbine and generator coupled by spur gears",
    problem="Natural frequencies of two parallel shafts whose gears mesh.",
    geometry="Generator: 5.8 m, diameters 300 and 220 mm, generator, disc and a gear of 328 teeth at "
    "its end. Turbine: 5.4 m, 150 mm, a pinion of 23 teeth at its start, turbine before its end. "
    "Wheels and discs are rigid masses; base radii 508.6 and 35.67 mm, pressure angle 22.5 degrees.",
    material="E 207 GPa, G 79.5 GPa, 7800 kg/m^3.",
    supports="Two bearings a shaft, 183.9 and 200.4 N/um on the generator's, 10.1 and 41.6 on the "
    "turbine's, none along the shafts; mesh 100 N/um along the line of action.",
    asked="The first elastic frequencies, and how many motions are free: both shafts slide, the "
    "train turns.",
    references=(
        *references(
            {
                "frequency 1": 68.037,
                "frequency 2": 70.628,
                "frequency 3": 109.887,
                "frequency 4": 110.544,
                "frequency 5": 147.709,
                "frequency 6": 219.962,
            },
            "rad/s",
            "cross_model",
            f"{RAO}; Timoshenko elements written out beside this case (Friswell et al. 2010, "
            "section 5.4), 32 a span, which share no code with the train",
            1e-5,
            "the change from 32 to 64 elements a span is 5e-6 at most",
        ),
        Reference(
            "first, ROSS's steel, one element a span",
            PRINTED,
            "rad/s",
            "cross_model",
            "ROSS, docstring of MultiRotor: wd[0] of the same rotor in steel of 211 GPa",
            1e-7,
            "printed; with damped bearings, which a light damping moves by 1e-5",
        ),
        Reference(
            "free motions", 3.0, "1", "closed_form", f"{RAO}: nothing holds them", 0.0, "a count"
        ),
    ),
    models=(
        Model(
            "train of Timoshenko beams",
            lambda: _of_train("timoshenko"),
            {_name(i): 2e-5 for i in range(1, COUNT + 1)} | {"free motions": 1e-8},
            "converged elements on both sides, with Cowper's shear coefficient on both; a disc on a "
            "step of the shaft sits 0.05 mm beside it, since no seat reaches across a step",
        ),
        Model(
            "elements written out, one a span",
            lambda: _of_elements(1),
            {"frequency 1": 1e-4, "first, ROSS's steel, one element a span": 1e-4},
            "ROSS's mesh of this example: 8.2 % too high in the first, 73.61 for 68.04 rad/s, "
            "which is the known deviation; the printed number within the damping of its bearings "
            "and its shear coefficient",
            known={"frequency 1": 73.612 / 68.037 - 1},
        ),
    ),
    remarks="One element a span is what the tutorial shows; its first frequency is 8 % off, and no "
    "result of it says so.",
)

CASES = (SPUR,)
