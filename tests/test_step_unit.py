"""The unit of a STEP file is that of its solids, whatever else the file has units for."""

from pathlib import Path

import pytest

import solidgear as sg
from solidgear.core.meshing.quality import MeshError
from solidgear.parts.body_file import UNITS
from solidgear.parts.step_unit import length_unit
from validation.step_parts import with_unit

STEP = (Path(__file__).parents[1] / "geometry" / "shaft_step.step").read_text()
METRE = "#90004=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.));\n"
INCH = (
    "#90001=(CONVERSION_BASED_UNIT('INCH',#90002) LENGTH_UNIT() NAMED_UNIT(#90003));\n"
    "#90002=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(0.0254),#90004);\n"
    "#90003=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n"
)
#: a density with a context of its own, as programs with a library of materials write it
PROPERTY = (
    "#90006=(GLOBAL_UNIT_ASSIGNED_CONTEXT((#90001))REPRESENTATION_CONTEXT('density; of steel',''));\n"
    "#90007=REPRESENTATION('density',(#90008),#90006);\n"
)
SECOND_SOLID = (
    "#90009=MANIFOLD_SOLID_BREP('it''s (2)',#38);\n"
    "#90010=ADVANCED_BREP_SHAPE_REPRESENTATION('two; (2)',(#11,#90009),#90006);\n"
)


def added(text: str, step: str = STEP) -> bytes:
    end = step.rindex("ENDSEC;")
    return (step[:end] + text + step[end:]).encode()


@pytest.mark.parametrize(
    "content, unit",
    [
        (added(METRE + "#90005=DERIVED_UNIT_ELEMENT(#90004,-3.);\n"), "mm"),
        (added(INCH + METRE + "#90005=DERIVED_UNIT_ELEMENT(#90001,-3.);\n"), "mm"),
        (added(INCH + METRE + PROPERTY), "mm"),
        (
            added("#90005=DERIVED_UNIT_ELEMENT(#90004,-3.);\n" + METRE, with_unit(STEP, "inch")),
            "inch",
        ),
        (added("#90005=DERIVED_UNIT_ELEMENT(#24,-3.);\n", with_unit(STEP, "m")), "m"),
    ],
    ids=["metre", "inch", "context of its own", "part in inches", "part in metres"],
)
def test_a_unit_of_density_is_not_that_of_the_shape(content, unit):
    assert length_unit(content) == UNITS[unit]


def test_solids_in_two_units_are_refused():
    with pytest.raises(MeshError, match=r"several units of length \(mm, inch\) for its solids"):
        length_unit(added(INCH + METRE + PROPERTY + SECOND_SOLID))


FOOT = (
    "#90001=(CONVERSION_BASED_UNIT('FOOT',#90002) LENGTH_UNIT() NAMED_UNIT(#90003));\n"
    "#90002=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(12.),#90011);\n"
    "#90011=(CONVERSION_BASED_UNIT('inch',#90012) LENGTH_UNIT() NAMED_UNIT(#90003));\n"
    "#90012=(LENGTH_MEASURE_WITH_UNIT()MEASURE_REPRESENTATION_ITEM()MEASURE_WITH_UNIT("
    "POSITIVE_LENGTH_MEASURE(2.54E1),#90013)REPRESENTATION_ITEM(''));\n"
    "#90013=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.));\n"
)
CONTEXT = "#90006=(GLOBAL_UNIT_ASSIGNED_CONTEXT((#90001))REPRESENTATION_CONTEXT('',''));\n"


def by_conversion(factor, name="METRE"):
    """Entities of a unit of so many metres, and of a context that has it."""
    inch = INCH.replace("0.0254", str(factor)).replace("INCH", name)
    return (CONTEXT + inch + METRE).encode()


@pytest.mark.parametrize(
    "content, metres",
    [
        (by_conversion("1.0"), 1.0),
        (by_conversion("1.E-3", "MILLIMETRE"), 1e-3),
        (by_conversion("0.3048", "FOOT"), 0.3048),
        (by_conversion("2.54E-5", "MIL"), 2.54e-5),
        (by_conversion("0.0254", "ZOLL"), 0.0254),
        ((CONTEXT + FOOT).encode(), 0.3048),
        ((CONTEXT + METRE.replace("$", ".MICRO.").replace("90004", "90001")).encode(), 1e-6),
    ],
    ids=["metre", "millimetre", "foot", "mil", "another name", "foot by inch by mm", "micrometre"],
)
def test_a_unit_by_conversion_carries_its_factor(content, metres):
    """Whatever it is called; ISO 10303-41."""
    assert length_unit(content) == pytest.approx(metres, rel=1e-12)


@pytest.mark.parametrize(
    "content",
    [
        (CONTEXT + INCH).encode(),  # counts a unit that is not there
        (CONTEXT + INCH.replace("#90004", "#90001")).encode(),  # counts itself
        by_conversion("one"),
    ],
    ids=["no unit behind it", "itself", "no number"],
)
def test_a_unit_without_a_factor_is_refused(content):
    with pytest.raises(MeshError, match="names no unit of length for its solids"):
        length_unit(content)


def test_a_part_in_a_unit_by_conversion_has_its_size():
    """A rod of 60 mm and 0.148 kg of steel, whose file calls its unit METRE and gives the factor 1."""
    scene = sg.load(Path(__file__).parent / "found" / "parts" / "unit_metre.toml")
    assert scene.length == pytest.approx(0.06, rel=1e-9)
    assert scene.body.volume * 7850 == pytest.approx(0.148, rel=2e-3)
