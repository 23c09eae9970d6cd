"""Errors of studies name arguments from Python, and options from the command line."""

from __future__ import annotations

import pytest

import solidgear as sg
from tests.command import command

SHAFT, TRAIN = "geometry/shaft_stepped.toml", "geometry/axle_straddle.toml"
LENGTH = "segment.left.length=1,2"
#: a study, its command with the same words, and what both say but for the names
CASES = {
    "torque": (
        lambda: sg.deflect(SHAFT, torque="3 N*m"),
        ("deflect", SHAFT, "--torque", "3 N*m"),
        f"{{torque}} is for a train, and {SHAFT} is a shaft: give {{load}}, or [load] in the file",
    ),
    "not the name of the option": (
        lambda: sg.bearing(SHAFT, "Q", load="x=1"),
        ("bearing", SHAFT, "--bearing", "Q", "--load", "x=1"),
        "{bearing} Q: no bearing of catalogue data has this name; known here: none",
    ),
    "two words": (
        lambda: sg.sweep(TRAIN, "losses.mesh=0.01,0.02", every_point=True, point="1"),
        ("sweep", TRAIN, "--vary", "losses.mesh=0.01,0.02", "--every-point", "--point", "1"),
        "{every-point} takes every operating point: give no {point} and vary none",
    ),
    "of another command": (
        lambda: sg.sweep(SHAFT, LENGTH, reduction_tolerance=0.1),
        ("sweep", SHAFT, "--vary", LENGTH, "--tolerance", "0.1"),
        "{tolerance} is that of one body for many bearing sets, and here more varies",
    ),
}
#: names of Python where they are not those of options
PYTHON = {"bearing": "name", "tolerance": "reduction_tolerance"}


@pytest.mark.parametrize("case", CASES)
def test_an_error_names_arguments_from_python_and_options_from_a_command(case):
    study, words, text = CASES[case]
    with pytest.raises(sg.SolidgearError) as raised:
        study()
    names = {part.partition("}")[0] for part in text.split("{")[1:]}
    python = {name: f"`{PYTHON.get(name) or name.replace('-', '_')}`" for name in names}
    assert str(raised.value).endswith(text.format(**python))
    options = text.format(**{name: f"--{name}" for name in names})
    assert str(command(*words).exception).endswith(options)
