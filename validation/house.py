"""Size and shape of the source: lines by kind and room, imports, circles, files to touch, constants.

``python -m validation.house`` prints the tables; ``--json FILE`` writes them, ``--tree DIR`` reads
another checkout, so that two can be held side by side.
"""

from __future__ import annotations

import argparse
import ast
import io
import json
import re
import tokenize
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

ROOT = Path(__file__).parent.parent
KINDS = ("code", "docstring", "comment", "blank")
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
#: first words of a docstring that is no sentence about a thing
ASKING = ("what", "whether", "where", "how", "which", "why")
#: a number in a module constant that no table of nature or standard gives: outside the pages, which
#: hold colours and sizes
UNTUNED = ("report",)


def lines_by_kind(path: Path) -> Counter[str]:
    """Lines of a Python file by what stands on them."""
    text = path.read_text(encoding="utf-8")
    kinds = ["blank" if not line.strip() else "code" for line in text.splitlines()]
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT and token.line.lstrip().startswith("#"):
            kinds[token.start[0] - 1] = "comment"
    for node in documented(ast.parse(text)):
        for k in range(node.lineno - 1, node.end_lineno or node.lineno):
            kinds[k] = "docstring"
    return Counter(kinds)


def documented(tree: ast.AST) -> Iterator[ast.expr]:
    """Expressions that are docstrings."""
    holders = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    waiting = [tree]
    while waiting:
        node = waiting.pop()
        # statements alone: expressions are most of a tree, and hold no docstring
        for name in ("body", "orelse", "handlers", "finalbody", "cases"):
            waiting += getattr(node, name, ())
        if isinstance(node, holders):
            match node.body:
                case [ast.Expr(value=ast.Constant(value=str()) as text), *_]:
                    yield text


def asks(docstring: ast.expr) -> bool:
    """True if a docstring begins with a question word and not with a noun or a verb."""
    assert isinstance(docstring, ast.Constant)
    return str(docstring.value).split(None, 1)[0].strip(",:").lower() in ASKING


def room_of(path: Path, package: Path) -> str:
    """First folder or module below the package."""
    return path.relative_to(package).parts[0].removesuffix(".py")


def module_of(path: Path, package: Path) -> str:
    """Dotted name of a file."""
    parts = path.relative_to(package.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imports(path: Path, known: set[str], *, late: bool) -> set[str]:
    """Modules of the package that a file imports as it runs; late ones stand in functions."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            node.body = []
    if not late:
        for node in ast.walk(tree):
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                node.body = [ast.Pass()]
    found: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module and not node.level:
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                found.add(full if full in known else node.module)
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
    return found & known


def circles(graph: dict[str, set[str]]) -> list[list[str]]:
    """Strongly connected groups of more than one module."""
    names = sorted(graph)
    links = np.array([[other in graph[name] for other in names] for name in names])
    _, group = connected_components(csr_matrix(links), connection="strong")
    groups = [[names[k] for k in np.flatnonzero(group == one)] for one in np.unique(group)]
    return sorted(one for one in groups if len(one) > 1)


def numbers_of(path: Path) -> dict[str, int]:
    """Numbers that the module constants of a file hold, by name."""
    out = {}
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            name, value = node.targets[0].id, node.value
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.value:
            name, value = node.target.id, node.value
        else:
            continue
        count = sum(
            isinstance(n, ast.Constant) and type(n.value) in (int, float) for n in ast.walk(value)
        )
        if name.strip("_").isupper() and count:
            out[name] = count
    return out


def measured(tree: Path) -> dict[str, object]:
    """All figures of a checkout."""
    package = tree / "solidgear"
    files = sorted(package.rglob("*.py"))
    known = {module_of(path, package) for path in files}
    rooms: dict[str, Counter[str]] = defaultdict(Counter)
    asking = docstrings = 0
    constants: Counter[str] = Counter()
    for path in files:
        rooms[room_of(path, package)] += lines_by_kind(path) + Counter(files=1)
        for node in documented(ast.parse(path.read_text(encoding="utf-8"))):
            docstrings += 1
            asking += asks(node)
        if room_of(path, package) not in UNTUNED:
            held = numbers_of(path)
            constants += Counter(names=len(held), numbers=sum(held.values()))
    now = {module_of(p, package): imports(p, known, late=False) for p in files}
    ever = {module_of(p, package): imports(p, known, late=True) for p in files}
    importers = Counter(there for here, theirs in ever.items() for there in theirs - {here})
    return {
        "package": {name: dict(rooms[name]) for name in sorted(rooms)},
        "other": {
            kind: _others(tree, kind) for kind in ("tests", "validation", "examples", "docs")
        },
        "pages": sum(len(p.read_text().splitlines()) for p in _pages(package)),
        "circles": circles(now),
        "circles with imports inside functions": circles(ever),
        "imports inside functions": sum(len(ever[m] - now[m]) for m in ever),
        "modules with one importer": sum(n == 1 for n in importers.values()),
        "files to touch": {
            name: sorted(
                str(p.relative_to(package))
                for p in files
                if re.search(word, p.read_text(encoding="utf-8"))
            )
            for name, word in ADDITIONS.items()
        },
        "constants": dict(constants),
        "docstrings": {"all": docstrings, "that begin with a question word": asking},
        "words": {
            str(p.relative_to(tree)): len(p.read_text(encoding="utf-8").split())
            for p in sorted([tree / "README.md", *(tree / "docs").rglob("*.md")])
        },
    }


def _others(tree: Path, folder: str) -> int:
    """Lines of Python beside the package."""
    return sum(len(p.read_text().splitlines()) for p in (tree / folder).rglob("*.py"))


def _pages(package: Path) -> list[Path]:
    """Scripts and templates of pages."""
    return [p for p in package.rglob("*") if p.suffix in (".js", ".html", ".css")]


def told(found: dict) -> Iterator[str]:
    """The figures as tables for a terminal."""
    total: Counter[str] = Counter()
    yield f"{'room':<14}{'files':>6}" + "".join(f"{kind:>11}" for kind in KINDS) + f"{'all':>9}"
    for name, row in found["package"].items():
        total += Counter(row)
        yield _row(name, row)
    yield _row("sum", total)
    yield f"pages (js, html, css): {found['pages']}"
    yield ", ".join(f"{name} {lines}" for name, lines in found["other"].items())
    for key in ("circles", "circles with imports inside functions"):
        yield f"{key}: {len(found[key])}, of {[len(group) for group in found[key]]} modules"
    for key in ("imports inside functions", "modules with one importer"):
        yield f"{key}: {found[key]}"
    for name, files in found["files to touch"].items():
        yield f"files that name a {name}: {len(files)}: {', '.join(files)}"
    yield f"module constants with numbers, outside pages: {found['constants']}"
    yield f"docstrings: {found['docstrings']}"
    yield f"words of the documentation: {sum(found['words'].values())}"


def _row(name: str, row: dict[str, int]) -> str:
    """One line of the table of rooms."""
    counts = [row.get(kind, 0) for kind in KINDS]
    cells = "".join(f"{count:>11}" for count in counts)
    return f"{name:<14}{row.get('files', 0):>6}{cells}{sum(counts):>9}"


def main() -> None:
    """Print the figures of a checkout, or write them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tree", type=Path, default=ROOT)
    parser.add_argument("--json", type=Path)
    asked = parser.parse_args()
    found = measured(asked.tree)
    if asked.json:
        asked.json.write_text(json.dumps(found, indent=1) + "\n")
    print("\n".join(told(found)))


if __name__ == "__main__":
    main()
