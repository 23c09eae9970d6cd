"""The file of a sweep shared by two, left by a killed one, without room, or no file of a sweep."""

import errno
import os
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest
from synthetic_sweep import (
    COLUMNS,
    PLAN,
    TOTAL,
    call,
    light,
    one_sentence,
    right,
    row,
    stop,
    tmp_path,
    write,
)

from solidgear.core.errors import SolidgearError
from solidgear.variants.sweep.rows import RowFile


# ------------------------------------------------------------------------------------------ shared
def test_a_second_sweep_on_the_same_file_is_refused_at_once(tmp_path, right):
    out = tmp_path / "rows.csv"
    with RowFile(out, COLUMNS, PLAN, TOTAL) as first:
        first.append(map(row, range(10)))
        for overwrite in (False, True):
            with pytest.raises(SolidgearError, match="is in use by another process"):
                write(out, overwrite=overwrite)
        with pytest.raises(SolidgearError, match="is in use by another process"):
            write(tmp_path / "." / ".." / tmp_path.name / "rows.csv")
        write(tmp_path / "other.csv")
    write(out)
    assert out.read_bytes() == right
    left = ["other.csv", "other.csv.sqlite", "rows.csv", "rows.csv.sqlite"]
    assert sorted(os.listdir(tmp_path)) == left


HOLD = """
import sys
from tests.synthetic_sweep import light
def hold(done, total, text):
    if done:
        print(done, flush=True)
        sys.stdin.read()
light(sys.argv[1], progress=hold)
"""


def test_a_killed_sweep_leaves_the_lock_and_its_rows(tmp_path):
    """While the first runs a second is refused; once it is killed the second goes on from there."""
    out = tmp_path / "rows.csv"
    light(tmp_path / "right.csv")
    command, pipe = [sys.executable, "-c", HOLD, out], subprocess.PIPE
    first = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True)
    try:
        done = int(first.stdout.readline())
        assert 0 < done < 12
        with pytest.raises(SolidgearError, match="rows.csv.sqlite: is in use by another process"):
            light(out)
        refused = call(out, "--overwrite")
        assert refused.exit_code == 1 and one_sentence(refused.exception)
    finally:
        first.kill()  # as kill -9 does
        first.communicate()
    (tmp_path / f".rows.csv.{first.pid}.part").write_text("left over from a killed export")
    summary = light(out)
    assert summary.skipped == done
    assert out.read_bytes() == (tmp_path / "right.csv").read_bytes()
    names = ["rows.csv", "rows.csv.sqlite"]
    assert sorted(n for n in os.listdir(tmp_path) if "rows" in n) == names


APPEND = """
import sys
from tests.synthetic_sweep import COLUMNS, PLAN, TOTAL, RowFile, row
with RowFile(sys.argv[1], COLUMNS, PLAN, TOTAL) as file:
    for i in sorted(set(range(TOTAL)) - file.done):
        sys.stdin.readline()
        file.append([row(i)])
        print(i, flush=True)
"""


MANY = pytest.param((1, 2, 5, 7, 10, 30), marks=pytest.mark.slow)


@pytest.mark.parametrize("moments", [(20,), MANY])
def test_killed_while_it_writes_it_goes_on(moments, tmp_path, right):
    """Whether the row it was writing is there depends on the moment; what comes out does not."""
    out, before = tmp_path / "rows.csv", 0
    for rows in moments:
        command, pipe = [sys.executable, "-c", APPEND, out], subprocess.PIPE
        process = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True)
        process.stdin.write("\n" * rows)
        process.stdin.flush()
        seen = [int(process.stdout.readline()) for _ in range(rows)]
        process.stdin.write("\n")
        process.stdin.flush()
        process.kill()
        process.communicate()
        with RowFile(out, COLUMNS, PLAN, TOTAL) as file:
            assert seen == list(range(before, before + rows))
            assert file.done in (set(range(before + rows)), set(range(before + rows + 1)))
            before = len(file.done)
    write(out)
    assert out.read_bytes() == right


