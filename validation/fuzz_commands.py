"""Random command lines: every command and option, with values that are right, nearly right and
absurd, on files of every kind.

Heavy answers are kept away by a memory limit (`ENVIRONMENT`), which the program itself must hold
before it meshes anything.
"""

from __future__ import annotations

import os
import random
from pathlib import Path

from validation.fuzz_mutations import SCENES, mutant

#: how often each is drawn
COMMANDS = {
    "answer": 12,
    "stiffness": 30,
    "modes": 30,
    "check": 12,
    "sweep": 8,
    "render": 3,
    "compare": 4,
    "chart": 1,
}
ENVIRONMENT = {"SOLIDGEAR_MEMORY_MB": "120"}

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

WILD = (
    "",
    " ",
    "0",
    "-0",
    "-1",
    "1",
    "2",
    "1e9",
    "1000000000",
    "-1e9",
    "1e-9",
    "1e400",
    "nan",
    "inf",
    "-inf",
    "true",
    "false",
    "None",
    "[]",
    "1,5",
    "1,2,3",
    ",",
    ",,",
    "a,b",
    "=",
    "==",
    "0x10",
    "1_0",
    "9" * 400,
    "9" * 5000,
    "x" * 5000,
    "\u0663",
    "\U0001f600",
    "\u202e",
    "\x1b[2J",
    "\x07",
    "a\nb",
    "../..",
    "--json",
    "-n",
    "'",
    '"',
    "%s",
    "{}",
    "$HOME",
    "\udcff",
    "1e308",
    "3.5 mm",
    "hex20",
    "average",
    "3.0",
    "2.5",
)
#: right and nearly right values of builder options
SETTINGS = {
    "order": ("1", "2", "3", "12", "13", "2.5", "-1"),
    "layers": ("0", "1", "2", "20", "21", "100000"),
    "edge_layers": ("0", "1", "2", "100000"),
    "radial_layers": ("0", "1", "3", "100000"),
    "ratio": ("0.2", "0.35", "0.01", "0.999", "1", "2", "0"),
    "size": ("0.01", "0.05", "1e-9", "1e9", "10 mm", "0"),
    "graded_size": ("0.01", "1e-9", "1e-3", "1e9"),
    "refinement": ("0.3", "0.5", "1", "1.5", "0.001", "20", "1e9"),
    "ovalising": ("2", "2,3", "1", "2,2", "3,", "1000000", "2,3,4,5,6,7,8,9"),
    "attachments": ("average", "rigid,section", "welded", "average,average"),
    "element": ("hex20", "hex8", "hex27", "tet10", "tet4", "hex9", "HEX20"),
    "around": ("8", "12", "13", "7", "100000"),
    "graded": ("1",),
    "elements": ("1", "10", "100", "1000", "5001", "1e3"),
    "shear": ("true", "false", "1", "yes"),
    "rotary_inertia": ("true", "false", "0"),
    "head": ("cone", "mean", "conical"),
    "mass": ("consistent", "lumped", "heavy"),
    "kappa": ("hutchinson", "cowper", "kowper"),
    "scene": ("1",),
    "fidelity": ("1", "euler"),
    "nonsense": ("1",),
    "self": ("1",),
    "options": ("1",),
    "": ("1",),
}
_OF = {
    "euler": ("shear", "rotary_inertia", "head", "mass", "kappa", "elements"),
    "harmonic": (
        "order",
        "layers",
        "edge_layers",
        "ratio",
        "size",
        "refinement",
        "attachments",
        "ovalising",
    ),
    "solid": (
        "element",
        "size",
        "layers",
        "edge_layers",
        "radial_layers",
        "ratio",
        "around",
        "graded_size",
        "refinement",
        "attachments",
    ),
}
_OF["timoshenko"] = _OF["euler"]
VARY = (
    "bearing.1.kxx=1e7:1e9:3",
    "bearing.1.scale=log:0.1:10:3",
    "bearing.2.position=0.25:0.26:2",
    "bearing.2.position=0:1:3",
    "bearing.1.kxx=log:1:0:3",
    "bearing.1.kxx=1:2:1e9",
    "bearing.1.scale=log:0.1:10:100000000",
    "bearing.1.scale=0:1:2",
    "bearing.9.kxx=1:2:3",
    "bearing.1.kqq=1:2:3",
    "bearing.1.kxx=1,2,nan",
    "bearing.1.kxx=",
    "bearing.1.kxx",
    "=",
    "bearing",
    "bearing.1.kxx=1e200:1e300:3",
    "bearing.1.kx_thz=1e9:1e10:2",
    "bearing.1.position=3,5 mm",
    "bearing.1.kxx=:::",
    "bearing.1.scale=-1,1",
    "bearing.1.kxx=1e8,1e8",
)


def _value(rng: random.Random, good: tuple[str, ...]) -> str:
    return rng.choice(good) if rng.random() < 0.85 else rng.choice(WILD)


def _settings(rng: random.Random, model: str) -> list[str]:
    out = []
    for _ in range(rng.choice((0, 0, 1, 1, 1, 2, 3))):
        key = (
            rng.choice(_OF.get(model, _OF["harmonic"]))
            if rng.random() < 0.93
            else rng.choice((*SETTINGS, *WILD))
        )
        out += [
            "--set",
            f"{key}={_value(rng, SETTINGS.get(key, ('1',)))}"
            if rng.random() < 0.97
            else rng.choice((key, *WILD)),
        ]
    return out


def _maybe(rng: random.Random, share: float, *arguments: str) -> list[str]:
    return list(arguments) if rng.random() < share else []


