"""Command ``check``: faults, cautions and verdicts of a shaft or a train."""

from __future__ import annotations

import json
from pathlib import Path

import typer

from solidgear.core.ladder import build
from solidgear.core.ladder.meshes import HARMONIC
from solidgear.core.ladder.registry import LADDER
from solidgear.core.loading import load
from solidgear.core.scene.toml_file import is_train
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
        given = {"--model": model.name != MODEL, "--set": bool(model.settings)}
        check_train(scene, run.as_json, given)
        return

    loaded = load(scene)
    # a model of revolution is looked at on the plain part, and the check says so
    shown = loaded.plain if LADDER[model.name].unfit(loaded) else loaded
    light = model.name == MODEL and not model.settings
    found = check_scene(loaded, build(shown, MODEL, **HARMONIC) if light else model.body(shown))
    if run.as_json:
        print(json.dumps(found, default=float))
    else:
        print_check(found)
    if found["faults"]:
        raise typer.Exit(1)


def print_check(found: dict) -> None:
    """Verdicts, faults, cautions and facts of one shaft, as
    :func:`solidgear.guards.check.check_scene` gives them.
    """
    _print_verdicts(
        {
            name: (told["verdict"], ", ".join(told["guards"]).replace("_", " "))
            for name, told in found["verdicts"].items()
        }
    )
    said = [record for record in found["records"] if not _spared(record, found["verdicts"])]
    cautions = [
        ": ".join(filter(None, (", ".join(record["models"]), record["sentence"])))
        for level in ("caution", "open", "avoid")
        for record in said
        if record["level"] == level
    ]
    facts = [record["sentence"] for record in said if record["level"] == "fact"]
    _print_sentences(found["faults"], cautions, facts)


def _print_sentences(faults: list[str], cautions: list[str], facts: list[str]) -> None:
    """Lines as wide as the terminal, a thought a sentence."""
    lines = [*(f"fault: {text}" for text in faults), *map(caution, cautions), *facts]
    for line in lines:
        print(filled(thoughts(line)))


def thoughts(text: str) -> str:
    """A text in which each thought that a semicolon joins is a sentence.

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
    first, *others = (part.strip() for part in parts)
    begun = [part if part.startswith(COMMAND) else part[:1].upper() + part[1:] for part in others]
    return ". ".join([first, *begun]) + ("." if not text.endswith(".") else "")


def _spared(record: dict, verdicts: dict) -> bool:
    """Tell whether a record is left to ``--json``: a sound mesh, what is said of models that do not
    hold the features at all, and a rule of thumb where what was computed refuses.
    """
    if record["guard"] == "mesh":
        return record["level"] == "fact"
    refused = [verdicts.get(m, {}).get("guards", []) for m in record["models"]]
    by = {"features"} | ({"beam_against_solid"} if record["guard"] == "slenderness" else set())
    return (
        bool(refused)
        and record["guard"] not in by
        and record["level"] in ("caution", "open")
        and all(by & set(guards) for guards in refused)
    )


def _print_verdicts(models: dict[str, tuple[str, str]]) -> None:
    """Verdict and reason of every model: a line for each verdict, in the order of check."""
    for verdict in dict.fromkeys(VERDICTS.values()):
        own = {name: why for name, (here, why) in models.items() if here == verdict}
        if own:
            told = (f"{name} ({why})" if why else name for name, why in own.items())
            print(filled(f"{verdict.capitalize()}: {', '.join(told)}."))


def check_train(train: Path, as_json: bool, given: dict[str, bool]) -> None:
    """The command check on a train: both shafts, then the system; options that speak of one shaft are
    refused where they were given.
    """
    # start-up: a shaft has no use for the studies of trains
    from solidgear.trains.judge.check import check_train as checked
    from solidgear.trains.options import Reduced

    instead = "run check on the file of the shaft for other models and meshes"
    refuse(given, f"one shaft, and {train} is a train: {instead}")
    shop = Reduced().workshop(train)
    found = checked(shop)
    if as_json:
        print(json.dumps(found, default=float))
    else:
        print("== train")
        _print_verdicts(
            {
                name: (told["verdict"], " and ".join(told["shafts"]))
                for name, told in found["verdicts"].items()
            }
        )
        _print_sentences(found["faults"], found["cautions"], found["facts"])
        for side in shop.train.shafts:
            print(f"== {side}")
            print_check(found[side])
    if found["faults"] or any(found[side]["faults"] for side in shop.train.shafts):
        raise typer.Exit(1)
