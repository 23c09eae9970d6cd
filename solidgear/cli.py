"""Command line: compare, stiffness, modes, render, check."""

from __future__ import annotations

import os
import sys

# MKL's and OpenBLAS's thread pools fight each other (five times slower eigensolution was seen); the dense
# matrices here are small, so OpenBLAS gets one thread. It reads this when numpy is first imported.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import functools
import json
from enum import Enum
from pathlib import Path
from typing import Annotated, Optional

import typer

from solidgear.errors import SolidgearError

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    help="One pinion shaft on its bearings as beam, axisymmetric-harmonic solid and full 3D solid, side by side.",
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
)


class Fidelity(str, Enum):
    """Models, cheapest first."""

    euler = "euler"
    timoshenko = "timoshenko"
    harmonic = "harmonic"
    solid = "solid"


SceneFile = Annotated[Path, typer.Argument(help="Scene file (TOML), such as geometry/pinion_overhung.toml.")]
FidelityOption = Annotated[Fidelity, typer.Option("--fidelity", "-f", help="Model to solve with.")]
JsonFlag = Annotated[bool, typer.Option("--json", help="Print JSON for machines instead of tables.")]
Settings = Annotated[
    Optional[list[str]],
    typer.Option("--set", help="Builder option as key=value, repeatable: order=8, layers=4, element=tet10, refinement=1.5."),
]


def _options(pairs: list[str] | None) -> dict:
    """Builder options from ``key=value`` texts; numbers as numbers."""
    out: dict = {}
    for pair in pairs or []:
        key, sep, text = pair.partition("=")
        if not sep or not key.isidentifier():
            raise SolidgearError(f"--set {pair}: write key=value, such as --set order=8")
        out[key] = tuple(_value(part) for part in text.split(",")) if "," in text else _value(text)
    return out


def _value(text: str):
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return {"true": True, "false": False}.get(text, text)


def _build(scene, fidelity: Fidelity, pairs):
    from solidgear.fidelity import build

    options = _options(pairs)
    try:
        return build(scene, fidelity.value, **options)
    except TypeError as error:
        if "unexpected keyword" in str(error):
            word = str(error).rsplit("'", 2)[-2]
            raise SolidgearError(f"--set {word}: the {fidelity.value} model has no such option; its docstring lists them") from None
        raise


def _console():
    from rich.console import Console

    # Without a terminal rich assumes 80 columns; a pipe can take more, but 80 is what people paste.
    return Console(highlight=False)


class _Progress:
    """One line per stage on standard error, a spinner where there is a terminal."""

    def __init__(self, quiet: bool = False):
        import time

        from rich.console import Console

        self.console = Console(stderr=True, highlight=False)
        self.quiet, self.start, self.clock = quiet, time.perf_counter(), time.perf_counter
        self.status = None

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


def _command(function):
    """Register a command; typer would swallow Ctrl-C without a word."""

    @functools.wraps(function)
    def quiet(*args, **kwargs):
        try:
            return function(*args, **kwargs)
        except KeyboardInterrupt:
            print("solidgear: interrupted", file=sys.stderr)
            raise typer.Exit(130) from None

    return app.command(name=function.__name__)(quiet)


@_command
def compare(
    scene: SceneFile,
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for results.json, report.html, renders and vtu files.")] = Path("out"),
    models: Annotated[str, typer.Option("--models", help="Comma-separated: lumped,euler,timoshenko,harmonic,solid.")] = "lumped,euler,timoshenko,harmonic,solid",
    as_json: JsonFlag = False,
    renders: Annotated[bool, typer.Option("--renders/--no-renders", help="Draw the first bending mode of every model.")] = True,
    solid_element: Annotated[Optional[str], typer.Option("--solid-element", help="hex20, hex27, hex8, tet10 or tet4.")] = None,
) -> None:
    """Solve a scene with every model and write a report on which to trust."""
    from solidgear.comparison import check_models
    from solidgear.comparison import compare as run
    from solidgear.report.write import prepare
    from solidgear.scene_file import load

    loaded = load(scene)
    wanted = tuple(m.strip() for m in models.split(",") if m.strip())
    check_models(wanted)
    prepare(out)
    settings = {"solid": {"element": solid_element}} if solid_element else None
    with _Progress(quiet=as_json) as progress:
        found = run(loaded, wanted, settings=settings, progress=progress)
        found.write_report(out, renders=renders and found.results["complete"], progress=progress)
    if as_json:
        print(json.dumps(found.results, allow_nan=False))
    else:
        from solidgear.report.terminal import final_table, verdict_text

        console = _console()
        console.print(final_table(found.results))
        console.print(verdict_text(found.results), markup=False)
        console.print(f"Report: {out / 'report.html'}", markup=False, soft_wrap=True)
    if not found.results["complete"]:
        raise typer.Exit(130)
    if not found.rungs:
        raise typer.Exit(1)


