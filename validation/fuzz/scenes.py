"""Scene files spoilt at random: each is refused or leads to finite numbers, by the library and by
the command line alike.
"""

from __future__ import annotations

import functools
import json
import random
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from solidgear.core.ladder import build
from solidgear.core.loading import load
from solidgear.core.solve.modes import modes
from solidgear.core.solve.statics import condense
from solidgear.guards.check import check_scene
from validation.fuzz.case import Case, Finding, Fuzz, Refused, refusing
from validation.fuzz.commands import ran
from validation.fuzz.spoiling import spoilt

FILE = "spoilt.toml"
#: a beam, and a light solid of revolution
MODELS = (("euler", {}), ("harmonic", {"order": 2, "layers": 1}))


def scene(dice: random.Random, harmonic: float = 0.05, command: float = 0.05) -> Case:
    """A spoilt scene; a share of them also by the harmonic solid with `check`, or by commands."""
    what, text = spoilt(dice)
    harmonic, command = dice.random() < harmonic, dice.random() < command
    return Case(what, {FILE: text}, functools.partial(used, harmonic=harmonic, command=command))


def used(folder: Path, harmonic: bool = False, command: bool = False) -> Iterator[str]:
    """Load the file and put the scene to use, and do the same by commands."""
    refusal = None
    try:
        yield from by_library(folder / FILE, harmonic)
    except Refused as error:
        refusal = error
    if command:
        yield "command"
        by_command(folder, refusal)
    if refusal:
        raise refusal


def by_library(path: Path, harmonic: bool = False) -> Iterator[str]:
    """The scene, and 6x6 and modes of the beam; on request the check and the solid too."""
    yield "load"
    with refusing((path.name,), reading=True):
        scene = load(path)
    for fidelity, options in MODELS[: 1 + harmonic]:
        yield fidelity
        with refusing(()):
            body = build(scene, fidelity, **options)
            found = condense(body, scene, scene.port.name)
            values = modes(body, scene, n=scene.ask.modes).frequency_hz
            checked = check_scene(scene, body).as_dict() if harmonic else None
        if not (np.isfinite(found.stiffness).all() and np.isfinite(values).all()):
            raise Finding("a result is not finite")
        record = {"scene": scene.as_dict(), "check": checked, "frequencies": values.tolist()}
        json.dumps(record, allow_nan=False)


def by_command(folder: Path, refusal: Refused | None) -> None:
    """`stiffness --json` and, for what is refused, `compare --out` say what the library says."""
    runs = [["stiffness", FILE, "-f", "euler", "--json"]]
    if refusal:
        runs.append(["compare", FILE, "--models", "euler", "--no-renders", "--out", "out"])
    for arguments in runs:
        try:
            ran(arguments, folder)
        except Refused as error:
            if not refusal:
                raise Finding(
                    f"accepted by the library, refused by {arguments[0]}: {error}"
                ) from None
        else:
            if refusal:
                raise Finding(f"refused by the library, accepted by {arguments[0]}: {refusal}")


SCENES = Fuzz("scenes", scene, share=0.57)
