"""Command ``compare``: a scene or a train by every model, or two files of a kind."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from solidgear.comparison.models import check_models, nothing
from solidgear.comparison.models import compare as compared
from solidgear.comparison.page.sheet import sheet
from solidgear.comparison.page.write import SHEET, Pictures
from solidgear.core import ELEMENTS, LADDER, SolidgearError, is_train, listed
from solidgear.core.machine.start import BEGUN
from solidgear.core.registry import needed
from solidgear.show.command import Progress, command
from solidgear.show.folder import held
from solidgear.show.options import (
    MODEL,
    CaseName,
    SceneFile,
    Shown,
    options_by_name,
    refuse,
    relative,
)
from solidgear.show.remarks import load
from solidgear.show.render import Drawing
from solidgear.show.sheet import Sheet, present


@command
def compare(
    scene: SceneFile,
    more: Annotated[
        list[Path] | None,
        typer.Argument(
            help="A second scene or train, to be compared with the first.", show_default=False
        ),
    ] = None,
    *,
    out: Annotated[
        Path,
        typer.Option(
            "--out", "-o", help="Folder for results.json, report.html, renders and vtu files."
        ),
    ] = Path("out"),
    models: Annotated[
        str,
        typer.Option("--models", help=f"Comma-separated: {','.join(LADDER.names)}."),
    ] = ",".join(LADDER.names),
    renders: Annotated[
        bool,
        typer.Option("--renders/--no-renders", help="Draw the first bending mode of every model."),
    ] = True,
    solid_element: Annotated[
        str | None, typer.Option("--solid-element", help=f"One of {listed(ELEMENTS)}.")
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            help="Builder option of one model as MODEL.key=value, repeatable: solid.around=32, "
            "harmonic.order=8. An option of the mesh fixes it.",
        ),
    ] = None,
    chart: Annotated[
        bool,
        typer.Option(
            "--chart",
            help="Also chart error against cost, as a section of the report (about four minutes more).",
        ),
    ] = False,
    sheet_language: Annotated[
        str | None,
        typer.Option(
            "--sheet",
            help="Also write sheet.html, one page to hand on, in a language: en or de.",
        ),
    ] = None,
    pinion: Annotated[
        str | None,
        typer.Option(
            "--pinion", help=f"For two trains: model of both pinions, {MODEL} by default."
        ),
    ] = None,
    gear: Annotated[
        str | None, typer.Option("--gear", help="For two trains: model of both gears, as --pinion.")
    ] = None,
    shafts: Annotated[
        list[str] | None,
        typer.Option(
            "--shaft",
            help="For two trains: model of a shaft with another name, input=euler; repeatable.",
        ),
    ] = None,
    mesh: Annotated[
        str | None,
        typer.Option(
            "--mesh",
            help="For two trains: the mesh whose transmission error drives; by default the first.",
        ),
    ] = None,
    tol: Annotated[
        float | None,
        relative(
            "--tol",
            "For trains: relative error that meshes of harmonic shafts may leave; by default a tenth "
            "of the file's tolerance.",
        ),
    ] = None,
    case: CaseName = None,
    run: Shown,
) -> None:
    of_one_shaft = {
        "--models": models != ",".join(LADDER.names),
        "--solid-element": bool(solid_element),
        "--set": bool(settings),
        "--chart": chart,
    }
    of_trains = {
        "--pinion": bool(pinion),
        "--gear": bool(gear),
        "--shaft": bool(shafts),
        "--mesh": bool(mesh),
    }
    if sheet_language is not None:
        languages = needed("sheet", "languages", "--sheet")
        if sheet_language not in languages:
            reason = f"{sheet_language!r} is not one of {', '.join(map(repr, languages))}."
            raise typer.BadParameter(reason, param_hint="'--sheet'")
    if more:
        refuse({"--sheet": bool(sheet_language)}, "one file; run solidgear sheet for each of two")
        of_trains["--tol"] = tol is not None
        compare_two = needed("compare", "two files", "compare of two files")
        compare_two(
            [scene, *more], out, pinion, gear, shafts, mesh, tol, case, run, of_one_shaft, of_trains
        )
        return
    refuse(of_trains, f"two trains, and {scene} is one, of which every model is solved")
    if is_train(scene):
        refuse({"--case": case is not None}, f"a shaft, and {scene} is a train")
        compare_train = needed("compare", "file of a train", str(scene))
        pages = []
        if sheet_language is not None:
            sheet_of = needed("sheet", "of a train", "--sheet")
            pages = [replace(sheet_of(scene, language=sheet_language), report="report.html")]
        compare_train(scene, out, tol, renders, run, of_one_shaft)
        for page in pages:
            page.save(out / SHEET, run.units)
        return
    if tol is not None:
        raise SolidgearError(
            f"--tol is for trains, and {scene} is one shaft: write tolerance under [ask] in the file"
        )

    loaded = load(scene, case)
    names = tuple(m.strip() for m in models.split(",") if m.strip())
    check_models(names)
    chosen = options_by_name(settings, LADDER.bodies, "model", "solid.around=32")
    if solid_element:
        chosen.setdefault("solid", {})["element"] = solid_element

    def study(progress: Progress) -> Sheet:
        with held(out), Drawing() as drawing:
            pictures = Pictures(drawing, out)
            solved = partial(pictures.begin_early, loaded) if renders else nothing
            comparison = compared(loaded, names, settings=chosen, progress=progress, solved=solved)
            comparison.began = BEGUN  # imports and reading count as well
            comparison.let_matrices_go()
            complete = comparison.record.complete
            drawn = renders and complete
            comparison.write_report(
                out,
                renders=drawn,
                units=run.units,
                progress=progress,
                pictures=pictures,
                sheet=sheet_language or "",
            )
            if chart and complete:
                from solidgear.comparison.race.command import run_chart  # start-up: for --chart

                run_chart(loaded, out, progress=progress)
        exit_code = 0 if comparison.solutions else 1
        files = [f"Report: {out / 'report.html'}"]
        if SHEET in (comparison.record.files or ()):
            files.append(f"Sheet: {out / SHEET}")
        return sheet(comparison.record, files, exit_code if complete else 130)

    present(study, run)
