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
        "--tol", parser=share, metavar="FLOAT", help="Error bar allowed for computed frequencies."
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
        correlation = correlated(loaded, data, tol, progress)
        files = _written(out, correlation, progress) if out else []
    tables = (
        [pairs(correlation)] if data.responses is None else [peaks(correlation), pairs(correlation)]
    )
    _tell(correlation, tables, files, run)


@command
def identify(
    scene: SceneFile,
    measured: MeasuredFile,
    *,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            help='Entry to find, such as bearing.A.stiffness.kxx; with bounds, "material.E=180 GPa '
            ': 220 GPa", or a standard deviation, "material.E=206 GPa ± 3 %"; repeatable.',
        ),
    ] = None,
    predict: Annotated[
        int, typer.Option("--predict", help="Number of modes above the measured ones to predict.")
    ] = 0,
    priors: Annotated[
        bool, typer.Option("--priors", help="Use the ranges of the scene's [uncertain] as well.")
    ] = False,
    tol: Tolerance = TOLERANCE,
    out: Out = None,
    run: Run,
) -> None:
    data = load_measured(measured)
    with held(out) if out else nullcontext(), run.progress() as progress:
        identification = identified(
            scene,
            data,
            vary or (),
            tol=tol,
            predict=predict,
            progress=progress,
            priors=priors,
        )
        files = write_identification(out, identification) if out else []
    tables = [entries(identification), fitted(identification)] + [predicted(identification)] * bool(
        identification.predicted
    )
    _tell(identification, tables, files, run)


def _written(out: Path, study: Any, progress: Callable[[str], None]) -> list[Path]:
    """Write the page of a correlation, with shapes and responses where there are any."""
    progress("responses and shapes at the measuring points")
    viewer = turned_beside(study)
    return write_correlation(out, study, overlay(study), viewer_fragment(viewer) if viewer else "")


def _tell(study: Any, tables: list, files: list[Path], run: Run) -> None:
    if run.as_json:
        print(json.dumps(study.results, allow_nan=False))
        return
    say(f"{study.scene}: {study.mesh}", *tables, soft_wrap=False)
    say(*study.sentences, soft_wrap=False)
    say(*([f"Written: {', '.join(map(str, files))}"] if files else []), soft_wrap=False)
