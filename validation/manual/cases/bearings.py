"""Rolling bearings: published displacements under load, and a row in closed form."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solidgear.bearings.ball import BallRow
from solidgear.bearings.roller import RollerRow
from solidgear.bearings.rolling import RollingBearing
from validation.manual.case import Answer, Case, Model, references

#: clearance in micrometres, load in x and y in N
LOADS = {
    "radial": (0.0, (1000.0, 0.0)),
    "axial": (0.0, (0.0, 1000.0)),
    "radial, clearance": (10.0, (1000.0, 0.0)),
    "axial, clearance": (10.0, (0.0, 1000.0)),
    "both, clearance": (10.0, (1000.0, 1000.0)),
}


def _groove(clearance: float, **changes) -> RollingBearing:
    row = BallRow(count=7, diameter=11.5e-3, pitch=43.5e-3, clearance=clearance * 1e-6, **changes)
    return RollingBearing((row,))


def _deep_groove(**changes) -> Answer:
    values = {}
    for name, (clearance, load) in LOADS.items():
        motion = _groove(clearance, **changes).motion([*load, 0, 0, 0, 0])
        for axis, force, moved in zip("xy", load, motion):
            if force:
                values[f"{name}: {axis}"] = 1e6 * moved
        if all(load):
            values[f"{name}: tilt"] = 1e6 * abs(motion[5])
    values["moment: tilt"] = 1e6 * abs(_groove(0.0, **changes).motion([0, 0, 0, 0, 0, 1.0])[5])
    return Answer(values, 5)


def _angular() -> Answer:
    row = BallRow(
        count=16,
        diameter=22.225e-3,
        pitch=125.26e-3,
        angle=np.radians(40.0),
        inner=11.6281 / 22.225,
        outer=11.6281 / 22.225,
        E=206.844e9,
    )
    bearing = RollingBearing((row,))
    motion = bearing.motion([0, 17.8e3, 0, 0, 0, 0])
    (balls,) = bearing.contacts(motion)
    return Answer(
        {
            "contact angle": float(np.degrees(balls.angle[0])),
            "displacement": 1e6 * motion[1],
            "ball load": float(balls.load[0]),
        },
        5,
    )


ROLLERS = {"count": 16, "diameter": 12e-3, "length": 18e-3, "pitch": 0.1}
ANGLE, PUSH = 0.25, 11e-6


def _closed_form() -> dict[str, float]:
    """Straight rollers under a push along y: every slice presses alike."""
    press = 35948 * 18 ** (8 / 9) * (1e3 * PUSH * np.sin(ANGLE)) ** (10 / 9)
    slope = 10 / 9 * press / (PUSH * np.sin(ANGLE))
    own = 0.018**2 / 12 * (1 - 1 / 30**2) / np.cos(ANGLE) ** 2
    radial = 8 * slope * np.cos(ANGLE) ** 2
    return {
        "axial load, N": 16 * press * np.sin(ANGLE),
        "K_yy, N/m": 16 * slope * np.sin(ANGLE) ** 2,
        "K_xx, N/m": radial,
        "K_x,thz, N/rad": radial * 0.05 * np.tan(ANGLE),
        "K_thz, N m/rad": radial * ((0.05 * np.tan(ANGLE)) ** 2 + own),
    }


def _roller_row() -> Answer:
    row = RollerRow(**ROLLERS, angle=ANGLE, profile="straight")  # type: ignore[arg-type]
    bearing = RollingBearing((row,))
    load = bearing.load(np.array([0, PUSH, 0, 0, 0, 0]))[1]
    stiffness = bearing.tangent(bearing.motion([0, load, 0, 0, 0, 0]))
    found: Sequence[float] = (
        load,
        stiffness[1, 1],
        stiffness[0, 0],
        stiffness[0, 5],
        stiffness[5, 5],
    )
    return Answer(dict(zip(_closed_form(), map(float, found))), 5)


MASTA = (
    "A commercial program's results by ISO/TS 16281, as tabulated with the public repository "
    "minzhun/ISO16281, Test_BallBearing.py"
)
DEEP_GROOVE = Case(
    name="ball_bearing_displacement",
    title="Deep groove ball bearing: displacement under load",
    problem="How far the inner ring of a deep groove ball bearing moves under radial, axial and "
    "combined load and under a moment, with and without clearance.",
    geometry="Seven balls of 11.5 mm on 43.5 mm, groove radii 0.52 and 0.53 of the ball; a ball "
    "lies in the direction of the radial load.",
    material="E 210 GPa, Poisson's ratio 0.3.",
    supports="1000 N along x, along y, or both; 1 N m about z. Radial clearance 0 or 10 "
    "micrometres.",
    asked="Displacement of the inner ring, and its tilt where nothing stops it.",
    references=references(
        {
            "radial: x": 15.1101,
            "axial: y": 133.5381,
            "radial, clearance: x": 21.223,
            "axial, clearance: y": 149.1717,
            "both, clearance: x": 19.5923,
            "both, clearance: y": 146.4603,
        },
        "um",
        "cross_model",
        MASTA,
        1e-5,
        "printed digits",
    )
    + references(
        {"both, clearance: tilt": 2687.2, "moment: tilt": 3695.7},
        "urad",
        "cross_model",
        MASTA,
        0.011,
        "its moment has the lever of half the pitch diameter, its kinematics that of the groove's "
        "centre: 1.06 % apart",
    ),
    models=(
        Model(
            "balls, exact Hertz",
            _deep_groove,
            {
                "radial: x": 1e-4,
                "axial: y": 1e-4,
                "radial, clearance: x": 1e-4,
                "axial, clearance: y": 1e-4,
                "both, clearance: x": 1e-4,
                "both, clearance: y": 1e-4,
                "both, clearance: tilt": 0.015,
                "moment: tilt": 0.015,
            },
            "the same integrals on both sides, and what the reference's own iteration leaves; the "
            "tilt differs by its two levers",
        ),
    ),
    remarks="With one lever for motion and moment the stiffness is the second derivative of an "
    "energy, and symmetric; with two it is not.",
)
ANGULAR = Case(
    name="angular_contact_218",
    title="Angular contact ball bearing 218 under thrust",
    problem="Contact angle, displacement and ball load of a 40 degree bearing under thrust.",
    geometry="16 balls of 22.225 mm on 125.26 mm, groove radii 11.6281 mm, contact angle 40 "
    "degrees.",
    material="E 206.844 GPa (30e6 psi), Poisson's ratio 0.3.",
    supports="17.8 kN along the axis.",
    asked="Contact angle under load in degrees, displacement in micrometres, ball load in N.",
    references=references(
        {"contact angle": 41.50, "displacement": 36.02, "ball load": 1679.0},
        "deg, um, N",
        "literature",
        "The 218 bearing of Harris, Rolling Bearing Analysis, and of Ricci (2009), Math. Problems "
        "in Engineering, 471804, under 17.8 kN",
        5e-4,
        "printed digits; the tabulated Hertz factors of Jones behind them",
    ),
    models=(
        Model(
            "balls, exact Hertz",
            _angular,
            1e-3,
            "factors read off a table by the reference, integrals evaluated here",
        ),
    ),
)
ROLLER_ROW = Case(
    name="roller_row",
    title="Row of tapered rollers in closed form",
    problem="Load and stiffness of a row of straight tapered rollers that is pushed along y: all "
    "slices press alike, so that sums over rollers and slices have closed forms.",
    geometry="16 rollers of 12 x 18 mm on 100 mm, contact angle 0.25 rad, no profile, 30 slices.",
    material="Steel: 35948 N/mm^(18/9) of ISO/TS 16281, equation (37).",
    supports="11 micrometres along y, then the load that belongs to them.",
    asked="Load along y and the stiffness there.",
    references=references(
        _closed_form(),
        "SI",
        "closed_form",
        "q = c delta^(10/9); sums of cos^2 around a circle, and of the squares of 30 evenly spaced "
        "slices",
        0.0,
        "closed form",
    ),
    models=(
        Model(
            "rollers in slices", _roller_row, 1e-6, "what the search for the load leaves is 1e-12"
        ),
    ),
)
CASES = (DEEP_GROOVE, ANGULAR, ROLLER_ROW)
