"""Parts that all commands share: the application, its argument types, progress and error handling."""

from __future__ import annotations

import functools
import re
import sys
from collections.abc import Callable, Collection
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ParamSpec, TypeVar

import typer

from solidgear.errors import SolidgearError, show
from solidgear.ladder.registry import LADDER
from solidgear.machine.memory import one_command
from solidgear.report.units import ENGINEERING, SYSTEMS

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.status import Status

    from solidgear.body import Body
    from solidgear.scene import Scene

P = ParamSpec("P")
R = TypeVar("R")

app = typer.Typer(
    no_args_is_help=True,
    help="Shafts on their bearings, and two that mesh, as lumped model, beam, "
    "axisymmetric-harmonic solid and full 3D solid, side by side.",
    epilog="Exit codes: 0 done; 1 refused or failed, in a sentence on standard error; 2 wrong usage; "
    "3 the tolerance is not reached, the numbers are there with their bars; 130 interrupted. "
    "First steps: solidgear new my_shaft, then solidgear check my_shaft.toml.",
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
)


def _version(asked: bool) -> None:
    if asked:
        from importlib.metadata import version

        typer.echo(f"solidgear {version('solidgear')}")
        raise typer.Exit


@app.callback()
def everywhere(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Print the version."),
    ] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", "-q", help="No progress; give it before the command.")
    ] = False,
) -> None:
    """Options of every command."""
    Progress.silent = quiet


#: the model that commands solve with unless told otherwise
FIDELITY = "harmonic"
#: the word for the cheapest mesh that keeps a tolerance, instead of a model
AUTO = "auto"
#: units of tables and pages unless told otherwise
UNITS = ENGINEERING.name
#: exit code where the tolerance is not reached: the numbers are there, with their bars
NOT_REACHED = 3


SceneFile = Annotated[
    Path,
    typer.Argument(
        help="Scene file (TOML), such as geometry/pinion_overhung.toml; - for standard input."
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
#: spellings of the option that names a model
BY_MODEL = ("--model", "--fidelity", "-f")
FidelityOption = Annotated[Choice, typer.Option(*BY_MODEL, help="Model to solve with.")]
AutoFidelityOption = Annotated[
    AutoChoice,
    typer.Option(
        *BY_MODEL,
        help="Model to solve with; auto: the cheapest whose bars are within --tol.",
    ),
]


def share(text: str) -> float:
    """A relative error from the command line."""
    try:
        return float(text)
    except ValueError:
        percent = text.strip().removesuffix("%").strip()
        meant = f"{float(percent) / 100:g}" if _is_number(percent) else "0.01"
        raise typer.BadParameter(
            f'"{text}" is no plain number; a tolerance is a share: write {meant}'
        ) from None


def _is_number(text: str) -> bool:
    return re.fullmatch(r"[0-9]*[.]?[0-9]+", text) is not None


Tolerance = Annotated[
    float | None,
    typer.Option(
        "--tol",
        parser=share,
        metavar="FLOAT",
        help="Of -f auto: relative error allowed; else the scene's own.",
    ),
]
JsonFlag = Annotated[
    bool, typer.Option("--json", help="Print JSON for machines instead of tables; always SI.")
]
UnitsOption = Annotated[
    UnitsChoice,
    typer.Option(
        "--units",
        help="Of tables and pages: "
        + "; ".join(f"{units.name}: {units.about}" for units in SYSTEMS.values())
        + ". JSON stays SI always.",
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        help="Builder option as key=value, repeatable: order=8, layers=4, element=tet10; solidgear options lists them.",
    ),
]
Engine = Annotated[
    str | None,
    typer.Option(
        "--engine",
        help="Who factors a 3D solid too large for this program: petsc (MUMPS under mpirun) "
        "or petsc-gamg (multigrid, statics only); the same as --set engine=...",
    ),
]


def with_engine(pairs: list[str] | None, engine: str | None) -> list[str] | None:
    """``--set`` options with that of ``--engine``."""
    return pairs if engine is None else [*(pairs or []), f"engine={engine}"]


def options(pairs: list[str] | None) -> dict:
    """Builder options from ``key=value`` texts; numbers as numbers, a list with commas as a tuple."""
    out: dict = {}
    for pair in pairs or []:
        key, sep, text = pair.partition("=")
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
    """Builder options by the names of models or of shafts, from ``NAME.key=value`` texts."""
    out: dict[str, list[str]] = {}
    for pair in pairs or []:
        name, dot, rest = pair.partition(".")
        if not dot or name not in names:
            raise SolidgearError(
                f"--set {pair}: write {what.upper()}.key=value, such as --set {example}; "
                f"{what}s: {', '.join(names)}"
            )
        out.setdefault(name, []).append(rest)
    return {name: options(own) for name, own in out.items()}


def _value(text: str):
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return {"true": True, "false": False}.get(text, text)


def build_body(scene: Scene, fidelity: str, pairs: list[str] | None) -> Body:
    """Body of a scene by one model, with ``--set`` options."""
    from solidgear.ladder import build

    # Checked here too: an option called scene or fidelity would be taken for an argument of
    # `build`.
    return build(scene, fidelity, **LADDER[fidelity].checked(options(pairs)))


def say(*told: RenderableType, soft_wrap: bool = True) -> None:
    """Print tables, and texts as they stand: a line of any length each, or broken at the width of
    the terminal without `soft_wrap`.
    """
    from rich.console import Console

    # Without a terminal rich assumes 80 columns; a pipe can take more, but 80 is what people paste.
    terminal = Console(highlight=False, markup=False, emoji=False)
    for one in told:
        terminal.print(one, soft_wrap=soft_wrap and isinstance(one, str))


def caution(text: str) -> str:
    return f"caution: {text}"


class Progress:
    """One line per stage on standard error, a spinner where there is a terminal."""

    #: of the whole run
    silent = False

    def __init__(self, quiet: bool = False):
        import time

        from rich.console import Console

        self.console = Console(stderr=True, highlight=False)
        self.quiet = quiet or self.silent
        self.start, self.clock = time.perf_counter(), time.perf_counter
        self.status: Status | None = None

    def __enter__(self):
        if not self.quiet and self.console.is_terminal:
            self.status = self.console.status("starting")
            self.status.start()
        return self

    def __exit__(self, *_):
        if self.status:
            self.status.stop()

    def __call__(self, text: str) -> None:
        if self.quiet:
            return
        line = f"{self.clock() - self.start:6.1f} s  {text}"
        if self.status:
            self.status.update(line)
        else:
            print(line, file=sys.stderr, flush=True)


def command(function: Callable[P, R]) -> Callable[P, R]:
    """Register a command; typer would swallow Ctrl-C without a word."""

    @functools.wraps(function)
    def quiet(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            with one_command():
                return function(*args, **kwargs)
        except KeyboardInterrupt:
            print("solidgear: interrupted", file=sys.stderr)
            raise typer.Exit(130) from None

    return app.command(name=function.__name__.replace("_", "-"))(quiet)
