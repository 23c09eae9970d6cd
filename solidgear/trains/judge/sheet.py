"""Sheet of a train that is judged: which mix of models holds, and all numbers of the judge."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from solidgear.show import input_tables
from solidgear.show.command import caution
from solidgear.show.folder import begun
from solidgear.show.page_parts import figures
from solidgear.show.plot import Make
from solidgear.show.run_tables import pairs_of
from solidgear.show.sheet import Section, Sheet, Terminal, write_json
from solidgear.show.sketch import sketch_svg
from solidgear.show.table import Cell, Column, Table, text
from solidgear.show.units import GROUP, Units, in_ascii
from solidgear.show.viewer import viewer_fragment
from solidgear.show.words import capital, grouped, percent, seconds, whole
from solidgear.trains.judge.comparison import Pictures, TrainComparison
from solidgear.trains.judge.judge import Departure, Verdict
from solidgear.trains.modes.modes import unpublished_lines
from solidgear.trains.modes.sheet import frequencies
from solidgear.trains.page import tables as train_tables
from solidgear.trains.page.chart import columns_chart, response_chart
from solidgear.trains.page.files import crossings, over_frequency
from solidgear.trains.response.order_chart import order_chart

AXES = (
    "coupled at ports. Vectors are in the axes of each shaft's own file: y along the shaft, x and "
    "z across it."
)
PAIRED = (
    "Modes are paired by the motions of all ports, not by number. A mix leaves the tolerance of "
    "modes at the first mode that moves by more, and the tolerance of mesh force where it differs "
    "by more than the decibels given, at the same frequency."
)
PROVENANCE = (
    "Solution verification: error bars of the judge's frequencies by local problems, and the "
    "proven bound of the reduction. Model-form comparison: one model of a shaft against another. "
    "Validation needs an experiment, and there is none here: no train, bearing or tooth here is "
    "validated against experiment."
)


def comparison_sheet(
    comparison: TrainComparison,
    units: Units,
    pictures: Pictures | None = None,
    viewer: str = "",
) -> Sheet:
    """Return the sheet of a train whose models are compared, with pictures of a folder and HTML of
    the judge's modes; without a folder that of a terminal.
    """
    verdict, data = comparison.verdict, comparison.results()
    sections: Sequence[Section] = []
    if pictures is not None:
        data |= {"pictures": pictures.files, "left_out": pictures.left_out}
        sections = _sections(comparison, units, viewer)
    pictures = pictures or Pictures()
    of_teeth = [mesh.sentence(units) for mesh in comparison.tooth_stiffness]
    loudest, conclusions = comparison.top.sentences(), [*verdict.sentences(), *of_teeth]
    return Sheet(
        name="report",
        json_name="results",
        title=verdict.train,
        lead=_lead(comparison),
        tables=[],
        data=data,
        lines={
            "response": over_frequency(comparison.judge, comparison.orders.teeth),
            "orders": crossings(comparison.orders, comparison.modes.speeds),
        },
        words=_words(comparison),
        verdict=[*loudest, *conclusions],
        notes=[f"Whole run: {seconds(comparison.seconds)} s."],
        cautions=[*verdict.cautions, *pictures.left_out],
        sections=sections,
        pictures=[*pictures.files.values()],
        terminal=Terminal(
            heading=[f"{verdict.train}, up to {verdict.highest_hz:g} Hz", *loudest],
            tables=[verdict_table(verdict)],
            results=[*map(in_ascii, conclusions), *unpublished_lines(verdict.unpublished)],
            closing=[*map(caution, verdict.cautions)],
            lines="whole",
        ),
    )


def drawn_sheet(
    comparison: TrainComparison, units: Units, folder: Path, renders: bool = True
) -> Sheet:
    """Return the sheet of a folder, with pictures that are drawn into it."""
    with begun(folder):
        # numbers first: whatever happens to pictures, they are there; without a list of files,
        # since the folder is begun again when all of it is written
        write_json(folder / "results.json", comparison.results())
        pictures = comparison.pictures(folder) if renders else Pictures()
    return comparison_sheet(comparison, units, pictures, shapes(comparison, pictures, folder))


def shapes(comparison: TrainComparison, pictures: Pictures, folder: Path) -> str:
    """Return HTML of the judge's modes: to be turned, and pictures of the loudest."""
    viewer = viewer_fragment(comparison.turned(), first=next(iter(comparison.loud), ""))
    files = {capital(caption): folder / name for caption, name in pictures.files.items()}
    return viewer + figures(files, f"{capital(comparison.verdict.every)} shafts in place in")


