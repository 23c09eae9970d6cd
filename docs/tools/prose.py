"""Prose of README and documentation held to its limits: `python docs/tools/prose.py`.

Prose and tables count as words; code, consoles, directives and formulas do not.
"""

import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
#: made by a program from something else that is checked
GENERATED = {
    "docs/guide/bearing_keys.md",
    "docs/gallery.md",
    "docs/validation/backlash.md",
    "docs/validation/experiments.md",
    "docs/validation/reducer.md",
    "docs/validation/scoreboard.md",
    "docs/validation/stability.md",
}
#: and a table of a page that is
MADE = re.compile(r"<!-- made by .*?<!-- made until here -->", re.S)
PARAGRAPH, SENTENCE, RUN = 120, 35, 12
#: words of the longest page, and of all of them
PAGE, TOTAL = 1000, 26500
#: what docs/glossary.md has another word for
BANNED = {
    r"\bFE model": "model",
    r"\bconfidence (?:band|interval)": "error bar",
    r"\berror bands?\b": "error bar",
    r"\buncertainty bands?\b": "error bar",
    r"\bspoke model": "sector",
    r"\b(?:eigenfrequency|eigenfrequencies)\b": "natural frequency",
    r"\bgear ?shafts? assembl\w+": "train",
    r"\bsubstructures?\b": "superelement",
    r"\breference point of the gear": "lumped point",
    r"\bmultipoint constraint": "attachment",
    r"\bgrounded springs?\b": "bearing",
}
#: turns that a stranger reads twice, and plain ones: none of them in any page
UNPLAIN = {
    r"\btold\b": "shown, printed or given",
    r"\btells?\b": "shows, says or prints",
    r"\bmatter of\b": "depends on",
    r"\bhangs? on\b": "depends on",
    r"^\W*Of\b": "a sentence that begins with its subject",
    r"\b[Oo]f an? [\w ]+, it (?:is|has)\b": "a sentence that begins with its subject",
    r"(?<![Ee]rror )(?<!flat )\bbars?\b(?! C$)(?!, discs)(?! shorter)": "error bar",
}
#: turns that are English now and then, and how often they may stand in all pages: only ever less
RARE = {r"\b(?:that|those) of\b": 15}


class Piece(NamedTuple):
    """Prose that belongs together: a paragraph, an item of a list, or a cell of a table."""

    line: int
    text: str
    cell: bool


def plain(text: str) -> str:
    """Text as it is read: links by their words, pictures left out, code as one word."""
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", " ", text)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"`[^`]*`", "`code`", text)
    return re.sub(r"\$[^$]+\$", "`code`", text)


def pieces(text: str) -> Iterator[Piece]:
    """Paragraphs, items and cells of a page, each with its first line."""
    fence, start, held = "", 0, list[str]()
    text = MADE.sub(lambda made: "\n" * made[0].count("\n"), text)
    for number, line in enumerate([*text.splitlines(), ""], 1):
        mark = re.match(r"\s*(```+|:::+|\$\$(?!.*\$\$))", line)
        inside = bool(fence)
        if mark and (not fence or line.strip() == fence):
            fence = "" if fence else mark[1]
        table = line.lstrip().startswith("|")
        heading = line.startswith("#")
        item = re.match(r"\s*(?:[-*]|\d+\.) ", line)
        out = inside or mark or table or heading or line.startswith("    ") or not line.strip()
        if held and (out or item):
            yield Piece(start, plain(" ".join(held)), False)
            held = []
        if not out:
            start = start if held else number
            held.append(line.strip())
        elif (table or heading) and not inside:
            for cell in re.split(r"(?<!\\)\|", line.strip("# ")):
                if cell.strip(" -:"):
                    yield Piece(number, plain(cell.strip()), True)


def words(text: str) -> list[str]:
    """Words of prose."""
    return [w for w in re.findall(r"[^\s]+", text) if re.search(r"\w", w)]


