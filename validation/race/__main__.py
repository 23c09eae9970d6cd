"""Races.

    python -m validation.race commands [--heat ...] [--runs 3] [--read] [--quick]
    python -m validation.race commands --heat compare --against FOLDER [SCENE.toml ...]

Results go to validation/results/NAME.json, a record a heat with date, commit and machine; `--read`
shows what is there. The exit code is 1 where something that was asked for was missed. Ctrl-C keeps
what has been run so far.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from validation.common import read_result
from validation.race.assembly import ASSEMBLY
from validation.race.backlash import BACKLASH
from validation.race.bearings import BEARINGS
from validation.race.commands import COMMANDS, THREADS
from validation.race.heat import Heat
from validation.race.installed import missing
from validation.race.peers import PEERS
from validation.race.race import Race, missed, told
from validation.race.real_parts import REAL_PARTS
from validation.race.sensitivities import SENSITIVITIES
from validation.race.solids import SOLIDS
from validation.race.sweep import SWEEP
from validation.race.trains import TRAINS

RACES: dict[str, Race] = {
    "commands": COMMANDS,
    "threads": THREADS,
    "assembly": ASSEMBLY,
    "bearings": BEARINGS,
    "trains": TRAINS,
    "backlash": BACKLASH,
    "sweep": SWEEP,
    "sensitivities": SENSITIVITIES,
    "solids": SOLIDS,
    "peers": PEERS,
    "real_parts": REAL_PARTS,
}


def main() -> int:
    """Command line."""
    listed = "\n".join(f"  {name:14}{race.question}" for name, race in RACES.items())
    parser = argparse.ArgumentParser(
        description=f"{__doc__}\n{listed}", formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("name", choices=RACES)
    parser.add_argument("--heat", help="some of its heats, by commas; all by default")
    parser.add_argument("--lane", default="", help="only lanes whose name holds this")
    parser.add_argument("--runs", type=int, help="rounds; every lane runs once a round")
    parser.add_argument("--quick", action="store_true", help="small: does it work, not how fast")
    parser.add_argument("--limit", type=float, default=900.0, help="seconds a process may take")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=NUMBER")
    parser.add_argument("--read", action="store_true", help="run nothing, show the result on file")
    parser.add_argument("--against", type=Path, metavar="FOLDER", help="another checkout")
    parser.add_argument("scenes", nargs="*", type=Path, help="further scene files")
    given = parser.parse_intermixed_args()
    race = RACES[given.name]
    heats = given.heat.split(",") if given.heat else list(race.heats)
    for heat in heats:
        if heat not in race.heats:
            parser.error(f"--heat {heat} is unknown; use {', '.join(race.heats)}")
    try:
        settings = race.settings | {k: float(v) for k, v in (s.split("=") for s in given.set)}
    except ValueError:
        parser.error(f"--set takes KEY=NUMBER, one of {race.settings or 'none'}")
    if unknown := set(settings) - set(race.settings):
        parser.error(f"--set {unknown.pop()} is unknown; use {race.settings or 'none'}")
    rounds = race.rounds if given.runs is None else given.runs
    if rounds < 1:
        parser.error(f"--runs {rounds} is not a number of rounds; use 1 or more")
    # a quick run replaces no result
    name = f"quick/{given.name}" if given.quick else given.name
    if not given.read:
        if absent := missing(*race.needs):
            print(absent)
        asked = Heat(given.quick, given.limit, settings, given.against, tuple(given.scenes))
        try:
            race.run(name, heats, rounds, asked, given.lane)
        except KeyboardInterrupt:
            print("interrupted: what has been run so far follows")
    found = {heat: record for heat, record in read_result(name).items() if heat in heats}
    for heat, record in found.items():
        told(given.name, heat, record)
    if race.read:
        race.read(found, settings)
    return int(not given.quick and any(map(missed, found.values())))


if __name__ == "__main__":
    sys.exit(main())
