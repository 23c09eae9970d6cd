"""Methods driven to their edges: every script of this folder measures one, and one page tells what
fails, where, and what the program does about it.

python -m validation.stability [--quick] [--only NAME ...]
python -m validation.stability --page
"""

from __future__ import annotations

import argparse
import importlib
import sys
import time
import traceback
from collections.abc import Iterable
from pathlib import Path

from validation.common import ROOT, show
from validation.stability.frame import Finding
from validation.stability.page import PAGE, keep, missing, write_page

#: what scripts share, and what a fillet changes, which is no edge
NO_EDGE = ("__init__", "__main__", "frame", "page", "fillets")
SCRIPTS = sorted(p.stem for p in Path(__file__).parent.glob("*.py") if p.stem not in NO_EDGE)


def run(names: Iterable[str], quick: bool = False) -> list[str]:
    """Measure, show and keep what scripts find; names of those that failed, which stop no others."""
    failed = []
    for name in names:
        start = time.perf_counter()
        try:
            script = importlib.import_module(f"validation.stability.{name}")
            found = script.measure(quick=quick)
            for finding in [found] if isinstance(found, Finding) else found:
                show(finding.method, finding.rows)
                print(finding.fails, finding.edge, finding.program, sep="\n")
                print(f"written to {keep(finding, script.draw).relative_to(ROOT)}")
        except Exception:
            failed.append(name)
            traceback.print_exc()
        word = "failed" if name in failed else "done"
        print(f"{name:28s} {word:7s} {time.perf_counter() - start:6.1f} s\n", flush=True)
    return failed


def main() -> int:
    """Command line; the exit code is 1 if any script failed."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="fewer and coarser points")
    parser.add_argument("--page", action="store_true", help="write the page of what was found")
    parser.add_argument(
        "--only",
        nargs="+",
        choices=SCRIPTS,
        default=SCRIPTS,
        metavar="NAME",
        help="of " + ", ".join(SCRIPTS),
    )
    options = parser.parse_args()
    if options.page:
        if names := missing():
            print(f"not measured yet: {', '.join(names)}")
            return 1
        write_page()
        print(f"written to {PAGE.relative_to(ROOT)}")
        return 0
    return int(bool(run(options.only, options.quick)))


if __name__ == "__main__":
    sys.exit(main())
