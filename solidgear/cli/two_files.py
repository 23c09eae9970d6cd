"""The command compare on two files."""

from __future__ import annotations

import json
import os
from pathlib import Path

from solidgear.cli.app import caution, say
from solidgear.cli.reading import load
from solidgear.cli.shared import MODEL, Shown
from solidgear.cli.train_options import Reduced, refuse_given
from solidgear.errors import SolidgearError
from solidgear.report import beside_tables, two_trains_tables
from solidgear.report.folder import held
from solidgear.report.two_shafts_page import numbers, write_two_shafts
from solidgear.report.two_trains_page import write_two_trains
from solidgear.report.units import in_ascii, units_named
from solidgear.scene.differences import differences
from solidgear.scene.toml_file import is_train
from solidgear.studies import two_shafts_told
from solidgear.studies.beside import same_file
from solidgear.studies.train import two_trains_told
from solidgear.studies.train.shaft import checked_rung
from solidgear.studies.train.two_trains import two_trains
from solidgear.studies.two_shafts import two_shafts

#: where options of one shaft lead
TRAINS = "of two trains --pinion and --gear choose the models"


def compare_two(
    files: list[Path],
    out: Path,
    models: tuple[str | None, str | None],
    run: Shown,
    given: dict[str, bool],
) -> None:
    """Two trains beside each other, or two shafts.

    Parameters
    ----------
    files : list of Path
        Two; more are refused.
    models : (str or None, str or None)
        Of pinion and gear of both trains; of two shafts none.
    given : dict of str to bool
        Options of compare that speak of one shaft, and whether they were given.

    Raises
    ------
    SolidgearError
        For more than two files, files of different kinds, or an option that does not apply.
    """
    if len(files) > 2:
        raise SolidgearError(f"compare takes one file, or two of a kind; {len(files)} are given")
    a, b = map(str, files)
    trains = is_train(a), is_train(b)
    if trains[0] != trains[1]:
        one, other = (a, b) if trains[0] else (b, a)
        raise SolidgearError(
            f"{one} is a train and {other} one shaft: compare takes two trains, two shafts, or either file alone"
        )
    if trains[0]:
        refuse_given(given, files[0], TRAINS)
    else:
        _refuse_of_two_shafts(given | {"--pinion": bool(models[0]), "--gear": bool(models[1])})
    if a == b or (os.path.exists(a) and os.path.exists(b) and os.path.samefile(a, b)):
        _say_same(a, b, "two trains" if trains[0] else "two shafts", run)
    elif trains[0]:
        _two_trains(a, b, out, (models[0] or MODEL, models[1] or MODEL), run)
    else:
        _two_shafts(a, b, out, run)


def _refuse_of_two_shafts(given: dict[str, bool]) -> None:
    for option in (option for option, there in given.items() if there):
        raise SolidgearError(
            f"{option} does not apply to two shafts: both are solved by the model that the judge "
            "chooses, to bars of a tenth of their tolerance"
        )


def _say_same(a: str, b: str, kind: str, run: Shown) -> None:
    sentence = same_file(a, b)
    if run.as_json:
        print(json.dumps({"kind": kind, "differences": [], "sentences": [sentence]}))
    else:
        say(sentence)


def _two_trains(a: str, b: str, out: Path, models: tuple[str, str], run: Shown) -> None:
    for model in models:
        checked_rung(model)
    shops = [Reduced().workshop(Path(path)) for path in (a, b)]
    shown, names = units_named(run.units), _names(a, b)
    with held(out), run.progress() as progress:
        found = two_trains(shops, names, differences(a, b), *models, progress=progress)
        told, words = two_trains_told.results(found), two_trains_told.sentences(found, shown)
        progress("report")
        write_two_trains(found, told, words, out, shown)
    if run.as_json:
        print(json.dumps(told, allow_nan=False))
        return
    say(
        *(f"{one.label}, {one.workshop.train.called}" for one in found.both),
        beside_tables.inputs(found, beside_tables.SHORT),
        beside_tables.modes(found),
        two_trains_tables.peaks(found, shown),
        *map(in_ascii, words),
        *told["unpublished_lines"],
        *map(caution, found.cautions),
        f"Report: {out / 'report.html'}",
        soft_wrap=False,
    )


def _two_shafts(a: str, b: str, out: Path, run: Shown) -> None:
    scenes = [load(Path(path)) for path in (a, b)]
    shown = units_named(run.units)
    with held(out), run.progress() as progress:
        found = two_shafts(scenes, _names(a, b), differences(a, b), progress)
        told, words = two_shafts_told.results(found), two_shafts_told.sentences(found, shown)
        progress("report")
        write_two_shafts(found, told, words, out, shown)
    if run.as_json:
        print(json.dumps(told, allow_nan=False))
        return
    say(
        *(f"{one.label}, {one.scene.title or one.scene.name}" for one in found.both),
        *map(in_ascii, words),
        beside_tables.inputs(found, beside_tables.SHORT),
        numbers(found, shown),
        beside_tables.modes(found),
        *map(caution, found.cautions),
        f"Report: {out / 'report.html'}",
        soft_wrap=False,
    )


def _names(a: str, b: str) -> tuple[str, str]:
    """Names of two files: those without folder and ending, unless they are the same."""
    short = Path(a).stem, Path(b).stem
    return short if short[0] != short[1] else (a, b)
