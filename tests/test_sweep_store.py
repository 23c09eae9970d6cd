"""The file of a sweep and the store beside it: damaged, shared, killed, without room.

Whatever is done to them, the next run ends with the right rows and says what it mended, or it ends
in one sentence.  Most of it is shown on rows that cost nothing, the rest on a light beam.
"""

import errno
import os
import random
import sqlite3
import subprocess
import sys
import tempfile
from contextlib import closing
from pathlib import Path

import pytest
from typer.testing import CliRunner

import solidgear as sg
from solidgear.cli import app
from solidgear.errors import SolidgearError
from solidgear.sweep import sweep
from solidgear.sweep.rows import RowFile

SCENE = "geometry/pinion_overhung.toml"
VARY = "bearing.1.scale=log:0.1:10:12"
COLUMNS = {"variant": int, "status": str, "f1_hz": float, "mode1": str}
PLAN = {"vary": "synthetic", "n": 1}
TOTAL = 120


def row(number):
    """A row that costs nothing: long enough for the rows to fill several pages of a database."""
    return {
        "variant": number,
        "status": "ok" if number % 7 else f"bearing {number}: " + "refused, " * 40,
        "f1_hz": 1000 / (number + 3) if number % 7 else None,
        "mode1": f"bending {number % 5}",
    }


def write(out, upto=TOTAL, batch=30, plan=PLAN, **rest):
    """Run a synthetic sweep; what was told, and the numbers it solved."""
    told, solved = [], []
    with RowFile(out, COLUMNS, plan, TOTAL, tell=told.append, **rest) as file:
        todo = [i for i in range(TOTAL) if i not in file.done]
        for k in range(0, len(todo), batch):
            if todo[k] >= upto:
                raise KeyboardInterrupt
            file.append(map(row, todo[k : k + batch]))
            solved += todo[k : k + batch]
        file.finish()
    return told, solved


def stop(out, upto):
    with pytest.raises(KeyboardInterrupt):
        write(out, upto)


def one_sentence(error):
    text = str(error)
    return "\n" not in text and len(text) > 20 and "Error(" not in text and "Traceback" not in text


@pytest.fixture
def tmp_path():
    """Folder in memory where there is one: hundreds of small files are synced to the disk here."""
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(dir=memory) as folder:
        yield Path(folder)


@pytest.fixture(scope="module")
def right(tmp_path_factory):
    """Bytes of the file of an undisturbed run."""
    out = tmp_path_factory.mktemp("right") / "rows.csv"
    write(out)
    return out.read_bytes()


# ------------------------------------------------------------------------------------ what is told
def spoil_bytes(rng, path):
    """Do something to the bytes of a file; whether anything is different now."""
    data = before = bytearray(path.read_bytes())
    data = bytearray(data)
    place, length = rng.randrange(len(data)), rng.choice([1, 1, 8, 200, 5000])
    kind = rng.choice(["flip", "flip", "zero", "cut", "drop", "noise", "twice", "append", "empty", "text"])
    if kind == "flip":
        data[place] ^= 1 << rng.randrange(8)
    elif kind == "zero":
        data[place : place + length] = bytes(len(data[place : place + length]))
    elif kind == "cut":
        del data[place:]
    elif kind == "drop":
        del data[place : place + length]
    elif kind == "noise":
        data[place : place + length] = rng.randbytes(len(data[place : place + length]))
    elif kind == "twice":
        data[place:place] = data[place : place + length]
    elif kind == "append":
        data += rng.randbytes(length)
    else:
        data = b"" if kind == "empty" else b"garbage\n\xff\xfe\n\n"
    path.write_bytes(data)
    return bytes(data) != bytes(before)


