"""Damage to the file of a sweep and to the store beside it.

Whatever is done to them, the next run ends with the right rows and says what it mended, or it ends
in one sentence.
"""

import random
import sqlite3
import tempfile
from contextlib import closing
from pathlib import Path

import pytest
from synthetic_sweep import PLAN, TOTAL, call, one_sentence, right, row, stop, tmp_path, write

from solidgear.core.errors import SolidgearError


def spoil_bytes(rng, path):
    """Do something to the bytes of a file; whether anything is different now."""
    before = path.read_bytes()
    data = bytearray(before)
    place, length = rng.randrange(len(data)), rng.choice([1, 1, 8, 200, 5000])
    kind = rng.choice(["flip", "flip", "zero", "cut", "drop", "noise", "append", "text"])
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
    elif kind == "append":
        data += rng.randbytes(length)
    else:
        data = b"garbage\n\xff\xfe\n\n"
    path.write_bytes(data)
    return bytes(data) != before


def judge(out, right, solved_before=TOTAL):
    """Run again over damaged files; how it ended, and what was told."""
    try:
        told, solved = write(out)
    except SolidgearError as error:
        assert one_sentence(error), error
        write(out, overwrite=True)
        assert out.read_bytes() == right
        return "refused", [str(error)]
    assert out.read_bytes() == right
    assert all(map(one_sentence, told))
    assert write(out) == ([], [])  # mended for good
    return "mended" if told or len(solved) > TOTAL - solved_before else "unharmed", told


def damage_and_go_on(seed, folder, right):
    """A sweep, stopped or finished, whose bytes are damaged at random and that is run again."""
    rng = random.Random(seed)
    out = folder / "rows.csv"
    upto = rng.choice([60, TOTAL])
    if upto < TOTAL:
        stop(out, upto)
    else:
        write(out)
    what = rng.choice(["file", "store", "store", "both"])
    spoilt_file = what in ("file", "both") and spoil_bytes(rng, out)
    if what in ("store", "both"):
        spoil_bytes(rng, folder / "rows.csv.sqlite")
    end, told = judge(out, right, upto)
    if spoilt_file and end != "refused":
        assert any(".changed" in text for text in told)
    return end


def test_damage_ends_in_a_sentence_or_in_the_right_rows(tmp_path, right):
    folders = [Path(tempfile.mkdtemp(dir=tmp_path)) for _ in range(36)]
    ends = [damage_and_go_on(seed, folder, right) for seed, folder in enumerate(folders)]
    assert {"mended", "refused", "unharmed"} == set(ends)


@pytest.mark.slow
def test_much_damage_ends_in_a_sentence_or_in_the_right_rows(tmp_path, right):
    for seed in range(1000, 1600):
        damage_and_go_on(seed, Path(tempfile.mkdtemp(dir=tmp_path)), right)


@pytest.mark.parametrize(
    ("statement", "end"),
    [
        ("UPDATE rows SET line = replace(line, 'bending', 'axial') WHERE variant = 37", "mended"),
        ("UPDATE rows SET line = x'fffe00' WHERE variant = 37", "mended"),
        (
            "UPDATE rows SET (line, checksum) = "
            "(SELECT line, checksum FROM rows WHERE variant = 12) WHERE variant = 37",
            "mended",
        ),
        ("UPDATE rows SET variant = 99999 WHERE variant = 37", "mended"),
        ("INSERT INTO rows SELECT 99999, line, checksum FROM rows WHERE variant = 37", "mended"),
        ("DELETE FROM rows WHERE variant >= 37", "mended"),
        ("UPDATE facts SET value = '[' WHERE name = 'file'", "mended"),
        ("DELETE FROM rows", "refused"),
        ("DROP TABLE rows", "refused"),
        ("DELETE FROM facts WHERE name = 'key'", "refused"),
        ("UPDATE facts SET value = '{}' WHERE name = 'key'", "refused"),
        ("UPDATE facts SET value = '[' WHERE name = 'key'", "refused"),
        ("PRAGMA user_version = 2", "refused"),
        ("PRAGMA journal_mode = WAL", "unharmed"),
    ],
)
def test_every_change_of_the_store_is_noticed(statement, end, tmp_path, right):
    out = tmp_path / "rows.csv"
    write(out)
    with closing(sqlite3.connect(f"{out}.sqlite")) as db, db:
        db.execute(statement)
    assert judge(out, right)[0] == end


@pytest.mark.parametrize(
    "damage",
    [
        lambda lines: [line.replace(b"90.9", b"90.8") for line in lines],
        lambda lines: lines[:-1] + [lines[-1][:4]],
        lambda lines: [],
    ],
    ids=["altered number", "cut off", "nothing"],
)
@pytest.mark.parametrize("upto", [60, TOTAL])
def test_a_damaged_file_is_set_aside_and_written_anew(damage, upto, tmp_path, right):
    out = tmp_path / "rows.csv"
    write(out) if upto == TOTAL else stop(out, upto)
    damaged = b"".join(damage(out.read_bytes().splitlines(keepends=True)))
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


def test_a_foreign_database_is_not_touched(tmp_path):
    out, store = tmp_path / "rows.csv", tmp_path / "rows.csv.sqlite"
    with closing(sqlite3.connect(store)) as db, db:
        db.execute("CREATE TABLE mine (a)")
    before = store.read_bytes()
    with pytest.raises(SolidgearError, match="is no database of rows that this.*--overwrite"):
        write(out)
    assert store.read_bytes() == before and not out.exists()


def test_a_plan_with_a_number_that_is_none_is_the_same_plan(tmp_path):
    plan = {**PLAN, "set": {"order": float("nan")}}
    write(tmp_path / "rows.csv", plan=plan)
    assert write(tmp_path / "rows.csv", plan=plan) == ([], [])


# ------------------------------------------------------------------------------------- the command
@pytest.mark.long
def test_the_command_tells_what_it_mended(tmp_path):
    out = tmp_path / "rows.csv"
    assert call(out).exit_code == 0
    right = out.read_bytes()
    out.write_bytes(right.replace(b"bending 1", b"bending 7", 1))
    with closing(sqlite3.connect(f"{out}.sqlite")) as db, db:
        db.execute("UPDATE rows SET line = replace(line, 'ok', 'of') WHERE variant = 3")
    again = call(out)
    assert again.exit_code == 0, again.output
    assert out.read_bytes() == right and "11 more were there already" in again.stdout
    told = [line for line in again.stderr.splitlines() if not line.startswith("caution: ")]
    assert told[0] == (
        f"solidgear: {out}.sqlite was damaged: "
        "11 of its rows are intact and kept, the others are solved again"
    )
    assert len(told) == 2 and told[1].startswith(f"solidgear: {out} does not match the record")
