"""Broken STEP and mesh files: each is refused with a sentence or is a sound part.

Files are cut off, garbled byte by byte and number by number, mirrored, rescaled, opened and
emptied; what is not refused must have the volume that its segments and its mesh agree on. Of decks,
lines of elements and nodes are lost, cut off and doubled: such a file must be refused with the line,
or `check` must tell what is odd about it.
"""

from __future__ import annotations

import functools
import random
import re
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import meshio
import numpy as np

import solidgear as sg
from solidgear.core.meshing.tetrahedra import tetrahedra
from validation.fuzz.case import Case, Finding, Fuzz, Refused, refusing
from validation.fuzz.decks import DECK_CHANGES, DECKS
from validation.fuzz.limits import Limits
from validation.mesh_files import write_mesh
from validation.shipped import GEOMETRY

SCENE = GEOMETRY / "shaft_step.toml"
#: files are read in a process of their own: the wall counts
LIMITS = Limits(wall=30.0)

Change = Callable[[str, random.Random], str]

NUMBER = re.compile(r"-?\d+\.\d*(?:E[+-]?\d+)?")


def cut_off(text: str, dice: random.Random) -> str:
    """The beginning of a file."""
    return text[: dice.randrange(len(text))]


def cut_off_with_end(text: str, dice: random.Random) -> str:
    """The beginning of a file, closed as a whole one is."""
    return cut_off(text, dice) + "\nENDSEC;\nEND-ISO-10303-21;\n"


def garbled(text: str, dice: random.Random) -> str:
    """Some letters are others."""
    letters = list(text)
    for _ in range(dice.choice((1, 5, 50, 500))):
        letters[dice.randrange(len(letters))] = chr(dice.randrange(32, 127))
    return "".join(letters)


def other_numbers(text: str, dice: random.Random) -> str:
    """Some numbers are others."""
    share = dice.choice((1e-3, 1e-2, 0.1))
    odd = ("0.", "-1.", "1.E30", "-1.E-30", "NAN", "1.E400", "")

    def changed(match: re.Match) -> str:
        if dice.random() > share:
            return match[0]
        return dice.choice(odd) if dice.random() < 0.5 else str(dice.gauss(0, 30))

    return NUMBER.sub(changed, text)


def rescaled(text: str, dice: random.Random) -> str:
    """Every number is larger, or of another sign."""
    factor = dice.choice((1e-3, 1e3, 25.4, 1 / 25.4, -1.0, 0.0, 1e12))
    return NUMBER.sub(lambda m: repr(float(m[0]) * factor).upper(), text)


def lines_left_out(text: str, dice: random.Random) -> str:
    """Some entries are missing: open shells, references to nothing."""
    share = dice.choice((0.002, 0.02, 0.3))
    return "\n".join(line for line in text.splitlines() if dice.random() > share)


def mixed(text: str, dice: random.Random) -> str:
    """References name other entries."""

    def changed(match: re.Match) -> str:
        return match[0] if dice.random() > 0.01 else f"#{dice.randrange(1, 400)}"

    return re.sub(r"#(\d+)(?= *[,)])", changed, text)


def emptied(text: str, dice: random.Random) -> str:
    """Nothing, or next to nothing."""
    head = text.split("DATA;")[0]
    return dice.choice(("", "\0" * 1000, head, f"{head}DATA;\nENDSEC;\nEND-ISO-10303-21;\n"))


def mirrored(text: str, dice: random.Random) -> str:
    """Coordinates of nodes along x of the other sign: a left-handed mesh, if it is one."""

    def flipped(match: re.Match) -> str:
        return match[1] + ("" if match[2].startswith("-") else "-") + match[2].lstrip("-")

    number = r"-?[\d.]+(?:e[+-]\d+)?"
    return re.sub(rf"(?m)^(\d+, *)({number})(?=, *{number}, *-)", flipped, text)


#: those of files of any format
CHANGES: tuple[Change, ...] = (
    cut_off,
    cut_off_with_end,
    garbled,
    other_numbers,
    rescaled,
    lines_left_out,
    mixed,
    emptied,
    mirrored,
)


@functools.cache
def sound_files() -> dict[str, str]:
    """Text of the sound files that broken ones are made of, by their ending."""
    with tempfile.TemporaryDirectory() as folder:
        return _written(Path(folder))


def _written(folder: Path) -> dict[str, str]:
    scene = sg.load(SCENE)
    mesh = tetrahedra(scene.outline, size=0.012).mesh
    # nodes of second order are left out
    used, numbered = np.unique(mesh.t, return_inverse=True)
    corners = numbered.reshape(4, -1).T
    cells = [("tetra", corners)]
    left = np.flatnonzero(mesh.p[1][mesh.t].mean(axis=0) < 0.09)
    right = np.setdiff1d(np.arange(mesh.t.shape[1]), left)
    points = np.round(1e3 * mesh.p[:, used].T, 6) + 0.0
    out = {"step": SCENE.with_suffix(".step").read_text()}
    for ending, more in (
        ("msh", {"file_format": "gmsh22", "binary": False}),
        ("vtu", {"binary": False}),
    ):
        path = folder / f"sound.{ending}"
        meshio.write(path, meshio.Mesh(points, cells), **more)
        out[ending] = path.read_text()
    for ending in DECKS:
        path = folder / f"sound.{ending}"
        write_mesh(path, points, "tetra", corners, {"left": left, "right": right})
        out[ending] = path.read_text()
    return out


def broken(dice: random.Random, endings: tuple[str, ...], changes: tuple[Change, ...]) -> Case:
    """A file of one of some endings, changed in one of some ways, as the part of a scene."""
    ending = dice.choice(endings)
    text = sound = sound_files()[ending]
    while text == sound:  # not every change is one of every file
        change = dice.choice(changes)
        text = change(sound, dice)
    part = f"part.{ending}"
    table = f'{"step" if ending == "step" else "mesh"} = "{part}"'
    scene = SCENE.read_text().replace('step = "shaft_step.step"', table)
    scene = re.sub(r"(?m)^(size_check|mass_check).*$", "", scene)
    files = {part: text.encode(), "scene.toml": scene.encode()}
    use = functools.partial(used, part=part, must_speak=change in DECK_CHANGES)
    return Case(f"{ending} {change.__name__}", files, use)


def used(folder: Path, part: str, must_speak: bool) -> Iterator[str]:
    """Read the scene; a change after which something must be said has to be told with its line."""
    yield "load"
    try:
        with refusing((part, "scene.toml"), reading=True):
            body = sg.load(folder / "scene.toml").body
    except Refused as refusal:
        if must_speak and not re.search("line |node ", str(refusal)):
            raise Finding(f"no line is named: {refusal}") from refusal
        raise
    assert body is not None  # its table is there
    if not (0 < body.volume < 1 and np.isfinite(body.round_volume)):
        raise Finding(f"a part of {body.volume} m^3 went through")
    if body.remarks:
        yield "told"
    elif must_speak:
        raise Finding("went through in silence")


#: half of them STEP files
PARTS = Fuzz(
    "parts",
    functools.partial(broken, endings=("step",) * 5 + ("msh", "vtu", *DECKS), changes=CHANGES),
    share=0.04,
    limits=LIMITS,
)
LINES_OF_DECKS = Fuzz(
    "decks",
    functools.partial(broken, endings=DECKS, changes=DECK_CHANGES),
    share=0.01,
    limits=LIMITS,
)
