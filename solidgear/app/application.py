"""The application: its commands, each a function of the room of its question."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from importlib import import_module
from typing import Annotated, Any, NamedTuple

import typer
from typer.core import TyperCommand, TyperGroup

from solidgear import __version__
from solidgear.app.options_alone import options_alone
from solidgear.core.machine.later import loading
from solidgear.core.machine.memory import one_command
from solidgear.core.registry import missing_room, without
from solidgear.show.command import Progress

HELP = ("-h", "--help")
#: texts of commands and options that help prints
HELP_TEXTS = ("help", "epilog", "short_help")


class Entry(NamedTuple):
    """A command: the module below :mod:`solidgear` that has its function, and the line of its help."""

    module: str
    help: str
    function: str = ""  #: by default called as the command


#: commands by what they are for, in the order of the work, each in the room of its question
GROUPS = {
    "Start": {
        "new": Entry(
            "app.files",
            "Write a short, commented scene or train that runs, to be made your own.",
        ),
        "scenes": Entry(
            "app.files",
            "List the scenes that come with solidgear, or copy them into a folder.",
        ),
        "check": Entry(
            "guards.check_command",
            "Say which models hold for a scene or train, which do not, and why; solves light "
            "meshes only.",
        ),
        "export": Entry(
            "exchange.command",
            "Mass and stiffness of a shaft or a train at its ports, or a gearbox in REXS.",
        ),
        "import": Entry(
            "exchange.rexs.command",
            "Read a gearbox of another program, in REXS, as a train with its shafts.",
            function="import_file",
        ),
        "options": Entry(
            "app.files",
            "List what --set takes: every builder option with default, limits and meaning.",
        ),
        "schema": Entry(
            "show.schema.command",
            "Print the JSON Schema of files, for editors, or of what a command prints with --json.",
        ),
    },
    "One shaft": {
        "answer": Entry(
            "app.answer",
            "Numbers within a tolerance, each with its error bar, from the cheapest model that "
            "can show it.",
        ),
        "stiffness": Entry(
            "app.stiffness",
            "6x6 stiffness and compliance at a lumped point, bearings included; 12x12 between two.",
        ),
        "modes": Entry(
            "app.modes",
            "Natural frequencies on the bearings, with the evidence for them.",
        ),
        "compare": Entry(
            "app.compare",
            "Solve a scene or a train with every model and write a report on which to trust, or "
            "compare two designs.",
        ),
        "sheet": Entry(
            "datasheet.command",
            "One page of a shaft or a train to hand on, as HTML or PDF, in English or German.",
        ),
        "chart": Entry(
            "comparison.race.command",
            "Chart error against cost: every model and element, uniform and graded, with the "
            "Pareto front.",
        ),
        "render": Entry(
            "app.render",
            "Draw one mode shape off-screen, or all of them in a page where they can be turned.",
        ),
        "bearing": Entry(
            "trains.load.bearing_command",
            "Catalogue bearings: stiffness at load, load of every element, pressure, life; for "
            "a train with an [operation] lives over its points.",
        ),
        "stress": Entry(
            "strength.stress.command",
            "Stress of shafts at rest: section forces, nominal stress, stress on fillets, DIN 743.",
        ),
    },
    "Design": {
        "sweep": Entry(
            "variants.sweep.command",
            "Thousands of bearing sets on one body, or variants of a shaft or train, as rows of "
            "a file.",
        ),
        "sensitivities": Entry(
            "variants.sensitivity.command",
            "What would change a number: its derivatives by every number of the file, from one "
            "solution.",
        ),
        "optimise": Entry(
            "variants.optimise.command",
            "The best design within ranges, and whether error bars show it to be better.",
        ),
        "budget": Entry(
            "variants.budget.command",
            "Which unknown is worth measuring: the range of the scene's numbers by every open "
            "input.",
        ),
    },
    "Measured": {
        "correlate": Entry(
            "measured.command",
            "Measured resonances beside computed modes: which belongs to which, how surely, and "
            "how far apart.",
        ),
        "identify": Entry(
            "measured.command",
            "Entries of a scene from measured resonances, and how sure they are.",
        ),
    },
    "Trains": {
        "system-modes": Entry(
            "trains.modes.command",
            "Natural frequencies of a train, each with its name and a proven bound.",
        ),
        "response": Entry(
            "trains.response.command",
            "Steady response to the transmission error: mesh force, reactions, motions, and a "
            "chart.",
        ),
        "receptance": Entry(
            "trains.response.command",
            "Receptance between any two ports of a train: table, chart, and peaks with their "
            "modes.",
        ),
        "nonlinear": Entry(
            "backlash.command",
            "Teeth with backlash: where they part, jumps over speed, and the error of the "
            "linear answer.",
        ),
        "deflect": Entry(
            "strength.deflection.command",
            "Deflection of shafts under torque: displacements, misalignment of the gears, "
            "bearing loads.",
        ),
        "contact": Entry(
            "teeth.command",
            "Teeth in contact: mesh stiffness, transmission error and load along the face, over "
            "the torque.",
        ),
        "judge-system": Entry(
            "trains.judge.command",
            "Compare a train with further mixes and reductions; a report only with --out.",
        ),
    },
}
COMMANDS = {name: entry for group in GROUPS.values() for name, entry in group.items()}


@contextmanager
def _brackets(*parts: Any) -> Iterator[None]:
    """Print square brackets in help as written, within this context; typer takes them for markup."""
    from rich.markup import escape  # start-up: for help alone

    plain = [(part, name, getattr(part, name, None)) for part in parts for name in HELP_TEXTS]
    for part, name, text in plain:
        if isinstance(text, str):
            setattr(part, name, escape(text))
    try:
        yield
    finally:
        for part, name, text in plain:
            if isinstance(text, str):
                setattr(part, name, text)


class Told(TyperCommand):
    """A command whose help is printed as written."""

    def format_help(self, ctx, formatter):
        with _brackets(self, *self.params):
            super().format_help(ctx, formatter)


class Door(TyperGroup):
    """The commands; a module is imported when one of its commands runs or is asked for help."""

    def format_help(self, ctx, formatter):
        with _brackets(self, *self.params, *self.commands.values()):
            super().format_help(ctx, formatter)

    def resolve_command(self, ctx, args):
        """Return the command itself, in place of the one that has only name and help."""
        name, found_command, arguments = super().resolve_command(ctx, args)
        if not name:
            return name, found_command, arguments
        with options_alone() if arguments and arguments[-1] in HELP else nullcontext():
            return name, _imported(name), arguments

    def invoke(self, ctx):
        """Run a command; typer would swallow Ctrl-C without a word."""
        try:
            with one_command():
                return super().invoke(ctx)
        except KeyboardInterrupt:
            print("solidgear: interrupted", file=sys.stderr)
            raise typer.Exit(130) from None


def _imported(name: str) -> Any:
    """Return a command with its options."""
    entry = COMMANDS[name]
    name_of_module = f"solidgear.{entry.module}"
    try:
        with loading(name_of_module):
            module = import_module(name_of_module)
    except ModuleNotFoundError as error:
        if not missing_room(error):
            raise
        print(f"solidgear: {name} {without(missing_room(error))}", file=sys.stderr)
        raise typer.Exit(1) from None
    alone = typer.Typer(add_completion=False, pretty_exceptions_enable=False)
    function = getattr(module, entry.function or name.replace("-", "_"))
    alone.command(name, cls=Told, help=entry.help)(function)
    return typer.main.get_command(alone)


app = typer.Typer(
    cls=Door,
    no_args_is_help=True,
    help="Shafts on their bearings, and trains of shafts that mesh, as lumped model, beam, "
    "axisymmetric-harmonic solid and full 3D solid, side by side.",
    epilog="Exit codes: 0 done; 1 refused or failed, in a sentence on standard error; 2 wrong usage; "
    "3 the tolerance is not reached, or a part of what was asked has no answer; 130 "
    "interrupted. First steps: solidgear new my_shaft, then solidgear check my_shaft.toml.",
    context_settings={"help_option_names": [*HELP]},
    pretty_exceptions_enable=False,
)


def add_command(group: str, name: str, entry: Entry) -> None:
    """Add a command to the application and to the panel of its group in the help."""
    COMMANDS[name] = GROUPS.setdefault(group, {})[name] = entry
    app.command(name, help=entry.help, rich_help_panel=group)(lambda: None)


for _group, _commands in GROUPS.items():
    for _name, _entry in _commands.items():
        add_command(_group, _name, _entry)


def _version(wanted_version: bool) -> None:
    if wanted_version:
        typer.echo(f"solidgear {__version__}")
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
