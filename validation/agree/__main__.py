"""Run the relations on shipped files, and on files or folders that are named.

``python -m validation.agree [FILE or FOLDER ...] [--kinds nested ...] [--jobs 2]``
"""

from __future__ import annotations

import argparse
import json
import os
from collections import Counter
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import partial
from itertools import groupby
from pathlib import Path

from validation.agree.of_file import KINDS, relations
from validation.agree.relation import Relation, failed
from validation.agree.subjects import files_in

RESULTS = Path(__file__).parent.parent / "results" / "agree.json"


def main() -> int:
    """Run, print what does not hold, and keep the counts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--kinds", nargs="+", choices=list(KINDS), default=list(KINDS))
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--out", type=Path, default=RESULTS)
    given = parser.parse_args()
    files = files_in(given.files)
    seen: list[Relation] = []
    pool = ProcessPoolExecutor(given.jobs, max_tasks_per_child=1)
    with pool:
        waiting = {pool.submit(partial(relations, file, given.kinds)): file for file in files}
        for done in as_completed(waiting):
            file = waiting[done]
            rows = done.result()
            seen += rows
            bad = failed(rows)
            print(f"{file}: {len(rows)} relations, {len(bad)} do not hold", flush=True)
            for relation in bad:
                print(f"  {relation.kind}: {relation.name}: {relation.seen}", flush=True)
    _keep(given.out, seen)
    return 1 if failed(seen) else 0


def _keep(path: Path, seen: list[Relation]) -> None:
    """Write counts by kind and every relation that does not hold."""
    counts = Counter(relation.kind for relation in seen)
    bad = failed(seen)
    by_kind = {
        kind: {"relations": count, "failed": sum(r.kind == kind for r in bad)}
        for kind, count in sorted(counts.items())
    }
    for kind, row in by_kind.items():
        print(f"{kind}: {row['relations']} relations, {row['failed']} do not hold")
    by_file = {
        subject: [f"{r.kind}: {r.name}: {r.seen}" for r in rows]
        for subject, rows in groupby(sorted(bad, key=lambda r: r.subject), lambda r: r.subject)
    }
    text = json.dumps({"kinds": by_kind, "failed": by_file}, indent=1)
    temporary = path.with_suffix(".part")
    temporary.write_text(text + "\n", encoding="utf-8")
    os.replace(temporary, path)


if __name__ == "__main__":
    raise SystemExit(main())
