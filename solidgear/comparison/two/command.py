"""Two files of a kind in the command compare: two trains, or two shafts."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from functools import partial
from pathlib import Path

from solidgear.comparison.two.differences import differences
from solidgear.comparison.two.two_shafts import TwoShafts, two_shafts
from solidgear.comparison.two.two_trains import TwoTrains, two_trains
from solidgear.core import SolidgearError, is_train
from solidgear.show.command import Progress, say
from solidgear.show.options import Shown, refuse
from solidgear.show.remarks import load
from solidgear.show.sheet import Sheet, present
from solidgear.show.units import units_named
from solidgear.trains.assembly.shaft import checked_model
from solidgear.trains.options import Pair, Reduced

#: where options of one shaft lead
TRAINS = "for two trains --pinion, --gear and --shaft choose the models"


def compare_two(
    files: list[Path],
    out: Path,
    mix: Pair,
    reduced: Reduced,
    mesh: str | None,
    run: Shown,
    options: dict[str, bool],
    of_trains: dict[str, bool],
) -> None:
    """Compare two trains or two shafts; `options` and `of_trains` say which options of one shaft
    and of trains were given.
    """
    trains = _are_trains(files, options, of_trains)
    a, b = map(str, files)
    if a == b or (os.path.exists(a) and os.path.exists(b) and os.path.samefile(a, b)):
        same = f"{a} is given twice" if a == b else f"{a} and {b} are one file"
        sentence = f"{same}: nothing differs, so nothing was solved."
        kind = TwoTrains.kind if trains else TwoShafts.kind
        data = {"kind": kind, "differences": [], "sentences": [sentence]}
        say(json.dumps(data) if run.as_json else sentence)
        return
    solve: Callable[..., TwoTrains | TwoShafts]
    if trains:
        assemblies = [reduced.assembly(path) for path in files]
        models = mix.by_shaft(assemblies[0].train).values()
        for model in models:
            checked_model(model)
        solve = partial(two_trains, assemblies, _names(a, b), differences(a, b), *models, mesh=mesh)
    else:
        solve = partial(two_shafts, [load(path) for path in files], _names(a, b), differences(a, b))

    def study(progress: Progress) -> Sheet:
        pair = solve(progress=progress)
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
    trains = is_train(a), is_train(b)
    if trains[0] != trains[1]:
        train, shaft = (a, b) if trains[0] else (b, a)
        raise SolidgearError(
            f"{train} is a train and {shaft} one shaft: compare two trains, two shafts, or either "
            "file alone"
        )
    if trains[0]:
        refuse(options, f"one shaft, and {a} is a train: {TRAINS}")
        return True
    for option, is_given in (options | of_trains).items():
        if is_given:
            raise SolidgearError(
                f"{option} does not apply to two shafts: both are solved as by answer, to a tenth "
                "of their tolerance"
            )
    return False


def _names(a: str, b: str) -> tuple[str, str]:
    """Return names of two files: those without folder and ending, unless they are the same."""
    short = Path(a).stem, Path(b).stem
    return short if short[0] != short[1] else (a, b)
