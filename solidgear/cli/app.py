"""Parts that all commands share: the application, what a command is, printing and progress."""

from __future__ import annotations

import functools
import inspect
import sys
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Annotated, Any, TypeVar, get_type_hints

import typer

from solidgear.machine.memory import one_command

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.status import Status

R = TypeVar("R")

app = typer.Typer(
    no_args_is_help=True,
    help="Shafts on their bearings, and two that mesh, as lumped model, beam, "
    "axisymmetric-harmonic solid and full 3D solid, side by side.",
    epilog="Exit codes: 0 done; 1 refused or failed, in a sentence on standard error; 2 wrong usage; "
    "3 the tolerance is not reached, or a part of what was asked has no answer: what is there has its "
    "bars; 130 interrupted. "
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


#: exit code where the tolerance is not reached: the numbers are there, with their bars
NOT_REACHED = 3


def say(*told: RenderableType, soft_wrap: bool = True) -> None:
    """Print tables, and texts as they stand: a line of any length each, or broken at the width of
    the terminal without `soft_wrap`.
    """
    from rich.console import Console

    # Without a terminal rich assumes 80 columns; a pipe can take more, but 80 is what people paste.
    terminal = Console(highlight=False, markup=False, emoji=False)
    for one in told:
        terminal.print(one, soft_wrap=soft_wrap and isinstance(one, str), crop=False)


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


class Group:
    """Options that several commands take: a frozen dataclass whose fields are annotated as parameters
    of a command are.
    """


def command(function: Callable[..., R]) -> Callable[..., R]:
    """Register a command, the fields of its groups among its options; typer would swallow Ctrl-C
    without a word.
    """
    parameters = inspect.signature(function, eval_str=True).parameters
    groups = {name: p.annotation for name, p in parameters.items() if _is_group(p.annotation)}

    @functools.wraps(function)
    def quiet(**given: Any) -> R:
        try:
            with one_command():
                for name, group in groups.items():
                    given[name] = group(**{key.name: given.pop(key.name) for key in _fields(group)})
                return function(**given)
        except KeyboardInterrupt:
            print("solidgear: interrupted", file=sys.stderr)
            raise typer.Exit(130) from None

    flat = [
        own
        for p in parameters.values()
        for own in (_fields(groups[p.name]) if p.name in groups else [p])
    ]
    quiet.__signature__ = inspect.Signature(flat)  # type: ignore[attr-defined]  # what typer reads
    quiet.__annotations__ = {p.name: p.annotation for p in flat}
    return app.command(name=function.__name__.replace("_", "-"))(quiet)


def _is_group(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, Group)


def _fields(group: type[Group]) -> Iterator[inspect.Parameter]:
    """The options of a group as parameters of a command."""
    hints = get_type_hints(group, include_extras=True)
    for name, own in inspect.signature(group).parameters.items():
        yield own.replace(annotation=hints[name], kind=inspect.Parameter.KEYWORD_ONLY)
