"""Peaks of another part are doubted, and those of the right part with a wrong material are not."""

from __future__ import annotations

import math
import tomllib

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.loading import scene_of
from solidgear.measured.alignment import Peak
from solidgear.measured.correlate import correlate
from solidgear.measured.data import Measured
from solidgear.measured.identify import identify
from solidgear.measured.same_part import FAR_SHIFTS, SAME_PART, Likeness, alignment_of

#: lengths and diameters of shafts, mm
SHAFTS = (
    ((120, 40), (200, 50)),
    ((90, 45), (60, 70), (140, 35)),
    ((250, 30),),
    ((40, 80), (160, 55)),
    ((60, 30), (60, 60), (60, 30), (30, 25)),
)


def file_of(steps, modulus=206e9, ratio=0.3):
    """Scene file of a shaft."""
    segments = ", ".join(
        f'{{ kind = "cylinder", name = "s{k}", length = "{length} mm", diameter = "{diameter} mm" }}'
        for k, (length, diameter) in enumerate(steps)
    )
    return (
        f"material = {{ E = {modulus}, nu = {ratio}, density = 7850.0 }}\nsegment = [{segments}]\n"
        'port = { position = 0.0, span = ["0 mm", "10 mm"] }\n'
    )


def shaft(*about):
    return scene_of(tomllib.loads(file_of(*about)), "shaft.toml")


def modes(scene, count=30):
    """Elastic modes by the Timoshenko beam; the pairing asks nothing of how they were computed."""
    body = sg.build(scene, "timoshenko")
    return [mode for mode in sg.modes(body, scene, n=count).modes if mode.frequency_hz > 0]


@pytest.fixture(scope="module")
def listed():
    return [modes(shaft(steps)) for steps in SHAFTS]


def likeness(measured, computed, noise=2e-3):
    """Peaks of a tap test, with an accelerometer's mass and cords in them, beside modes."""
    rng = np.random.default_rng(11)
    logs = [math.log(mode.frequency_hz) + noise * rng.standard_normal() for mode in measured]
    peaks = [Peak(log, 1e-3) for log in sorted(logs)]
    top = peaks[-1].log_frequency + math.log(1.1) + max(FAR_SHIFTS)
    its = [
        Peak(math.log(mode.frequency_hz), 2e-4, mode.multiplicity, mode.name.family)
        for mode in computed
        if math.log(mode.frequency_hz) < top
    ]
    return Likeness.of(alignment_of(peaks, its))


@pytest.mark.parametrize("count", [5, 8])
def test_peaks_of_every_other_shaft_are_doubted(listed, count):
    for k, measured in enumerate(listed):
        for j, computed in enumerate(listed):
            doubted = likeness(measured[:count], computed)
            assert bool(doubted.sentence) == (j != k), (k, j, doubted)
            # fewer may be too few to say more
            assert count == 5 or j == k or doubted.sentence.startswith("This may be another part")


@pytest.mark.parametrize("factor", [0.6, 0.75, 1.2, 1.8])
@pytest.mark.parametrize("ratio", [0.26, 0.34])
def test_a_wrong_material_is_no_other_part(listed, factor, ratio):
    """Cast iron and aluminium have these ratios; a modulus may be one of another metal."""
    for steps, computed in zip(SHAFTS, listed):
        measured = modes(shaft(steps, 206e9 * factor, ratio), 14)
        for count in (4, 9):
            kept = likeness(measured[:count], computed)
            assert kept.sentence == "", (steps, count, kept)
            # frequencies go with the root
            assert math.exp(2 * kept.shift) == pytest.approx(factor, rel=0.05)


def test_few_pairs_that_scatter_show_nothing_either_way():
    few = Likeness(3, 3, 0.0, 1.5 * SAME_PART)
    assert not few.scattered and few.sentence.startswith("Too few pairs to show")
    many = Likeness(12, 12, 0.0, 1.5 * SAME_PART)
    assert many.scattered and many.sentence.startswith("This may be another part")
    none = Likeness(4, 0, 0.0, 0.0)
    assert none.sentence == "This may be another part: none of 4 resonances has a mode."


@pytest.mark.long
def test_sentences_open_with_the_doubt(tmp_path):
    peaks = Measured(
        mode=[{"frequency": mode.frequency_hz} for mode in modes(shaft(SHAFTS[1]))[:8]]
    )
    doubted = correlate(shaft(SHAFTS[0]), peaks, 5e-2)
    assert doubted.sentences[0].startswith("This may be another part: ")
    assert doubted.sentences[1].endswith("if they are of this part.")
    assert doubted.results["other_part"]["in_question"]
    assert not any("a wrong modulus, density or length" in said for said in doubted.sentences)
    path = tmp_path / "shaft.toml"
    path.write_text(file_of(SHAFTS[0]))
    assert identify(path, peaks, ["material.E"], tol=5e-2).likeness.scattered
