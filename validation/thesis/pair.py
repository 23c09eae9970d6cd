"""Problem: the 28 natural frequencies of Hua (2010), two pinion mountings of one spiral bevel
geared rotor.

Reference: the printed frequencies.  Models: the 14-DOF lumped pair with (i) the published masses
(springs of torsion and mesh, which are not published, identified), (ii) pinion mass, pinion
inertia, mesh stiffness and torsional springs identified, (iii) the mesh stiffness kept within the
thesis's plots and its point and the axial mass identified instead, (iv) as (ii) with a mass and
inertia for each mounting, as the effective-mass method gives. The pinion's K_ll is the published
one, the gear's is condensed from an Euler beam of the published shaft and bearings.

    python -m validation.thesis.pair
"""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

import numpy as np
from scipy.linalg import eigh

import solidgear as sg
from solidgear.system.gear_mesh import (
    MeshVector,
    line_of_action,
    mean_radius,
    mesh_point,
    to_gear_frame,
)
from solidgear.system.highest_frequency import consistency
from solidgear.system.identify import Unknown, identify, torsion_springs
from solidgear.system.lumped_pair import LumpedPair, diagonal_mass, shaft_stiffness
from validation.common import ROOT, results_folder, show, write_rows

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

# The mesh-blind frequencies of the pinion, by their place in the spectrum of model (ii).
BLIND = {"2-bearing": (620.2, 3145.5), "3-bearing": (1739.2, 4062.8)}


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


def frequency_rows(fits: dict, gear_stiffness: np.ndarray) -> list[dict]:
    """One row a published frequency, all cases side by side, with the component that dominates in
    (ii).
    """
    solved = {
        (name, case): geared_pair(f.values, case, gear_stiffness).solve()
        for name, f in fits.items()
        for case in CASES
    }
    rows = []
    for case in CASES:
        for k, published in enumerate(PUBLISHED[case]):
            row = {"mounting": case, "mode": k + 1, "published_hz": f"{published:.1f}"}
            for name in fits:
                value = solved[name, case].frequency_hz[k]
                row[f"{name}_hz"] = f"{value:.1f}"
                row[f"{name}_error"] = (
                    f"{100 * (value / published - 1):+.1f} %"
                    if published
                    else "exact"
                    if value == 0
                    else "NOT ZERO"
                )
            modes = solved["ii", case]
            row["most energy in (ii)"] = (
                f"{modes.dominant()[k]} {modes.energy[k].max():.2f}" if published else "rigid"
            )
            rows.append(row)
    return rows


def quantity_rows(name: str, found) -> list[dict]:
    """What was identified, how firmly, and which frequencies it moves most."""
    label = [f"{case[0]}b {hz:.1f}" for case in CASES for hz in PUBLISHED[case][1:]]
    rows = []
    for q in found.quantities:
        order = np.argsort(-np.abs(q.sensitivity))[:3]
        rows.append(
            {
                "case": name,
                "quantity": q.name,
                "status": q.status,
                "value": q.value,
                "unit": q.unit,
                "lower": q.lower,
                "upper": q.upper,
                "on bound": q.on_bound or "no",
                "spread": f"{100 * q.spread:.1f} %",
                "d ln f / d ln p, largest": "; ".join(
                    f"{label[j]} Hz {q.sensitivity[j]:+.2f}" for j in order
                ),
            }
        )
    return rows


def sensitivity_rows(found) -> list[dict]:
    """d ln f_j / d ln p, one row a frequency."""
    places = [(case, hz) for case in CASES for hz in PUBLISHED[case][1:]]
    return [
        {
            "mounting": case,
            "published_hz": hz,
            **{q.name: round(float(q.sensitivity[j]), 4) for q in found.quantities},
        }
        for j, (case, hz) in enumerate(places)
    ]