def command_line(seed: int, number: int) -> tuple[list[str], dict[str, bytes]]:
    """Arguments of the program and the files it finds: case ``number`` of a run."""
    rng = random.Random(f"command {seed}:{number}")
    files = {"tiny.toml": TINY}
    kind = rng.choices(("tiny", "shipped", "spoilt", "odd"), (68, 12, 10, 10))[0]
    scene = {"tiny": "tiny.toml", "shipped": "shipped.toml", "spoilt": "spoilt.toml"}.get(kind)
    if kind == "shipped":
        files["shipped.toml"] = SCENES[rng.choice(tuple(SCENES))]
    elif kind == "spoilt":
        files["spoilt.toml"] = mutant(seed, rng.randrange(10**9))[2]
    elif kind == "odd":
        files |= {
            "empty.toml": b"",
            "marked.toml": b"\xef\xbb\xbf" + TINY,
            "wide.toml": TINY.decode().encode("utf-16"),
            "nul.toml": TINY + b"\0",
        }
        files |= {
            "deep.toml": b"title" + b".a" * 90 + b" = 1\n" + TINY,
            "twice.toml": TINY + b"\n[port]\n",
            "large.toml": b"# " + b"x" * 400_000 + b"\n" + TINY,
        }
        scene = rng.choice(
            (
                *list(files)[1:],
                "pipe",
                "folder",
                "missing.toml",
                "/dev/zero",
                "/dev/null",
                "/proc/self/mem",
                "/",
                "",
                ".",
                "x" * 300,
                "tiny.toml/x",
                *WILD,
            )
        )
    model = rng.choices(
        ("euler", "timoshenko", "harmonic", "solid", rng.choice(WILD)), (25, 40, 18, 14, 3)
    )[0]
    name = rng.choices(
        (*COMMANDS, rng.choice(WILD)),
        (*COMMANDS.values(), 1),
    )[0]
    arguments = [name, scene]
    if name in ("stiffness", "modes", "check", "sweep", "render"):
        arguments += ["-f", model, *_settings(rng, model)]
    if name in ("answer", "stiffness", "modes", "check", "sweep", "compare"):
        arguments += _maybe(rng, 0.3, "--json")
    if name == "stiffness":
        arguments += _maybe(
            rng, 0.3, "--attachment", _value(rng, ("average", "rigid", "section", "welded"))
        )
    elif name == "answer":
        arguments += _maybe(rng, 0.8, "--tol", _value(rng, ("0.1", "1e-2", "1e-9", "0", "2")))
        arguments += _maybe(rng, 0.6, "--ask", _value(rng, ("bending", "C_z,thx", "C_zx", ",")))
    elif name == "modes":
        arguments += (
            _maybe(rng, 0.5, "-n", _value(rng, ("1", "3", "12", "0", "500", "501")))
            + _maybe(rng, 0.3, "--max-frequency", _value(rng, ("1000", "1e5", "0.1", "0")))
            + _maybe(rng, 0.1, "--count")
        )
    elif name == "sweep":
        for _ in range(rng.choice((1, 1, 2))):
            arguments += ["--vary", _value(rng, VARY)]
        arguments += _maybe(
            rng,
            0.9,
            "--out",
            _value(
                rng, ("rows.csv", "rows.txt", "new/rows.csv", "tiny.toml", "folder", "/dev/full")
            ),
        )
        arguments += (
            _maybe(rng, 0.2, "--sample", _value(rng, ("1", "5", "0")))
            + _maybe(rng, 0.2, "--seed", _value(rng, ("3", "-1")))
            + _maybe(rng, 0.2, "-n", _value(rng, ("1", "4", "0")))
        )
        arguments += (
            _maybe(rng, 0.2, "--tolerance", _value(rng, ("1e-3", "1", "0")))
            + _maybe(rng, 0.1, "--jobs", rng.choice(("0", "-1", "x", "nan")))
            + _maybe(rng, 0.05, "--overwrite")
        )
    elif name == "render":  # what is right takes seconds to draw: only what is not
        arguments += [
            "--mode",
            _value(rng, ("banana 7", "bending 99", "rigid", "")),
            *_maybe(rng, 0.5, "--out", rng.choice(("x.png", "tiny.toml/x.png", "folder", ""))),
        ]
    elif name == "compare":
        arguments += [
            "--no-renders",
            "--models",
            _value(
                rng,
                (
                    "euler",
                    "timoshenko",
                    "lumped",
                    "lumped,euler",
                    "euler,banana",
                    "euler,euler",
                    "solid",
                ),
            ),
            "--out",
            rng.choice(("out", "tiny.toml", "a/b", "/dev/null")),
        ]
        arguments += _maybe(rng, 0.2, "--solid-element", _value(rng, ("hex20", "tet11")))
    elif name == "chart":
        arguments += rng.choice(
            (
                ["--runs", "0"],
                ["--budget", "-1"],
                ["--budget", "nan"],
                ["--runs", "x"],
                ["--out", "tiny.toml"],
            )
        )
    if rng.random() < 0.04:
        rng.shuffle(arguments)
    if rng.random() < 0.04:
        arguments.insert(
            rng.randrange(len(arguments) + 1),
            rng.choice((*WILD, "--help", "-h", "--banana", "--set", "--json")),
        )
    if rng.random() < 0.03:
        del arguments[rng.randrange(len(arguments))]
    # a null byte cannot be part of an argument, and a process of its own would get these bytes as
    # surrogates
    return [a.replace("\0", "") for a in arguments], files


def put(files: dict[str, bytes], folder: Path) -> None:
    """The files of a case in an empty folder, with a folder and a pipe beside them."""
    for name, text in files.items():
        (folder / name).write_bytes(text)
    (folder / "folder").mkdir()
    os.mkfifo(folder / "pipe")
