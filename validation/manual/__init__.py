"""Validation manual: cases with a known answer, their pages, and the command that writes them."""

from validation.manual.case import Case
from validation.manual.cases import free_beams, held_beams

CASES: dict[str, Case] = {case.name: case for case in (*free_beams.CASES, *held_beams.CASES)}
