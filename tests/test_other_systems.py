"""What Windows and macOS do otherwise, made up here: consoles, locks, open files, names of files."""

import ast
import errno
import io
import os
import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from solidgear.app.streams import spell_out
from solidgear.core.errors import SolidgearError
from solidgear.core.machine import threads, whole_file
from solidgear.core.machine.whole_file import whole
from solidgear.show import folder
from solidgear.show.sheet import Sheet, write_folder
from solidgear.show.table import numbers

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "solidgear"
SOURCES = sorted(PACKAGE.rglob("*.py"))
#: files that read what Linux alone has, and get along without
LINUX = {"control_groups.py", "environment.py", "interruptible.py"}


@pytest.mark.parametrize(
    "encoding, written",
    [
        ("cp1252", "f <= 3 µm · alpha -> ±2 | größer"),
        ("ascii", "f <= 3 um * alpha -> +-2 | gro?er"),
    ],
)
def test_a_console_gets_every_character_in_some_way(encoding, written):
    stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    with pytest.raises(UnicodeEncodeError):
        stream.write("≤")
    spell_out(stream)
    stream.write("f ≤ 3 µm · α → ±2 ┃ größer")
    stream.flush()
    assert stream.buffer.getvalue().decode(encoding) == written


def test_a_page_is_read_in_a_folder_with_blanks_by_a_console_of_windows(tmp_path):
    """Its lines end as on Windows, and it comes from there."""
    place = tmp_path / "Wälzlager und Ritzel" / "µ ≤ 1.toml"
    place.parent.mkdir()
    place.write_bytes(
        (ROOT / "geometry" / "shaft_stepped.toml").read_bytes().replace(b"\n", b"\r\n")
    )
    out = subprocess.run(
        [sys.executable, "-m", "solidgear", "--quiet", "stiffness", str(place), "-f", "euler"],
        env=os.environ | {"PYTHONPATH": str(ROOT), "PYTHONIOENCODING": "cp1252"},
        capture_output=True,
    )
    assert out.returncode == 0 and "N/um" in out.stdout.decode("cp1252"), out.stderr


def test_two_runs_of_one_folder_on_windows(tmp_path, monkeypatch):
    """Locks are of bytes, and a file that is open cannot be removed."""
    fcntl = pytest.importorskip("fcntl")

    def locking(descriptor, mode, size):
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise PermissionError(errno.EACCES, "Permission denied") from None

    opened = {}
    original_open, original_unlink = Path.open, Path.unlink

    def remember(path, *arguments, **options):
        file = original_open(path, *arguments, **options)
        opened.setdefault(path, []).append(file)
        return file

    def refuse_open(path, **options):
        if any(not file.closed for file in opened.get(path, ())):
            raise PermissionError(errno.EACCES, "it is open")
        original_unlink(path, **options)

    monkeypatch.setattr(folder, "fcntl", None)
    monkeypatch.setattr(folder, "msvcrt", SimpleNamespace(locking=locking, LK_NBLCK=2))
    monkeypatch.setattr(Path, "open", remember)
    monkeypatch.setattr(Path, "unlink", refuse_open)
    with folder.held(tmp_path):
        folder._held.clear()  # as another process, which knows of none
        with pytest.raises(SolidgearError, match=f"process {os.getpid()} is writing there"):
            with folder.held(tmp_path):
                pass
    assert not list(tmp_path.iterdir())
    with folder.held(tmp_path):
        pass


def test_a_file_that_a_scanner_holds_for_a_moment_is_replaced_all_the_same(tmp_path, monkeypatch):
    replace, refusals = os.replace, [PermissionError(errno.EACCES, "in use")] * 2

    def held(*places):
        if refusals:
            raise refusals.pop()
        replace(*places)

    monkeypatch.setattr(os, "replace", held)
    target = tmp_path / "rows.csv"
    with pytest.raises(PermissionError), whole(target) as partial:
        partial.write_text("1")
    assert not list(tmp_path.iterdir())
    monkeypatch.setattr(whole_file, "PAUSES", (0.0, 0.0))
    with whole(target) as partial:
        partial.write_text("1")
    assert target.read_text() == "1"


def test_processors_where_the_system_binds_in_another_way(monkeypatch):
    """By psutil on Windows; none can be bound on macOS."""
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)
    import psutil

    monkeypatch.setattr(psutil, "Process", lambda: SimpleNamespace(cpu_affinity=lambda: [0, 2, 3]))
    assert threads._affinity() == 3
    monkeypatch.setattr(psutil, "Process", lambda: SimpleNamespace())
    assert threads._affinity() == (os.cpu_count() or 1)


def test_names_of_shafts_become_names_of_files(tmp_path):
    lines = {f"line_{name}": numbers({"y [m]": [k]}) for k, name in enumerate(("A/1: *", "b", "B"))}
    files = write_folder(Sheet("study", "", "", (), {}, lines=lines), tmp_path)
    names = [file.name for file in files if file.suffix == ".csv"]
    assert names == ["line_A_1_ _.csv", "line_b.csv", "line_B_2.csv"]
    assert [(tmp_path / name).read_text().split()[-1] for name in names] == ["0", "1", "2"]


def calls(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "attr", getattr(node.func, "id", ""))
            yield node, name


def test_texts_are_read_and_written_in_an_encoding_that_is_said():
    """The usual one of Windows is another on every continent."""
    silent = []
    for path in SOURCES:
        text = path.read_text(encoding="utf-8")
        if not re.search(r"\b(open|read_text|write_text)\(", text):
            continue
        for node, name in calls(ast.parse(text)):
            is_method = isinstance(node.func, ast.Attribute)
            if name != "open" and not (is_method and name in ("read_text", "write_text")):
                continue
            words = [a.value for a in node.args if isinstance(a, ast.Constant)]
            words = [word for word in words if isinstance(word, str)]
            binary = any(re.fullmatch(r"[rwa+]*b[rwa+]*", word) for word in words)
            named = "utf-8" in words or any(key.arg == "encoding" for key in node.keywords)
            # gmsh, images and sessions of programs are opened by functions of their own
            of_file = name != "open" or not is_method or words
            if of_file and not binary and not named:
                silent.append(f"{path.relative_to(ROOT)}:{node.lineno}")
    assert silent == []


def test_nothing_asks_linux_alone():
    asked = re.compile(r"[\"'/]proc/|os\.(fork|getppid|killpg|getpgid|kill)\(")
    places = {path.name for path in SOURCES if asked.search(path.read_text(encoding="utf-8"))}
    assert places <= LINUX
