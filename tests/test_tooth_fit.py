"""Teeth of cylindrical gears fit where the centre distance puts them, or a train says that they do not."""

from math import acos, atan, cos, pi, radians, sin, tan
from pathlib import Path

import pytest

from solidgear.core.errors import SceneError
from solidgear.core.gears.wheel import Rack, Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.trains.assembly.gear_bodies import gear_cautions
from solidgear.trains.assembly.layout import contacts
from solidgear.trains.file.cylindrical import working_cylinders
from solidgear.trains.file.reading import load_train
from solidgear.trains.file.tooth_fit import fit_cautions, fit_of, wheel_cautions

GEOMETRY = Path(__file__).parent.parent / "geometry"
PRESSURE = radians(20)


def inv(angle):
    return tan(angle) - angle


def pair_of(teeth, module, helix=0.0, shift=(0.0, 0.0), centre=None):
    first, second = (Wheel(z, module, helix, x, Rack(PRESSURE)) for z, x in zip(teeth, shift))
    return WheelPair(first, second, centre)


def gap_by_thickness(teeth, module, helix, shift, centre):
    """Backlash along the line of action from tooth thicknesses on the working pitch circles."""
    across = atan(tan(PRESSURE) / cos(helix))
    radii = [module * z / (2 * cos(helix)) for z in teeth]
    at_work = acos(sum(radii) * cos(across) / centre)
    rolling = [centre * z / sum(teeth) for z in teeth]
    thick = [
        2 * r * ((pi / 2 + 2 * x * tan(PRESSURE)) / z + inv(across) - inv(at_work))
        for r, x, z in zip(rolling, shift, teeth)
    ]
    base_helix = atan(tan(helix) * cos(across))
    return (2 * pi * rolling[0] / teeth[0] - sum(thick)) * cos(at_work) * cos(base_helix)


@pytest.mark.parametrize("helix", [0.0, radians(18)])
@pytest.mark.parametrize("shift", [(0.0, 0.0), (0.4, -0.15)])
@pytest.mark.parametrize("more", [-2e-3, 0.0, 1e-3])
def test_backlash_is_the_pitch_without_both_teeth(helix, shift, more):
    """By two ways of ISO 21771 that share no step: base pitches, and thicknesses where wheels roll."""
    teeth, module = (23, 57), 2.5e-3
    centre = working_cylinders(teeth, module, helix, PRESSURE, shift).without_backlash + more
    fit = pair_of(teeth, module, helix, shift, centre)
    due = gap_by_thickness(teeth, module, helix, shift, centre)
    assert fit.backlash == pytest.approx(due, abs=1e-12)
    assert (abs(fit.backlash) < 1e-12) if more == 0 else (fit.backlash * more > 0)


def test_contact_ratio_of_standard_gears_outside_and_inside():
    """1.6841 of 23 and 57 teeth at 20 degrees; of a ring by the length of its path of contact, which
    begins where the rack's straight side, 1.25 - 0.38 (1 - sin 20 deg) modules long, ends.
    """
    outside = pair_of((23, 57), 4e-3, centre=160e-3)
    assert outside.contact_ratio == pytest.approx(1.6841, abs=5e-5)
    inside = pair_of((34, -85), 1.0, centre=25.5)
    straight = 1.25 - 0.38 * (1 - sin(PRESSURE))
    start = 17 * sin(PRESSURE) - straight / sin(PRESSURE)
    stop = (18.0**2 - (17 * cos(PRESSURE)) ** 2) ** 0.5
    assert inside.contact_ratio == pytest.approx((stop - start) / (pi * cos(PRESSURE)), rel=1e-12)
    # its tips would meet the teeth of the planet before
    assert inside.tip_ends[0] < start
    assert inside.backlash == pytest.approx(0.0, abs=1e-12)
    assert inside.clearances == pytest.approx((0.25, 0.25), rel=1e-12)


