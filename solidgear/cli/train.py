"""Commands on a train, two shafts that mesh: system-modes, response."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from solidgear.cli.app import Group, caution, command, say
from solidgear.cli.at_speed import Speed, say_at_speed
from solidgear.cli.shaft_settings import ShaftSettings, of_shafts
from solidgear.cli.shared import MODEL, UNITS, Shown
from solidgear.errors import SceneError, SolidgearError, show
from solidgear.ladder.registry import LADDER

if TYPE_CHECKING:
    from solidgear.studies.train.models import Workshop

TrainFile = Annotated[
    Path, typer.Argument(help="Train file (TOML), such as geometry/axle_overhung.toml.")
]
MODELS = (
    f"{', '.join(LADDER.bodies)}, rigid, lumped, lumped-bending, lumped-matched, "
    "lumped-old; a lumped one may name its body, lumped/euler."
)
MOST_KEPT = 200


@dataclass(frozen=True)
class Reduced(Group):
    """Options of every command on a train: how its shafts are reduced, and up to which frequency."""

    max_frequency: Annotated[
        float | None, typer.Option(help="Hz; as the file says by default.")
    ] = None
    reduction: Annotated[
        str,
        typer.Option("--reduction", help="rubin (free modes and residuals) or craig_bampton."),
    ] = "rubin"
    kept: Annotated[
        int, typer.Option("--kept", help="Modes of each shaft kept in its reduction.")
    ] = 24
    local_harmonics: Annotated[
        str | None,
        typer.Option(
            "--local-harmonics",
            help="Harmonics n >= 2 of harmonic solids that the teeth drive where they touch, such as "
            "2,3; by default as local_harmonics in the table mesh of the file says.",
        ),
    ] = None
    point: Annotated[
        str | None,
        typer.Option(
            "--point",
            help="Operating point, by its name or number in the file; the first by default.",
        ),
    ] = None

    def workshop(
        self, path: Path, settings: Mapping[str | tuple[str, str], Mapping] | None = None
    ) -> Workshop:
        """Workshop of a train, once these options are sound, with builder options by side and model."""
        from solidgear.scene.toml_file import parse
        from solidgear.studies.loading import load_train
        from solidgear.studies.train.models import Workshop

        if not 1 <= self.kept <= MOST_KEPT:
            raise SolidgearError(f"--kept {show(self.kept)}: give 1 to {MOST_KEPT} modes")
        if self.max_frequency is not None and not self.max_frequency > 0:
            raise SolidgearError(
                f"--max-frequency {self.max_frequency:g}: must be greater than zero, in Hz"
            )
        loaded = load_train(path)
        if self.point is not None:
            from solidgear.studies.train.operation import at_point

            loaded = at_point(loaded, self.point)
        if self.local_harmonics is not None:
            mesh = loaded.mesh.with_changes(local_harmonics=_harmonics(self.local_harmonics))
            loaded = loaded.with_changes(mesh=mesh)
        try:
            return Workshop(loaded, self.reduction, self.kept, settings or {})
        except SceneError as error:  # what the mesh of a sound file cannot be
            raise error.located(parse(str(path)), where=str(path)) from None


@dataclass(frozen=True)
class Mix(Group):
    """Models of the two shafts."""

    pinion: Annotated[
        str, typer.Option("--pinion", help=f"Model of the pinion's shaft: {MODELS}")
    ] = MODEL
    gear: Annotated[str, typer.Option("--gear", help="Model of the gear's shaft, as --pinion.")] = (
        MODEL
    )
    settings: ShaftSettings = None

    @property
    def of_shafts(self) -> dict[str | tuple[str, str], dict[str, Any]]:
        """Builder options by side and model."""
        return of_shafts(self.settings, self.pinion, self.gear)


@dataclass(frozen=True)
class Driven(Mix):
    """Options of every command on steady motion: losses, and models to draw as well."""

    against: Annotated[
        list[str] | None,
        typer.Option(
            "--against",
            help="Further model to draw, as PINION+GEAR, such as euler+euler; repeatable.",
        ),
    ] = None
    damping: Annotated[
        str,
        typer.Option(
            help="hysteretic, viscous (with --matched-at), modal, or literal (C = zeta K)."
        ),
    ] = "hysteretic"
    matched_at: Annotated[
        float | None, typer.Option("--matched-at", help="Hz at which viscous losses match.")
    ] = None

    @property
    def mixes(self) -> list[tuple[str, str]]:
        """Models of pinion and gear, the first those that are told."""
        return [(self.pinion, self.gear), *map(mix, self.against or [])]

    @property
    def losses(self) -> tuple[str, float]:
        """Their kind, and the Hz at which viscous ones match."""
        return self.damping, self.matched_at or 0.0


def refuse_given(given: dict[str, bool], train: Path, instead: str) -> None:
    """Refuse options that speak of one shaft.

    Parameters
    ----------
    given : dict of str to bool
        Such options, and whether they were given.
    train : Path
    instead : str
        What to do for a train, in words.

    Raises
    ------
    SolidgearError
    """
    for option, there in given.items():
        if there:
            raise SolidgearError(f"{option} is for one shaft, and {train} is a train: {instead}")


def _harmonics(text: str) -> tuple[int, ...]:
    """Numbers of waves from a text such as ``2,3``."""
    from solidgear.scene.train_tables import FIRST_HARMONIC, LAST_HARMONIC

    try:
        found = tuple(int(word) for word in text.split(",") if word.strip())
    except ValueError:
        found = ()
    sound = all(FIRST_HARMONIC <= n <= LAST_HARMONIC for n in found)
    if not found or not sound or len(set(found)) < len(found):
        raise SolidgearError(
            f"--local-harmonics {show(text, 40)}: write whole numbers from {FIRST_HARMONIC} to "
            f"{LAST_HARMONIC}, each once, such as 2,3"
        )
    return found


@command
def system_modes(
    train: TrainFile,
    *,
    models: Mix,
    pictures: Annotated[
        Path | None,
        typer.Option("--pictures", help="Folder for a picture a mode, both shafts in place."),
    ] = None,
    mode: Annotated[
        list[int] | None,
        typer.Option("--mode", help="Only draw this one, counted from 1 as listed; repeatable."),
    ] = None,
    turn: Annotated[
        Path | None,
        typer.Option(help="HTML file: all modes of both shafts in 3D, to be turned and animated."),
    ] = None,
    reduced: Reduced,
    run: Shown,
) -> None:
    """Natural frequencies of a geared rotor system, each with its name and its proven bound."""
    from solidgear.report.train_tables import modes
    from solidgear.studies.train.modes import train_modes
    from solidgear.studies.train.slips import slips

    shop = reduced.workshop(train, models.of_shafts)
    if mode and pictures is None:
        raise SolidgearError("--mode says which mode to draw; add --pictures and a folder")
    said = slips(shop)
    pair = models.pinion, models.gear
    found = train_modes(shop, *pair, reduced.max_frequency)
    if run.units != UNITS and turn is None:
        raise SolidgearError(
            f"--units {run.units}: the table has Hz and rpm alone; add --turn model.html, whose page "
            "shows the train in these units"
        )
    drawn = _drawn(shop, *pair, pictures, mode, found) if pictures else []
    if turn is not None:
        drawn += _turned(shop, found, turn, reduced.max_frequency, run.units, said)
    if run.as_json:
        cautions = {"cautions": [*said, *found.cautions]}
        print(json.dumps(found.as_dict() | cautions, allow_nan=False))
        return
    say(*found.heading(), *map(caution, said))
    say(modes(found.as_dict(), numbered=True), *found.remarks(), *drawn)


def _drawn(shop, pinion: str, gear: str, folder: Path, numbers: list[int] | None, found):
    """Pictures of modes, and what is to be said of them."""
    from solidgear.studies.train.pictures import draw_modes

    listed = [n for n, mode in enumerate(found.modes, start=1) if mode.frequency_hz > 0]
    done = draw_modes(shop, pinion, gear, folder, numbers or listed).values()
    written = [str(one.path) for one in done if one.ok]
    lines = [f"Written: {', '.join(written)}"] if written else []
    return lines + sorted({one.reason for one in done if not one.ok})


def _turned(
    shop, found, path: Path, max_frequency: float | None, units: str, slips: tuple[str, ...]
) -> list[str]:
    """Write the page in which modes can be turned; what is to be said of it."""
    from solidgear.report import train_tables
    from solidgear.report.train_sheet import write_sheet
    from solidgear.report.units import units_named
    from solidgear.report.viewer import viewer_fragment
    from solidgear.studies.train.comparison import described
    from solidgear.studies.train.pictures import still_of, turned_modes

    models = turned_modes(shop, found.pinion, found.gear, max_frequency)
    names = [mode.name for mode in found.modes]
    elastic = [shape.name for shape in models.shapes]
    first = next((name for name in elastic if "bending" in name), elastic[0])
    still, said = still_of(shop, found.pinion, found.gear, names.index(first) + 1)
    write_sheet(
        path,
        found.train,
        f"Natural frequencies and mode shapes: pinion {found.pinion}, gear {found.gear}.",
        [
            train_tables.modes(found.as_dict(), "Natural frequencies"),
            train_tables.facts(described(shop), units_named(units)),
        ],
        viewer=viewer_fragment([models], still=still, first=first),
        notes=found.notes(),
        cautions=[*slips, *found.cautions],
    )
    return [*filter(None, [said]), f"Written: {path}"]


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
        typer.Option("--orders", help="Orders of the mesh in orders.png; 3, or as many as given."),
    ] = None,
    at: Speed,
    reduced: Reduced,
    run: Shown,
) -> None:
    """Steady response to the transmission error: mesh force, reactions, motions, and a chart."""
    from solidgear.report.folder import held
    from solidgear.report.train_files import write_response
    from solidgear.studies.train.comparison import described
    from solidgear.studies.train.modes import train_modes, unpublished_lines
    from solidgear.studies.train.orders import order_map
    from solidgear.studies.train.respond import respond
    from solidgear.studies.train.slips import slips

    shop = reduced.workshop(train, driven.of_shafts)
    asked = at.asked(shop.train)
    highest, losses = reduced.max_frequency, driven.losses
    forces = _forces(force)
    with held(out):
        found = [respond(shop, *pair, highest, *losses, forces) for pair in driven.mixes]
        unpublished = shop.train.unpublished()
        said = slips(shop)
        cautions = [*said, *found[0].cautions]
        notes = {"damping": driven.damping, "unpublished": unpublished, "cautions": cautions}
        title = shop.train.called
        teeth, band = shop.train.pinion.teeth, shop.train.ask.decibels
        # a force on a port has no order of the mesh
        lines = None if forces else order_map(shop, *driven.mixes[0], highest, *losses, orders)
        modes = lines.modes if lines else train_modes(shop, *driven.mixes[0], highest).modes
        there, told = asked.found(modes), described(shop)
        files = write_response(out, found, title, teeth, band, notes, lines, told, run.units, there)
    if run.as_json:
        print((out / "response.json").read_text(encoding="utf-8"))
        return
    say(
        f"{title}: pinion {driven.pinion}, gear {driven.gear}, {driven.damping} losses",
        soft_wrap=False,
    )
    say(*map(caution, said))
    tops = [(p.frequency_hz, p.force, p.mode) for p in found[0].peaks]
    print_peaks(tops, "mesh force", "N", teeth, run.units)
    if there is not None:
        say_at_speed(there)
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
    """Port and component, from a text such as ``gear.gear:z``; what else follows is part of the
    example in an error.
    """
    from solidgear.frames import DOF_NAMES

    port, _, dof = text.partition(":")
    if not port or dof not in DOF_NAMES:
        raise SolidgearError(
            f"{option} {show(text, 40)}: write PORT:COMPONENT{'=VALUE' * bool(more)}, such as "
            f"gear.gear:z{more}; components are {' '.join(DOF_NAMES)}"
        )
    return port, dof


def print_peaks(found, what: str, si: str, teeth: int, units: str) -> None:
    """Print peaks (Hz, size in an SI unit, mode), or that there is none."""
    from solidgear.report.train_tables import peaks
    from solidgear.report.units import units_named

    told = peaks(found, what, si, teeth, units_named(units))
    say(told if told else f"{told.title}: none in this range.", soft_wrap=False)
