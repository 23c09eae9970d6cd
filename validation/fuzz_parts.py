"""Broken STEP and mesh files: each ends in one sentence or in a sound part, none in a crash or a hang.

    python -m validation.fuzz_parts --cases 500 --seed 1

Files are cut off, garbled byte by byte and number by number, mirrored, rescaled, opened and
emptied; what is not refused must have the volume that its segments and its mesh agree on. Of decks,
lines of elements and nodes are lost, cut off and doubled: such a file must be refused with the line,
or `check` must tell what is odd about it.
"""

from __future__ import annotations

import argparse
import random
import re
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import meshio
import numpy as np

import solidgear as sg
from solidgear.meshing.tetrahedra import tetrahedra
from validation.fuzz_decks import DECK_CHANGES, DECKS
from validation.mesh_files import write_mesh
from validation.shipped import GEOMETRY

SCENE = GEOMETRY / "shaft_step.toml"
#: longest that one file may take, s
HANG = 30.0
#: the longest sentence
LONG = 600


class Outcome(NamedTuple):
    """What became of one file."""

    kind: str
    refused: bool
    sentence: str
    seconds: float
    fault: str = ""
    told: bool = False

    @property
    def became(self) -> str:
        """What became of it in a word."""
        return "refused" if self.refused else "told" if self.told else "taken"


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
    last = 400
    return re.sub(
        r"#(\d+)(?= *[,)])",
        lambda m: m[0] if dice.random() > 0.01 else f"#{dice.randrange(1, last)}",
        text,
    )


def emptied(text: str, dice: random.Random) -> str:
    """Nothing, or next to nothing."""
    head = text.split("DATA;")[0]
    return dice.choice(("", "\0" * 1000, head, f"{head}DATA;\nENDSEC;\nEND-ISO-10303-21;\n"))


def mirrored(text: str, dice: random.Random) -> str:
    """Coordinates of nodes along x of the other sign: a left-handed mesh, if it is one."""

    def flipped(match: re.Match) -> str:
        return match[1] + ("" if match[2].startswith("-") else "-") + match[2].lstrip("-")

    return re.sub(
        r"(?m)^(\d+, *)(-?[\d.]+(?:e[+-]\d+)?)(?=, *-?[\d.]+(?:e[+-]\d+)?, *-)", flipped, text
    )


Change = Callable[[str, random.Random], str]
#: changes of decks after which something must be said
MUST_SPEAK = frozenset(change.__name__ for change in DECK_CHANGES)
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


def sound_files(folder: Path) -> dict[str, str]:
    """Text of the sound files that broken ones are made of, by their ending."""
    scene = sg.load(SCENE)
    mesh = tetrahedra(scene.segments, size=0.012).mesh
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


def attacked(folder: Path, ending: str, text: str, kind: str) -> Outcome:
    """Read one file as a scene's part."""
    path = folder / f"part.{ending}"
    path.write_text(text)
    words = SCENE.read_text().replace(
        'step = "shaft_step.step"', f'{"step" if ending == "step" else "mesh"} = "{path.name}"'
    )
    words = re.sub(r"(?m)^(size_check|mass_check).*$", "", words)
    scene = folder / "scene.toml"
    scene.write_text(words)
    start, sentence, fault, refused = time.perf_counter(), "", "", False
    told = False
    try:
        found = sg.load(scene)
        body = found.body
        assert body is not None  # its table is there
        if not (0 < body.volume < 1 and np.isfinite(body.round_volume)):
            fault = f"a part of {body.volume} m^3 went through"
        told, sentence = bool(body.remarks), "; ".join(body.remarks)
        if kind in MUST_SPEAK and not told:
            fault = "went through in silence"
    except sg.SolidgearError as error:
        refused, sentence = True, str(error)
        if len(sentence) > LONG * 3 or "Traceback" in sentence:
            fault = "no sentence"
        if kind in MUST_SPEAK and "line " not in sentence and "node " not in sentence:
            fault = fault or "no line is named"
    except Exception as error:  # that is what is looked for
        fault = f"{type(error).__name__}: {error}"
    seconds = time.perf_counter() - start
    if seconds > HANG:
        fault = fault or f"took {seconds:.0f} s"
    return Outcome(f"{ending} {kind}", refused, sentence, seconds, fault, told)


def campaign(cases: int, seed: int, folder: Path, endings: tuple[str, ...] = (), changes=CHANGES):
    """Outcomes of some cases, one after another.

    Parameters
    ----------
    cases, seed : int
    folder : Path
        For the files.
    endings : tuple of str, optional
        Only those; by default half of the cases are STEP files.
    changes : tuple of callable, optional
        Only those, and of decks those of their lines.

    Yields
    ------
    Outcome
    """
    dice = random.Random(seed)
    sound = sound_files(folder)
    for _ in range(cases):
        meshes = tuple(e for e in sound if e != "step")
        ending = dice.choice(endings or ("step",) * len(meshes) + meshes)
        text = sound[ending]
        possible = (*changes, *(DECK_CHANGES if ending in DECKS else ()))
        while text == sound[ending]:  # not every change is one of every file
            change = dice.choice(possible)
            text = change(sound[ending], dice)
        yield attacked(folder, ending, text, change.__name__)


def main() -> None:
    """Run a campaign and print what came of it."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--decks", action="store_true", help="only lines of decks")
    parser.add_argument("--words", action="store_true", help="print every sentence")
    given = parser.parse_args()
    counts: Counter = Counter()
    faults, slowest = [], 0.0
    with tempfile.TemporaryDirectory() as folder:
        only = (DECKS, ()) if given.decks else ((), CHANGES)
        for k, one in enumerate(campaign(given.cases, given.seed, Path(folder), *only)):
            counts[one.kind, one.became] += 1
            slowest = max(slowest, one.seconds)
            if one.fault:
                faults.append((k, one))
                print(f"FAULT {k} {one.kind}: {one.fault}", flush=True)
            if given.words:
                print(
                    f"{k} {one.kind} {one.seconds:.1f} s: {one.became}: {one.sentence}", flush=True
                )
    for (kind, what), n in sorted(counts.items()):
        print(f"{n:4d} {kind}: {what}")
    became = Counter({what: 0 for what in ("refused", "told", "taken")})
    for (_, what), n in counts.items():
        became[what] += n
    print(", ".join(f"{n} {what}" for what, n in became.items()))
    print(f"{given.cases} cases, {len(faults)} faults, the slowest took {slowest:.1f} s")


if __name__ == "__main__":
    main()
