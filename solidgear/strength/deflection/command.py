"""The command deflect: a train under torque, or a shaft under its load."""

from __future__ import annotations

import json
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated, Any

import typer

from solidgear.core.loading import explained
from solidgear.core.scene import Scene
from solidgear.show.command import Progress, caution, command, say
from solidgear.show.folder import held
from solidgear.show.options import BY_MODEL, Shown
from solidgear.show.units import units_named
from solidgear.strength.acting import Acting, AtRestFile, load_in_words
from solidgear.strength.deflection import shaft as deflection
from solidgear.strength.deflection import tables
from solidgear.strength.deflection import train as of_train
from solidgear.strength.deflection.files import write_deflection
from solidgear.trains.assembly.layout import senses_sentence
from solidgear.trains.assembly.models import Workshop
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import Train


@command
def deflect(
    file: AtRestFile,
    *,
    acting: Acting,
    models: Annotated[
        list[str] | None,
        typer.Option(
            *BY_MODEL,
            help="Model of every shaft; repeatable, the finest last. By default rigid (trains), "
            "euler, timoshenko and harmonic.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for a page, deflection lines and their chart."),
    ] = None,
    run: Shown,
) -> None:
    given = acting.read(file)
    with held(out) if out else nullcontext(), run.progress() as progress:
        if isinstance(given, tuple):
            every = acting.torque is None and acting.point is None and len(given[0].operation) > 1
            data, lines = _train(*given, models, out, run.units, progress, every)
        else:
            data, lines = _shaft(file, given, models, out, run.units, progress)
    if run.as_json:
        print(json.dumps(data, allow_nan=False))
        return
    say(*lines, soft_wrap=False)


def _train(
    train: Train,
    at: OperatingPoint,
    models: list[str] | None,
    out: Path | None,
    units: str,
    progress: Progress,
    every: bool,
) -> tuple[dict, list]:
    found = of_train.deflect_train(Workshop(train), at, models or of_train.MODELS, progress, every)
    shown, judge = units_named(units), found.judge
    over = tables.over_points(found.points, shown)
    turning = tables.over_a_turn(judge.turns, shown)
    force = ", ".join(
        shown.text(size, "N", 5)
        + name.removeprefix("mesh")
        + (" (each planet)" if name in [stage.name for stage in train.stages] else "")
        for name, size in judge.mesh_forces.items()
    )
    lead = f"At {at.label}: {force} along the line of action."
    sense = senses_sentence(found.senses)
    lines: list[Any] = [
        f"{found.title} at {at.label}",
        f"Mesh force {force} along the line of action, {'coast' if at.coast else 'drive'} flank.",
        f"{sense[0].upper()}{sense[1:]}.",
        *filter(None, [tables.misalignment(found, shown)]),  # none of planets alone
        *tables.bearings(judge.shafts, shown),
        tables.displacements(judge.shafts, shown),
        *tables.housing(judge, shown),
        *turning,
        *over,
        found.verdict(),
        *judge.notes,
        *map(caution, found.cautions),
    ]
    if out:
        files = write_deflection(
            out,
            {one.model: one.shafts for one in found.solutions},
            found.as_dict(),
            f"{found.title}: deflection",
            f"{lead} {found.verdict()}",
            [tables.misalignment(found, shown), *turning, *over, *tables.housing(judge, shown)],
            [sense, *judge.notes, *found.cautions],
            shown,
            judge.turns,
        )
        lines.append(f"Written: {', '.join(map(str, files))}")
    return found.as_dict(), lines


def _shaft(
    file: Path,
    scene: Scene,
    models: list[str] | None,
    out: Path | None,
    units: str,
    progress: Progress,
) -> tuple[dict, list]:
    with explained(file):
        found = deflection.deflect_scene(scene, models or deflection.MODELS, progress)
    shown, judge = units_named(units), found.shafts[-1]
    lead = f"Under {load_in_words(scene, shown)}; numbers by {judge.model}."
    note = f"No error bars: {deflection.WITHOUT_BAR}."
    moved = tables.models(found.shafts, scene.port.name, note, shown)
    lines: list[Any] = [
        found.title,
        lead,
        moved,
        *tables.bearings([judge], shown),
        tables.displacements([judge], shown),
        *map(caution, judge.notes),
    ]
    if out:
        shafts = {shaft.model: [shaft] for shaft in found.shafts}
        told_first = [moved]
        title = f"{found.title}: deflection"
        files = write_deflection(
            out, shafts, found.as_dict(), title, lead, told_first, judge.notes, shown
        )
        lines.append(f"Written: {', '.join(map(str, files))}")
    return found.as_dict(), lines