def sentences(text: str) -> list[str]:
    """Sentences of a piece; a colon or a semicolon ends none."""
    return re.split(r"(?<=[.!?])[*)\"]*\s+(?=[*`\"(\[]*[A-Z0-9`])", text)


def length(page: str, text: str) -> Iterator[str]:
    """Paragraphs and sentences that are too long."""
    for piece in pieces(text):
        count = len(words(piece.text))
        if count > PARAGRAPH:
            yield f"{page}:{piece.line}: a paragraph of {count} words, more than {PARAGRAPH}"
        for sentence in sentences(piece.text):
            count = len(words(sentence))
            if count > SENTENCE:
                start = " ".join(words(sentence)[:6])
                yield f"{page}:{piece.line}: {count} words, more than {SENTENCE}: {start} ..."


def banned(page: str, text: str) -> Iterator[str]:
    """Words for which the glossary has another one."""
    for piece in pieces(text):
        for pattern, better in BANNED.items():
            if match := re.search(pattern, piece.text, re.I):
                yield f"{page}:{piece.line}: {match[0]!r}, in the glossary {better!r}"


def unplain(page: str, text: str) -> Iterator[str]:
    """Yield the turns of :data:`UNPLAIN` in a page, each with a plain one."""
    for piece in pieces(text):
        for sentence in sentences(piece.text):
            for pattern, better in UNPLAIN.items():
                if match := re.search(pattern, sentence):
                    yield f"{page}:{piece.line}: {match[0]!r}, better {better!r}"


def too_often(pages: dict[str, str]) -> Iterator[str]:
    """Yield the turns of :data:`RARE` that stand in more places than they may."""
    for pattern, most in RARE.items():
        places = [
            f"{page}:{piece.line}"
            for page, text in pages.items()
            for piece in pieces(text)
            for _ in re.finditer(pattern, piece.text)
        ]
        if len(places) > most:
            yield f"{pattern} in {len(places)} places, more than {most}: {', '.join(places)}"


def twice(pages: dict[str, str]) -> Iterator[str]:
    """Runs of words that stand in more than one place."""
    seen: dict[tuple[str, ...], tuple[str, int]] = {}
    for page, text in pages.items():
        for piece in pieces(text):
            run = [w.strip(".,;:()*\"'").lower() for w in words(piece.text)]
            reported = False
            for k in range(len(run) - RUN + 1):
                key = tuple(run[k : k + RUN])
                first = seen.setdefault(key, (page, piece.line))
                if first != (page, piece.line) and not reported:
                    reported = True
                    where = f"{first[0]}:{first[1]}"
                    yield f"{page}:{piece.line}: stands in {where} too: {' '.join(key)}"


def size(page: str, text: str) -> int:
    """Words of a page that count."""
    return sum(len(words(piece.text)) for piece in pieces(text))


def faults(pages: dict[str, str]) -> list[str]:
    """Everything that is out of its limits, as file:line and the rule."""
    found = [
        fault
        for rule in (length, banned, unplain)
        for page, text in pages.items()
        for fault in rule(page, text)
    ]
    found += too_often(pages)
    found += twice(pages)
    sizes = {page: size(page, text) for page, text in pages.items()}
    found += [f"{p}:1: {n} words, more than {PAGE}" for p, n in sizes.items() if n > PAGE]
    if sum(sizes.values()) > TOTAL:
        found.append(f"all pages: {sum(sizes.values())} words, more than {TOTAL}")
    return found


def hand_written() -> dict[str, str]:
    """Pages that somebody writes, by their path."""
    paths = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    names = {p.relative_to(ROOT).as_posix(): p for p in paths if "written" not in p.parts}
    return {
        name: path.read_text(encoding="utf-8")
        for name, path in names.items()
        if name not in GENERATED
    }


if __name__ == "__main__":
    pages = hand_written()
    if "--sizes" in sys.argv:
        for page, text in pages.items():
            print(f"{size(page, text):6} {page}")
        print(f"{sum(size(p, t) for p, t in pages.items()):6} in all")
    wrong = faults(pages)
    print("\n".join(wrong))
    sys.exit(bool(wrong))
