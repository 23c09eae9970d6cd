"""The command deflect: a train under torque, or a shaft under its load."""

from __future__ import annotations

import json
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated, Any

import typer

from solidgear.core import Scene, explained
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
            help="Model of every shaft; repeatable, the finest last. By default rigid (trains "
            "only), euler, timoshenko and harmonic.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for a page, deflection lines and their chart."),
    ] = None,
    run: Shown,
) -> None:
    loaded = acting.read(file)
    with held(out) if out else nullcontext(), run.progress() as progress:
        if isinstance(loaded, tuple):
            train, point = loaded
            every_point = (
                acting.torque is None and acting.point is None and len(train.operation) > 1
            )
            data, lines = _train(train, point, models, out, run.units, progress, every_point)
        else:
            data, lines = _shaft(file, loaded, models, out, run.units, progress)
    if run.as_json:
        print(json.dumps(data, allow_nan=False))
        return
    say(*lines, soft_wrap=False)


def _train(
    train: Train,
    point: OperatingPoint,
    models: list[str] | None,
    out: Path | None,
    units: str,
    progress: Progress,
    every_point: bool,
) -> tuple[dict, list]:
    deflected = of_train.deflect_train(
        Workshop(train), point, models or of_train.MODELS, progress, every_point
    )
    chosen_units, judge = units_named(units), deflected.judge
    point_tables = tables.over_points(deflected.points, chosen_units)
    turning = tables.over_a_turn(judge.turns, chosen_units)
    force = ", ".join(
        chosen_units.text(size, "N", 5)
        + name.removeprefix("mesh")
        + (" (each planet)" if name in [stage.name for stage in train.stages] else "")
        for name, size in judge.mesh_forces.items()
    )
    lead = f"At {point.label}: {force} along the line of action."
    sense = senses_sentence(deflected.senses)
    lines: list[Any] = [
        f"{deflected.title} at {point.label}",
        f"Mesh force {force} along the line of action, {'coast' if point.coast else 'drive'} flank.",
        f"{sense[0].upper()}{sense[1:]}.",
        *filter(None, [tables.misalignment(deflected, chosen_units)]),  # none of planets alone
        *tables.bearings(judge.shafts, chosen_units),
        tables.displacements(judge.shafts, chosen_units),
        *tables.housing(judge, chosen_units),
        *turning,
        *point_tables,
        deflected.verdict(),
        *judge.notes,
        *map(caution, deflected.cautions),
    ]
    if out:
        files = write_deflection(
            out,
            {model.model: model.shafts for model in deflected.solutions},
            deflected.as_dict(),
            f"{deflected.title}: deflection",
            f"{lead} {deflected.verdict()}",
            [
                tables.misalignment(deflected, chosen_units),
                *turning,
                *point_tables,
                *tables.housing(judge, chosen_units),
            ],
            [sense, *judge.notes, *deflected.cautions],
            chosen_units,
            judge.turns,
        )
        lines.append(f"Written: {', '.join(map(str, files))}")
    return deflected.as_dict(), lines


def _shaft(
    file: Path,
    scene: Scene,
    models: list[str] | None,
    out: Path | None,
    units: str,
    progress: Progress,
) -> tuple[dict, list]:
    with explained(file):
        deflected = deflection.deflect_scene(scene, models or deflection.MODELS, progress)
    chosen_units, judge = units_named(units), deflected.shafts[-1]
    lead = f"Under {load_in_words(scene, chosen_units)}; numbers by {judge.model}."
    note = f"No error bars: {deflection.WITHOUT_BAR}."
    moved = tables.models(deflected.shafts, scene.port.name, note, chosen_units)
    lines: list[Any] = [
        deflected.title,
        lead,
        moved,
        *tables.bearings([judge], chosen_units),
        tables.displacements([judge], chosen_units),
        *map(caution, judge.notes),
    ]
    if out:
        shafts = {shaft.model: [shaft] for shaft in deflected.shafts}
        told_first = [moved]
        title = f"{deflected.title}: deflection"
        files = write_deflection(
            out, shafts, deflected.as_dict(), title, lead, told_first, judge.notes, chosen_units
        )
        lines.append(f"Written: {', '.join(map(str, files))}")
    return deflected.as_dict(), lines
