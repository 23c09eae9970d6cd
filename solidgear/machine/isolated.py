"""A function in a process of its own: what a library does that may end the process, or never
return, ends that one.
"""

from __future__ import annotations

import importlib
import os
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from solidgear.machine.patience import Patience

_ROOT = str(Path(__file__).resolve().parents[2])
_CODE = "from solidgear.machine.isolated import _serve; _serve()"


class IsolatedError(RuntimeError):
    """The process ended without a result: it was killed by a signal, or took too long."""


def isolated(function: Callable, *arguments: Any, seconds: float, memory_mb: float = 8000.0) -> Any:
    """Result of a function of a module that can be imported, called in a process of its own, or what it
    raises; arguments and result can be pickled, and the address space that it may take is limited
    where the system can do that.

    Raises
    ------
    IsolatedError
        If the process ended without a result, or was killed after so many seconds of processor time.

    Examples
    --------
    >>> import math
    >>> isolated(math.hypot, 3.0, 4.0, seconds=60)
    5.0
    """
    place = os.pathsep.join(filter(None, (_ROOT, os.environ.get("PYTHONPATH"))))
    with tempfile.TemporaryDirectory(prefix="solidgear") as folder:
        given, made = Path(folder) / "given", Path(folder) / "made"
        given.write_bytes(pickle.dumps((_name(function), arguments, memory_mb)))
        # what the library prints is no message of ours
        child = subprocess.Popen(
            [sys.executable, "-c", _CODE, str(given), str(made)],
            env={**os.environ, "PYTHONPATH": place},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        patience = Patience(seconds)
        try:
            code = patience.wait(child)
        finally:
            child.kill()
        if patience.why:
            raise IsolatedError(patience.why)
        if not made.exists():
            how = f"signal {-code}" if code < 0 else f"code {code}"
            raise IsolatedError(f"ended by itself ({how})")
        succeeded, value = pickle.loads(made.read_bytes())
    if not succeeded:
        raise value
    return value


def _name(function: Callable) -> tuple[str, str]:
    """Module and name of a function; of one that is run as a script, its module."""
    module = function.__module__
    if module == "__main__":
        spec = getattr(sys.modules["__main__"], "__spec__", None)
        module = spec.name if spec is not None else module
    return module, function.__qualname__


def _serve() -> None:
    """In the process itself: call what was given and leave what it made."""
    given, made = (Path(name) for name in sys.argv[1:3])
    (module, name), arguments, memory_mb = pickle.loads(given.read_bytes())
    _limit(memory_mb)
    try:
        function = getattr(importlib.import_module(module), name)
        out = (True, function(*arguments))
    except Exception as error:
        out = (False, error)
    part = made.with_suffix(".part")
    try:
        part.write_bytes(pickle.dumps(out))
    except Exception as error:  # an exception that cannot be pickled is still told
        part.write_bytes(pickle.dumps((False, IsolatedError(f"{type(error).__name__}: {out[1]}"))))
    part.rename(made)


def _limit(memory_mb: float) -> None:
    try:
        import resource
    except ImportError:  # not on Windows
        return
    size = int(memory_mb * 2**20)
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (size if hard < 0 else min(size, hard), hard))
