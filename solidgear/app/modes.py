"""Command ``modes``: natural frequencies of one scene."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from solidgear.core import (
    LADDER,
    MOST_MODES,
    Quantity,
    SolidgearError,
    as_supports,
    bars_of_modes,
    listed,
    show,
)
from solidgear.core import modes as solve
from solidgear.core.judge.at_rest import spin_caution
from solidgear.core.judge.coarser_mesh import coarser_bars
from solidgear.core.judge.completeness import completeness, cut_short, split_apart
from solidgear.core.judge.hidden import complete_list, less_widest
from solidgear.core.plain import plain
from solidgear.core.solve.mixtures import mixtures
from solidgear.show.command import caution, command, say
from solidgear.show.options import Run, SceneFile, Solved, options, speed_of
from solidgear.show.remarks import cautions, load, open_ranges
from solidgear.show.settled import (
    SECOND_MESH,
    bar_lines,
    beyond,
    ended,
    heading,
    unjudged,
    without_bar,
)
from solidgear.show.terminal import modes_table
from solidgear.show.words import by_plane

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
    run: Run,
) -> None:
    turns = speed_of(speed)
    if max_frequency is not None and not max_frequency > 0:
        raise SolidgearError(f"--max-frequency {max_frequency:g}: must be greater than zero, in Hz")
    if n is not None and not 1 <= n <= MOST_MODES:
        raise SolidgearError(f"-n {show(n)}: give 1 to {MOST_MODES} modes")
    loaded = load(scene)
    body, settled = model.body(loaded, "modes")
    mode_set = solve(
        body,
        loaded,
        loaded.ask.modes if n is None else n,
        max_frequency=max_frequency or loaded.ask.max_frequency,
        count=count,
    )
    bounded = LADDER[body.fidelity].bounded
    if settled is not None and bounded:
        mode_set = complete_list(loaded, body, as_supports(loaded), mode_set)
    whole = mode_set.whole if count and not bounded else mode_set
    bars = bars_of_modes(loaded, body, whole, settled)
    if settled is None and model.on_two_meshes:
        bars = coarser_bars(loaded, body, whole, options(model.pairs))
    evidence = less_widest(mode_set.evidence, bars.values())
    bars = {name: bar for name, bar in bars.items() if name in mode_set.names}
    bare = without_bar(mode_set, bars)
    reason = model.without_bars(bars, settled, loaded, body)
    reason = reason or unjudged(bare, body.fidelity, second=settled is None)
    warnings = cautions(loaded, body)
    open_ = open_ranges(loaded)
    highest_hz = max_frequency or loaded.ask.max_frequency
    warnings += cut_short(mode_set.modes, n or loaded.ask.modes, highest_hz, option="-n")
    warnings += spin_caution(loaded, body, mode_set.modes, bars, turns)
    rows = [
        {
            "name": m.name,
            "family": m.family,
            "frequency_hz": m.frequency_hz,
            "multiplicity": m.multiplicity,
            "error": m.error,
            "bar": bars.get(m.name),
            "split": m.split,
        }
        for m in mode_set.modes
    ]
    if run.as_json:
        record = {
            "scene": loaded.name,
            "fidelity": body.fidelity,
            "dofs": body.size,
            "modes": rows,
            "evidence": evidence,
            "cautions": warnings,
            "open": open_.model_dump(mode="json"),
        }
        record |= {} if settled is None else plain(settled)
        record |= {"without_bar": bare, "why_without_bar": reason}
        print(json.dumps(record, default=float))
        ended(settled)
        return

    say(heading(loaded, body, settled), modes_table(mode_set.modes, bars, open_), soft_wrap=False)
    if len(rows) > MANY:
        shapes = sum(m.multiplicity for m in mode_set.modes)
        say(f"{shapes} shapes up to {mode_set.frequency_hz[-1]:.6g} Hz.")
    planes = by_plane(mode_set.names)
    if planes:
        say(planes.strip())
    e = mode_set.evidence
    say(*(f"caution: {sentence}" for sentence in split_apart(e)), soft_wrap=False)
    say(*(f"caution: {mixture.sentence}." for mixture in mixtures(mode_set)))
    if e["error"] > 1e-6:
        say(
            f"caution: rounding leaves errors of {e['error']:.0e} in frequencies, since the "
            "smallest cells are too stiff beside the shaft; use a coarser mesh.",
            soft_wrap=False,
        )
    if count:
        say(
            f"Residual {e['residual']:.1e}, orthogonality {e['orthogonality']:.1e}, rigid modes "
            f"{e['rigid_modes']}, {e['method']} on {e['backend']}.",
            soft_wrap=False,
        )
        say(completeness(evidence, body.fidelity), soft_wrap=False)
    lines = bar_lines(settled, {Quantity(name): bar for name, bar in bars.items()})
    if bars and settled is None:
        lines.append(SECOND_MESH)
    if not bars and reason:
        lines.append(f"No error bars: {reason}.")
    elif reason:
        lines.append(f"No error bar: {listed(bare, most=3)}; {reason}.")
    lines += beyond(bars, settled)
    say(*lines)
    say(*map(caution, warnings), soft_wrap=False)
    ended(settled)
