"""Sheet of the modes of a train, and their tables for a terminal and for a page."""

from __future__ import annotations

from collections.abc import Sequence

from solidgear.show.command import caution
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import NUMBER, Cell, Column, Table, text, word
from solidgear.show.units import Units, in_ascii
from solidgear.show.words import whole
from solidgear.trains.assembly.shaft import mix_label
from solidgear.trains.assembly.slips import unit_slips
from solidgear.trains.assembly.tooth_stiffness import of_teeth
from solidgear.trains.judge.comparison import train_data
from solidgear.trains.modes.modes import TrainMode, TrainModes
from solidgear.trains.modes.study import SolvedModes
from solidgear.trains.page.tables import facts

#: relative; no frequency is shown with a smaller bound, whatever the proof says
ROUNDING = 1e-12


def modes_sheet(
    modes: SolvedModes, units: Units, viewer: str = "", written: Sequence[str] = ()
) -> Sheet:
    """Return the sheet of the modes of a train; `written` are lines on files."""
    assembly, system = modes.assembly, modes.solved
    slips = unit_slips(assembly)
    cautions = [*slips, *system.cautions]
    by_teeth = of_teeth(assembly, units)
    return Sheet(
        name="modes",
        title=system.train,
        lead=f"Natural frequencies and mode shapes: {mix_label(system.models)}.",
        tables=[frequencies(system, "Natural frequencies"), facts(train_data(assembly), units)],
        data=system.as_dict() | {"cautions": cautions},
        notes=[*system.notes(), *by_teeth],
        cautions=cautions,
        viewer=viewer,
        terminal=Terminal(
            heading=[*system.heading(), *map(caution, slips)],
            tables=[numbered(system)],
            closing=[*system.remarks(), *map(in_ascii, by_teeth), *written],
            lines="whole",
        ),
    )


def numbered(system: TrainModes) -> Table:
    """Return the modes for a terminal, numbered as they are drawn."""
    count = {id(mode): number for number, mode in enumerate(system.modes, start=1)}
    number = Column("", lambda mode: count[id(mode)], kind=NUMBER)
    columns = _columns(system, nothing="")
    if not system.has_mesh_bars:
        columns.pop()
    return Table("", [number, *columns], system.modes, style="ruled")


def frequencies(system: TrainModes, title: str) -> Table:
    """Return the modes for a page."""
    speeds = system.speeds
    note = (
        f"{speeds.capitalize()} rpm: the speed at which its teeth mesh at this frequency. Bound: "
        "largest error by the reduction. Mesh: largest error by the meshes of harmonic solids."
    )
    return Table(title, _columns(system, nothing=None), system.modes, note)


def _columns(system: TrainModes, nothing: str | None) -> list[Column]:
    """Return columns of modes, `nothing` for what a mode does not have."""

    def mesh(mode: TrainMode) -> float | str | None:
        return nothing if mode.mesh is None else mode.mesh

    return [
        word("mode", lambda mode: mode.name),
        Column("Hz", lambda mode: mode.frequency_hz, lambda hz: f"{hz:.2f}"),
        Column(
            f"{system.speeds} rpm",
            lambda mode: mode.rpm,
            whole,
            name=f"{system.speeds} speed",
            unit="rpm",
        ),
        text("most strain energy", lambda mode: mode.strained or nothing),
        Column("bound", _bound, name="error bound of the reduction", unit="1"),
        Column("mesh", mesh, lambda share: f"{share:.0e}", name="error bar", unit="1"),
    ]


def _bound(mode: TrainMode) -> Cell:
    words = "exact" if mode.frequency_hz == 0 else f"{max(mode.bound, ROUNDING):.0e}"
    return Cell(mode.bound, "", words)