@_command
def stiffness(
    scene: SceneFile,
    fidelity: FidelityOption = Fidelity.harmonic,
    attachment: Annotated[Optional[str], typer.Option(help="average, rigid or section for every port; by default as the scene says.")] = None,
    as_json: JsonFlag = False,
    settings: Settings = None,
) -> None:
    """6x6 stiffness and compliance at the lumped point, bearings included."""
    import numpy as np

    from solidgear.frames import DOF_NAMES
    from solidgear.scene_file import load
    from solidgear.solve.statics import condense

    loaded = load(scene)
    if attachment:
        loaded = loaded.with_attachment(attachment)
    body = _build(loaded, fidelity, settings)
    found = condense(body, loaded, loaded.port.name)

    if as_json:

        def plain(a):
            return [[float(v) if np.isfinite(v) else None for v in row] for row in a]

        record = {
            "scene": loaded.name,
            "fidelity": fidelity.value,
            "port": found.port,
            "attachment": found.attachment,
            "order": DOF_NAMES,
            "stiffness": plain(found.stiffness),
            "compliance": plain(found.compliance),
            "free": found.free_names,
            "dofs": body.size,
            "evidence": found.evidence,
        }
        print(json.dumps(record))
        return
    from solidgear.report.terminal import matrix_table

    console = _console()
    console.print(f"{loaded.name}: {fidelity.value}, {body.size} unknowns, port {found.port!r} at y = {1e3 * loaded.port.y:.3f} mm ({found.attachment})", markup=False)
    console.print(matrix_table(found.stiffness, "stiffness"))
    console.print(matrix_table(found.compliance, "compliance"))
    if found.free_names:
        console.print(f"Free: {', '.join(found.free_names)} (stiffness exactly zero).")


@_command
def modes(
    scene: SceneFile,
    fidelity: FidelityOption = Fidelity.harmonic,
    n: Annotated[Optional[int], typer.Option("-n", help="Number of elastic shapes; twins count twice.")] = None,
    max_frequency: Annotated[Optional[float], typer.Option(help="Hz; leave out modes above.")] = None,
    as_json: JsonFlag = False,
    settings: Settings = None,
) -> None:
    """Natural frequencies on the bearings, with the evidence for them."""
    from solidgear.scene_file import load
    from solidgear.solve.modes import modes as solve

    loaded = load(scene)
    body = _build(loaded, fidelity, settings)
    if max_frequency is not None and not max_frequency > 0:
        raise SolidgearError(f"--max-frequency {max_frequency:g}: must be greater than zero, in Hz")
    found = solve(body, loaded, loaded.ask.modes if n is None else n, max_frequency=max_frequency or loaded.ask.max_frequency)
    rows = [{"name": m.name, "family": m.family, "frequency_hz": m.frequency_hz, "multiplicity": m.multiplicity} for m in found.modes]
    if as_json:
        print(json.dumps({"scene": loaded.name, "fidelity": fidelity.value, "dofs": body.size, "modes": rows, "evidence": found.evidence}, default=float))
        return
    from solidgear.report.terminal import modes_table

    console = _console()
    console.print(f"{loaded.name}: {fidelity.value}, {body.size} unknowns", markup=False)
    console.print(modes_table(rows))
    e = found.evidence
    console.print(f"Residual {e['residual']:.1e}, orthogonality {e['orthogonality']:.1e}, rigid modes {e['rigid_modes']}, back end {e['backend']}.")


@_command
def render(
    scene: SceneFile,
    out: Annotated[Path, typer.Option("--out", "-o", help="PNG file to write.")] = Path("mode.png"),
    fidelity: FidelityOption = Fidelity.harmonic,
    mode: Annotated[str, typer.Option(help='Name of the mode, such as "bending 1" or "axial 1".')] = "bending 1",
    settings: Settings = None,
) -> None:
    """Draw one mode shape off-screen."""
    from solidgear.report.write import render_mode
    from solidgear.scene_file import load
    from solidgear.solve.modes import modes as solve

    loaded = load(scene)
    body = _build(loaded, fidelity, settings)
    found = solve(body, loaded, max(loaded.ask.modes, 10))
    path = render_mode(loaded, body, found, mode, out)
    print(path)


@_command
def check(
    scene: SceneFile,
    fidelity: FidelityOption = Fidelity.harmonic,
    as_json: JsonFlag = False,
    settings: Settings = None,
) -> None:
    """Say what will be modelled and what will not hold, before anything is solved."""
    from solidgear.check import check_scene
    from solidgear.scene_file import load

    loaded = load(scene)
    body = _build(loaded, fidelity, settings)
    found = check_scene(loaded, body)
    if as_json:
        print(json.dumps(found, default=float))
    else:
        for line in found["facts"]:
            print(line)
        for line in found["cautions"]:
            print(f"caution: {line}")
        for line in found["faults"]:
            print(f"fault: {line}")
    if found["faults"]:
        raise typer.Exit(1)


def main() -> None:
    """Entry point: errors raised on purpose become one sentence and exit code 1."""
    try:
        app()
    except SolidgearError as error:
        print(f"solidgear: {error}", file=sys.stderr)
        sys.exit(1)
    except MemoryError:
        print("solidgear: not enough memory for this model; use a coarser one (--set refinement=0.5) or the harmonic model", file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    main()
