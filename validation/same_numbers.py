"""Whether another state of the source gives the same numbers: every shipped scene and train.

    git worktree add ../before SOME_COMMIT
    python -m validation.same_numbers ../before [--only pinion_overhung] [--relative 1e-12]

Both are run by this interpreter, each with its own source; times, memory and machine are left out.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from validation.common import ROOT
from validation.shipped import GEOMETRY

#: seconds in a sentence
TIMES = re.compile(r"[\d.e+-]+ s\b")
#: what may differ between two runs of one source
VARIES = {"seconds", "seconds_total", "peak_mb", "expected_peak_mb", "environment", "created"}


def results(tree: Path, scene: Path, folder: Path) -> dict:
    """The record of a comparison by the source under ``tree``."""
    command = [sys.executable, "-m", "solidgear.cli", "compare", str(scene), "--no-renders"]
    env = {**os.environ, "PYTHONPATH": str(tree)}
    subprocess.run(
        [*command, "--out", str(folder)], cwd=folder, env=env, check=True, capture_output=True
    )
    record = json.loads((folder / "results.json").read_text())
    # mixes of models of a train stand by their seconds
    record["verdict"].get("mixes", []).sort(key=lambda mix: (mix["pinion"], mix["gear"]))
    return record


def differences(a, b, relative: float, where: str = "") -> Iterator[str]:
    """Places at which two records differ, in words."""
    if isinstance(a, dict) and isinstance(b, dict):
        for key in sorted({*a, *b} - VARIES):
            if key not in a or key not in b:
                yield f"{where}/{key}: only {'after' if key in b else 'before'}"
            else:
                yield from differences(a[key], b[key], relative, f"{where}/{key}")
    elif isinstance(a, list) and isinstance(b, list):
        if len(a) != len(b):
            yield f"{where}: {len(a)} entries, then {len(b)}"
        for k, (x, y) in enumerate(zip(a, b, strict=False)):
            yield from differences(x, y, relative, f"{where}/{k}")
    elif isinstance(a, float) and isinstance(b, float):
        if not math.isclose(a, b, rel_tol=relative, abs_tol=0.0) and not (a != a and b != b):
            yield f"{where}: {a!r}, then {b!r}"
    elif isinstance(a, str) and isinstance(b, str) and TIMES.sub("", a) == TIMES.sub("", b):
        return
    elif a != b:
        yield f"{where}: {a!r}, then {b!r}"


def lost(found: Iterator[str]) -> list[str]:
    """Differences without what is only there now."""
    return [line for line in found if not line.endswith(": only after")]


def main() -> int:
    """Command line; the exit code is 1 if anything differs."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("before", type=Path, help="root of the other source")
    parser.add_argument("--only", default="", help="scenes with this word in their name")
    parser.add_argument("--relative", type=float, default=1e-12)
    options = parser.parse_args()
    wrong = 0
    for scene in (s for s in sorted(GEOMETRY.glob("*.toml")) if options.only in s.stem):
        with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as two:
            before = results(options.before.resolve(), scene, Path(one))
            after = results(ROOT, scene, Path(two))
        found = lost(differences(before, after, options.relative))
        wrong += len(found)
        print(f"{scene.stem}: {len(found)} differences", flush=True)
        for line in found[:20]:
            print("   ", line)
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
