"""The command deflect: a train under torque, or a shaft under its load."""

from __future__ import annotations

import json
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from solidgear.cli.app import Progress, caution, command, say
from solidgear.cli.shared import BY_MODEL, Shown
from solidgear.errors import SceneError, SolidgearError, show

if TYPE_CHECKING:
    from solidgear.scene.operation import OperatingPoint
    from solidgear.scene.train import Train


@command
def deflect(
    file: Annotated[
        Path,
        typer.Argument(help="Train or scene file (TOML), such as geometry/axle_overhung.toml."),
    ],
    *,
    torque: Annotated[
        str | None,
        typer.Option(help='Of a train, such as "115 N*m"; by default its first operating point.'),
    ] = None,
    of: Annotated[str, typer.Option("--of", help="Shaft of --torque: pinion or gear.")] = "pinion",
    point: Annotated[
        str | None, typer.Option("--point", help="Operating point of a train, by name or number.")
    ] = None,
    weight: Annotated[
        str | None,
        typer.Option(help="With --torque: direction of weight in the pinion's scene, such as -z."),
    ] = None,
    load: Annotated[
        str | None,
        typer.Option(
            "--load",
            help='Of a shaft, in place of the load in its file: "x=2 kN, z=-500 N" at the port.',
        ),
    ] = None,
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
    """Deflection of shafts under torque: displacements, misalignment of the gears, bearing loads."""
    from solidgear.report.folder import held
    from solidgear.scene.toml_file import is_train

    of_train = {"--torque": torque, "--point": point, "--weight": weight}
    with held(out) if out else nullcontext(), run.progress() as progress:
        if is_train(file):
            _refuse({"--load": load}, "a shaft", file, "a train takes --torque")
            how = _point(file, torque, of, point, weight)
            every = torque is None and point is None and len(how[0].operation) > 1
            told = _train(file, *how, models, out, run.units, progress, every)
        else:
            _refuse(of_train, "a train", file, "a shaft takes --load, or has [load]")
            told = _shaft(file, load, models, out, run.units, progress)
    data, lines = told
    if run.as_json:
        print(json.dumps(data, allow_nan=False))
        return
    say(*lines, soft_wrap=False)


def _refuse(options: dict[str, str | None], what: str, file: Path, instead: str) -> None:
    for option, given in options.items():
        if given is not None:
            raise SolidgearError(f"{option} is for {what}, and {file} is none: {instead}")


def _point(
    file: Path, torque: str | None, of: str, point: str | None, weight: str | None
) -> tuple[Train, OperatingPoint]:
    """A train and the operating point that options and file name."""
    from solidgear.scene.operation import OperatingPoint
    from solidgear.studies.loading import load_train
    from solidgear.studies.train.operation import named_point

    if torque is None:
        _refuse({"--weight": weight}, "a --torque", file, "write weight into its [operation]")
        train = load_train(file)
        if not train.operation:
            raise SolidgearError(
                f'{file}: no torque is given; write [operation] with torque = "115 N*m", or give '
                "--torque"
            )
        return train, train.operation[0] if point is None else named_point(train, point)
    if point is not None:
        raise SolidgearError("give either --torque or --point, not both")
    given: dict[str, Any] = {"torque": torque, "of": of} | ({"weight": weight} if weight else {})
    try:
        own = OperatingPoint(**given)
    except SceneError as error:
        raise SolidgearError(f"--torque {show(torque, 40)}: {error}") from None
    return load_train(file, own), own


def _train(
    file: Path,
    train: Train,
    at: OperatingPoint,
    models: list[str] | None,
    out: Path | None,
    units: str,
    progress: Progress,
    every: bool,
) -> tuple[dict, list]:
    from solidgear.report import deflection_tables as tables
    from solidgear.report.deflection_files import write_deflection
    from solidgear.report.units import units_named
    from solidgear.studies.train.deflection import MODELS, deflect_train
    from solidgear.studies.train.models import Workshop

    found = deflect_train(Workshop(train), at, models or MODELS, progress, every)
    shown, judge = units_named(units), found.judge
    over = tables.over_points(found.points, shown)
    force = shown.text(judge.mesh_force, "N", 5)
    lead = f"At {at.label}: {force} along the line of action."
    lines: list[Any] = [
        f"{found.title} at {at.label}",
        f"Mesh force {force} along the line of action, {'coast' if at.coast else 'drive'} flank.",
        tables.misalignment(found, shown),
        *tables.bearings(judge.shafts, shown),
        tables.displacements(judge.shafts, shown),
        *over,
        found.verdict(),
        *judge.notes,
        *map(caution, found.cautions),
    ]
    if out:
        files = write_deflection(
            out,
            {one.pinion: one.shafts for one in found.found},
            found.as_dict(),
            f"{found.title}: deflection",
            f"{lead} {found.verdict()}",
            [tables.misalignment(found, shown), *over],
            [*judge.notes, *found.cautions],
            shown,
        )
        lines.append(f"Written: {', '.join(map(str, files))}")
    return found.as_dict(), lines


def _shaft(
    file: Path,
    load: str | None,
    models: list[str] | None,
    out: Path | None,
    units: str,
    progress: Progress,
) -> tuple[dict, list]:
    from solidgear.cli.bearing import loaded_by
    from solidgear.report import deflection_tables as tables
    from solidgear.report.deflection_files import write_deflection
    from solidgear.report.units import units_named
    from solidgear.scene.file import load as read
    from solidgear.studies.deflection import MODELS, deflect_scene
    from solidgear.studies.loading import explained

    scene = read(file) if load is None else loaded_by(read(file), load)
    with explained(file):
        found = deflect_scene(scene, models or MODELS, progress)
    shown, judge = units_named(units), found.shafts[-1]
    told = ", ".join(
        f"{name} {shown.text(float(v), si, 4)}"
        for name, v, si in zip(tables.DOFS, found.load, tables.LOAD_OF)
        if v
    )
    lead = f"Under {told} at {scene.port.name}; numbers by {judge.model}."
    lines: list[Any] = [
        found.title,
        lead,
        tables.models(found.shafts, scene.port.name, shown),
        *tables.bearings([judge], shown),
        tables.displacements([judge], shown),
        *map(caution, judge.notes),
    ]
    if out:
        shafts = {shaft.model: [shaft] for shaft in found.shafts}
        told_first = [tables.models(found.shafts, scene.port.name, shown)]
        title = f"{found.title}: deflection"
        files = write_deflection(
            out, shafts, found.as_dict(), title, lead, told_first, judge.notes, shown
        )
        lines.append(f"Written: {', '.join(map(str, files))}")
    return found.as_dict(), lines
