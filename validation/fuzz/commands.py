"""Random command lines: every command and option, with values that are right, nearly right and
absurd, on files of every kind.

Heavy answers are kept away by a memory limit, which the program itself must hold before it meshes
anything.
"""

from __future__ import annotations

import contextlib
import csv
import functools
import io
import json
import os
import random
import re
import shlex
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from validation.fuzz.case import Case, Finding, Fuzz, Refused, fit, sort_of
from validation.fuzz.spoiling import SCENES, spoilt

#: a shaft on two bearings for which every model is small
TINY = b"""\
material = {E = "207 GPa", nu = 0.3, density = "7850 kg/m^3"}
port = {at = "s.middle", attach_to = "s"}

[[segment]]
kind = "cylinder"
name = "s"
length = "300 mm"
diameter = "60 mm"

[[bearing]]
name = "1"
position = "30 mm"
seat_width = "20 mm"
stiffness = {kxx = 1e8, kyy = 1e7, kzz = 1e8}

[[bearing]]
name = "2"
position = "270 mm"
seat_width = "20 mm"
stiffness = {kxx = 1e8, kzz = 1e8}
"""
ODD = {
    "empty.toml": b"",
    "marked.toml": b"\xef\xbb\xbf" + TINY,
    "wide.toml": TINY.decode().encode("utf-16"),
    "nul.toml": TINY + b"\0",
    "deep.toml": b"title" + b".a" * 90 + b" = 1\n" + TINY,
    "twice.toml": TINY + b"\n[port]\n",
    "large.toml": b"# " + b"x" * 400_000 + b"\n" + TINY,
}
WILD = (
    *"0 -0 -1 1 2 1e9 1000000000 -1e9 1e-9 1e400 1e308 nan inf -inf 0x10 1_0 2.5 3.0".split(),
    *"true false None [] {} 1,5 1,2,3 , ,, a,b = == ' % %s $HOME ../.. --json -n".split(),
    *("", " ", '"', "3.5 mm", "hex20", "average", "9" * 400, "9" * 5000, "x" * 5000),
    *("\u0663", "\U0001f600", "\u202e", "\x1b[2J", "\x07", "a\nb", "\udcff"),
)
#: how files end that are whole
ENDS = {".html": b"</html>", ".vtu": b"</VTKFile>", ".png": b"IEND\xaeB`\x82"}
NOT_FILES = "pipe|folder|missing.toml|/dev/zero|/dev/null|/proc/self/mem|/||.|tiny.toml/x"


@dataclass(frozen=True)
class Flag:
    """An option of a command.

    Attributes
    ----------
    name : str
    share : float
        Of the command lines that have it.
    values : str
        Right and nearly right ones, between bars; none for a switch.
    wild : bool
        Any text instead, now and then: not where an answer would take seconds, or write somewhere.
    """

    name: str
    share: float
    values: str | None = None
    wild: bool = True

    def drawn(self, dice: random.Random) -> list[str]:
        """The arguments of one command line."""
        if dice.random() >= self.share:
            return []
        if self.values is None:
            return [self.name]
        return [self.name, value(dice, self.values) if self.wild else one_of(dice, self.values)]


def one_of(dice: random.Random, values: str) -> str:
    """One of some values between bars."""
    return dice.choice(values.split("|"))


def value(dice: random.Random, values: str) -> str:
    """A right or nearly right value, or now and then a wild one."""
    return one_of(dice, values) if dice.random() < 0.85 else dice.choice(WILD)


