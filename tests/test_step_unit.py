"""The unit of a STEP file is that of its solids, whatever else the file has units for."""

from pathlib import Path

import pytest

from solidgear.core.meshing.quality import MeshError
from solidgear.parts.part import length_unit
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
    assert length_unit(content) == unit


def test_solids_in_two_units_are_refused():
    with pytest.raises(MeshError, match=r"several units of length \(inch, mm\).*its solids"):
        length_unit(added(INCH + METRE + PROPERTY + SECOND_SOLID))