def rayleigh_rows(fits: dict) -> list[dict]:
    """Can the highest published frequency belong to these stiffnesses and masses?"""
    rows = []
    for name, found in fits.items():
        for case in CASES:
            pair = geared_pair(found.values, case, np.zeros((6, 6)))
            verdict = consistency(
                np.diag(pair.pinion_support), np.diag(pair.pinion_mass), PUBLISHED[case].max()
            )
            rows.append(
                {
                    "masses": "(i) published" if name == "i" else f"({name})",
                    "mounting": case,
                    "bound_hz": f"{verdict.bound_hz:.1f}",
                    "published_hz": verdict.published_hz,
                    "consistent": verdict.consistent,
                    "needed": f"{verdict.needed_mass:.2f} {'kg' if verdict.dof < 3 else 'kg m^2'}",
                }
            )
    return rows


def blind_rows(gear_stiffness: np.ndarray, mass: float, inertia: float) -> list[dict]:
    """Frequencies the mesh cannot move, against the published ones in their places of the spectrum."""
    gear, pinion = DATA["inertia"]["gear"], DATA["inertia"]["pinion"]
    cases = [
        (
            "gear, published mass, nothing identified",
            gear_stiffness,
            gear["mass"],
            gear["bending"],
            (430.3, 1920.2),
        )
    ]
    for case, pair in BLIND.items():
        stiffness = shaft_stiffness(**DATA["support"][case])
        own = exact_masses(stiffness, pair)
        cases.append(
            (f"pinion {case}, published mass", stiffness, pinion["mass"], pinion["bending"], pair)
        )
        cases.append((f"pinion {case}, identified (ii)", stiffness, mass, inertia, pair))
        cases.append((f"pinion {case}, mass of its own", stiffness, *own, pair))
    rows = []
    for name, stiffness, m, i, pair in cases:
        for found, hz in zip(bending_frequencies(stiffness, m, i), pair):
            error = f"{100 * (found / hz - 1):+.1f} %"
            row = {
                "body": name,
                "mass": f"{m:.2f}",
                "inertia": f"{i:.4f}",
                "published_hz": f"{hz:.1f}",
                "computed_hz": f"{found:.1f}",
            }
            rows.append({**row, "error": error})
    return rows


def exact_masses(stiffness: np.ndarray, pair: tuple[float, float]) -> tuple[float, float]:
    """Mass and inertia that give one mounting's two mesh-blind frequencies exactly, kg and kg m^2.

    ``kxx/M + kthz/I`` is the sum and ``det K / (M I)`` the product of the squared angular frequencies.  Of the two solutions
    of that quadratic the one is taken whose mass belongs to the translation.
    """
    low, high = (2 * np.pi * np.array(pair)) ** 2
    k, t, c = stiffness[0, 0], stiffness[5, 5], stiffness[0, 5]
    share = k * t * low * high / (k * t - c**2)
    over_mass = max(np.roots([1.0, -(low + high), share]).real) / k
    return 1 / over_mass, (k * t - c**2) * over_mass / (low * high)


def mesh_rows() -> list[dict]:
    """Line of action and mean mesh point from Table 1, against the plots."""
    gears, plotted, rows = DATA["gears"], DATA["plotted"], []
    n = line_of_action(
        gears["pitch_angle"][0],
        gears["spiral_angle"],
        PRESSURE_ANGLE,
        gears["hand"][0],
        gears["loaded_side"][0],
    )
    rows.append(
        {
            "quantity": "line of action, pinion",
            "ours": np.round(n, 3).tolist(),
            "plotted": plotted["line_of_action"],
        }
    )
    for name, angle in (
        ("published pitch angle", gears["pitch_angle"][0]),
        ("pitch angle of 14/45 teeth", float(np.arctan(1 / RATIO))),
    ):
        r = mean_radius(gears["pitch_radius"][0], angle, gears["face_width"])
        ours = [round(-r, 3), round(r / float(np.tan(angle)), 3), 0.0]
        rows.append(
            {
                "quantity": f"mesh point from the apex, {name}",
                "ours": ours,
                "plotted": plotted["mesh_point"],
            }
        )
    return rows


