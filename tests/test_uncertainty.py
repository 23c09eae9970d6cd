"""What the data of a scene leave open of its numbers."""

import json

import pytest
from pytest import approx

import solidgear as sg
from solidgear.comparison.page.html import numbers
from solidgear.core import as_supports
from solidgear.core.judge.correlation import pair_modes
from solidgear.core.judge.open_numbers import IntervalRecord
from solidgear.core.judge.record import Record
from solidgear.core.quantity import Quantity
from solidgear.core.scene.uncertain import with_ranges
from solidgear.show.open_words import acting, interval, parts
from solidgear.show.open_words import budget as budget_table
from solidgear.show.units import ENGINEERING
from solidgear.variants.budget.budget import (
    NamedShapes,
    ReducedBeam,
    beside,
    budget,
    open_inputs,
    spread_points,
)
from tests.command import command

STEPPED, GEARBOX = "geometry/shaft_stepped.toml", "geometry/gearbox_catalogue.toml"


@pytest.fixture(scope="module")
def gearbox():
    # modes as high as the seventh bending may pass the points that were solved, by 1e-4 of themselves
    scene = sg.load(GEARBOX).with_changes(ask=sg.Ask(modes=4))
    return budget(scene, samples=20, seed=3)


def test_a_modulus_and_a_density_move_a_free_shaft_by_their_roots():
    free = sg.Scene.from_parts([sg.Segment.cylinder("rod", length=0.6, diameter=0.03)])
    found = beside(with_ranges(free, {"material.E": "± 4 %", "material.density": "± 2 %"}))
    total = found.of("bending 1").total
    assert total.low == approx((0.96 / 1.02) ** 0.5 - 1, rel=1e-6)  # f ~ sqrt(E / rho)
    assert total.high == approx((1.04 / 0.98) ** 0.5 - 1, rel=1e-6)


def test_a_body_of_its_own_takes_a_modulus_without_being_built_again():
    scene = with_ranges(sg.load(STEPPED), {"material.E": "0.5e11 Pa : 3e11 Pa"})
    by_body = beside(scene, sg.build(scene, "timoshenko"))
    for quantity in ("C_zz", "K_thx", "C_yy"):
        own, built = by_body.of(quantity).total, beside(scene).of(quantity).total
        # springs stay as they are, so that these are no factors of a modulus; but for rounding equal
        assert (own.low, own.high) == approx((built.low, built.high), rel=1e-6)


@pytest.mark.long
def test_ranges_of_catalogue_bearings_hold_samples_of_all_their_data(gearbox):
    for one in gearbox.numbers:
        # rounding of what does not move is 1e-9
        assert one.total.low - 1e-9 <= one.sampled.low, one.quantity
        assert one.sampled.high <= one.total.high + 1e-9, one.quantity
    first = gearbox.of("bending 1").total
    assert first.low < -0.5 and first.high > 0.1  # the load decides, and is taken from a fifth on


def test_what_is_worth_measuring_comes_first(gearbox):
    shares = gearbox.of("bending 1").shares
    assert next(iter(shares)) == "load" and sum(shares.values()) == approx(1.0)
    by_source = gearbox.of("bending 1").by_source
    assert by_source["load"].low < by_source["bearings"].low < 0


def test_ranges_write_their_chart_and_the_numbers_of_the_command(gearbox, tmp_path):
    files = {path.name for path in gearbox.write(tmp_path)}
    assert files == {"budget.html", "budget.json", "budget.png", "budget.svg"}
    written = json.loads((tmp_path / "budget.json").read_text(encoding="utf-8"))
    assert written["scene"] == "gearbox_catalogue" and len(written["numbers"]) > 4


@pytest.mark.slow
def test_inputs_that_do_not_act_on_one_another_add_up_as_squares():
    scene = sg.load(STEPPED).with_changes(ask=sg.Ask(modes=3))
    scene = with_ranges(scene, {"material.E": "± 5 %", "material.density": "± 5 %"})
    found = budget(scene, samples=40, seed=1)
    first = found.of("bending 1")
    # a deviation of 40 samples is good to 1 / sqrt(80); Latin squares are better than that
    assert first.sampled.deviation == approx(first.total.deviation, rel=0.1)
    assert not acting(found, found.numbers)