# --------------------------------------------------------------------------------- what cannot be
def test_a_full_disk_keeps_the_rows_before(tmp_path, right):
    out = tmp_path / "rows.csv"
    with pytest.raises(SolidgearError) as full, RowFile(out, COLUMNS, PLAN, TOTAL) as file:
        file.append(map(row, range(30)))
        file._db.execute("PRAGMA max_page_count = 1")  # as many as there are
        file.append(map(row, range(30, TOTAL)))
    assert str(full.value) == (
        f"--out {out}: cannot be written (database or disk is full); 30 of 120 rows are kept, "
        "and the same command goes on from there"
    )
    assert write(out) == list(range(30, TOTAL)) and out.read_bytes() == right


def test_no_room_for_the_file_keeps_the_rows(tmp_path, right, monkeypatch):
    out = tmp_path / "rows.csv"
    stop(out, 60)
    before = out.read_bytes()

    def full(self, partial):
        partial.write_bytes(b"half")
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(RowFile, "_write_csv", full)
    with pytest.raises(SolidgearError, match="No space left on device.*120 of 120 rows are kept"):
        write(out)
    assert out.read_bytes() == before  # whole, if old
    assert sorted(os.listdir(tmp_path)) == ["rows.csv", "rows.csv.sqlite"]
    monkeypatch.undo()
    # the file cannot take the place of the one before
    monkeypatch.setattr("solidgear.core.machine.whole_file.os.replace", _raise)
    with pytest.raises(SolidgearError, match="cannot be written"):
        write(out)
    assert out.read_bytes() == before
    monkeypatch.undo()
    assert write(out) == [] and out.read_bytes() == right


def _raise(*_):
    raise OSError(errno.EIO, os.strerror(errno.EIO))


def test_what_is_no_file_is_refused(tmp_path):
    (tmp_path / "a.csv").mkdir()
    (tmp_path / "b.csv.sqlite").mkdir()
    names = ["a.csv", "b.csv", "a" * 248 + ".csv"]
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "d.csv")
        os.mkfifo(tmp_path / "e.csv.sqlite")
        names += ["d.csv", "e.csv"]
    for name in names:
        for overwrite in (False, True):
            with pytest.raises(SolidgearError, match="cannot be written|is not a file") as error:
                write(tmp_path / name, overwrite=overwrite)
            assert one_sentence(error.value)


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs a folder nobody can write to")
def test_a_folder_that_cannot_be_written_is_told():
    refused = call("/proc/self/rows.csv")
    assert refused.exit_code == 1 and "cannot be written" in str(refused.exception)


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        ("CREATE TABLE mine (a)", "is no database of rows that this.*--overwrite"),
        ("PRAGMA user_version = 1; CREATE TABLE rows (a)", "is no database of rows that this"),
        (None, "is damaged beyond repair .file is not a database.; put back a copy.*--overwrite"),
    ],
    ids=["foreign", "older", "no database"],
)
def test_what_is_no_file_of_rows_is_not_touched_unless_overwritten(spoil, says, tmp_path, right):
    out, database = tmp_path / "rows.csv", tmp_path / "rows.csv.sqlite"
    if spoil is None:
        database.write_bytes(b"garbage, and more of it than the head of a database" * 40)
    else:
        with closing(sqlite3.connect(database)) as db, db:
            db.executescript(spoil)
    before = database.read_bytes()
    with pytest.raises(SolidgearError, match=says) as refused:
        write(out)
    assert one_sentence(refused.value)
    assert database.read_bytes() == before and not out.exists()
    assert write(out, overwrite=True) == list(range(TOTAL)) and out.read_bytes() == right


def test_a_table_that_is_gone_is_written_again(tmp_path, right):
    out = tmp_path / "rows.csv"
    write(out)
    out.unlink()
    assert write(out) == [] and out.read_bytes() == right


def test_a_parquet_file_is_made_when_all_rows_are_there(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    out = tmp_path / "rows.parquet"
    stop(out, 60)
    assert not out.exists()
    write(out)
    assert parquet.read_table(out).to_pylist() == [row(i) for i in range(TOTAL)]


def test_a_plan_with_a_number_that_is_none_is_the_same_plan(tmp_path):
    plan = {**PLAN, "set": {"order": float("nan")}}
    write(tmp_path / "rows.csv", plan=plan)
    assert write(tmp_path / "rows.csv", plan=plan) == []


def test_a_sweep_without_rows_leaves_no_file(tmp_path):
    with RowFile(tmp_path / "rows.csv", COLUMNS, PLAN, TOTAL):
        pass
    assert not os.listdir(tmp_path)
