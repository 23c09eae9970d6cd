"""Commands of the documentation, run again: what a page shows is what the program prints.

A block of kind `console` holds commands behind `$` and, below each, what it prints; `...` stands for
lines left out. A block of kind `toml` with a caption is a file that the commands read. Every page
runs in a folder of its own, with the shipped scenes and examples beside it.

    python docs/tools/console.py docs/tutorial.md             # compare
    python docs/tools/console.py --write docs/tutorial.md     # write what is printed today
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
#: columns of the pages' text
COLUMNS = "88"
#: relative difference of numbers that is none: libraries and processors differ far less, and no
#: table is wrong by this much unseen, since words must agree exactly
SAME = 0.02
#: numbers below this are rounding, in SI and as parts of one alike
ROUNDING = 1e-11
NUMBER = re.compile(r"(?<![\w.])[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+|[kM])?(?!\w)")
#: how large counts are written
SIZES = {"k": "e3", "M": "e6"}
#: numbers of a machine and not of a shaft: seconds, megabytes
OF_A_MACHINE = re.compile(r"[\d.]+ (?:m?s|MB|GB)\b")
BACKEND = re.compile(r"\b(?:pardiso|cholmod|mumps|superlu)\b")
LEFT_OUT = "..."


@dataclass
class Block:
    """A fenced block of a page: its kind, its first and last line, its text and its caption."""

    kind: str
    start: int
    end: int
    lines: list[str]
    caption: str = ""


@dataclass
class Step:
    """A command and what is printed below it."""

    command: str
    shown: list[str] = field(default_factory=list)


def blocks(text: str) -> list[Block]:
    """Fenced blocks of a page, in order."""
    out, lines, i = [], text.splitlines(), 0
    while i < len(lines):
        opening = re.match(r"(`{3,}|:{3,})\{?(?:code-block\} )?([\w-]+)\}?\s*$", lines[i])
        if not opening:
            i += 1
            continue
        fence, kind = opening.groups()
        last = next(j for j in range(i + 1, len(lines)) if lines[j].strip() == fence)
        body, caption = lines[i + 1 : last], ""
        while body and re.match(r":\w+:", body[0]):
            key, _, value = body.pop(0).partition(" ")
            caption = value if key == ":caption:" else caption
        out.append(Block(kind, i + 1, last, body, caption.strip("`")))
        i = last + 1
    return out


def steps(block: Block) -> list[Step]:
    """Commands of a console block."""
    out: list[Step] = []
    for line in block.lines:
        if line.startswith("$ "):
            out.append(Step(line[2:]))
        elif out:
            out[-1].shown.append(line)
    return out


def run(command: str, folder: Path) -> str:
    """What a command prints, errors among it; progress goes to standard error and is left out."""
    environment = os.environ | {
        "COLUMNS": COLUMNS,
        "PYTHONPATH": str(ROOT),
        "TERM": "dumb",
        "NO_COLOR": "1",
    }
    words = re.sub(r"\bpython (?=\S)", f"{sys.executable} ", command)
    words = re.sub(r"\bsolidgear (?=\S)", f"{sys.executable} -m solidgear.app --quiet ", words)
    done = subprocess.run(
        words,
        shell=True,
        cwd=folder,
        env=environment,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=240,
    )
    return "\n".join(line.rstrip() for line in done.stdout.splitlines())


def value(text: str) -> float:
    """A number as it is printed, ``94.1k`` too."""
    return float(text[:-1] + SIZES.get(text[-1], text[-1]))


def words_and_numbers(text: str) -> tuple[list[str], list[float]]:
    """Words without numbers, and numbers without what a machine adds."""
    text = "\n".join(map(without_rounding, without_times(text).splitlines()))
    text = BACKEND.sub("BACKEND", OF_A_MACHINE.sub("TIME", text))
    numbers = [value(n) for n in NUMBER.findall(text)]
    words = re.findall(r"[^\W\d_]+", NUMBER.sub(" ", text))
    return words, numbers


def without_rounding(line: str) -> str:
    """Numbers far below the largest of their row, as zeros: what is left of a symmetry."""
    largest = max((abs(value(n)) for n in NUMBER.findall(line)), default=0.0)
    return NUMBER.sub(lambda n: "0" if abs(value(n[0])) < ROUNDING * largest else n[0], line)


def without_times(text: str) -> str:
    """Tables without their last column where it is one of times."""
    out, timed = [], False
    for line in text.splitlines():
        if re.search(r"(\btime(, s)?|  s)$", line.rstrip()):
            timed = True
        elif line and not line.startswith(" "):
            timed = False  # tables are indented
        out.append(re.sub(r"[\d.]+\s*$", "", line) if timed else line)
    return "\n".join(out)


def same(shown: str, printed: str) -> str:
    """Empty if both tell the same; else what differs."""
    theirs, numbers = words_and_numbers(shown)
    ours, found = words_and_numbers(printed)
    if theirs != ours:
        first = next((a, b) for a, b in zip([*theirs, "(end)"], [*ours, "(end)"]) if a != b)
        return f"the page says {first[0]!r} where the program says {first[1]!r}"
    if len(numbers) != len(found):
        return f"{len(numbers)} numbers on the page, {len(found)} printed"
    for a, b in zip(numbers, found):
        if max(abs(a), abs(b)) > ROUNDING and abs(a - b) > SAME * max(abs(a), abs(b)):
            return f"the page says {a:g} where the program says {b:g}"
    return ""


def differs(step: Step, printed: str) -> str:
    """Empty if a step shows what was printed, with lines left out where the page says so."""
    shown = "\n".join(step.shown).strip("\n")
    if LEFT_OUT not in [line.strip() for line in step.shown]:
        return same(shown, printed.strip("\n"))
    rest = printed.splitlines()
    for part in re.split(rf"(?m)^\s*{re.escape(LEFT_OUT)}\s*$", shown):
        part_lines = part.strip("\n").splitlines()
        if not part_lines:
            continue
        for at in range(len(rest) - len(part_lines) + 1):
            if not same("\n".join(part_lines), "\n".join(rest[at : at + len(part_lines)])):
                rest = rest[at + len(part_lines) :]
                break
        else:
            return f"not printed: {part_lines[0].strip()!r} and what follows"
    return ""


def workplace() -> Path:
    """A folder as the reader's: shipped scenes and examples in it, and nothing else."""
    folder = Path(tempfile.mkdtemp(prefix="pages"))
    for name in ("geometry", "examples"):
        shutil.copytree(ROOT / name, folder / name)
    return folder


