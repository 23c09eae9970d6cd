"""The command response: steady motion of a train by the transmission error."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import DOF_NAMES, SolidgearError, show
from solidgear.show.command import caution, command, say
from solidgear.show.folder import held
from solidgear.show.options import Shown
from solidgear.show.units import units_named
from solidgear.trains.assembly.orders import order_map
from solidgear.trains.assembly.shaft import mix_label
from solidgear.trains.assembly.slips import unit_slips
from solidgear.trains.judge.comparison import train_data
from solidgear.trains.modes.modes import train_modes, unpublished_lines
from solidgear.trains.options import Driven, Reduced, TrainFile
from solidgear.trains.page.files import write_response
from solidgear.trains.page.tables import peaks
from solidgear.trains.response.loudest import loudest
from solidgear.trains.response.respond import respond
from solidgear.trains.response.speed_command import Speed, say_at_speed


@command
def response(
    train: TrainFile,
    *,
    out: Annotated[
        Path, typer.Option("--out", "-o", help="Folder for response.csv and its chart.")
    ] = Path("out"),
    driven: Driven,
    force: Annotated[
        list[str] | None,
        typer.Option(
            "--force",
            help="Force on a port instead of the transmission error, such as gear.gear:z=100 in N; repeatable.",
        ),
    ] = None,
    orders: Annotated[
        int | None,
        typer.Option(
            "--orders", help="Number of orders of the mesh in orders.png; 3, or as many as given."
        ),
    ] = None,
    at: Speed,
    reduced: Reduced,
    run: Shown,
) -> None:
    assembly = driven.assembly(reduced, train)
    orders_asked = at.asked(assembly.train)
    mixes, driver = driven.mixes(assembly.train), assembly.train.named_mesh(driven.mesh)
    how = {"highest_hz": reduced.max_frequency, "mesh": driver.name, **driven.losses}
    forces = _forces(force)
    with held(out):
        turns = orders_asked.turns or None
        responses = [respond(assembly, *mix, forces=forces, turns=turns, **how) for mix in mixes]
        unpublished = assembly.train.unpublished()
        warnings = unit_slips(assembly)
        cautions = [*warnings, *responses[0].cautions]
        notes: dict = {"damping": driven.damping, "unpublished": unpublished, "cautions": cautions}
        title, band = assembly.train.called, assembly.train.ask.decibels
        if driver.label and not forces:
            title += f", driven by the {driver.name}"
        teeth = assembly.train.per_turn(driver)
        # a force on a port has no order of the mesh
        lines = None if forces else order_map(assembly, *mixes[0], mesh_orders=orders, **how)
        limit = reduced.max_frequency
        modes = (
            lines.modes if lines else train_modes(assembly, *mixes[0], max_frequency=limit).modes
        )
        at_speed, description = orders_asked.found(modes), train_data(assembly)
        top = loudest(responses[0], modes, assembly.train, assembly.scenes, not forces, driver.name)
        notes |= {"loudest": top.as_dict()}
        files = write_response(
            out, responses, title, teeth, band, notes, lines, description, run.units, at_speed
        )
    if run.as_json:
        print((out / "response.json").read_text(encoding="utf-8"))
        return
    say(
        f"{title}: {mix_label(responses[0].models)}, {driven.damping} losses",
        soft_wrap=False,
    )
    say(*top.sentences(), *map(caution, warnings))
    print_peaks(responses[0].peaks, "mesh force", "N", teeth, run.units)
    if at_speed is not None:
        say_at_speed(at_speed)
    say(*unpublished_lines(unpublished), *map(caution, responses[0].cautions))
    say(f"Written: {', '.join(map(str, files))}")


def _forces(texts: list[str] | None) -> dict:
    """Return six components at ports, from texts such as ``gear.gear:z=100``."""
    out: dict = {}
    for text in texts or []:
        end, _, value = text.partition("=")
        try:
            number = float(value)
        except ValueError:
            number = float("nan")
        if not abs(number) < float("inf"):
            raise SolidgearError(
                f"--force {show(text, 40)}: write PORT:COMPONENT=VALUE, such as gear.gear:z=100"
            )
        port, dof = end_of("--force", end, "=100")
        out.setdefault(port, [0.0] * 6)[DOF_NAMES.index(dof)] += number
    return out


def end_of(option: str, text: str, more: str = "") -> tuple[str, str]:
    """Read port and component from a text such as ``gear.gear:z``; `more` completes the example in
    an error.
    """
    port, _, dof = text.partition(":")
    if not port or dof not in DOF_NAMES:
        raise SolidgearError(
            f"{option} {show(text, 40)}: write PORT:COMPONENT{'=VALUE' if more else ''}, such as "
            f"gear.gear:z{more}; components are {' '.join(DOF_NAMES)}"
        )
    return port, dof


def print_peaks(responses, name: str, si: str, teeth: float, units: str) -> None:
    """Print peaks (Hz, size in an SI unit, mode), or that there is none."""
    table = peaks(responses, name, si, teeth, units_named(units))
    say(table if table else f"{table.title}: none in this range.", soft_wrap=False)
