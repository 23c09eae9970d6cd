"""Scene files and command lines spoilt at random: refused in plain sentences or answered, never a
traceback, a hang or half an output.
"""

import os
import subprocess
import sys
import warnings
from collections import Counter
from functools import partial
from pathlib import Path

import pytest

from solidgear.core.errors import SceneError, SolidgearError
from solidgear.core.machine.isolated import isolated
from solidgear.core.scene import Bearing, Material, Port, Scene, Segment
from solidgear.core.scene.file import load

ROOT = Path(__file__).parents[1]
GOOD = (ROOT / "geometry" / "pinion_overhung.toml").read_text(encoding="utf-8")

pytestmark = pytest.mark.skipif(
    sys.platform == "win32", reason="the watchdog of the fuzz needs POSIX signals"
)


@pytest.fixture(scope="module")
def fuzz():
    """The kinds of input, and the rooms they are made and judged in."""
    from validation.fuzz import case, commands, scenes

    return case, commands, scenes


def nothing_found(case, kind, cases, seed=1):
    """Counts of outcomes by stage, and of sorts of refusals.

    In a process of its own: what spoilt input does to one, and limits that are set on it, end no
    other test.
    """
    outcomes = isolated(case.run, kind, cases, seed, seconds=200, memory_mb=1e6)
    found = [outcome.told() for outcome in outcomes if outcome.kind == "finding"]
    assert not found, "\n".join(found)
    stages = Counter((outcome.kind, outcome.stage) for outcome in outcomes)
    return stages, {outcome.detail for outcome in outcomes if outcome.kind == "refused"}


@pytest.mark.long
def test_spoilt_scenes_are_refused_or_solved(fuzz):
    case, _, scenes = fuzz
    cases, kind = 20, case.Fuzz("scenes", partial(scenes.scene, harmonic=0.7, command=0.35))
    stages, sorts = nothing_found(case, kind, cases)
    # a fuzz that never gets past the parser, or never meets a refusal, tests nothing
    accepted = {stage: n for (kind, stage), n in stages.items() if kind == "accepted"}
    assert sum(accepted.values()) >= cases // 10 and {"harmonic", "command"} <= set(accepted)
    assert len(sorts) > cases // 7


@pytest.mark.long
def test_command_lines_are_refused_or_answered(fuzz):
    case, commands, _ = fuzz
    cases = 6
    stages, sorts = nothing_found(case, commands.COMMAND_LINES, cases)
    assert sum(n for (kind, _), n in stages.items() if kind == "accepted") > cases // 7
    assert len({stage for _, stage in stages}) > cases // 10 and len(sorts) > cases // 4


@pytest.mark.slow
def test_hundreds_of_files_and_command_lines(fuzz):
    # ten thousand take a quarter of an hour: `python -m validation.fuzz --cases 10000`
    case, commands, scenes = fuzz
    nothing_found(case, scenes.SCENES, 150)
    nothing_found(case, commands.COMMAND_LINES, 100)


def test_a_case_follows_from_its_number(fuzz):
    _, commands, scenes = fuzz
    for kind in (commands.COMMAND_LINES, scenes.SCENES):
        one, same, other = (kind.case(3, number) for number in (14, 14, 15))
        assert (one.what, one.files) == (same.what, same.files)
        assert (one.what, one.files) != (other.what, other.files)


# ------------------------------------------------------------------------------------------------- the fuzz itself sees
def raising(error):
    def broken(path):
        raise error

    return broken


def test_what_reserves_address_space_is_within_the_limits(fuzz):
    """Memory that is used is limited, and room that is only reserved is not."""
    code = """
import mmap
from validation.fuzz.limits import Limits
with Limits(room=1 << 30).watched():
    print(len(mmap.mmap(-1, 8 << 30, prot=mmap.PROT_READ)) >> 30)
    try:
        bytearray(2 << 30)
    except MemoryError:
        print("limited")
"""
    how = {"env": {**os.environ, "PYTHONPATH": str(ROOT)}, "timeout": 120}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, **how)
    assert (done.stdout.split(), done.returncode) == (["8", "limited"], 0), done.stderr


