"""Files of what campaigns came to: the score with date, commit, seeds and machine."""

from __future__ import annotations

import argparse
import json
import re
from pathlib import Path

from solidgear.core.machine.whole_file import whole
from validation.campaign import table
from validation.campaign.case import Case
from validation.campaign.rows import Found
from validation.common import RESULTS, stamp


def result(case: Case, given: argparse.Namespace, found: Found) -> dict[str, object]:
    """A score and where it came from, as plain data."""
    made = stamp()
    return {
        "campaign": case.name,
        "asked": case.asked(given),
        "date": made["date"].split()[0],
        "commit": made["commit"],
        "machine": "{cpu}, {cores} cores".format(**made["machine"]),
        "bars": table.bars(found.rows, case.parts),
        "details": table.bars(found.rows, case.details),
        "verdicts": table.verdicts(found.verdicts),
        "checks": table.checks(found.verdicts),
        "costs": table.costs(found.costs, case.tag_of_costs),
        "misses": table.misses(found.rows) if case.singly else [],
        "cases": table.cases(found.verdicts),
        "failures": found.failures,
        "problems": len(found.problems),
    }


def write(folder: Path, content: dict[str, object]) -> Path:
    """Write a result under the name of its campaign and what was asked."""
    words = re.sub(r"[^a-z0-9]+", "_", f"{content['campaign']} {content['asked']}".lower())
    path = folder / f"{words.strip('_')[:60]}.json"
    folder.mkdir(parents=True, exist_ok=True)
    with whole(path) as partial:
        partial.write_text(json.dumps(content, indent=1) + "\n")
    return path


def read(folder: Path = RESULTS) -> list[dict]:
    """Results of campaigns in a folder with their names, the newest first; races write there too."""
    paths = sorted(folder.glob("*.json"))
    found = [json.loads(path.read_text()) | {"name": path.stem} for path in paths]
    campaigns = [one for one in found if "campaign" in one]
    return sorted(campaigns, key=lambda one: one["date"], reverse=True)
