"""Scenes drawn by seeds, held against what is true: one command for all campaigns.

    python -m validation.campaign answers --seeds 95001 95020
    python -m validation.campaign shafts --seeds 1 100 --jobs 2
    python -m validation.campaign scoreboard

Options of a campaign: python -m validation.campaign NAME --help. What was found of each body and
its references are kept in validation/results/: a run that was stopped goes on where it was, and
another version of the product is judged by the same references. The score is written there too, and
`scoreboard` makes the page of all scores.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from validation.campaign import results, scoreboard
from validation.campaign.cases import CASES
from validation.campaign.run import run, timed
from validation.campaign.table import report
from validation.common import RESULTS


def parsed(arguments: list[str] | None = None) -> argparse.Namespace:
    """Options of the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    names = parser.add_subparsers(dest="campaign", required=True, metavar="NAME")
    names.add_parser("scoreboard", help="write the page of all scores")
    for case in CASES.values():
        own = names.add_parser(case.name, help=case.question, description=type(case).__doc__)
        add = own.add_argument
        add("--seeds", type=int, nargs=2, metavar=("FIRST", "LAST"), default=case.seeds)
        add("--jobs", type=int, default=1, help="bodies at a time")
        add("--seconds", type=float, default=case.seconds, help="that one call may take")
        add("--folder", type=Path, default=RESULTS, help="of rows, references and scores")
        add("--again", action="store_true", help="ask again what has been answered")
        case.options(own)
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> int:
    """Command line; the exit code is 1 if something does not hold."""
    given = parsed(arguments)
    if given.campaign == "scoreboard":
        scoreboard.PAGE.write_text(scoreboard.page(results.read()))
        return 0
    case = CASES[given.campaign]
    found, whole = run(case, given, timed(lambda text: print(text, flush=True)))
    print("\n".join(report(found, (*case.parts, *case.details), case.tag_of_costs)))
    if whole:
        print(f"\nscore: {results.write(given.folder, results.result(case, given, found))}")
    return int(found.wrong)


if __name__ == "__main__":
    sys.exit(main())
