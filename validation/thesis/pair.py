"""The geared pair of Hua (2010) from its published numbers: two pinion mountings of one rotor.

The pinion's K_ll is the published one, the gear's is condensed from an Euler beam of the published
shaft and bearings.  What is not published, or cannot be, is identified from the frequencies.
"""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
from scipy.linalg import eigh

import solidgear as sg
from solidgear.core.system.gear_mesh import (
    MeshVector,
    line_of_action,
    mean_radius,
    mesh_point,
    to_gear_frame,
)
from validation.common import ROOT
from validation.thesis.identify import Unknown, identify
from validation.thesis.lumped_pair import LumpedPair, diagonal_mass, shaft_stiffness

DATA = tomllib.loads(Path(__file__).with_name("published.toml").read_text())
CASES = tuple(DATA["support"])
PUBLISHED = {case: np.array(DATA["frequency_hz"][case]) for case in CASES}
ELASTIC = np.concatenate([PUBLISHED[case][1:] for case in CASES])
RATIO = DATA["gears"]["teeth"][1] / DATA["gears"]["teeth"][0]
PRESSURE_ANGLE = np.radians(
    25.0
)  # not published; gives the plotted line of action with the published angles

UNKNOWNS = {
    u.name: u
    for u in (
        Unknown("pinion torsion", 5e3, 5e4, "N m/rad"),
        Unknown("gear torsion", 2e4, 2e5, "N m/rad"),
        Unknown("pinion mass", 10.0, 40.0, "kg"),
        Unknown("pinion bending inertia", 0.2, 1.0, "kg m^2"),
        Unknown("mesh stiffness", 5e7, 5e9, "N/m"),
        Unknown("pinion mass, 2-bearing", 10.0, 40.0, "kg"),
        Unknown("pinion mass, 3-bearing", 10.0, 40.0, "kg"),
        Unknown("pinion bending inertia, 2-bearing", 0.2, 1.0, "kg m^2"),
        Unknown("pinion bending inertia, 3-bearing", 0.2, 1.0, "kg m^2"),
        Unknown("pinion axial mass", 10.0, 40.0, "kg"),
        Unknown("mesh radius", 0.045, 0.067, "m", log=False),  # toe to heel is 0.043 to 0.067
        Unknown("mesh axial, pinion", -0.06, 0.06, "m", log=False),
        Unknown("mesh axial, gear", -0.1, 0.1, "m", log=False),
    )
}
MASSES = ("pinion mass", "pinion bending inertia")
MASSES_EACH = tuple(f"{name}, {case}" for name in MASSES for case in CASES)
MESH_POINT = ("mesh radius", "mesh axial, pinion", "mesh axial, gear")
TORSION_AND_MESH = ("pinion torsion", "gear torsion", "mesh stiffness")
# Without better knowledge the lumped points are taken at the middle of the face.  The mesh point
# stays at the height of the axes: moving it along the line of action changes nothing, so of its
# three coordinates only two can be identified.
DEFAULTS = {"mesh axial, pinion": 0.0, "mesh axial, gear": 0.0}


def gear_support() -> np.ndarray:
    """The gear's K_ll, which the source does not print: Euler beam, as its pinion K_ll turned out
    to be.
    """
    scene = sg.load(ROOT / "geometry" / "gear_shaft.toml")
    return sg.condense(sg.build(scene, "euler"), scene, "gear").stiffness


def geared_pair(values: dict[str, float], case: str, gear_stiffness: np.ndarray) -> LumpedPair:
    """The pair of one mounting; `values` override the published data."""
    gears, inertia, support = DATA["gears"], DATA["inertia"], DATA["support"][case]
    v = {**DEFAULTS, **values}
    n = line_of_action(
        gears["pitch_angle"][0],
        gears["spiral_angle"],
        PRESSURE_ANGLE,
        gears["hand"][0],
        gears["loaded_side"][0],
    )
    radius = v.get(
        "mesh radius",
        mean_radius(gears["pitch_radius"][0], gears["pitch_angle"][0], gears["face_width"]),
    )
    pinion = MeshVector(n, mesh_point(radius, v["mesh axial, pinion"]))
    # The radii are in the ratio of the teeth: the published pitch angles, 0.391 and 1.282 rad, do
    # not belong to 14 and 45 teeth (0.302 and 1.269), so the mean radii that follow from them would
    # miss it.
    n_gear = to_gear_frame(n)
    gear = MeshVector(n_gear, mesh_point(RATIO * radius, v["mesh axial, gear"], member="gear"))
    mass, bending = (
        v.get(f"{name}, {case}", v.get(name, inertia["pinion"][key]))
        for name, key in (("pinion mass", "mass"), ("pinion bending inertia", "bending"))
    )
    m = diagonal_mass(mass, inertia["pinion"]["torsional"], bending)
    m[1, 1] = v.get("pinion axial mass", mass)
    return LumpedPair(
        inertia["engine"],
        inertia["load"],
        m,
        diagonal_mass(**inertia["gear"]),
        shaft_stiffness(**support),
        gear_stiffness,
        v["pinion torsion"],
        v["gear torsion"],
        v["mesh stiffness"],
        pinion,
        gear,
    )


def bending_frequencies(stiffness: np.ndarray, mass: float, inertia: float) -> np.ndarray:
    """Two frequencies, Hz, of a body of revolution on its K_ll in one plane.

    The mesh is one spring, and every one of these frequencies is double (two planes): one mode of
    each pair does not move the line of action, so these frequencies stay in the spectrum of the
    pair whatever the mesh is.
    """
    plane = np.ix_([0, 5], [0, 5])
    return np.sqrt(eigh(stiffness[plane], np.diag([mass, inertia]), eigvals_only=True)) / (
        2 * np.pi
    )


def fit(names, gear_stiffness, starts=8, **bounds):
    """Identify the named quantities from both mountings at once; published frequencies of zero say
    nothing.
    """
    unknowns = [bounds.get(name.replace(" ", "_"), UNKNOWNS[name]) for name in names]

    def frequencies(values):
        return np.concatenate(
            [geared_pair(values, case, gear_stiffness).solve().frequency_hz[1:] for case in CASES]
        )

    return identify(frequencies, unknowns, ELASTIC, starts=starts)