JSON = Flag("--json", 0.3)
VARY = (
    "bearing.1.kxx=1e7:1e9:3|bearing.1.scale=log:0.1:10:3|bearing.2.position=0.25:0.26:2|"
    "bearing.2.position=0:1:3|bearing.1.kxx=log:1:0:3|bearing.1.kxx=1:2:1e9|"
    "bearing.1.scale=log:0.1:10:100000000|bearing.1.scale=0:1:2|bearing.9.kxx=1:2:3|"
    "bearing.1.kqq=1:2:3|bearing.1.kxx=1,2,nan|bearing.1.kxx=|bearing.1.kxx|=|bearing|"
    "bearing.1.kxx=1e200:1e300:3|bearing.1.kx_thz=1e9:1e10:2|bearing.1.position=3,5 mm|"
    "bearing.1.kxx=:::|bearing.1.scale=-1,1|bearing.1.kxx=1e8,1e8"
)
#: how often a command is drawn, and its options
COMMANDS = {
    "answer": (
        12,
        JSON,
        Flag("--tol", 0.8, "0.1|1e-2|1e-9|0|2"),
        Flag("--ask", 0.6, "bending|C_z,thx|C_zx|,"),
    ),
    "stiffness": (30, JSON, Flag("--attachment", 0.3, "average|rigid|section|welded")),
    "modes": (
        30,
        JSON,
        Flag("-n", 0.5, "1|3|12|0|500|501"),
        Flag("--max-frequency", 0.3, "1000|1e5|0.1|0"),
        Flag("--count", 0.1),
    ),
    "check": (12, JSON),
    "sweep": (
        8,
        JSON,
        Flag("--vary", 1.0, VARY),
        Flag("--vary", 0.33, VARY),
        Flag("--out", 0.9, "rows.csv|rows.txt|new/rows.csv|tiny.toml|folder|/dev/full"),
        Flag("--sample", 0.2, "1|5|0"),
        Flag("--seed", 0.2, "3|-1"),
        Flag("-n", 0.2, "1|4|0"),
        Flag("--tolerance", 0.2, "1e-3|1|0"),
        Flag("--jobs", 0.1, "0|-1|x|nan", wild=False),
        Flag("--overwrite", 0.05),
    ),
    # what is right takes seconds to draw: only what is not
    "render": (
        3,
        Flag("--mode", 1.0, "banana 7|bending 99|rigid|"),
        Flag("--out", 0.5, "x.png|tiny.toml/x.png|folder|", wild=False),
    ),
    "compare": (
        4,
        JSON,
        Flag("--no-renders", 1.0),
        Flag(
            "--models",
            1.0,
            "euler|timoshenko|lumped|lumped,euler|euler,banana|euler,euler|solid",
        ),
        Flag("--out", 1.0, "out|tiny.toml|a/b|/dev/null", wild=False),
        Flag("--solid-element", 0.2, "hex20|tet11"),
    ),
    "chart": (
        1,
        Flag("--runs", 1.0, "0|x", wild=False),
        Flag("--budget", 1.0, "-1|nan", wild=False),
        Flag("--out", 1.0, "tiny.toml", wild=False),
    ),
}
#: commands of one model, which is drawn with options of its builder
OF_A_MODEL = ("stiffness", "modes", "check", "sweep", "render")
#: right and nearly right values of builder options
SETTINGS = {
    "order": "1|2|3|12|13|2.5|-1",
    "layers": "0|1|2|20|21|100000",
    "edge_layers": "0|1|2|100000",
    "radial_layers": "0|1|3|100000",
    "ratio": "0.2|0.35|0.01|0.999|1|2|0",
    "size": "0.01|0.05|1e-9|1e9|10 mm|0",
    "graded_size": "0.01|1e-9|1e-3|1e9",
    "refinement": "0.3|0.5|1|1.5|0.001|20|1e9",
    "ovalising": "2|2,3|1|2,2|3,|1000000|2,3,4,5,6,7,8,9",
    "attachments": "average|rigid,section|welded|average,average",
    "element": "hex20|hex8|hex27|tet10|tet4|hex9|HEX20",
    "around": "8|12|13|7|100000",
    "elements": "1|10|100|1000|5001|1e3",
    "shear": "true|false|1|yes",
    "rotary_inertia": "true|false|0",
    "head": "cone|mean|conical",
    "mass": "consistent|lumped|heavy",
    "kappa": "hutchinson|cowper|kowper",
    "fidelity": "1|euler",
    **dict.fromkeys(("graded", "scene", "nonsense", "self", "options", ""), "1"),
}
_BEAM = "shear rotary_inertia head mass kappa elements".split()
_HARMONIC = "order layers edge_layers ratio size refinement attachments ovalising".split()
_SOLID = (
    "element size layers edge_layers radial_layers ratio around graded_size refinement attachments"
).split()
OPTIONS_OF = {"euler": _BEAM, "timoshenko": _BEAM, "harmonic": _HARMONIC, "solid": _SOLID}


def command_line(dice: random.Random) -> Case:
    """Arguments of the program and the files it finds."""
    scene, files = _scene(dice)
    name = dice.choices((*COMMANDS, dice.choice(WILD)), (*(c[0] for c in COMMANDS.values()), 1))[0]
    arguments = [name, scene]
    if name in OF_A_MODEL:
        model = dice.choices((*OPTIONS_OF, dice.choice(WILD)), (25, 40, 18, 14, 3))[0]
        arguments += ["-f", model, *_settings(dice, model)]
    flags = COMMANDS[name][1:] if name in COMMANDS else ()
    # any one of them ends it at once
    for flag in [dice.choice(flags)] if name == "chart" else flags:
        arguments += flag.drawn(dice)
    if dice.random() < 0.04:
        dice.shuffle(arguments)
    if dice.random() < 0.04:
        more = dice.choice((*WILD, "--help", "-h", "--banana", "--set", "--json"))
        arguments.insert(dice.randrange(len(arguments) + 1), more)
    if dice.random() < 0.03:
        del arguments[dice.randrange(len(arguments))]
    what = shlex.join(a if len(a) < 60 else a[:50] + "..." for a in arguments)
    return Case(what, files, functools.partial(used, arguments=arguments))


def _scene(dice: random.Random) -> tuple[str, dict[str, bytes]]:
    """What stands for the scene, and the files there are."""
    files = {"tiny.toml": TINY}
    kind = dice.choices(("tiny", "shipped", "spoilt", "odd"), (68, 12, 10, 10))[0]
    if kind == "shipped":
        files["shipped.toml"] = SCENES[dice.choice(tuple(SCENES))]
    elif kind == "spoilt":
        files["spoilt.toml"] = spoilt(dice)[1]
    elif kind == "odd":
        files |= ODD
        return dice.choice((*ODD, *NOT_FILES.split("|"), "x" * 300, *WILD)), files
    return f"{kind}.toml", files


