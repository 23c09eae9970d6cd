"""The commands correlate and identify: measured resonances beside a scene."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated, Any

import typer

from solidgear.measured.correlate import correlate as correlated
from solidgear.measured.data import load_measured
from solidgear.measured.identify import identify as identified
from solidgear.measured.overlay import overlay
from solidgear.measured.tables import (
    entries,
    fitted,
    pairs,
    peaks,
    predicted,
    write_correlation,
    write_identification,
)
from solidgear.measured.turned import turned_beside
from solidgear.show.arguments import load
from solidgear.show.command import command, say
from solidgear.show.folder import held
from solidgear.show.options import Run, share
from solidgear.show.viewer import viewer_fragment

SceneFile = Annotated[Path, typer.Argument(help="Scene file (TOML).")]
MeasuredFile = Annotated[
    Path,
    typer.Argument(
        help="Measured resonances: .csv with a head such as frequency [Hz], or .toml with a list mode, "
        "or .unv, .uff with mode shapes or frequency responses."
    ),
]
Tolerance = Annotated[
    float,
    typer.Option(
        "--tol", parser=share, metavar="FLOAT", help="Bar allowed of computed frequencies."
    ),
]
Out = Annotated[
    Path | None, typer.Option("--out", "-o", help="Folder for a page, data and tables.")
]
#: relative; below the scatter of careful measurements
TOLERANCE = 2e-4


@command
def correlate(
    scene: SceneFile,
    measured: MeasuredFile,
    *,
    tol: Tolerance = TOLERANCE,
    out: Out = None,
    run: Run,
) -> None:
    data = load_measured(measured)
    loaded = load(scene)
    with held(out) if out else nullcontext(), run.progress() as progress:
        found = correlated(loaded, data, tol, progress)
        files = _written(out, found, progress) if out else []
    tables = [pairs(found)] if data.responses is None else [peaks(found), pairs(found)]
    _tell(found, tables, files, run)


@command
def identify(
    scene: SceneFile,
    measured: MeasuredFile,
    *,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            help="Entry that is to be found, such as bearing.A.stiffness.kxx; with bounds, "
            '"material.E=180 GPa : 220 GPa", or known to a standard deviation, '
            '"material.E=206 GPa ± 3 %"; repeatable.',
        ),
    ] = None,
    predict: Annotated[
        int, typer.Option("--predict", help="Modes beyond the measured ones to predict.")
    ] = 0,
    priors: Annotated[
        bool, typer.Option("--priors", help="Ranges of the scene's [uncertain] hold as well.")
    ] = False,
    tol: Tolerance = TOLERANCE,
    out: Out = None,
    run: Run,
) -> None:
    data = load_measured(measured)
    with held(out) if out else nullcontext(), run.progress() as progress:
        found = identified(
            scene,
            data,
            vary or (),
            tol=tol,
            predict=predict,
            progress=progress,
            priors=priors,
        )
        files = write_identification(out, found) if out else []
    tables = [entries(found), fitted(found)] + [predicted(found)] * bool(found.predicted)
    _tell(found, tables, files, run)


def _written(out: Path, found: Any, progress: Callable[[str], None]) -> list[Path]:
    """The page of a correlation, with shapes to be turned and responses where there are any."""
    progress("responses and shapes at the measuring points")
    shown = turned_beside(found)
    return write_correlation(out, found, overlay(found), viewer_fragment(shown) if shown else "")


def _tell(found: Any, tables: list, files: list[Path], run: Run) -> None:
    if run.as_json:
        print(json.dumps(found.results, allow_nan=False))
        return
    say(f"{found.scene}: {found.mesh}", *tables, soft_wrap=False)
    say(*found.sentences, soft_wrap=False)
    say(*([f"Written: {', '.join(map(str, files))}"] if files else []), soft_wrap=False)
