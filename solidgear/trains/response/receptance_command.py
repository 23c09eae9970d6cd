"""The command receptance: motion of one port of a train for a unit force on another."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from solidgear.show.command import caution, command, say
from solidgear.show.folder import held
from solidgear.show.options import Shown
from solidgear.trains.assembly.slips import unit_slips
from solidgear.trains.command import end_of, print_peaks
from solidgear.trains.judge.comparison import train_data
from solidgear.trains.modes.modes import unpublished_lines
from solidgear.trains.options import Driven, Reduced, TrainFile
from solidgear.trains.page.files import write_receptance
from solidgear.trains.response.receptance import receptance as between

END = "as PORT:COMPONENT, such as gear.gear:z, in the axes of the port's own shaft."


@command
def receptance(
    train: TrainFile,
    *,
    from_: Annotated[str, typer.Option("--from", help=f"Where a unit force acts, {END}")],
    to: Annotated[str, typer.Option("--to", help=f"Where the motion is read, {END}")],
    out: Annotated[
        Path, typer.Option("--out", "-o", help="Folder for receptance.csv and its chart.")
    ] = Path("out"),
    driven: Driven,
    reduced: Reduced,
    run: Shown,
) -> None:
    assembly = driven.assembly(reduced, train)
    ends = end_of("--from", from_), end_of("--to", to)
    unpublished, warnings = assembly.train.unpublished(), unit_slips(assembly)
    cautions = [*warnings, *assembly.cautions]
    title = f"{assembly.train.called}: {to} for a unit force on {from_}"
    with held(out):
        how: dict[str, Any] = {"highest_hz": reduced.max_frequency, **driven.losses}
        mixes = driven.mixes(assembly.train)
        receptances = [between(assembly, *mix, from_=ends[0], to=ends[1], **how) for mix in mixes]
        notes = {"from": from_, "to": to, "unpublished": unpublished, "cautions": cautions}
        teeth = assembly.train.per_turn(assembly.train.named_mesh(driven.mesh))
        files = write_receptance(
            out, receptances, title, teeth, notes, train_data(assembly), run.units
        )
    if run.as_json:
        print((out / "receptance.json").read_text(encoding="utf-8"))
        return
    say(
        f"{title}; {receptances[0].label}, {driven.damping} losses",
        *map(caution, warnings),
    )
    print_peaks(receptances[0].peaks, "receptance", receptances[0].unit, teeth, run.units)
    say(*unpublished_lines(unpublished), *map(caution, assembly.cautions))
    say(f"Written: {', '.join(map(str, files))}")
