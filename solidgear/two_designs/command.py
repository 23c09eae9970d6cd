"""Two files of a kind in the command compare: two trains, or two shafts."""

from __future__ import annotations

import json
import os
from functools import partial
from pathlib import Path

from solidgear.core import SolidgearError
from solidgear.show.command import Progress, say
from solidgear.show.options import MODEL, Shown, refuse
from solidgear.show.remarks import load
from solidgear.show.sheet import Sheet, present
from solidgear.show.units import units_named
from solidgear.trains.options import Pair
from solidgear.two_designs.study import are_trains, beside
from solidgear.two_designs.two_shafts import TwoShafts
from solidgear.two_designs.two_trains import TwoTrains

#: where options of one shaft lead
TRAINS = "for two trains --pinion, --gear and --shaft choose the models"


def compare_two(
    files: list[Path],
    out: Path,
    pinion: str | None,
    gear: str | None,
    shafts: list[str] | None,
    mesh: str | None,
    tol: float | None,
    case: str | int | None,
    run: Shown,
    options: dict[str, bool],
    of_trains: dict[str, bool],
) -> None:
    """Compare two trains or two shafts; `options` and `of_trains` say which options of one shaft
    and of trains were given.
    """
    trains = _are_trains(files, options, of_trains)
    if trains:
        refuse({"--case": case is not None}, "shafts, and both files are trains")
    a, b = map(str, files)
    if a == b or (os.path.exists(a) and os.path.exists(b) and os.path.samefile(a, b)):
        same = f"{a} is given twice" if a == b else f"{a} and {b} are one file"
        sentence = f"{same}: nothing differs, so nothing was solved."
        kind = TwoTrains.kind if trains else TwoShafts.kind
        data = {"kind": kind, "differences": [], "sentences": [sentence]}
        say(json.dumps(data) if run.as_json else sentence)
        return

    mix, read = Pair(pinion or MODEL, gear or MODEL, shafts), partial(load, case=case)

    def study(progress: Progress) -> Sheet:
        first, second = files
        pair = beside(first, second, mix.models, mesh=mesh, tol=tol, progress=progress, read=read)
        progress("report")
        return pair.sheet(units_named(run.units))

    present(study, run, out)


def _are_trains(files: list[Path], options: dict[str, bool], of_trains: dict[str, bool]) -> bool:
    """Return whether two files are trains; refuse other files, and options of the other kind."""
    if len(files) > 2:
        raise SolidgearError(
            f"compare takes one file, or two scenes or two trains; {len(files)} are given"
        )
    a, b = files
    if are_trains(a, b):
        refuse(options, f"one shaft, and {a} is a train: {TRAINS}")
        return True
    for option, is_given in (options | of_trains).items():
        if is_given:
            raise SolidgearError(
                f"{option} does not apply to two shafts: both are solved as by answer, to a tenth "
                "of their tolerance"
            )
    return False
