"""The command stress: section forces of shafts, and the stress on their fillets."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import SceneError, SolidgearError, show
from solidgear.core.scene.units import quantity
from solidgear.show.command import Group, command
from solidgear.show.options import BY_MODEL, MODEL, Choice, Shown, relative
from solidgear.show.sheet import present
from solidgear.strength.acting import Acting, AtRestFile
from solidgear.strength.stress.rating import Conditions
from solidgear.strength.stress.study import stress as stressed


@dataclass(frozen=True)
class Rated(Group):
    """Data that a rating by DIN 743 needs beyond the file; what is not given is assumed."""

    roughness: Annotated[
        str | None,
        typer.Option(help='Roughness Rz of the fillets, such as "6.3 um"; else K_F is 1.'),
    ] = None
    ultimate_at_size: Annotated[
        float | None,
        typer.Option(help="K_1 of the tensile strength, by the size of the part; else 1."),
    ] = None
    yield_at_size: Annotated[
        float | None, typer.Option(help="K_1 of the yield point, by the size of the part; else 1.")
    ] = None
    hardening: Annotated[
        float | None, typer.Option(help="K_V of a hardened or rolled surface; else 1.")
    ] = None
    force_share: Annotated[
        float | None, typer.Option(help="Amplitude of the axial force over its mean; else 0.")
    ] = None
    torque_share: Annotated[
        float | None, typer.Option(help="Amplitude of the torque over its mean; else 0.")
    ] = None
    constant_mean: Annotated[
        bool,
        typer.Option(
            "--constant-mean",
            help="Mean stress stays as loads grow (case 1 of the norm); by default it grows (case "
            "2).",
        ),
    ] = False

    def conditions(self) -> Conditions:
        """Return the options read as conditions of a rating; refuse one that cannot be read."""
        values = {f.name: getattr(self, f.name) for f in fields(self)}
        try:
            return Conditions(**{name: v for name, v in values.items() if v is not None})
        except SceneError as error:
            first = error.problems[0]
            option = f"--{str(first.path[0]).replace('_', '-')}"
            raise SolidgearError(f"{option} {first.value}: {first.reason}") from None


@command
def stress(
    file: AtRestFile,
    *,
    acting: Acting,
    drive: Annotated[
        list[str] | None,
        typer.Option(
            help='Torque that enters a shaft at a bearing, mass or point, such as "B=115 N*m", and '
            "leaves at the port; repeatable."
        ),
    ] = None,
    fidelity: Annotated[
        Choice, typer.Option(*BY_MODEL, help="Model for bearing reactions.")
    ] = MODEL,
    tol: Annotated[
        float,
        relative("--tol", "Error bar allowed for a form factor."),
    ] = 0.01,
    local: Annotated[
        float | None,
        relative("--local", "Solve 3D solids at keyways and cross holes, to this error bar."),
    ] = None,
    rated: Rated,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for a page, section forces and their charts."),
    ] = None,
    run: Shown,
) -> None:
    present(
        lambda progress: stressed(
            file,
            str(fidelity),
            **vars(acting),
            drive=dict(map(_torque, drive or ())),
            tol=tol,
            local=local,
            conditions=rated.conditions(),
            progress=progress,
        ).sheet(run.units),
        run,
        out,
    )


def _torque(text: str) -> tuple[str, float]:
    """Return the name and torque, N m, from ``B=115 N*m``."""
    name, sep, value = (part.strip() for part in text.partition("="))
    if not sep or not name:
        raise SolidgearError(f'--drive {show(text)}: write NAME=TORQUE, such as "B=115 N*m"')
    try:
        return name, quantity(value, "torque")
    except SceneError as error:
        raise SolidgearError(f"--drive {show(text)}: {error}") from None
