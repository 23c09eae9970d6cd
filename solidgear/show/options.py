"""Options that several commands take, in groups.

A command takes a group as one parameter, and every field of the group is one of its options: what
is added to a group, all these commands take.

What is an option of every command, given before it, stands in ``everywhere`` of
:mod:`solidgear.app.application`; that of one command is a parameter of its function.
"""

from __future__ import annotations

import sys
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import typer

from solidgear.core import LADDER, SceneError, SolidgearError, build, show
from solidgear.core.scene.units import quantity
from solidgear.show.command import Group, Progress
from solidgear.show.units import ENGINEERING, SYSTEMS

if TYPE_CHECKING:
    from solidgear.core import Body, Scene, Settled

#: the model that commands solve with unless told otherwise
MODEL = "harmonic"
#: the word for the cheapest mesh that keeps a tolerance, instead of a model
AUTO = "auto"
#: spellings of the option that names a model
BY_MODEL = ("--model", "--fidelity", "-f")
#: units of tables and pages unless told otherwise
UNITS = ENGINEERING.name

SceneFile = Annotated[
    Path,
    typer.Argument(
        help="Scene file (TOML), such as geometry/pinion_overhung.toml; - for standard input."
    ),
]
if TYPE_CHECKING:
    #: of a command a text, of Python also a number
    Named: TypeAlias = str | int | None
else:
    Named = str | None
CaseName = Annotated[
    Named,
    typer.Option(
        "--case", help="Case of the loads of a shaft, by name or number; by default the first."
    ),
]
if TYPE_CHECKING:
    Choice = str
    AutoChoice = str
    UnitsChoice = str
else:
    UnitsChoice = StrEnum("UnitsChoice", [(name, name) for name in SYSTEMS])
    Choice = StrEnum("Choice", [(name, name) for name in LADDER.bodies])
    AutoChoice = StrEnum("AutoChoice", [(name, name) for name in (AUTO, *LADDER.bodies)])


def share(text: str | float) -> float:
    """Read a relative error, as a share or in per cent; defaults are numbers."""
    number = str(text).strip()
    try:
        return float(number.removesuffix("%")) / (100 if number.endswith("%") else 1)
    except ValueError:
        raise typer.BadParameter(
            f'"{text}" is not a number; give a tolerance such as 0.01 or 1%'
        ) from None


def relative(name: str, about: str) -> Any:
    """Return an option that is a relative error."""
    return typer.Option(name, parser=share, metavar="FLOAT", help=about)


Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        help="Builder option as key=value, repeatable: order=8, layers=4, element=tet10; solidgear options lists them.",
    ),
]


@dataclass(frozen=True)
class Run(Group):
    """Options of every command that solves and prints numbers."""

    as_json: Annotated[
        bool,
        typer.Option("--json", help="Print JSON for machines instead of tables; always SI."),
    ] = False

    def progress(self) -> Progress:
        """Print progress on standard error, unless JSON is asked for."""
        return Progress(quiet=self.as_json)


@dataclass(frozen=True)
class Shown(Run):
    """Options of a command whose numbers have other units than Hz."""

    units: Annotated[
        UnitsChoice,
        typer.Option(
            "--units",
            help="Units of tables and pages: "
            + "; ".join(f"{units.name}: {units.about}" for units in SYSTEMS.values())
            + ". JSON is always in SI.",
        ),
    ] = UNITS


@dataclass(frozen=True)
class Fixed(Group):
    """A model and its mesh."""

    name: Annotated[Choice, typer.Option(*BY_MODEL, help="Model to solve with.")] = MODEL
    settings: Settings = None

    def body(self, scene: Scene) -> Body:
        """Return the body of a scene."""
        return build_body(scene, self.name, self.settings)


@dataclass(frozen=True)
class Chosen(Group):
    """A model and its mesh, or the cheapest that keeps a tolerance."""

    name: Annotated[
        AutoChoice,
        typer.Option(
            *BY_MODEL,
            help="Model to solve with; auto: the cheapest whose error bars are within --tol.",
        ),
    ] = AUTO
    tol: Annotated[
        float | None,
        relative(
            "--tol", "Relative error allowed, for -f auto or a 3D model; else the scene's own."
        ),
    ] = None
    settings: Settings = None

    @property
    def pairs(self) -> list[str]:
        """``--set`` options."""
        return self.settings or []

    def automatic(self, scene: Scene | None = None) -> bool:
        """Tell whether the mesh is to be chosen; refuse what does not go together, with a model that
        holds the scene and has the options that are set.

        Raises
        ------
        SolidgearError
            For a tolerance of a fixed model, which must not look as if it kept it, or a mesh that
            is to be chosen and is set as well.
        """
        if self.name != AUTO:
            if self.tol is not None:
                raise SolidgearError(
                    f"--tol {self.tol:g} needs -f auto; the mesh of -f {self.name} is set by --set"
                )
            return False
        settings = options(self.pairs)  # which says so where one is no key=value
        if settings:
            models = (MODEL, *LADDER.holding(scene)) if scene is not None else (MODEL,)
            fit = [m for m in models if scene is None or LADDER[m].can_model(scene)]
            able = [m for m in fit if settings.keys() <= LADDER[m].options.keys()]
            raise SolidgearError(
                f"--set {show(self.pairs[0], 40)} needs a fixed model: add -f "
                f"{(able or fit or [MODEL])[0]}"
            )
        return True


