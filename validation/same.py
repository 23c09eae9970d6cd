"""Commands on shipped and strangers' scenes, run by two checkouts and compared byte for byte.

``python -m validation.same OLD`` runs all of :data:`COMMANDS` in the checkout OLD and in this one:
what they print, their exit codes and the files that they write.  Times, memory and paths aside,
nothing may differ where files move and names change.  ``--only compare`` takes the commands that
hold a word; ``--accept`` is for wanted changes: it prints the differences and ends with 0.
"""

from __future__ import annotations

import argparse
import difflib
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parent.parent
#: command lines; OUT stands for a folder or file that the command writes
COMMANDS = """
modes geometry/pinion_overhung.toml -f timoshenko --json
modes geometry/pinion_overhung.toml -f harmonic --count
modes tests/scenes/input_shaft.toml -n 12
modes geometry/cylinder_free.toml -f solid
modes geometry/pinion_toothed.toml -f sector
stiffness geometry/pinion_overhung.toml
stiffness geometry/pinion_straddle.toml -f timoshenko --json
stiffness geometry/gearbox_catalogue.toml
stiffness geometry/shaft_step.toml
answer geometry/pinion_overhung.toml
answer geometry/rotor_disc.toml --tol 1e-3 --json
answer tests/scenes/hypoid_pinion.toml
answer geometry/pinion_keyed.toml
check geometry/pinion_overhung.toml
check geometry/pinion_spiral.toml
check tests/scenes/thin_tube_ovalising.toml
check geometry/gearbox_train.toml
compare geometry/pinion_overhung.toml --out OUT
compare tests/scenes/motor_rotor.toml --out OUT
compare geometry/shaft_stepped.toml geometry/shaft_hollow.toml --out OUT
compare geometry/axle_straddle.toml
bearing geometry/gearbox_catalogue.toml
stress geometry/pinion_filleted.toml --load z=2\\ kN --json
stress geometry/gearbox_output.toml --out OUT
deflect geometry/gearbox_catalogue.toml
deflect geometry/axle_straddle.toml --torque 100\\ N*m --out OUT
deflect geometry/reducer.toml --json
sensitivities geometry/pinion_overhung.toml
sensitivities geometry/gearbox_catalogue.toml -f timoshenko
budget geometry/gearbox_catalogue.toml
sweep geometry/pinion_overhung.toml --vary segment.1.length=19\\ mm,20\\ mm --out OUT.csv
sweep geometry/pinion_overhung.toml --vary bearing.1.scale=0.5,1,2 --out OUT.csv
optimise geometry/shaft_stepped.toml -f timoshenko --vary segment.middle.diameter=30\\ mm:60\\ mm --goal max\\ bending\\ 1
system-modes geometry/axle_straddle.toml
system-modes geometry/gearbox_two_stage.toml --json
system-modes geometry/gearbox_housed.toml
response geometry/axle_straddle.toml --out OUT
response geometry/reducer.toml
judge-system geometry/axle_straddle.toml
nonlinear geometry/axle_straddle.toml --backlash 100\\ um
receptance geometry/axle_straddle.toml --from gear.gear:z --to pinion.pinion:x --out OUT
scenes
new OUT
options
--help
""".strip().splitlines()
#: what two runs of one command may write differently
VOLATILE = (
    (re.compile(r"(?<![\w.])\d+(\.\d+)?(e[-+]?\d+)? ?(s|ms|min|MB|GB|GiB|MiB)\b"), "TIME"),
    (
        re.compile(
            r'("[^"\n]*(seconds|time|peak|memory|_mb|elapsed|cost|date)[^"\n]*": ?)[^,\n}]*'
        ),
        r"\1TIME",
    ),
    (re.compile(r"\d{4}-\d\d-\d\d([T ]\d\d:\d\d(:\d\d)?)?"), "DATE"),
)
#: files whose bytes hold no text
PICTURES = (".png", ".vtu", ".npz", ".gz")


@dataclass(frozen=True)
class Output:
    """What a command leaves."""

    texts: dict[str, list[str]]  #: lines of the terminal and of each text file, by name
    pictures: tuple[str, ...]  #: names of files without text


def output(tree: Path, command: str, folder: Path) -> Output:
    """Run a command in a checkout and read what it leaves."""
    words = re.split(r"(?<!\\) ", command)
    target = folder / "out"
    line = [w.replace("\\ ", " ").replace("OUT", str(target)) for w in words]
    environment = {**os.environ, "PYTHONPATH": str(tree), "COLUMNS": "100"}
    run = subprocess.run(
        [sys.executable, "-m", "solidgear", *line],
        cwd=tree,
        env=environment,
        capture_output=True,
        text=True,
    )
    texts = {"exit code": [str(run.returncode)]}
    texts |= {
        "output": _lines(run.stdout, tree, folder),
        "errors": _lines(run.stderr, tree, folder),
    }
    files = sorted(p for p in folder.rglob("*") if p.is_file())
    for path in files:
        if path.suffix not in PICTURES:
            text = path.read_text(encoding="utf-8", errors="replace")
            texts[str(path.relative_to(folder))] = _lines(text, tree, folder)
    names = tuple(str(p.relative_to(folder)) for p in files if p.suffix in PICTURES)
    return Output(texts, names)


def _lines(text: str, *places: Path) -> list[str]:
    """Return the lines of a text without times and paths."""
    for place in places:
        text = text.replace(str(place), "PLACE")
    for pattern, word in VOLATILE:
        text = pattern.sub(word, text)
    return text.splitlines()


def differences(old: Output, new: Output) -> Iterator[str]:
    """Yield the lines in which two outputs differ."""
    if old.pictures != new.pictures:
        yield f"pictures: {', '.join(old.pictures)} became {', '.join(new.pictures)}"
    for name in sorted(old.texts.keys() | new.texts.keys()):
        before, after = old.texts.get(name, []), new.texts.get(name, [])
        yield from difflib.unified_diff(before, after, f"{name} before", name, lineterm="", n=0)


def main() -> int:
    """Compare two checkouts, command by command."""
    parser = argparse.ArgumentParser(prog="python -m validation.same", description=__doc__)
    parser.add_argument("old", type=Path, help="the other checkout")
    parser.add_argument("--only", default="", help="commands that hold this word")
    parser.add_argument("--accept", action="store_true", help="end with 0 whatever differs")
    parser.add_argument("--lines", type=int, default=20, help="lines shown of each command")
    arguments = parser.parse_args()
    differing = 0
    for command in (c for c in COMMANDS if arguments.only in c):
        with tempfile.TemporaryDirectory() as before, tempfile.TemporaryDirectory() as after:
            old = output(arguments.old.resolve(), command, Path(before))
            new = output(ROOT, command, Path(after))
        lines = list(differences(old, new))
        differing += bool(lines)
        print(
            f"{'differs' if lines else 'same':<8}{old.texts['exit code'][0]}  {command}", flush=True
        )
        for line in lines[: arguments.lines]:
            print(f"    {line[:200]}")
    print(f"{differing} differ")
    return int(differing > 0 and not arguments.accept)


if __name__ == "__main__":
    raise SystemExit(main())
