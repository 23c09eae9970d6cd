"""Do the bars of models with features hold, and is what they call valid within the tolerance?"""

from __future__ import annotations

import argparse
import itertools
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import solidgear as sg
from solidgear.core.judge.quantities import JUDGED, size
from solidgear.core.judge.study import study
from solidgear.core.judge.ties import SCENE
from solidgear.core.ladder.registry import LADDER
from validation.campaign.case import Case, Run
from validation.campaign.rows import (
    DECIDED,
    FALSE_VALID,
    Cost,
    Found,
    Row,
    Verdict,
    sorted_verdict,
    within,
)
from validation.campaign.scenes.parts import SORTS, draw
from validation.campaign.truths.features import PAIR, Numbers, numbers, truth

#: meshes of each model that are judged: one after the other, as a user would come to them
MESHES = {"corrected": 3, "sector": 3, "solid": 3}
#: unknowns of the last mesh of a model above which it is left out
HEAVY = {"corrected": 18_500, "sector": 170_000, "solid": 10_000}
#: tolerances at which a model is called valid
TOLERANCES = (1e-3, 3e-3, 1e-2, 3e-2)


class Features(Case):
    """Models of parts with features on their first meshes, against finer meshes of another kind."""

    name, question = "features", "bars and verdicts of models with features"
    parts, details = ((), ("model",)), (("part", "model"),)
    seeds = (1, 20)
    seconds = 1800.0
    tag_of_costs = "model"

    def options(self, parser: argparse.ArgumentParser) -> None:
        parser.add_argument("--sort", choices=SORTS)
        parser.add_argument("--parts", type=int, help="from the first seed on, instead of the last")

    def bodies(self, given: argparse.Namespace) -> list[tuple[int]]:
        first, last = given.seeds
        seeds = range(first, last + 1) if given.parts is None else itertools.count(first)
        fit_for_this = ((seed,) for seed in seeds if _light(draw(seed, given.sort).text))
        return list(itertools.islice(fit_for_this, given.parts))

    def asked(self, given: argparse.Namespace) -> str:
        if given.parts is None:
            return super().asked(given)
        sort = f" of sort {given.sort}" if given.sort else ""
        return f"{given.parts} parts{sort} from seed {given.seeds[0]} on"

    def judge(self, run: Run, seed: int) -> Found:
        drawn = draw(seed, run.given.sort)
        scene = loaded(drawn.text)
        kept = run.folder / "features"
        kept.mkdir(parents=True, exist_ok=True)
        true, problem = run.call(truth, scene, drawn.text, kept)
        if problem:
            return Found(problems=[f"{seed}, {drawn.words}: no reference: {problem}"])
        body = f"{seed} {drawn.words} ({max(map(abs, true.effect.values())):.1%})"
        out = Found()
        for model in fit(scene):
            if heavy(scene, model):
                out.problems.append(f"{body}: {model} left out, too large")
                continue
            for place in range(MESHES[model]):
                mesh, problem = run.call(solved, scene, model, place)
                if problem:
                    out.problems.append(f"{body}: {model} {place + 1} left out: {problem}")
                    continue
                label = f"{model} {place + 1}"
                out.costs.append(Cost(body, {"model": label}, mesh.seconds))
                judged(out, label, mesh, true, body)
        return out


@dataclass(frozen=True)
class Mesh:
    """Numbers of a model on one mesh."""

    numbers: dict[str, float]  #: with the first bending pair by plane or by frequency
    bars: dict[str, float]
    split: bool  #: whether "bending 2" is the second of the first pair
    seconds: float  #: of processor time


def loaded(text: str) -> sg.Scene:
    """The scene of a file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part.toml"
        path.write_text(text)
        return sg.load(path)


def fit(scene: sg.Scene) -> list[str]:
    """Models of a part with features that have bars of their own."""
    out = [n for n in MESHES if not LADDER[n].unfit(scene) and n in LADDER.fit(scene)]
    # all copies of a sector are the same numbers as one of them
    return [n for n in out if n != "solid" or "sector" not in out]


def heavy(scene: sg.Scene, model: str) -> bool:
    """The last mesh of a model takes more time than there is."""
    last = dict(LADDER[model].meshes(_options(model)).levels[MESHES[model] - 1])
    return LADDER[model].size(scene, last).unknowns > HEAVY[model]


def _light(text: str) -> bool:
    """A part fits together and can be meshed, and a model with bars for its features is not too
    large.
    """
    try:
        scene = loaded(text)
        return any(n != "solid" and not heavy(scene, n) for n in fit(scene))
    except sg.SolidgearError:  # of the file, or of a mesh that cannot be made
        return False


def _options(model: str) -> dict:
    return {"element": "tet10"} if model == "solid" else {}


def solved(scene: sg.Scene, model: str, place: int) -> Mesh:
    """A model on one mesh of its list, with the bars of that mesh."""
    start = time.process_time()
    options = _options(model)
    level = LADDER[model].meshes(options).levels[place]
    one = study(scene, model, {**options, **level}, evidence=False, counted=False)
    bars = {str(q): bar.width for q, bar in one.error_bars[SCENE].items()}
    split = "bending z 1" not in {m.name for m in one.modes.modes}
    return Mesh(numbers(one.ties[SCENE]), bars, split, time.process_time() - start)


def judged(out: Found, label: str, mesh: Mesh, true: Numbers, body: str) -> None:
    """Hold the bars of a mesh, and what is valid by them, against the truth."""
    bars = mesh.bars
    own, tags = mesh.numbers, {"model": label, "part": body}
    errors = {q: (own[q] - v) / size(true.values, q) for q, v in true.values.items() if q in own}
    split = "bending 2" in bars and mesh.split
    called = {"pair 1": "bending 1", **({"pair 2": "bending 2"} if split else {})}
    for q, error in errors.items():
        bar = bars.get(called.get(q, q))
        if bar is not None and q != PAIR[1]:
            told = {"how": "finer meshes", "rule": DECIDED}
            out.rows.append(Row(body, q, tags, bar, error, true.doubt[q], **told))
    names = {q: "pair 1" if q == "bending 1" else q for q in JUDGED}
    asked = {q: n for q, n in names.items() if n in errors}
    if not asked or any(q not in bars for q in asked):
        return
    found = {n: (errors[n], true.doubt[n]) for n in asked.values()}
    for tolerance in TOLERANCES:
        valid = all(bars[q] <= tolerance for q in asked)
        sort = sorted_verdict(valid, within(found, tolerance))
        why = "a bar is within the tolerance, its error is not" if sort == FALSE_VALID else ""
        out.verdicts.append(Verdict(body, label, tolerance, sort, why))
