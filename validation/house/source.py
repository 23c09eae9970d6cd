"""Files of the package and what stands on their lines."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections import Counter, deque
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

#: kinds of lines, in the order in which the table shows them
KINDS = (
    "logic",
    "signature",
    "field",
    "import",
    "raise",
    "words",
    "comment",
    "docstring",
    "blank",
)
#: words in a row that make a string a text for people
PROSE = re.compile(r"[A-Za-z]{2,}[ ,;:]+[a-z]{2,}[ ,]+[a-z(]")

FUNCTION = (ast.FunctionDef, ast.AsyncFunctionDef)


@dataclass(frozen=True)
class Source:
    """A file of the package."""

    path: Path
    package: Path

    @cached_property
    def text(self) -> str:
        """Content of the file."""
        return self.path.read_text(encoding="utf-8")

    @cached_property
    def tree(self) -> ast.Module:
        """Syntax of the file."""
        return ast.parse(self.text)

    @property
    def place(self) -> str:
        """Path below the package."""
        return str(self.path.relative_to(self.package))

    @property
    def room(self) -> str:
        """First folder or module below the package."""
        return self.path.relative_to(self.package).parts[0].removesuffix(".py")

    @property
    def module(self) -> str:
        """Dotted name."""
        parts = self.path.relative_to(self.package.parent).with_suffix("").parts
        return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)

    @cached_property
    def functions(self) -> list[ast.FunctionDef | ast.AsyncFunctionDef]:
        """Functions and methods, nested ones too."""
        return [node for node in statements(self.tree) if isinstance(node, FUNCTION)]

    @cached_property
    def lines(self) -> Counter[str]:
        """Lines by what stands on them."""
        kinds = ["" if line.strip() else "blank" for line in self.text.splitlines()]
        for first, last, kind in _marks(self):
            for k in range(first - 1, min(last, len(kinds))):
                kinds[k] = kinds[k] or kind
        return Counter(kind or "logic" for kind in kinds)


def sources(package: Path) -> list[Source]:
    """Return all files of a package."""
    return [Source(path, package) for path in sorted(package.rglob("*.py"))]


def statements(tree: ast.AST) -> Iterator[ast.stmt]:
    """Yield the statements below a node, outer ones first; expressions, which hold none and are nine
    nodes in ten, are not walked.
    """
    pending = deque(ast.iter_child_nodes(tree))
    while pending:
        node = pending.popleft()
        if isinstance(node, ast.stmt):
            yield node
        if isinstance(node, ast.stmt | ast.ExceptHandler | ast.match_case):
            pending.extend(ast.iter_child_nodes(node))


def documented(tree: ast.AST) -> Iterator[ast.Constant]:
    """Yield the docstrings of a module and of all that it holds."""
    holders = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    for node in ast.walk(tree):
        if isinstance(node, holders):
            match node.body:
                case [ast.Expr(value=ast.Constant(value=str()) as text), *_]:
                    yield text


def _marks(source: Source) -> Iterator[tuple[int, int, str]]:
    """Yield first line, last line and kind; the first mark of a line holds."""
    for docstring in documented(source.tree):
        yield docstring.lineno, docstring.end_lineno or docstring.lineno, "docstring"
    for token in tokenize.generate_tokens(io.StringIO(source.text).readline):
        if token.type == tokenize.COMMENT and token.line.lstrip().startswith("#"):
            yield token.start[0], token.start[0], "comment"
    nodes = [*statements(source.tree)]
    for kind, types in (("import", (ast.Import, ast.ImportFrom)), ("raise", (ast.Raise,))):
        for node in nodes:
            if isinstance(node, types):
                yield node.lineno, node.end_lineno or node.lineno, kind
    for text in ast.walk(source.tree):
        if isinstance(text, ast.Constant | ast.JoinedStr) and PROSE.search(_text(text)):
            yield text.lineno, text.end_lineno or text.lineno, "words"
    for node in nodes:
        if isinstance(node, (*FUNCTION, ast.ClassDef)):
            first = min([d.lineno for d in node.decorator_list] + [node.lineno])
            kind = "field" if isinstance(node, ast.ClassDef) else "signature"
            yield first, node.body[0].lineno - 1, kind
        if isinstance(node, ast.ClassDef):
            for field in node.body:
                if isinstance(field, ast.AnnAssign):
                    yield field.lineno, field.end_lineno or field.lineno, "field"


def _text(node: ast.Constant | ast.JoinedStr) -> str:
    """Return what a string holds beside its fields."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ""
    return "".join(v.value for v in node.values if isinstance(v, ast.Constant))
