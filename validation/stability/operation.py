"""Problem: the commands on a machine that fails them: too little memory, no back end, no renderer
or one that dies, an interrupt, a full disk, a folder that cannot be written, a reader that goes
away.  Reference: what a command owes its user: an exit code, one sentence, and whole files or none.

Every case is a child process on the overhung pinion.
"""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from solidgear.show.folder import LOCK
from validation.common import ROOT
from validation.fuzz.commands import not_whole
from validation.stability.frame import Finding

SCENE = str(ROOT / "geometry" / "pinion_overhung.toml")
SECONDS = 150


@dataclass(frozen=True)
class Case:
    """One way a machine can fail a command.

    Attributes
    ----------
    what : str
    arguments : tuple of str
        ``{out}`` is a fresh folder, ``{file}`` a file in it.
    code : tuple of int
        Exit codes that are right.
    says : str
        Must occur in what the command prints.
    env : dict
    limit : (int, int), optional
        Resource limit and its value.
    hide : dict of str to str, optional
        Modules put in front of the real ones, name -> source.
    stop : (str, int), optional
        Send this signal once this text was printed.
    stdout : str
        Where standard output goes, a pipe by default; ``closed`` is a pipe that nobody reads.
    quick : bool
    """

    what: str
    arguments: tuple
    code: tuple
    says: str = ""
    env: tuple = ()
    limit: tuple | None = None
    hide: tuple = ()
    stop: tuple | None = None
    stdout: str = ""
    quick: bool = False


NO_PARDISO = (("pypardiso", "raise ImportError('hidden')"),)
NO_MKL = ("PYPARDISO_MKL_RT", "/nowhere/libmkl_rt.so")
DEATH = (("pyvista", "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"),)
NO_RENDERER = (("SOLIDGEAR_RENDERER", "none"),)
LITTLE = (("SOLIDGEAR_MEMORY_MB", "30"),)
MB = 1 << 20
#: commands that cases share
MODES, SOLID = ("modes", SCENE, "-f", "timoshenko"), ("modes", SCENE, "-f", "solid")
STIFFNESS = ("stiffness", SCENE, "-f", "timoshenko")
RENDER = ("render", SCENE, "-f", "timoshenko", "--out", "{file}")
COMPARE = ("compare", SCENE, "--models", "timoshenko,euler", "--out")
BOTH = ("compare", SCENE, "--models", "timoshenko,solid", "--out", "{out}")
CASES = (
    Case(
        "memory: limit set to 30 MB, modes of a solid",
        (*SOLID, "-n", "4"),
        (1,),
        "MB are free",
        env=LITTLE,
    ),
    Case(
        "memory: limit set to 30 MB, compare",
        (*BOTH, "--no-renders"),
        (0,),
        "MB are free",
        env=LITTLE,
    ),
    Case(
        "memory: address space of 900 MB, modes of a fine solid",
        (*SOLID, "--set", "refinement=1.8"),
        (1,),
        "memory",
        limit=(resource.RLIMIT_AS, 900 * MB),
    ),
    Case(
        "memory: limit that is no number",
        SOLID,
        (1,),
        "SOLIDGEAR_MEMORY_MB",
        env=(("SOLIDGEAR_MEMORY_MB", "lots"),),
    ),
    Case(
        "back end: one that does not exist",
        STIFFNESS,
        (1,),
        "back end",
        env=(("SOLIDGEAR_BACKEND", "umfpack"),),
        quick=True,
    ),
    Case(
        "back end: asked for, not installed",
        STIFFNESS,
        (1,),
        "pardiso",
        env=(("SOLIDGEAR_BACKEND", "pardiso"), NO_MKL),
        hide=NO_PARDISO,
        quick=True,
    ),
    Case(
        "back end: not installed, not asked for",
        (*SOLID, "--set", "refinement=0.7", "-n", "4"),
        (0,),
        "bending 1",
        env=(NO_MKL,),
        hide=NO_PARDISO,
    ),
    Case("renderer: none, render", RENDER, (1,), "OpenGL", env=NO_RENDERER),
    Case("renderer: none, compare", (*COMPARE, "{out}"), (0,), "Report", env=NO_RENDERER),
    Case(
        "renderer: dies of a segmentation fault, compare",
        (*COMPARE, "{out}"),
        (0,),
        "Report",
        hide=DEATH,
    ),
    Case("renderer: dies of a segmentation fault, render", RENDER, (1,), "signal 11", hide=DEATH),
    Case(
        "interrupt: Ctrl-C in the solid of compare",
        BOTH,
        (130,),
        "interrupt",
        stop=("solid: layers", signal.SIGINT),
    ),
    Case("interrupt: Ctrl-C at the start", BOTH, (130,), stop=("timoshenko: build", signal.SIGINT)),
    Case(
        "interrupt: terminated while files are written",
        (*COMPARE, "{out}"),
        (-signal.SIGTERM, 143),
        stop=("report", signal.SIGTERM),
    ),
    Case(
        "interrupt: killed while files are written",
        (*COMPARE, "{out}"),
        (-signal.SIGKILL,),
        stop=("renders", signal.SIGKILL),
    ),
    Case(
        "disk: full after 60 kB, compare",
        (*COMPARE, "{out}"),
        (1,),
        "File too large",
        limit=(resource.RLIMIT_FSIZE, 60 << 10),
    ),
    Case(
        "disk: full from the start, compare",
        (*COMPARE, "{out}"),
        (1,),
        "File too large",
        limit=(resource.RLIMIT_FSIZE, 0),
    ),
    Case("disk: full, render", RENDER, (1,), limit=(resource.RLIMIT_FSIZE, 4 << 10)),
    Case("disk: standard output full", (*MODES, "--json"), (1,), stdout="/dev/full", quick=True),
    Case("pipe: nobody reads", MODES, (0, 1, -signal.SIGPIPE, 141), stdout="closed"),
    Case("folder: lies below a file", (*COMPARE, SCENE + "/out"), (1,), "--out", quick=True),
    Case("folder: system folder that takes no files", (*COMPARE, "/proc/solidgear"), (1,), "--out"),
    Case(
        "scene: a device without end",
        ("check", "/dev/zero"),
        (1,),
        "/dev/zero",
        limit=(resource.RLIMIT_AS, 3000 * MB),
    ),
)


