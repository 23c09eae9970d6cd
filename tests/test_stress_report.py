"""Tables and the chart of the stress of a shaft: every number with its unit, bar and source."""

import math

import pytest
from charted import facts_of
from filleted import STRONG, shoulder
from test_fillet_stress import loads_on

from solidgear.show.units import US
from solidgear.strength.stress import sheet as stress_tables
from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.shaft import shaft_stress


@pytest.fixture(scope="module")
def found():
    scene = shoulder(strength=STRONG)
    return shaft_stress(
        scene, loads_on(scene), tolerance=0.05, conditions=Conditions(roughness="6.3 um")
    )


def test_every_section_force_is_read_off(found):
    table = stress_tables.section_forces(found.forces)
    at_gear = [row for row in table.texts if row[1] == "gear"]
    assert [row[2] for row in at_gear] == ["before", "beyond"]
    assert at_gear[0][table.heads.index("N, N")] == "2000.0"
    assert at_gear[1][table.heads.index("T, N m")] == "0"


def test_nominal_stress_is_in_megapascal_or_ksi(found):
    metric, imperial = (stress_tables.nominal_stress(found, *units) for units in ((), (US,)))
    assert (metric.title, imperial.title) == ("Nominal stress, MPa", "Nominal stress, ksi")
    at = metric.heads.index("tau_t")
    value, other = (float(told.texts[0][at]) for told in (metric, imperial))
    assert value == pytest.approx(6.894757 * other, rel=1e-3) and value != 0


def test_a_fillet_is_told_with_its_bars_beside_what_is_published(found):
    (notch,) = found.notches
    table = stress_tables.form_factors(found)
    row = dict(zip(table.heads, table.texts[1]))
    factor = notch.found.factors["bending"]
    assert (row["fillet"], row["by"]) == ("fillet", "bending")
    assert float(row["Kt"]) == pytest.approx(factor.value, rel=5e-4)
    assert float(row["error bar"].split()[0]) == pytest.approx(
        100 * factor.bar / factor.value, rel=0.01
    )
    # D/d 1.5, r/d 0.1: Peterson, chart 3.10, and DIN 743-2, 5.2, by hand
    assert (row["Peterson"], row["DIN 743"]) == ("1.743", "1.720")
    assert float(row["Kf"]) < float(row["Kt"])
    stress = stress_tables.surface_stress(found, {"fillet": (90e6, 99e6)})
    row = dict(zip(stress.heads, stress.texts[1]))
    assert row["range"] == "90.00 to 99.00"
    assert float(row["surface"]) == pytest.approx(notch.local.amplitude / 1e6, rel=5e-4)
    assert float(row["error bar"]) == pytest.approx(notch.local.amplitude_bar / 1e6, rel=0.05)


def test_a_rating_shows_every_factor_its_source_and_what_is_assumed(found):
    table = stress_tables.rating("fillet", found.worst[0].rating)
    symbols = [row[0] for row in table.texts]
    for wanted in ("K_1 (sigma_B)", "K_2", "K_F", "K_V", "beta", "K_sigma, K_tau", "sigma_WK"):
        assert wanted in symbols
    assert all(row[-1] for row in table.texts)
    assert "Assumed, since not given: K_1 (sigma_B)" in table.note
    assert f"Safety against fatigue {found.worst[0].rating.fatigue:.3g}"[:28] in table.note
    (row,) = stress_tables.safeties(found).texts
    assert row[:2] == ["fillet", "fillet"]
    assert float(row[2]) == pytest.approx(found.worst[0].rating.fatigue, rel=5e-3)


def test_sharp_corners_are_told_in_one_sentence():
    scene = shoulder().with_changes(blends=())
    bare = shaft_stress(scene, loads_on(scene))
    (told,) = stress_tables.remarks(bare)
    assert told.startswith("sharp corners at y = 300.00 mm (s0 to s1): no stress there")
    for table in (stress_tables.fillets, stress_tables.form_factors, stress_tables.safeties):
        assert not table(bare)


def test_a_chart_is_read_at_every_load(found):
    facts = facts_of(stress_tables.section_chart(found.forces, "a shaft").svg())
    told = dict(facts)
    assert told["N before gear"]["N"] == "2000.0 N"
    assert told["T beyond gear"]["T"] == "0 N m"


def test_the_size_of_a_moment_is_no_straight_line_between_loads(found):
    """Of two components that change sign in different places the size curves."""
    scene = shoulder()
    loads = loads_on(scene)
    for name, x in (("A", 4000.0), ("gear", 1000.0), ("B", -5000.0)):
        loads[name] = loads[name] + [x, 0, 0, 0, 0, 0]
    arms = sum(loads[name][0] * y for name, y in places(scene))
    loads["B"] = loads["B"] + [0, 0, 0, 0, 0, arms]
    forces = shaft_stress(scene.with_changes(blends=()), loads).forces
    panel = stress_tables.section_chart(forces).rows[2][0]
    size = next(rows for mark, rows, _ in panel.layers if rows[0].get("name") == "M")
    for row in size:
        six = forces.at(row["x"] / 1e3)
        near = forces.at(row["x"] / 1e3 - 1e-9)
        exact = {round(math.hypot(s[3], s[5]), 4) for s in (six, near)}
        assert min(abs(row["y"] - value) for value in exact) < 1e-3
    assert len(size) > 60


def places(scene):
    return [(station.name, station.y) for station in scene.stations]
