"""Builder options of the shafts of a train."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import typer

from solidgear.cli.shared import options_by_name
from solidgear.ladder.registry import LADDER
from solidgear.studies.train.shaft import checked_rung

ShaftSettings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        help="Builder option of the model of one shaft as SIDE.key=value, repeatable: "
        "pinion.order=3, gear.elements=40; solidgear options lists them.",
    ),
]


def of_shafts(
    pairs: list[str] | None, models: Mapping[str, str]
) -> dict[str | tuple[str, str], dict[str, Any]]:
    """Builder options of all shafts, by (side, model), from ``SIDE.key=value`` texts.

    Parameters
    ----------
    models : mapping of str to str
        By shaft; of a lumped or rigid one the options are those of the body it comes from.

    Raises
    ------
    SolidgearError
        For a model, an option or a value that there is not.
    """
    out: dict[str | tuple[str, str], dict[str, Any]] = {}
    given = options_by_name(pairs, models, "side", "pinion.order=3")
    for side, options in given.items():
        kind, base = checked_rung(models[side])
        out[side, base or kind] = LADDER[base or kind].checked(options)
    return out
