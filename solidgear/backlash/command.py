"""The command nonlinear: a train whose teeth have backlash, over speed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from solidgear.backlash import train as study
from solidgear.backlash.sheet import nonlinear_sheet
from solidgear.backlash.speed_run import ramp_of, speed_run
from solidgear.backlash.study import BacklashStudy
from solidgear.core import SceneError, SolidgearError, show
from solidgear.core.scene.units import quantity
from solidgear.show.command import Progress, command
from solidgear.show.options import Shown
from solidgear.show.sheet import Sheet, present
from solidgear.show.units import units_named
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.mesh_stiffness import with_solved_meshes
from solidgear.trains.assembly.slips import unit_slips
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.train import named_pair
from solidgear.trains.options import Mix, Reduced, TrainFile
from solidgear.trains.options import mix as read_mix

#: speeds of a sweep in time, and mean forces of a map: each takes seconds
MOST_RUNS = 200
#: at which branches apart are looked for
SPEEDS = 32


@command
def nonlinear(
    train: TrainFile,
    *,
    models: Mix,
    backlash: Annotated[
        str | None,
        typer.Option(
            help='Backlash along the line of action, such as "100 um"; by default the file\'s.'
        ),
    ] = None,
    mean_force: Annotated[
        str | None,
        typer.Option(
            "--mean-force",
            help='Mean force of the teeth, such as "5 kN"; by default by the file\'s operating '
            "point.",
        ),
    ] = None,
    error: Annotated[
        str | None,
        typer.Option(help='Transmission error, such as "10 um"; by default the file\'s.'),
    ] = None,
    mesh: Annotated[
        str | None,
        typer.Option(
            "--mesh",
            help="Mesh whose transmission error drives the train, and to which --backlash, "
            "--mean-force and --error belong; by default the first.",
        ),
    ] = None,
    min_frequency: Annotated[
        float | None,
        typer.Option("--min-frequency", help="Hz; a hundredth of the highest by default."),
    ] = None,
    against: Annotated[
        list[str] | None,
        typer.Option(
            "--against",
            help="Further models to judge, as PINION+GEAR, one for each shaft; lumped and "
            "Timoshenko shafts by default.",
        ),
    ] = None,
    apart: Annotated[
        int,
        typer.Option(
            "--apart", help="Number of speeds at which separate branches are searched; 0 for none."
        ),
    ] = SPEEDS,
    in_time: Annotated[
        int,
        typer.Option(
            "--in-time", help="Number of speeds at which to check it by integration in time."
        ),
    ] = 0,
    run_up: Annotated[
        list[float] | None,
        typer.Option(
            "--run-up",
            help="Run through the range in time at so many rpm/s of the engine's shaft; below 0 "
            "for a run-down.",
        ),
    ] = None,
    contact_loss: Annotated[
        float | None,
        typer.Option(
            "--contact-loss",
            help="Frequency in Hz at which a damper in contact only has the loss factor of the "
            "mesh.",
        ),
    ] = None,
    forces: Annotated[
        int,
        typer.Option(
            "--forces", help="Number of mean forces for a map of jumps over speed and torque."
        ),
    ] = 0,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for the branch, its chart and a page."),
    ] = None,
    reduced: Reduced,
    run: Shown,
) -> None:
    assembly = models.assembly(reduced, train)
    first = tuple(models.by_shaft(assembly.train).values())
    driver = named_pair(assembly.train, mesh)
    # nonlinear motion sees the stiffness of its own teeth vary
    assembly = assembly.with_train(with_solved_meshes(assembly.asked_train, driver.name))
    further_mixes = _usual(assembly)
    if against is not None:
        further_mixes = [
            tuple(assembly.models_by_shaft(read_mix(text)).values()) for text in against
        ]
    assembly = _with_teeth(assembly, driver, backlash, error)
    if contact_loss is not None and not contact_loss > 0:
        raise SolidgearError(f"--contact-loss {contact_loss:g}: give a frequency above 0 Hz")
    teeth = study.teeth_of(
        assembly, _read("--mean-force", mean_force, "load"), contact_loss, driver.name
    )
    for option, count in (("--apart", apart), ("--in-time", in_time), ("--forces", forces)):
        if not 0 <= count <= MOST_RUNS:
            raise SolidgearError(f"{option} {count}: give 0 to {MOST_RUNS}")
    low, high = study.ends(assembly, reduced.max_frequency, min_frequency)
    passing = assembly.train.per_turn(driver)
    ramps = [ramp_of(rpm, passing, low, high) for rpm in run_up or []]

    def solve(progress: Progress) -> Sheet:
        judged = tuple(
            study.with_backlash(
                assembly, mix, teeth, reduced.max_frequency, min_frequency, progress, apart
            )
            for mix in [first, *(mix for mix in further_mixes if mix != first)]
        )
        result = BacklashStudy(
            train=assembly.train,
            mixes=judged,
            lever=study.torque_of(assembly, driver.name, 1.0).torque,
            in_time=study.in_time(judged[0], in_time, progress) if in_time else (),
            over_force=study.over_force(judged[0], forces, progress) if forces else (),
            runs=tuple(speed_run(judged[0], ramp, progress) for ramp in ramps),
        )
        cautions = [*unit_slips(assembly), *assembly.cautions]
        if assembly.train.planetary:
            cautions.append("teeth of planets are springs that never part")
        cautions += _beside_torque(assembly, mean_force)
        return nonlinear_sheet(result, assembly, cautions, units_named(run.units))

    present(solve, run, out)


def _beside_torque(assembly: Assembly, mean_force: str | None) -> list[str]:
    """Return cautions on further loads in a loop of meshes, which divide the torque differently."""
    point, looped = assembly.train.point, None in assembly.train.flows.values()
    if not looped or mean_force is not None or point is None or not (point.weight or point.force):
        return []
    return [
        "weight and forces on shafts, which change the force of each mesh in a loop, are left "
        "out; run solidgear deflect"
    ]


def _usual(assembly: Assembly) -> list[tuple[str, ...]]:
    """Return the models compared by default; shafts in a housing cannot be lumped."""
    usual = ("timoshenko",) if assembly.train.housed else ("lumped", "timoshenko")
    return [(model,) * len(assembly.train.shafts) for model in usual]


def _with_teeth(
    assembly: Assembly, driver: Pair, backlash: str | None, error: str | None
) -> Assembly:
    """Return the same train with the given teeth of one mesh."""
    width, size = _read("--backlash", backlash, "length"), _read("--error", error, "length")
    if width is None and size is None:
        return assembly
    for option, value, text in (("--backlash", width, backlash), ("--error", size, error)):
        if value is not None and value < 0:
            raise SolidgearError(f"{option} {show(text, 40)}: it must not be negative")
    changes: dict[str, Any] = {} if width is None else {"backlash": width}
    if size is not None:
        changes["transmission_error"] = size
    meshes = [
        pair.mesh.with_changes(**changes) if pair.name == driver.name else pair.mesh
        for pair in assembly.train.pairs
    ]
    return assembly.with_train(assembly.train.with_changes(meshes=tuple(meshes)))


def _read(option: str, text: str | None, dimension: str) -> float | None:
    """Return a quantity of an option in SI."""
    if text is None:
        return None
    try:
        return quantity(text, dimension)
    except SceneError as error:
        raise SolidgearError(f"{option} {show(text, 40)}: {error}") from None
