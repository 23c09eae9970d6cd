"""The command export: a gearbox, or the matrices of a shaft or a train, for other programs."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from solidgear.core import DOF_NAMES, LADDER, SolidgearError
from solidgear.core.reduction.matrix_units import MATRIX_UNITS, SI, matrix_units
from solidgear.core.reduction.port_matrices import PortMatrices, not_free
from solidgear.exchange.export import OTHERS, is_rexs, refuse_options
from solidgear.exchange.matrices.formats import FORMATS, format_of, write_matrices
from solidgear.exchange.matrices.ross import rotor_remarks, write_ross
from solidgear.exchange.matrices.source import (
    CRAIG_BAMPTON,
    MODEL,
    Wanted,
    port_matrices,
    read_shaft,
)
from solidgear.exchange.rexs.export.exporting import Exported, write_rexs
from solidgear.exchange.rexs.units import REST
from solidgear.show.command import Progress, command
from solidgear.show.options import BY_MODEL, CaseName, Run, Settings, options, refuse, speed_of
from solidgear.show.remarks import document_under
from solidgear.show.sheet import Sheet, present
from solidgear.show.table import Column, Table, text

KINDS = "; ".join(f"{name}: {f.about}" for name, f in FORMATS.items())


@command
def export(
    file: Annotated[Path, typer.Argument(help="Scene or train file (TOML).")],
    *,
    to: Annotated[
        str | None,
        typer.Option(
            "--to",
            help=f"Format, by default that of the ending of --out: {KINDS}; ross: a Python file "
            "with the rotor of the beam and the shaft condensed to its point; rexs: the shaft or "
            "the train as it is, in .rexs, .rexsj or .rexsz.",
        ),
    ] = None,
    out: Annotated[Path, typer.Option("--out", "-o", help="File to write.")],
    model: Annotated[
        list[str] | None,
        typer.Option(
            *BY_MODEL,
            help=f"{', '.join(LADDER.bodies)}, by default {MODEL}; of one shaft of a train "
            "SHAFT=MODEL, repeatable.",
        ),
    ] = None,
    modes: Annotated[
        int, typer.Option(help="Modes beside the six motions of a port, no half pair.")
    ] = 0,
    method: Annotated[
        str,
        typer.Option(
            help="craig-bampton: modes with all ports held; free-interface: modes of the free body "
            "and residual fields."
        ),
    ] = CRAIG_BAMPTON,
    ports: Annotated[
        str | None,
        typer.Option(help="Ports to keep, with commas; of a train SHAFT.PORT. All by default."),
    ] = None,
    bearings: Annotated[
        bool | None,
        typer.Option(
            "--bearings/--free",
            help="With or without what holds it; by default a shaft is free and a train is not.",
        ),
    ] = None,
    speed: Annotated[
        str | None,
        typer.Option("--speed", help='Of a shaft, such as "3000 rpm": adds the gyroscopic matrix.'),
    ] = None,
    loss: Annotated[
        float, typer.Option(help="Loss factor of a shaft: adds structural damping.")
    ] = 0.0,
    system: Annotated[
        str, typer.Option("--units", help=f"Units of the file: {', '.join(MATRIX_UNITS)}.")
    ] = SI.name,
    settings: Settings = None,
    case: CaseName = None,
    run: Run,
) -> None:
    matrix_units(system)
    names = [name.strip() for name in ports.split(",")] if ports else []
    wanted = {
        "model": _models(model or []),
        "modes": modes,
        "method": method,
        "ports": tuple(names),
        "bearings": bearings,
        "speed": speed_of(speed),
        "loss": loss,
        **options(settings),
    }

    def study(_: Progress) -> Sheet:
        if is_rexs(out, to or ""):
            usual = Wanted()
            asked = {k: v for k, v in wanted.items() if v != getattr(usual, k, None)}
            refuse({"--case": case is not None}, f"matrices, and {out} is REXS")
            refuse_options(out, asked, system)
            return _rexs_sheet(write_rexs(file, out), file, out)
        source = document_under(file, case)
        if to == "ross":
            remarks = rotor_remarks(read_shaft(source), held=bearings is not False)
            return _rotor_sheet(write_ross(source, out, system, **wanted), remarks)
        format_of(out, to or "", OTHERS)
        matrices = port_matrices(source, **wanted)
        return _sheet(matrices, write_matrices(matrices, out, to or "", system), system)

    present(study, run)


def _models(words: list[str]) -> str | dict[str, str]:
    """Return one model for all, or models by shaft."""
    by_shaft = dict(word.split("=", 1) for word in words if "=" in word)
    alone = [word for word in words if "=" not in word]
    if len(alone) > 1 or (alone and by_shaft):
        raise SolidgearError(f"--model {', '.join(words)}: give one model, or SHAFT=MODEL for each")
    return by_shaft or (alone[0] if alone else "")


def _rexs_sheet(result: Exported, file: Path, out: Path) -> Sheet:
    """Return what was written, and what REXS has no place for."""
    components = result.document.components.values()
    counts = Counter(component.type for component in components)
    table = Table("", [text("component"), Column("count")], [*counts.items()])
    rows = [(name, ", ".join(keys)) for name, keys in result.without_place]
    places = Table("No place in REXS", [text("component"), text("entries")], rows)
    facts = f"REXS {result.document.version}: {len(components)} components."
    notes = [f"Written: {out}"]
    if rows:
        notes.insert(
            0,
            f"What has no place stands in {REST}, which solidgear import reads and others pass over.",
        )
    data = {
        "files": [str(out)],
        "version": result.document.version,
        "components": dict(counts),
        "without_place": {name: [*keys] for name, keys in result.without_place},
    }
    tables = [table, places] if rows else [table]
    return Sheet("export", str(file), facts, tables, data, notes=notes)


def _rotor_sheet(files: list[Path], remarks: list[str]) -> Sheet:
    """Return what was written, and in what the rotor is another model than the beam here."""
    names = ", ".join(map(str, files))
    notes = [f"{remark[:1].upper()}{remark[1:]}." for remark in remarks]
    return Sheet("export", f"Written: {names}", "", [], {"files": [*map(str, files)]}, notes=notes)


def _sheet(matrices: PortMatrices, files: list[Path], units: str) -> Sheet:
    """Return what was written: coordinates, mass and frequencies."""
    points = [(name, *(1e3 * place)) for name, place in matrices.positions.items()]
    table = Table("", [text("point"), *(Column(f"{axis} (mm)") for axis in "xyz")], points)
    free = not_free(matrices) is None
    facts = [f"{matrices.size} coordinates: {' '.join(DOF_NAMES)} of each point"]
    if matrices.modes:
        facts[0] += f", then {matrices.modes} modes"
    mass = float(matrices.rigid_mass[0, 0]) if free else None
    if free:
        first = matrices.elastic[0][0] / (2 * np.pi)
        facts.append(f"mass {mass:.6g} kg; first free mode {first:.6g} Hz")
    data = {
        "source": matrices.source,
        "notes": [*matrices.notes],
        "cautions": [*matrices.cautions],
        "coordinates": matrices.coordinates,
        "positions": {name: place.tolist() for name, place in matrices.positions.items()},
        "units": units,
        "mass": mass,
        "free": free,
        "files": [*map(str, files)],
    }
    notes = [*(f"{note[:1].upper()}{note[1:]}." for note in matrices.notes)]
    notes.append(f"Units of the file: {matrix_units(units).words}.")
    notes.append(f"Written: {', '.join(map(str, files))}")
    return Sheet(
        "export",
        matrices.source,
        "; ".join(facts) + ".",
        [table],
        data,
        notes=notes,
        cautions=matrices.cautions,
    )
