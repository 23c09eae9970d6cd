"""Command line: one module a command, or a few; :mod:`solidgear.show.command` knows which."""

from __future__ import annotations

import os
import signal
import sys
import threading

from solidgear.core.machine import start  # noqa: F401  before anything that takes time
from solidgear.core.machine.later import load_later, loading
from solidgear.core.machine.threads import pin

# before anything imports numpy
_overruled = pin()
load_later()


def _interrupted(*_) -> None:
    """Exit on Ctrl-C while modules are imported."""
    os.write(2, b"solidgear: interrupted\n")
    os._exit(130)


_main_thread = threading.current_thread() is threading.main_thread()
_hears = _main_thread and signal.getsignal(signal.SIGINT) is signal.default_int_handler
if _hears:
    signal.signal(signal.SIGINT, _interrupted)


with loading("solidgear.app.application"):
    from solidgear.app.application import app
from solidgear.app.streams import spell_out
from solidgear.core import SolidgearError
from solidgear.core.errors import for_terminal
from solidgear.core.machine.interruptible import leave
from solidgear.show.command import Progress

if _hears:
    signal.signal(signal.SIGINT, signal.default_int_handler)

if _overruled:
    Progress.first = (
        f"OPENBLAS_NUM_THREADS={_overruled} is not kept: dense matrices are small here and take one "
        "thread; PARDISO takes all cores granted"
    )


#: what the loader says of a library that finds no room
NOT_MAPPED = ("failed to map segment", "annot allocate memory")


def main() -> None:
    """Run the command line; errors raised on purpose become one sentence each and exit code 1."""
    for stream in (sys.stdout, sys.stderr):
        spell_out(stream)
    try:
        _run()
    except SystemExit as end:
        leave(end.code)


def _run() -> None:
    try:
        app()
    except KeyboardInterrupt:  # before or after a command, which say more
        print("solidgear: interrupted", file=sys.stderr)
        sys.exit(130)
    except SolidgearError as error:
        print(f"solidgear: {for_terminal(error)}", file=sys.stderr)
        sys.exit(1)
    except OSError as error:  # a full disk behind a redirected output, say
        if isinstance(error, BrokenPipeError):
            os._exit(141)  # the reader has left; nothing to say, and no way to say it
        print(f"solidgear: cannot write the output ({error.strerror or error})", file=sys.stderr)
        os._exit(1)  # flushing at exit would fail again
    except MemoryError:
        _stop_without_memory()
    except ImportError as error:
        if not any(words in str(error) for words in NOT_MAPPED):
            raise
        _stop_without_memory()


def _stop_without_memory() -> None:
    """Exit with a sentence that was prepared before, since nothing can be imported any more."""
    print(
        "solidgear: not enough memory for this model; use a coarser mesh (--set refinement=0.5) "
        "or the harmonic model",
        file=sys.stderr,
    )
    sys.exit(1)
