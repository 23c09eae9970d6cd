"""Command ``check``: faults, cautions and verdicts of a shaft or a train."""

from __future__ import annotations

import json
from pathlib import Path

import typer

from solidgear.core import HARMONIC, LADDER, build, is_train, load
from solidgear.guards.check import VERDICTS, check_scene
from solidgear.show.command import caution, command, filled
from solidgear.show.options import MODEL, Fixed, Run, SceneFile, refuse

#: not capitalised where it begins a sentence
COMMAND = "solidgear"


@command
def check(
    scene: SceneFile,
    *,
    model: Fixed,
    run: Run,
) -> None:
    if is_train(scene):
        options = {"--model": model.name != MODEL, "--set": bool(model.settings)}
        check_train(scene, run.as_json, options)
        return

    loaded = load(scene)
    # a model of revolution is looked at on the plain part, and the check says so
    checked = loaded.plain if LADDER[model.name].unfit(loaded) else loaded
    light = model.name == MODEL and not model.settings
    report = check_scene(
        loaded, build(checked, MODEL, **HARMONIC) if light else model.body(checked)
    )
    if run.as_json:
        print(json.dumps(report, default=float))
    else:
        print_check(report)
    if report["faults"]:
        raise typer.Exit(1)


def print_check(report: dict) -> None:
    """Print verdicts, faults, cautions and facts of one shaft."""
    _print_verdicts(
        {
            name: (verdict["verdict"], ", ".join(verdict["guards"]).replace("_", " "))
            for name, verdict in report["verdicts"].items()
        }
    )
    records = [record for record in report["records"] if not _spared(record, report["verdicts"])]
    cautions = [
        ": ".join(filter(None, (", ".join(record["models"]), record["sentence"])))
        for level in ("caution", "open", "avoid")
        for record in records
        if record["level"] == level
    ]
    facts = [record["sentence"] for record in records if record["level"] == "fact"]
    _print_sentences(report["faults"], cautions, facts)


def _print_sentences(faults: list[str], cautions: list[str], facts: list[str]) -> None:
    """Print lines as wide as the terminal, a thought a sentence."""
    lines = [*(f"fault: {text}" for text in faults), *map(caution, cautions), *facts]
    for line in lines:
        print(filled(thoughts(line)))


def thoughts(text: str) -> str:
    """Return a text in which each part before a semicolon becomes a sentence.

    Examples
    --------
    >>> thoughts("too soft (1 N/m; 2 N/m); use a beam")
    'too soft (1 N/m; 2 N/m). Use a beam.'
    """
    parts, depth = [""], 0
    for k, letter in enumerate(text):
        depth += (letter in "([{") - (letter in ")]}")
        if text[k : k + 2] == "; " and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    first, *following = (part.strip() for part in parts)
    begun = [
        part if part.startswith(COMMAND) else part[:1].upper() + part[1:] for part in following
    ]
    return ". ".join([first, *begun]) + ("." if not text.endswith(".") else "")


def _spared(record: dict, verdicts: dict) -> bool:
    """Return True for a record left to ``--json``: a sound mesh, or a caution on a model that is
    out anyway.
    """
    if record["guard"] == "mesh":
        return record["level"] == "fact"
    refused = [verdicts.get(m, {}).get("guards", []) for m in record["models"]]
    refusals = {"features"} | (
        {"beam_against_solid"} if record["guard"] == "slenderness" else set()
    )
    return (
        bool(refused)
        and record["guard"] not in refusals
        and record["level"] in ("caution", "open")
        and all(refusals & set(guards) for guards in refused)
    )


def _print_verdicts(models: dict[str, tuple[str, str]]) -> None:
    """Print verdict and reason of every model, a line for each verdict."""
    for verdict in dict.fromkeys(VERDICTS.values()):
        reasons = {name: reason for name, (value, reason) in models.items() if value == verdict}
        if reasons:
            texts = (f"{name} ({reason})" if reason else name for name, reason in reasons.items())
            print(filled(f"{verdict.capitalize()}: {', '.join(texts)}."))


def check_train(train: Path, as_json: bool, options: dict[str, bool]) -> None:
    """Check a train: the shafts, then the system; refuse options of one shaft."""
    # start-up: a shaft has no use for the studies of trains
    from solidgear.trains.judge.check import check_train as checked
    from solidgear.trains.options import Reduced

    instead = "for other models and meshes run check on the file of a shaft"
    refuse(options, f"one shaft, and {train} is a train: {instead}")
    assembly = Reduced().assembly(train)
    report = checked(assembly)
    if as_json:
        print(json.dumps(report, default=float))
    else:
        print("== train")
        _print_verdicts(
            {
                name: (verdict["verdict"], " and ".join(verdict["shafts"]))
                for name, verdict in report["verdicts"].items()
            }
        )
        _print_sentences(report["faults"], report["cautions"], report["facts"])
        for side in assembly.train.shafts:
            print(f"== {side}")
            print_check(report[side])
    if report["faults"] or any(report[side]["faults"] for side in assembly.train.shafts):
        raise typer.Exit(1)