@pytest.mark.parametrize(
    "broken, says",
    [
        (raising(ZeroDivisionError()), "ZeroDivisionError"),
        (lambda path: [n for n in iter(int, 1)], "processor time"),
        (lambda path: warnings.warn("overflow", RuntimeWarning, stacklevel=1), "RuntimeWarning"),
        (raising(SceneError("two\u2028lines", where="spoilt.toml")), ""),
        (raising(SceneError("of no file")), "does not name the file"),
        (raising(SolidgearError("spoilt.toml rings \x07 the bell")), "not fit for a terminal"),
    ],
)
def test_what_the_fuzz_calls_a_finding(fuzz, broken, says, monkeypatch):
    case, _, scenes = fuzz
    monkeypatch.setattr(scenes, "load", broken)
    kind = case.Fuzz("scenes", scenes.scene, limits=case.Limits(cpu=0.2))
    outcome = case.one(kind, case.Case("broken", {}, scenes.used))
    # the message of an error is made one line on purpose, whatever it quotes
    assert outcome.kind == ("finding" if says else "refused")
    assert says in outcome.sentence


def leaves(name, text):
    return lambda: Path(name).write_text(text)


def prints_a_traceback():
    print("Traceback (most recent call last):", file=sys.stderr)
    sys.exit(1)


@pytest.mark.parametrize(
    "main",
    [
        None,
        leaves("left.json", "{"),
        leaves("left.csv", "a,b\n1,2\n3"),
        lambda: Path("out").mkdir(),
        lambda: print('{"stiffness": ['),
        lambda: print('{"stiffness": NaN}'),
        lambda: sys.exit(2),
        prints_a_traceback,
        lambda: None,
    ],
    ids=[
        "the program itself",
        "half a file",
        "torn table",
        "empty folder",
        "half an answer",
        "no number",
    ]
    + ["another code", "traceback", "nothing said"],
)
def test_what_the_fuzz_calls_a_bad_command(fuzz, main, monkeypatch):
    import solidgear.app

    case, _, scenes = fuzz

    def use(folder):
        yield "command"
        scenes.by_command(folder, None)

    good = case.Case("good", {scenes.FILE: GOOD.encode()}, use)
    if main:
        monkeypatch.setattr(solidgear.app, "main", main)
    assert case.one(scenes.SCENES, good).kind == ("finding" if main else "accepted")


# ------------------------------------------------------------------------------------------------- what it found
def test_both_ends_of_a_cone_are_named_as_in_the_file(tmp_path):
    text = GOOD.replace(
        'kind = "cylinder"\nname = "shaft"', 'kind = "cone"\nname = "shaft"'
    ).replace('diameter = "90 mm"', 'start_diameter = "90 mm"\nend_diameter = "1 um"')
    path = tmp_path / "spoilt.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(
        SceneError,
        match=r'segment\[2\] "shaft".end_diameter = "1 um": a diameter of 1e-06 m is under a thousandth',
    ):
        load(path)


def test_scenes_made_in_python_are_refused_alike():
    rod = Segment.cylinder("rod", length=0.3, diameter=0.06)
    with pytest.raises(
        SceneError, match="stiffness in thz is 1e-40, below 1e-30 in SI, too soft for a spring"
    ):
        Bearing(name="1", y=0.1, seat_width=0.01, stiffness={"kxx": 1e8, "kthz": 1e-40})
    with pytest.raises(SceneError, match="below 1 Pa"):
        Material(E=1e-3, nu=0.3, density=7850)
    with pytest.raises(SceneError, match="port.hi.*under a millionth"):
        Scene.from_parts([rod], port=Port(y=0.1, lo=0.1, hi=0.1 + 1e-8))
