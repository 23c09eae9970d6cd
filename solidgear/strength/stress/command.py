"""The command stress: section forces of shafts, and the stress on their fillets."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

from solidgear.core import SceneError, SolidgearError
from solidgear.show.command import Group, command
from solidgear.show.options import BY_MODEL, Choice, Shown, relative
from solidgear.show.sheet import present
from solidgear.strength.acting import Acting, AtRestFile
from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.study import stress as stressed

if TYPE_CHECKING:
    Hours: TypeAlias = str | float | None
else:
    Hours = str | None


@dataclass(frozen=True)
class Rated(Group):
    """Data that a rating by DIN 743 needs beyond the file; what is not given is assumed."""

    roughness: Annotated[
        str | None,
        typer.Option(help='Roughness Rz of the notches, such as "6.3 um"; else K_F is 1.'),
    ] = None
    ultimate_at_size: Annotated[
        float | None,
        typer.Option(
            help="K_1 of the tensile strength, by the size of the part; else by the group of the "
            "steel, or 1."
        ),
    ] = None
    yield_at_size: Annotated[
        float | None,
        typer.Option(
            help="K_1 of the yield point, by the size of the part; else by the group of the steel, "
            "or 1."
        ),
    ] = None
    treated_diameter: Annotated[
        str | None,
        typer.Option(
            help='Diameter of heat treatment for K_1, such as "80 mm"; else the largest of the '
            "shaft."
        ),
    ] = None
    hardening: Annotated[
        float | None, typer.Option(help="K_V of a hardened or rolled surface; else 1.")
    ] = None
    hard_surface: Annotated[
        bool, typer.Option("--hard-surface", help="The surface is case-hardened or nitrided.")
    ] = False
    surface_strength: Annotated[
        str | None,
        typer.Option(help="Tensile strength of a hard surface, for the safety of a first crack."),
    ] = None
    force_share: Annotated[
        float | None, typer.Option(help="Amplitude of the axial force over its mean; else 0.")
    ] = None
    torque_share: Annotated[
        float | None, typer.Option(help="Amplitude of the torque over its mean; else 0.")
    ] = None
    bending_share: Annotated[
        float | None,
        typer.Option(
            help="Amplitude of bending over its mean, of a shaft that does not turn; else bending "
            "is all amplitude."
        ),
    ] = None
    overload: Annotated[
        float | None,
        typer.Option(help="Largest load over the load, for yielding and first cracks; else 1."),
    ] = None
    constant_mean: Annotated[
        bool,
        typer.Option(
            "--constant-mean",
            help="Mean stress stays as loads grow (case 1 of the norm); by default it grows (case "
            "2).",
        ),
    ] = False

    cycles: Annotated[
        float | None, typer.Option(help="Cycles of the load, for a finite life; else endless.")
    ] = None
    spectrum: Annotated[
        str | None,
        typer.Option(
            help='Factors of the load with their cycles, such as "1:2e4, 0.7:1e6"; Miner\'s '
            "consequent rule."
        ),
    ] = None
    hours: Annotated[
        Hours,
        typer.Option(
            help='Life of a duty table with shares of the time, such as 20000 (hours) or "2 years".'
        ),
    ] = None
    damage_sum: Annotated[
        float | None, typer.Option(help="Sum of damage that a spectrum bears; else 0.3.")
    ] = None

    def conditions(self) -> Conditions:
        """Return the options read as conditions of a rating; refuse one that cannot be read."""
        values = {f.name: getattr(self, f.name) for f in fields(self)}
        with suppress(TypeError, ValueError):  # a text with a unit stays one
            values["hours"] = float(values["hours"])
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
    fidelity: Annotated[
        Choice | None,
        typer.Option(
            *BY_MODEL,
            help="Model for bearing reactions; by default the cheapest solid that models all of a "
            "shaft, or none where they follow from statics.",
        ),
    ] = None,
    tol: Annotated[
        float,
        relative("--tol", "Error bar allowed for a form factor."),
    ] = 0.01,
    local: Annotated[
        float | None,
        relative("--local", "Solve 3D solids at keyways and cross holes, to this error bar."),
    ] = None,
    duty: Annotated[
        bool,
        typer.Option(
            "--duty", help="Rate over all cases or operating points, by share or hours and speed."
        ),
    ] = False,
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
            str(fidelity or ""),
            **vars(acting),
            tol=tol,
            local=local,
            conditions=rated.conditions(),
            duty=duty,
            progress=progress,
        ).sheet(run.units),
        run,
        out,
    )
