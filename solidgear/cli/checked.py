"""Printing of checks of a shaft and of a train."""

from __future__ import annotations

import json
from pathlib import Path

import typer


def print_check(found: dict) -> None:
    """Facts, cautions, faults and verdicts of one shaft.

    Parameters
    ----------
    found : dict
        As :func:`solidgear.studies.check.check_scene` gives it.
    """
    told = [record for record in found["records"] if not _spared(record, found["verdicts"])]
    for record in (r for r in told if r["level"] == "fact"):
        print(record["sentence"])
    for level in ("caution", "open", "avoid"):
        for record in (r for r in told if r["level"] == level):
            words = ("caution", ", ".join(record["models"]), record["sentence"])
            print(": ".join(filter(None, words)))
    for line in found["faults"]:
        print(f"fault: {line}")
    _print_verdicts(
        {
            name: (told["verdict"], ", ".join(told["guards"]).replace("_", " "))
            for name, told in found["verdicts"].items()
        }
    )


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
    from solidgear.studies.check import VERDICTS

    for verdict in dict.fromkeys(VERDICTS.values()):
        own = {name: why for name, (here, why) in models.items() if here == verdict}
        if own:
            told = (f"{name} ({why})" if why else name for name, why in own.items())
            print(f"{verdict.capitalize()}: {', '.join(told)}.")


def check_train(train: Path, as_json: bool, given: dict[str, bool]) -> None:
    """The command check on a train: both shafts, then the system.

    Parameters
    ----------
    given : dict of str to bool
        Options of check that speak of one shaft, and whether they were given.
    """
    from solidgear.cli.train_options import Reduced, refuse_given
    from solidgear.studies.train.check import check_train as run

    instead = "run check on the file of the shaft for other models and meshes"
    refuse_given(given, train, instead)
    shop = Reduced().workshop(train)
    found = run(shop)
    if as_json:
        print(json.dumps(found, default=float))
    else:
        for side in shop.train.shafts:
            print(f"== {side}")
            print_check(found[side])
        print("== train")
        for line in found["facts"]:
            print(line)
        for line in found["cautions"]:
            print(f"caution: {line}")
        for line in found["faults"]:
            print(f"fault: {line}")
        _print_verdicts(
            {
                name: (told["verdict"], " and ".join(told["shafts"]))
                for name, told in found["verdicts"].items()
            }
        )
    if found["faults"] or any(found[side]["faults"] for side in shop.train.shafts):
        raise typer.Exit(1)
