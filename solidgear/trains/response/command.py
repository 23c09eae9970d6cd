"""The commands response and receptance: steady motion of a train, by its transmission error or by a
force on a port."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, pi
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from solidgear.core import DOF_NAMES, SceneError, SolidgearError, show
from solidgear.core.scene.units import quantity
from solidgear.show.command import Group, Progress, command
from solidgear.show.options import Shown
from solidgear.show.sheet import Sheet, present
from solidgear.show.units import units_named
from solidgear.trains.assembly.orders import order_map
from solidgear.trains.file.train import Train
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.options import Driven, Reduced, TrainFile
from solidgear.trains.response.at_speed import NEAR, at_speed, refuse_share, turns_of_pinion
from solidgear.trains.response.loudest import loudest
from solidgear.trains.response.receptance import End
from solidgear.trains.response.receptance import receptance as between
from solidgear.trains.response.respond import respond
from solidgear.trains.response.sheet import Responses, receptance_sheet, response_sheet
from solidgear.trains.response.spectrum import Spectrum, read_spectrum

END = "as PORT:COMPONENT, such as gear.gear:z, in the axes of the port's own shaft."


@dataclass(frozen=True)
class Speed(Group):
    """Options of `response` that speak of one speed."""

    speed: Annotated[
        str | None,
        typer.Option(
            "--speed",
            help='Speed such as "3000 rpm": orders of shafts, mesh and catalogue bearings in Hz, '
            "and those near natural frequencies. By default the operating point's speed.",
        ),
    ] = None
    of: Annotated[
        str | None,
        typer.Option(
            "--of", help="Shaft of --speed: pinion or gear; by default the engine's shaft."
        ),
    ] = None
    measured: Annotated[
        Path | None,
        typer.Option(
            "--measured",
            help="Spectrum at this speed (CSV: frequency in Hz, amplitude), drawn over the "
            "computed mesh force; every peak is listed with its order.",
        ),
    ] = None
    fit_speed: Annotated[
        float | None,
        typer.Option(
            "--fit-speed",
            help="Fit the speed within this share, such as 0.03, to the mesh order in the spectrum.",
        ),
    ] = None
    within: Annotated[
        float | None,
        typer.Option(
            "--within", help="Share of a natural frequency within which an order is listed; 0.05."
        ),
    ] = None

    def turns(self, train: Train) -> tuple[float, str]:
        """Return turns of the engine's shaft in a second, and their origin in words; zero without a
        speed.
        """
        reference, point = train.reference, train.point
        if self.speed is not None:
            shaft = self.of or reference
            turns, origin = _turns(train, self.speed, shaft), f"{self.speed} of the {shaft}"
            if shaft != reference:
                origin += f", {60 * turns:.6g} rpm of the {reference}"
            return turns, origin
        if point is not None and point.speed:
            return (point.speed_of(reference, train.turns) or 0.0) / (2 * pi), point.label
        needing = {"--measured": self.measured, "--within": self.within, "--of": self.of}
        for option, value in needing.items():
            if value is not None:
                raise SolidgearError(f'{option} needs a speed; add --speed "3000 rpm"')
        return 0.0, ""

    def spectrum(self) -> Spectrum | None:
        """Read the measured spectrum, once shares are between 0 and 1."""
        refuse_share("--within", self.within)
        refuse_share("--fit-speed", self.fit_speed)
        if self.fit_speed is not None and self.measured is None:
            raise SolidgearError("--fit-speed needs a spectrum; add --measured spectrum.csv")
        return None if self.measured is None else read_spectrum(self.measured)


def _turns(train: Train, text: str, shaft: str) -> float:
    try:
        speed = quantity(text, "speed")
    except SceneError:
        raise SolidgearError(
            f'--speed {show(text, 40)}: write a number and a unit, such as "3000 rpm" or '
            '"314 rad/s"'
        ) from None
    try:
        return turns_of_pinion(train, speed, shaft)
    except SolidgearError as error:
        raise SolidgearError(f"--speed {show(text, 40)} --of {show(shaft, 40)}: {error}") from None


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
    together: Annotated[
        bool,
        typer.Option(
            "--together",
            help="Drive by all meshes at the frequencies of the mesh, each at its phase.",
        ),
    ] = False,
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
    (turns, origin), spectrum = at.turns(assembly.train), at.spectrum()
    mixes, driver = driven.mixes(assembly.train), assembly.train.named_mesh(driven.mesh)
    options = {"highest_hz": reduced.max_frequency, "mesh": driver.name, **driven.losses}
    options["together"] = together
    forces = _forces(force)
    if forces and together:
        raise SolidgearError("--together adds up errors of meshes, and --force takes their place")

    def study(progress: Progress) -> Sheet:
        responses = [
            respond(assembly, *mix, forces=forces, turns=turns or None, **options) for mix in mixes
        ]
        # a force on a port has no order of the mesh
        lines = None if forces else order_map(assembly, *mixes[0], mesh_orders=orders, **options)
        limit = reduced.max_frequency
        modes = (lines or train_modes(assembly, *mixes[0], max_frequency=limit)).modes
        within = NEAR if at.within is None else at.within
        speed = None
        if turns:
            speed = at_speed(assembly.train, modes, turns, origin, within, spectrum, at.fit_speed)
        title = assembly.train.called
        if together:
            title += f", driven by all meshes at the frequencies of the {driver.name}"
        elif driver.label and not forces:
            title += f", driven by the {driver.name}"
        result = Responses(
            assembly=assembly,
            title=title,
            teeth=assembly.train.per_turn(driver),
            responses=responses,
            loudest=loudest(
                responses[0], modes, assembly.train, assembly.scenes, not forces, driver.name
            ),
            orders=lines,
            speed=speed,
        )
        return response_sheet(result, units_named(run.units))

    present(study, run, out)


def _forces(texts: list[str] | None) -> dict[str, np.ndarray]:
    """Return six components at ports, from texts such as ``gear.gear:z=100``."""
    out: dict[str, np.ndarray] = {}
    for text in texts or []:
        end, _, value = text.partition("=")
        try:
            number = float(value)
        except ValueError:
            number = float("nan")
        if not isfinite(number):
            raise SolidgearError(
                f"--force {show(text, 40)}: write PORT:COMPONENT=VALUE, such as gear.gear:z=100"
            )
        port, dof = _end("--force", end, "=100")
        out.setdefault(port, np.zeros(6))[DOF_NAMES.index(dof)] += number
    return out


def _end(option: str, text: str, more: str = "") -> End:
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
    begin, end = _end("--from", from_), _end("--to", to)

    def study(progress: Progress) -> Sheet:
        highest, mixes = reduced.max_frequency, driven.mixes(assembly.train)
        receptances = [
            between(assembly, *mix, from_=begin, to=end, highest_hz=highest, **driven.losses)
            for mix in mixes
        ]
        teeth = assembly.train.per_turn(assembly.train.named_mesh(driven.mesh))
        return receptance_sheet(assembly, receptances, teeth, units_named(run.units))

    present(study, run, out)
