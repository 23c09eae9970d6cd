"""Are valid models valid, do their bars hold? Random shafts through `compare` and `check`."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from functools import partial
from typing import Any

from solidgear.comparison.models import compare
from solidgear.core.judge.quantities import JUDGED, size
from solidgear.core.ladder import build
from solidgear.core.quantity import QUANTITIES
from solidgear.core.scene import Scene
from solidgear.guards.check import check_scene
from validation.campaign.case import Case, Run
from validation.campaign.rows import (
    AGREES,
    CONTRADICTS,
    DECIDED,
    FALSE_INVALID,
    FALSE_VALID,
    UNCERTAIN,
    UNSOLVED,
    Cost,
    Found,
    Row,
    Said,
    Verdict,
    held,
    sorted_verdict,
    within,
)
from validation.campaign.scenes.shafts import random_scene, traits
from validation.campaign.truths.kept import Truths, truth_of
from validation.campaign.truths.reference import Reference, plain_mode

#: unknowns of the bending block of the lightest level of a reference, half of it at the others:
#: about 20 s on one core for all its solutions
MOST_UNKNOWNS = 100_000
#: a reference that is known worse than this share of a bar is refined, but not below solver noise
SHARE, FINE = 0.1, 1e-8
#: models whose verdicts are judged, and those whose bars are
BEAMS, SOLIDS = ("lumped", "euler", "timoshenko"), ("harmonic", "solid")
#: what a lumped model answers for
LUMPED = ("C_zz", "C_thx", "C_yy", "C_z,thx", "bending 1")


@dataclass(frozen=True)
class Lane:
    """Models that are compared."""

    models: tuple[str, ...]
    judged: tuple[str, ...] = ()  #: those whose verdicts are
    element: str = "hex20"  #: of the 3D solid
    check: bool = False  #: whether `check` is asked too


ALL = "all"
#: 3D solids that judge beams with no harmonic solid beside them
ALONE = {f"{element} alone": element for element in ("tet10", "hex20")}
LANES = {
    ALL: Lane((*BEAMS, "harmonic"), (*BEAMS, "harmonic"), check=True),
    "hex20": Lane(("solid",)),
    "tet10": Lane(("solid",), element="tet10"),
    **{name: Lane((*BEAMS, "solid"), BEAMS, element) for name, element in ALONE.items()},
}


class Shafts(Case):
    """Verdicts of beams and solids, and bars of the solids, against the spectral reference."""

    name, question = "shafts", "verdicts and bars of `compare` on random shafts"
    parts, details = ((), ("model",), ("model", "ties")), (("model", "quantity"),)
    seeds = (1, 100)
    tag_of_costs = "model"

    def options(self, parser: argparse.ArgumentParser) -> None:
        add = parser.add_argument
        add("--solid", type=int, default=0, help="shafts for bars of HEX20 and TET10 each")
        add(
            "--alone",
            action="store_true",
            help="verdicts by 3D solids alone, TET10 and HEX20 in turn, and nothing else",
        )
        add(
            "--tolerance",
            type=float,
            nargs="+",
            default=[None],
            help="each in turn, instead of the scenes' own",
        )

    def bodies(self, given: argparse.Namespace) -> list[tuple]:
        seeds, first = range(given.seeds[0], given.seeds[1] + 1), given.tolerance[0]
        if given.alone:
            turns = [list(ALONE)[seed % len(ALONE)] for seed in seeds]
            return [(s, t, lane) for t in given.tolerance for s, lane in zip(seeds, turns)]
        plain = [(seed, tolerance, ALL) for tolerance in given.tolerance for seed in seeds]
        solid = [
            (seed, first, lane) for lane in ("hex20", "tet10") for seed in seeds[: given.solid]
        ]
        return plain + solid

    def judge(self, run: Run, seed: int, tolerance: float | None, lane: str) -> Found:
        scene, compared = scene_of(seed, tolerance), LANES[lane]
        drawn = traits(scene)
        body = f"seed {seed} ({drawn['kind']}, {drawn['ties']}, L/D {drawn['l_over_d']:.2f})"
        said, problem = run.call(outcome, scene, compared)
        if problem:
            return Found(problems=[f"{body}, {lane}: {problem}"])
        # of solids that judge alone verdicts are asked for, which need no fine reference
        truths = refined(run, scene, {"models": {}} if lane in ALONE else said)
        if truths.finest is None:
            return Found(problems=[f"{body}: no reference within {MOST_UNKNOWNS} unknowns"])
        out = Found()
        for name in (name for name in SOLIDS if name in said["models"]):
            model, label = said["models"][name], name if lane == ALL else lane
            tags = {"model": label, "ties": drawn["ties"]}
            out.rows += rows_of(model, truths, body, tags)
            if not model["bars"]:
                why = model["why_not"] or "no reason told"
                out.problems.append(f"{body}, {lane}: no bar of {name}: {why}")
            elif model["seconds"]:
                out.costs.append(Cost(body, {"model": label}, model["seconds"], model["unknowns"]))
        if compared.judged:
            models = [said["models"].get(name, {}) for name in compared.judged]
            refused = any(not model.get("valid") for model in models)
            like = scene.with_attachment("section")
            fair = refined(run, like, {"models": {}}).references if refused else {}
            out.verdicts += verdicts_of(said, truths.references, fair, scene, body, lane)
        return out


def scene_of(seed: int, tolerance: float | None) -> Scene:
    """The scene of a seed, with another tolerance if one is given."""
    scene = random_scene(seed)
    if tolerance is None:
        return scene
    return scene.with_changes(ask=scene.ask.with_changes(tolerance=tolerance))


def refined(run: Run, scene: Scene, said: dict) -> Truths:
    """References fine enough: verdicts ask for a hundredth of the tolerance, bars for a tenth of
    each.
    """
    goal = dict.fromkeys(JUDGED, scene.ask.tolerance / 100)
    for model in (said["models"].get(name, {}) for name in SOLIDS):
        for name, bar in model.get("bars", {}).items():
            goal[name] = min(goal.get(name, 1.0), max(SHARE * bar, FINE))
    truths = run.truths(scene, MOST_UNKNOWNS, MOST_UNKNOWNS // 2, MOST_UNKNOWNS // 2)
    truths.meet(goal)
    return truths


def shape(model: dict, name: str) -> dict | None:
    """A mode of a model by its name."""
    return next((mode for mode in model["modes"] if mode["name"] == name), None)


def rows_of(model: dict, truths: Truths, body: str, tags: dict[str, str]) -> list[Row]:
    """Bars of one model, those without a true value left out."""
    out, values = [], model["values"]
    for name, bar in model["bars"].items():
        said = Said(name, values[name], bar, size(values, name))
        truth = truths.of(name, said.value, partial(shape, model, name))
        told = {"body": body, "tags": tags | {"quantity": name}, "rule": DECIDED}
        out += [held(said, truth, **told)] if truth else []
    return out


def errors_of(
    model: dict, references: dict[str, Reference], names: tuple[str, ...] = JUDGED
) -> dict[str, tuple[float, float]]:
    """Error and doubt of a model's quantities, relative to their true size; those without a truth
    are left out.
    """
    out = {}
    for name in (name for name in names if name in model["values"]):
        value = model["values"][name]
        truth = truth_of(name, value, references, partial(shape, model, name))
        if truth is not None:
            out[name] = (value - truth.value) / truth.size, truth.uncertainty
    return out


def verdicts_of(
    said: dict,
    references: dict[str, Reference],
    fair: dict[str, Reference],
    scene: Scene,
    body: str,
    lane: str = ALL,
) -> list[Verdict]:
    """Verdicts of all models of a lane; `fair` are references with section ties everywhere."""
    tolerance, out = scene.ask.tolerance, []
    for name in LANES[lane].judged:
        model = said["models"].get(name)
        label = f"{name} by {lane}" if lane in ALONE else name
        if not model or not model["values"]:
            out.append(Verdict(body, label, tolerance, UNSOLVED))
            continue
        names = LUMPED if name == "lumped" else JUDGED
        errors = errors_of(model, references, names)
        # a solid has ties of its own and is judged on the scene alone
        like = name == "harmonic" or fair and within(errors_of(model, fair, names), tolerance)
        sort, why = sorted_verdict(model["valid"], within(errors, tolerance), like), ""
        if sort == FALSE_VALID:
            worst = max(errors, key=lambda q: abs(errors[q][0]))
            why = f"{worst} is {100 * errors[worst][0]:+.2f} % off"
        elif sort == FALSE_INVALID:
            why = str(model["why_not"])
        out.append(Verdict(body, label, tolerance, sort, why))
    return out + _checked(said, tolerance, body)


def _checked(said: dict, tolerance: float, body: str) -> list[Verdict]:
    """Verdicts of `check`, beside those of `compare`."""
    out = []
    for name, verdict in said["check"].items():
        model = said["models"].get(name)
        if model is None:
            continue
        flat = {"holds": True, "will not hold": False}.get(verdict)
        sort, why = UNCERTAIN, ""
        if flat is not None:
            sort = AGREES if flat == bool(model["valid"]) else CONTRADICTS
        if sort == CONTRADICTS:
            found = "valid" if model["valid"] else f"not valid ({model['why_not']})"
            why = f"check says {verdict!r}, compare {found}"
        out.append(Verdict(body, f"check of {name}", tolerance, sort, why))
    return out


# ------------------------------------------------------------------------------------------------
# - asked of a worker
def outcome(scene: Scene, lane: Lane) -> dict[str, Any]:
    """Verdicts, values and bars of every model, and what `check` says, as plain data."""
    settings = {"solid": {"element": lane.element}} if "solid" in lane.models else None
    comparison = compare(scene, models=lane.models, settings=settings)
    records = comparison.results["models"]
    out = {name: _model(record, comparison.solutions.get(name)) for name, record in records.items()}
    said = {}
    if lane.check:
        verdicts = check_scene(scene, build(scene, "timoshenko")).verdicts
        said = {name: verdict.verdict for name, verdict in verdicts.items()}
    return {"models": out, "check": said}


def _model(record: dict, rung) -> dict:
    out = {"valid": record["valid"], "why_not": record["why_not"]}
    out |= {"values": {}, "bars": {}, "modes": [], "seconds": 0.0, "unknowns": 0}
    if record["compliance"] is None:
        return out
    out["values"] = values = _values(record)
    each = (record.get("band") or {}).get("each") or {}
    out["bars"] = {q: float(bar) for q, bar in each.items() if q in values and bar is not None}
    spent = (record.get("seconds") or {}).values()
    out["seconds"] = sum(one for one in spent if isinstance(one, float))
    out["unknowns"] = record.get("unknowns") or 0
    named = ("name", "family", "frequency_hz", "multiplicity")
    out["modes"] = [{key: mode[key] for key in named} for mode in record["modes"]]
    if rung is not None:
        out["modes"] = [plain_mode(mode) for mode in rung.modes.modes]
    return out


def _values(record: dict) -> dict[str, float]:
    """Compared numbers of a model's record; those that do not exist are left out."""
    named = {m["name"]: m["frequency_hz"] for m in record["modes"]}
    out = {}
    for name in QUANTITIES:
        value = named.get(name) if name.is_frequency else record[name.kind][name.row][name.column]
        if value:
            out[name] = float(value)
    return out