@dataclass(frozen=True)
class Solved(Chosen):
    """Options of a single solution, which may be as large as the machine's memory."""

    engine: Annotated[
        str | None,
        typer.Option(
            "--engine",
            help="Solver of a 3D solid too large for this program: petsc (MUMPS under mpirun) or "
            "petsc-gamg (multigrid, statics only); the same as --set engine=...",
        ),
    ] = None
    bars: Annotated[
        bool,
        typer.Option(
            "--bars/--no-bars",
            help="Error bars of a solid whose mesh is set: of a 3D solid about twice the time.",
        ),
    ] = True

    @property
    def pairs(self) -> list[str]:
        """``--set`` options with ``--engine`` among them."""
        return [*super().pairs, *([] if self.engine is None else [f"engine={self.engine}"])]

    @property
    def refined(self) -> bool:
        """Whether the model is a 3D solid whose mesh is as coarse as the tolerance allows."""
        if self.name == AUTO or self.pairs or not self.bars:
            return False
        return bool(LADDER[self.name].bars_by) and not LADDER[self.name].follows

    def without_bars(self, settled: Settled | None) -> str:
        """Return the reason why numbers have no error bar; empty where they have one."""
        if settled is not None:
            return ""
        if not LADDER[self.name].bars_by:
            return f"the {LADDER[self.name].title} cannot show its own; -f auto has error bars"
        return "" if self.bars else "--no-bars leaves them out"

    def body(
        self, scene: Scene, ask: str, progress: Progress, points: Sequence[str] = ()
    ) -> tuple[Body, Settled | None]:
        """Build the body to solve with, and say how its mesh was chosen.

        Parameters
        ----------
        points : sequence of str
            As for :func:`solidgear.core.judge.settle.settle`.
        """
        if not self.refined and not self.automatic(scene):
            return build_body(scene, self.name, self.pairs), None
        # start-up: for ``auto`` alone
        from solidgear.core import settle
        from solidgear.core.judge.refinement import Interrupted

        # a second or less for most scenes: lines are for those who watch
        watched = progress if sys.stderr.isatty() else Progress(quiet=True)
        only = self.name if self.refined else ""
        try:
            settled = settle(scene, self.tol, ask, points=points, only=only, progress=watched)
        except Interrupted as stop:  # what a coarser mesh gave is shown
            settled = stop.result
        return settled.body, settled


#: what an option of a builder is not
OF_BODIES = "options are of the mesh of a body; an entry of a file varies by --vary of sweep"


def options(pairs: list[str] | None) -> dict:
    """Return the builder options from ``key=value`` texts; numbers as numbers, a list with commas
    as a tuple.
    """
    out: dict = {}
    for pair in pairs or []:
        key, sep, text = pair.partition("=")
        if "." in key:
            raise SolidgearError(f"--set {show(pair)}: {OF_BODIES}")
        if not sep or not key.isidentifier():
            raise SolidgearError(f"--set {show(pair)}: write key=value, such as --set order=8")
        if key in out:
            raise SolidgearError(
                f"--set {show(pair)}: {key} is set twice; set it once, lists with commas such as ovalising=2,3"
            )
        out[key] = tuple(_value(part) for part in text.split(",")) if "," in text else _value(text)
    return out


def options_by_name(
    pairs: list[str] | None, names: Collection[str], what: str, example: str
) -> dict[str, dict]:
    """Return the builder options by the names of models or of shafts, from ``NAME.key=value``
    texts.
    """
    out: dict[str, list[str]] = {}
    for pair in pairs or []:
        name, dot, setting = pair.partition(".")
        if not dot or name not in names:
            raise SolidgearError(
                f"--set {pair}: write {what.upper()}.key=value, such as --set {example}; "
                f"{what}s: {', '.join(names)}"
            )
        out.setdefault(name, []).append(setting)
    return {name: options(settings) for name, settings in out.items()}


def refuse(present: Mapping[str, bool], kind: str) -> None:
    """Refuse the first of some options that is given; `kind` says what they are for."""
    for option, is_given in present.items():
        if is_given:
            raise SolidgearError(f"{option} is for {kind}")


def _value(text: str):
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return {"true": True, "false": False}.get(text, text)


def build_body(scene: Scene, name: str, pairs: list[str] | None) -> Body:
    """Return the body of a scene by one model, with ``--set`` options."""
    # Checked here too: an option called scene or fidelity would be taken for an argument of
    # `build`.
    return build(scene, name, **LADDER[name].checked(options(pairs)))


def speed_of(text: str | None) -> float | None:
    """Return the speed of an option, rad/s."""
    if text is None:
        return None
    try:
        speed = quantity(text, "speed")
    except SceneError as error:
        raise SolidgearError(f"`speed` {error}") from None
    if speed <= 0:
        raise SolidgearError(f"`speed` {text}: must be greater than zero")
    return speed