STATEMENTS = [
    "UPDATE rows SET line = replace(line, 'bending', 'axial') WHERE variant = {n}",
    "UPDATE rows SET line = '' WHERE variant = {n}",
    "UPDATE rows SET line = 12 WHERE variant = {n}",
    "UPDATE rows SET line = x'fffe00' WHERE variant = {n}",
    "UPDATE rows SET line = (SELECT line FROM rows WHERE variant = {m}), "
    "checksum = (SELECT checksum FROM rows WHERE variant = {m}) WHERE variant = {n}",
    "UPDATE rows SET checksum = 'none' WHERE variant = {n}",
    "UPDATE rows SET variant = 99999 WHERE variant = {n}",
    "UPDATE rows SET variant = -1 WHERE variant = {n}",
    "INSERT INTO rows SELECT 99999, line, checksum FROM rows WHERE variant = {n}",
    "DELETE FROM rows WHERE variant = {n}",
    "DELETE FROM rows WHERE variant >= {n}",
    "DELETE FROM rows",
    "DROP TABLE rows",
    "DELETE FROM facts",
    "DELETE FROM facts WHERE name = 'rows'",
    "DELETE FROM facts WHERE name = 'key'",
    "UPDATE facts SET value = 7 WHERE name = 'rows'",
    "UPDATE facts SET value = '{{}}' WHERE name = 'key'",
    "UPDATE facts SET value = '[' WHERE name = 'file'",
    "DROP TABLE facts",
    "PRAGMA user_version = 2",
    "PRAGMA application_id = 0",
    "ALTER TABLE rows RENAME COLUMN line TO text",
    "PRAGMA journal_mode = WAL",
]


def spoil_rows(rng, store):
    statement = rng.choice(STATEMENTS).format(n=rng.randrange(60), m=rng.randrange(60))
    with closing(sqlite3.connect(store)) as db, db:
        db.execute(statement)


def judge(out, right, spoilt_file, solved_before):
    """Run again over damaged files; how it ended."""
    try:
        told, solved = write(out)
    except SolidgearError as error:
        assert one_sentence(error), error
        write(out, overwrite=True)
        assert out.read_bytes() == right
        return "refused"
    assert out.read_bytes() == right
    assert all(map(one_sentence, told))
    if len(solved) > TOTAL - solved_before:
        assert any("was damaged" in text for text in told)
    if spoilt_file:
        assert any(".changed" in text for text in told)
    assert write(out) == ([], [])  # mended for good
    return "mended" if told else "unharmed"


def damage_and_go_on(seed, folder, right):
    """A sweep, stopped or finished, is damaged at random and run again; how that ended."""
    rng = random.Random(seed)
    out, store = folder / "rows.csv", folder / "rows.csv.sqlite"
    upto = rng.choice([60, TOTAL])
    if upto < TOTAL:
        stop(out, upto)
    else:
        write(out)
    what = rng.choice(["file", "store", "store", "rows", "rows", "both"])
    spoilt_file = what in ("file", "both") and spoil_bytes(rng, out)
    if what in ("store", "both"):
        spoil_bytes(rng, store)
    if what == "rows":
        spoil_rows(rng, store)
    return judge(out, right, spoilt_file, upto)


def test_damage_ends_in_a_sentence_or_in_the_right_rows(tmp_path, right):
    ends = [damage_and_go_on(seed, Path(tempfile.mkdtemp(dir=tmp_path)), right) for seed in range(36)]
    assert {"mended", "refused", "unharmed"} == set(ends)
    assert ends.count("mended") > len(ends) / 2  # a refusal is the exception


@pytest.mark.slow
def test_much_damage_ends_in_a_sentence_or_in_the_right_rows(tmp_path, right):
    for seed in range(1000, 1600):
        damage_and_go_on(seed, Path(tempfile.mkdtemp(dir=tmp_path)), right)


@pytest.mark.parametrize("statement", STATEMENTS)
def test_every_change_of_the_store_is_noticed(statement, tmp_path, right):
    out = tmp_path / "rows.csv"
    write(out)
    with closing(sqlite3.connect(f"{out}.sqlite")) as db, db:
        db.execute(statement.format(n=37, m=12))
    if judge(out, right, False, TOTAL) == "unharmed":
        assert "journal_mode" in statement


LINES = {
    "garbage": lambda lines: lines[:5] + [b"garbage\n"] + lines[5:],
    "empty": lambda lines: lines[:5] + [b"\n"] + lines[5:],
    "not UTF-8": lambda lines: lines[:5] + [b"\xff\xfe\n"] + lines[5:],
    "altered number": lambda lines: [line.replace(b"90.9", b"90.8") for line in lines],
    "twice": lambda lines: lines[:6] + lines[5:],
    "short": lambda lines: lines[:5] + [lines[5][:9] + b"\n"] + lines[6:],
    "row 99999": lambda lines: lines + [lines[5].replace(b"4,", b"99999,", 1)],
    "missing": lambda lines: lines[:5] + lines[6:],
    "other header": lambda lines: [b"a,b\n", *lines[1:]],
    "cut off": lambda lines: lines[:-1] + [lines[-1][:4]],
    "nothing": lambda lines: [],
}