def check(path: Path, write: bool = False, without: str = "") -> list[str]:
    """What a page shows and the program does not print, one sentence each.

    Parameters
    ----------
    path : Path
        A page.
    write : bool
        Put what is printed into the page instead; blocks that leave lines out stay.
    without : str
        A command that is not run, such as ``compare``.
    """
    text = path.read_text()
    lines, wrong, folder = text.splitlines(), [], workplace()
    replaced: list[tuple[Block, list[str]]] = []
    try:
        for block in blocks(text):
            if block.kind == "toml" and block.caption:
                (folder / block.caption).write_text("\n".join(block.lines) + "\n")
            if block.kind != "console":
                continue
            fresh: list[str] = []
            for step in steps(block):
                if without and step.command.startswith(f"solidgear {without}"):
                    fresh += [f"$ {step.command}", *step.shown]
                    continue
                printed = run(step.command, folder)
                kept = LEFT_OUT in [line.strip() for line in step.shown]
                if problem := differs(step, printed):
                    wrong.append(f"{path.name}, $ {step.command}: {problem}")
                fresh.append(f"$ {step.command}")
                fresh += step.shown if kept else printed.strip("\n").splitlines()
            replaced.append((block, fresh))
    finally:
        shutil.rmtree(folder)
    if write:
        for block, fresh in reversed(replaced):
            lines[block.start : block.end] = fresh
        path.write_text("\n".join(lines) + "\n")
    return wrong


def main() -> int:
    """Compare or write the pages named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pages", nargs="+", type=Path)
    parser.add_argument("--write", action="store_true")
    chosen = parser.parse_args()
    wrong = [problem for page in chosen.pages for problem in check(page, chosen.write)]
    print("\n".join(wrong) or "every page shows what the program prints")
    return 1 if wrong and not chosen.write else 0


if __name__ == "__main__":
    sys.exit(main())
