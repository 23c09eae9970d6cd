"""Commands for their help: modules of the command line without what only their work imports, which
is most of a start.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import CodeType

ROOM = "solidgear.cli."


@contextmanager
def options_alone() -> Iterator[None]:
    """While this lasts, modules of the command line are read for their options; they are forgotten
    after it.
    """
    here, known = _Finder(), set(sys.modules)
    sys.meta_path.insert(0, here)
    try:
        yield
    finally:
        sys.meta_path.remove(here)
        for name in {n for n in sys.modules if n.startswith(ROOM)} - known:
            del sys.modules[name]
            vars(sys.modules[ROOM[:-1]]).pop(name.removeprefix(ROOM), None)


class _Finder(MetaPathFinder):
    """Modules of this room."""

    def find_spec(self, fullname, path, target=None) -> ModuleSpec | None:
        found = PathFinder.find_spec(fullname, path) if fullname.startswith(ROOM) else None
        if found is not None and found.origin is not None:
            found.loader = _Loader(fullname, found.origin)
        return found


class _Loader(SourceFileLoader):
    """Source without the imports that nothing names before a command runs."""

    def get_code(self, fullname: str) -> CodeType:
        tree = ast.parse(self.get_data(self.path))
        work = {f.name: f.body for f in tree.body if isinstance(f, ast.FunctionDef)}
        told, seen = _told(tree), set[str]()
        # functions that make options are called as the module is read
        while new := (told & set(work)) - seen:
            seen |= new
            told |= {name for one in new for node in work[one] for name in _told(node)}
        for node in tree.body:
            if isinstance(node, ast.ImportFrom) and node.module != "__future__":
                node.names = [a for a in node.names if (a.asname or a.name) in told]
        tree.body = [n for n in tree.body if not isinstance(n, ast.ImportFrom) or n.names]
        return compile(tree, self.path, "exec", dont_inherit=True)


def _told(node: ast.AST) -> set[str]:
    """Names that are looked up when a statement runs: of a command those of its head, of another
    function its defaults.
    """
    if isinstance(node, ast.FunctionDef):
        head = [node.args] if node.decorator_list else [*node.args.defaults, *node.args.kw_defaults]
        parts: list[ast.AST] = [*node.decorator_list, *filter(None, head)]
    else:
        parts = list(ast.iter_child_nodes(node))
    own = {node.id} if isinstance(node, ast.Name) else set()
    return own.union(*map(_told, parts))
