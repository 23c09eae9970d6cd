"""Bearings of makers' catalogues: ratings, equivalent loads, lives and lubrication."""

from __future__ import annotations

import math

import numpy as np

from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.catalogued import catalogued, state
from solidgear.bearings.equivalent import equivalent_load
from solidgear.bearings.geometry import inner_geometry
from solidgear.bearings.life import life
from solidgear.bearings.rating import ratings
from solidgear.core.scene.lubrication import Lubrication
from validation.manual.case import Answer, Case, Model, references
from validation.manual.printed import printed, to_the_digits

RPM = math.pi / 30
STEEL = "Bearing steel."
ISO = "ISO 281 gives the printed digits"


# ----------------------------------------------------------------------- 6309
def _skf() -> Answer:
    speed = 3000 * RPM
    data = Catalogue(
        designation="6309", load_rating="55.3 kN", static_rating="31.5 kN", load={"z": "10 kN"}
    )
    made = catalogued(data)
    oil = Lubrication(viscosity="20 mm^2/s", cleanliness=0.8)
    result = life(data, made, state(data, made), oil, speed)
    film = result.modified
    assert film is not None
    values = {
        "L10": result.basic / 1e6,
        "L10h": result.basic / (speed * 3600 / (2 * math.pi)),
        "nu_1": 1e6 * film.reference_viscosity,
        "kappa": film.kappa,
    }
    return Answer(values, 5)


SKF = "SKF, Rolling bearings (2013), calculation examples, example 1, page 92"
LIVES = {"L10": "169"}
HOURS = {"L10h": "940"}
FILM = {"nu_1": "8.15"}
EXPLORER = Case(
    name="printed_ball_bearing_life",
    title="Life of a 6309, SKF",
    problem="How long does a deep groove ball bearing live under a radial load?",
    geometry="6309 with C = 55.3 kN.",
    material=STEEL,
    supports="10 kN across, 3000 r/min, oil of 20 mm^2/s.",
    asked="Basic life, viscosity that the speed asks for, and the viscosity ratio.",
    printed=True,
    references=printed(LIVES, "million revolutions", SKF)
    + printed(HOURS, "h", SKF)
    + printed(FILM, "mm^2/s", SKF)
    + printed({"kappa": "2.45"}, "1", SKF),
    models=(
        Model(
            "ISO 281",
            _skf,
            to_the_digits(LIVES)
            | to_the_digits(HOURS, 1.0)
            | dict.fromkeys(("nu_1", "kappa"), 0.01),
            "life to the digits (the hours are those of 169 million revolutions, rounded); the "
            "catalogue reads nu_1 off a diagram that lies below the formula of ISO 281",
            known={"nu_1": 0.184, "kappa": -0.154},
        ),
    ),
    remarks="4500 / sqrt(3000 r/min) / sqrt(72.5 mm) of ISO 281:2007 is 9.65 mm^2/s, 18 % above the "
    "8.15 mm^2/s of the catalogue's diagram. With its kappa of 2.45, C_u of 1.34 kN and 0.8 for "
    "dirt, ISO 281 gives a_ISO = 5.5; the catalogue has a factor of 8 (from memory), of a diagram for "
    "its own class of bearings, so modified lives are not compared.",
)


# ----------------------------------------------------------------------- 6208
def _ntn() -> Answer:
    data = Catalogue(designation="6208", load_rating="32.5 kN", static_rating="17.8 kN")
    inside = inner_geometry(data).middle
    values = {}
    for name, axial in (("radial", 0.0), ("both", 1800.0)):
        load = np.array([3200.0, axial, 0, 0, 0, 0])
        equivalent = equivalent_load(data, inside, ratings(data, inside), load)
        values[f"P, {name}"] = equivalent.load / 1e3
        values[f"L10h, {name}"] = (32.5e3 / equivalent.load) ** 3 * 1e6 / 60 / 650
    return Answer(values, 5)


NTN = "NTN, Ball and Roller Bearings, bearing life calculation examples 1 and 2"
NOMOGRAM = {"L10h, radial": 27000.0, "L10h, both": 10500.0}
COMBINED = Case(
    name="printed_ball_bearing_load",
    title="Equivalent load and life of a 6208, NTN",
    problem="How long does a deep groove ball bearing live under a radial load, and with an axial load "
    "beside it?",
    geometry="6208 with C = 32.5 kN and C0 = 17.8 kN.",
    material=STEEL,
    supports="3.2 kN across, then with 1.8 kN along; 650 r/min.",
    asked="Equivalent load and life.",
    printed=True,
    references=printed({"P, radial": "3.20", "P, both": "4.38"}, "kN", NTN)
    + references(
        NOMOGRAM, "h", "literature", NTN, 0.03, "lives are read off nomograms of three digits"
    ),
    models=(
        Model(
            "ISO 281",
            _ntn,
            {"P, radial": 2e-3, "P, both": 4e-3} | dict.fromkeys(NOMOGRAM, 0.03),
            "the catalogue interpolates Y to two digits, and reads lives off a nomogram",
        ),
    ),
)


# ----------------------------------------------------------------------- a pair
def _pair() -> Answer:
    pair = Catalogue(designation="7312 B", arrangement="back_to_back", load_rating="104 kN")
    return Answer({"C of the pair": ratings(pair, inner_geometry(pair).middle).dynamic / 1e3}, 5)


PAIR = {"C of the pair": "168.5"}
BACK_TO_BACK = Case(
    name="printed_pair_rating",
    title="Rating of a pair of 7312 B, SKF",
    problem="What does a pair of angular contact ball bearings side by side carry?",
    geometry="Two 7312 BECBP with C = 104 kN each.",
    material=STEEL,
    supports="None.",
    asked="C of the pair.",
    printed=True,
    references=printed(
        PAIR, "kN", "SKF, Rolling bearings, application example C.3, centrifugal pump"
    ),
    models=(
        Model(
            "ISO 281",
            _pair,
            {"C of the pair": 3e-3},
            "the catalogue takes 1.62 times the C of one, ISO 281 2^0.7 = 1.6245",
        ),
    ),
)

CASES = (EXPLORER, COMBINED, BACK_TO_BACK)
