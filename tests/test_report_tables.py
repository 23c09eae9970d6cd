"""Tables of a report say which bearings a shaft stands on, at what load, and own up to what is left out."""

from dataclasses import fields

import solidgear as sg
from solidgear.comparison.page import tables
from solidgear.core.judge.bars import ErrorBar
from solidgear.core.judge.record import BarRecord, Record
from solidgear.show.input_tables import bearings, masses, material_words, scene_facts
from solidgear.show.units import US

CATALOGUE = sg.load("geometry/gearbox_catalogue.toml").as_dict()
GIVEN = sg.load("geometry/shaft_stepped.toml").as_dict()


def record(scene=CATALOGUE, **more):
    return Record.model_validate({"scene": scene, **more})


def cell(one):
    return one[0] if isinstance(one, tuple) else one


def test_the_load_that_bearings_are_taken_under_is_a_fact_of_the_scene():
    facts = {row[0]: cell(row[1]) for row in scene_facts(record()).rows}
    told = facts["load at the lumped point"]
    assert told == "x 3800 N, y -1000 N, z 1400 N; bearings have their stiffness under it"
    pounds = {row[0]: cell(row[1]) for row in scene_facts(record(), US).rows}
    # 3800 N / 4.4482216 N
    assert pounds["load at the lumped point"].startswith("x 854.274 lbf, ")
    assert "load at the lumped point" not in {row[0] for row in scene_facts(record(GIVEN)).rows}


def test_masses_and_densities_are_in_pounds_and_inches_where_lengths_are():
    pound, inch = 0.45359237, 0.0254
    disc = {"name": "disc", "y": inch, "mass": pound, "inertia": [pound * inch**2] * 3}
    table = masses({"masses": [disc | {"offset": [0.0, inch, 0.0]}]}, US)
    assert table.heads[2:] == ["y, in", "mass, lb", "inertia x, y, z, lb in²", "offset, in"]
    assert table.texts[0][2:] == ["1", "1", "1, 1, 1", "0, 1, 0"]
    steel = {"E": 206.842718795e9, "nu": 0.3, "density": 7850.0}
    # 7850 kg/m^3 times (0.0254 m)^3, over 0.45359237 kg
    assert material_words(steel, US) == "E = 30000 ksi, nu = 0.3, density = 0.283599 lb/in³"


def test_a_catalogue_bearing_is_told_by_its_designation():
    notes = {row[0]: cell(row[-1]) for row in bearings(CATALOGUE).rows}
    assert notes["A"] == "NU 207, 35 x 72 x 17 mm, clearance CN."
    assert notes["B"] == "7208 B, 40 x 80 x 18 mm, back to back, preload 400 N."
    assert {cell(row[-1]) for row in bearings(GIVEN).rows} == {""}


def test_entries_without_a_column_are_owned_up_to():
    # K_xz of the loaded roller bearing is a quarter of K_xx
    assert (
        "Further entries of 'A', 'B', such as couplings, are in results.json"
        in bearings(CATALOGUE).note
    )
    assert "Further entries of" not in bearings(GIVEN).note


def test_the_mirrored_coupling_is_no_further_entry():
    scene = {"bearings": [{"name": "one", "stiffness": [[0.0] * 6 for _ in range(6)]}]}
    matrix = scene["bearings"][0]["stiffness"]
    matrix[2][3] = matrix[3][2] = 4.0
    matrix[0][5] = matrix[5][0] = -4.0
    assert "Further entries of" not in bearings(scene).note
    matrix[0][5] = matrix[5][0] = -5.0
    assert "Further entries of 'one'" in bearings(scene).note


def test_a_mode_that_is_like_no_other_has_no_partner_by_name():
    # of an Euler beam's second axial mode beside a solid without one
    pair = {"mode": "axial 2", "partner": "bending 8", "mac": 0.0237}
    table = tables.pairs(Record.model_validate({"mac": {"models": {"euler": {"pairs": [pair]}}}}))
    assert table.rows == [["axial 2", "0.0237 (none)"]]
    pair["mac"] = 0.8
    table = tables.pairs(Record.model_validate({"mac": {"models": {"euler": {"pairs": [pair]}}}}))
    assert table.rows == [["axial 2", "0.8000 (bending 8)"]]


def test_every_column_of_error_bars_has_one_who_fills_it():
    """A record keeps what an error bar of today has; a field that none has is a column of dashes."""
    names = {"gci" if f.name == "width" else f.name for f in fields(ErrorBar)}
    assert set(BarRecord.model_fields) <= names
