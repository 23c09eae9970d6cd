"""A function in another process: a library that ends the process, or never returns, ends that one."""

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

from solidgear.core.machine.patience import Patience

_ROOT = str(Path(__file__).resolve().parents[3])
_CODE = "from solidgear.core.machine.isolated import _serve; _serve()"


class IsolatedError(RuntimeError):
    """The process ended without a result: it was killed by a signal, or took too long."""


def isolated(function: Callable, *arguments: Any, seconds: float, memory_mb: float = 8000.0) -> Any:
    """Call a function of a module that can be imported in another process and return the result, or raise
    the exception; arguments and result can be pickled, and the address space is limited where the
    system can do that.  IsolatedError if the process ended without a result, or was killed after so
    many seconds of processor time.

    Examples
    --------
    >>> import math
    >>> isolated(math.hypot, 3.0, 4.0, seconds=60)
    5.0
    """
    place = os.pathsep.join(filter(None, (_ROOT, os.environ.get("PYTHONPATH"))))
    with tempfile.TemporaryDirectory(prefix="solidgear", ignore_cleanup_errors=True) as folder:
        request, answer = Path(folder) / "request", Path(folder) / "answer"
        request.write_bytes(pickle.dumps((_name(function), arguments, memory_mb)))
        # the library prints no message of ours
        child = subprocess.Popen(
            [sys.executable, "-c", _CODE, str(request), str(answer)],
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
        if patience.reason:
            raise IsolatedError(patience.reason)
        if not answer.exists():
            status = f"signal {-code}" if code < 0 else f"code {code}"
            raise IsolatedError(f"ended by itself ({status})")
        succeeded, value = pickle.loads(answer.read_bytes())
    if not succeeded:
        raise value
    return value


def _name(function: Callable) -> tuple[str, str]:
    """Return module and name of a function; of one that is run as a script, its module."""
    module = function.__module__
    if module == "__main__":
        spec = getattr(sys.modules["__main__"], "__spec__", None)
        module = spec.name if spec is not None else module
    return module, function.__qualname__


def _serve() -> None:
    """Answer the request, in the other process."""
    request, answer = (Path(name) for name in sys.argv[1:3])
    (module, name), arguments, memory_mb = pickle.loads(request.read_bytes())
    _limit(memory_mb)
    try:
        function = getattr(importlib.import_module(module), name)
        out = (True, function(*arguments))
    except Exception as error:
        out = (False, error)
    part = answer.with_suffix(".part")
    try:
        part.write_bytes(pickle.dumps(out))
    except Exception as error:  # an exception that cannot be pickled is still reported
        part.write_bytes(pickle.dumps((False, IsolatedError(f"{type(error).__name__}: {out[1]}"))))
    part.rename(answer)


def _limit(memory_mb: float) -> None:
    try:
        import resource
    except ImportError:  # not on Windows
        return
    size = int(memory_mb * 2**20)
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    try:
        resource.setrlimit(resource.RLIMIT_AS, (size if hard < 0 else min(size, hard), hard))
    except (OSError, ValueError):  # macOS refuses less than is mapped already
        pass
