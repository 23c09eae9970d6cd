"""The command line on one file: numbers or one sentence, never a traceback."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from solidgear.core.ladder.model import SOLID
from solidgear.core.ladder.registry import LADDER
from solidgear.core.scene import Scene
from validation.common import ROOT

#: exit codes of a command that knows what it says: done, refused, tolerance not reached
KNOWN = (0, 1, 3)
#: seconds that a command may take
LONGEST = 240.0
#: the longest sentence
LONG = 1500


def spoken(scene: Scene, path: Path) -> list[str]:
    """Sentences on what is wrong with what commands say of a file."""
    fit = [n for n in LADDER.of(SOLID) if n in LADDER.fit(scene) and not LADDER[n].unfit(scene)]
    strange = [n for n in LADDER.bodies if LADDER[n].unfit(scene)]
    commands = [["check"], ["answer", "--tol", "0.02"]]
    commands += [["stiffness", "-f", name] for name in (*fit[:1], *strange[:1])]
    out = []
    for name, *rest in commands:
        words = [name, str(path), *rest]
        try:
            code, text = _said(words)
        except subprocess.TimeoutExpired:
            out.append(f"{' '.join(words)}: took more than {LONGEST:.0f} s")
            continue
        refuses = rest[-1:] and rest[-1] in strange
        if "Traceback" in text or code not in KNOWN:
            out.append(f"{name} {rest}: exit code {code}: {text[-300:]}")
        elif refuses and code != 1:
            out.append(f"{name} {rest}: exit code {code} of a model that does not fit")
        elif code == 1 and len(text) > LONG:
            out.append(f"{name} {rest}: {len(text)} letters are no sentence")
        elif code == 1 and not refuses and fit:
            out.append(f"{name} {rest}: refused: {text.strip()[-300:]}")
    return out


def _said(words: list[str]) -> tuple[int, str]:
    found = subprocess.run(
        [sys.executable, "-m", "solidgear.app", "-q", *words],
        capture_output=True,
        text=True,
        timeout=LONGEST,
        cwd=ROOT,
    )
    return found.returncode, found.stdout + found.stderr
