"""Command of the command line: groups of options, printing and progress."""

from __future__ import annotations

import functools
import inspect
import sys
import textwrap
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, get_type_hints

from solidgear.core.errors import SolidgearError

if TYPE_CHECKING:
    from rich.console import Console, RenderableType
    from rich.status import Status

R = TypeVar("R")
#: options of arguments of Python whose names commands do not have
OTHERWISE = {
    "folder": "--out",
    "forces": "--force",
    "options": "--set",
    "reduction_tolerance": "--tolerance",
}
#: exit code where a check finds what must not be used
FAULTY = 1
#: exit code where the tolerance is not reached: the numbers are there, with their bars
NOT_REACHED = 3


def console(stderr: bool = False) -> Console:
    """Return the terminal, which prints square brackets as they are."""
    from rich.console import Console  # start-up: not before a command prints

    # Without a terminal rich assumes 80 columns; a pipe can take more, but 80 is what people paste.
    return Console(highlight=False, markup=False, emoji=False, stderr=stderr)


def say(*blocks: RenderableType, soft_wrap: bool = True, printer: Console | None = None) -> None:
    """Print tables, and texts as they stand: a line of any length each, or broken at the width of
    the terminal without `soft_wrap`; on a printer in place of the terminal, where one is given.
    """
    terminal = printer or console()
    for block in blocks:
        if isinstance(block, str) and not soft_wrap:
            # rich breaks lines at the spaces that hold the digits of a number together as well
            lines = block.split("\n")
            block = "\n".join(
                textwrap.fill(line, terminal.width, break_long_words=False, break_on_hyphens=False)
                for line in lines
            )
        terminal.print(block, soft_wrap=isinstance(block, str), crop=False)


def as_typed(path: Path) -> str:
    """Return a path as it is typed into a shell, in quotes where it has blanks.

    Examples
    --------
    >>> as_typed(Path("my box.toml")), as_typed(Path("box.toml"))
    ('"my box.toml"', 'box.toml')
    """
    return f'"{path}"' if " " in str(path) else str(path)


def filled(text: str, indent: str = "") -> str:
    """Fill a text into lines as wide as the terminal, all but the first indented further."""
    from rich.console import Console  # start-up: as in `say`

    return textwrap.fill(
        text,
        Console().width,
        initial_indent=indent,
        subsequent_indent=f"{indent}  ",
        break_long_words=False,
        break_on_hyphens=False,
    )


def caution(text: str) -> str:
    return f"caution: {text}"


class Progress:
    """One line per stage on standard error, a spinner where there is a terminal."""

    #: of the whole run
    silent = False
    first = ""  #: a line before all others

    def __init__(self, quiet: bool = False):
        self.console = console(stderr=True)
        self.quiet = quiet or self.silent
        self.start = time.perf_counter()
        self.status: Status | None = None

    def __enter__(self):
        if self.first and not self.quiet:
            print(self.first, file=sys.stderr)
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
        line = f"{time.perf_counter() - self.start:6.1f} s  {text}"
        if self.status:
            from rich.text import Text  # start-up: as in `console`

            self.status.update(Text(line))  # a text alone would be read as markup
        else:
            print(line, file=sys.stderr, flush=True)


class Group:
    """Options that several commands take: a frozen dataclass whose fields are annotated as parameters
    of a command are.
    """


def command(function: Callable[..., R]) -> Callable[..., R]:
    """Register a function as a command; the fields of its option groups become options."""
    parameters = inspect.signature(function, eval_str=True).parameters
    groups = {name: p.annotation for name, p in parameters.items() if _is_group(p.annotation)}

    @functools.wraps(function)
    def flattened(**values: Any) -> R:
        for name, group in groups.items():
            values[name] = group(**{key.name: values.pop(key.name) for key in _fields(group)})
        try:
            return function(**values)
        except SolidgearError as error:
            error.spell_arguments(lambda name: options.get(name) or _option(name))
            raise

    flat = [
        field
        for p in parameters.values()
        for field in (_fields(groups[p.name]) if p.name in groups else [p])
    ]
    options = {p.name: _option_of(p) for p in flat}
    flattened.__signature__ = inspect.Signature(flat)  # type: ignore[attr-defined]  # what typer reads
    flattened.__annotations__ = {p.name: p.annotation for p in flat}
    return flattened


def _option_of(parameter: inspect.Parameter) -> str:
    """Return the long option of a parameter of a command."""
    declared = [
        word
        for part in getattr(parameter.annotation, "__metadata__", ())
        # typer takes the first name for a default until it reads the command
        for word in (getattr(part, "default", None), *(getattr(part, "param_decls", None) or ()))
        if isinstance(word, str) and word.startswith("--")
    ]
    return declared[0].partition("/")[0] if declared else _option(parameter.name)


def _option(name: str) -> str:
    """Return the option of an argument of Python that no parameter of the command has."""
    return OTHERWISE.get(name) or f"--{name.strip('_').replace('_', '-')}"


def _is_group(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, Group)


def _fields(group: type[Group]) -> Iterator[inspect.Parameter]:
    """Yield the options of a group as parameters of a command."""
    hints = get_type_hints(group, include_extras=True)
    for name, parameter in inspect.signature(group).parameters.items():
        yield parameter.replace(annotation=hints[name], kind=inspect.Parameter.KEYWORD_ONLY)
