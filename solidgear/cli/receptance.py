"""The command receptance: motion of one port of a train for a unit force on another."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from solidgear.cli.app import FIDELITY, UNITS, JsonFlag, UnitsOption, caution, command, say
from solidgear.cli.shaft_settings import ShaftSettings, of_shafts
from solidgear.cli.train import (
    Against,
    Damping,
    GearModel,
    Kept,
    LocalHarmonics,
    MatchedAt,
    MaxFrequency,
    PinionModel,
    Point,
    Reduction,
    TrainFile,
    end_of,
    mix,
    print_peaks,
    workshop,
)

END = "as PORT:COMPONENT, such as gear.gear:z, in the axes of the port's own shaft."


@command
def receptance(
    train: TrainFile,
    from_: Annotated[str, typer.Option("--from", help=f"Where a unit force acts, {END}")],
    to: Annotated[str, typer.Option("--to", help=f"Whose motion is told, {END}")],
    out: Annotated[
        Path, typer.Option("--out", "-o", help="Folder for receptance.csv and its chart.")
    ] = Path("out"),
    pinion: PinionModel = FIDELITY,
    gear: GearModel = FIDELITY,
    against: Against = None,
    max_frequency: MaxFrequency = None,
    damping: Damping = "hysteretic",
    matched_at: MatchedAt = None,
    reduction: Reduction = "rubin",
    kept: Kept = 24,
    local_harmonics: LocalHarmonics = None,
    settings: ShaftSettings = None,
    point: Point = None,
    units: UnitsOption = UNITS,
    as_json: JsonFlag = False,
) -> None:
    """Receptance between any two ports of a train: table, chart, and peaks with their modes."""
    from solidgear.report.folder import held
    from solidgear.report.train_files import write_receptance
    from solidgear.studies.train.comparison import described
    from solidgear.studies.train.modes import unpublished_lines
    from solidgear.studies.train.receptance import receptance as run
    from solidgear.studies.train.slips import slips

    own = of_shafts(settings, pinion, gear)
    shop = workshop(train, reduction, kept, max_frequency, local_harmonics, point, own)
    ends = end_of("--from", from_), end_of("--to", to)
    mixes = [(pinion, gear), *map(mix, against or [])]
    unpublished, said = shop.train.unpublished(), slips(shop)
    cautions = [*said, *shop.cautions]
    title = f"{shop.train.called}: {to} for a unit force on {from_}"
    with held(out):
        found = [
            run(shop, *pair, *ends, max_frequency, damping, matched_at or 0.0) for pair in mixes
        ]
        notes = {"from": from_, "to": to, "unpublished": unpublished, "cautions": cautions}
        files = write_receptance(
            out, found, title, shop.train.pinion.teeth, notes, described(shop), units
        )
    if as_json:
        print((out / "receptance.json").read_text(encoding="utf-8"))
        return
    say(f"{title}; pinion {pinion}, gear {gear}, {damping} losses", *map(caution, said))
    tops, teeth = found[0].peaks, shop.train.pinion.teeth
    print_peaks(tops, "receptance", found[0].unit, teeth, units)
    say(*unpublished_lines(unpublished), *map(caution, shop.cautions))
    say(f"Written: {', '.join(map(str, files))}")
