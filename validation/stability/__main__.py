"""Run every script of this folder and write one report: method, edge measured, what the program
does about it.

python -m validation.stability [--quick] [--only NAME ...]
"""

from __future__ import annotations

import argparse
import importlib
import sys
import time
import traceback

from validation.common import markdown, results_folder
from validation.stability.frame import FOLDER, ROOT, findings, publish

#: what scripts share, and what a fillet changes, which is no edge
NO_EDGE = ("frame", "fillets")
SCRIPTS = sorted(
    p.stem for p in FOLDER.glob("*.py") if not p.stem.startswith("_") and p.stem not in NO_EDGE
)


def run(names, quick: bool = False):
    """Findings by script name, and one sentence for each script that failed; a failure does not
    stop the others.
    """
    done, failed = {}, {}
    for name in names:
        start = time.perf_counter()
        try:
            script = importlib.import_module(f"validation.stability.{name}")
            done[name] = findings(script.measure(quick=quick))
            for finding in done[name]:
                publish(finding, getattr(script, "draw", None))
        except Exception as error:
            done.pop(name, None)
            failed[name] = f"{type(error).__name__}: {error}"
            traceback.print_exc()
        print(
            f"{name:28s} {'failed' if name in failed else 'done':7s} {time.perf_counter() - start:6.1f} s",
            flush=True,
        )
    return done, failed


def report(done, failed) -> str:
    """The whole table and every finding, as Markdown."""
    whole = [f for name in sorted(done) for f in done[name]]
    rows = [
        (f"[{_cell(f.method)}](#{f.name.replace('_', '-')})", _cell(f.edge), _cell(f.program))
        for f in whole
    ]
    head = ("method", "edge measured", "what the program does")
    lines = ["# Where methods fail", "", *markdown(head, rows)]
    lines += ["", *(f"- `{name}` could not be measured: {why}" for name, why in failed.items()), ""]
    for f in whole:
        heading = f.name.replace("_", "-")
        lines += [f"## {heading}", "", f"**{f.method}.** {f.fails} {f.edge} {f.program}", ""]
        lines += [f"Guard held by `{f.guard}`.", ""] if f.guard else []
        lines += [f"![{heading}]({f.name}/chart.png)", "", f"[rows]({f.name}/rows.csv)", ""]
    return "\n".join(lines)


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")


def main() -> int:
    """Command line; the exit code is 1 if any script failed."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="fewer and coarser points")
    parser.add_argument(
        "--only",
        nargs="+",
        choices=SCRIPTS,
        default=SCRIPTS,
        metavar="NAME",
        help="of " + ", ".join(SCRIPTS),
    )
    options = parser.parse_args()
    done, failed = run(options.only, options.quick)
    target = results_folder("stability") / "report.md"
    target.write_text(report(done, failed))
    print(f"written to {target.relative_to(ROOT)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
