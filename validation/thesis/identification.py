"""What the 28 frequencies of Hua (2010) say of the numbers that are not printed beside them.

Identified are (i) springs of torsion and mesh with the published masses, (ii) mass and inertia of
the pinion as well, (iii) the mesh stiffness kept within the thesis's plots and its point and the
axial mass instead, (iv) as (ii) with a mass and inertia for each mounting, as the effective-mass
method gives.  The case ``thesis_geared_pair`` of the manual holds (ii) to the printed frequencies.

    python -m validation.thesis.identification
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from solidgear.core.system.gear_mesh import line_of_action, mean_radius
from validation.common import results_folder, show, write_rows
from validation.thesis.identify import Unknown
from validation.thesis.lumped_pair import shaft_stiffness
from validation.thesis.pair import (
    CASES,
    DATA,
    ELASTIC,
    MASSES,
    MASSES_EACH,
    MESH_POINT,
    PRESSURE_ANGLE,
    PUBLISHED,
    RATIO,
    TORSION_AND_MESH,
    bending_frequencies,
    fit,
    gear_support,
    geared_pair,
)

# The mesh-blind frequencies of the pinion, by their place in the spectrum of model (ii).
BLIND = {"2-bearing": (620.2, 3145.5), "3-bearing": (1739.2, 4062.8)}


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
                "status": "identified",
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


def highest(stiffness, mass, published_hz: float) -> tuple[float, int, float]:
    """Lower bound (Hz) of the highest frequency, the degree of freedom that sets it, and the least
    mass (or inertia) there with which the published frequency becomes possible.

    Rayleigh's quotient of a unit vector is ``K_ii / M_ii``, and no quotient exceeds the highest
    eigenvalue; a mesh that is left out can only raise it.
    """
    quotient = np.diag(stiffness) / np.diag(mass)
    dof = int(np.argmax(quotient))
    needed = stiffness[dof, dof] / (2 * np.pi * published_hz) ** 2
    return float(np.sqrt(quotient[dof]) / (2 * np.pi)), dof, float(needed)


def rayleigh_rows(fits: dict) -> list[dict]:
    """Can the highest published frequency belong to these stiffnesses and masses?"""
    rows = []
    for name, found in fits.items():
        for case in CASES:
            pair = geared_pair(found.values, case, np.zeros((6, 6)))
            top = float(PUBLISHED[case].max())
            bound, dof, needed = highest(pair.pinion_support, pair.pinion_mass, top)
            rows.append(
                {
                    "masses": "(i) published" if name == "i" else f"({name})",
                    "mounting": case,
                    "bound_hz": f"{bound:.1f}",
                    "published_hz": top,
                    "consistent": top >= bound,
                    "needed": f"{needed:.2f} {'kg' if dof < 3 else 'kg m^2'}",
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

    ``kxx/M + kthz/I`` is the sum and ``det K / (M I)`` the product of the squared angular
    frequencies.  Of the two solutions of that quadratic the one is taken whose mass belongs to the
    translation.
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


def torsion_springs(
    engine: float,
    pinion: float,
    gear: float,
    load: float,
    ratio: float,
    first_hz: float,
    second_hz: float,
) -> list[tuple[float, float]]:
    """Exact springs of the torsional chain with a rigid mesh, from its two frequencies.

    With everything on the pinion's side, ``J1 = engine``, ``J2 = pinion + gear/R^2``, ``J3 =
    load/R^2``, the springs obey

        k1 (1/J1 + 1/J2) + k2 (1/J2 + 1/J3) = w1^2 + w2^2
        k1 k2 (J1 + J2 + J3) / (J1 J2 J3) = w1^2 w2^2

    which is a quadratic: none, one or two pairs fit, and the frequencies alone do not decide which
    of two it is.

    Springs are those from engine to pinion and from gear to load on their own shafts, N m/rad, the
    softer gear side first.
    """
    j1, j2, j3 = engine, pinion + gear / ratio**2, load / ratio**2
    w1, w2 = (2 * np.pi * first_hz) ** 2, (2 * np.pi * second_hz) ** 2
    a, b = 1 / j1 + 1 / j2, 1 / j2 + 1 / j3
    product = w1 * w2 * j1 * j2 * j3 / (j1 + j2 + j3)
    # a k1 and b k2 are the roots of s^2 - (w1 + w2) s + a b product.
    discriminant = (w1 + w2) ** 2 - 4 * a * b * product
    root = np.sqrt(discriminant)
    big = (w1 + w2 + root) / 2
    small = a * b * product / big
    pairs = {(float(s / a), float(product / (s / a) * ratio**2)) for s in (big, small)}
    return sorted(pairs, key=lambda pair: pair[1])


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


def main() -> None:
    """Identify, and show every table."""
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
            f"on bounds: {', '.join(f.on_bounds) or 'none'}; condition {f.condition:.0f}; "
            f"{f.agreeing} of {f.starts} starts agree"
        )
    print(
        "Not reproduced: with the published pinion mass and inertia the frequencies cannot "
        "come out, whatever the mesh, because "
        "the published K_ll alone puts the highest one above the published one; and the mesh stiffness that fits, "
        f"{fits['ii'].values['mesh stiffness']:.3g} N/m, is not the plotted {low:.1e} to {high:.1e} N/m."
    )
    each = fits["iv"].values
    print(
        "With a mass and an inertia for each mounting the worst error is "
        f"{100 * abs(fits['iv'].error).max():.1f} %, a gear mode; "
        "the inertias are "
        f"{each['pinion bending inertia, 2-bearing']:.3f} (2-bearing; "
        f"{DATA['inertia']['pinion']['bending']} is published) and "
        f"{each['pinion bending inertia, 3-bearing']:.3f} kg m^2, so its two lists look as if "
        "made with two pinion inertias, not one."
    )


if __name__ == "__main__":
    main()
