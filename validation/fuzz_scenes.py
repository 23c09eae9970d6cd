"""Fuzz of scene files and command lines: each is refused in plain sentences or leads to finite
numbers, and leaves nothing half done.

    python -m validation.fuzz_scenes [--cases 10000] [--seed 1] [--commands 0.4]

A *finding* is anything else: an exception that is not raised on purpose (a user would see a
traceback), a warning, a number that is not finite, a message that is not fit for a terminal or does
not name the file, more time than `LIMIT` or `COMMAND_LIMIT`, or a command that leaves a file that
is not whole, or anything at all when it is refused. Every case follows from the seed and its number
alone, so that a finding can be made again. Everything runs in this process, with memory and time
watched.
"""

from __future__ import annotations

import argparse
import contextlib
import csv
import io
import json
import os
import re
import shlex
import sys
import tempfile
import traceback
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from solidgear.errors import TOLD, SceneError, SolidgearError
from solidgear.ladder import build
from solidgear.solve.modes import modes
from solidgear.solve.statics import condense
from solidgear.studies.check import check_scene
from solidgear.studies.loading import load
from validation.common import ROOT, results_folder, show, write_rows
from validation.fuzz_commands import ENVIRONMENT, command_line, put
from validation.fuzz_limits import Overrun, watched
from validation.fuzz_mutations import mutant

# s of processor time, since wall time would blame the program for a busy machine; of a file, check
# of a thin tube included, and of a command line
LIMIT, COMMAND_LIMIT = 30.0, 30.0


@dataclass(frozen=True)
class Outcome:
    """What became of one case: accepted, refused or a finding; how far it came; the sentence, or
    what was found; its sort, or a traceback.
    """

    kind: str
    stage: str
    sentence: str = ""
    detail: str = ""


def _sort(sentence: str) -> str:
    return re.sub(r'"[^"]*"|\([^)]*\)|[-+]?\d[\d.e+-]*', "_", sentence.split(";")[0])[:60]


# ------------------------------------------------------------------------------------------------- files
def use(path: Path, harmonic: bool = False) -> Outcome:
    """Load a file and put the scene to use: 6x6 and modes of the Euler beam; on request the check
    and a light harmonic solid too.
    """
    stage = "load"
    try:
        with watched(LIMIT):
            scene = load(path)
            for fidelity, options in (("euler", {}), ("harmonic", {"order": 2, "layers": 1}))[
                : 1 + harmonic
            ]:
                stage = fidelity
                body = build(scene, fidelity, **options)
                found = condense(body, scene, scene.port.name)
                values = modes(body, scene, n=scene.ask.modes).frequency_hz
                if not (np.isfinite(found.stiffness).all() and np.isfinite(values).all()):
                    return Outcome("finding", stage, "a result is not finite")
                json.dumps(
                    {
                        "scene": scene.as_dict(),
                        "check": check_scene(scene, body) if harmonic else None,
                        "frequencies": values.tolist(),
                    },
                    allow_nan=False,
                )
    except SolidgearError as error:
        return _judged(error, path, stage)
    except Overrun:
        return Outcome("finding", stage, f"more than {LIMIT:g} s of processor time")
    except Exception as error:
        return Outcome(
            "finding", stage, f"{type(error).__name__}: {error}"[:300], traceback.format_exc()
        )
    return Outcome("accepted", stage)


def _judged(error: SolidgearError, path: Path, stage: str) -> Outcome:
    """Whether a refusal is sentences one can act on: one for each problem of a scene, TOLD at most,
    and one for anything else.
    """
    lines = str(error).splitlines()
    count = len(error.problems) if isinstance(error, SceneError) and stage == "load" else 1
    faults = {
        "is not one line for each problem": len(lines)
        != (1 if count == 1 else 1 + min(count, TOLD) + (count > TOLD)),
        "does not name the file": stage == "load"
        and not all(path.name in line for line in lines[: 1 + TOLD]),
        "is not fit for a terminal": any(
            not line.isprintable() or len(line) > 1000 for line in lines
        ),
        "speaks of the program's own parts": "pydantic" in str(error)
        or "Value error" in str(error),
    }
    for fault, true in faults.items():
        if true:
            return Outcome("finding", stage, f"the message {fault}: {str(error)!r}"[:400])
    return Outcome("refused", stage, lines[0], _sort(getattr(error, "reason", lines[0])))


