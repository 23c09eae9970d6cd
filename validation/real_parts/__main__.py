"""Random parts with features through every model, and a table of what held."""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from validation.real_parts.claims import judged
from validation.real_parts.scenes import SORTS, draw


def main() -> int:
    """Command line; the exit code is 1 where a claim does not hold."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sort", choices=SORTS)
    parser.add_argument("--light", action="store_true", help="no bands")
    parser.add_argument("--commands", action="store_true", help="the command line as well")
    given = parser.parse_args()
    done = refused = failed = 0
    seed = given.seed
    with tempfile.TemporaryDirectory() as folder:
        while done < given.scenes:
            part = draw(seed, given.sort)
            path = Path(folder) / f"part_{seed}.toml"
            more = {"bands": not given.light, "commands": given.commands}
            out = judged(part.text, seed, path, **more)
            seed += 1
            if out.refused:
                refused += 1
                continue
            done += 1
            failed += bool(out.failures)
            numbers = ", ".join(f"{k} {v:.1e}" for k, v in out.numbers.items())
            print(
                f"{out.seed} | {part.sort}: {out.words} | {numbers} | {out.seconds:.1f} s",
                flush=True,
            )
            for failure in out.failures:
                print(f"    FAILS: {failure}", flush=True)
    print(f"{done} parts, {failed} with failures; {refused} drawn that do not fit together")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