def run(case: Case, room: Path) -> dict:
    """One child; what it answered and what it left behind."""
    out = room / "out"
    words = [w.format(out=out, file=room / "mode.png") for w in case.arguments]
    env = dict(os.environ) | {"PYTHONUNBUFFERED": "1"} | dict(case.env)
    path = [str(ROOT), env.get("PYTHONPATH", "")]
    if case.hide:
        shadow = room / "shadow"
        shadow.mkdir()
        for name, source in case.hide:
            (shadow / f"{name}.py").write_text(source)
        path.insert(0, str(shadow))
    env["PYTHONPATH"] = os.pathsep.join(p for p in path if p)

    def limited():
        signal.signal(
            signal.SIGINT, signal.SIG_DFL
        )  # a shell's background jobs ignore it, and children inherit that
        if case.limit:
            resource.setrlimit(case.limit[0], (case.limit[1], case.limit[1]))

    start = time.perf_counter()
    text, log = "", room / "log"
    with log.open("wb") as sink:
        if case.stdout == "closed":
            reader, target = os.pipe()
            os.close(reader)
        else:
            target = os.open(case.stdout, os.O_WRONLY) if case.stdout else os.dup(sink.fileno())
        # The log is a file of the parent's making: a limit on file sizes would cut it off too, so
        # errors go through a pipe there.
        pipe = case.limit is not None and case.limit[0] == resource.RLIMIT_FSIZE
        child = subprocess.Popen(
            [sys.executable, "-m", "solidgear.app", *words],
            env=env,
            cwd=room,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE if pipe else target,
            stderr=subprocess.STDOUT if pipe else sink,
            preexec_fn=limited,
            start_new_session=True,
        )
        os.close(target)
        try:
            if pipe:
                text = child.communicate(timeout=SECONDS)[0].decode(errors="replace")
            elif case.stop:
                word, number = case.stop
                while (
                    child.poll() is None
                    and word not in log.read_text(errors="replace")
                    and time.perf_counter() - start < SECONDS
                ):
                    time.sleep(0.01)
                child.send_signal(number)
            code = child.wait(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            child.kill()
            code = child.wait()
    text = text or log.read_text(errors="replace")
    lines = [line for line in text.splitlines() if line.strip()]
    left = [
        p
        for p in sorted(room.rglob("*"))
        if p.is_file() and p.name not in ("log", LOCK) and "shadow" not in p.parts
    ]
    seconds = time.perf_counter() - start
    faults = []
    if "Traceback" in text:
        faults.append("traceback")
    if seconds >= SECONDS:
        faults.append("hangs")
    if code not in case.code:
        faults.append(f"exit code {code}")
    if (
        case.says
        and case.says not in text
        and case.says
        not in "".join(p.read_text(errors="replace") for p in left if p.suffix == ".json")
    ):
        faults.append("does not say why")
    faults += [f"{p.name}: {why}" for p in left if (why := not_whole(p))]
    said = next(
        (line for line in reversed(lines) if line.startswith("solidgear:")),
        lines[-1] if lines else "",
    )
    said = said.replace(str(room), "").replace(str(ROOT), "").strip()
    return {
        "what": case.what,
        "exit code": code,
        "fault": "; ".join(faults),
        "says": said[:200],
        "files left": ", ".join(p.name for p in left),
    }


def measure(quick: bool = False) -> Finding:
    """Every case in a folder of its own."""
    rows = []
    for case in CASES:
        if quick and not case.quick:
            continue
        with tempfile.TemporaryDirectory(prefix="solidgear-operation-") as folder:
            rows.append(run(case, Path(folder)))
    bad = [r for r in rows if r["fault"]]
    return Finding(
        "operation",
        "A machine that fails the run",
        "A run can end for reasons outside the model: memory, back end, renderer, an "
        "interrupt, a disk. A file must not look whole that is not.",
        f"Of {len(rows)} ways to fail {len(rows) - len(bad)} end with the right exit code, a "
        "sentence and whole files or none"
        + (
            f"; not so: {'; '.join(r['what'] + ' (' + r['fault'] + ')' for r in bad)}."
            if bad
            else "."
        ),
        "Every command ends in one sentence and exit code 1 (130 after Ctrl-C). Files "
        "are written under another name and moved into place; a picture is drawn in a "
        "child process.",
        "tests/test_compare.py::test_disk_that_fills_up_is_a_sentence_and_leaves_no_halves",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """A line for each case."""
    rows = finding.rows[::-1]
    for i, r in enumerate(rows):
        axes.plot(0, i, "s", color="#c4541c" if r["fault"] else "#00805e", ms=7)
        axes.text(0.03, i, f"exit {r['exit code']}", fontsize=6, va="center")
        axes.text(
            0.12,
            i,
            r["fault"] or r["says"].replace("solidgear: ", "")[:95],
            fontsize=6,
            va="center",
            color="#c4541c" if r["fault"] else "black",
        )
    axes.set_yticks(range(len(rows)), [r["what"] for r in rows], fontsize=6)
    axes.set(xlim=(-0.02, 1), xticks=(), title=finding.method)
    axes.grid(False)