# ------------------------------------------------------------------------------------------------- command lines
def command(arguments: list[str], folder: Path) -> tuple[int, str, str, list[Path]]:
    """Exit code, standard output and error of the command line run in this process, and the files
    it left in ``folder``.
    """
    from solidgear.cli import main

    out, err = io.StringIO(), io.StringIO()
    old, before = sys.argv, set(folder.rglob("*"))
    sys.argv = ["solidgear", *arguments]
    try:
        with (
            watched(COMMAND_LIMIT),
            contextlib.redirect_stdout(out),
            contextlib.redirect_stderr(err),
            contextlib.chdir(folder),
        ):
            main()
        code = 0
    except SystemExit as error:
        code = error.code or 0
    finally:
        sys.argv = old
    return code, out.getvalue(), err.getvalue(), sorted(set(folder.rglob("*")) - before)


def use_command(path: Path, expected: str) -> Outcome:
    """`stiffness --json` and, for what is refused, `compare --out`: exit code, one sentence or
    whole JSON, and nothing left behind.
    """
    runs = [["stiffness", path.name, "-f", "euler", "--json"]]
    if expected == "refused":
        runs.append(["compare", path.name, "--models", "euler", "--no-renders", "--out", "out"])
    for arguments in runs:
        outcome = use_arguments(arguments, path.parent)
        if outcome.kind == "finding":
            return outcome
        if outcome.kind != expected:
            return Outcome(
                "finding",
                outcome.stage,
                f"{expected} by the library, {outcome.kind} by the command: {outcome.sentence!r}",
            )
    return Outcome(expected, f"command {runs[-1][0]}")


def use_arguments(arguments: list[str], folder: Path) -> Outcome:
    """Run one command line in a folder and judge what it said and left."""
    stage = f"command {arguments[0] if arguments else ''}"[:40]
    try:
        code, out, err, left = command(arguments, folder)
        fault = _fault(arguments, code, out, err, left)
        if fault:
            return Outcome("finding", stage, fault[:400])
    except Overrun:
        return Outcome("finding", stage, f"more than {COMMAND_LIMIT:g} s of processor time")
    except Exception as error:
        return Outcome(
            "finding", stage, f"{type(error).__name__}: {error}"[:300], traceback.format_exc()
        )
    return Outcome(
        "refused" if code else "accepted",
        stage,
        err[:300] if code else "",
        _sort(
            err.removeprefix("solidgear: ").split(": ")[-1] if code == 1 else "usage" * (code == 2)
        ),
    )


def _fault(arguments: list[str], code: int, out: str, err: str, left: list[Path]) -> str:
    if "Traceback" in out + err:
        return f"a traceback: {err[-300:]!r}"
    if broken := [f"{path.name}: {why}" for path in left if (why := _not_whole(path))]:
        return f"left half done: {', '.join(broken)}"
    if code == 2:
        return (
            ""
            if ("Usage: " in err or "─ Error ─" in err) and not out and not left
            else f"wrong usage, output {out[:60]!r}, error {err[:200]!r}, left {left}"
        )
    # what was checked or compared may be answered in full and still end with 1: a fault of the
    # mesh, or no model that could be solved; 3 is an answer whose bar is above the tolerance
    answered = code in (0, 3) or code == 1 and out and arguments[0] in ("check", "compare")
    if not answered:
        lines = err.splitlines()
        listed = re.match(r"solidgear: \d+ problems in ", err)
        said = [
            line for line in lines if not re.match(r" *\d+\.\d s  ", line)
        ]  # stages that were reached are told as they come
        if (
            code != 1
            or out
            or not said
            or not said[0].startswith("solidgear: ")
            or len(said) != 1
            and not listed
        ):
            return f"exit code {code}, output {out[:60]!r}, error {err[:200]!r}"
        if not all(line.isprintable() and len(line) < 1500 for line in said):
            return f"not fit for a terminal: {err[:200]!r}"
        return f"refused, and left {', '.join(p.name for p in left)}" if left else ""
    if (
        "--json" in arguments
        and "--help" not in arguments
        and "-h" not in arguments
        and arguments[0] != "render"
    ):
        json.loads(
            out,
            parse_constant=lambda word: (_ for _ in ()).throw(ValueError(f"{word} in the JSON")),
        )
    return "" if out.strip() else "no answer and no refusal"


def _not_whole(path: Path) -> str:
    """Why a file left behind is not one that can be used."""
    if path.is_dir():
        return "" if any(path.iterdir()) else "an empty folder"
    if path.name.startswith(".") or path.suffix == ".part":
        return "a partial file"
    try:
        if path.suffix == ".json":
            json.loads(path.read_text(encoding="utf-8"))
        elif path.suffix == ".csv":
            text = path.read_text(encoding="utf-8")
            rows = list(csv.reader(io.StringIO(text)))
            if not text.endswith("\n") or len({len(row) for row in rows}) > 1:
                return "a torn row"
        elif path.suffix == ".html" and not path.read_text(encoding="utf-8").rstrip().endswith(
            "</html>"
        ):
            return "a torn page"
    except ValueError as error:
        return f"{type(error).__name__}"
    return ""