@pytest.mark.parametrize("damage", LINES)
@pytest.mark.parametrize("upto", [60, TOTAL])
def test_a_damaged_file_is_set_aside_and_written_anew(damage, upto, tmp_path, right):
    out = tmp_path / "rows.csv"
    write(out) if upto == TOTAL else stop(out, upto)
    damaged = b"".join(LINES[damage](out.read_bytes().splitlines(keepends=True)))
    assert damaged != out.read_bytes()
    out.write_bytes(damaged)
    told, solved = write(out)
    assert out.read_bytes() == right and len(solved) == TOTAL - upto
    assert len(told) == 1 and "rows.csv.changed" in told[0] and one_sentence(told[0])
    # nobody's work is lost
    assert (tmp_path / "rows.csv.changed").read_bytes() == damaged
    out.write_bytes(b"again")
    write(out)
    assert (tmp_path / "rows.csv.changed").read_bytes() == damaged
    assert (tmp_path / "rows.csv.changed2").read_bytes() == b"again"


def test_a_file_that_is_gone_comes_back(tmp_path, right):
    out = tmp_path / "rows.csv"
    write(out)
    out.unlink()
    told, solved = write(out)
    assert out.read_bytes() == right and not solved
    assert told == [f"{out} was gone and is written anew from rows.csv.sqlite"]


