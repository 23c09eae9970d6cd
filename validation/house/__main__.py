"""The figures of a checkout as tables, or as JSON."""

from __future__ import annotations

import argparse
import ast
import json
import re
import runpy
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from validation.house import runs, structure, words
from validation.house.floors import MAY_IMPORT
from validation.house.source import KINDS, Source, sources

ROOT = Path(__file__).parent.parent.parent
#: for each kind of addition, one that exists, as the source names it
ADDITIONS = {
    "cut": r"cross_?hole|cross hole",
    "repeated feature": r"spline",
    "bearing kind": r"needle",
    "element": r"hex27",
    "output file": r"write_vtu",
    "mesh format": r"\buniversal\b",
    "model": r"\bcorrected\b",
    "option of a builder": r"\bedge_layers\b",
    "option of commands": r'"--json"',
    "quantity": r"\bk_theta\b|C_thy",
}
#: rooms whose module constants are colours and sizes of pages
PAGES = ("show",)


def figures(tree: Path) -> dict:
    """Return all figures of a checkout that need no run of it."""
    files = sources(tree / "solidgear")
    floors, room_of = floors_of(tree)
    rooms: dict[str, Counter[str]] = defaultdict(Counter)
    for source in files:
        rooms[room_of(source.module) or source.room] += source.lines + Counter(files=1)
    core = sum((row for name, row in rooms.items() if name.startswith("core")), Counter())
    return {
        "package": {name: dict(rooms[name]) for name in sorted(rooms)},
        "core": {"files": core.pop("files", 0), "lines": sum(core.values())},
        "other": {
            name: _lines(tree / name) for name in ("tests", "validation", "examples", "docs")
        },
        "pages": sum(_length(p) for p in tree.glob("solidgear/**/*") if p.suffix in PAGE_FILES),
        **_structure(files, floors, room_of),
        **_words(files),
        "files to touch": {
            name: [source.place for source in files if re.search(pattern, source.text)]
            for name, pattern in ADDITIONS.items()
        },
        "constants": _constants(files),
        "words of the documentation": sum(
            len(p.read_text(encoding="utf-8").split())
            for p in [tree / "README.md", *(tree / "docs").rglob("*.md")]
        ),
    }


#: templates and scripts of pages
PAGE_FILES = (".js", ".html", ".css")


def floors_of(tree: Path) -> tuple[dict[str, set[str]], Callable[[str], str]]:
    """Return the table of what each room of a checkout may import, and the room of a module."""
    path = tree / "validation" / "house" / "floors.py"
    table = runpy.run_path(str(path)) if path.exists() else {"MAY_IMPORT": MAY_IMPORT}
    return table["MAY_IMPORT"], table.get("room_of", _first_folder)


def _first_folder(module: str) -> str:
    """Return the room of a module in a checkout without a core."""
    return ".".join(module.split(".")[1:2])


def _structure(
    files: Sequence[Source], floors: dict[str, set[str]], room_of: Callable[[str], str]
) -> dict:
    """Return what the imports say."""
    running = structure.graph(files, types=False)
    read = structure.graph(files)
    single = structure.single_importers(running, structure.through_doors(files))
    home = structure.in_own_folder(single)
    lines = {source.module: sum(source.lines.values()) for source in files}
    return {
        "circles of modules as they run": structure.circles(running),
        "circles of modules as they are read": structure.circles(read),
        "circles of rooms as they are read": structure.circles(
            structure.between_rooms(read, room_of)
        ),
        "arrows up as the source is read": structure.arrows_up(read, floors, room_of),
        "modules with one importer": len(single),
        "of these in its own folder": len(home),
        "lines of these": sum(lines[module] for module in home),
    }


def _words(files: Sequence[Source]) -> dict:
    """Return what names, docstrings and types say."""
    no_nouns, names = words.pronouns(files)
    counts, total = words.docstring_words(files)
    return {
        "functions": sum(len(source.functions) for source in files),
        "names": names,
        "names that are no nouns": dict(no_nouns.most_common(12)),
        "share of names that are no nouns": round(sum(no_nouns.values()) / names, 4),
        "docstring words": total,
        "docstring words by 10,000": {w: round(1e4 * counts[w] / total, 1) for w in words.DIALECT},
        "typed Any": dict(words.open_types(files).most_common()),
        "forms": dict(words.shapes(files)),
    }


def _constants(files: Sequence[Source]) -> dict[str, int]:
    """Return how many module constants hold numbers, and how many numbers, outside pages."""
    names = numbers = 0
    for source in files:
        if source.room in PAGES:
            continue
        for node in source.tree.body:
            if not isinstance(node, ast.Assign | ast.AnnAssign) or node.value is None:
                continue
            target = node.targets[0] if isinstance(node, ast.Assign) else node.target
            if not isinstance(target, ast.Name) or not target.id.strip("_").isupper():
                continue
            constants = [n for n in ast.walk(node.value) if isinstance(n, ast.Constant)]
            count = sum(type(n.value) in (int, float) for n in constants)
            names += count > 0
            numbers += count
    return {"names": names, "numbers": numbers}


def _lines(folder: Path) -> int:
    """Return the lines of Python in a folder."""
    return sum(_length(path) for path in folder.rglob("*.py"))


def _length(path: Path) -> int:
    return len(path.read_text(encoding="utf-8").splitlines())


def table(rooms: dict[str, dict[str, int]]) -> Iterator[str]:
    """Yield the lines of the table of rooms."""
    total: Counter[str] = Counter()
    for row in rooms.values():
        total += Counter(row)
    yield f"{'room':<16}{'files':>6}" + "".join(f"{kind:>10}" for kind in KINDS) + f"{'all':>9}"
    for name, row in [*rooms.items(), ("sum", total)]:
        counts = [row.get(kind, 0) for kind in KINDS]
        cells = "".join(f"{count:>10}" for count in counts)
        yield f"{name:<16}{row.get('files', 0):>6}{cells}{sum(counts):>9}"
    share = total["logic"] / sum(total[kind] for kind in KINDS)
    yield f"share of logic: {100 * share:.1f} %"


def report(data: dict) -> Iterator[str]:
    """Yield the figures as lines for a terminal."""
    yield from table(data["package"])
    for key, value in data.items():
        if key == "package":
            continue
        if key.startswith("circles"):
            yield f"{key}: {len(value)}, of {[len(group) for group in value]}"
        elif key == "files to touch":
            for name, files in value.items():
                yield f"files that name a {name}: {len(files)}: {', '.join(files)}"
        elif key == "runs":
            for name, row in value.items():
                yield f"{name}: " + ", ".join(f"{k} {v}" for k, v in row.items())
        elif isinstance(value, list):
            yield f"{key}: {len(value)}, {', '.join(value)}"
        elif isinstance(value, dict):
            yield f"{key}: " + ", ".join(f"{name} {count}" for name, count in value.items())
        else:
            yield f"{key}: {value}"


def main() -> None:
    """Print the figures of a checkout, or write them."""
    parser = argparse.ArgumentParser(prog="python -m validation.house", description=__doc__)
    parser.add_argument("--tree", type=Path, default=ROOT, help="another checkout")
    parser.add_argument("--json", type=Path, help="a file for the figures")
    parser.add_argument("--runs", action="store_true", help="follow a few commands too")
    arguments = parser.parse_args()
    data = figures(arguments.tree)
    if arguments.runs:
        data["runs"] = runs.all_followed(arguments.tree)
    if arguments.json:
        arguments.json.write_text(json.dumps(data, indent=1) + "\n")
    print("\n".join(report(data)))


if __name__ == "__main__":
    main()
