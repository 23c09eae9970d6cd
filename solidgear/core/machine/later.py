"""What a start does without: parts of libraries, plugins, the search for garbage.

SciPy copies every name of numpy into a namespace of its own when it is imported, and with them
tools for Fortran, tests and types: a third of the time of its import.  Here they are executed at
their first use.  pydantic searches the metadata of all packages for plugins, of which none is
wanted; the library for it imports a parser of mail, to read them with.  What modules define lives
as long as the process, and the collector would search it for garbage again and again.
"""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import LazyLoader
from types import ModuleType

UNUSED = ("importlib.metadata._adapters", "numpy.ctypeslib", "numpy.f2py", "numpy.testing")
PLUGINS = "PYDANTIC_DISABLE_PLUGINS"


class Later:
    """Finder of modules that are executed when one of their attributes is first read."""

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if name not in UNUSED:
            return None
        spec = PathFinder.find_spec(name, path, target)
        if spec is not None and spec.loader is not None:
            spec.loader = LazyLoader(spec.loader)
        return spec


def load_later() -> None:
    """Defer these modules, and search no plugins, for the life of this process."""
    os.environ.setdefault(PLUGINS, "__all__")
    if not any(isinstance(finder, Later) for finder in sys.meta_path):
        sys.meta_path.insert(0, Later())


@contextmanager
def loading(module: str) -> Iterator[None]:
    """Search for no garbage while a module is imported, and never in what it defines."""
    if module in sys.modules or not gc.isenabled():
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()