def test_a_parquet_file_is_mended_too(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    out = tmp_path / "rows.parquet"
    stop(out, 60)
    assert not out.exists()
    write(out)
    right = parquet.read_table(out).to_pylist()
    assert right == [{**row(i), "f1_hz": row(i)["f1_hz"]} for i in range(TOTAL)]
    out.write_bytes(out.read_bytes()[:500])
    told, solved = write(out)
    assert len(told) == 1 and not solved and parquet.read_table(out).to_pylist() == right
    with closing(sqlite3.connect(f"{out}.sqlite")) as db, db:
        db.execute("DELETE FROM rows WHERE variant = 7")
    told, solved = write(out)
    assert len(told) == 1 and solved == [7] and parquet.read_table(out).to_pylist() == right


def test_a_foreign_database_is_not_touched(tmp_path):
    out, store = tmp_path / "rows.csv", tmp_path / "rows.csv.sqlite"
    with closing(sqlite3.connect(store)) as db, db:
        db.execute("CREATE TABLE mine (a)")
    before = store.read_bytes()
    with pytest.raises(SolidgearError, match="is no database of rows that this version.*--overwrite"):
        write(out)
    assert store.read_bytes() == before and not out.exists()


def test_rows_of_another_plan_are_refused_even_where_they_are_damaged(tmp_path):
    out, store = tmp_path / "rows.csv", tmp_path / "rows.csv.sqlite"
    write(out)
    before = out.read_bytes()
    with pytest.raises(SolidgearError, match=r"another sweep \(it differs in: n\)"):
        write(out, plan={**PLAN, "n": 2})
    with closing(sqlite3.connect(store)) as db, db:
        db.execute("DELETE FROM facts WHERE name = 'key'")
    with pytest.raises(SolidgearError, match="neither its key nor any row of this sweep is intact"):
        write(out, plan={**PLAN, "n": 2})
    told, solved = write(out)  # but those of this one are known by their checksums
    assert not solved and "all 120 rows are intact" in told[0] and out.read_bytes() == before


def test_a_plan_with_a_number_that_is_none_is_the_same_plan(tmp_path):
    plan = {**PLAN, "set": {"order": float("nan")}}
    write(tmp_path / "rows.csv", plan=plan)
    assert write(tmp_path / "rows.csv", plan=plan) == ([], [])


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
    assert sorted(os.listdir(tmp_path)) == ["other.csv", "other.csv.sqlite", "rows.csv", "rows.csv.sqlite"]


HOLD = """
import sys
from tests.test_sweep_store import light
def hold(done, total, text):
    if done:
        print(done, flush=True)
        sys.stdin.read()
light(sys.argv[1], progress=hold)
"""


def light(out, **rest):
    options = {"elements": 40}
    return sweep(sg.load(SCENE), [VARY], out, fidelity="timoshenko", options=options, n=4, **rest)


def call(out, *more):
    words = ["sweep", SCENE, "-f", "timoshenko", "--set", "elements=40", "-n", "4", "--vary", VARY]
    return CliRunner().invoke(app, [*words, "--out", str(out), *more])


def test_a_killed_sweep_leaves_the_lock_and_its_rows(tmp_path):
    """While the first runs the second is refused; once it is killed the second goes on where it was."""
    out = tmp_path / "rows.csv"
    light(tmp_path / "right.csv")
    first = subprocess.Popen(
        [sys.executable, "-c", HOLD, out], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
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
    assert summary.skipped == done and summary.repairs == ()
    assert out.read_bytes() == (tmp_path / "right.csv").read_bytes()
    names = ["rows.csv", "rows.csv.sqlite"]
    assert sorted(n for n in os.listdir(tmp_path) if "rows" in n) == names


APPEND = """
import sys
from tests.test_sweep_store import COLUMNS, PLAN, TOTAL, RowFile, row
with RowFile(sys.argv[1], COLUMNS, PLAN, TOTAL) as file:
    for i in sorted(set(range(TOTAL)) - file.done):
        file.append([row(i)])
        print(i, flush=True)
"""


@pytest.mark.parametrize("moments", [(20,), pytest.param((1, 2, 5, 7, 10, 30), marks=pytest.mark.slow)])
def test_killed_at_any_moment_it_goes_on(moments, tmp_path, right):
    """Killed while it writes: which rows are there then depends on the moment, what comes out does not."""
    out = tmp_path / "rows.csv"
    for rows in moments:
        process = subprocess.Popen([sys.executable, "-c", APPEND, out], stdout=subprocess.PIPE, text=True)
        seen = [int(process.stdout.readline()) for _ in range(rows)]
        process.kill()
        process.communicate()
        with RowFile(out, COLUMNS, PLAN, TOTAL, tell=pytest.fail) as file:
            assert set(seen) <= file.done < set(range(TOTAL))
    assert write(out)[0] == [] and out.read_bytes() == right


# --------------------------------------------------------------------------------- what cannot be
def test_a_full_disk_keeps_the_rows_before(tmp_path, right):
    out = tmp_path / "rows.csv"
    with pytest.raises(SolidgearError) as full, RowFile(out, COLUMNS, PLAN, TOTAL) as file:
        file.append(map(row, range(30)))
        file._store._db.execute("PRAGMA max_page_count = 1")  # as many as there are
        file.append(map(row, range(30, TOTAL)))
    assert str(full.value) == (
        f"--out {out}: cannot be written (database or disk is full); 30 of 120 rows are kept, "
        "and the same command goes on from there"
    )
    told, solved = write(out)
    assert told == [] and solved == list(range(30, TOTAL)) and out.read_bytes() == right


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
    # killed between noting what the file will be and putting it there: either is right
    monkeypatch.setattr("solidgear.whole_file.os.replace", _raise)
    with pytest.raises(SolidgearError, match="cannot be written"):
        write(out)
    monkeypatch.undo()
    assert write(out) == ([], []) and out.read_bytes() == right


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
            with pytest.raises(SolidgearError, match="cannot be written|is no file") as error:
                write(tmp_path / name, overwrite=overwrite)
            assert one_sentence(error.value)


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs a folder nobody can write to")
def test_a_folder_that_cannot_be_written_is_told():
    refused = call("/proc/self/rows.csv")
    assert refused.exit_code == 1 and "cannot be written" in str(refused.exception)


def test_a_store_taken_away_under_a_running_sweep_is_told(tmp_path):
    out = tmp_path / "rows.csv"
    with pytest.raises(SolidgearError, match="was taken away or replaced"), RowFile(out, COLUMNS, PLAN, TOTAL) as file:
        file.append(map(row, range(10)))
        (tmp_path / "rows.csv.sqlite").unlink()
        file.append(map(row, range(10, 20)))


# ------------------------------------------------------------------------------------- the command
def test_the_command_tells_what_it_mended(tmp_path):
    out = tmp_path / "rows.csv"
    assert call(out).exit_code == 0
    right = out.read_bytes()
    out.write_bytes(right.replace(b"bending 1", b"bending 7", 1))
    with closing(sqlite3.connect(f"{out}.sqlite")) as db, db:
        db.execute("UPDATE rows SET line = replace(line, 'ok', 'of') WHERE variant = 3")
    again = call(out)
    assert again.exit_code == 0, again.output
    assert out.read_bytes() == right and "11 of them there before" in again.stdout
    told = again.stderr.splitlines()
    assert told[0] == f"solidgear: {out}.sqlite was damaged: 11 of its rows are intact and kept, the others are solved again"
    assert len(told) == 2 and told[1].startswith(f"solidgear: {out} does not match the record")
