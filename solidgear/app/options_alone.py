"""Commands for their help: modules of the command line without what only their work imports, which
is most of a start.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import CodeType

#: modules of commands and of their options; all others are imported as they are
OF_COMMANDS = re.compile(
    r"solidgear\.(app\..*|show\.(options|settled|remarks)|.*\.(\w+_)?(command|options)|.*\.acting)"
)


@contextmanager
def options_alone() -> Iterator[None]:
    """Import modules of the command line for their options only, within this context."""
    finder = _Finder()
    sys.meta_path.insert(0, finder)
    try:
        yield
    finally:
        sys.meta_path.remove(finder)
        for name in finder.stripped & set(sys.modules):
            room, _, module = name.rpartition(".")
            del sys.modules[name]
            if room in sys.modules:
                vars(sys.modules[room]).pop(module, None)


class _Finder(MetaPathFinder):
    def __init__(self):
        self.stripped: set[str] = set()  #: modules that were imported for their options only

    def find_spec(self, fullname, path, target=None) -> ModuleSpec | None:
        if not OF_COMMANDS.fullmatch(fullname) or fullname.startswith("solidgear.core."):
            return None
        spec = PathFinder.find_spec(fullname, path)
        if spec and spec.origin:
            spec.loader = _Loader(fullname, spec.origin)
            self.stripped.add(fullname)
        return spec


class _Loader(SourceFileLoader):
    """Source without the imports that nothing names before a command runs."""

    def get_code(self, fullname: str) -> CodeType:
        tree = ast.parse(self.get_data(self.path))
        kept_names, before = _names_used(tree), 0
        # functions that make options are called as the module is read, and those that they call
        while len(kept_names) > before:
            before = len(kept_names)
            for node in tree.body:
                if isinstance(node, ast.FunctionDef) and node.name in kept_names:
                    kept_names |= set().union(*map(_names_used, node.body))
        for node in tree.body:
            if isinstance(node, ast.ImportFrom) and node.module != "__future__":
                node.names = [a for a in node.names if (a.asname or a.name) in kept_names]
        tree.body = [n for n in tree.body if not isinstance(n, ast.ImportFrom) or n.names]
        return compile(tree, self.path, "exec", dont_inherit=True)


def _names_used(node: ast.AST) -> set[str]:
    """Return the names that a statement looks up when it runs: of a command those of its head."""
    parts: list[ast.AST] = list(ast.iter_child_nodes(node))
    if isinstance(node, ast.FunctionDef):
        head = [node.args] if node.decorator_list else [*node.args.defaults, *node.args.kw_defaults]
        parts = [*node.decorator_list, *filter(None, head)]
    return set().union([node.id] if isinstance(node, ast.Name) else [], *map(_names_used, parts))
