"""Command line: one module a group of commands."""

from __future__ import annotations

from solidgear.threads import pin

pin()  # before anything imports numpy

import os
import sys

# fmt: off
from solidgear.cli import solve  # noqa: F401  (each registers its commands, in the order of the help)
from solidgear.cli import chart  # noqa: F401
from solidgear.cli import sweep  # noqa: F401
# fmt: on
from solidgear.cli.app import app
from solidgear.errors import SolidgearError, for_terminal


def main() -> None:
    """Entry point: errors raised on purpose become one sentence (a scene's, one for each problem) and exit code 1."""
    try:
        app()
    except SolidgearError as error:
        print(f"solidgear: {for_terminal(error)}", file=sys.stderr)
        sys.exit(1)
    except OSError as error:  # a full disk behind a redirected output, say; files of our own are guarded where they are written
        if isinstance(error, BrokenPipeError):
            os._exit(141)  # the reader has left; nothing to say, and no way to say it
        print(f"solidgear: cannot write the output ({error.strerror or error})", file=sys.stderr)
        os._exit(1)  # flushing at exit would fail again
    except MemoryError:
        print("solidgear: not enough memory for this model; use a coarser one (--set refinement=0.5) or the harmonic model", file=sys.stderr)
        sys.exit(1)
