"""Builder options: one table, held by builders and command line alike."""

import inspect
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.elements import ELEMENTS
from solidgear.core.ladder.registry import LADDER
from solidgear.core.ladder.solid import _CHARTED
from solidgear.core.models.beam.body import beam
from solidgear.core.models.harmonic.body import harmonic
from solidgear.core.models.options import FACTORING_OPTIONS, THINNEST_LAYER
from solidgear.core.models.solid.body import solid
from solidgear.guards.elements import LINEAR, LOCKING
from solidgear.show.options import build_body, options

SCENE = sg.load(Path(__file__).parents[1] / "geometry" / "shaft_stepped.toml")
BUILDERS = {"euler": beam, "timoshenko": beam, "harmonic": harmonic, "solid": solid}


@pytest.mark.parametrize("model", BUILDERS)
def test_the_table_holds_what_builders_take(model):
    taken = {
        name: p.default
        for name, p in inspect.signature(BUILDERS[model]).parameters.items()
        if name != "scene"
    }
    # how a body is factored is no matter of its builder
    assert set(LADDER[model].options) - set(FACTORING_OPTIONS) == set(taken)
    # every default lies within its own limits
    assert LADDER[model].checked(
        {name: value for name, value in taken.items() if value is not None}
    )
    for name, value in taken.items():
        assert LADDER[model].options[name].optional == (value is None), name


def test_every_limit_has_a_reason():
    for table in (model.options for model in LADDER):
        for name, option in table.items():
            limited = any(
                limit is not None
                for limit in (option.least, option.most, option.above, option.below)
            )
            assert option.meaning and (option.why or not limited or option.kind == "flag"), name


def test_what_is_told_of_one_element_is_told_of_all():
    # an element without a row is silently not charted, or never said to lock
    assert set(ELEMENTS) == set(_CHARTED) == set(LOCKING) - {"Q1"}
    first = {name for name, element in ELEMENTS.items() if element.order == 1}
    assert set(LINEAR) == first
    assert all(ELEMENTS[better].order == 2 for better, _ in LINEAR.values())


