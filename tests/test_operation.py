"""Runs that end early, folders that are shared or used again, machines that lack something: a
sentence, the right code, whole files.
"""

import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.comparison.models import compare
from solidgear.show.folder import LOCK, held

pytestmark = pytest.mark.usefixtures("no_charts")

ROOT = Path(__file__).parent.parent
SCENE = str(ROOT / "geometry" / "pinion_overhung.toml")
OTHER = str(ROOT / "geometry" / "shaft_stepped.toml")
posix = pytest.mark.skipif(os.name != "posix", reason="signals and locks of POSIX")
# Long enough for a machine that does ten other things; what is waited for takes seconds.
PATIENCE = 120

# A factorisation of a solid that takes many minutes of C code, which is what Ctrl-C used to wait
# for.
ENDLESS = """
import hashlib, os
from solidgear.app import main
from solidgear.core.solve import factored
from solidgear.core.solve.backends.superlu import SuperLU
factored.LONG = 0
real = SuperLU.factor

def endless(self):
    if self.matrix.shape[0] < 1000:
        return real(self)
    os.write(2, b"now in C\\n")
    hashlib.pbkdf2_hmac("sha256", b"", b"", 2**31 - 1)

SuperLU.factor = endless
main()
"""


def whole(path):
    """Whether a file is one that a user can use."""
    data = path.read_bytes()
    if path.suffix == ".json":
        return bool(json.loads(data))
    end = {".html": b"</html>", ".vtu": b"</VTKFile>", ".png": b"IEND\xaeB`\x82", ".csv": b"\n"}[
        path.suffix
    ]
    return data.rstrip(b"\n" if path.suffix != ".csv" else b"").endswith(end)


def environment(**more):
    return {**os.environ, "PYTHONPATH": str(ROOT), "SOLIDGEAR_BACKEND": "superlu", **more}


def started(code, *arguments, **more):
    """A child that hears Ctrl-C even where this process was told not to."""
    hear = "import signal\nsignal.signal(signal.SIGINT, signal.default_int_handler)\n"
    command = [sys.executable, "-c", hear + code, *map(str, arguments)]
    return subprocess.Popen(
        command, env=environment(**more), text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )


# --------------------------------------------------------------------------- Ctrl-C
COMMANDS = {
    "compare": ["compare", SCENE, "--models", "timoshenko,harmonic", "--out", "out"],
    "modes": ["modes", SCENE, "--tol", "1e-4"],
    "stiffness": ["stiffness", SCENE, "--tol", "1e-4"],
    "chart": ["chart", SCENE, "--out", "out"],
    "sweep": ["sweep", SCENE, "--vary", "bearing.1.scale=1,2", "--out", "rows.csv"],
}


