"""Sentences on the fields of classes, where they stand in the code.

A field has its sentence in a comment ``#:`` behind it or above it, where it may begin with the names
of several fields, or else in the section Attributes of the docstring of its class.
"""

from __future__ import annotations

import ast
import inspect
import re
import sys
from collections.abc import Iterator
from functools import cache

#: an entry of a section: names, a type or none, indented lines
_ENTRY = re.compile(r"^(\S[^:\n]*?)(?: : [^\n]*)?$\n?((?:^    [^\n]*\n?)*)", re.MULTILINE)
_SECTION = re.compile(r"\n\n\w+\n-+\n")
_NAMES = re.compile(r"(\w+(?:, \w+)*): (.*)", re.S)
_COMMENT = re.compile(r"#: ?(.*)")


@cache
def sentences(kind: type) -> dict[str, str]:
    """Return the sentences on the fields of a class, those of its bases included.

    Examples
    --------
    >>> from solidgear import Material
    >>> sentences(Material)["nu"]
    "Poisson's ratio, between -1 and 0.5, both excluded."
    """
    out: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        if base.__module__.startswith("solidgear."):
            out |= {**attributes(base), **_comments(base)}
    return out


def summary(kind: type) -> str:
    """Return the first sentence of the docstring of a class."""
    text = inspect.cleandoc(kind.__dict__.get("__doc__") or "")
    return " ".join(text.split("\n\n")[0].split())


def attributes(kind: type) -> dict[str, str]:
    """Return the entries of the section Attributes of a docstring, the lines of each joined; names
    that share an entry share its text.
    """
    parts = inspect.cleandoc(kind.__dict__.get("__doc__") or "").split("Attributes\n----------\n")
    if len(parts) == 1:
        return {}
    entries = _ENTRY.findall(_SECTION.split(parts[1])[0])
    texts = [(names, " ".join(lines.split())) for names, lines in entries]
    return {name: text for names, text in texts for name in names.split(", ") if text}


def _comments(kind: type) -> dict[str, str]:
    """Return the comments on fields in the source of a class."""
    lines, definitions = _source(kind.__module__)
    definition = definitions.get(kind.__qualname__)
    if definition is None:  # made by a function
        return {}
    fields = [node for node in definition.body if isinstance(node, ast.AnnAssign)]
    names = [node.target.id for node in fields if isinstance(node.target, ast.Name)]
    out: dict[str, str] = {}
    for node, name in zip(fields, names):
        out |= dict(_of_field(name, names, lines, node))
    return out


@cache
def _source(module: str) -> tuple[list[str], dict[str, ast.ClassDef]]:
    """Return the lines of a module, and its classes by their names; nothing without its source."""
    try:
        source = inspect.getsource(sys.modules[module])
    except OSError:
        return [], {}
    return source.splitlines(), dict(_classes(ast.parse(source).body, ""))


def _classes(nodes: list[ast.stmt], outer: str) -> Iterator[tuple[str, ast.ClassDef]]:
    for node in nodes:
        if isinstance(node, ast.ClassDef):
            yield f"{outer}{node.name}", node
            yield from _classes(node.body, f"{outer}{node.name}.")


def _of_field(
    name: str, fields: list[str], lines: list[str], node: ast.AnnAssign
) -> Iterator[tuple[str, str]]:
    """Yield the names and the text of the comments behind and above a field."""
    first, last = node.lineno - 1, (node.end_lineno or node.lineno) - 1
    behind = _COMMENT.search(lines[last], node.end_col_offset or 0)
    if behind:
        yield name, behind[1]
    above: list[str] = []
    while first and (comment := _COMMENT.fullmatch(lines[first - 1].strip())):
        above.insert(0, comment[1])
        first -= 1
    text = " ".join(" ".join(above).split())
    several = _NAMES.fullmatch(text)
    if several and set(several[1].split(", ")) <= {*fields}:
        for shared in several[1].split(", "):
            yield shared, several[2]
    elif text:
        yield name, text
