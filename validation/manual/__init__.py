"""Validation manual: cases with a known answer, their pages, and the command that writes them."""

from validation.manual.case import Case
from validation.manual.cases import (
    bearings,
    fillets,
    free_beams,
    held_beams,
    pinion,
    printed_bearings,
    printed_countershaft,
    printed_notches,
    printed_shafts,
    rods,
    solids,
    spur_train,
    statics,
    thesis,
)

SUBJECTS = (
    statics,
    free_beams,
    held_beams,
    rods,
    solids,
    bearings,
    thesis,
    pinion,
    spur_train,
    fillets,
    printed_countershaft,
    printed_shafts,
    printed_notches,
    printed_bearings,
)
CASES: dict[str, Case] = {case.name: case for subject in SUBJECTS for case in subject.CASES}