def _settings(dice: random.Random, model: str) -> list[str]:
    out = []
    for _ in range(dice.choice((0, 0, 1, 1, 1, 2, 3))):
        known = dice.random() < 0.93
        key = dice.choice(OPTIONS_OF.get(model, _HARMONIC) if known else (*SETTINGS, *WILD))
        whole = f"{key}={value(dice, SETTINGS.get(key, '1'))}"
        out += ["--set", whole if dice.random() < 0.97 else dice.choice((key, *WILD))]
    return out


def used(folder: Path, arguments: Sequence[str]) -> Iterator[str]:
    """Run a command line beside a folder and a pipe."""
    (folder / "folder").mkdir()
    os.mkfifo(folder / "pipe")
    yield f"command {arguments[0] if arguments else ''}"[:40]
    ran(arguments, folder)


def ran(arguments: Sequence[str], folder: Path) -> None:
    """Run a command line in this process, and judge exit code, what it said and what it left.

    Raises
    ------
    Refused
    Finding
    """
    from solidgear.app import main

    out, err = io.StringIO(), io.StringIO()
    before, code = set(folder.rglob("*")), 0
    old, sys.argv = sys.argv, ["solidgear", *arguments]
    try:
        with (
            contextlib.redirect_stdout(out),
            contextlib.redirect_stderr(err),
            contextlib.chdir(folder),
        ):
            main()
    except SystemExit as error:
        code = error.code or 0
    finally:
        sys.argv = old
    left = sorted(set(folder.rglob("*")) - before)
    said = out.getvalue(), err.getvalue()
    if fault := _fault(arguments, code, *said, left):
        raise Finding(fault)
    if code:
        last = said[1].removeprefix("solidgear: ").split(": ")[-1]
        raise Refused(said[1][:300], "usage" if code == 2 else sort_of(last) if code == 1 else "")


def _fault(arguments: Sequence[str], code: int, out: str, err: str, left: list[Path]) -> str:
    """What must not be, or nothing."""
    if "Traceback" in out + err:
        return f"a traceback: {err[-300:]!r}"
    if broken := [f"{path.name}: {why}" for path in left if (why := not_whole(path))]:
        return f"left half done: {', '.join(broken)}"
    if code == 2:
        usage = "Usage: " in err or "─ Error ─" in err
        told = f"wrong usage, output {out[:60]!r}, error {err[:200]!r}, left {left}"
        return "" if usage and not out and not left else told
    # what was checked or compared may be answered in full and still end with 1: a fault of the
    # mesh, or no model that could be solved; 3 is an answer whose bar is above the tolerance
    judged = code == 1 and out and arguments[0] in ("check", "compare")
    if code not in (0, 3) and not judged:
        return _fault_of_a_refusal(code, out, err, left)
    asked = set(arguments)
    if "--json" in asked and not asked & {"--help", "-h"} and arguments[0] != "render":
        json.loads(out, parse_constant=_no_number)
    return "" if out.strip() else "no answer and no refusal"


def _fault_of_a_refusal(code: int, out: str, err: str, left: list[Path]) -> str:
    # stages that were reached are told as they come
    said = [line for line in err.splitlines() if not re.match(r" *\d+\.\d s  ", line)]
    listed = re.match(r"solidgear: \d+ problems in ", err)
    sentence = said and said[0].startswith("solidgear: ") and (len(said) == 1 or listed)
    if code != 1 or out or not sentence:
        return f"exit code {code}, output {out[:60]!r}, error {err[:200]!r}"
    if not all(map(fit, said)):
        return f"not fit for a terminal: {err[:200]!r}"
    return f"refused, and left {', '.join(p.name for p in left)}" if left else ""


def _no_number(word: str) -> None:
    raise Finding(f"{word} in the JSON")


def not_whole(path: Path) -> str:
    """Why a file left behind is not one that can be used; nothing of one that can."""
    if path.is_dir():
        return "" if any(path.iterdir()) else "an empty folder"
    if path.name.startswith(".") or path.suffix == ".part":
        return "a partial file"
    if end := ENDS.get(path.suffix):
        return "" if path.read_bytes().rstrip().endswith(end) else "a torn file"
    if path.suffix not in (".json", ".csv"):
        return ""
    try:
        text = path.read_text(encoding="utf-8")
        if path.suffix == ".json":
            json.loads(text)
    except ValueError as error:
        return type(error).__name__
    if path.suffix == ".csv":
        widths = {len(row) for row in csv.reader(io.StringIO(text))}
        return "" if text.endswith("\n") and len(widths) <= 1 else "a torn row"
    return ""


COMMAND_LINES = Fuzz(
    "commands", command_line, share=0.38, environment={"SOLIDGEAR_MEMORY_MB": "120"}
)