def _lead(comparison: TrainComparison) -> str:
    """Return what the train is and what it is compared with."""
    train = comparison.assembly.train
    two = len(train.shafts) == 2
    count = "two shafts" if two else f"{len(train.shafts)} shafts"
    mixes = "every mix of models" if two else "mixes of models"
    source = f" Source: {train.source}." if train.source else ""
    return (
        f"solidgear report on the train {train.name}: {count} that mesh, with engine and load; "
        f"{mixes} against {train.every} shafts solid.{source}"
    )


def _words(comparison: TrainComparison) -> dict[str, str]:
    """Return the words of the charts."""
    every = comparison.verdict.every
    return {
        "response": (
            "Dynamic mesh force and transmission error of every model drawn; shaded: the tolerance "
            f"in decibels around {every} shafts solid. Dotted: where a model leaves it."
        ),
        "housing": (
            "Loads on the mounts of the housing and accelerations of its points, over all three "
            f"directions, {every} shafts solid."
        ),
        "orders": (
            f"Orders of the mesh and of {every} shafts over the speed of the "
            f"{comparison.modes.speeds}, and the natural frequencies they meet. Colour: mesh force "
            "along orders of the transmission error."
        ),
    }


def _sections(comparison: TrainComparison, units: Units, viewer: str) -> list[Section]:
    """Return the sections of the page."""
    train, verdict, judge = comparison.assembly.train, comparison.verdict, comparison.judge
    data, orders, solid = comparison.data, comparison.orders, f"{train.every} shafts solid"
    title, teeth = train.called, orders.teeth
    if [mesh.name for mesh in train.drivers] != ["mesh"]:
        title += f", driven by the {train.drivers[0].name}"
    drawn, marks = comparison.drawn, comparison.marks
    force: dict[str, Make] = {
        "response": partial(response_chart, drawn, title, teeth, verdict.decibels, marks, units)
    }
    if housing := train_tables.housing_columns(judge.columns):
        force["housing"] = partial(columns_chart, [judge], housing, teeth, units)
    chain = "Engine, shafts, teeth and load"
    if len(train.shafts) == 2:
        chain = "Engine, {}'s shaft, teeth, {}'s shaft and load".format(*train.shafts)
    peaks = train_tables.peaks(judge.peaks, "mesh force", "N", teeth, units, solid, judge.bars)
    met = train_tables.crossings(orders.crossings, units, comparison.modes.speeds)
    return [
        Section("train", "Train", f"{chain}, {AXES}", tables=[train_tables.facts(data, units)]),
        Section("mixes", "Verdict on the models", PAIRED, tables=[mixes_table(verdict)]),
        Section(
            "response",
            "Mesh force",
            charts=force,
            tables=[peaks, train_tables.housing(judge, units)],
            notes=[] if peaks else ["No peak of the mesh force lies in this range."],
        ),
        Section(
            "modes",
            "Natural frequencies",
            tables=[frequencies(comparison.modes, f"Natural frequencies, {solid}")],
            notes=comparison.modes.notes(),
        ),
        Section(
            "orders",
            "Order lines",
            charts={"orders": partial(order_chart, orders, title, teeth, units)},
            tables=[met],
            notes=[] if met else ["No order line meets a mode in this range."],
        ),
        Section("shapes", "Mode shapes", viewer=viewer),
        *(_shaft(k, side, data[side]["scene"], units) for k, side in enumerate(train.shafts)),
        Section(
            "provenance",
            "Provenance",
            PROVENANCE,
            tables=[pairs_of(comparison.environment, "Environment of the run")],
        ),
    ]


