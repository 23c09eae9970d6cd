"""Command line: one module a group of commands."""

from __future__ import annotations

from solidgear.threads import pin

pin()  # before anything imports numpy

import sys

from solidgear.cli import solve  # noqa: F401  (registers its commands)
from solidgear.cli.app import app
from solidgear.errors import SolidgearError


def main() -> None:
    """Entry point: errors raised on purpose become one sentence and exit code 1."""
    try:
        app()
    except SolidgearError as error:
        print(f"solidgear: {error}", file=sys.stderr)
        sys.exit(1)
    except MemoryError:
        print("solidgear: not enough memory for this model; use a coarser one (--set refinement=0.5) or the harmonic model", file=sys.stderr)
        sys.exit(1)