REFUSED = {
    "no end of cells": ("harmonic", {"refinement": 1e9}, "between 0.01 and 20"),
    "no end of cells in 3D": ("solid", {"refinement": 1e9}, "between 0.01 and 20"),
    "cells of nothing": (
        "harmonic",
        {"size": 1e-9},
        "lines of cells, more than 20000; give size of at least",
    ),
    "cells of nothing in 3D": ("solid", {"size": 1e-9}, "lines of cells, more than 20000"),
    "tetrahedra of nothing": (
        "solid",
        {"element": "tet10", "size": 1e-9},
        "lines of cells, more than 20000",
    ),
    "layers without end": ("harmonic", {"layers": 100_000}, "between 0 and 20"),
    "waves without end": ("harmonic", {"ovalising": 1_000_000}, "at most 100"),
    "elements without end": ("euler", {"elements": 10**9}, "between 1 and 5000"),
    "cells around without end": ("solid", {"around": 10**9}, "between 8 and 720"),
    "layers thinner than digits": (
        "harmonic",
        {"ratio": 0.01, "layers": 4},
        "costs digits below 1e-06; give layers of at most 3",
    ),
    "layers thinner than digits by the usual ratio": ("harmonic", {"layers": 9}, "at most 8"),
    "layers across thinner than digits": (
        "solid",
        {"ratio": 0.01, "radial_layers": 4},
        "give radial_layers of at most 3",
    ),
    "misspelt": ("harmonic", {"ordr": 3}, 'did you mean "order"'),
    "unknown": (
        "harmonic",
        {"nonsense": 1},
        'no such option as "nonsense"; there are order, layers',
    ),
    "of another model": ("euler", {"order": 3}, "no such option"),
    "None": ("harmonic", {"order": None}, "order null is not usable"),
    "a flag for a number": ("harmonic", {"order": True}, "order true is not usable"),
    "a number for a flag": ("timoshenko", {"shear": 1}, "it is true or false"),
    "a decimal comma": ("harmonic", {"refinement": (1, 5)}, "decimals take a point"),
    "a wave twice": ("harmonic", {"ovalising": (2, 2)}, "each once"),
    "an array": ("harmonic", {"order": np.array([1, 2])}, "order"),
    "a huge number": ("harmonic", {"order": 10**6000}, "order 0x"),
    "unknown tie": (
        "solid",
        {"attachments": ("welded",)},
        "give one or more of average, rigid, section",
    ),
    "no tie": ("harmonic", {"attachments": ()}, "attachments"),
    "a cut without a number": ("harmonic", {"cuts": ((0.12, 0.025),)}, "give 3 numbers, y and r"),
    "cuts without end": ("harmonic", {"cuts": ((0.12, 0.025, 13),)}, "between 1 and 12"),
    "half a cut": ("harmonic", {"cuts": ((0.12, 0.025, 0.5),)}, "a whole number"),
    "a word for a place": ("harmonic", {"cuts": ("shoulder",)}, "give 3 numbers"),
    "a line through nowhere": ("harmonic", {"across": ((0.1, np.nan),)}, "give 2 numbers"),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_refused_in_a_sentence(kind):
    model, given, says = REFUSED[kind]
    with pytest.raises(sg.SolidgearError) as caught:
        sg.build(SCENE, model, **given)
    message = str(caught.value)
    assert message.startswith(f"{model}: ") and says in message
    assert "\n" not in message and len(message) < 500


@pytest.mark.parametrize("pair", ["scene=1", "fidelity=1", "self=1", "options=1", "nonsense=1"])
@pytest.mark.parametrize("model", LADDER.bodies)
def test_names_of_arguments_are_no_options(pair, model):
    with pytest.raises(sg.SolidgearError, match=f"{model}: there is no such option as"):
        build_body(SCENE, model, [pair])


def test_settings_of_the_command_line():
    assert options(["order=8", "ratio=0.3", "ovalising=2,3", "shear=false", "element=tet10"]) == {
        "order": 8,
        "ratio": 0.3,
        "ovalising": (2, 3),
        "shear": False,
        "element": "tet10",
    }
    with pytest.raises(sg.SolidgearError, match="order is set twice"):
        options(["order=3", "order=5"])


def test_a_single_name_number_or_place_is_a_list_of_one():
    given = {
        "ovalising": 2,
        "attachments": "rigid",
        "cuts": (0.12, 0.025, 1),
        "across": (0.12, 0.01),
    }
    assert LADDER["harmonic"].checked(given) == {name: (one,) for name, one in given.items()}


@pytest.mark.parametrize("name", ["cuts", "across"])
def test_a_place_that_is_not_on_the_mesh_is_named(name):
    nowhere = {"cuts": ((0.5, 0.5, 1),), "across": ((0.5, 0.5),)}[name]
    with pytest.raises(sg.SolidgearError, match=f"{name}: no .* of the mesh .* y = 0.5 m"):
        sg.build(SCENE, "harmonic", order=2, layers=0, **{name: nowhere})


def test_the_thinnest_layer_still_has_digits():
    # the limit was read from residuals that rise with ever thinner layers; just inside it the modes
    # have three digits to spare
    scene = sg.load(Path(__file__).parents[1] / "geometry" / "pinion_overhung.toml")
    body = sg.build(scene, "harmonic", order=2, ratio=0.1, layers=6)
    assert 0.1**6 == pytest.approx(THINNEST_LAYER)
    plain = sg.build(scene, "harmonic", order=2, ratio=0.1, layers=4)
    one, other = (sg.modes(b, scene, n=4).frequency_hz[1:] for b in (body, plain))
    # what two more layers of a tenth change at the shoulder is 1e-5
    np.testing.assert_allclose(one, other, rtol=1e-4)