def test_inputs_that_act_on_one_another_are_told(gearbox):
    # less load than a fifth of it softens a bearing more where its clearance is large: the deviation
    # of all lies beyond the root of squares of each, as 2,000 samples show (validation)
    found = gearbox.model_copy(deep=True)
    one = found.of("bending 1")
    one.sampled.deviation = 1.4 * one.total.deviation
    found.samples = 200
    assert "bending 1" in [told.quantity for told in acting(found, [one])]
    assert "there take the samples and not s" in budget_table(found, ["bending 1"]).note


def test_a_bearing_that_its_file_calls_assumed_has_a_range():
    opened = open_inputs(sg.load("geometry/intermediate_shaft.toml"))
    assert [(one.path, one.low, one.high) for one in opened] == [
        ("bearing.A.stiffness", 0.5, 2.0),
        ("bearing.B.stiffness", 0.5, 2.0),
    ]


def test_a_mode_is_followed_through_its_neighbours(gearbox):
    # axial 1 and bending 1 pass each other where the load is small: by name, one would end there
    axial = gearbox.of("axial 1").total
    assert -0.25 < axial.low < -0.1 and axial.high < 0.05


def test_a_reduced_beam_has_the_modes_of_the_beam_on_any_springs():
    """Springs three times softer and stiffer: names follow the shapes, and
    what the beam's higher modes would add is less than the figures of a range.
    """
    gearbox, listed = sg.load(GEARBOX), 6
    beam = sg.build(gearbox, "timoshenko")
    reduced = ReducedBeam(beam, listed + 4)
    first = NamedShapes.of(
        sg.modes(beam, gearbox, listed), reduced.shapes(as_supports(gearbox), beam)
    )
    for factor in (0.3, 1.0, 3.0):
        scene = gearbox.with_bearing_scale(factor)
        direct = sg.modes(beam, scene, listed + 4)
        shapes = reduced.shapes(as_supports(scene), beam)
        elastic = [m for m in direct.modes for _ in range(m.multiplicity) if m.frequency_hz]
        expected = [m.frequency_hz for m in elastic][: len(shapes.frequency_hz)]
        assert shapes.frequency_hz[: len(expected)] == pytest.approx(expected, rel=1e-5)
        named = first.frequencies(shapes, beam)
        paired = {p.reference.name: p for p in pair_modes(direct, sg.modes(beam, gearbox, listed))}
        certain = [name for name, p in paired.items() if p.certain and p.mode is not None]
        assert len(certain) >= 3
        for name in certain:
            assert named[Quantity(name)] == pytest.approx(paired[name].frequency_hz, rel=1e-5)


def test_a_reduced_beam_keeps_its_modes_beside_a_clamp():
    """A clamp of 1e22 N/m added to the reduced stiffness leaves nothing of the shaft."""
    scene = sg.load("geometry/rotor_disc.toml")
    beam = sg.build(scene, "timoshenko")
    direct = sg.modes(beam, scene, 4)
    expected = [m.frequency_hz for m in direct.modes for _ in range(m.multiplicity)]
    shapes = ReducedBeam(beam, 10).shapes(as_supports(scene), beam)
    assert shapes.frequency_hz[: len(expected)] == pytest.approx(expected, rel=1e-5)


def test_points_inside_fill_every_direction():
    points = spread_points(3, 16)
    for k in range(3):
        assert len(set((points[:, k] * 16).astype(int))) == 16


def test_a_scene_that_states_all_of_its_data_prints_as_without_ranges():
    scene = sg.load(STEPPED)
    assert open_inputs(scene) == () and beside(scene).inputs == []
    with pytest.raises(sg.SolidgearError, match="no input is open"):
        budget(scene)
    assert "uncertain" not in scene.as_dict()


