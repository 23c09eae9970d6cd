"""Commands on a train, two shafts that mesh: system-modes, response."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from solidgear.cli.app import FIDELITY, JsonFlag, command, console
from solidgear.errors import SceneError, SolidgearError, show
from solidgear.fidelity.ladder import LADDER

TrainFile = Annotated[
    Path, typer.Argument(help="Train file (TOML), such as geometry/axle_overhung.toml.")
]
RUNGS = (
    f"{', '.join(LADDER.bodies)}, rigid, lumped, lumped-bending, lumped-matched, "
    "lumped-old; a lumped one may name its body, lumped/euler."
)
PinionRung = Annotated[str, typer.Option("--pinion", help=f"Model of the pinion's shaft: {RUNGS}")]
GearRung = Annotated[str, typer.Option("--gear", help="Model of the gear's shaft, as --pinion.")]
Reduction = Annotated[
    str, typer.Option("--reduction", help="rubin (free modes and residuals) or craig_bampton.")
]
MaxFrequency = Annotated[float | None, typer.Option(help="Hz; as the file says by default.")]
Kept = Annotated[int, typer.Option("--kept", help="Modes of each shaft kept in its reduction.")]
MOST_KEPT = 200
#: relative; no frequency is printed with a smaller bound, whatever the proof says
ROUNDING = 1e-12


def workshop(path: Path, reduction: str, kept: int, max_frequency: float | None):
    """Where the bodies of a train are built, once the options that all commands share are sound."""
    from solidgear.scene.toml_file import parse
    from solidgear.scene.train_file import load_train
    from solidgear.studies.axle.models import Workshop

    if not 1 <= kept <= MOST_KEPT:
        raise SolidgearError(f"--kept {show(kept)}: give 1 to {MOST_KEPT} modes")
    if max_frequency is not None and not max_frequency > 0:
        raise SolidgearError(f"--max-frequency {max_frequency:g}: must be greater than zero, in Hz")
    loaded = load_train(path)
    try:
        return Workshop(loaded, reduction, kept)
    except SceneError as error:  # what the mesh of a sound file cannot be
        raise error.located(parse(str(path)), where=str(path)) from None


@command
def system_modes(
    train: TrainFile,
    pinion: PinionRung = FIDELITY,
    gear: GearRung = FIDELITY,
    max_frequency: MaxFrequency = None,
    reduction: Reduction = "rubin",
    kept: Kept = 24,
    as_json: JsonFlag = False,
) -> None:
    """Natural frequencies of a geared rotor system, each with its name and its proven bound."""
    from solidgear.studies.axle.modes import train_modes

    shop = workshop(train, reduction, kept, max_frequency)
    found = train_modes(shop, pinion, gear, max_frequency)
    if as_json:
        print(json.dumps(found.as_dict(), allow_nan=False))
        return
    say(*found.heading())
    console().print(_modes_table(found))
    say(*found.remarks())


def say(*sentences: str) -> None:
    terminal = console()
    for sentence in sentences:
        terminal.print(sentence, markup=False, soft_wrap=True)


def caution(text: str) -> str:
    return f"caution: {text}"


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


@command
def response(
    train: TrainFile,
    out: Annotated[
        Path, typer.Option("--out", "-o", help="Folder for response.csv and its chart.")
    ] = Path("out"),
    pinion: PinionRung = FIDELITY,
    gear: GearRung = FIDELITY,
    against: Annotated[
        list[str] | None,
        typer.Option(
            "--against",
            help="Further model to draw, as PINION+GEAR, such as euler+euler; repeatable.",
        ),
    ] = None,
    max_frequency: MaxFrequency = None,
    damping: Annotated[
        str,
        typer.Option(
            help="hysteretic, viscous (with --matched-at), modal, or literal (C = zeta K)."
        ),
    ] = "hysteretic",
    matched_at: Annotated[
        float | None, typer.Option("--matched-at", help="Hz at which viscous losses match.")
    ] = None,
    force: Annotated[
        list[str] | None,
        typer.Option(
            "--force",
            help="Force on a port instead of the transmission error, such as gear.gear:z=100 in N; repeatable.",
        ),
    ] = None,
    reduction: Reduction = "rubin",
    kept: Kept = 24,
    as_json: JsonFlag = False,
) -> None:
    """Steady response to the transmission error: mesh force, reactions, motions, and a chart."""
    from solidgear.report.folder import held
    from solidgear.report.train_files import write_response
    from solidgear.studies.axle.modes import unpublished_lines
    from solidgear.studies.axle.respond import respond

    shop = workshop(train, reduction, kept, max_frequency)
    mixes = [(pinion, gear), *map(mix, against or [])]
    forces = _forces(force)
    with held(out):
        found = [
            respond(shop, *pair, max_frequency, damping, matched_at or 0.0, forces)
            for pair in mixes
        ]
        unpublished = shop.train.unpublished()
        notes = {"damping": damping, "unpublished": unpublished, "cautions": found[0].cautions}
        title = shop.train.title or shop.train.name
        teeth, band = shop.train.pinion.teeth, shop.train.ask.decibels
        files = write_response(out, found, title, teeth, band, notes)
    if as_json:
        print((out / "response.json").read_text(encoding="utf-8"))
        return
    terminal = console()
    terminal.print(f"{title}: pinion {pinion}, gear {gear}, {damping} losses", markup=False)
    terminal.print(_peaks_table(found[0], teeth))
    if not found[0].peaks:
        terminal.print("The mesh force has no peak in this range.", markup=False)
    say(*unpublished_lines(unpublished), *map(caution, found[0].cautions))
    say(f"Written: {', '.join(map(str, files))}")


def mix(text: str) -> tuple[str, str]:
    pinion, plus, gear = text.partition("+")
    if not plus:
        raise SolidgearError(f"--against {show(text, 40)}: write PINION+GEAR, such as euler+euler")
    return pinion.strip(), gear.strip()


def _forces(texts: list[str] | None) -> dict:
    """Six components at ports, from texts such as ``gear.gear:z=100``."""
    from solidgear.frames import DOF_NAMES

    out: dict = {}
    for text in texts or []:
        port, _, rest = text.partition(":")
        dof, _, value = rest.partition("=")
        try:
            number = float(value)
        except ValueError:
            number = float("nan")
        if dof not in DOF_NAMES or not abs(number) < float("inf"):
            raise SolidgearError(
                f"--force {show(text, 40)}: write PORT:COMPONENT=VALUE, such as gear.gear:z=100; "
                f"components are {' '.join(DOF_NAMES)}"
            )
        out.setdefault(port, [0.0] * 6)[DOF_NAMES.index(dof)] += number
    return out


def _peaks_table(found, teeth: int):
    from rich.table import Table

    table = Table(title="Peaks of the mesh force", title_justify="left", show_edge=False)
    table.add_column("mode")
    for head in ("Hz", "pinion rpm", "mesh force N"):
        table.add_column(head, justify="right")
    for peak in found.peaks:
        hz = peak.frequency_hz
        table.add_row(peak.mode, f"{hz:.1f}", f"{60 * hz / teeth:.0f}", f"{peak.force:.1f}")
    return table