def torsion_rows(identified: dict[str, float]) -> list[dict]:
    """Both exact springs of the rigid-mesh chain, and what the chain becomes with the identified
    ones.
    """
    inertia, rows = DATA["inertia"], []
    chain = (
        inertia["engine"],
        inertia["pinion"]["torsional"],
        inertia["gear"]["torsional"],
        inertia["load"],
    )
    exact = torsion_springs(*chain, RATIO, 16.3, 47.3)
    for name, (k1, k2) in [
        *((f"rigid mesh, solution {k + 1}", pair) for k, pair in enumerate(exact)),
        (
            "identified (ii), mesh made rigid",
            (identified["pinion torsion"], identified["gear torsion"]),
        ),
    ]:
        j = np.diag([chain[0], chain[1] + chain[2] / RATIO**2, chain[3] / RATIO**2])
        k = k1 * np.outer([1, -1, 0], [1, -1, 0]) + k2 / RATIO**2 * np.outer([0, 1, -1], [0, 1, -1])
        hz = np.sqrt(np.abs(eigh(k, j, eigvals_only=True))) / (2 * np.pi)
        row = {
            "chain": name,
            "engine-pinion N m/rad": f"{k1:.4g}",
            "gear-load N m/rad": f"{k2:.4g}",
        }
        rows.append({**row, "hz": f"{hz[1]:.3f}, {hz[2]:.3f}"})
    return rows


def main() -> int:
    """Run every case; exit code 1 if (ii) misses 10 % anywhere or 1 % on the torsional modes."""
    stiffness = gear_support()
    low, high = DATA["plotted"]["mesh_stiffness"]
    plotted = Unknown("mesh stiffness", low, high, "N/m")
    fits = {
        "i": fit(TORSION_AND_MESH, stiffness),
        "ii": fit((*TORSION_AND_MESH, *MASSES), stiffness),
        "iii": fit(
            (*TORSION_AND_MESH, *MASSES, "pinion axial mass", *MESH_POINT),
            stiffness,
            mesh_stiffness=plotted,
        ),
        "iv": fit((*TORSION_AND_MESH, *MASSES_EACH), stiffness),
    }
    tables = {
        "frequencies": frequency_rows(fits, stiffness),
        "identified": [row for name, found in fits.items() for row in quantity_rows(name, found)],
        "rayleigh": rayleigh_rows(fits),
        "mesh_blind": blind_rows(
            stiffness, fits["ii"].values["pinion mass"], fits["ii"].values["pinion bending inertia"]
        ),
        "mesh": mesh_rows(),
        "torsion": torsion_rows(fits["ii"].values),
        "sensitivity": sensitivity_rows(fits["ii"]),
    }
    folder = results_folder("thesis_pair")
    for name, rows in tables.items():
        write_rows(folder / f"{name}.csv", rows)
        if name != "sensitivity":
            show(name.replace("_", " "), rows)
    for name, f in fits.items():
        print(
            f"({name}) rms {100 * f.rms:.2f} %, worst {100 * f.error[f.worst]:+.1f} % on {ELASTIC[f.worst]:.1f} Hz "
            f"({CASES[f.worst // len(PUBLISHED[CASES[0]][1:])]}); "
            f"on bounds: {', '.join(f.on_bounds) or 'none'}; condition {f.condition:.0f}; {f.agreeing} of {f.starts} starts agree"
        )
    torsional = max(abs(fits["ii"].error[k]) for k in (0, 1, 13, 14))
    passed = abs(fits["ii"].error).max() < 0.10 and torsional < 0.01
    print(
        f"torsional modes within {100 * torsional:.2f} % (asked 1 %), all others within 10 %: {'passed' if passed else 'FAILED'}"
    )
    print(
        "Not reproduced: with the published pinion mass and inertia the frequencies cannot come out, whatever the mesh, because "
        "the published K_ll alone puts the highest one above the published one; and the mesh stiffness that fits, "
        f"{fits['ii'].values['mesh stiffness']:.3g} N/m, is not the plotted {low:.1e} to {high:.1e} N/m."
    )
    each = fits["iv"].values
    print(
        f"With a mass and an inertia for each mounting the worst error is {100 * abs(fits['iv'].error).max():.1f} %, a gear mode; "
        "the inertias are "
        f"{each['pinion bending inertia, 2-bearing']:.3f} (2-bearing; {DATA['inertia']['pinion']['bending']} is published) and "
        f"{each['pinion bending inertia, 3-bearing']:.3f} kg m^2, so its two lists look as if made with two pinion inertias, not one."
    )
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