def _shaft(k: int, side: str, scene: Mapping[str, Any], units: Units) -> Section:
    """Return the section of one shaft: drawn, and its bearings."""
    words = (
        f"The shaft of the {side}: upper half in section, lower half from outside; y runs along the "
        "shaft, dimensions in mm."
    )
    return Section(
        f"shaft_{k}",
        f"Shaft of the {side}",
        drawings={words: sketch_svg(side, scene)},
        tables=[input_tables.bearings(scene, units)],
    )


def verdict_table(verdict: Verdict) -> Table:
    """Return every mix of models and where it leaves the tolerances, for a terminal."""

    def off(mix: Departure) -> str:
        if mix.error is None:
            return f"{mix.mode} gone" if mix.mode else ""
        digits = 1 if abs(mix.error) < 0.0995 else 0
        return f"{mix.mode} {100 * mix.error:+.{digits}f} %"

    columns = [
        text(" + ".join(verdict.cheapest.models), lambda mix: mix_words(mix.mix)),
        *_ends(verdict, "modes\n{}", "force\n{}"),
        text("first mode off", off),
        text("by", lambda mix: mix.cause),
        Column("s", lambda mix: mix.seconds, "{:.1f}".format),
        Column("first mode off by", lambda mix: mix.error, name="off", unit="1", hidden=True),
    ]
    title = "Within the tolerance up to, in Hz"
    return Table(title, columns, verdict.mixes, style="bare", name="mixes")


def mixes_table(verdict: Verdict) -> Table:
    """Return every mix of models for a page: where it leaves the tolerances, why, and its cost."""
    cheapest = verdict.cheapest

    def named(mix: Departure) -> str:
        return mix_words(mix.mix) + (", cheapest" if mix is cheapest else "")

    def off(mix: Departure) -> str | None:
        if not mix.mode:
            return None
        error = "no counterpart" if mix.error is None else percent(mix.error).replace(" ", GROUP)
        return f"{mix.mode}: {error}"

    columns = [
        Column(" + ".join(cheapest.models), named),
        *_ends(verdict, "modes within {}, Hz", "mesh force within {}, Hz"),
        text("first mode off", off),
        text("because of", lambda mix: mix.cause or None),
        Column("unknowns", lambda mix: mix.unknowns, grouped),
        Column("build and reduce, s", lambda mix: mix.seconds, seconds),
    ]
    return Table(
        f"Frequency up to which every mix of models agrees with {verdict.every} shafts solid, "
        "cheapest first",
        columns,
        verdict.mixes,
        "Cause: the shaft whose replacement by the solid helps most; for a lumped model, the "
        "assumption. Any peak or dip that moves a little leaves the tolerance in force.",
    )


def _ends(verdict: Verdict, modes: str, force: str) -> list[Column]:
    """Return columns of the frequencies up to which mixes hold, with heads for a tolerance."""
    tolerance, decibels = f"{100 * verdict.tolerance:g} %", f"{verdict.decibels:g} dB"

    def end(head: str, of: Callable[[Departure], float | None], name: str) -> Column:
        def cell(mix: Departure) -> Cell:
            hz = of(mix)
            return Cell(hz, "", f"{verdict.highest_hz:.0f}+" if hz is None else whole(hz))

        return Column(head, cell, name=name, unit="Hz")

    return [
        end(modes.format(tolerance), lambda mix: mix.modes_to_hz, f"modes within {tolerance}"),
        end(force.format(decibels), lambda mix: mix.force_to_hz, f"force within {decibels}"),
        end(force.format(tolerance), lambda mix: mix.close_to_hz, f"force within {tolerance}"),
    ]


def mix_words(mix: Sequence[str]) -> str:
    """Return models of the shafts in turn, in short."""
    return f"{'both' if len(mix) == 2 else 'all'} {mix[0]}" if len({*mix}) == 1 else " + ".join(mix)