@pytest.mark.parametrize(
    "path, text, sentence",
    [
        ("material.E", "300 GPa : 400 GPa", "that contains the scene's value"),
        ("material.E", "3 %", "must be two ends"),
        ("bearing.A.stiffness", "1 : 2", "cannot have a range here"),
        ("bearing.B.catalogue.preload", "100 um : 1 N", "preload"),
        ("segment.left.length", "± 1 %", "a range may have"),
    ],
)
def test_a_range_that_is_none_is_refused_by_its_path(path, text, sentence):
    with pytest.raises(sg.SceneError, match=sentence) as refused:
        with_ranges(sg.load(GEARBOX), {path: text})
    assert path in str(refused.value)


def test_ranges_stand_in_the_column_of_the_bar_on_page_one(gearbox):
    record = Record.model_validate(
        {
            "open": gearbox.model_dump(),
            "models": {"harmonic": {"modes": [{"name": "bending 1", "frequency_hz": 1574.6}]}},
        }
    )
    (row,) = numbers(record, ENGINEERING).rows
    assert row[2] == "no error bar\nbearings -10 / +11 %\nload -39 / +3.1 %\nin all -55 / +14 %"
    assert dict(parts(record.open, "bending 1"))["in all"] == "-55 / +14 %"


def test_a_range_is_told_to_the_figures_it_has():
    told = [
        interval(IntervalRecord(low=a, high=b)) for a, b in ((-0.015, 0.015), (0, 0.024), (0, 0))
    ]
    assert told == ["± 1.5 %", "0 / +2.4 %", "0"]


def test_the_commands_tell_ranges(tmp_path):
    chart, scene = tmp_path / "budget.png", "geometry/intermediate_shaft.toml"
    done = command("budget", scene, "--ask", "bending", "--out", chart)
    assert done.exit_code == 0, done.output
    assert "bearing.A.stiffness" in done.output and chart.read_bytes().startswith(PNG)


PNG = b"\x89PNG"

SHARED = """
material = "42CrMo4"
segment = [
    { kind = "cylinder", name = "a", length = "150 mm", diameter = "50 mm" },
    { kind = "cylinder", name = "b", length = "150 mm", diameter = "50 mm", material = %s },
]
bearing = [
    { name = "A", position = "20 mm", seat_width = "20 mm", stiffness = { kxx = "4e8 N/m", kyy = "2e8 N/m", kzz = "4e8 N/m" } },
    { name = "B", position = "280 mm", seat_width = "20 mm", stiffness = { kxx = "4e8 N/m", kzz = "4e8 N/m" } },
]
port = { at = "a.end", attach_to = "a" }
"""


def first(path, text):
    path.write_text(text)
    scene = sg.load(path)
    return scene, sg.modes(sg.build(scene, "timoshenko"), scene, n=2).named(
        "bending 1"
    ).frequency_hz


def test_a_modulus_moves_every_segment_that_has_it_from_the_material(tmp_path):
    """A segment with a density of its own takes E from the material: a range of E is one of it too."""
    own = SHARED % '{ density = "7000 kg/m^3" }'
    scene, there = first(tmp_path / "a.toml", own)
    softer = own.replace('"42CrMo4"', '{ E = "189 GPa", nu = 0.3, density = "7850 kg/m^3" }')
    _, low = first(tmp_path / "b.toml", softer)
    found = beside(with_ranges(scene, {"material.E": "189 GPa : 210 GPa"})).of("bending 1").total
    assert found.low == approx(low / there - 1, rel=1e-6)  # the same beam on the same mesh


def test_a_material_of_a_segment_may_have_a_range(tmp_path):
    named = SHARED % '"aluminium"'
    scene, there = first(tmp_path / "a.toml", named)
    stiffer = named.replace('"aluminium"', '{ E = "77 GPa", nu = 0.3, density = "2700 kg/m^3" }')
    _, high = first(tmp_path / "b.toml", stiffer)
    ranged = with_ranges(scene, {"segment.b.material.E": "70 GPa : 77 GPa"})
    assert beside(ranged).of("bending 1").total.high == approx(high / there - 1, rel=1e-6)
    # a body that is given cannot be as many times as stiff in one of its segments alone
    by_body = beside(ranged, sg.build(ranged, "timoshenko")).of("C_zz").total
    assert by_body.low == approx(beside(ranged).of("C_zz").total.low, rel=1e-6)
