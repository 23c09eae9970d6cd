"""Bearings of catalogue data fit their seats, shoulders and each other, or a scene says that they do not."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from solidgear.bearings.fit import misfits
from solidgear.core.scene.file import load
from solidgear.guards.registry import GUARDS
from solidgear.trains.assembly.layout import contacts, places
from solidgear.trains.assembly.space import overlaps
from solidgear.trains.file.reading import load_train

GEOMETRY = Path(__file__).parent.parent / "geometry"
SCENE = load(GEOMETRY / "gearbox_catalogue.toml")


def with_b(catalogue=None, **bearing):
    """The shaft of 40 mm with another bearing B in place of a pair of 7208 B, 36 mm wide at 150 mm."""
    first, second = SCENE.bearings
    data = second.catalogue.with_changes(
        **{"elements": None, "element_diameter": None, "pitch_diameter": None} | (catalogue or {})
    )
    second = second.with_changes(catalogue=data, **bearing)
    return SCENE.with_changes(bearings=(first, second))


def of(designation):
    """Boundary dimensions of a designation."""
    size = {"7210 B": (50, 90, 20), "7308 B": (40, 90, 23), "7207 B": (35, 72, 17)}[designation]
    bore, outer, width = (1e-3 * value for value in size)
    return {"designation": designation, "bore": bore, "outer_diameter": outer, "width": width}


@pytest.mark.parametrize("name", ["catalogue", "middle", "output"])
def test_shipped_bearings_fit(name):
    assert list(misfits(load(GEOMETRY / f"gearbox_{name}.toml"))) == []


@pytest.mark.parametrize(("designation", "bore"), [("7210 B", 50), ("7207 B", 35)])
def test_a_bore_that_is_not_its_seat_is_told_by_both_diameters(designation, bore):
    (text,) = misfits(with_b(of(designation)))
    assert f"'B' ({designation}) has a bore of {bore} mm and sits on a diameter of 40 mm" in text


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"seat_width": 36e-3}, ()),
        ({"seat_width": 44e-3}, ("is 36 mm wide with both of its rows, and its seat_width 44 mm",)),
        ({"seat_width": 10e-3}, ("is 36 mm wide with both of its rows, and its seat_width 10 mm",)),
        ({"seat_width": 20e-3, "y": 98e-3}, ()),
        ({"seat_width": 20e-3, "y": 91e-3}, ("over a step to 60 mm at 80 mm ('pinion')",)),
    ],
)
def test_width_against_seat_and_step(changes, words):
    told = list(misfits(with_b(**changes)))
    assert len(told) == len(words) and all(word in text for word, text in zip(words, told))


def test_a_shoulder_as_high_as_the_outer_ring_is_told():
    """It ends at 80 mm; a pair of 40 x 80 begins there."""
    for height, told in ((60e-3, 0), (78e-3, 1)):
        scene = with_b(y=98e-3)
        thick = tuple(
            s.with_changes(outer0=height / 2, outer1=height / 2) if s.name == "pinion" else s
            for s in scene.segments
        )
        assert len(list(misfits(scene.with_changes(segments=thick)))) == told


def test_bearings_that_take_the_same_space_are_told():
    """36 mm wide each, at 150 mm and at 120 mm; side by side at 114 mm they are not."""
    first, second = with_b().bearings
    for y, told in ((120e-3, 1), (114e-3, 0)):
        third = second.with_changes(name="C", y=y, seat_width=15e-3)
        second = second.with_changes(seat_width=15e-3)
        found = list(misfits(SCENE.with_changes(bearings=(first, second, third))))
        assert len(found) == told and all("take the same space" in text for text in found)


def test_an_inside_of_another_bearing_is_told():
    """A pitch circle of 60 mm is that of 40 x 80; 50 x 90 has 70 mm."""
    assert list(misfits(with_b({"pitch_diameter": 60e-3}))) == []
    _, inside = misfits(with_b(of("7210 B") | {"pitch_diameter": 60e-3}))
    assert (
        "pitch_diameter of 60 mm, but 70 mm is midway between its bore and its outer diameter"
        in inside
    )


def test_a_guard_says_it():
    probe = SimpleNamespace(scene=with_b(of("7210 B")))  # nothing of it is solved
    assert [notice.level for notice in GUARDS["bearing_fit"](probe)] == ["caution"]


def test_a_bearing_that_reaches_into_the_other_shaft_is_told():
    """Axes 115.5 mm apart leave 93 mm beside a shaft of 45 mm: a ring of 72 mm fits, of 200 mm not."""
    train = load_train(GEOMETRY / "gearbox_train.toml")
    for outer, count in ((72e-3, 0), (200e-3, 1)):
        first, *others = train.pinion.scene.bearings
        data = first.catalogue.with_changes(outer_diameter=outer)
        scene = train.pinion.scene.with_changes(
            bearings=(first.with_changes(catalogue=data), *others)
        )
        wide = train.with_changes(pinion=train.pinion.with_changes(scene=scene))
        scenes = {side: wide.shaft(side) for side in wide.shafts}
        told = overlaps(wide, scenes, places(wide, contacts(wide), scenes))
        assert len(told) == count and all('bearing "A"' in str(one) for one in told)
