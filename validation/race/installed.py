"""Other programs that races are run against: which are here, and how the missing ones are installed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache


@dataclass(frozen=True)
class Program:
    """A program that races need: its name, Python module or command, and what installs it."""

    name: str
    module: str = ""
    command: str = ""
    install: str = ""


PROGRAMS = {
    program.name: program
    for program in (
        Program("CalculiX", command="ccx", install="apt-get install calculix-ccx"),
        Program("sfepy", "sfepy", install="'sfepy>=2024.4'"),
        # 3.1 and later need Python 3.13 and work with every plotly; 2.3 fails with plotly 6
        Program("ROSS", "ross", install="'ross-rotordynamics>=2.3' 'plotly<6'"),
        Program("pyHarm", "pyHarm", install="'pyharm-os>=1.2'"),
    )
}


def missing(*names: str) -> str:
    """Return one sentence on the programs that are not here, with all that installs them; empty if
    all are.
    """
    absent = [PROGRAMS[name] for name in names if not present(name)]
    if not absent:
        return ""
    lines = [program.install for program in absent if program.command]
    if packages := [program.install for program in absent if program.module]:
        lines.append(f"pip install {' '.join(packages)} (here or in a Python named in PEERS)")
    verb = "is" if len(absent) == 1 else "are"
    return f"{_listed([program.name for program in absent])} {verb} missing: {'; '.join(lines)}"


def present(name: str) -> bool:
    """Return whether a program can be run."""
    program = PROGRAMS[name]
    if program.command:
        return shutil.which(program.command) is not None
    return bool(interpreter(program.module))


@cache
def interpreter(module: str) -> str:
    """Return a Python that can import a module: this one, or the first of those that `PEERS` names,
    parted as paths are; empty where none can.
    """
    look = f"import {module}"
    others = os.environ.get("PEERS", "").split(os.pathsep)
    for python in (sys.executable, *filter(None, others)):
        # a package that is there and cannot be imported is of no use
        if subprocess.call([python, "-c", look], stderr=subprocess.DEVNULL) == 0:
            return python
    return ""


def _listed(names: Sequence[str]) -> str:
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))
