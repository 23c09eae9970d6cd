"""Which bearings could have the matrices of Table 1 of Hua (2010)? An inverse question.

A row of rollers that all press alike, Z of them on a pitch radius R at a contact angle a, each with
a stiffness k over an effective length l, has in closed form (case ``roller_row`` of the manual)

    kxx = Z k cos(a)^2 / 2,                kyy = Z k sin(a)^2,
    kx,thz = kxx R tan(a),                 kthz = kxx ((R tan(a))^2 + l^2 / (12 cos(a)^2)).

Four published numbers give the four unknowns a, R, l and Z k exactly, if there are any. What load
the rollers must then bear follows from the line contact of ISO/TS 16281, k ~ Q^(1/10), and is held
against the static rating of ISO 76 and the pressure it stands for. The page compares it with what
real bearings of 90 mm bore have over the preloads that they stand, and with how the verdicts on the
thesis's axle change on them.

    python -m validation.thesis.bearings
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

import solidgear as sg
from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.catalogued import catalogued
from solidgear.bearings.hertz import LINE_POWER, line_constant, line_pressure
from solidgear.bearings.inside import Inside
from solidgear.bearings.kinds import SHARES
from solidgear.bearings.rating import static_roller_rating
from solidgear.bearings.solved import solved
from solidgear.core.scene import Bearing, BearingLoad, Scene
from validation.common import ROOT

PAGE = Path(__file__).with_suffix(".md")

#: Table 1: kxx, kyy N/m, |kx,thz| N/rad, kthz N m/rad, and the shaft under the bearing, m
PUBLISHED = {
    "1": (8.823e9, 8.887e8, 1.452e8, 3.856e6, 0.090),
    "2": (8.599e9, 1.721e9, 1.521e8, 3.600e6, 0.090),
    "3": (9.988e9, 1.852e9, 2.590e8, 7.663e6, 0.120),
    "4": (5.042e9, 1.091e9, 1.198e8, 3.065e6, 0.120),
}
#: makers' ratings of tapered bearings of 90 mm bore, N
REAL = {"32018 X": (168e3, 270e3), "30218": (216e3, 285e3), "32218": (262e3, 375e3)}
REAL["32318"] = (457e3, 610e3)
#: the pinion's mesh force: n of the thesis's plots, and a point on the pitch cone
DIRECTION, MESH = np.array([0.24, 0.54, 0.80]), np.array([-0.058, 0.0, -0.006])


class Found(NamedTuple):
    """A row of rollers that has a published matrix.

    Attributes
    ----------
    angle : float
        rad.
    pitch, length : float
        m; the length is NaN where none is real.
    together : float
        Z k, N/m.
    """

    angle: float
    pitch: float
    length: float
    together: float


def inverse(kxx: float, kyy: float, coupling: float, tilt: float) -> Found:
    """The row of rollers that has these four entries.

    Examples
    --------
    >>> found = inverse(8.823e9, 8.887e8, 1.452e8, 3.856e6)
    >>> round(math.degrees(found.angle), 1), round(1e3 * found.pitch)
    (12.7, 147)
    """
    angle = math.atan(math.sqrt(kyy / (2 * kxx)))
    lever = coupling / kxx
    rest = tilt / kxx - lever**2
    length = math.sqrt(12 * rest) * math.cos(angle) if rest > 0 else math.nan
    return Found(angle, 2 * lever / math.tan(angle), length, 2 * kxx / math.cos(angle) ** 2)


class Demand(NamedTuple):
    """What the rollers of a row must bear to be that stiff.

    Attributes
    ----------
    count : int
    diameter, load, force : float
        Of a roller in m and N; along y of the whole row in N.
    pressure, rating : float
        Pa; static rating by ISO 76, N.
    share : float
        Equivalent static load of that preload over the rating.
    """

    count: int
    diameter: float
    load: float
    force: float
    pressure: float
    rating: float
    share: float


def demand(found: Found, bore: float, count: int | None = None) -> Demand:
    """Load of every roller at which the row has its stiffness.

    Parameters
    ----------
    bore : float
        m.
    count : int, optional
        Rollers, as thick as usually fill the pitch circle; without it they take the usual share of
        the room between bore and outside diameter.
    """
    filling = SHARES["tapered"].filling.middle
    if count is None:
        diameter = SHARES["tapered"].diameter.middle * 2 * (found.pitch - bore)
        count = round(filling * math.pi / math.asin(diameter / found.pitch))
    else:
        diameter = found.pitch * math.sin(filling * math.pi / count)
    constant = line_constant(found.length)
    approach = (found.together / count / (LINE_POWER * constant)) ** (1 / (LINE_POWER - 1))
    load = constant * approach**LINE_POWER
    gamma = diameter * math.cos(found.angle) / found.pitch
    pressure = line_pressure(np.array(load), found.length, 2 / diameter / (1 - gamma))
    inside = Inside(count, diameter, found.length, found.pitch, found.angle, (0.5, 0.5))
    rating = static_roller_rating(inside)
    force = count * load * math.sin(found.angle)
    share = 0.22 / math.tan(found.angle) * force / rating
    return Demand(count, diameter, load, force, float(pressure), rating, share)


def thickest(found: Found, bore: float, share: float) -> Demand:
    """The row of the fewest rollers that has the stiffness within a share of its static rating."""
    for count in range(6, 200):
        row = demand(found, bore, count)
        if row.share <= share:
            return row
    raise ValueError("no number of rollers will do")


def possible(demands: dict[str, Demand]) -> str:
    """Which of the published matrices a bearing of usual proportions could have."""
    beyond = {name: d.share for name, d in demands.items() if d.share > 1}
    within = [
        f"{name} ({100 * d.share:.3g} % of it, rollers of {1e3 * d.diameter:.0f} mm)"
        for name, d in demands.items()
        if d.share <= 1
    ]
    times = " and ".join(f"{share:.0f}" for share in beyond.values())
    return (
        f"**With usual proportions no preload gives the matrices of bearings {' and '.join(beyond)}: "
        f"they need {times} times the static rating. Possible are those of bearings "
        f"{' and '.join(within)}.**"
    )


def real_stiffness(designation: str, share: float) -> np.ndarray:
    """(6, 6) of a real bearing preloaded to a share of its static rating."""
    dynamic, static = REAL[designation]
    data = Catalogue(designation=designation, load_rating=dynamic, static_rating=static, holds="+y")
    angle = catalogued(data).inside.angle
    force = share * static * math.tan(angle) / 0.22
    made = catalogued(data.with_changes(preload=f"{force!r} N"))
    return made.bearing.tangent(np.zeros(6))


def axle(designation: str, preload: float, force: float) -> Scene:
    """The overhung pinion of Table 1 on two real tapered bearings, back to back."""
    scene = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    dynamic, static = REAL[designation]
    bearings = []
    for bearing, holds in zip(scene.bearings, ("+y", "-y")):
        data = Catalogue(
            designation=designation,
            load_rating=dynamic,
            static_rating=static,
            holds=holds,
            preload=f"{preload!r} N",
        )
        bearings.append(
            Bearing(
                name=bearing.name,
                y=bearing.y,
                seat_width=bearing.seat_width,
                catalogue=data,
                status="estimated",
            )
        )
    push = force * DIRECTION / np.linalg.norm(DIRECTION)
    turn = np.cross(MESH, push)
    load = BearingLoad(x=push[0], y=push[1], z=push[2], thx=turn[0], thz=turn[2])
    return scene.with_changes(bearings=tuple(bearings), load=load)


def axle_rows() -> list[dict]:
    """The axle on published and on real bearings: frequencies, and how far the beam is off."""
    rows = []
    published = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    scenes: list[tuple[str, Scene]] = [("Table 1", published)]
    for name, preload, force in (
        ("32218", 2e3, 5e3),
        ("32218", 5e3, 20e3),
        ("32218", 20e3, 50e3),
        ("32318", 5e3, 20e3),
    ):
        scene = axle(name, preload, force)
        found = solved(scene, sg.build(scene, "timoshenko"))
        words = f"{name}, preload {preload / 1e3:g} kN, mesh {force / 1e3:g} kN"
        scenes.append((words, found.scene))
    for words, scene in scenes:
        beam, solid = (sg.build(scene, f) for f in ("timoshenko", "harmonic"))
        first = {
            body.fidelity: sg.modes(body, scene, 8).named("bending 1").frequency_hz
            for body in (beam, solid)
        }
        c = {b.fidelity: sg.condense(b, scene, "pinion").compliance[2, 2] for b in (beam, solid)}
        k = sg.condense(solid, scene, "pinion").stiffness
        rows.append(
            {
                "bearings": words,
                "k1": scene.bearings[0].stiffness[2, 2],
                "k2": scene.bearings[1].stiffness[2, 2],
                "K_zz": k[2, 2],
                "bending": first["harmonic"],
                "beam_f": first["timoshenko"] / first["harmonic"] - 1,
                "beam_c": c["timoshenko"] / c["harmonic"] - 1,
            }
        )
    return rows


def page() -> str:
    """The page as Markdown."""
    lines = [
        "# Which bearings could have the matrices of Table 1?",
        "",
        "Written by `python -m validation.thesis.bearings`; formulas in its source.",
        "",
        "## The inverse",
        "",
        "A row of rollers that all press alike has exactly the five different entries of Table 1. "
        "Contact angle, pitch diameter, roller length and the rollers' stiffness together follow "
        "from four of them.",
        "",
        "| bearing | contact angle, deg | pitch diameter, mm | roller length, mm | Z k, N/m |",
        "| --- | --- | --- | --- | --- |",
    ]
    demands = {}
    for name, (*entries, bore) in PUBLISHED.items():
        found = inverse(*entries)
        demands[name] = demand(found, bore)
        lines.append(
            f"| {name} | {math.degrees(found.angle):.2f} | {1e3 * found.pitch:.1f} | "
            f"{1e3 * found.length:.1f} | {found.together:.3e} |"
        )
    lines += [
        "",
        "By angle, pitch and length all four are tapered roller bearings that could exist: the "
        "matrices were computed from such rows. What their rollers must bear, Z and diameter by the "
        "proportions usual for that pitch on that shaft:",
        "",
        "| bearing | rollers | load of a roller, kN | preload along y, kN | pressure, MPa | "
        "static rating C0, kN | preload over C0 |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for name, d in demands.items():
        lines.append(
            f"| {name} | {d.count} of {1e3 * d.diameter:.1f} mm | {d.load / 1e3:.3g} | "
            f"{d.force / 1e3:.3g} | {d.pressure / 1e6:.0f} | {d.rating / 1e3:.0f} | {d.share:.3g} |"
        )
    lines += [
        "",
        "ISO 76 rates a bearing at 4000 MPa. A line contact stiffens with the tenth root of its load, "
        "so a factor in stiffness costs its tenth power in load. " + possible(demands),
        "",
        "More and thinner rollers on the same pitch circle stiffen a row at once. The fewest that "
        "stay within the static rating, and within a tenth of it:",
        "",
        "| bearing | within C0 | within C0 / 10 | length over diameter then |",
        "| --- | --- | --- | --- |",
    ]
    for name, (*entries, bore) in PUBLISHED.items():
        found = inverse(*entries)
        whole, tenth = thickest(found, bore, 1.0), thickest(found, bore, 0.1)
        lines.append(
            f"| {name} | {whole.count} of {1e3 * whole.diameter:.1f} mm | {tenth.count} of "
            f"{1e3 * tenth.diameter:.1f} mm | {found.length / tenth.diameter:.1f} |"
        )
    lines += [
        "",
        "Such rollers are longer and thinner than usual ones, between thicker rings. "
        "The pilot bearing 0 carries bearing 2's numbers. That all rollers press alike is itself a "
        "state of pure preload: under a mesh force half of them would be empty, and x and z of the "
        "matrices would differ. The weak couplings of Table 1, 1e-8 of the diagonal, say that next "
        "to none was there. Rings and housing, rigid here, make real bearings softer still.",
        "",
        "## What real bearings have",
        "",
        "Tapered bearings of 90 mm bore, inner geometry estimated from the ratings, preloaded by "
        "themselves to a share of the static rating. Table 1 has 8.6e9 to 8.8e9 N/m for that seat.",
        "",
        "| bearing | preload over C0 | kxx, N/m | kyy, N/m | kthx, N m/rad | Table 1 brg 1 over it: "
        "kxx, kyy, kthx |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    first = PUBLISHED["1"]
    for name in REAL:
        for share in (0.01, 0.05, 0.2, 1.0):
            k = real_stiffness(name, share)
            ratio = (first[0] / k[0, 0], first[1] / k[1, 1], first[3] / k[3, 3])
            lines.append(
                f"| {name} | {share:g} | {k[0, 0]:.2e} | {k[1, 1]:.2e} | {k[3, 3]:.2e} | "
                f"{ratio[0]:.1f}, {ratio[1]:.1f}, {ratio[2]:.1f} |"
            )
    lines += [
        "",
        "## The thesis's axle on them",
        "",
        "The overhung pinion of Table 1 under a mesh force along the plotted line of action, in "
        "equilibrium with two equal bearings, back to back, preloaded against each other. The series "
        "spring K_c is left out of the rows with real bearings.",
        "",
        "| bearings | kzz at 1, N/m | kzz at 2, N/m | K_zz at the pinion, N/m | first bending, Hz | "
        "Timoshenko off: frequency | compliance C_zz |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    rows = axle_rows()
    for row in rows:
        lines.append(
            f"| {row['bearings']} | {row['k1']:.2e} | {row['k2']:.2e} | {row['K_zz']:.2e} | "
            f"{row['bending']:.0f} | {100 * row['beam_f']:+.1f} % | {100 * row['beam_c']:+.1f} % |"
        )
    low, high, soft = rows[1], rows[0], min(rows[1:], key=lambda row: abs(row["beam_c"]))
    lines += [
        "",
        f"On Table 1's bearings the Timoshenko beam is {100 * high['beam_f']:+.1f} % off in first "
        f"bending and {100 * high['beam_c']:+.1f} % in compliance, and is not valid at 5 %. On real "
        f"ones first bending falls from {high['bending']:.0f} to {low['bending']:.0f} Hz at the "
        f"lightest load, the bearings are {high['k1'] / low['k1']:.1f} and "
        f"{high['k2'] / low['k2']:.1f} times softer than published, and the beam's compliance is "
        f"{100 * soft['beam_c']:+.1f} % off there. Whether a beam is good enough for this axle hangs "
        "on its bearings, and those on the load.",
        "",
    ]
    return "\n".join(lines)


def main() -> None:
    """Write the page."""
    text = page()
    PAGE.write_text(text)
    print(text)


if __name__ == "__main__":
    main()
