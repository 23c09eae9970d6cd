"""Random parts with features through every model, and a table of what held."""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import solidgear as sg
from validation.real_parts.claims import judged
from validation.real_parts.judge import HEAD, Part, judge, light, summary, told
from validation.real_parts.scenes import SORTS, draw


def main() -> int:
    """Command line; the exit code is 1 where a claim does not hold."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sort", choices=SORTS)
    parser.add_argument("--light", action="store_true", help="no bands")
    parser.add_argument("--commands", action="store_true", help="the command line as well")
    parser.add_argument(
        "--judge", action="store_true", help="bars and verdicts against a reference"
    )
    parser.add_argument(
        "--again", action="store_true", help="bars anew, of what models said the last time"
    )
    given = parser.parse_args()
    if given.judge:
        return _judge(given)
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


def _judge(given: argparse.Namespace) -> int:
    """Bars against references; the exit code is 1 where what is called valid is not."""
    parts: list[Part] = []
    seed = given.seed
    print(*HEAD, sep="\n")
    with tempfile.TemporaryDirectory() as folder:
        while len(parts) < given.scenes:
            drawn = draw(seed, given.sort)
            seed += 1
            path = Path(folder) / f"part_{drawn.seed}.toml"
            path.write_text(drawn.text)
            try:
                if not light(sg.load(path)):
                    continue
            except sg.SolidgearError:
                continue  # it does not fit together
            try:
                parts.append(judge(drawn.text, drawn.seed, drawn.words, path, again=given.again))
            except (sg.SolidgearError, MemoryError) as error:
                print(f"    seed {drawn.seed}, {drawn.words}: no reference: {error}", flush=True)
                continue
            print(*told(parts[-1]), sep="\n", flush=True)
    print(*summary(parts), sep="\n")
    wrong = any(
        said and is_so is False
        for p in parts
        for verdict in p.verdicts.values()
        for said, is_so in verdict.values()
    )
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
