"""What check prints of a shaft, and check on a train."""

from __future__ import annotations

import json
from pathlib import Path

import typer

from solidgear.errors import SolidgearError


def print_check(found: dict) -> None:
    """Facts, cautions, faults and verdicts of one shaft.

    Parameters
    ----------
    found : dict
        As :func:`solidgear.studies.check.check_scene` gives it.
    """
    from solidgear.studies.check import VERDICTS

    for line in found["facts"]:
        print(line)
    for level in ("caution", "open", "avoid"):
        for record in (r for r in found["records"] if r["level"] == level):
            words = ("caution", ", ".join(record["models"]), record["sentence"])
            print(": ".join(filter(None, words)))
    for line in found["faults"]:
        print(f"fault: {line}")
    for verdict in dict.fromkeys(VERDICTS.values()):
        models = [
            f"{m} ({', '.join(v['guards']).replace('_', ' ')})" if v["guards"] else m
            for m, v in found["verdicts"].items()
            if v["verdict"] == verdict
        ]
        if models:
            print(f"{verdict.capitalize()}: {', '.join(models)}.")


def check_train(train: Path, as_json: bool, given: dict[str, bool]) -> None:
    """The command check on a train: both shafts, then the system.

    Parameters
    ----------
    train : Path
    as_json : bool
    given : dict of str to bool
        Options of check that speak of one shaft, and whether they were given.
    """
    from solidgear.cli.train import workshop
    from solidgear.scene.train import SIDES
    from solidgear.studies.axle.check import check_train as run
    from solidgear.studies.axle.models import KEPT
    from solidgear.studies.check import VERDICTS

    for option, there in given.items():
        if there:
            raise SolidgearError(
                f"{option} is for one shaft, and {train} is a train: run check on the file of "
                "the shaft for other models and meshes"
            )
    shop = workshop(train, "rubin", KEPT, None)
    found = run(shop)
    if as_json:
        print(json.dumps(found, default=float))
    else:
        for side in SIDES:
            print(f"== {side}")
            print_check(found[side])
        print("== train")
        for line in found["facts"]:
            print(line)
        for line in found["cautions"]:
            print(f"caution: {line}")
        for line in found["faults"]:
            print(f"fault: {line}")
        for verdict in dict.fromkeys(VERDICTS.values()):
            models = [
                f"{m} ({' and '.join(v['shafts'])})" if v["shafts"] else m
                for m, v in found["verdicts"].items()
                if v["verdict"] == verdict
            ]
            if models:
                print(f"{verdict.capitalize()}: {', '.join(models)}.")
    if found["faults"] or any(found[side]["faults"] for side in SIDES):
        raise typer.Exit(1)
