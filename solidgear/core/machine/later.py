"""Parts of numpy that SciPy loads and nobody here uses, executed at their first use instead.

SciPy copies every name of numpy into a namespace of its own when it is imported, and with them
tools for Fortran, tests and types: a third of the time of its import.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import LazyLoader
from types import ModuleType

UNUSED = ("numpy.ctypeslib", "numpy.f2py", "numpy.testing")


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
    """Defer these modules for the life of this process."""
    if not any(isinstance(finder, Later) for finder in sys.meta_path):
        sys.meta_path.insert(0, Later())
