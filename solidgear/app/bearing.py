"""The command on bearings of catalogue data."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from solidgear.bearings.bearing_life import bearing_lives
from solidgear.bearings.chart import BearingPanel, draw_bearings
from solidgear.bearings.designation import boundary
from solidgear.bearings.life_command import plain_life, print_life
from solidgear.bearings.rolling import UNITS
from solidgear.bearings.study import BearingFacts, bearing_facts, loaded_by, over_load
from solidgear.core import DOF_NAMES, Scene, SolidgearError, as_written, explained, parse, shaft
from solidgear.core.plain import plain
from solidgear.core.scene.toml_file import describes_train
from solidgear.show.command import command, say
from solidgear.show.options import Run, SceneFile, speed_of
from solidgear.show.plot import check_ending
from solidgear.show.terminal import matrix_table
from solidgear.show.words import engineering


@command
def bearing(
    scene: SceneFile,
    *,
    load: Annotated[
        str | None,
        typer.Option(
            "--load",
            help='Another load, such as "x=2 kN, z=-500 N, thx=10 N*m", on the port or the bearing '
            "of --bearing.",
        ),
    ] = None,
    name: Annotated[
        str | None, typer.Option("--bearing", help="Only this bearing, under --load.")
    ] = None,
    speed: Annotated[
        str | None,
        typer.Option("--speed", help='Speed of the shaft, such as "3000 rpm", for lives in hours.'),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", help="Chart of stiffness over load: a file that ends in .png or .svg."
        ),
    ] = None,
    run: Run,
) -> None:
    if describes_train(parse(str(scene))):
        # start-up: a fifth of a second that bearings of a shaft have no use for
        from solidgear.trains.load.life_command import show_train

        of_scenes = {"--load": load, "--speed": speed, "--out": out}
        show_train(scene, name, of_scenes, run.as_json)
        return
    if out is not None:
        check_ending(out)
    turns = speed_of(speed)
    loaded = as_written(scene)
    if load is not None:
        loaded = loaded_by(loaded, load, name)
    with explained(scene):
        body = shaft(loaded)
        facts = [fact for fact in bearing_facts(loaded, body) if name in (None, fact.name)]
        if not facts:
            raise SolidgearError(f"--bearing {name}: no bearing of catalogue data has this name")
        lives = {life.name: life for life in bearing_lives(loaded, body, turns)}
        if out is not None:
            _draw(out, loaded, body, facts)
    if run.as_json:
        bearings = [_plain(fact) | {"life": plain_life(lives[fact.name])} for fact in facts]
        print(json.dumps({"scene": loaded.name, "bearings": bearings}, allow_nan=False))
        return
    for fact in facts:
        _print(fact)
        print_life(lives[fact.name])
    if out is not None:
        say(f"Chart: {out}")


def _draw(out: Path, scene: Scene, body, facts: Sequence[BearingFacts]) -> None:
    curves = over_load(scene, body)
    panels = [
        BearingPanel(
            f"bearing {fact.name}, {fact.called}",
            curves[fact.name].factors,
            curves[fact.name].middle[:, :3],
            curves[fact.name].low[:, :3],
            curves[fact.name].high[:, :3],
            [(row.azimuth, row.load) for row in fact.rows],
        )
        for fact in facts
    ]
    draw_bearings(out, panels)


def _print(fact: BearingFacts) -> None:
    kind = fact.called
    ignored = boundary(fact.data.designation).ignored if fact.data.designation else ""
    unused = f" (read and ignored: {ignored})" if ignored else ""
    support = f", {fact.bearing.support}" if fact.bearing.support else ""
    say(f"Bearing {fact.name!r}: {kind}{unused}{support}, {fact.bearing.status}")
    i = fact.inside
    size = f"{i['elements']} elements of {1e3 * i['element_diameter']:.4g}"
    if "element_length" in i:
        size += f" x {1e3 * i['element_length']:.4g}"
    inside = f"{size} mm a row on {1e3 * i['pitch_diameter']:.5g} mm"
    if i["contact_angle"]:
        inside += f", contact angle {np.degrees(i['contact_angle']):.4g} deg"
    room = f"; radial clearance at work {1e6 * fact.made.clearance:.3g} um"
    say(inside + room * (fact.data.kind != "thrust_ball"))
    if fact.made.estimated:
        words = ", ".join(fact.made.estimated).replace("_", " ")
        say(f"Estimated from boundary dimensions and ratings: {words}.")
    # contacts that balance each other leave the rounding of their sum
    at_work = max(np.abs(fact.load).max(), sum(row.load.sum() for row in fact.rows))
    parts = [
        f"{n} {engineering(v, 4)} {u}"
        for n, v, u in zip(DOF_NAMES, fact.load, UNITS)
        if abs(v) > 1e-9 * at_work
    ]
    say(f"Load: {', '.join(parts) or 'none'}")
    moved = [
        f"{n} {1e6 * v:.4g} {'um' if k < 3 else 'urad'}"
        for k, (n, v) in enumerate(zip(DOF_NAMES, fact.motion))
        if abs(v) > 1e-12
    ]
    say(f"Displacement: {', '.join(moved) or 'none'}")
    scale = np.sqrt(np.abs(np.diag(fact.stiffness)))
    stiffness = np.where(
        np.abs(fact.stiffness) > 1e-12 * np.outer(scale, scale), fact.stiffness, 0.0
    )
    say(matrix_table(stiffness, "stiffness"))
    # a bearing that carries nothing has no stiffness at either end
    if fact.spread is not None and np.any(fact.spread[1] > 0):
        ends = [
            f"{n} {engineering(low, 3)} to {engineering(high, 3)}"
            for n, low, high in zip(DOF_NAMES, *fact.spread)
            if high > 0
        ]
        say(f"Range over the estimated inside, from soft to stiff: {', '.join(ends)}.")
    for k, row in enumerate(fact.rows):
        place = "" if len(fact.rows) == 1 else f" of the {'lower' if k == 0 else 'upper'} row"
        carrying = row.load > 0
        if not carrying.any():
            continue
        angle = np.degrees(row.angle[carrying])
        turned = (
            f", contact angle {angle.min():.2f} to {angle.max():.2f} deg" if angle.any() else ""
        )
        say(
            f"{int(carrying.sum())} of {len(row.load)} elements{place} carry, at most "
            f"{engineering(float(row.load.max()), 4)} N{turned}, pressure "
            f"{row.inner.max() / 1e6:.0f} MPa inside, {row.outer.max() / 1e6:.0f} MPa outside"
        )
    for note in fact.notes:
        say(f"caution: bearing {fact.name!r}: {note}")


def _plain(fact: BearingFacts) -> dict[str, Any]:
    data = {
        "name": fact.name,
        "kind": fact.data.kind,
        "designation": fact.data.designation,
        "status": fact.bearing.status,
        "support": fact.bearing.support or None,
        "inside": fact.inside,
        "estimated": fact.made.estimated,
        "clearance": fact.made.clearance,
        "load": fact.load,
        "displacement": fact.motion,
        "stiffness": fact.stiffness,
        "spread": fact.spread,
        "rows": [
            {
                "azimuth": row.azimuth,
                "load": row.load,
                "contact_angle": row.angle,
                "pressure_inner": row.inner,
                "pressure_outer": row.outer,
            }
            for row in fact.rows
        ],
        "notes": fact.notes,
    }
    return plain(data)
