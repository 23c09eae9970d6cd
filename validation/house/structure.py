"""Imports between files and rooms: circles, arrows up, modules that serve one importer."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from validation.house.floors import room_of
from validation.house.source import Source, statements

Graph = dict[str, set[str]]


def imports(source: Source, known: set[str], *, types: bool, late: bool) -> set[str]:
    """Return the modules of the package that a file imports.

    With `types` those under ``if TYPE_CHECKING`` too, with `late` those inside functions.
    """
    modules: set[str] = set()
    pending: list[ast.AST] = [source.tree]
    while pending:
        node = pending.pop()
        if not types and isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            pending.extend(node.orelse)
            continue
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and not late:
            continue
        if isinstance(node, ast.ImportFrom) and node.module and not node.level:
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                modules.add(full if full in known else node.module)
        elif isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        if isinstance(node, ast.mod | ast.stmt | ast.ExceptHandler | ast.match_case):
            pending.extend(ast.iter_child_nodes(node))
    return modules & known


def graph(files: Sequence[Source], *, types: bool = True, late: bool = True) -> Graph:
    """Return for each module those that it imports."""
    known = {source.module for source in files}
    return {s.module: imports(s, known, types=types, late=late) - {s.module} for s in files}


def through_doors(files: Sequence[Source]) -> Graph:
    """Return for each module those whose names it takes from a package that hands them out, or
    names in a text as a table of additions does.
    """
    packages = {s.module: _handed_out(s) for s in files if s.path.name == "__init__.py"}
    known = {source.module for source in files}
    taken: Graph = defaultdict(set)
    for source in files:
        for node in ast.walk(source.tree):
            match node:
                case ast.ImportFrom(module=str(package), names=names) if package in packages:
                    handed = packages[package]
                    taken[source.module] |= {handed[a.name] for a in names if a.name in handed}
                case ast.Constant(value=str(text)) if re.fullmatch(r"[a-z_0-9.]+(:\w+)?", text):
                    taken[source.module] |= {f"solidgear.{text.partition(':')[0]}"} & known
    return {module: (targets & known) - {module} for module, targets in taken.items()}


def _handed_out(package: Source) -> dict[str, str]:
    """Return the names that a package imports, each with its module."""
    return {
        alias.asname or alias.name: node.module
        for node in statements(package.tree)
        if isinstance(node, ast.ImportFrom) and node.module and not node.level
        for alias in node.names
    }


def circles(arrows: Graph) -> list[list[str]]:
    """Return strongly connected groups of more than one module or room."""
    names = sorted(arrows)
    links = np.array([[name in arrows[start] for name in names] for start in names])
    _, group = connected_components(csr_matrix(links), connection="strong")
    groups = [[names[k] for k in np.flatnonzero(group == label)] for label in np.unique(group)]
    return sorted(members for members in groups if len(members) > 1)


def between_rooms(arrows: Graph, room_of: Callable[[str], str] = room_of) -> Graph:
    """Return the graph of rooms, of an import graph of modules."""
    rooms: Graph = defaultdict(set)
    for module, targets in arrows.items():
        rooms[room_of(module)] |= {room_of(target) for target in targets} - {room_of(module)}
    return {room: targets - {""} for room, targets in rooms.items() if room}


def arrows_up(
    arrows: Graph, floors: dict[str, set[str]], room_of: Callable[[str], str] = room_of
) -> list[str]:
    """Return the imports between modules that a table of what each room may import forbids."""
    return sorted(
        f"{module} -> {target}"
        for module, targets in arrows.items()
        for target in targets
        if (room := room_of(module)) in floors
        and (below := room_of(target)) not in ("", "core", room)
        and below not in floors[room]
    )


def single_importers(arrows: Graph, besides: Graph) -> dict[str, str]:
    """Return the modules that one module alone imports, with that module.

    What others take of it by way of a package, `besides`, counts as well.
    """
    users: Graph = defaultdict(set)
    for module, target in _pairs(arrows, besides):
        users[target].add(module)
    count = {target: len(modules) for target, modules in users.items()}
    return {
        target: module
        for module, targets in arrows.items()
        for target in targets
        if count[target] == 1
    }


def _pairs(*graphs: Graph) -> Iterator[tuple[str, str]]:
    """Yield all arrows of graphs."""
    for arrows in graphs:
        for module, targets in arrows.items():
            yield from ((module, target) for target in targets)


def in_own_folder(single: dict[str, str]) -> dict[str, str]:
    """Return those whose one importer stands in the same folder."""
    return {
        module: importer
        for module, importer in single.items()
        if module.rpartition(".")[0] == importer.rpartition(".")[0]
    }
