"""Commands on a train, two shafts that mesh: system-modes, response, judge-system."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from solidgear.cli.app import JsonFlag, command, console
from solidgear.errors import SolidgearError, show

TrainFile = Annotated[
    Path, typer.Argument(help="Train file (TOML), such as geometry/axle_overhung.toml.")
]
RUNGS = (
    "euler, timoshenko, harmonic, solid, rigid, lumped, lumped-bending, lumped-matched, "
    "lumped-old; a lumped one may name its body, lumped/euler."
)
PinionRung = Annotated[str, typer.Option("--pinion", help=f"Model of the pinion's shaft: {RUNGS}")]
GearRung = Annotated[str, typer.Option("--gear", help="Model of the gear's shaft, as --pinion.")]
Reduction = Annotated[
    str, typer.Option("--reduction", help="rubin (free modes and residuals) or craig_bampton.")
]
Kept = Annotated[int, typer.Option("--kept", help="Modes of each shaft kept in its reduction.")]
MOST_KEPT = 200
#: relative; no frequency is printed with a smaller bound, whatever the proof says
ROUNDING = 1e-12


def _shop(path: Path, reduction: str, kept: int):
    from solidgear.scene.train_file import load_train
    from solidgear.studies.axle.models import Workshop

    if not 1 <= kept <= MOST_KEPT:
        raise SolidgearError(f"--kept {show(kept)}: give 1 to {MOST_KEPT} modes")
    return Workshop(load_train(path), reduction, kept)


@command
def system_modes(
    train: TrainFile,
    pinion: PinionRung = "harmonic",
    gear: GearRung = "harmonic",
    max_frequency: Annotated[
        float | None, typer.Option(help="Hz; as the file says by default.")
    ] = None,
    reduction: Reduction = "rubin",
    kept: Kept = 24,
    as_json: JsonFlag = False,
) -> None:
    """Natural frequencies of a geared rotor system, each with its name and its proven bound."""
    from solidgear.studies.axle.modes import train_modes

    if max_frequency is not None and not max_frequency > 0:
        raise SolidgearError(f"--max-frequency {max_frequency:g}: must be greater than zero, in Hz")
    shop = _shop(train, reduction, kept)
    found = train_modes(shop, pinion, gear, max_frequency)
    if as_json:
        print(json.dumps(found.as_dict(), allow_nan=False))
        return
    terminal = console()
    for line in found.heading():
        terminal.print(line, markup=False, soft_wrap=True)
    terminal.print(_modes_table(found))
    for line in found.remarks():
        terminal.print(line, markup=False, soft_wrap=True)


def _modes_table(found):
    from rich.table import Table

    table = Table(show_edge=False)
    table.add_column("mode")
    table.add_column("Hz", justify="right")
    table.add_column("pinion rpm", justify="right")
    table.add_column("most strain energy")
    table.add_column("bound", justify="right")
    for mode in found.modes:
        bound = "exact" if mode.frequency_hz == 0 else f"{max(mode.bound, ROUNDING):.0e}"
        table.add_row(
            mode.name, f"{mode.frequency_hz:.2f}", f"{mode.rpm:.0f}", mode.strained, bound
        )
    return table