@posix
@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=() if n == "modes" else pytest.mark.slow) for n in COMMANDS]
)
def test_ctrl_c_in_the_middle_of_a_factorisation(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    child = started(ENDLESS, *COMMANDS[name])
    try:
        said = []
        for line in child.stderr:
            said.append(line)
            if "now in C" in line:
                break
        child.send_signal(signal.SIGINT)
        out, err = child.communicate(timeout=PATIENCE)  # the C code would take longer
    finally:
        child.kill()
    text = "".join(said) + err
    kept = name in ("modes", "stiffness")  # numbers of the mesh before
    assert child.returncode == (3 if kept else 130), text
    assert "interrupted" in (out if kept else err) and "Traceback" not in text
    left = {str(p.relative_to(tmp_path)) for p in tmp_path.rglob("*") if p.is_file()}
    if name == "compare":  # what was solved before is kept
        assert left == {"out/results.json", "out/report.html"} and all(
            whole(tmp_path / p) for p in left
        )
        stored = json.loads((tmp_path / "out/results.json").read_text())
        assert stored["complete"] is False and list(stored["models"]) in (
            ["timoshenko"],
            ["timoshenko", "harmonic"],
        )
        assert "interrupted" in out  # the table says so
    else:
        assert not {p for p in left if not p.startswith("rows.csv")}


@posix
@pytest.mark.parametrize("module", ["typer", "solidgear.app.modes"])
def test_ctrl_c_while_modules_are_read(module):
    """A breath after the start nothing has begun, and there is nothing to trace back."""
    code = "import os, signal, sys, types\n"
    code += (
        "class Finder:\n    def find_spec(self, name, *_):\n        if name == '"
        + module
        + "': os.kill(os.getpid(), signal.SIGINT)\n"
    )
    code += "sys.meta_path.insert(0, Finder())\nimport solidgear.app\n"
    code += "sys.argv[1:] = ['modes', 'shaft.toml']\nsolidgear.app.main()\n"
    child = started(code)
    out, err = child.communicate(timeout=PATIENCE)
    assert (child.returncode, out, err) == (130, "", "solidgear: interrupted\n")


# --------------------------------------------------------------------------- killed
#: files of a report that take their place one after the other: results, shape, results again, report
FILES = 4
# A process without the threads of this one forks for every file, and kills the child before it.
KILLED = """
import os, shutil, signal, sys
from pathlib import Path
import solidgear as sg
from solidgear.comparison.page import charts
from solidgear.comparison.models import compare
charts.CHARTS = dict.fromkeys(charts.CHARTS, lambda results: None)
root, scene, other, files = Path(sys.argv[1]), *sys.argv[2:4], int(sys.argv[4])
before = compare(sg.load(other), ("euler", "timoshenko"))
found = compare(sg.load(scene), ("euler",))
real, done = os.replace, []

def replace(*names):
    done.append(names)
    if len(done) == at:
        os.kill(os.getpid(), signal.SIGKILL)
    real(*names)

before.write_report(root / "before", renders=False)
for at in range(1, files + 2):
    folder = root / str(at)
    for copy in ("old", "again"):
        shutil.copytree(root / "before", folder / copy)
    child = os.fork()
    if child == 0:
        os.replace = replace
        try:
            found.write_report(folder / "again", renders=False)
        finally:
            os._exit(0)
    status = os.waitpid(child, 0)[1]
    (folder / "status").write_text(str(os.waitstatus_to_exitcode(status)))
    shutil.copytree(folder / "again", folder / "killed")
    found.write_report(folder / "again", renders=False)
"""


@pytest.fixture(scope="module")
def killed(tmp_path_factory):
    """Folders of a run of another scene in which one of this scene was killed before its n-th file."""
    root = tmp_path_factory.mktemp("killed")
    child = started(KILLED, root, SCENE, OTHER, FILES)
    try:
        _, err = child.communicate(timeout=PATIENCE)
    finally:
        child.kill()
    assert child.returncode == 0, err
    return root


@posix
@pytest.mark.parametrize("at", range(1, FILES + 2))
def test_killed_while_files_are_written(at, killed):
    """Before each file takes its place in turn: all others are whole, and no report or shape stands
    beside numbers that are not its own.
    """
    folder = killed / str(at)
    was_killed = int((folder / "status").read_text()) == -signal.SIGKILL
    assert was_killed == (at <= FILES)
    shown = {p.name: p for p in (folder / "killed").iterdir() if not p.name.startswith(".")}
    assert all(whole(p) for p in shown.values())
    scene = json.loads(shown["results.json"].read_text())["scene"]["name"]
    fresh = scene == sg.load(SCENE).name
    assert fresh == (at > 1)
    for name in ("report.html", "modes_euler.vtu", "modes_timoshenko.vtu"):
        if name in shown:
            old = (folder / "old" / name).read_bytes()
            assert (shown[name].read_bytes() != old) == fresh, name
    # The next run finds neither a lock nor halves in its way, and leaves its own files only.
    left = {p.name for p in (folder / "again").iterdir()}
    assert left == {"results.json", "report.html", "modes_euler.vtu"}


def test_a_chart_that_is_killed_leaves_no_picture_of_another(tmp_path):
    from solidgear.comparison.race.race import (
        MACHINE,
        PICTURE,
        ROWS,
        Race,
        Reference,
        Row,
        write_rows,
    )

    (tmp_path / PICTURE).write_bytes(b"of an earlier chart")
    row = Row(
        "beam",
        "Euler",
        1,
        "euler",
        {},
        "ok",
        unknowns=6,
        samples=[0.1],
        values={"C_zz": 1.0},
        errors={"C_zz": 0.1},
    )
    reference = Reference("harmonic", {}, "order 2", 6, 0.1, {"C_zz": 1.0}, {"C_zz": 0.01})
    race = Race({}, reference, [row], {}, 1, 4, 1.0)
    write_rows(race, tmp_path)
    assert {p.name for p in tmp_path.iterdir()} == {ROWS, MACHINE}
    (tmp_path / PICTURE).write_bytes(b"its own")
    row.samples.append(0.1)
    write_rows(race, tmp_path)
    assert (tmp_path / PICTURE).exists()


# --------------------------------------------------------------------------- a folder that is used again
def test_what_an_earlier_run_left_goes_and_nothing_else(tmp_path):
    compare(sg.load(OTHER), ("euler", "timoshenko")).write_report(tmp_path, renders=False)
    stored = json.loads((tmp_path / "results.json").read_text())
    assert stored["files"] == ["report.html", "modes_euler.vtu", "modes_timoshenko.vtu"]
    # A list that was tampered with names nothing but files of our own making.
    (tmp_path / "mode_harmonic.png").write_bytes(b"listed")
    (tmp_path / "mode_folder.png").mkdir()
    foreign = ["mode_mine.png", "modes_mine.vtu", "notes.txt", "speed_accuracy.png"]
    for name in foreign:
        (tmp_path / name).write_text("mine")
    stored["files"] += [
        "mode_harmonic.png",
        "mode_folder.png",
        "notes.txt",
        "../outside.txt",
        "speed_accuracy.png",
        7,
        None,
    ]
    (tmp_path / "results.json").write_text(json.dumps(stored))
    outside = tmp_path.parent / "outside.txt"
    outside.write_text("mine")
    compare(sg.load(OTHER), ("euler",)).write_report(tmp_path, renders=False)
    assert {p.name for p in tmp_path.iterdir()} == {
        "results.json",
        "report.html",
        "modes_euler.vtu",
        "mode_folder.png",
        *foreign,
    }
    assert outside.exists()


@pytest.mark.parametrize(
    "text",
    ["", "[]", '{"files": 3}', '{"files": {"a": 1}}', "\udcff"],
)
def test_results_that_are_not_ours_are_no_hindrance(text, tmp_path):
    (tmp_path / "results.json").write_bytes(text.encode("utf-8", "surrogateescape"))
    compare(sg.load(OTHER), ("euler",)).write_report(tmp_path, renders=False)
    assert json.loads((tmp_path / "results.json").read_text())["complete"]


# --------------------------------------------------------------------------- two runs in one folder
HOLD = """
import sys, time
from solidgear.comparison.page import charts
from solidgear.show.folder import held
with held(sys.argv[1]):
    print("held", flush=True)
    time.sleep(600)
"""


@posix
def test_a_second_run_is_refused_until_the_first_is_dead(tmp_path, run):
    second = ["compare", SCENE, "--models", "euler", "--no-renders", "--out", tmp_path]
    child = started(HOLD, tmp_path)
    try:
        assert child.stdout.readline() == "held\n"
        # A chart would write into the same report.
        for command in (second, ["chart", SCENE, "--out", tmp_path]):
            code, out, err = run(*command)
            assert code == 1 and out == "" and err.count("\n") == 1
            assert f"process {child.pid} is writing there" in err
            assert {p.name for p in tmp_path.iterdir()} == {LOCK}
    finally:
        child.kill()
        child.wait()
    assert (tmp_path / LOCK).exists()  # left by the killed one, and no hindrance
    assert run(*second)[0] == 0 and not (tmp_path / LOCK).exists()


def test_the_same_process_may_enter_again(tmp_path):
    with held(tmp_path) as folder, held(tmp_path / ".") as again:
        assert folder.samefile(again)
    assert list(tmp_path.iterdir()) == []


# --------------------------------------------------------------------------- without pictures
@pytest.mark.long
def test_the_terminal_says_that_pictures_are_missing_and_what_brings_them(
    tmp_path, run, monkeypatch
):
    monkeypatch.setenv("SOLIDGEAR_RENDERER", "none")
    command = ["compare", SCENE, "--models", "euler,timoshenko", "--out", tmp_path]
    code, out, _ = run(*command)
    assert code == 0  # numbers are whole
    said = [line for line in out.splitlines() if "left out" in line]
    assert len(said) == 1 and re.match(
        r"caution: render of euler, timoshenko left out: .*apt-get install .*libgl1", said[0]
    )
    # and not where none were asked for
    assert "left out" not in run(*command, "--no-renders")[1]