@pytest.mark.parametrize(
    ("teeth", "shift", "more", "words"),
    [
        ((23, 57), (0.0, 0.0), 0.0, ()),
        ((17, 57), (0.0, 0.0), 0.0, ()),
        ((14, 57), (0.0, 0.0), 0.0, ("a contact ratio of 1.46 remains of 1.62",)),
        ((11, 57), (0.0, 0.0), 0.0, ("of 1.18 remains of 1.59", "at least 0.36")),
        (
            (20, 20),
            (1.2, 1.2),
            0.0,
            ("tips of the pinion, 61 mm across if they are those of its rack, cut 673",),
        ),
        ((23, 57), (0.0, 0.0), 1.5e-3, ("contact ratio is 0.6",)),
    ],
)
def test_teeth_that_hardly_anyone_would_make_are_told(teeth, shift, more, words):
    centre = working_cylinders(teeth, 2.5e-3, 0.0, PRESSURE, shift).without_backlash + 2 * more
    fit = pair_of(teeth, 2.5e-3, shift=shift, centre=centre)
    said = [*fit_cautions(fit, ("pinion", "gear")), *wheel_cautions(fit.first, "pinion")]
    assert all(any(word in text for text in said) for word in words)
    assert bool(said) == bool(words)


@pytest.fixture(scope="module")
def gearbox():
    return load_train(GEOMETRY / "gearbox_train.toml").with_changes(operation=())


def by_module(train, mesh=None, **pinion):
    """The gearbox in the words of cylindrical gears: 115.5 mm without backlash."""
    plain = {"pitch_radius": None, "spiral_angle": None, "pitch_angle": None}
    own = plain | {"module": 3e-3 * cos(radians(15)), "helix_angle": radians(15)} | pinion
    return train.with_changes(
        pinion=train.pinion.with_changes(**own),
        gear=train.gear.with_changes(**plain),
        mesh=train.mesh.with_changes(**(mesh or {})),
    )


def said_of(train):
    return [text for text in gear_cautions(train, contacts(train)) if "along the line" in text]


@pytest.mark.parametrize(
    ("distance", "words"),
    [
        (
            112e-3,
            "is too short: 20 and 57 teeth of 2.89778 mm module with profile shifts that sum to 0",
        ),
        (122e-3, "is too long"),
    ],
)
def test_teeth_that_overlap_or_do_not_reach_each_other_are_refused(gearbox, distance, words):
    with pytest.raises(SceneError, match=words) as error:
        by_module(gearbox, {"centre_distance": distance})
    assert error.value.problems[0].path == ("mesh", "centre_distance")


@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        ({}, ""),
        ({"centre_distance": 115.6e-3}, ""),
        ({"centre_distance": 115.45e-3}, "overlap by 34"),
        ({"centre_distance": 117e-3}, "the backlash is large"),
        ({"centre_distance": 115.6e-3, "backlash": 100e-6}, ""),
        ({"centre_distance": 116e-3, "backlash": 100e-6}, "less than the teeth have"),
        ({"backlash": 1.5e-3}, "far more than the teeth have"),
    ],
)
def test_backlash_of_the_numbers_is_held_against_what_is_usual_and_what_is_given(
    gearbox, mesh, words
):
    said = said_of(by_module(gearbox, mesh))
    assert [words in text for text in said] == [True] * bool(words)


def test_the_sum_of_profile_shifts_that_fits_a_distance_has_no_backlash(gearbox):
    """They contradict each other, and not each a limit of its own: 112 mm is right for -1.1 modules."""
    teeth, helix = (20, 57), radians(15)
    module = 3e-3 * cos(helix)
    across = atan(tan(PRESSURE) / cos(helix))
    at_work = acos(115.5e-3 * cos(across) / 112e-3)
    both = sum(teeth) * (inv(at_work) - inv(across)) / (2 * tan(PRESSURE))
    train = by_module(gearbox, {"centre_distance": 112e-3}, profile_shift=both)
    assert fit_of(train.pairs[0]).backlash == pytest.approx(0.0, abs=1e-12)
    assert fit_of(train.pairs[0]).first.module == module


def test_a_radius_that_contradicts_the_centre_distance_is_refused(gearbox):
    mesh = gearbox.mesh.with_changes(centre_distance=110e-3)
    with pytest.raises(SceneError, match=r"110 mm apart roll at 28\.5714 mm"):
        gearbox.with_changes(mesh=mesh)


def test_roots_within_the_bore_are_refused(gearbox):
    scene = gearbox.pinion.scene
    hollow = scene.with_changes(
        segments=tuple(s.with_changes(inner0=15e-3, inner1=15e-3) for s in scene.segments)
    )
    by_module(gearbox, scene=hollow)
    with pytest.raises(SceneError, match="inside the bore of its shaft, 15 mm") as error:
        by_module(gearbox, scene=hollow, teeth=11)
    assert error.value.problems[0].path == ("pinion", "teeth")
