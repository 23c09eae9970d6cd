"""Command ``modes``: natural frequencies of one scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any

import typer

from solidgear.core import (
    LADDER,
    Mode,
    ModeSet,
    OpenNumbers,
    Quantity,
    Settled,
    SolidgearError,
    bars_of_modes,
    listed,
    number_cautions,
    without_axis,
)
from solidgear.core.errors import NoBounds
from solidgear.core.judge.asked import checked_number, modes_of_scene
from solidgear.core.judge.bounded import NOTHING_BEYOND
from solidgear.core.judge.completeness import completeness, cut_short, split_apart
from solidgear.core.judge.hidden import less_bars
from solidgear.core.machine.memory import NoRoom
from solidgear.core.plain import plain
from solidgear.core.solve.mixtures import mixtures
from solidgear.show import open_words
from solidgear.show.command import Progress, caution, command
from solidgear.show.options import CaseName, Run, SceneFile, Solved, speed_of
from solidgear.show.remarks import cautions, load, open_ranges
from solidgear.show.settled import Judged, bar_lines, source_of_bars
from solidgear.show.sheet import Sheet, present
from solidgear.show.table import Column, Table, text
from solidgear.show.words import by_plane, hertz, percent

#: rows of a list whose beginning has left the terminal
MANY = 30


@command
def modes(
    scene: SceneFile,
    *,
    model: Solved,
    n: Annotated[
        int | None, typer.Option("-n", help="Number of elastic shapes; twins count twice.")
    ] = None,
    max_frequency: Annotated[
        float | None, typer.Option(help="Hz; leave out modes above it.")
    ] = None,
    count: Annotated[
        bool,
        typer.Option("--count", help="Prove by a second factorisation that no mode was missed."),
    ] = False,
    speed: Annotated[
        str | None,
        typer.Option(
            help='Speed of the shaft, such as "3000 rpm": shows which frequencies spin moves, and '
            "how far."
        ),
    ] = None,
    case: CaseName = None,
    run: Run,
) -> None:
    turns = speed_of(speed)
    if max_frequency is not None and not max_frequency > 0:
        raise SolidgearError(f"--max-frequency {max_frequency:g}: must be greater than zero, in Hz")
    asked = None if n is None else checked_number(n)
    loaded = load(scene, case)
    if turns and without_axis(loaded):
        raise SolidgearError(
            f"--speed: {loaded.name} has no axis that it could turn about; leave it out"
        )
    asked = asked or loaded.ask.modes
    highest_hz = max_frequency or loaded.ask.max_frequency

    def study(progress: Progress) -> Sheet:
        body, settled = model.body(loaded, "modes", progress)
        is_solid = bool(LADDER[body.fidelity].bars_by)
        how = {"max_frequency": highest_hz, "count": count}
        mode_set = modes_of_scene(loaded, body, settled, asked, **how)
        whole = mode_set.whole if count and not is_solid else mode_set
        reason = model.without_bars(settled)
        bars: dict[str, float] = {}
        if not reason:
            try:
                bars = bars_of_modes(loaded, body, whole, settled)
            except (NoBounds, NoRoom) as error:
                reason = str(error)
        above = [mode for mode in whole.modes if mode.name not in mode_set.names]
        elastic = [str(mode.name) for mode in mode_set.modes if mode.frequency_hz > 0]
        # where the mesh is off by no one knows how much, it does not count the modes of the body
        every = bars if bars.keys() >= set(elastic) else {}
        evidence = less_bars(mode_set.evidence, every, above)
        bars = {name: bar for name, bar in bars.items() if name in mode_set.names}
        judged = Judged(
            loaded,
            body,
            settled,
            {Quantity(name): bar for name, bar in bars.items()},
            reason,
            [
                *cautions(loaded, body),
                *cut_short(mode_set.modes, asked, highest_hz, option="-n"),
                *(mixture.sentence for mixture in mixtures(mode_set)),
                *number_cautions(
                    loaded, {name: bars.get(name) for name in elastic}, body.fidelity, turns
                ),
            ],
            open_ranges(loaded),
        )
        return modes_sheet(mode_set, judged, evidence, count)

    present(study, run)


def modes_sheet(modes: ModeSet, judged: Judged, proof: dict[str, Any], counted: bool) -> Sheet:
    """Return the sheet of natural frequencies, with the evidence of a count of modes."""
    settled, model = judged.settled, judged.body.fidelity
    bars = {str(name): bar for name, bar in judged.bars.items()}
    bare = [m.name for m in modes.modes if m.frequency_hz > 0 and m.name not in bars]
    reason = judged.reason
    if bare and not reason:
        reason = NOTHING_BEYOND
    data = {
        "scene": judged.scene.name,
        "model": model,
        "unknowns": judged.body.size,
        "modes": [
            {
                "name": m.name,
                "family": m.family,
                "frequency_hz": m.frequency_hz,
                "multiplicity": m.multiplicity,
                "solver_error": m.error,
                "bar": bars.get(m.name),
                "split": m.split,
            }
            for m in modes.modes
        ],
        "evidence": proof,
        "cautions": judged.cautions,
        "open": judged.open,
    }
    evidence = modes.evidence
    notes = [by_plane(modes.names).strip()]
    if len(modes.modes) > MANY:
        shapes = sum(m.multiplicity for m in modes.modes)
        notes.insert(0, f"{shapes} shapes up to {modes.frequency_hz[-1]:.6g} Hz.")
    notes += map(caution, split_apart(modes, bars))
    if evidence["error"] > 1e-6:
        notes.append(
            caution(
                f"rounding leaves errors of {evidence['error']:.0e} in frequencies, since the "
                "smallest cells are too stiff beside the shaft; use a coarser mesh."
            )
        )
    if counted:
        notes += [
            f"Residual {evidence['residual']:.1e}, orthogonality {evidence['orthogonality']:.1e}, "
            f"rigid modes {evidence['rigid_modes']}, {evidence['method']} on {evidence['backend']}.",
            completeness(proof, model),
        ]
    notes += bar_lines(settled, judged.bars, bool(bare))
    if bars and settled is None:
        notes.append(source_of_bars(model))
    if not bars and reason:
        notes.append(f"No error bars: {reason}.")
    elif reason:
        notes.append(f"No error bar: {listed(bare, most=3)}; {reason}.")
    return Sheet(
        name="modes",
        title=judged.heading,
        lead="",
        tables=[modes_table(modes.modes, bars, judged.open)],
        data=plain(
            data
            | ({} if settled is None else plain(settled))
            | {"without_bar": bare, "why_without_bar": reason}
        ),
        notes=[*filter(None, notes), *_beyond(bars, settled)],
        cautions=judged.cautions,
        reached=judged.reached,
    )


def modes_table(modes: Sequence[Mode], bars: Mapping[str, float], open_: OpenNumbers) -> Table:
    """Return natural frequencies with names and multiplicity, error bars and ranges."""

    def bar(mode: Mode) -> str:
        width = bars.get(mode.name)
        return "" if width is None else percent(width, signed=False)

    columns = [
        text("mode", lambda m: m.name or None),
        text("family", lambda m: m.family or None),
        Column("frequency, Hz", lambda m: m.frequency_hz, hertz),
        Column("shapes", lambda m: m.multiplicity),
        *([Column("error bar", bar)] if bars else []),
        *open_words.columns(open_, lambda mode: mode.name),
    ]
    return Table("", columns, modes, open_words.remark(open_))


def _beyond(bars: Mapping[str, float], settled: Settled | None) -> list[str]:
    """Return sentences on error bars beyond the tolerance of quantities that are not judged."""
    if settled is None or not settled.reached:
        return []
    wide = {name: bar for name, bar in bars.items() if bar > settled.tolerance}
    if not wide:
        return []
    names = listed((f"{q} +- {percent(bar, signed=False)}" for q, bar in wide.items()), most=3)
    return [
        f"Beyond {percent(settled.tolerance, signed=False)}: {names}; --tol holds the first mode "
        "of every family, and a smaller one narrows these too."
    ]