# ------------------------------------------------------------------------------------------------- a run
def run(
    cases: int,
    seed: int,
    *,
    commands: float = 0.4,
    every_command: int = 20,
    every_harmonic: int = 20,
    progress: Callable[[str], None] | None = None,
) -> list[dict]:
    """Rows of a whole run, one a case.

    Parameters
    ----------
    cases, seed : int
    commands : float
        Share of cases that are command lines; the others are files.
    every_command, every_harmonic : int
        Of the files, every so many-th also goes through the command line, or through the harmonic
        solid.
    """
    load(
        ROOT / "geometry" / "pinion_overhung.toml"
    )  # the first text with a unit imports pint, which is not the case's fault
    rows: list[dict] = []
    lines = round(cases * commands)
    before = {key: os.environ.get(key) for key in ENVIRONMENT}
    for number in range(cases):
        try:
            with tempfile.TemporaryDirectory() as place:
                if number < cases - lines:
                    row = _file_case(Path(place), seed, number, every_command, every_harmonic)
                else:
                    os.environ.update(ENVIRONMENT)
                    try:
                        row = _command_case(Path(place), seed, number)
                    finally:
                        for key, value in before.items():
                            os.environ.pop(key) if value is None else os.environ.update(
                                {key: value}
                            )
        except KeyboardInterrupt:
            if progress:
                progress(f"interrupted at case {number}; reporting what there is")
            return rows
        rows.append(row)
        if progress and row["outcome"] == "finding":
            progress(told(row))
        if progress and number % 500 == 499:
            progress(f"{number + 1} cases, {sum(r['outcome'] == 'finding' for r in rows)} findings")
    return rows


def told(row: dict) -> str:
    """A finding in one line that any terminal can show."""
    text = f"case {row['case']}: {row['what']}: {row['sentence']}"
    return text.encode("unicode_escape").decode()


def _file_case(
    folder: Path, seed: int, number: int, every_command: int, every_harmonic: int
) -> dict:
    scene, mutations, text = mutant(seed, number)
    path = folder / "spoilt.toml"
    path.write_bytes(text)
    outcome = use(path, harmonic=number % every_harmonic == 0)
    if outcome.kind != "finding" and number % every_command == 0:
        told = use_command(path, outcome.kind)
        outcome = told if told.kind == "finding" else outcome
    return _row(number, f"{scene}: {' '.join(mutations)}", outcome)


def _command_case(folder: Path, seed: int, number: int) -> dict:
    arguments, files = command_line(seed, number)
    put(files, folder)
    outcome = use_arguments(arguments, folder)
    return _row(
        number, shlex.join(a if len(a) < 60 else a[:50] + "..." for a in arguments), outcome
    )


def _row(number: int, what: str, outcome: Outcome) -> dict:
    return {
        "case": number,
        "what": what,
        "outcome": outcome.kind,
        "stage": outcome.stage,
        "sentence": outcome.sentence,
        "detail": outcome.detail,
    }


def main() -> int:
    """Command line; the exit code is 1 if anything was found."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--cases", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--commands", type=float, default=0.4)
    options = parser.parse_args()
    rows = run(
        options.cases,
        options.seed,
        commands=options.commands,
        progress=lambda line: print(line, file=sys.stderr, flush=True),
    )
    folder = results_folder("fuzz_scenes")
    write_rows(
        folder / "rows.csv",
        [
            {key: str(value).encode("unicode_escape").decode() for key, value in row.items()}
            for row in rows
        ],
    )
    kinds = Counter(
        (r["outcome"], r["stage"], r["detail"] if r["outcome"] == "refused" else r["sentence"][:70])
        for r in rows
    )
    table = [
        {"outcome": a, "stage": b, "sentence": c, "cases": n}
        for (a, b, c), n in sorted(kinds.items(), key=lambda item: (item[0][0], -item[1]))
    ]
    show(f"{options.cases} cases, seed {options.seed}", table)
    total = Counter(r["outcome"] for r in rows)
    print(
        f"accepted {total['accepted']}, refused {total['refused']} in "
        f"{sum(k[0] == 'refused' for k in kinds)} kinds of sentence, findings "
        f"{total['finding']}"
    )
    for row in (r for r in rows if r["outcome"] == "finding"):
        if not row["stage"].startswith("command") or row["case"] < options.cases * (
            1 - options.commands
        ):
            (folder / f"finding_{options.seed}_{row['case']}.toml").write_bytes(
                mutant(options.seed, row["case"])[2]
            )
        print(told(row))
    return 1 if total["finding"] else 0


if __name__ == "__main__":
    sys.exit(main())
